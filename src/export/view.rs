//! The view of a scene that an export holds: most forms hold one.

use super::{Form, executable, html};
use crate::{
    optics::TermSelection,
    registry::Registry,
    scene::{Scene, variant::LETTERS},
    text::listed,
};

/// The scene that a form gets, and a sentence that says which view it is and how to get the others. Programs and pages
/// hold all views unless one was asked for, and scenes without variants have only one: then there is nothing to say.
#[must_use]
pub fn exported(
    form: &Form,
    scene: &Scene,
    view: Option<usize>,
    stem: &str,
    registry: &Registry,
) -> (Scene, Option<String>) {
    let whole = scene.variants.is_empty() || view.is_none() && !holds_one(form);
    let index = view.unwrap_or_default();
    let Some((seen, terms)) = (!whole).then(|| scene.seen(index, registry)).flatten() else {
        return (scene.clone(), None);
    };
    let others: Vec<_> = (0..=scene.variants.len()).filter(|i| *i != index).collect();
    let names: Vec<_> = others.iter().map(|i| called(scene, *i)).collect();
    let first = others.first().and_then(|i| LETTERS.get(*i)).copied().unwrap_or("A");
    let one = called(scene, index);
    let mut note = format!(
        "This is {one} of a scene that compares it with {}; lcm export --view {first} exports another one.",
        listed(&names, "and")
    );
    if terms != TermSelection::All {
        note.push_str(" The view shows some terms of the equation only; the export shows all.");
    }
    let mut seen = seen.alone();
    let name = scene.name.as_deref().unwrap_or(stem);
    seen.name = Some(format!("{name}, {one}"));
    seen.description = Some(match &scene.description {
        Some(description) => format!("{description} {note}"),
        None => note.clone(),
    });
    (seen, Some(note))
}

/// True if a form holds one view; programs and pages hold all.
#[must_use]
pub fn holds_one(form: &Form) -> bool {
    form.id != executable::FORM.id && form.id != html::HTML.id
}

/// `view B (Phong)`.
pub(super) fn called(scene: &Scene, view: usize) -> String {
    let letter = LETTERS.get(view).copied().unwrap_or("?");
    match scene.view_name(view) {
        name if name == letter => format!("view {letter}"),
        name => format!("view {letter} ({name})"),
    }
}
