//! Matches of the window: one at a time, in the background.

use bevy::ecs::prelude::*;

use super::background::Background;
use crate::{
    matching::{
        Match, MatchError, Measure, Request,
        each::{Ranking, candidates, match_each},
        match_view,
    },
    panel::state::Session,
    registry::Registry,
    scene::Scene,
};

/// The running match of a view, labelled with the view, and the fits of every model.
#[derive(Debug, Default, Resource)]
pub(super) struct Matches(Background<usize, Ended>, Background<(), Ranked>);

/// The view with the measurement, what is compared, and the fits; `None` if the search crashed.
type Ranked = (usize, Measure, Option<Ranking>);

/// The scene in which a view was matched, and the outcome; `None` if the search crashed.
type Ended = (Scene, usize, Measure, Option<Result<Match, MatchError>>);

impl Matches {
    /// Starts a match and returns at once. Calls `wake` at each step.
    pub(super) fn begin(
        &self,
        (view, measure, parameters): (usize, Measure, Vec<&'static str>),
        session: &Session,
        registry: &Registry,
        wake: impl Fn() + Send + 'static,
    ) {
        let (scene, registry) = ((*session.document).clone(), registry.clone());
        let broken = (scene.clone(), view, measure, None);
        // Pictures are compared as seen from the current camera.
        let mut seen = scene.clone();
        seen.observer = session.facts.observer(seen.observer);
        self.0.begin(view, wake, broken, move |progress| {
            let request = Request { scene: &seen, view, measure, parameters: &parameters };
            let outcome = match_view(&request, &registry, progress).and_then(Match::unless_interrupted);
            (scene, view, measure, Some(outcome))
        });
    }

    /// Starts to fit every model to the measurement of a view.
    pub(super) fn begin_every(
        &self,
        (view, measure): (usize, Measure),
        session: &Session,
        registry: &Registry,
        wake: impl Fn() + Send + 'static,
    ) {
        let (scene, registry) = (session.to_fit(view, registry), registry.clone());
        self.1.begin((), wake, (view, measure, None), move |progress| {
            let ranking = match_each(&scene, candidates(&registry), measure, &registry, progress);
            (view, measure, Some(ranking))
        });
    }

    /// Stops all of them.
    pub(super) fn cancel(&self) {
        self.0.cancel();
        self.1.cancel();
    }

    /// Reports the progress to the panels, and applies a finished match.
    pub(super) fn report(&self, session: &mut ResMut<Session>, registry: &Registry) {
        let facts = &mut session.bypass_change_detection().facts;
        (facts.matching, facts.ranking) = (self.0.running(), self.1.running());
        if let Some((view, measure, ranking)) = self.1.take() {
            session.ranked((view, measure), ranking, registry);
        }
        if let Some((scene, view, measure, outcome)) = self.0.take() {
            session.matched(&scene, (view, measure), outcome, registry);
        }
    }
}
