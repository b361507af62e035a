//! Builder methods for declarations of light types: adding a field to [`Declaration`] does not break existing
//! declarations.

use super::{Declaration, Size};
use crate::shader::Source;

impl Declaration {
    /// A light type with an id, a name, and its twin in WGSL. By default it has neither position nor
    /// direction, and 1 lx.
    ///
    /// ```
    /// use lights_camera_models::{light::Declaration, shader::Source};
    /// const LAMP: Declaration = Declaration::new("lamp", "Lamp", Source::new("lamp.wgsl", "…"))
    ///     .summary("Shines downwards only.")
    ///     .at_position()
    ///     .candela(20.0, 200.0);
    /// assert_eq!((LAMP.unit, LAMP.has_position), ("cd", true));
    /// ```
    #[must_use]
    pub const fn new(id: &'static str, name: &'static str, wgsl: Source) -> Self {
        Self {
            id,
            name,
            summary: "",
            glyph: "●",
            has_position: false,
            has_direction: false,
            unit: "lx",
            default_intensity: 1.0,
            slider_max: 10.0,
            cone_parameter: None,
            sizes: &[],
            roll_parameter: None,
            equation: "",
            extent: false,
            wgsl,
        }
    }

    /// Sets a one-sentence summary.
    #[must_use]
    pub const fn summary(self, summary: &'static str) -> Self {
        Self { summary, ..self }
    }

    /// Sets the glyph for lists.
    #[must_use]
    pub const fn glyph(self, glyph: &'static str) -> Self {
        Self { glyph, ..self }
    }

    /// Adds a position.
    #[must_use]
    pub const fn at_position(self) -> Self {
        Self { has_position: true, ..self }
    }

    /// Adds a direction.
    #[must_use]
    pub const fn with_direction(self) -> Self {
        Self { has_direction: true, ..self }
    }

    /// Sets an intensity in candela, for lights with a position: the default, and the maximum of the slider.
    #[must_use]
    pub const fn candela(self, default: f32, slider_max: f32) -> Self {
        Self { unit: "cd", default_intensity: default, slider_max, ..self }
    }

    /// Sets an intensity in lux, for lights without a position: the default, and the maximum of the slider.
    #[must_use]
    pub const fn lux(self, default: f32, slider_max: f32) -> Self {
        Self { unit: "lx", default_intensity: default, slider_max, ..self }
    }

    /// Adds extent, with a luminance in cd/m²: the default, and the maximum of the slider.
    #[must_use]
    pub const fn luminance(self, default: f32, slider_max: f32) -> Self {
        Self { unit: "cd/m²", default_intensity: default, slider_max, extent: true, ..self }
    }

    /// Adds extent, keeping the unit.
    #[must_use]
    pub const fn with_extent(self) -> Self {
        Self { extent: true, ..self }
    }

    /// Sets an intensity that is a factor of the light's own output: the default, and the maximum of the slider.
    #[must_use]
    pub const fn factor(self, default: f32, slider_max: f32) -> Self {
        Self { unit: "×", default_intensity: default, slider_max, ..self }
    }

    /// Adds a cone, drawn as a gizmo; `parameter` names its half angle in degrees.
    #[must_use]
    pub const fn cone(self, parameter: &'static str) -> Self {
        Self { cone_parameter: Some(parameter), ..self }
    }

    /// Sets the sizes: numbers in metres that have handles in the picture, and determine the outline of a
    /// light with extent.
    ///
    /// ```
    /// use lights_camera_models::{light::{Declaration, Size}, shader::Source};
    /// const PANEL: Declaration = Declaration::new("panel", "Panel", Source::new("panel.wgsl", "…"))
    ///     .at_position()
    ///     .with_direction()
    ///     .luminance(10.0, 100.0)
    ///     .sizes(&[Size::Width("width"), Size::Height("height")])
    ///     .roll("roll");
    /// assert_eq!(PANEL.sizes[1].parameter(), "height");
    /// ```
    #[must_use]
    pub const fn sizes(self, sizes: &'static [Size]) -> Self {
        Self { sizes, ..self }
    }

    /// Adds a rotation about the direction, with a handle in the picture; `parameter` names the angle in
    /// degrees.
    #[must_use]
    pub const fn roll(self, parameter: &'static str) -> Self {
        Self { roll_parameter: Some(parameter), ..self }
    }

    /// Sets the equation of the light that arrives at a point.
    #[must_use]
    pub const fn equation(self, equation: &'static str) -> Self {
        Self { equation, ..self }
    }
}
