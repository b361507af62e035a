//! The document and the scene that is shown follow each other.

use bevy::ecs::prelude::*;

use crate::{
    panel::state::{Session, Severity},
    registry::Registry,
    render::{entities::CurrentScene, plugin::ShownTerms},
};

/// The document goes into the scene that is shown.
pub(super) fn publish(session: Res<Session>, mut scene: ResMut<CurrentScene>, mut terms: ResMut<ShownTerms>) {
    if session.document != scene.0 {
        scene.0 = session.document.scene().clone();
    }
    terms.set_if_neq(ShownTerms(session.view.terms));
}

/// Submits changes of the entities to the document; those that it refuses go back.
pub(super) fn take_over(
    mut scene: ResMut<CurrentScene>,
    registry: Res<Registry>,
    mut session: ResMut<Session>,
) {
    if scene.is_changed() && session.document != scene.0 {
        if let Err(why) = session.submit(scene.0.clone(), &registry) {
            session.say(Severity::Warning, why);
        }
        if session.document != scene.0 {
            scene.0 = session.document.scene().clone();
        }
    }
}
