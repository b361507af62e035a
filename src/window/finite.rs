//! Warnings about non-finite light, with the model or light that causes it.

use bevy::ecs::prelude::*;

use crate::{
    explain::finite::{NotFinite, Scope, Tried, probe},
    panel::state::{Session, Severity},
    registry::Registry,
};

/// Checks, after changes of the document or the registry, everything that the tests of this crate do not cover, and
/// reports new findings.
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
