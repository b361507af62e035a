//! Keys of the editor, which come before those of commands while its text has the focus.

use bevy_egui::egui::{Event, Modifiers};

use super::super::{
    prelude::*,
    state::{CODE_TAB, CodeCommand},
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
    /// The indentation of the line of the cursor.
    pub(super) indent: String,
    /// What the keys asked for.
    pub(super) asked: Vec<Ask>,
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
    let (mut actions, mut asked) = (Vec::new(), Vec::new());
    ctx.input_mut(|input| {
        for event in std::mem::take(&mut input.events) {
            match meant(&event, &typing, at) {
                Meant::Itself => input.events.push(event),
                Meant::Text(text) => input.events.push(Event::Text(text)),
                Meant::Save => actions.push(Action::Code(CodeCommand::Save)),
                Meant::Ask(ask) => asked.push(ask),
            }
        }
        // A space with Ctrl is no text.
        if asked.contains(&Ask::Complete) {
            input.events.retain(|event| !matches!(event, Event::Text(text) if text == " "));
        }
    });
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

/// The meaning of an event in the editor.
enum Meant {
    Itself,
    Text(String),
    Save,
    Ask(Ask),
}

fn meant(event: &Event, typing: &Typing, at: Focus) -> Meant {
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
        Key::Enter if writes && plain && !typing.indent.is_empty() => {
            return Meant::Text(format!("\n{}", typing.indent));
        }
        _ => return Meant::Itself,
    })
}
