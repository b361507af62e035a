//! Light that is not finite: the window says whose it is.

use bevy::ecs::prelude::*;

use crate::{
    explain::finite::{NotFinite, Scope, Tried, probe},
    panel::state::{Session, Severity},
    registry::Registry,
};

/// Tries what no test of this crate has tried, whenever the document or the registry changed, and reports what is new.
pub(super) fn report_light_that_is_not_finite(
    mut session: ResMut<Session>,
    registry: Res<Registry>,
    mut tried: Local<Tried>,
    mut known: Local<Vec<NotFinite>>,
) {
    let found = probe(session.document.scene(), &registry, Scope::Untested, &mut tried);
    if *known != found {
        for odd in found.iter().filter(|odd| !known.contains(odd)) {
            session.say(
                Severity::Warning,
                format!("{odd}. It is drawn black or white; the channel “Not a number” shows where."),
            );
        }
        *known = found;
    }
}
