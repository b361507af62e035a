//! The menu of documents and pictures.

use super::{Group, List, Mark, Menu, command};
use crate::{
    document::Selection,
    export::FORMS,
    files::Shown as _,
    panel::{
        export,
        state::{
            Action, Effect, ExportCommand, LinkTo, MaterialCommand, Pick, Session, SheetOf, TakeCommand,
            Taken, Turning, ViewChange,
        },
    },
    scene::variant::LETTERS,
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
        let material = command("save_material", "Save material…", Action::Material(MaterialCommand::Ask));
        let tip = "Save the material of the selected object as a small file in your folder of materials";
        let none = !matches!(to.session.selection, Selection::Object(_));
        let material = material.says("Save the material of the object…").tip(tip).at_desk();
        to.add(material.unless(none, "No object is selected"));
        let link = command("copy_link", "Copy link to this scene", Action::CopyLink(LinkTo::Scene));
        let tip = "Put an address on the clipboard that holds this scene, and opens it in a browser with the laboratory";
        to.add(link.tip(tip));
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
        let help = "Write the views beside each other to a PNG file, the copies of a row, or a turn, with labels, and below \
                    each view the difference from one of them as a map with numbers; or a film of them. The CPU renderer \
                    draws them, as seen now.";
        let save = command("save_sheet", "Save sheet or film…", ask(Taken::Sheet(of_sheet(to.session))));
        to.add(save.says("Save a sheet or a film of the views, a row or a turn…").tip(help));
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

/// The default subject of a sheet: the row of the selected object, the views, the first row, or a turn.
fn of_sheet(session: &Session) -> SheetOf {
    let scene = &session.document;
    match session.selection {
        Selection::Object(i) if scene.row(i).is_some() => SheetOf::Row(i),
        _ if !scene.variants.is_empty() => SheetOf::Views,
        _ => {
            let first = scene.rows().next().map(|row| SheetOf::Row(row.first));
            first.unwrap_or(SheetOf::Turn(Turning::default()))
        }
    }
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
