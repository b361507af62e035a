//! The editor: files of shaders and custom models, and the scene as JSON, in tabs of a panel at the bottom.
//!
//! It is egui's own text field with our layout. The crate `egui_code_editor` (0.4.2 fits our egui, later ones do not)
//! would save the gutter and some of the colours, but it clones and hashes the layout of the whole text in every
//! frame, lays line numbers out as a second text field, colours by lists of words, so that a declaration in a comment
//! is grey, has no place for marks at lines or for help, and brings another way to open links.
//!
//! A text is written as an editor of one's own would write it, and the watcher then loads it. While it is
//! typed, a thread checks it after a short rest.

use std::{collections::HashMap, sync::Mutex, time::Duration};

use super::{
    kept::Answers,
    prelude::*,
    state::{CodeCommand, CodeOf, OpenCode, Theirs},
};
use crate::{caught::lock, library::status::Reloaded, parameter::Parameter};
use check::{Checked, Given, Mark};
use layout::Layouts;
use steps::Steps;
use tokens::Language;
use words::{Offer, Vocabulary};

mod bars;
pub mod check;
pub mod difference;
pub(super) mod disk;
pub mod find;
mod finder;
mod keyboard;
mod layout;
mod offering;
mod steps;
mod surface;
pub mod tokens;
pub mod words;

pub use disk::open_new;

pub(super) use keyboard::keys;

/// Rest after which a text is checked, seconds.
const PAUSE: f64 = 0.35;
/// Rest after which the scene as JSON follows the document, seconds.
const REST: f64 = 0.3;

/// See the module.
pub(super) struct CodePanel {
    /// The text of the field, and the text of the session that it equals.
    buffer: String,
    same: Option<(u64, Arc<str>)>,
    layouts: Layouts,
    /// The steps of undoing of each open text, by its number.
    steps: HashMap<u64, Steps>,
    finder: finder::Finder,
    /// The document that the scene as JSON shows, and when it was first seen.
    followed: Option<(crate::document::Revision, f64)>,
    /// The byte of the cursor, and the other end of the selection.
    cursor: [usize; 2],
    /// The place of the cursor on the screen.
    cursor_at: Rect,
    /// True if the cursor is to be brought into sight.
    reveals: bool,
    checks: Mutex<Answers<Question, Checked>>,
    /// The latest outcome.
    checked: Option<(Question, Checked)>,
    /// The text that was typed last, and when.
    typed_at: Option<(u64, Arc<str>, f64)>,
    /// The parameters that the text declared when that could last be read.
    parameters: Option<(u64, &'static [Parameter])>,
    vocabulary: Option<(Option<Reloaded>, Vocabulary)>,
    offer: Option<Offering>,
    /// The difference that was shown last.
    difference: Option<bars::Known>,
}

impl Default for CodePanel {
    fn default() -> Self {
        Self {
            buffer: String::new(),
            same: None,
            layouts: Layouts::default(),
            steps: HashMap::new(),
            finder: finder::Finder::default(),
            followed: None,
            cursor: [0; 2],
            cursor_at: Rect::NOTHING,
            reveals: false,
            checks: Mutex::default(),
            checked: None,
            typed_at: None,
            parameters: None,
            vocabulary: None,
            offer: None,
            difference: None,
        }
    }
}

/// The words that are offered.
struct Offering {
    offer: Offer,
    chosen: usize,
    /// True if the user has asked for them or walked through them: Enter then takes one.
    wanted: bool,
}

/// What a check is about: the text, and the shaders that it may import.
#[derive(Clone, PartialEq)]
struct Question {
    number: u64,
    text: Arc<str>,
    since: Option<Reloaded>,
}

/// The note on its tab: texts with unsaved changes.
pub(super) fn note(session: &Session) -> Option<(Severity, String)> {
    session.has_unsaved_code().then(|| (Severity::Info, "●".to_owned()))
}

/// The language of a text.
fn language(open: &OpenCode) -> Language {
    match open.of {
        CodeOf::Scene => Language::Json,
        CodeOf::File(_) => Language::Wgsl,
    }
}

impl CodePanel {
    /// Shows the panel.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let session = context.session();
        self.follow(ui, context);
        bars::tabs(ui, context);
        let Some(open) = session.code.visible() else {
            keyboard::forget(ui.ctx());
            return bars::nothing(ui, context);
        };
        self.take_in(ui.ctx(), open, session);
        bars::conflict(ui, open, context);
        if open.shows_difference
            && let Some(Theirs::Changed(theirs)) = &open.theirs
        {
            return bars::difference(ui, &mut self.difference, &open.text, theirs);
        }
        self.check(ui.ctx(), open, context);
        self.field(ui, open, context);
    }

    /// Checks the text once it rests.
    fn check(&mut self, ctx: &Context, open: &OpenCode, context: &PanelContext<'_>) {
        let now = ctx.input(|input| input.time);
        let is_known =
            |known: &(u64, Arc<str>, f64)| known.0 == open.number && Arc::ptr_eq(&known.1, &open.text);
        if !self.typed_at.as_ref().is_some_and(is_known) {
            // A text that has just been opened rests already.
            let fresh = self.typed_at.as_ref().is_none_or(|known| known.0 != open.number);
            let since = if fresh { f64::NEG_INFINITY } else { now };
            self.typed_at = Some((open.number, open.text.clone(), since));
        }
        let Some((.., since)) = self.typed_at else { return };
        if now - since < PAUSE {
            return ctx.request_repaint_after(Duration::from_secs_f64(PAUSE - (now - since)));
        }
        let (session, registry) = (context.session(), context.registry());
        let question =
            Question { number: open.number, text: open.text.clone(), since: session.shaders.last.clone() };
        let mut checks = lock(&self.checks);
        checks.ask(ctx, &question, Duration::ZERO, || {
            let given = Given::new(open, session, registry);
            Some(move || given.check())
        });
        if let Some((question, checked)) = &checks.shown
            && self.checked.as_ref().is_none_or(|(known, _)| known != question)
        {
            self.checked = Some((question.clone(), checked.clone()));
            if let Some(parameters) = checked.parameters {
                self.parameters = Some((question.number, parameters));
            }
        }
    }

    /// The errors of the text: those found while it is typed, and those of its file that only drawing shows.
    fn marks(&self, open: &OpenCode, session: &Session) -> Vec<Mark> {
        let found = self.checked.as_ref().filter(|(question, _)| question.number == open.number);
        let mut all = found.map(|(_, checked)| checked.marks.clone()).unwrap_or_default();
        if all.is_empty() && !open.is_unsaved() {
            all = check::drawn(open, session);
        }
        all
    }

    fn parameters(&self, open: &OpenCode) -> &'static [Parameter] {
        self.parameters.filter(|(number, _)| *number == open.number).map_or(&[], |(_, all)| all)
    }

    /// The words, made anew when the shaders have changed.
    fn vocabulary(&mut self, context: &PanelContext<'_>) -> &Vocabulary {
        let last = &context.session().shaders.last;
        if self.vocabulary.as_ref().is_none_or(|(since, _)| since != last) {
            self.vocabulary = Some((last.clone(), Vocabulary::of(context.registry())));
        }
        &self.vocabulary.get_or_insert_with(|| (None, Vocabulary::of(context.registry()))).1
    }

    /// Lets the scene as JSON follow the document, once that rests.
    fn follow(&mut self, ui: &Ui, context: &mut PanelContext<'_>) {
        let session = context.session();
        if session.code.of(&CodeOf::Scene).is_none() {
            self.followed = None;
            return;
        }
        let (now, revision) = (ui.input(|input| input.time), session.document.revision());
        match self.followed {
            Some((known, since)) if known == revision => {
                if since.is_finite() && now - since >= REST && !session.document.in_gesture() {
                    context.act(Action::Code(CodeCommand::Follow));
                    self.followed = Some((revision, f64::INFINITY));
                } else if since.is_finite() {
                    ui.ctx().request_repaint_after(Duration::from_secs_f64(REST));
                }
            }
            _ => {
                self.followed = Some((revision, now));
                ui.ctx().request_repaint_after(Duration::from_secs_f64(REST));
            }
        }
    }
}
