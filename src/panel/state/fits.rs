//! Fits to a measurement: of the model beside it, or of every model.

use super::{CompareCommand, Effect, Session, Severity};
use crate::{
    document::Selection,
    matching::{
        Measure, digits,
        each::{Matched, Ranking},
        parameters,
    },
    registry::Registry,
    scene::{
        Scene, Variant,
        variant::{LETTERS, MAX_VARIANTS},
    },
};

/// The message where nothing was measured.
const NOTHING: &str = "No view shows a measured surface. Give an object one of the measured reflection models, and choose its file.";

/// The fits of every model to a measurement, which the window lists.
#[derive(Clone, Debug, Default)]
pub struct Fits {
    /// The view with the measurement.
    pub view: usize,
    /// What is compared.
    pub measure: Measure,
    /// The fits; `None` while they are being found.
    pub ranking: Option<Ranking>,
    /// The model that was put into a view.
    pub shown: Option<&'static str>,
}

impl Session {
    fn is_measured(id: &str, registry: &Registry) -> bool {
        registry.model(id).is_some_and(|model| model.declaration.measured)
    }

    /// True if a view shows a measured surface.
    fn shows_measured(&self, view: usize, registry: &Registry) -> bool {
        let one = self.document.overrides(view).and_then(|variant| variant.reflection_model);
        let mut own = self.document.shown().map(|object| self.document.model_of(object));
        match &one {
            Some(id) => Self::is_measured(id, registry),
            None => own.any(|id| Self::is_measured(id, registry)),
        }
    }

    /// The first view that shows a measured surface.
    fn measurement(&self, registry: &Registry) -> Option<usize> {
        (0..=self.document.variants.len()).find(|view| self.shows_measured(*view, registry))
    }

    /// The measured objects of a view alone: the selected one, or all.
    #[must_use]
    pub fn to_fit(&self, view: usize, registry: &Registry) -> Scene {
        let mut scene =
            self.document.seen(view, registry).map_or_else(Scene::default, |(scene, _)| scene).alone();
        let measured: Vec<_> = scene
            .objects
            .iter()
            .map(|o| o.visible && Self::is_measured(scene.model_of(o), registry))
            .collect();
        let selected = match self.selection {
            Selection::Object(i) if measured.get(i) == Some(&true) => Some(i),
            _ => None,
        };
        for (i, object) in scene.objects.iter_mut().enumerate() {
            object.visible = measured[i] && selected.is_none_or(|selected| selected == i);
        }
        scene
    }

    /// Fits the model beside the measurement to it; every model if there is none.
    pub(super) fn fit(&mut self, registry: &Registry) {
        let Some(view) = self.measurement(registry) else { return self.say(Severity::Info, NOTHING) };
        if view > 0 {
            // A view is matched to view A.
            self.compare(CompareCommand::Swap(view), registry);
            if !self.shows_measured(0, registry) {
                return;
            }
        }
        let count = self.document.variants.len();
        let compared = if view > 0 { view } else { self.document.comparison.with };
        let other = [compared].into_iter().chain(1..=count);
        let other = other
            .filter(|view| (1..=count).contains(view))
            .find(|view| !self.shows_measured(*view, registry));
        let free = |view: &usize| -> Vec<_> {
            parameters(&self.document, *view, registry)
                .into_iter()
                .filter(|(_, usual)| *usual)
                .map(|(parameter, _)| parameter.name)
                .collect()
        };
        match other.map(|view| (view, free(&view))).filter(|(_, names)| !names.is_empty()) {
            Some((view, parameters)) => {
                self.request(Effect::Match { view, measure: Measure::default(), parameters });
            }
            None => self.fit_every(Measure::default(), registry),
        }
    }

    /// Fits every model to the measurement.
    pub(super) fn fit_every(&mut self, measure: Measure, registry: &Registry) {
        let Some(view) = self.measurement(registry) else { return self.say(Severity::Info, NOTHING) };
        self.fits = Some(Fits { view, measure, ..Fits::default() });
        self.request(Effect::MatchEvery { view, measure });
    }

    /// Handles the end of the fits of every model. `ranking` is `None` if the search crashed.
    pub fn ranked(
        &mut self,
        (view, measure): (usize, Measure),
        ranking: Option<Ranking>,
        registry: &Registry,
    ) {
        let Some(ranking) = ranking else {
            self.fits = None;
            return self.say(Severity::Error, "The models were not fitted: an internal error.");
        };
        let text = match ranking.matched.first() {
            None => "No model was fitted to the measurement.".to_owned(),
            Some(Matched { model, found }) => format!(
                "{} fitted to the measurement of view {}; {} comes nearest. Error: {} ({}).",
                crate::text::plural(ranking.matched.len(), "model"),
                LETTERS[view.min(MAX_VARIANTS)],
                registry.model(model).map_or(*model, |entry| entry.declaration.name),
                digits(found.after),
                measure.unit()
            ),
        };
        self.say(Severity::Info, text);
        self.fits = Some(Fits { view, measure, ranking: Some(ranking), shown: None });
    }

    /// Puts a fitted model into a view beside the measurement: view B, unless that has the measurement.
    pub(super) fn show_fit(&mut self, id: &str, registry: &Registry) {
        let Some(fits) = &mut self.fits else { return };
        let found =
            fits.ranking.iter().flat_map(|ranking| &ranking.matched).find(|matched| matched.model == id);
        let (Some(Matched { model, found }), Some(entry)) = (found, registry.model(id)) else { return };
        fits.shown = Some(*model);
        let mut all = self.document.variants.clone();
        let place = (0..MAX_VARIANTS).find(|i| i + 1 != fits.view).unwrap_or_default();
        // What view A has set is for its model.
        let mut variant = all.get(place).cloned().unwrap_or_default();
        variant.reflection_model = Some(id.to_owned());
        variant.material = crate::parameter::Values::default();
        for p in entry.parameters {
            let value = found.values.iter().find(|(name, _)| *name == p.name).map(|(_, value)| value.clone());
            variant.material.set(p.name, value.unwrap_or_else(|| p.default_value()));
        }
        if place < all.len() {
            all[place] = variant;
        } else {
            all.push(Variant { based_on: None, ..variant });
        }
        let with = if fits.view == 0 { place + 1 } else { fits.view };
        self.show_views(all, with, self.document.comparison.layout, "Show a fit", registry);
        self.look(registry);
    }
}
