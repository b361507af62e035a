//! The differences between the views of a scene.

use std::collections::BTreeSet;

use crate::scene::{Scene, Variant};

/// The facts that the heading of a view gives instead of the caption around it.
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
    /// Also the non-default values, except colours: where models differ, they are part of what defines one.
    pub(super) values: bool,
    /// Also the non-default colours.
    pub(super) colours: bool,
}

impl Said {
    /// The facts that a view overrides; for view A, the scene itself, the facts that other views override.
    pub(super) fn of(scene: &Scene, view: usize) -> Self {
        let mut said = Self::default();
        let views = if view == 0 { 1..=scene.variants.len() } else { view..=view };
        views.filter_map(|view| scene.overrides(view)).for_each(|variant| said.add(&variant));
        said.values = view == 0 && said.model && !said.material.is_empty();
        said
    }

    /// The facts in the heading of a view: everything that any view overrides, unless this one overrides
    /// nothing.
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
