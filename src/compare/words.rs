//! The numbers of differences in words, for captions.

use super::{metric, pair::Pair, shown::Shown};
use crate::{caption::Part, scene::variant::LETTERS};

/// The numbers between the first view and each of the others: "B to A over objects: RMSE 0.039, FLIP 0.121". They are over
/// the pixels that objects cover, where these are known. Views of other sizes are left out.
#[must_use]
pub fn numbers(views: &[usize], shown: &[Shown]) -> Vec<Part> {
    let letter = |view: &usize| LETTERS.get(*view).copied().unwrap_or_default();
    let ([first, views @ ..], [a, others @ ..]) = (views, shown) else { return Vec::new() };
    let mut parts = Vec::new();
    for (view, other) in views.iter().zip(others) {
        let Some(measured) = Pair::new(a, other).ok().and_then(|pair| pair.measure()) else { continue };
        let (over, of) = match &measured.covered {
            Some(covered) => (" over objects", covered),
            None => ("", &measured.all),
        };
        parts.push(Part::new(0, format!("{} to {}{over}:", letter(view), letter(first))));
        for (id, metric) in metric::in_window() {
            let number = of.of(id).map(|number| format!("{} {}", metric.name, (metric.text)(number)));
            parts.extend(number.map(|text| Part { continues: true, ..Part::new(0, text) }));
        }
    }
    parts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        caption::line,
        reference::Settings,
        registry::Registry,
        scene::{Scene, Variant},
    };

    #[test]
    fn pictures_of_which_only_codes_are_known_are_compared_over_objects_too() {
        let registry = Registry::builtin();
        let phong = Variant { reflection_model: Some("phong".to_owned()), ..Variant::default() };
        let scene = Scene { variants: vec![phong], ..Scene::default() };
        let settings = Settings { width: 64, height: 36, samples: 4, ..Settings::default() };
        let view = |view| Shown::of_view(&scene, view, &registry, &settings).expect("a view");
        let lit = [view(0), view(1)];
        let codes =
            lit.clone().map(|shown| Shown::of_codes(64, 36, shown.into_rgb8()).expect("the right size"));
        let covered = codes.clone().map(|shown| shown.covering_objects(&scene, &registry, 4));
        assert_eq!(numbers(&[0, 1], &covered), numbers(&[0, 1], &lit));
        assert_eq!(codes[1].clone().covering_like(&covered[0]), covered[1], "calculated once");
        let small = Shown::of_codes(1, 1, vec![0; 3]).expect("the right size");
        assert_eq!(small.clone().covering_like(&covered[0]), small);
        assert_ne!(numbers(&[0, 1], &codes), numbers(&[0, 1], &lit), "the wrong twin");
    }

    #[test]
    fn each_view_is_compared_with_the_first() {
        let shown = |code: u8| Shown::of_codes(16, 16, vec![code; 3 * 256]).expect("the right size");
        let said = line(&numbers(&[0, 2, 3], &[shown(100), shown(151), shown(100)]));
        assert!(said.starts_with("C to A: RMSE 0.200, FLIP "), "{said}");
        assert!(said.contains(" · D to A: RMSE 0.000, FLIP 0.000"), "{said}");
        assert_eq!(numbers(&[0], &[shown(100)]), []);
        let covered = |code: u8| shown(code).covering(vec![true; 256]).expect("the right size");
        assert!(line(&numbers(&[0, 1], &[covered(1), covered(2)])).starts_with("B to A over objects: "));
    }
}
