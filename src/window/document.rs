//! The document and the scene that is shown follow each other.

use bevy::ecs::prelude::*;

use crate::{
    panel::state::{Session, Severity},
    registry::Registry,
    render::{
        entities::{CurrentScene, SceneEntities},
        exchange::Changes,
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
    for refused in entities.refused() {
        session.say(Severity::Warning, refused.clone());
    }
    let Some(changes) = entities.changed_by_others(&session.document, &scene) else { return };
    let answer = match &changes {
        Changes::Values(parts) => session.submit(&scene.0, parts, &registry),
        Changes::Lists(removed) => session.submit_lists(&scene.0, removed, &registry),
    };
    entities.settle(&changes, answer.is_ok(), &session.document, &mut scene);
    if let Err(why) = answer {
        session.say(Severity::Warning, why);
    }
}
