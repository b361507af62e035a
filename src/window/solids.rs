//! Notices about glass: objects of solid models whose meshes are not solids, and smooth glass through which no light is
//! seen.

use bevy::ecs::prelude::*;

use crate::{
    explain::{
        dark_glass::dark_glass,
        solids::{Tested, Thin, thin},
    },
    panel::state::{Session, Severity},
    registry::Registry,
};

/// Reports, after changes of the document or the registry, objects that have come to be drawn as thin glass.
pub(super) fn report_solids_drawn_thin(
    mut session: ResMut<Session>,
    registry: Res<Registry>,
    mut tested: Local<Tested>,
    mut known: Local<Vec<Thin>>,
) {
    let found = thin(session.document.scene(), &registry, &mut tested);
    if *known != found {
        for new in found.iter().filter(|thin| !known.contains(thin)) {
            session.say(Severity::Warning, format!("{new}."));
        }
        *known = found;
    }
}

/// Reports, after changes of the document or the registry, that no light is seen through smooth glass.
pub(super) fn report_dark_glass(
    mut session: ResMut<Session>,
    registry: Res<Registry>,
    mut known: Local<bool>,
) {
    let found = dark_glass(session.document.scene(), &registry);
    if let Some(new) = found.as_ref().filter(|_| !*known) {
        session.say(Severity::Warning, format!("{new}."));
    }
    *known = found.is_some();
}
