//! The keyboard: the keys of commands as they are pressed and as texts name them.

use std::{collections::BTreeMap, ops::DerefMut, sync::LazyLock};

use super::{
    command::{self, Command, Group, own},
    kept::Same,
    menu, modal,
    prelude::*,
    settings,
    state::{Replaced, Shortcut},
};

/// A key and its command.
#[derive(Clone, Debug)]
pub struct Binding {
    /// The key.
    pub shortcut: Shortcut,
    /// The heading in the list of keys.
    pub group: Group,
    /// The action, in words.
    pub label: String,
    /// The action.
    pub action: Action,
    /// True if it works while text is typed, unless it is text itself.
    anywhere: bool,
}

impl Binding {
    fn of(shortcut: Shortcut, path: &[&str], command: &Command) -> Self {
        Self {
            shortcut,
            group: command.heading(),
            label: command.in_list(path),
            action: command.by_key.as_ref().unwrap_or(&command.action).clone(),
            anywhere: command.anywhere,
        }
    }

    /// The usual spelling: `Ctrl+Shift+S`.
    #[must_use]
    pub fn keys(&self) -> String {
        self.shortcut.to_string()
    }

    /// True if it works while text is being typed.
    fn while_typing(&self) -> bool {
        let Shortcut { ctrl, alt, key, .. } = self.shortcut;
        let is_text = !ctrl && !alt && !is_function_key(key);
        (ctrl && matches!(self.group, Group::File | Group::Window)) || (self.anywhere && !is_text)
    }

    /// True if it is the panel's while something in a panel has the focus: nobody means to remove the object that a
    /// slider belongs to, or to turn the camera by the arrows that move it.
    fn yields_to_widgets(&self) -> bool {
        use Key::{ArrowDown, ArrowLeft, ArrowRight, ArrowUp, Backspace, Delete, End, Home, Space};
        let of_widgets = [Space, Delete, Backspace, Home, End, ArrowLeft, ArrowRight, ArrowUp, ArrowDown];
        let plain = !self.shortcut.ctrl && !self.shortcut.alt;
        self.group == Group::Camera || plain && of_widgets.contains(&self.shortcut.key)
    }
}

fn is_function_key(key: Key) -> bool {
    key.name().len() > 1 && key.name().strip_prefix('F').is_some_and(|n| n.parse::<u8>().is_ok())
}

/// All keys, in the order of the list.
#[must_use]
pub fn bindings(session: &Session, registry: &Registry) -> Vec<Binding> {
    let root = command::all(session, registry, false);
    let all = command::with_keys(&root);
    let each = all.iter().flat_map(|(path, command)| {
        command.keys.iter().map(|shortcut| Binding::of(*shortcut, path, command))
    });
    each.collect()
}

/// Actions of the mouse, and keys that belong to a widget: for the list.
pub static ELSEWHERE: LazyLock<Vec<(&str, &str, &str)>> = LazyLock::new(|| {
    let columns = |line: &'static str| {
        let (group, rest) = line.split_once('\t')?;
        rest.split_once('\t').map(|(key, label)| (group, key, label))
    };
    include_str!("../../assets/text/keys.tsv").lines().filter_map(columns).collect()
});

/// True if Escape was pressed and nothing that is open over the picture takes it.
pub(super) fn escapes(ctx: &Context, session: &Session, area: &PictureArea) -> bool {
    let open = session.view.chooser_open
        || session.view.finder_open
        || session.view.keys_open
        || session.view.about_open;
    let free = area.has_keys && !open && !Popup::is_any_open(ctx);
    free && ctx.input(|i| i.key_pressed(Key::Escape))
}

/// Checks the keys that the user gave to commands, once, and reports what is wrong with them and with the default ones.
pub(super) fn check(session: &mut impl DerefMut<Target = Session>, registry: &Registry) {
    if session.keys.checked.is_some() {
        return;
    }
    let given = session.settings.keys.clone();
    let root = command::declared(session, registry, true, !given.is_empty());
    let (own, problems) = if given.is_empty() { Default::default() } else { own::check(&given, &root) };
    let session = &mut **session;
    for why in root.commands().into_iter().flat_map(|(_, command)| &command.unreadable) {
        session.say(Severity::Error, why);
    }
    session.keys.checked = Some(Arc::new(own));
    let file = settings::file().map_or_else(|| "the settings".to_owned(), |path| path.shown().to_string());
    for problem in problems {
        session.say(Severity::Warning, format!("In {file}, {problem}"));
    }
}

/// The keys that tooltips and other texts name, by the ids of commands.
#[derive(Clone, Default)]
struct Named {
    /// Made from these own keys, so many shading models and so many panels.
    of: Option<(Option<Same<Replaced>>, usize, usize)>,
    keys: Arc<Names>,
}

/// Lets texts name the keys as they are now.
pub(super) fn remember(ctx: &Context, session: &Session, registry: &Registry) {
    let own = session.keys.checked.clone().map(Same);
    let of = Some((own, registry.shading_models().len(), session.panels.len()));
    if kept::with(ctx, |named: &mut Named| named.of == of) {
        return;
    }
    kept::set(ctx, Named { of, keys: Arc::new(names(session, registry)) });
}

/// The keys of commands and their titles, by the ids of commands.
type Names = BTreeMap<String, (Option<Shortcut>, String)>;

fn names(session: &Session, registry: &Registry) -> Names {
    let root = command::all(session, registry, false);
    let key = |(path, command): (Vec<&str>, &Command)| {
        (command.id.to_string(), (command.keys.first().copied(), command.title(&path)))
    };
    root.commands().into_iter().map(key).collect()
}

fn named(ctx: &Context, id: &str) -> Option<(Option<Shortcut>, String)> {
    kept::with(ctx, |named: &mut Named| named.keys.get(id).cloned())
}

/// The key of a command.
pub(super) fn of(ctx: &Context, id: &str) -> Option<Shortcut> {
    named(ctx, id)?.0
}

/// The key of a command as a sentence names it; without a key, the command.
pub(super) fn word(ctx: &Context, id: &str) -> String {
    match named(ctx, id) {
        Some((Some(key), _)) => key.to_string(),
        Some((None, name)) => format!("the command “{name}”"),
        None => String::new(),
    }
}

/// A text with the key of a command in brackets behind it, if it has one.
pub(super) fn hint(ctx: &Context, text: &str, id: &str) -> String {
    with_key(text, of(ctx, id))
}

fn with_key(text: &str, key: Option<Shortcut>) -> String {
    key.map_or_else(|| text.to_owned(), |key| format!("{text} ({})", key.with_signs()))
}

/// The keys that work beside the panels.
#[must_use]
pub fn hint_beside(session: &Session, registry: &Registry, text: &str, id: &str) -> String {
    with_key(text, names(session, registry).get(id).and_then(|(key, _)| *key))
}

/// What was typed since the finder was opened, until its field takes it.
#[derive(Clone, Default)]
struct Ahead {
    text: Option<String>,
    /// True if the finder was open in the last frame.
    open: bool,
}

/// The text that is for the field of the finder, which is not there yet; `None` if it is, or if the finder is closed.
fn ahead(ctx: &Context, session: &Session) -> Option<String> {
    let open = session.view.finder_open;
    kept::with(ctx, |known: &mut Ahead| {
        let opens = open && !std::mem::replace(&mut known.open, open);
        known.text.take().filter(|_| open).or_else(|| opens.then(String::new))
    })
}

/// What was typed while the finder opened, for its field; once.
pub(super) fn typed_ahead(ctx: &Context) -> Option<String> {
    kept::with(ctx, |known: &mut Ahead| known.text.take())
}

/// Reads the keys that were pressed. A dialog that `asks` has all of them. Call before the widgets see them.
#[must_use]
pub fn pressed(ctx: &Context, session: &Session, registry: &Registry, asks: bool) -> Vec<Action> {
    let any = ctx.input(|i| i.events.iter().any(modal::is_typed));
    let mut ahead = ahead(ctx, session);
    if !any && ahead.is_none() {
        return Vec::new();
    }
    let table = if asks { Vec::new() } else { bindings(session, registry) };
    ctx.input_mut(|input| drop_letters_with_alt(input, &table));
    if asks {
        return Vec::new();
    }
    let typing = ctx.text_edit_focused();
    let focused = ctx.memory(|m| m.focused());
    let taken = typing || session.view.finder_open || Popup::is_any_open(ctx);
    let (mut actions, mut waits) = (Vec::new(), Vec::new());
    let (mut stop_tab, mut may_ask) = (false, false);
    ctx.input_mut(|input| {
        input.events.retain(|event| {
            if may_ask && modal::is_typed(event) {
                waits.push(event.clone());
                return false;
            }
            if ahead.as_mut().is_some_and(|text| type_into(text, event)) {
                return false;
            }
            let egui::Event::Key { key, pressed: true, modifiers, .. } = event else { return true };
            let Some(binding) = table.iter().find(|b| b.shortcut.matches(*key, *modifiers)) else {
                return true;
            };
            let elsewhere = (taken || ahead.is_some()) && !binding.while_typing();
            if elsewhere || focused.is_some() && binding.yields_to_widgets() {
                return true;
            }
            // With the focus in a panel, Tab moves it on.
            if *key == Key::Tab {
                if focused.is_some() {
                    return true;
                }
                stop_tab = true;
            }
            if binding.action == Action::View(ViewChange::Finder(true)) {
                ahead = Some(String::new());
            }
            actions.push(binding.action.clone());
            may_ask = binding.action.may_ask();
            false
        });
        // A letter that is a command is no text.
        if !actions.is_empty() && !typing {
            input.events.retain(|e| !matches!(e, egui::Event::Text(_)));
        }
    });
    modal::wait(ctx, waits);
    kept::with(ctx, |known: &mut Ahead| known.text = ahead);
    if stop_tab {
        ctx.memory_mut(|m| m.move_focus(egui::FocusDirection::None));
    }
    // The widgets of this frame already know.
    actions.retain(|action| !menu::moves_focus(ctx, action));
    actions
}

/// Removes the letters typed with Alt, which open menus: they are no text, not even in a field. On a Mac they are, unless
/// a command has them.
fn drop_letters_with_alt(input: &mut egui::InputState, table: &[Binding]) {
    const MAC: bool = cfg!(target_os = "macos");
    let held = !MAC && input.modifiers.alt && !input.modifiers.ctrl;
    let events = &input.events;
    let is_with_alt = |at: Option<usize>| match events.get(at?)? {
        egui::Event::Key { key, pressed: true, modifiers, .. } => {
            let opens = || !MAC || table.iter().any(|binding| binding.shortcut.matches(*key, *modifiers));
            Some(modifiers.alt && !modifiers.ctrl && opens())
        }
        _ => None,
    };
    // A keyboard sends a letter before its key.
    let by_key = |at: usize| is_with_alt(Some(at + 1)).or_else(|| is_with_alt(at.checked_sub(1)));
    let is_dropped = |(at, event): (usize, &egui::Event)| {
        matches!(event, egui::Event::Text(_)) && by_key(at).unwrap_or(held)
    };
    let dropped: Vec<bool> = events.iter().enumerate().map(is_dropped).collect();
    let mut dropped = dropped.into_iter();
    input.events.retain(|_| !dropped.next().unwrap_or(false));
}

/// Types an event at the end of a text; false if it types nothing.
fn type_into(text: &mut String, event: &egui::Event) -> bool {
    match event {
        egui::Event::Text(typed) => text.push_str(typed),
        egui::Event::Key { key: Key::Backspace, pressed: true, .. } => _ = text.pop(),
        _ => return false,
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        lesson::shipped::LESSONS,
        panel::{Panels, state::LessonSource},
        scene::Variant,
    };

    /// A window with all panels.
    fn session() -> Session {
        let mut session = Session::default();
        session.panels = Panels::builtin().infos().collect();
        session
    }

    #[test]
    fn no_key_does_two_things() {
        let registry = Registry::builtin();
        let mut session = session();
        session.model_slots.fill(&registry);
        let check = |session: &Session| {
            let table = bindings(session, &registry);
            assert!(table.len() > 70, "{}", table.len());
            for (i, a) in table.iter().enumerate() {
                for b in &table[..i] {
                    let both = format!("{} does “{}” and “{}”", a.keys(), a.label, b.label);
                    assert!(!a.shortcut.clashes(b.shortcut), "{both}");
                }
            }
        };
        check(&session);
        // With two views, all that the finder knows, and the pages of a lesson in a presentation.
        session.document.amend(|scene| scene.variants.push(Variant::default()));
        session.view.finder_open = true;
        check(&session);
        session.begin_lesson(Arc::new(LESSONS[0].clone()), LessonSource::Shipped(0), &registry);
        session.view.presenting = true;
        check(&session);
        let page = Shortcut::read("PageDown").expect("a key");
        let table = bindings(&session, &registry);
        let turned = table.iter().find(|binding| binding.shortcut == page).map(|binding| &binding.action);
        assert_eq!(turned, Some(&Action::Lesson(LessonCommand::Next)));
    }

    #[test]
    fn the_letters_that_shading_models_must_leave_alone_are_those_of_other_actions() {
        let registry = Registry::builtin();
        let shading: Vec<_> =
            registry.shading_models().iter().map(|s| s.declaration.key.to_string()).collect();
        let table = bindings(&Session::default(), &registry);
        let letter = |s: &Shortcut| !s.ctrl && !s.shift && !s.alt && s.key.name().len() == 1;
        let letters = table.iter().map(|b| b.shortcut).filter(letter).map(|s| s.key.name().to_owned());
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
            let edit = Action::Edit(Session::default().edit_shading_model(shading.declaration.id));
            let binding = table.iter().find(|b| b.action == edit);
            assert_eq!(binding.map(Binding::keys), Some(shading.declaration.key.to_string()));
        }
    }

    /// The actions of these events, and what remains of these.
    fn read(ctx: &Context, session: &Session, events: Vec<egui::Event>) -> (Vec<Action>, Vec<egui::Event>) {
        let mut read = Default::default();
        let input = egui::RawInput { events, ..egui::RawInput::default() };
        let _ = ctx.run_ui(input, |ui| {
            let actions = pressed(ui.ctx(), session, &Registry::builtin(), false);
            read = (actions, ui.ctx().input(|i| i.events.clone()));
        });
        read
    }

    #[test]
    fn what_is_typed_while_the_finder_opens_is_for_its_field() {
        let key = |key, modifiers| egui::Event::Key {
            key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers,
        };
        let letter = |k: Key| [egui::Event::Text(k.name().to_lowercase()), key(k, egui::Modifiers::NONE)];
        let texts = |events: &[egui::Event]| events.iter().any(|e| matches!(e, egui::Event::Text(_)));
        let ctx = Context::default();
        let mut session = session();
        // Keys of shading models and of others, which act without the finder.
        let (actions, left) = read(&ctx, &session, letter(Key::H).to_vec());
        assert!(actions.len() == 1 && !texts(&left), "{actions:?}, {left:?}");
        let mut events = vec![key(Key::F, egui::Modifiers::COMMAND)];
        events.extend([Key::H, Key::E].into_iter().flat_map(letter));
        let (actions, left) = read(&ctx, &session, events);
        assert_eq!(actions, [Action::View(ViewChange::Finder(true))], "the frame with its key");
        assert!(!texts(&left), "{left:?}");
        session.view.finder_open = true;
        let mut events: Vec<_> = [Key::X, Key::X, Key::C].into_iter().flat_map(letter).collect();
        events.insert(4, key(Key::Backspace, egui::Modifiers::NONE));
        let (actions, left) = read(&ctx, &session, events);
        assert!(actions.is_empty() && !texts(&left), "before its field is there: {actions:?}, {left:?}");
        assert_eq!(typed_ahead(&ctx).as_deref(), Some("hexc"));
        // Then its field takes what is typed, no letter acts, and its key closes it.
        let (actions, left) = read(&ctx, &session, letter(Key::H).to_vec());
        assert!(actions.is_empty() && texts(&left), "{actions:?}, {left:?}");
        assert_eq!(typed_ahead(&ctx), None);
        let (actions, _) = read(&ctx, &session, vec![key(Key::F, egui::Modifiers::COMMAND)]);
        assert_eq!(actions, [Action::View(ViewChange::Finder(false))]);
    }
}
