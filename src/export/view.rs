//! The view of a scene that an export contains: most forms contain one.

use super::Form;
use crate::{
    optics::TermSelection,
    registry::Registry,
    scene::{Scene, variant::LETTERS},
    text::listed,
};

/// The scene passed to a form, and a sentence that names its view and explains how to export the others.
/// Programs and pages contain all views unless one was requested, and scenes without variants have only one:
/// then no sentence is needed.
#[must_use]
pub fn exported(
    form: &Form,
    scene: &Scene,
    view: Option<usize>,
    stem: &str,
    registry: &Registry,
) -> (Scene, Option<String>) {
    let whole = scene.variants.is_empty() || view.is_none() && !form.of_view;
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

/// The note of forms whose pictures have no labels, if the scene has some.
pub(super) fn without_labels(scene: &Scene) -> Option<String> {
    let has_labels = scene.rows().any(|row| row.repeat.labels);
    has_labels.then(|| "The labels of rows are left out.".to_owned())
}

/// `view B (Phong)`.
pub(super) fn called(scene: &Scene, view: usize) -> String {
    let letter = LETTERS.get(view).copied().unwrap_or("?");
    match scene.view_name(view) {
        name if name == letter => format!("view {letter}"),
        name => format!("view {letter} ({name})"),
    }
}
