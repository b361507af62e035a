//! Notices about objects of solid models whose meshes are not solids.

use bevy::ecs::prelude::*;

use crate::{
    explain::solids::{Tested, Thin, thin},
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
