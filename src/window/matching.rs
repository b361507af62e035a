//! Matches of the window: one at a time, beside it.

use bevy::ecs::prelude::*;

use super::background::Background;
use crate::{
    matching::{Match, MatchError, Request, What, match_view},
    panel::state::{Matching, Session},
    registry::Registry,
    scene::Scene,
};

/// The match that runs: of a view, on a scene.
#[derive(Debug, Default, Resource)]
pub(super) struct Matches(Background<usize, Ended>);

/// The scene on which a view was matched, and the outcome; `None` if the search broke off.
type Ended = (Scene, usize, What, Option<Result<Match, MatchError>>);

impl Matches {
    /// Begins a match and comes back at once. `wake` is called at each step.
    pub(super) fn begin(
        &self,
        (view, what, parameters): (usize, What, Vec<&'static str>),
        session: &Session,
        registry: &Registry,
        wake: impl Fn() + Send + 'static,
    ) {
        let (scene, registry) = ((*session.document).clone(), registry.clone());
        let same = scene.clone();
        // Pictures are compared as they are seen: from where the camera stands.
        let mut seen = scene.clone();
        seen.observer = session.facts.observer(seen.observer.field_of_view);
        self.0.begin(
            view,
            wake,
            move || (same, view, what, None),
            move |progress| {
                let request = Request { scene: &seen, view, what, parameters: &parameters };
                let outcome = match_view(&request, &registry, progress);
                (scene, view, what, Some(outcome))
            },
        );
    }

    /// Stops the match at its next step.
    pub(super) fn cancel(&self) {
        self.0.cancel();
    }

    /// Tells the panels how far it is; one that has ended is applied.
    pub(super) fn report(&self, session: &mut ResMut<Session>, registry: &Registry) {
        let running =
            self.0.running().map(|now| Matching { view: now.label, done: now.done, step: now.step });
        if session.facts.matching != running {
            session.bypass_change_detection().facts.matching = running;
        }
        if let Some((scene, view, what, outcome)) = self.0.take() {
            session.matched(&scene, (view, what), outcome, registry);
        }
    }
}
