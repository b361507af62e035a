//! Warnings about non-finite light, with the model or light that causes it: a message, and a badge in the picture.

use bevy::ecs::prelude::*;

use crate::{
    document::Selection,
    explain::finite::{NotFinite, Scope, Tried, probe},
    panel::state::{NoNumber, Session, Severity},
    registry::Registry,
};

/// Checks, after changes of the document or the registry, everything that the tests of this crate do not cover, in every
/// view, and reports new findings.
pub(super) fn report_light_that_is_not_finite(
    mut session: ResMut<Session>,
    registry: Res<Registry>,
    mut tried: Local<Tried>,
    mut known: Local<Vec<NoNumber>>,
) {
    let scene = session.document.scene();
    let mut found = session.facts.not_finite.clone();
    // Without models and lights from elsewhere there is nothing to try.
    let is_tested = registry.sources().edited().next().is_none() && !registry.has_foreign();
    for (view, found) in found.iter_mut().enumerate() {
        let odd = match view {
            _ if is_tested => Vec::new(),
            0 => probe(scene, &registry, Scope::Untested, &mut tried),
            _ => scene
                .seen(view, &registry)
                .map_or_else(Vec::new, |(seen, _)| probe(&seen, &registry, Scope::Untested, &mut tried)),
        };
        *found = odd.into_iter().filter_map(no_number).collect();
    }
    let mut all: Vec<NoNumber> = Vec::new();
    for odd in found.iter().flatten() {
        if all.contains(odd) {
            continue;
        }
        if !known.contains(odd) {
            let name = session.name_of(odd.part, &registry);
            let what = &odd.what;
            session.say(
                Severity::Warning,
                format!("{name} {what}. It is drawn black or white; the channel “Not a number” shows where."),
            );
        }
        all.push(odd.clone());
    }
    *known = all;
    if session.facts.not_finite != found {
        session.bypass_change_detection().facts.not_finite = found;
    }
}

fn no_number(odd: NotFinite) -> Option<NoNumber> {
    let light = odd.path.index_in("lights").map(Selection::Light);
    let part = light.or_else(|| odd.path.index_in("objects").map(Selection::Object))?;
    Some(NoNumber { part, what: odd.what })
}
