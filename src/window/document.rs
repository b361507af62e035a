//! The document and the scene that is shown follow each other.

use bevy::ecs::prelude::*;

use crate::{
    panel::state::{Session, Severity},
    registry::Registry,
    render::{
        entities::{CurrentScene, SceneEntities},
        illumination::ShownTerms,
    },
};

/// The document goes into the scene that is shown.
pub(super) fn publish(
    session: Res<Session>,
    scene: ResMut<CurrentScene>,
    mut entities: ResMut<SceneEntities>,
    mut terms: ResMut<ShownTerms>,
) {
    entities.show(&session.document, scene);
    terms.set_if_neq(ShownTerms(session.view.terms));
}

/// Submits changes of the entities to the document; those that it refuses go back.
pub(super) fn take_over(
    mut scene: ResMut<CurrentScene>,
    mut entities: ResMut<SceneEntities>,
    registry: Res<Registry>,
    mut session: ResMut<Session>,
) {
    let parts = entities.changed_by_others(&session.document, &scene);
    if parts.is_empty() {
        return;
    }
    if let Err(why) = session.submit(&scene.0, &parts, &registry) {
        session.say(Severity::Warning, why);
        scene.0.clone_from(session.document.scene());
    }
    entities.agree(&session.document, &scene);
}
