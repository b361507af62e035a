//! Builder methods for declarations of object types: adding a field to [`Declaration`] does not break
//! existing declarations.

use std::ops::RangeInclusive;

use super::Declaration;
use crate::declared::setters;

impl Declaration {
    /// An object type with an id, a name, and a single tessellation.
    ///
    /// ```
    /// use lights_camera_models::shape::Declaration;
    /// const PRISM: Declaration =
    ///     Declaration::new("prism", "Prism").summary("A column.").tessellation(3..=64, 6, "Its sides.");
    /// assert_eq!(PRISM.default_tessellation, 6);
    /// ```
    #[must_use]
    pub const fn new(id: &'static str, name: &'static str) -> Self {
        Self {
            id,
            name,
            summary: "",
            glyph: "■",
            open: "",
            tessellation_help: "It is always 1.",
            tessellation: 1..=1,
            default_tessellation: 1,
        }
    }

    setters! {
        /// Sets a one-sentence summary of the shape and its use.
        summary(summary: &'static str) { summary }

        /// Sets the glyph for lists.
        glyph(glyph: &'static str) { glyph }

        /// Sets the reason why the mesh is not closed, for solid models: "its parts pass into each other".
        open(open: &'static str) { open }

        /// Sets the range of tessellations, and the meaning of the number.
        tessellation(range: RangeInclusive<u32>, default: u32, help: &'static str) { tessellation: range, default_tessellation: default, tessellation_help: help }
    }
}
