//! The state of the open document besides its scene and file; a lesson sets it aside with the document.

use super::{ModelSlots, OnDisk, Plots, StashedValues, Travels};

/// The state of the open document besides its scene and file.
#[derive(Clone, Debug, Default)]
pub struct Desk {
    /// State of the document's file on disk.
    pub disk: OnDisk,
    /// Values of the document that no model accepts at present.
    pub(in crate::panel) stashed: StashedValues,
    /// The ways of objects through models, on which their materials go along.
    pub(in crate::panel) travels: Travels,
    /// Display options of the plots.
    pub plots: Plots,
    /// The models that keys 1–9 choose.
    pub model_slots: ModelSlots,
}

impl Desk {
    /// The desk of a document with this reflection model.
    pub(super) fn with(model: &str) -> Self {
        let mut desk = Self::default();
        desk.model_slots.take(model);
        desk
    }
}
