use glam::Vec3;

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{
        Frame, Terms,
        diffuse::{oren_nayar_full, oren_nayar_qualitative},
    },
    parameter::{BASE_COLOUR, Parameter, SIGMA},
    parameters,
};

/// The choice between the two equations of the paper.
const OREN_NAYAR_FORM: Parameter = Parameter::choice(
    "oren_nayar_form",
    &[("full", "full, with interreflection"), ("qualitative", "qualitative")],
    0,
)
.symbol("")
.label("form")
.help("The full equation of the paper, with interreflection between facets, or its short form, which most programs use.");

parameters! {
    /// **Oren–Nayar** — Lambert for rough surfaces: plaster, sand, clay, the moon.
    ///
    /// ```text
    /// qualitative:  f_r = C_b/π (A + B max(0, cos φ) sin α tan β)
    ///   A = 1 − σ²/2 / (σ² + 0.33),  B = 0.45 σ² / (σ² + 0.09)
    /// full:  f_r = C_b/π (C₁ + cos φ C₂ tan β + (1 − |cos φ|) C₃ tan((α + β)/2) + 0.17 C_b C₄)
    ///   C₁ = A,  C₂ = B (sin α − [cos φ < 0] (2β/π)³)
    ///   C₃ = 0.125 σ²/(σ² + 0.09) (4αβ/π²)²,  C₄ = σ²/(σ² + 0.13) (1 − cos φ (2β/π)²)
    /// α, β: the larger and the smaller of the polar angles of L and V;  φ: the azimuth between them
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `sigma` | σ | ° (radians in the equation) | 0–35 | 20 |
    /// | `oren_nayar_form` | – | – | `full`, `qualitative` | `full` |
    ///
    /// Source: M. Oren, S. K. Nayar (1994), *Generalization of Lambert's Reflectance Model*, SIGGRAPH '94.
    /// The surface consists of long V-shaped grooves with Lambertian walls, which mask and shadow each other; σ is the
    /// standard deviation of the angle of the walls. The equations are fits to integrals over all grooves. From near
    /// the light, the viewer sees mostly the lit walls, so a sphere looks flat, as bright at its edge as in its middle.
    ///
    /// Use it for rough matte materials. At σ = 0 it is Lambert. Reciprocal and, up to σ = 35°, where the range ends,
    /// non-negative. Not energy conserving: the fit of the full form reflects more than it receives at small σ (σ = 0.2
    /// rad, white: E = 1.0255 at cos θ = 0.1), while large σ lose light.
    pub struct OrenNayar {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `σ`, degrees.
        sigma: number = SIGMA,
        /// 0: full, 1: qualitative.
        oren_nayar_form: choice = OREN_NAYAR_FORM,
    }
}

impl ReflectionModel for OrenNayar {
    const DECLARATION: Declaration =
        built_in!("oren_nayar", "Oren–Nayar", Diffuse).matte().ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_l, cos_v)) = frame.cosines(l, v) else { return Terms::default() };
        let sigma = self.sigma.to_radians();
        let factor = match self.oren_nayar_form {
            0 => oren_nayar_full(cos_l, cos_v, l.dot(v), sigma, self.base_colour),
            _ => Vec3::splat(oren_nayar_qualitative(cos_l, cos_v, l.dot(v), sigma)),
        };
        Terms { diffuse: cos_l * factor * self.base_colour, ..Terms::default() }
    }
}
