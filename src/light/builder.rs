//! Builder methods for declarations of light types: adding a field to [`Declaration`] does not break existing
//! declarations.

use super::{Declaration, Size};
use crate::{declared::setters, shader::Source};

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

    setters! {
        /// Sets a one-sentence summary.
        summary(summary: &'static str) { summary }

        /// Sets the glyph for lists.
        glyph(glyph: &'static str) { glyph }

        /// Adds a position.
        at_position() { has_position: true }

        /// Adds a direction.
        with_direction() { has_direction: true }

        /// Sets an intensity in candela, for lights with a position: the default, and the maximum of the slider.
        candela(default: f32, slider_max: f32) { unit: "cd", default_intensity: default, slider_max }

        /// Sets an intensity in lux, for lights without a position: the default, and the maximum of the slider.
        lux(default: f32, slider_max: f32) { unit: "lx", default_intensity: default, slider_max }

        /// Adds extent, with a luminance in cd/m²: the default, and the maximum of the slider.
        luminance(default: f32, slider_max: f32) { unit: "cd/m²", default_intensity: default, slider_max, extent: true }

        /// Adds extent, keeping the unit.
        with_extent() { extent: true }

        /// Sets an intensity that is a factor of the light's own output: the default, and the maximum of the slider.
        factor(default: f32, slider_max: f32) { unit: "×", default_intensity: default, slider_max }

        /// Adds a cone, drawn as a gizmo; `parameter` names its half angle in degrees.
        cone(parameter: &'static str) { cone_parameter: Some(parameter) }

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
        sizes(sizes: &'static [Size]) { sizes }

        /// Adds a rotation about the direction, with a handle in the picture; `parameter` names the angle in
        /// degrees.
        roll(parameter: &'static str) { roll_parameter: Some(parameter) }

        /// Sets the equation of the light that arrives at a point.
        equation(equation: &'static str) { equation }
    }
}
