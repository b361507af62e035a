//! The keyboard: one table, which the handler, the menus and the list of keys (F1) all read.

use bevy_egui::egui::{self, Key, Modifiers};
use glam::Vec3;

use super::{
    focus,
    state::{
        Action, CompareCommand, HandleChange, LessonCommand, ModelCommand, PLOTS_TAB, PictureArea,
        PictureCommand, SHADER_TAB, Session, Steer, ViewChange,
    },
};
use crate::{channel::DebugChannel, registry::Registry, scene::Comparison};

/// The heading of the keys that steer the camera; with the focus in a panel they are the panel's.
const CAMERA: &str = "Camera";
/// The heading of the keys of the handles in the picture.
const HANDLES: &str = "Handles";
/// One press turns by so much, degrees.
const TURN: f32 = 5.0;

/// A key and what it does.
#[derive(Clone, Debug)]
pub struct Binding {
    /// Ctrl (⌘ on a Mac) must be held.
    pub ctrl: bool,
    /// Shift must be held.
    pub shift: bool,
    /// Alt must be held.
    pub alt: bool,
    /// The key.
    pub key: Key,
    /// The heading in the list of keys.
    pub group: &'static str,
    /// Its action.
    pub label: String,
    /// The action.
    pub action: Action,
}

impl Binding {
    /// Its usual spelling: `Ctrl+Shift+S`.
    #[must_use]
    pub fn keys(&self) -> String {
        let ctrl = match (self.ctrl, cfg!(target_os = "macos")) {
            (true, true) => "Cmd+",
            (true, false) => "Ctrl+",
            (false, _) => "",
        };
        let key = match self.key {
            Key::Equals | Key::Plus => "+",
            Key::Minus => "−",
            key => key.name(),
        };
        let alt = if self.alt { "Alt+" } else { "" };
        format!("{ctrl}{alt}{}{key}", if self.shift { "Shift+" } else { "" })
    }

    fn matches(&self, key: Key, modifiers: Modifiers) -> bool {
        let plus = |k: Key| matches!(k, Key::Plus | Key::Equals);
        let same_key = key == self.key || (plus(key) && plus(self.key));
        // `+` needs Shift on many keyboards and none on others.
        let shift = plus(self.key) || modifiers.shift == self.shift;
        same_key && shift && modifiers.command == self.ctrl && modifiers.alt == self.alt
    }

    /// True if it works while text is being typed.
    fn while_typing(&self) -> bool {
        (self.ctrl && matches!(self.group, "File" | "Window"))
            || matches!(self.key, Key::F1 | Key::F5 | Key::F11)
    }
}

/// All keys, in the order of the list.
#[must_use]
pub fn bindings(session: &Session, registry: &Registry) -> Vec<Binding> {
    let mut all = Vec::new();
    let mut add = |group, ctrl, shift, key, label: &str, action| {
        all.push(Binding { ctrl, shift, alt: false, key, group, label: label.to_owned(), action });
    };
    add("File", true, false, Key::N, "New default scene", Action::New);
    add("File", true, false, Key::O, "Open…", Action::OpenDialog);
    add("File", true, false, Key::S, "Save", Action::Save);
    add("File", true, true, Key::S, "Save as…", Action::SaveAsDialog);
    add("File", true, false, Key::P, "Save the picture…", Action::Picture(PictureCommand::Dialog(None)));
    add("File", true, true, Key::P, "Copy the picture", Action::Picture(PictureCommand::Copy(None)));
    add("File", true, false, Key::Q, "Quit", Action::Quit);
    add("Edit", true, false, Key::Z, "Undo", Action::Undo);
    add("Edit", true, true, Key::Z, "Redo", Action::Redo);
    add("Edit", true, false, Key::Y, "Redo", Action::Redo);
    add("Edit", true, false, Key::D, "Duplicate", Action::Duplicate(session.selection));
    add("Edit", false, false, Key::Delete, "Delete", Action::Remove(session.selection));
    let toggle = "Hide or show the object, switch the light off or on";
    add("Edit", false, false, Key::V, toggle, Action::Toggle(session.selection));
    add("Edit", false, false, Key::F2, "Rename", Action::BeginRename(session.selection));
    for shading in registry.shading_models() {
        let d = shading.declaration;
        if let Some(key) = Key::from_name(&d.key.to_string()) {
            let label = format!("{} shading", d.name);
            add(
                "Reflection and shading",
                false,
                false,
                key,
                &label,
                Action::Edit(session.edit_shading_model(d.id)),
            );
        }
    }
    let chooser = Action::View(ViewChange::Chooser(!session.view.chooser_open));
    add("Reflection and shading", false, false, Key::R, "Choose a reflection model", chooser);
    const DIGITS: [Key; 9] =
        [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];
    for (slot, key) in DIGITS.into_iter().enumerate() {
        let label = match session.model_slots.get(slot) {
            Some(id) => registry.model(id).map_or(id.as_str(), |m| m.declaration.name).to_owned(),
            None => continue,
        };
        add("Reflection and shading", false, false, key, &label, Action::RecentModel(slot));
    }
    add("Reflection and shading", false, false, Key::T, "Next term of the equation alone", Action::NextTerms);
    let channel = |channel| Action::View(ViewChange::Channel(channel));
    let next = DebugChannel::next(session.channel_of(session.active()));
    add("Picture", false, false, Key::X, "Next debug channel: normals, N·L, depth, …", channel(next));
    add("Picture", false, true, Key::X, "No debug channel: the picture", channel(None));
    add("Custom models", true, true, Key::N, "New reflection model…", Action::Model(ModelCommand::New));
    add(
        "Custom models",
        true,
        true,
        Key::D,
        "Duplicate the model as a file…",
        Action::Model(ModelCommand::Duplicate),
    );
    add(
        "Custom models",
        true,
        false,
        Key::E,
        "Open the model in an editor",
        Action::Model(ModelCommand::EditShown),
    );
    let compare = |command: CompareCommand| Action::Compare(command);
    add("Comparison", true, false, Key::B, "Add a view", compare(CompareCommand::Add));
    add("Comparison", true, false, Key::L, "Next layout", compare(CompareCommand::NextLayout));
    add(
        "Comparison",
        false,
        false,
        Key::Space,
        "Blink: the other view while held",
        compare(CompareCommand::Blink(true)),
    );
    let next = (session.active() + 1) % (session.document.variants.len() + 1);
    add("Comparison", true, false, Key::K, "Next view", compare(CompareCommand::Activate(next)));
    let comparison = session.document.comparison;
    for (key, label, step) in [
        (Key::Comma, "Edge of the wipe left or up", -0.02),
        (Key::Period, "Edge of the wipe right or down", 0.02),
    ] {
        let split = (comparison.split + step).clamp(0.0, 1.0);
        add(
            "Comparison",
            false,
            false,
            key,
            label,
            compare(CompareCommand::Set(Comparison { split, ..comparison })),
        );
    }
    add("Picture", false, false, Key::Tab, "Next object", Action::SelectNext);
    add("Picture", false, true, Key::Tab, "Previous object", Action::SelectPrevious);
    add(
        "Picture",
        false,
        false,
        Key::E,
        "Explain the pixel at the pointer; again: let go of it",
        Action::Pin,
    );
    let lobe = Action::View(ViewChange::Lobe(session.view.lobe.next()));
    add("Picture", false, true, Key::E, "Lobe at the explained point: linear, logarithmic, off", lobe);
    add("Picture", false, false, Key::H, "Home: the observer's view", Action::HomeView);
    add("Picture", false, false, Key::C, "Focus selection", Action::FocusSelection);
    let side = "Look at the pinned point from the side: its vectors N and L face on";
    add("Picture", false, true, Key::H, side, Action::LookFromSide);
    add("Picture", false, false, Key::Plus, "Brighter by ½ EV", Action::Expose(0.5));
    add("Picture", false, false, Key::Minus, "Darker by ½ EV", Action::Expose(-0.5));
    for (shift, key, label, steer) in [
        (false, Key::ArrowLeft, "Turn left about what is looked at", Steer::Turn(-TURN, 0.0)),
        (false, Key::ArrowRight, "Turn right", Steer::Turn(TURN, 0.0)),
        (false, Key::ArrowUp, "Turn up", Steer::Turn(0.0, TURN)),
        (false, Key::ArrowDown, "Turn down", Steer::Turn(0.0, -TURN)),
        (true, Key::ArrowLeft, "Move left", Steer::Move(-1.0, 0.0)),
        (true, Key::ArrowRight, "Move right", Steer::Move(1.0, 0.0)),
        (true, Key::ArrowUp, "Move up", Steer::Move(0.0, 1.0)),
        (true, Key::ArrowDown, "Move down", Steer::Move(0.0, -1.0)),
        (false, Key::PageUp, "Nearer", Steer::Zoom(0.9)),
        (false, Key::PageDown, "Farther", Steer::Zoom(1.0 / 0.9)),
    ] {
        add(CAMERA, false, shift, key, label, Action::Steer(steer));
    }
    let mode = HandleChange::Mode(session.view.handles.next());
    let mode = Action::View(ViewChange::Handles(mode));
    add(HANDLES, false, false, Key::F3, "Next handles: move, turn, size", mode);
    for (key, label, way) in [
        (Key::ArrowLeft, "Nudge the selection along −x, to the left", Vec3::NEG_X),
        (Key::ArrowRight, "Along x, to the right", Vec3::X),
        (Key::ArrowUp, "Along −z, into the room", Vec3::NEG_Z),
        (Key::ArrowDown, "Along z, out of the room", Vec3::Z),
        (Key::PageUp, "Along y, up", Vec3::Y),
        (Key::PageDown, "Along −y, down", Vec3::NEG_Y),
    ] {
        add(HANDLES, true, false, key, label, Action::Nudge(way));
    }
    let size = [
        (Key::Plus, "Everything larger", ViewChange::Larger),
        (Key::Minus, "Everything smaller", ViewChange::Smaller),
        (Key::Num0, "Everything at 100 %", ViewChange::Scale(100)),
    ];
    for (key, label, change) in size {
        add("Window", true, false, key, label, Action::View(change));
    }
    let presenting = Action::View(ViewChange::Presenting(!session.view.presenting));
    add("Window", false, false, Key::F5, "Presentation; Esc leaves it", presenting);
    let fullscreen = Action::View(ViewChange::Fullscreen(!session.view.fullscreen));
    add("Window", false, false, Key::F11, "Full screen", fullscreen);
    add(
        "Window",
        false,
        false,
        Key::F1,
        "This list",
        Action::View(ViewChange::Keys(!session.view.keys_open)),
    );
    add("Window", false, false, Key::F8, "Messages", Action::View(session.strip_change()));
    let tab = |id: &str| {
        let open = session.view.bottom_open && session.view.bottom_tab == id;
        Action::View(if open { ViewChange::Bottom(false) } else { ViewChange::BottomTab(id.to_owned()) })
    };
    add("Window", false, false, Key::F7, "Plots: curves of the model", tab(PLOTS_TAB));
    add("Window", false, false, Key::F9, "Shader: files and errors", tab(SHADER_TAB));
    let steps = [
        (Key::ArrowRight, "Next step", LessonCommand::Next),
        (Key::ArrowLeft, "Previous step", LessonCommand::Previous),
    ];
    all.extend(steps.map(|(key, label, command)| Binding {
        ctrl: false,
        shift: false,
        alt: true,
        key,
        group: "Lessons",
        label: label.to_owned(),
        action: Action::Lesson(command),
    }));
    // Remote controls of lecturers send these.
    if session.view.presenting && session.lesson.is_some() {
        for binding in all.iter_mut().filter(|binding| !binding.ctrl) {
            match binding.key {
                Key::PageDown => binding.action = Action::Lesson(LessonCommand::Next),
                Key::PageUp => binding.action = Action::Lesson(LessonCommand::Previous),
                _ => continue,
            }
            binding.group = "Lessons";
        }
    }
    all
}

/// Actions of the mouse, and keys that belong to a widget: for the list.
pub const ELSEWHERE: &[(&str, &str, &str)] = &[
    ("Window", "F6, Shift+F6", "To the next panel, to the one before; Tab moves on within it, Esc leaves"),
    ("Window", "F10, Alt and a letter", "The menus; arrows walk, Enter chooses"),
    ("In the scene list", "↑ ↓", "Select the part above, the one below"),
    (
        "Lessons",
        "Page Up, Page Down",
        "Scroll the text, with the focus in the lesson; in a presentation: the steps",
    ),
    ("In a field", "↑ ↓", "A little more, a little less; with Shift ten times that"),
    ("In a field", "Enter, Esc", "Keep the value; go back to the one before"),
    ("On a slider", "← →", "A little less, a little more; Home and End: the ends"),
    ("On a slider", "double-click", "The default; Backspace does it too"),
    (
        "In the plots",
        "← →",
        "Move the light or the reading by 1°, with Shift by 10°; Tab goes from one to the other",
    ),
    ("Mouse in the picture", "left drag", "Turn about what is looked at"),
    ("Mouse in the picture", "right drag", "Move sideways; Shift and left drag does it too"),
    ("Mouse in the picture", "wheel", "Nearer, farther"),
    ("Mouse in the picture", "click", "Select"),
    ("Mouse in the picture", "Alt and click", "Explain the pixel; again: let go of it, as Esc does"),
    ("Mouse in the picture", "drag of a handle", "Move, turn, resize; with Ctrl in steps, Esc takes it back"),
];

/// The usual spelling of the key of an action: for menus.
#[must_use]
pub fn keys_of(bindings: &[Binding], action: &Action) -> String {
    bindings.iter().find(|b| b.action == *action).map(Binding::keys).unwrap_or_default()
}

/// True if Escape was pressed and nothing that is open over the picture takes it.
pub(super) fn escapes(ctx: &egui::Context, session: &Session, area: &PictureArea) -> bool {
    let open = session.view.chooser_open
        || session.view.keys_open
        || session.view.about_open
        || session.draft.is_some();
    let free = area.has_keys && !open && !egui::Popup::is_any_open(ctx);
    free && ctx.input(|i| i.key_pressed(Key::Escape))
}

/// Reads the keys that were pressed. Call before the widgets see them.
#[must_use]
pub fn pressed(ctx: &egui::Context, session: &Session, registry: &Registry) -> Vec<Action> {
    if session.questions.open.is_some() {
        return Vec::new();
    }
    let typing = ctx.text_edit_focused();
    let focused = ctx.memory(|m| m.focused());
    let popup = egui::Popup::is_any_open(ctx);
    let table = bindings(session, registry);
    let mut actions = Vec::new();
    let mut stop_tab = false;
    let mut panels = None;
    ctx.input_mut(|input| {
        input.events.retain(|event| {
            let egui::Event::Key { key, pressed: true, modifiers, .. } = event else { return true };
            if *key == Key::F6 {
                panels = Some(modifiers.shift);
                return false;
            }
            let Some(binding) = table.iter().find(|b| b.matches(*key, *modifiers)) else { return true };
            if (typing || popup) && !binding.while_typing() {
                return true;
            }
            // With the focus in a panel, Delete is the panel's: nobody means to remove the object that
            // a slider belongs to.
            if (matches!(key, Key::Delete | Key::Space) || binding.group == CAMERA) && focused.is_some() {
                return true;
            }
            // With the focus in a panel, Tab moves it on.
            if *key == Key::Tab {
                if focused.is_some() {
                    return true;
                }
                stop_tab = true;
            }
            actions.push(binding.action.clone());
            false
        });
        // A letter that is a command is no text.
        if !actions.is_empty() && !typing {
            input.events.retain(|e| !matches!(e, egui::Event::Text(_)));
        }
    });
    if stop_tab {
        ctx.memory_mut(|m| m.move_focus(egui::FocusDirection::None));
    }
    if let Some(back) = panels {
        focus::next_region(ctx, back);
    }
    actions
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Edit;

    #[test]
    fn no_key_does_two_things() {
        let table = bindings(&Session::default(), &Registry::builtin());
        for (i, a) in table.iter().enumerate() {
            for b in &table[..i] {
                assert!(a.keys() != b.keys(), "{} does “{}” and “{}”", a.keys(), a.label, b.label);
            }
        }
    }

    #[test]
    fn the_letters_that_shading_models_must_leave_alone_are_those_of_other_actions() {
        let registry = Registry::builtin();
        let shading: Vec<_> =
            registry.shading_models().iter().map(|s| s.declaration.key.to_string()).collect();
        let table = bindings(&Session::default(), &registry);
        let letter = |b: &&Binding| !b.ctrl && !b.shift && b.key.name().len() == 1;
        let letters = table.iter().filter(letter).map(|b| b.key.name().to_owned());
        let letters = letters.filter(|l| l.chars().all(|c| c.is_ascii_uppercase()) && !shading.contains(l));
        let mut letters: Vec<_> = letters.collect();
        letters.sort();
        assert_eq!(letters, crate::registry::WINDOW_KEYS.iter().map(char::to_string).collect::<Vec<_>>());
    }

    #[test]
    fn every_shading_mode_has_its_key() {
        let registry = Registry::builtin();
        let table = bindings(&Session::default(), &registry);
        for shading in registry.shading_models() {
            let edit = Action::Edit(Edit::ShadingModel(shading.declaration.id.to_owned()));
            assert_eq!(keys_of(&table, &edit), shading.declaration.key.to_string());
        }
    }
}
