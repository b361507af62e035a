//! Matches of the window: one at a time, in the background.

use bevy::ecs::prelude::*;

use super::background::Background;
use crate::{
    matching::{Match, MatchError, Request, What, match_view},
    panel::state::Session,
    registry::Registry,
    scene::Scene,
};

/// The running match of a view, labelled with the view.
#[derive(Debug, Default, Resource)]
pub(super) struct Matches(pub(super) Background<usize, Ended>);

/// The scene in which a view was matched, and the outcome; `None` if the search crashed.
type Ended = (Scene, usize, What, Option<Result<Match, MatchError>>);

impl Matches {
    /// Starts a match and returns at once. Calls `wake` at each step.
    pub(super) fn begin(
        &self,
        (view, what, parameters): (usize, What, Vec<&'static str>),
        session: &Session,
        registry: &Registry,
        wake: impl Fn() + Send + 'static,
    ) {
        let (scene, registry) = ((*session.document).clone(), registry.clone());
        let broken = (scene.clone(), view, what, None);
        // Pictures are compared as seen from the current camera.
        let mut seen = scene.clone();
        seen.observer = session.facts.observer(seen.observer);
        self.0.begin(view, wake, broken, move |progress| {
            let request = Request { scene: &seen, view, what, parameters: &parameters };
            let outcome = match_view(&request, &registry, progress);
            (scene, view, what, Some(outcome))
        });
    }

    /// Reports the progress to the panels, and applies a finished match.
    pub(super) fn report(&self, session: &mut ResMut<Session>, registry: &Registry) {
        session.bypass_change_detection().facts.matching = self.0.running();
        if let Some((scene, view, what, outcome)) = self.0.take() {
            session.matched(&scene, (view, what), outcome, registry);
        }
    }
}
