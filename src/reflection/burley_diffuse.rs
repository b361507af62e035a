use glam::Vec3;

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{Frame, Terms, diffuse::burley, geometry::half_vector},
    parameter::{BASE_COLOUR, Parameter, ROUGHNESS},
    parameters,
};

parameters! {
    /// **Burley diffuse** — the base of Disney's model: smooth surfaces darken at the edge, rough ones brighten.
    ///
    /// ```text
    /// f_r = C_b/π (1 + (F_90 − 1)(1 − N·L)⁵) (1 + (F_90 − 1)(1 − N·V)⁵)
    /// F_90 = 1/2 + 2 r (H·L)²
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `roughness` | r | – | 0–1 | 0.5 |
    ///
    /// Source: B. Burley (2012), *Physically-Based Shading at Disney*, SIGGRAPH course *Practical Physically-Based
    /// Shading in Film and Game Production*. An empirical fit to measured materials: at grazing angles, the Fresnel
    /// factor weakens light on its way into and out of a smooth surface, F_90 = 1/2; rough surfaces reflect it back, up
    /// to F_90 = 5/2.
    ///
    /// Use it as the base under a highlight, for looks matched to production renderers. Reciprocal and non-negative.
    /// Not energy conserving: the fit does not bound the albedo (r = 1, white: E = 1.380 at cos θ = 0.1).
    pub struct BurleyDiffuse {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `r`.
        roughness: number = Parameter {
            help: "From 0, a smooth surface with a dark edge, to 1, a rough one whose edge reflects light back.",
            ..ROUGHNESS
        },
    }
}

impl ReflectionModel for BurleyDiffuse {
    const DECLARATION: Declaration =
        built_in!("burley_diffuse", "Burley diffuse", Diffuse).matte().ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_l, cos_v)) = frame.cosines(l, v) else { return Terms::default() };
        let factor = burley(cos_l, cos_v, l.dot(half_vector(l, v)), self.roughness);
        Terms { diffuse: cos_l * factor * self.base_colour, ..Terms::default() }
    }
}
