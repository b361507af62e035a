use glam::Vec3;

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{Frame, Terms},
    parameter::{BASE_COLOUR, K_D, Parameter},
    parameters,
};

/// The exponent of the wrapped cosine. The CA writes a square and also states that `k_d = 1` equals Lambert,
/// which holds only for exponent 1; hence a parameter.
const WRAP_EXPONENT: Parameter = Parameter::number("wrap_exponent", 1.0..=4.0, 2.0)
    .symbol("p")
    .label("wrap exponent")
    .help("The power of the wrapped cosine: 2 is the equation as written and, with a diffuse coefficient of 0.5, Valve's Half-Lambert; 1 is Lambert at a coefficient of 1.");

parameters! {
    /// **Modified Lambert** — diffuse wrap: light reaches around the edge; instance model 2 of the Commonality Analysis.
    ///
    /// ```text
    /// response = max(0, (N·L) k_d + (1 − k_d))^p · C_b
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `k_d` | k_d | – | 0.5–1 | 0.8 |
    /// | `wrap_exponent` | p | – | 1–4 | 2 |
    ///
    /// `N·L` is not clamped; the bracket is, before it is raised to the power. Source: Commonality Analysis, IM2; the half-Lambert case is
    /// J. Mitchell, M. McTaggart, C. Green (2006), *Shading in Valve's Source Engine*. Breaks energy conservation and
    /// reciprocity: the part of the surface facing away from the light receives none, and yet shines.
    pub struct ModLambert {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `k_d`.
        k_d: number = K_D,
        /// `p`.
        wrap_exponent: number = WRAP_EXPONENT,
    }
}

impl ReflectionModel for ModLambert {
    const DECLARATION: Declaration =
        built_in!("mod_lambert", "Modified Lambert", Basic).lit_from_below().matte();

    fn response(&self, l: Vec3, _v: Vec3, frame: &Frame) -> Terms {
        let wrapped = frame.n.dot(l) * self.k_d + (1.0 - self.k_d);
        Terms { diffuse: wrapped.max(0.0).powf(self.wrap_exponent) * self.base_colour, ..Terms::default() }
    }

    fn ambient_response(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        self.base_colour
    }
}
