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
    let focused = ctx.memory(|memory| memory.focused());
    let writes = focused == Some(id);
    let finds = focused.is_some_and(|focused| super::finder::FIELDS.map(Id::new).contains(&focused));
    if !writes && !finds {
        return Vec::new();
    }
    let (mut actions, mut asked) = (Vec::new(), Vec::new());
    ctx.input_mut(|input| {
        for event in std::mem::take(&mut input.events) {
            match meant(&event, &typing, writes) {
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
    if !asked.is_empty() {
        kept::with(ctx, |typing: &mut Typing| typing.asked.extend(asked));
        ctx.request_repaint();
    }
    actions
}

/// The meaning of an event in the editor.
enum Meant {
    Itself,
    Text(String),
    Save,
    Ask(Ask),
}

/// `writes` says that the focus is in the text, and not in the bar to find.
fn meant(event: &Event, typing: &Typing, writes: bool) -> Meant {
    let Event::Key { key, pressed: true, modifiers, .. } = event else { return Meant::Itself };
    let is = |wanted: Modifiers| modifiers.matches_exact(wanted);
    let (plain, ctrl, shift) = (is(Modifiers::NONE), is(Modifiers::COMMAND), is(Modifiers::SHIFT));
    let offers = typing.offers && writes && plain;
    Meant::Ask(match key {
        Key::S | Key::Enter if ctrl => return Meant::Save,
        Key::F if ctrl => Ask::Find(false),
        Key::H if ctrl => Ask::Find(true),
        Key::F3 if plain || shift => Ask::Next(shift),
        Key::Enter if !writes && (plain || shift) => Ask::Next(shift),
        Key::Escape if typing.offers || typing.finds => Ask::Escape,
        Key::Space if writes && ctrl => Ask::Complete,
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
