//! The files that are no materials: one line, which unfolds, so that they leave the materials their place.

use std::path::Path;

use super::super::{prelude::*, rank::rank};
use crate::materials::Broken;

/// Most files that are listed, and most mistakes of each.
const MOST: usize = 40;
const MOST_MISTAKES: usize = 3;
/// Most files in the tooltip.
const MOST_IN_TIP: usize = 8;
/// Height of the list, in points; a longer one is scrolled.
const ROOM: f32 = 90.0;
/// Room for the triangle and the sign before the words, in points.
const SIGNS: f32 = 36.0;

/// True if a search may mean a file.
pub(super) fn is_named(broken: &Broken, search: &str) -> bool {
    rank(&file_name(&broken.path), &[], &broken.problems.join(" "), search).is_some()
}

fn file_name(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// A file with its mistakes.
fn said(broken: &Broken) -> String {
    let mut text = format!("{} was not read: ", file_name(&broken.path));
    text += &broken.problems.iter().take(MOST_MISTAKES).cloned().collect::<Vec<_>>().join("; ");
    let more = broken.problems.len().saturating_sub(MOST_MISTAKES);
    if more > 0 {
        text += &format!("; and {}", plural(more, "more mistake"));
    }
    text
}

/// Shows the line, if there are such files, and the list while it is unfolded.
pub(super) fn broken(ui: &mut Ui, all: &[&Broken], unfolded: &mut bool) {
    let title = match all {
        [] => return,
        [one] => said(one),
        all => format!("{} files cannot be read", all.len()),
    };
    let response = line(ui, &title, *unfolded);
    if response.clicked() {
        *unfolded = !*unfolded;
    }
    if *unfolded {
        let scroll = ScrollArea::vertical().id_salt("broken files").auto_shrink([false, true]);
        scroll.max_height(ROOM).show(ui, |ui| list(ui, all, MOST));
    } else {
        theme::tip(response, 420.0, |ui| list(ui, all, MOST_IN_TIP));
    }
}

/// The line that folds. Returns its response.
fn line(ui: &mut Ui, title: &str, unfolded: bool) -> Response {
    let palette = Palette::here(ui);
    let width = ui.available_width();
    let words = theme::elided(ui, title, TextStyle::Small, palette.error, width - SIGNS);
    let (rect, _) = ui.allocate_exact_size(vec2(width, words.size().y + 6.0), Sense::hover());
    let under = ui.painter().add(Shape::Noop);
    let response = icon::fold(ui, rect, ui.id().with("files that cannot be read"), title, unfolded);
    if theme::is_hot(&response) {
        ui.painter().set(under, Shape::rect_filled(rect, 3.0, palette.hovered));
    }
    icon::severity(ui.painter(), rect.left_center() + vec2(24.0, 0.0), 5.5, Severity::Error, &palette);
    let at = rect.left_center() + vec2(SIGNS, -0.5 * words.size().y);
    ui.painter().galley(at, words, palette.error);
    response
}

/// The files with their mistakes, at most so many.
fn list(ui: &mut Ui, all: &[&Broken], most: usize) {
    for broken in all.iter().take(most) {
        let text = RichText::new(said(broken)).small().color(Palette::here(ui).error);
        icon::remark(ui, [14.0, 16.0], Severity::Error, Label::new(text).wrap());
    }
    if all.len() > most {
        theme::note(ui, format!("And {} were not read.", plural(all.len() - most, "more file")));
    }
}
