//! The menu of documents and pictures.

use super::{Group, List, Mark, Menu, command};
use crate::{
    document::Selection,
    export::FORMS,
    files::Shown as _,
    panel::{
        export,
        state::{Action, Effect, ExportCommand, Pick, Session, TakeCommand, Taken, ViewChange},
    },
    scene::{Repetition, variant::LETTERS},
};

pub(super) fn file(to: &mut List) {
    to.menu(Menu::new("File").group(Group::File).width(super::show::WIDTH), |to| {
        to.add(command("new", "New default scene", Action::New).keys("Ctrl+N"));
        to.add(command("open", "Open…", Action::OpenDialog).keys("Ctrl+O"));
        recent(to);
        to.menu(Menu::new(super::EXAMPLES), |_| ());
        to.line();
        to.add(command("save", "Save", Action::Save).keys("Ctrl+S"));
        to.add(command("save_as", "Save as…", Action::Do(Effect::Pick(Pick::Save))).keys("Ctrl+Shift+S"));
        let unsaved = to.session.path.is_none();
        let reload = command("reload", "Reload from disk", Action::Reload);
        to.add(reload.unless(unsaved, "The scene has no file yet"));
        to.line();
        pictures(to);
        exports(to);
        to.line();
        to.add(command("quit", "Quit", Action::Quit).keys("Ctrl+Q"));
    });
}

fn recent(to: &mut List) {
    let files = &to.session.settings.recent_files;
    to.menu(Menu::new("Open recent").empty("Files that you open or save appear here."), |to| {
        for (i, path) in files.iter().enumerate() {
            let whole = path.shown().to_string();
            let name = path.file_name().map_or_else(|| whole.clone(), |n| n.to_string_lossy().into_owned());
            let open = command(format!("open_recent.{}", i + 1), name, Action::Open(path.clone()));
            to.add(open.tip(whole));
        }
        to.line();
        let clear = command("clear_recent", "Clear the list", Action::ClearRecent);
        to.add(clear.says("Clear the list of recent files").absent(files.is_empty()));
    });
}

fn pictures(to: &mut List) {
    let alone = !to.session.document.variants.is_empty();
    let view = to.session.active();
    let letter = LETTERS.get(view).copied().unwrap_or_default();
    let (save, copy) = if alone { ("Save all views…", "Copy all views") } else { ("Save…", "Copy") };
    let copied = |view| Action::Do(Effect::Picture { view, file: None, overwrite: false });
    to.menu(Menu::new("Picture").width(super::show::WIDTH), |to| {
        let ask = |of| Action::Take(TakeCommand::Ask(of));
        let file = "Write the picture to a PNG file, without handles and labels, or its linear light to an OpenEXR file \
                    (.exr) with layers or a Radiance file (.hdr). A window asks for size, caption and background first. \
                    The file holds the scene, so it can be opened again.";
        let save = command("save_picture", save, ask(Taken::Picture(None)));
        to.add(save.says("Save the picture…").keys("Ctrl+P").tip(file));
        let help = "Write the picture to another file, with the size, the caption and the background as they were chosen last";
        let again = Action::Do(Effect::Pick(Pick::Picture(None)));
        let again = command("save_picture_again", "Save with the same options…", again);
        to.add(again.says("Save the picture with the same options…").tip(help));
        let help = "Write the picture of the active view to a PNG, OpenEXR (.exr) or Radiance (.hdr) file";
        let name = format!("Save view {letter} alone…");
        let save = command("save_view", name, ask(Taken::Picture(Some(view))));
        to.add(save.tip(help).absent(!alone));
        let help = "Write the views beside each other to a PNG file, or the copies of a row, with labels, and below each the \
                    difference from the first as a map with numbers. The CPU renderer draws them, as seen now.";
        let save = command("save_sheet", "Save sheet…", ask(Taken::Sheet(row_of_sheet(to.session))));
        let save = save.says("Save a sheet of the views or of a row…").tip(help);
        let has_row = to.session.document.objects.iter().any(|object| matches!(object.repeat, Repetition::Copy { .. }));
        let why = "The scene has one view alone and no row; add a view (Ctrl+B) or a row (Edit › Row…)";
        to.add(save.unless(!alone && !has_row, why));
        let copy = command("copy_picture", copy, copied(None));
        let help = "Put the picture as it is shown on the clipboard";
        to.add(copy.says("Copy the picture").keys("Ctrl+Shift+P").tip(help));
        let help = "Put the picture of the active view on the clipboard";
        let copy = command("copy_view", format!("Copy view {letter} alone"), copied(Some(view)));
        to.add(copy.tip(help).absent(!alone));
        to.line();
        let on = to.session.settings.picture_caption;
        let caption = command("caption", "With a caption", Action::View(ViewChange::PictureCaption(!on)));
        let help = "Add a strip below the picture: models, values that differ from the defaults, tone mapping, version";
        to.add(caption.mark(Mark::Check(on)).tip(help));
    });
}

/// An object of the row of which a sheet is offered first: that of the selected object, or the first one if there is only
/// one view.
fn row_of_sheet(session: &Session) -> Option<usize> {
    let scene = &session.document;
    let selected = match session.selection {
        Selection::Object(i) => scene.row(i).map(|_| i),
        _ => None,
    };
    let first = || scene.rows().next().map(|row| row.first);
    selected.or_else(|| if scene.variants.is_empty() { first() } else { None })
}

/// An entry for each form.
fn exports(to: &mut List) {
    to.menu(Menu::new("Export as"), |to| {
        for form in FORMS {
            let action = Action::Export(ExportCommand::Dialog(form.id));
            let export = command(format!("export.{}", form.id), format!("{}…", form.name), action);
            to.add(export.tip(export::help(to.session, form)));
        }
    });
}
