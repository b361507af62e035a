//! The shader panel: the files behind the picture, and their errors.

use std::path::Path;

use super::{author, export, laws, prelude::*, state::Effect};
use crate::{custom::source_path, text::sentence};
use {files::files, trouble::troubles};

mod files;
mod trouble;

pub use files::words;
pub use trouble::{Excerpt, consequence, excerpt, report};

/// The note on its tab: the number of errors.
pub(super) fn note(session: &Session) -> Option<(Severity, String)> {
    let count = session.shaders.troubles.len();
    (count > 0).then(|| (Severity::Error, plural(count, "error")))
}

/// The *Shaders* panel.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    let whole = ui.available_rect_before_wrap();
    let gap = 12.0;
    // Problems get more width.
    let share = if session.shaders.troubles.is_empty() { 0.5 } else { 0.4 };
    let left = (share * whole.width()).clamp(240.0, 620.0);
    let columns = whole.split_left_right_at_x(whole.left() + left + gap);
    ui.painter().vline(columns.1.left(), whole.y_range(), Stroke::new(1.0, Palette::here(ui).line));
    let (mut list, mut text) = columns;
    list.max.x -= gap;
    text.min.x = (text.min.x + gap).min(text.max.x - 64.0);
    theme::column(ui, list, |ui| files(ui, context));
    theme::column(ui, text, |ui| {
        if session.shaders.troubles.is_empty() {
            well(ui, context);
        } else {
            troubles(ui, context);
        }
    });
}

/// The action that opens a file in an editor, at a line.
fn open_in_editor(path: &Path, line: usize) -> Action {
    Action::Do(Effect::OpenInEditor { path: path.to_owned(), line })
}

/// The message about a missing model that a scene refers to.
#[must_use]
pub fn missing_model(session: &Session, registry: &Registry, id: &str) -> String {
    let path = source_path(id);
    let trouble =
        session.shaders.troubles.iter().find(|t| t.problem.file == path).map(|t| t.problem.to_string());
    match trouble.or_else(|| registry.broken_model(id).map(str::to_owned)) {
        Some(why) => format!(
            "The file {path} has no working version yet: {} Correct the file, or choose another model.",
            sentence(&why)
        ),
        None => format!(
            "There is no reflection model “{id}”: the file {path} is missing. Restore it, or choose another \
             model."
        ),
    }
}

/// The panel without errors: the latest reload, and first steps.
fn well(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    let heading = if laws::are_broken(session) { "No errors, but broken laws" } else { "No errors" };
    let how = match &session.shaders.folders.shaders {
        Some(_) => {
            "Open a file at the left, change it and save it: the picture follows. Errors appear here, and the picture keeps the last version that worked."
        }
        None => {
            "To change how the picture is computed: export the shaders, open one in an editor, save it. The picture follows. Or write a custom model:"
        }
    };
    ui.horizontal(|ui| {
        ui.label(theme::strong(ui, heading));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            laws::button(ui, context);
            export::copy_menu(ui, context);
            let last = session.shaders.last.as_ref();
            let text =
                last.map(|last| format!("{} loaded in {:.0} ms", last.file, last.milliseconds.max(0.0)));
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                text.map(|text| ui.add(Label::new(theme::small(ui, text)).truncate()));
            });
        });
    });
    ScrollArea::vertical().id_salt("well").auto_shrink(false).show(ui, |ui| {
        // The scroll bar floats over this margin.
        ui.set_width(ui.available_width() - 8.0);
        laws::findings(ui, session);
        ui.add(Label::new(how).wrap());
        ui.add_space(4.0);
        author::buttons(ui, context);
    });
}
