//! Commands that stand in no menu: they have keys, and the finder knows them.

use glam::Vec3;

use super::{BAR, Command, Group, List, command};
use crate::{
    channel::DebugChannel,
    panel::state::{
        Action, CompareCommand, Effect, FocusMove, LessonCommand, MODEL_SLOTS, Steer, ViewChange,
    },
};

/// Angle of a turn by one press, degrees.
const TURN: f32 = 5.0;
/// Distance that one press moves the edge of a wipe, as a fraction of the picture.
const EDGE: f32 = 0.02;

pub(super) fn elsewhere(to: &mut List) {
    models(to);
    picture(to);
    comparison(to);
    camera(to);
    nudges(to);
    let lesson = |id: &'static str, name: &'static str, what| {
        command(id, name, Action::Lesson(what)).group(Group::Lessons)
    };
    let none = to.session.lesson.is_none();
    let next = lesson("next_step", "Next step", LessonCommand::Next).keys("Alt+Right");
    let previous = lesson("previous_step", "Previous step", LessonCommand::Previous).keys("Alt+Left");
    to.add(next.unless(none, "No lesson is open"));
    to.add(previous.unless(none, "No lesson is open"));
    focus(to);
}

fn models(to: &mut List) {
    let (session, registry) = (to.session, to.registry);
    let of_models = |command: Command| command.group(Group::Reflection);
    for d in registry.shading_models().iter().map(|shading| shading.declaration) {
        let action = Action::Edit(session.edit_shading_model(d.id));
        let shading = command(format!("shading.{}", d.id), format!("{} shading", d.name), action);
        to.add(of_models(shading).keys(&d.key.to_string()).tip(d.summary));
    }
    let chooser = Action::View(ViewChange::Chooser(!session.view.chooser_open));
    to.add(of_models(command("choose_model", "Choose a reflection model", chooser)).keys("R"));
    for slot in 0..MODEL_SLOTS {
        let id = session.model_slots.get(slot);
        let name = id.map_or("", |id| registry.model(id).map_or(id.as_str(), |m| m.declaration.name));
        let number = (slot + 1).to_string();
        let recent = command(format!("recent_model.{number}"), name.to_owned(), Action::RecentModel(slot));
        to.add(of_models(recent).keys(&number).absent(id.is_none()));
    }
    to.add(of_models(command("next_term", "Next term of the equation alone", Action::NextTerms)).keys("T"));
}

fn picture(to: &mut List) {
    let session = to.session;
    let next = DebugChannel::next(session.channel_of(session.active()));
    let next = Action::View(ViewChange::Channel(next));
    let channels = "Next debug channel: normals, N·L, depth, …";
    to.add(command("next_channel", channels, next).keys("X").rank(-1));
    to.add(command("next_object", "Next object", Action::SelectNext).keys("Tab"));
    to.add(command("previous_object", "Previous object", Action::SelectPrevious).keys("Shift+Tab"));
    let explain = "Explain the pixel at the pointer; again: let go of it";
    to.add(command("explain", explain, Action::Pin).keys("E"));
    let lobe = Action::View(ViewChange::Lobe(session.view.lobe.next()));
    let name = "Lobe at the explained point: linear, logarithmic, off";
    to.add(command("next_lobe", name, lobe).keys("Shift+E"));
    to.add(command("brighter", "Brighter by ½ EV", Action::Expose(0.5)).keys("+").rank(1));
    to.add(command("darker", "Darker by ½ EV", Action::Expose(-0.5)).keys("−").rank(1));
}

fn comparison(to: &mut List) {
    let compare = |id: &'static str, name: &'static str, what| {
        command(id, name, Action::Compare(what)).group(Group::Comparison)
    };
    let session = to.session;
    to.add(compare("next_layout", "Next layout", CompareCommand::NextLayout).keys("Ctrl+L"));
    let blink = compare("blink", "Blink: the other view while held", CompareCommand::Blink(true));
    to.add(Command { held: true, ..blink.keys("Space") });
    let views = session.document.variants.len() + 1;
    let next = CompareCommand::Activate((session.active() + 1) % views);
    to.add(
        compare("next_view", "Next view", next).keys("Ctrl+K").unless(views == 1, "There is only one view"),
    );
    let now = session.document.comparison;
    let other = views == 1 || !now.layout.has_edge();
    for (id, key, name, step) in [
        ("edge_back", "Comma", "Edge of the wipe left or up", -EDGE),
        ("edge_on", "Period", "Edge of the wipe right or down", EDGE),
    ] {
        let moved = now.with_split(now.split + step);
        let set = compare(id, name, CompareCommand::Set(moved)).keys(key);
        to.add(set.unless(other, "The views are not compared by a wipe"));
    }
}

fn camera(to: &mut List) {
    for (id, keys, name, steer) in [
        ("turn_left", "Left", "Turn left about what is looked at", Steer::Turn(-TURN, 0.0)),
        ("turn_right", "Right", "Turn right", Steer::Turn(TURN, 0.0)),
        ("turn_up", "Up", "Turn up", Steer::Turn(0.0, TURN)),
        ("turn_down", "Down", "Turn down", Steer::Turn(0.0, -TURN)),
        ("move_left", "Shift+Left", "Move left", Steer::Move(-1.0, 0.0)),
        ("move_right", "Shift+Right", "Move right", Steer::Move(1.0, 0.0)),
        ("move_up", "Shift+Up", "Move up", Steer::Move(0.0, 1.0)),
        ("move_down", "Shift+Down", "Move down", Steer::Move(0.0, -1.0)),
        ("nearer", "PageUp", "Nearer", Steer::Zoom(0.9)),
        ("farther", "PageDown", "Farther", Steer::Zoom(1.0 / 0.9)),
    ] {
        to.add(command(id, name, Action::Do(Effect::Steer(steer))).keys(keys).group(Group::Camera));
    }
}

fn nudges(to: &mut List) {
    for (id, keys, name, row, way) in [
        ("left", "Left", "to the left", "Nudge the selection along −x, to the left", Vec3::NEG_X),
        ("right", "Right", "to the right", "Along x, to the right", Vec3::X),
        ("in", "Up", "into the room", "Along −z, into the room", Vec3::NEG_Z),
        ("out", "Down", "out of the room", "Along z, out of the room", Vec3::Z),
        ("up", "PageUp", "up", "Along y, up", Vec3::Y),
        ("down", "PageDown", "down", "Along −y, down", Vec3::NEG_Y),
    ] {
        let name = format!("Nudge the selection {name}");
        let nudge = command(format!("nudge_{id}"), name, Action::Nudge(way)).row(row);
        to.add(nudge.keys(&format!("Ctrl+{keys}")).group(Group::Handles).rank(1));
    }
}

/// The keyboard focus: panels and menus. Their keys are the last of the window's.
fn focus(to: &mut List) {
    let to_focus = |command: Command| command.group(Group::Window).rank(2).anywhere();
    let next = command("next_panel", "Next panel", Action::Focus(FocusMove::NextPanel));
    to.add(to_focus(next).keys("F6"));
    let previous = command("previous_panel", "Previous panel", Action::Focus(FocusMove::PreviousPanel));
    to.add(to_focus(previous).keys("Shift+F6"));
    let first = command("menu_bar", "Menu bar", Action::Focus(FocusMove::Menu(BAR[0].1)));
    to.add(to_focus(first).keys("F10").at_desk());
    for (key, menu) in BAR {
        let id = format!("menu.{}", menu.to_lowercase());
        let open = command(id, format!("{menu} menu"), Action::Focus(FocusMove::Menu(menu)));
        to.add(to_focus(open).keys(key).at_desk());
    }
}
