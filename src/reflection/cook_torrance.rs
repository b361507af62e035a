use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::{Declaration, Factor, Measured, Readout, ReflectionModel, built_in, preset};
use crate::{
    optics::{
        Frame, Terms,
        distribution::beckmann,
        fresnel::{conductor_rgb, normal_reflectance_rgb},
        geometry::half_vector,
        lobes::{self, Lobe, Lobes},
        masking::v_cavity,
    },
    parameter::{BASE_COLOUR, EXTINCTION, IOR, Parameter, Value, meaning},
    parameters,
};

/// The fraction of the specular part; the rest is diffuse.
pub(super) const SPECULAR_WEIGHT: Parameter = Parameter::number("specular_weight", 0.0..=1.0, 0.5)
    .symbol("s")
    .label("specular share")
    .help("The specular fraction of the surface; the rest is diffuse. 1 for metals, about 0.1 to 0.5 for plastics and paints.");

const SLOPE: Parameter = Parameter::number("slope", 0.001..=1.0, 0.2)
    .symbol("m")
    .label("slope of the facets")
    .help("Root mean square slope of the microfacets: smaller values sharpen the highlight. 0.2 is shiny, 0.6 nearly matte.")
    .stands_for(&meaning::ALPHA_OF_FACETS);

parameters! {
    /// **Cook–Torrance** — microfacets with Beckmann's distribution, and the exact Fresnel equations, which give metals
    /// their colour.
    ///
    /// ```text
    /// f_r = (1 − s) C_b/π + s D F G / (4 (N·L)(N·V))
    /// D = exp(−tan² θ_h / m²) / (π m² cos⁴ θ_h)
    /// G = min(1, 2 (N·H)(N·V)/(V·H), 2 (N·H)(N·L)/(V·H))
    /// F = the Fresnel equations for unpolarised light, of n + ik, at the angle between L and H
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `ior` | n | – | 0.01–6, for red, green, blue | 1.5 |
    /// | `extinction` | k | – | 0–12, for red, green, blue | 0 |
    /// | `slope` | m | – | 0.001–1 | 0.2 |
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `specular_weight` | s | – | 0–1 | 0.5 |
    ///
    /// Source: R. L. Cook, K. E. Torrance (1982), *A Reflectance Model for Computer Graphics*, ACM
    /// Transactions on Graphics 1(1), 7–24. The paper's R_d is C_b, its d is 1 − s.
    ///
    /// **The factor 4.** The paper prints `R_s = F D G / (π (N·L)(N·V))` and a D without 1/π. With D normalised, `∫ D
    /// cos θ_h dω = 1`, that is four times the form above. The Jacobian of the half vector, `dω_h = dω_l / (4 L·H)`,
    /// demands the 4; with the π, a perfect mirror would reflect four times the incident light. The form here is the
    /// one for a normalised D, so values of programs that follow the printed form must be divided by 4.
    ///
    /// **When to use it**: for metals with measured n and k, and for plastics with a coloured body and a white
    /// highlight; to see a highlight shift towards white at grazing angles. Unlike that of `torrance_sparrow`, its
    /// distribution is one of slopes; compared with GGX it has short tails, so highlights end more sharply than on most
    /// real surfaces.
    ///
    /// **Laws**: all three hold. The masking of the V-shaped cavities is consistent with the distribution of normals,
    /// and s divides the light between the two parts. Light that strikes several facets is lost, so rough metals are
    /// too dark.
    pub struct CookTorrance {
        /// `n`.
        ior: triple = IOR,
        /// `k`.
        extinction: triple = EXTINCTION,
        /// `m`.
        slope: number = SLOPE,
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `s`.
        specular_weight: number = SPECULAR_WEIGHT,
    }
}

impl ReflectionModel for CookTorrance {
    const DECLARATION: Declaration =
        built_in!("cook_torrance", "Cook–Torrance", Microfacet).ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (cos_l, cos_v) = (frame.n.dot(l), frame.n.dot(v));
        // Below the surface, or at such a grazing angle that the quotients would leave the range of f32.
        if cos_l.min(cos_v) < 1e-9 {
            return Terms::default();
        }
        let h = half_vector(l, v);
        // L·H, and H in a frame with x along its tangential part: both without cancellation.
        let cos_d = 0.5 * (l + v).length();
        let local = Vec3::new(frame.n.cross(h).length(), 0.0, frame.n.dot(h));
        let d = beckmann(local, Vec2::splat(self.slope));
        let visibility = v_cavity(cos_l, cos_v, local.z, cos_d);
        let f = conductor_rgb(self.ior, self.extinction, cos_d);
        let diffuse = (1.0 - self.specular_weight) * cos_l * self.base_colour;
        let specular = self.specular_weight * PI * d * (visibility * cos_l) * f;
        Terms::of(diffuse, specular)
    }

    fn lobes(&self) -> Lobes {
        let (s, reflected) = (self.specular_weight, conductor_rgb(self.ior, self.extinction, lobes::OBLIQUE));
        Lobes::diffuse_and(Lobe::ggx(self.slope), (1.0 - s) * self.base_colour, s * reflected)
    }

    fn readouts(&self) -> Vec<Readout> {
        vec![Readout::of_f0(normal_reflectance_rgb(self.ior, self.extinction)), Readout::of_alpha(self.slope)]
    }

    fn factor(&self, factor: Factor) -> Option<Vec3> {
        factor.by(
            |cos_d| conductor_rgb(self.ior, self.extinction, cos_d),
            |h| beckmann(h, Vec2::splat(self.slope)),
            |l, v| v_cavity(l.z, v.z, half_vector(l, v).z, 0.5 * (l + v).length()),
        )
    }

    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        conductor_preset(material)
    }
}

/// Sets n and k; a metal has no diffuse reflection. The diffuse reflection of a dielectric depends on its
/// pigments, so it stays.
pub(super) fn conductor_preset(material: &Measured) -> Vec<(&'static str, Value)> {
    let mut values = preset::conductor(material);
    if material.metal {
        values.push((SPECULAR_WEIGHT.name, Value::Number(1.0)));
    }
    values
}
