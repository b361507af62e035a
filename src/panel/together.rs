//! What is selected together, as panels and marks need it in each frame.

use super::{prelude::*, state::Together};

/// The lights and objects that are selected together, made again whenever they change; `None` if they are not several, or
/// none has a position.
pub(super) fn together(ctx: &Context, session: &Session, registry: &Registry) -> Option<Together> {
    if !session.has_group() {
        return None;
    }
    let document = &session.document;
    let key = (document.revision(), session.selection, kept::Same(document.others().clone()));
    kept::of_key(ctx, Id::new("what is selected together"), key, || Together::of(session, registry))
}
