//! Keys of the editor, which come before those of commands while its text has the focus.

use bevy_egui::egui::{Event, Modifiers};

use super::{
    super::{
        modal,
        prelude::*,
        state::{CODE_TAB, CodeCommand},
    },
    tokens::Language,
};

/// What a key asks of the panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ask {
    /// Find, or find and replace.
    Find(bool),
    /// Go to the next place found, or to the one before.
    Next(bool),
    /// Close what is open over the text.
    Escape,
    /// Offer words.
    Complete,
    /// Choose the entry of the offered words this far below.
    Choose(isize),
    /// Insert the chosen word.
    Accept,
    /// Undo a step of the text.
    Undo,
    /// Do it again.
    Redo,
}

/// The text field as the keys need to know it.
#[derive(Clone, Debug, Default)]
pub(super) struct Typing {
    /// The field.
    pub(super) id: Option<Id>,
    /// True while words are offered.
    pub(super) offers: bool,
    /// True if Enter takes one of them.
    pub(super) takes_enter: bool,
    /// True while the bar to find is open.
    pub(super) finds: bool,
    /// The widgets of that bar.
    pub(super) bar: Vec<Id>,
    /// The line of the cursor.
    pub(super) line: Line,
    /// What the keys asked for.
    pub(super) asked: Vec<Ask>,
}

/// What the keys need to know of the line of the cursor.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Line {
    /// The indentation of the next line.
    indent: String,
    /// Number of characters that a closing bracket takes away, if it is the first of the line.
    back: usize,
    /// True if the cursor is before the quote that ends a text.
    ends_text: bool,
}

impl Line {
    /// The line with these texts before and behind the cursor.
    pub(super) fn new(before: &str, behind: &str, language: Language, nothing_selected: bool) -> Self {
        let level = match language {
            Language::Wgsl => 4,
            Language::Json => 2,
        };
        let line = before.rsplit('\n').next().unwrap_or_default();
        let rest = line.trim_start_matches([' ', '\t']);
        let mut indent = line[..line.len() - rest.len()].to_owned();
        let is_open = line.trim_end().ends_with(['{', '[']);
        let spaces = line.chars().rev().take(level).take_while(|c| *c == ' ').count();
        let back = if line.ends_with('\t') { 1 } else { spaces };
        let back = if rest.is_empty() && nothing_selected { back } else { 0 };
        if is_open {
            indent.extend(std::iter::repeat_n(' ', level));
        }
        let (mut within, mut escaped) = (false, false);
        for c in line.chars() {
            within ^= c == '"' && !escaped;
            escaped = c == '\\' && !escaped;
        }
        let ends_text = within && !escaped && nothing_selected && behind.starts_with('"');
        Self { indent, back, ends_text }
    }
}

/// The editor is not in sight.
pub(super) fn forget(ctx: &Context) {
    kept::set(ctx, Typing::default());
}

/// Takes the keys of the editor out of the input. Call before the widgets see them.
pub(in crate::panel) fn keys(ctx: &Context, session: &Session) -> Vec<Action> {
    let typing: Typing = kept::get(ctx);
    let in_sight =
        session.view.bottom_open && session.view.bottom_tab == CODE_TAB && !session.view.presenting;
    let Some(id) = typing.id.filter(|_| in_sight && session.questions.open.is_none()) else {
        return Vec::new();
    };
    let Some(at) = focus(ctx, id, &typing.bar) else { return Vec::new() };
    let (mut actions, mut asked, mut waits) = (Vec::new(), Vec::new(), Vec::new());
    let mut typed = false;
    ctx.input_mut(|input| {
        for event in std::mem::take(&mut input.events) {
            // While frames are slow, several keys come in one.
            if typed && depends(&event, at) || !waits.is_empty() && follows(&event) {
                waits.push(event);
                continue;
            }
            typed |= changes(&event);
            match meant(&event, &typing, at) {
                Meant::Itself => input.events.push(event),
                Meant::Text(text) => input.events.push(Event::Text(text)),
                Meant::Over => input.events.push(press(Key::ArrowRight)),
                Meant::Back => {
                    input.events.extend((0..typing.line.back).map(|_| press(Key::Backspace)));
                    input.events.push(event);
                }
                Meant::Save => actions.push(Action::Code(CodeCommand::Save)),
                Meant::Ask(ask) => asked.push(ask),
            }
        }
        // A space with Ctrl is no text.
        if asked.contains(&Ask::Complete) {
            input.events.retain(|event| !matches!(event, Event::Text(text) if text == " "));
        }
    });
    modal::wait(ctx, waits);
    if asked.contains(&Ask::Escape) {
        ctx.memory_mut(|memory| memory.request_focus(id));
    }
    if !asked.is_empty() {
        kept::with(ctx, |typing: &mut Typing| typing.asked.extend(asked));
        ctx.request_repaint();
    }
    actions
}

/// The part of the editor that has the focus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Focus {
    Text,
    /// A field of the bar to find.
    Field,
    /// A button of that bar.
    Button,
}

/// The part of the editor that has the focus, or had it until Escape was pressed: egui takes the focus away by that key
/// before anything else sees it.
fn focus(ctx: &Context, text: Id, bar: &[Id]) -> Option<Focus> {
    let id = ctx.memory(|memory| {
        let own = || bar.iter().copied().chain([text]);
        memory.focused().or_else(|| own().find(|id| memory.had_focus_last_frame(*id)))
    })?;
    if id == text {
        return Some(Focus::Text);
    }
    let is_field = super::finder::FIELDS.map(Id::new).contains(&id);
    bar.contains(&id).then_some(if is_field { Focus::Field } else { Focus::Button })
}

/// A press of a key alone.
fn press(key: Key) -> Event {
    Event::Key { key, physical_key: None, pressed: true, repeat: false, modifiers: Modifiers::NONE }
}

/// True for what changes a text. A new line and an indentation are left out: held down, a key is not to lag behind.
fn changes(event: &Event) -> bool {
    match event {
        Event::Text(_) | Event::Paste(_) | Event::Cut | Event::Ime(_) => true,
        Event::Key { key, pressed: true, .. } => matches!(key, Key::Backspace | Key::Delete),
        _ => false,
    }
}

/// True for what depends on the text as the keys before it leave it, which is known in the next frame only. Not so Esc:
/// egui has taken the focus away by then.
fn depends(event: &Event, at: Focus) -> bool {
    let writes = at == Focus::Text;
    match event {
        Event::Text(text) => writes && matches!(text.as_str(), "}" | "]"),
        Event::Key { key: Key::Enter, pressed: true, .. } => true,
        Event::Key { key, pressed: true, modifiers, .. } => {
            writes && (*key == Key::Tab || modifiers.command && *key != Key::Escape)
        }
        _ => false,
    }
}

/// True for what comes after a key that waits.
fn follows(event: &Event) -> bool {
    let is_escape = matches!(event, Event::Key { key: Key::Escape, .. });
    !is_escape && (modal::is_typed(event) || matches!(event, Event::Cut | Event::Copy | Event::Ime(_)))
}

/// The meaning of an event in the editor.
enum Meant {
    Itself,
    /// It is itself, after a level of indentation is taken away.
    Back,
    /// The cursor steps over what is typed.
    Over,
    Text(String),
    Save,
    Ask(Ask),
}

fn meant(event: &Event, typing: &Typing, at: Focus) -> Meant {
    if let Event::Text(text) = event
        && at == Focus::Text
    {
        return match text.as_str() {
            "}" | "]" if typing.line.back > 0 => Meant::Back,
            "\"" if typing.line.ends_text => Meant::Over,
            _ => Meant::Itself,
        };
    }
    let Event::Key { key, pressed: true, modifiers, .. } = event else { return Meant::Itself };
    let is = |wanted: Modifiers| modifiers.matches_exact(wanted);
    let (plain, ctrl, shift) = (is(Modifiers::NONE), is(Modifiers::COMMAND), is(Modifiers::SHIFT));
    let writes = at == Focus::Text;
    let offers = typing.offers && writes && plain;
    Meant::Ask(match key {
        Key::S | Key::Enter if ctrl => return Meant::Save,
        Key::F if ctrl => Ask::Find(false),
        Key::H if ctrl => Ask::Find(true),
        Key::F3 if plain || shift => Ask::Next(shift),
        Key::Enter if at == Focus::Field && (plain || shift) => Ask::Next(shift),
        Key::Escape if plain && (typing.offers || typing.finds) => Ask::Escape,
        Key::Space if writes && ctrl => Ask::Complete,
        Key::Z if writes && ctrl => Ask::Undo,
        Key::Y if writes && ctrl => Ask::Redo,
        Key::Z if writes && is(Modifiers::COMMAND | Modifiers::SHIFT) => Ask::Redo,
        Key::ArrowDown if offers => Ask::Choose(1),
        Key::ArrowUp if offers => Ask::Choose(-1),
        Key::Tab if offers => Ask::Accept,
        Key::Enter if offers && typing.takes_enter => Ask::Accept,
        // Spaces, as in the shipped models.
        Key::Tab if writes && plain => return Meant::Text("    ".to_owned()),
        Key::Enter if writes && plain && !typing.line.indent.is_empty() => {
            return Meant::Text(format!("\n{}", typing.line.indent));
        }
        _ => return Meant::Itself,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_indented_as_the_one_before_and_a_level_more_after_a_bracket() {
        let indent = |before: &str, language| Line::new(before, "", language, true).indent.len();
        for (before, wgsl, json) in [
            ("", 0, 0),
            ("fn f() {", 4, 2),
            ("{\n  \"a\": [ ", 6, 4),
            ("{\n    let a = 1.0;", 4, 4),
            ("{\n    \n", 0, 0),
        ] {
            let all = [indent(before, Language::Wgsl), indent(before, Language::Json)];
            assert_eq!(all, [wgsl, json], "{before}");
        }
    }

    #[test]
    fn a_bracket_that_is_first_in_its_line_goes_a_level_back() {
        let back = |before: &str, language| Line::new(before, "", language, true).back;
        for (before, wgsl, json) in
            [("{\n        ", 4, 2), ("{\n ", 1, 1), ("{\n\t", 1, 1), ("{\n  x ", 0, 0), ("", 0, 0)]
        {
            assert_eq!(
                [back(before, Language::Wgsl), back(before, Language::Json)],
                [wgsl, json],
                "{before}"
            );
        }
        assert_eq!(Line::new("{\n    ", "", Language::Wgsl, false).back, 0, "it replaces what is selected");
    }

    #[test]
    fn a_quote_steps_over_that_which_ends_a_text() {
        let over = |before: &str, behind: &str| Line::new(before, behind, Language::Json, true).ends_text;
        assert!(over("{ \"na", "\": 1"));
        for (before, behind) in [("{ ", "\"name\""), ("{ \"na", "me\""), ("{ \"a\\", "\""), ("{ \"a\"", "\"")]
        {
            assert!(!over(before, behind), "{before}|{behind}");
        }
    }
}
