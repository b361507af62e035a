//! What differs between the views of a scene.

use std::collections::BTreeSet;

use crate::scene::{Scene, Variant};

/// The things that the heading of a view says, and the caption around it does not.
#[derive(Clone, Debug, Default)]
pub(super) struct Said {
    pub(super) model: bool,
    pub(super) shading: bool,
    pub(super) material: BTreeSet<String>,
    pub(super) terms: bool,
    pub(super) tone_mapping: bool,
    pub(super) exposure: bool,
    pub(super) encoding: bool,
    pub(super) tessellation: bool,
    /// Also the values that are not the defaults, colours apart: they make a model what it is where others have another.
    pub(super) values: bool,
    /// The colours among them too.
    pub(super) colours: bool,
}

impl Said {
    /// What a view overrides; of view A, the scene itself, what the others do.
    pub(super) fn of(scene: &Scene, view: usize) -> Self {
        let mut said = Self::default();
        let views = if view == 0 { 1..=scene.variants.len() } else { view..=view };
        views.filter_map(|view| scene.overrides(view)).for_each(|variant| said.add(&variant));
        said.values = view == 0 && said.model && !said.material.is_empty();
        said
    }

    /// What the heading of a view says: what any of them overrides, unless this one overrides nothing.
    pub(super) fn in_heading(scene: &Scene, view: usize) -> Self {
        let own = scene.overrides(view).unwrap_or_default();
        let nothing =
            Variant { name: own.name.clone(), based_on: own.based_on.clone(), ..Variant::default() };
        if view > 0 && own == nothing { Self::default() } else { Self::of(scene, 0) }
    }

    fn add(&mut self, variant: &Variant) {
        self.model |= variant.reflection_model.is_some();
        self.shading |= variant.shading_model.is_some();
        self.material.extend(variant.material.0.keys().map(|name| name.clone().into_owned()));
        self.terms |= variant.terms.is_some();
        self.tone_mapping |= variant.tone_mapping.is_some();
        self.exposure |= variant.exposure.is_some();
        self.encoding |= variant.encoding.is_some();
        self.tessellation |= variant.tessellation.is_some();
    }
}
