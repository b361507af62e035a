//! Declarations of light types, step by step: another field of [`Declaration`] changes none of them.

use super::{Declaration, Size};
use crate::shader::Source;

impl Declaration {
    /// A light type with an id and a name, and its twin in WGSL. It has neither position nor direction, and 1 lx.
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

    /// The same with one sentence about its behaviour.
    #[must_use]
    pub const fn summary(self, summary: &'static str) -> Self {
        Self { summary, ..self }
    }

    /// The same with a glyph for lists.
    #[must_use]
    pub const fn glyph(self, glyph: &'static str) -> Self {
        Self { glyph, ..self }
    }

    /// The same with a position.
    #[must_use]
    pub const fn at_position(self) -> Self {
        Self { has_position: true, ..self }
    }

    /// The same with a direction.
    #[must_use]
    pub const fn with_direction(self) -> Self {
        Self { has_direction: true, ..self }
    }

    /// The same with an intensity in candela, as lights with a position have: the default, and the end of the slider.
    #[must_use]
    pub const fn candela(self, default: f32, slider_max: f32) -> Self {
        Self { unit: "cd", default_intensity: default, slider_max, ..self }
    }

    /// The same with an intensity in lux, as lights without a position have: the default, and the end of the slider.
    #[must_use]
    pub const fn lux(self, default: f32, slider_max: f32) -> Self {
        Self { unit: "lx", default_intensity: default, slider_max, ..self }
    }

    /// The same with extent, and its luminance in cd/m²: the default, and the end of the slider.
    #[must_use]
    pub const fn luminance(self, default: f32, slider_max: f32) -> Self {
        Self { unit: "cd/m²", default_intensity: default, slider_max, extent: true, ..self }
    }

    /// The same with extent, in the unit that it has.
    #[must_use]
    pub const fn with_extent(self) -> Self {
        Self { extent: true, ..self }
    }

    /// The same with an intensity that is a factor of what it is by itself: the default, and the end of the slider.
    #[must_use]
    pub const fn factor(self, default: f32, slider_max: f32) -> Self {
        Self { unit: "×", default_intensity: default, slider_max, ..self }
    }

    /// The same with a cone that a gizmo draws: half its angle in degrees is the number of that name.
    #[must_use]
    pub const fn cone(self, parameter: &'static str) -> Self {
        Self { cone_parameter: Some(parameter), ..self }
    }

    /// The same with sizes: numbers in metres that have handles in the picture, and make the outline of a light with extent.
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

    /// The same with a turn about its direction that has a handle in the picture: the number of that name, in degrees.
    #[must_use]
    pub const fn roll(self, parameter: &'static str) -> Self {
        Self { roll_parameter: Some(parameter), ..self }
    }

    /// The same with the equation of the light that arrives at a point.
    #[must_use]
    pub const fn equation(self, equation: &'static str) -> Self {
        Self { equation, ..self }
    }
}
