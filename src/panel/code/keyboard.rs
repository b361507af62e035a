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
    let finds = focused.is_some_and(|focused| super::bars::FIELDS.map(Id::new).contains(&focused));
    if !writes && !finds {
        return Vec::new();
    }
    let (mut actions, mut asked) = (Vec::new(), Vec::new());
    ctx.input_mut(|input| {
        for event in std::mem::take(&mut input.events) {
            let Event::Key { key, pressed: true, modifiers, .. } = event else {
                input.events.push(event);
                continue;
            };
            let is = |wanted: Modifiers| modifiers.matches_exact(wanted);
            let (plain, ctrl) = (is(Modifiers::NONE), is(Modifiers::COMMAND));
            let ask = match key {
                Key::S if ctrl => None,
                Key::Enter if ctrl => None,
                Key::F if ctrl => Some(Ask::Find(false)),
                Key::H if ctrl => Some(Ask::Find(true)),
                Key::F3 if plain => Some(Ask::Next(false)),
                Key::F3 if is(Modifiers::SHIFT) => Some(Ask::Next(true)),
                Key::Enter if finds && plain => Some(Ask::Next(false)),
                Key::Enter if finds && is(Modifiers::SHIFT) => Some(Ask::Next(true)),
                Key::Escape if typing.offers || typing.finds => Some(Ask::Escape),
                Key::Space if writes && ctrl => Some(Ask::Complete),
                Key::ArrowDown if typing.offers && plain => Some(Ask::Choose(1)),
                Key::ArrowUp if typing.offers && plain => Some(Ask::Choose(-1)),
                Key::Tab if typing.offers && writes && plain => Some(Ask::Accept),
                Key::Enter if typing.takes_enter && writes && plain => Some(Ask::Accept),
                // Space, as in the shipped models.
                Key::Tab if writes && plain => {
                    input.events.push(Event::Text("    ".to_owned()));
                    continue;
                }
                Key::Enter if writes && plain => {
                    match typing.indent.is_empty() {
                        true => input.events.push(event),
                        false => input.events.push(Event::Text(format!("\n{}", typing.indent))),
                    }
                    continue;
                }
                _ => {
                    input.events.push(event);
                    continue;
                }
            };
            match ask {
                Some(ask) => asked.push(ask),
                None => actions.push(Action::Code(CodeCommand::Save)),
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
