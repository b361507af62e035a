//! The editor: files of shaders and custom models, and the scene as JSON, in tabs of a panel at the bottom.
//!
//! It is egui's own text field with our layout. The crate `egui_code_editor` (0.4.2 fits our egui, later ones do not)
//! would save the gutter and some of the colours, but it clones and hashes the layout of the whole text in every
//! frame, lays line numbers out as a second text field, colours by lists of words, so that a declaration in a comment
//! is grey, has no place for marks at lines or for help, and brings another way to open links.
//!
//! A text is written as an editor of one's own would write it, and the watcher then loads it: see [`disk`]. While it is
//! typed, a thread checks it after a short rest.

use super::{
    prelude::*,
    state::{CodeCommand, CodeOf, OpenCode, Theirs},
};
use layout::Layouts;
use tokens::Language;

mod bars;
pub mod difference;
pub(super) mod disk;
pub mod find;
mod keyboard;
mod layout;
mod surface;
pub mod tokens;

pub(super) use keyboard::keys;

/// Rest after which the scene as JSON follows the document, seconds.
const REST: f64 = 0.3;

/// See the module.
#[derive(Default)]
pub(super) struct CodePanel {
    /// The text of the field, and the text of the session that it equals.
    buffer: String,
    same: Option<(u64, Arc<str>)>,
    layouts: Layouts,
    finder: bars::Finder,
    /// The document that the scene as JSON shows, and when it was first seen.
    followed: Option<(crate::document::Revision, f64)>,
    /// The byte of the cursor, and the other end of the selection.
    cursor: [usize; 2],
    /// True if the cursor is to be brought into sight.
    reveals: bool,
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
        if self
            .same
            .as_ref()
            .is_none_or(|(number, text)| *number != open.number || !Arc::ptr_eq(text, &open.text))
        {
            self.buffer = open.text.to_string();
            self.same = Some((open.number, open.text.clone()));
        }
        bars::conflict(ui, open, context);
        if open.shows_difference
            && let Some(Theirs::Changed(theirs)) = &open.theirs
        {
            return bars::difference(ui, &open.text, theirs);
        }
        self.field(ui, open, context);
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
                    ui.ctx().request_repaint_after(std::time::Duration::from_secs_f64(REST));
                }
            }
            _ => {
                self.followed = Some((revision, now));
                ui.ctx().request_repaint_after(std::time::Duration::from_secs_f64(REST));
            }
        }
    }
}
