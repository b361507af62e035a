//! The menu of the parts of the scene and of custom models.

use super::{CONTINUE, CONTINUE_TIP, Group, List, Menu, command};
use crate::{
    document::{Edit, Selection},
    panel::{
        history::HISTORY_TAB,
        state::{Action, Alike, Arrangement, CodeCommand, Effect, ModelCommand, Pick, ViewChange},
    },
};

pub(super) fn edit(to: &mut List) {
    to.menu(Menu::new("Edit").group(Group::Edit).width(1.3 * super::show::WIDTH), |to| {
        history(to);
        to.line();
        additions(to);
        to.line();
        parts(to);
        several(to);
        to.line();
        models(to);
    });
}

fn history(to: &mut List) {
    let document = &to.session.document;
    let (done, steps) = (document.done(), document.steps().len());
    let step = |verb: &str, at: Option<usize>| match at.and_then(|at| document.steps().nth(at)) {
        Some(name) => format!("{verb} “{name}”"),
        None => verb.to_owned(),
    };
    let undo = done.checked_sub(1);
    let redo = Some(done).filter(|done| *done < steps);
    let back = command("undo", step("Undo", undo), Action::Undo).says("Undo").keys("Ctrl+Z");
    to.add(back.unless(undo.is_none(), "There is nothing to undo"));
    let again = command("redo", step("Redo", redo), Action::Redo).says("Redo").keys("Ctrl+Shift+Z Ctrl+Y");
    to.add(again.unless(redo.is_none(), "There is nothing to redo"));
    let list = Action::View(ViewChange::BottomTab(HISTORY_TAB.to_owned()));
    to.add(command("history", "History…", list).at_desk());
}

fn additions(to: &mut List) {
    let (lights, shapes) = (to.registry.lights(), to.registry.shapes());
    let add = |id: String, name, glyph, tip, action| super::Command {
        glyph,
        foreign: true,
        ..command(id, name, action).tip(tip)
    };
    to.menu(Menu::new("Add a light"), |to| {
        for d in lights.iter().map(|light| light.declaration) {
            let action = Action::AddLight(d.id.to_owned());
            to.add(add(format!("add_light.{}", d.id), d.name, d.glyph, d.summary, action));
        }
    });
    to.menu(Menu::new("Add an object"), |to| {
        for d in shapes.iter().map(|shape| shape.declaration) {
            let action = Action::AddObject(d.id.to_owned());
            to.add(add(format!("add_object.{}", d.id), d.name, d.glyph, d.summary, action));
        }
    });
}

fn parts(to: &mut List) {
    let part = to.session.selection;
    let none = !matches!(part, Selection::Light(_) | Selection::Object(_));
    let why = "Neither a light nor an object is selected";
    for command in [
        command("rename", "Rename", Action::BeginRename(part)).keys("F2").rank(4).at_desk(),
        command("duplicate", "Duplicate", Action::Duplicate(part)).keys("Ctrl+D").rank(1),
        command("toggle", "Hide or switch off", Action::Toggle(part))
            .says("Hide or show the object, switch the light off or on")
            .keys("V")
            .rank(3),
        command("delete", "Delete", Action::Remove(part)).keys("Delete").rank(2),
    ] {
        to.add(command.unless(none, why));
    }
    to.line();
    rows(to);
}

/// Several lights and objects at once.
fn several(to: &mut List) {
    to.menu(Menu::new("Several parts"), |to| {
        select(to);
        to.line();
        others(to);
        to.line();
        to.menu(Menu::new("Align and distribute"), arrange);
        single(to);
    });
}

fn select(to: &mut List) {
    let session = to.session;
    for by in Alike::ALL {
        let all = command(format!("select.{}", by.id()), by.name(), Action::SelectAlike(by));
        let all = if by == Alike::Kind {
            all.says("Select all objects, all lights, or both").keys("Ctrl+A")
        } else {
            all
        };
        let is_light = matches!(session.selection, Selection::Light(_)) && by == Alike::Model;
        to.add(all.unless(is_light, "A light is selected, which has no reflection model"));
    }
    let one = command("select.one", "The first alone", Action::Select(session.selection));
    to.add(one.unless(!session.has_group(), "Only one part is selected"));
}

fn others(to: &mut List) {
    let session = to.session;
    let objects = matches!(session.selection, Selection::Object(_)) || session.has_group();
    let alone = command("hide_others", "Hide the other objects", Action::HideOthers).keys("Shift+V").rank(3);
    to.add(alone.unless(!objects, "No object is selected"));
    let hidden = session.document.objects.iter().any(|object| !object.visible);
    let all = command("show_all", "Show all objects", Action::ShowAll).keys("Ctrl+Shift+V").rank(3);
    to.add(all.unless(!hidden, "No object is hidden"));
}

fn arrange(to: &mut List) {
    let none = !to.session.has_group();
    let names = [
        ["Left sides", "Middles from left to right", "Right sides", "Equal distances along x"],
        ["Undersides", "Middles from below to above", "Tops", "Equal distances along y"],
        ["Backs", "Middles from back to front", "Fronts", "Equal distances along z"],
    ];
    let ways = [Arrangement::Low, Arrangement::Middle, Arrangement::High, Arrangement::Apart];
    for (axis, (names, letter)) in names.into_iter().zip(["x", "y", "z"]).enumerate() {
        for (how, name) in ways.into_iter().zip(names) {
            let id = format!("arrange.{letter}_{}", how.id());
            let arrange = command(id, name, Action::Arrange(how, axis));
            to.add(arrange.unless(none, "Only one part is selected"));
        }
        if letter != "z" {
            to.line();
        }
    }
}

/// The object whose row is meant.
fn object_of_row(to: &List) -> Option<usize> {
    match to.session.selection {
        Selection::Object(i) => Some(i),
        // There is no other that could be meant.
        _ => Some(0).filter(|_| to.session.document.objects.len() == 1),
    }
}

fn single(to: &mut List) {
    let object = object_of_row(to);
    let row = object.and_then(|i| to.session.document.row(i));
    let single = Edit::Row { object: object.unwrap_or_default(), entry: None, what: "Single objects" };
    let single = command("single_objects", "Make single objects", Action::Edit(single));
    to.add(single.unless(row.is_none(), "The object is in no row"));
}

fn rows(to: &mut List) {
    let object = object_of_row(to);
    let row = object.and_then(|i| to.session.document.row(i));
    let part = object.map_or(Selection::Room, Selection::Object);
    let make = command("row", "Row…", Action::MakeRow(part))
        .says("Row or grid of the object")
        .keys("Ctrl+R")
        .rank(5);
    let make = make
        .tip("Copies of the object beside each other, edited as one; values may differ from copy to copy.");
    let make = make.unless(object.is_none(), "No object is selected");
    to.add(if row.is_some() { make.unless(true, "The object is in a row already") } else { make });
}

fn models(to: &mut List) {
    let model = |id: &'static str, name: &'static str, what| {
        command(id, name, Action::Model(what)).group(Group::CustomModels)
    };
    // From within a text of the panel Code, too, as those of that panel below.
    to.add(model("new_model", "New reflection model…", ModelCommand::New).keys("Ctrl+Shift+N").anywhere());
    let duplicate = model("duplicate_model", "Duplicate the model as a file…", ModelCommand::Duplicate);
    to.add(duplicate.keys("Ctrl+Shift+D").anywhere());
    let open = model("edit_model", "Open the model in an editor", ModelCommand::EditShown).keys("Ctrl+E");
    to.menu(Menu::new("Code"), |to| {
        let code =
            |id, name, what| command(id, name, Action::Code(what)).group(Group::CustomModels).anywhere();
        to.add(open);
        to.add(code("code", "Edit the code of the model", CodeCommand::Model).keys("Ctrl+Shift+E").at_desk());
        to.add(
            code("scene_code", "Edit the scene as JSON", CodeCommand::Scene).keys("Ctrl+Shift+J").at_desk(),
        );
        // That of the message on top.
        let kept = to.session.code.kept.last().map(|kept| kept.path.clone());
        let is_none = kept.is_none();
        let recover = CodeCommand::Recover(kept.unwrap_or_default());
        let go_on = code(CONTINUE, "Continue with unsaved text", recover).keys("Ctrl+Shift+R");
        to.add(go_on.tip(CONTINUE_TIP).at_desk().absent(is_none));
    });
    let export = Action::Do(Effect::Pick(Pick::ShaderFolder));
    to.add(command("export_shaders", "Export shaders for editing…", export).group(Group::CustomModels));
}
