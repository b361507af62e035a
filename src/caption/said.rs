//! The differences between the views of a scene.

use crate::scene::{Scene, Variant};

/// The facts that the heading of a view gives instead of the caption around it.
#[derive(Clone, Debug, Default)]
pub(super) struct Said {
    /// The overridden fields, with the values of any view.
    pub(super) over: Variant,
    /// Also the non-default values, except colours: where models differ, they are part of what defines one.
    pub(super) values: bool,
    /// Also the non-default colours.
    pub(super) colours: bool,
}

impl Said {
    /// The facts that a view overrides; for view A, the scene itself, the facts that other views override.
    pub(super) fn of(scene: &Scene, view: usize) -> Self {
        let views = if view == 0 { 1..=scene.variants.len() } else { view..=view };
        let all = views.filter_map(|view| scene.overrides(view));
        let over = all.fold(Variant::default(), |known, variant| variant.over(&known));
        let values = view == 0 && over.reflection_model.is_some() && !over.material.0.is_empty();
        Self { over, values, colours: false }
    }

    /// The facts in the heading of a view: everything that any view overrides, unless this one overrides
    /// nothing.
    pub(super) fn in_heading(scene: &Scene, view: usize) -> Self {
        let own = Variant { name: None, ..scene.overrides(view).unwrap_or_default() };
        if view > 0 && own == Variant::default() { Self::default() } else { Self::of(scene, 0) }
    }
}
