//! The shipped lessons, built into the program, so that it needs no folder next to it.

use std::sync::LazyLock;

use super::Lesson;
use crate::registry::Registry;

macro_rules! texts {
    ($($name:literal),* $(,)?) => {
        &[$(($name, include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/lessons/", $name, ".md")))),*]
    };
}

/// Texts of the lessons, each building on those before it.
pub const TEXTS: &[(&str, &str)] = texts![
    "01_reflection_models",
    "02_three_terms",
    "03_where_shading_is_computed",
    "04_half_vectors_and_highlights",
    "05_light_falls_off",
    "06_gamma",
    "07_fresnel_and_metals",
    "08_energy_and_the_white_furnace",
    "09_a_highlight_has_the_shape_of_the_lamp",
    "10_a_material_under_the_sky",
    "11_why_a_straw_looks_broken",
    "12_glass_paper_leaf",
    "13_a_model_of_your_own",
];

/// All shipped lessons, in the order of lists.
pub static LESSONS: LazyLock<Vec<Lesson>> = LazyLock::new(|| {
    let registry = Registry::builtin();
    // A test reads each without problems.
    TEXTS.iter().filter_map(|(name, text)| Lesson::from_text(text, name, None, &registry).ok()).collect()
});
