//! Notices about glass: objects of solid models whose meshes are not solids, and smooth glass through which no light is
//! seen.

use bevy::ecs::prelude::*;

use crate::{
    explain::{
        dark_glass::dark_glass,
        solids::{Tested, thin},
    },
    panel::state::{Session, Severity},
    registry::Registry,
};

/// The sentences said so far that still hold.
#[derive(Debug, Default)]
pub(super) struct Said {
    thin: Vec<String>,
    is_dark: bool,
}

/// Reports, after changes of the document or the registry, objects that have come to be drawn as thin glass, and that no
/// light is seen through smooth glass any more.
pub(super) fn report_glass(
    mut session: ResMut<Session>,
    registry: Res<Registry>,
    mut tested: Local<Tested>,
    mut said: Local<Said>,
) {
    let scene = session.document.scene();
    let (thin, dark) = (thin(scene, &registry, &mut tested), dark_glass(scene, &registry));
    let is_dark = dark.is_some();
    let of_thin = thin.iter().filter(|new| !said.thin.contains(new));
    let news: Vec<_> = of_thin.chain(dark.iter().filter(|_| !said.is_dark)).cloned().collect();
    news.iter().for_each(|new| session.say(Severity::Warning, format!("{new}.")));
    *said = Said { thin, is_dark };
}
