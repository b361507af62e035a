//! Builder methods for declarations of shading models: adding a field to [`Declaration`] does not break
//! existing declarations.

use super::{Declaration, Stage};
use crate::{declared::setters, shader::Source};

impl Declaration {
    /// A shading model with an id and a name, the stage that evaluates the reflection model, the key that selects it in
    /// the window, and its twin in WGSL.
    ///
    /// ```
    /// use lights_camera_models::{shader::Source, shading::{Declaration, Stage}};
    /// const NORMALS: Declaration =
    ///     Declaration::new("normals", "Normals", Stage::Pixel, 'N', Source::new("normals.wgsl", "…"))
    ///         .summary("The normal as a colour.");
    /// assert_eq!(NORMALS.key, 'N');
    /// ```
    #[must_use]
    pub const fn new(id: &'static str, name: &'static str, stage: Stage, key: char, wgsl: Source) -> Self {
        Self {
            id,
            name,
            author: "",
            source: "",
            summary: "",
            stage,
            faceted: matches!(stage, Stage::Polygon),
            key,
            wgsl,
        }
    }

    setters! {
        /// Sets author and year, in short, and the publication.
        published(author: &'static str, source: &'static str) { author, source }

        /// Sets the summary: the method and what to look for, in one or two sentences.
        summary(summary: &'static str) { summary }

        /// Makes normals those of polygons, also inside solid bodies, as they are with [`Stage::Polygon`] in any case.
        faceted() { faceted: true }
    }
}
