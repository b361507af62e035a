use glam::Vec3;

use super::{Declaration, Factor, Measured, Readout, ReflectionModel, built_in, preset};
use crate::{
    optics::{
        Frame, Terms,
        fresnel::schlick,
        geometry::half_slope,
        lobes::{self, Lobe, Lobes},
    },
    parameter::{BASE_COLOUR, K_S, Parameter, SPECULAR_COLOUR, Value, meaning},
    parameters,
};

/// The exponent of the highlight along the tangent.
const EXPONENT_U: Parameter = Parameter::integer_from("exponent_u", 0, 10_000, 10)
    .symbol("n_u")
    .label("exponent along the tangent")
    .help("The sharpness of the highlight along the tangent: larger values narrow it in that direction. It is large where scratches run along the tangent.")
    .stands_for(&meaning::EXPONENT_ALONG);

/// The exponent of the highlight along the bitangent.
const EXPONENT_V: Parameter = Parameter::integer_from("exponent_v", 0, 10_000, 200)
    .symbol("n_v")
    .label("exponent across the tangent")
    .help("The sharpness of the highlight across the tangent. If it equals the exponent along the tangent, the surface is isotropic.")
    .stands_for(&meaning::EXPONENT_ACROSS);

parameters! {
    /// **Ashikhmin–Shirley** — an anisotropic Phong highlight over a diffuse base that dims beneath it.
    ///
    /// ```text
    /// f_d = 28 R_d/(23π) (1 − F_0) (1 − (1 − N·L/2)⁵) (1 − (1 − N·V/2)⁵)
    /// f_s = √((n_u + 1)(n_v + 1))/(8π) (N·H)^n F / (H·L max(N·L, N·V))
    /// n = (n_u (H·T)² + n_v (H·B)²) / (1 − (N·H)²),  F = F_0 + (1 − F_0)(1 − H·L)⁵
    /// R_d = C_b,  F_0 = R_s = k_s C_s
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `specular_colour` | C_s | sRGB | 0–255 | white |
    /// | `k_s` | k_s | – | 0–1 | 0.5 |
    /// | `exponent_u` | n_u | – | whole, ≥ 0 | 10 |
    /// | `exponent_v` | n_v | – | whole, ≥ 0 | 200 |
    ///
    /// Source: M. Ashikhmin, P. Shirley (2000), *An Anisotropic Phong BRDF Model*, journal of graphics tools 5(2). The
    /// highlight follows Schlick's approximation of the Fresnel equations, so it becomes white and strong at grazing
    /// angles; the base receives the rest of the light. The factor 28/23 makes its albedo `R_d (1 − R_s)(1 − (1 −
    /// μ/2)⁵)`, close below the limit set by the Fresnel factor.
    ///
    /// Use it for varnished, lacquered and brushed surfaces. It keeps all three laws for all exponents; rough
    /// highlights lose light, since light reflected below the horizon is not compensated.
    pub struct AshikhminShirley {
        /// `R_d`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `C_s`, linear.
        specular_colour: colour = SPECULAR_COLOUR,
        /// `k_s`.
        k_s: number = K_S,
        /// `n_u`.
        exponent_u: number = EXPONENT_U,
        /// `n_v`.
        exponent_v: number = EXPONENT_V,
    }
}

impl ReflectionModel for AshikhminShirley {
    const DECLARATION: Declaration =
        built_in!("ashikhmin_shirley", "Ashikhmin–Shirley", Classical).ambient_by_albedo().anisotropic();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_l, cos_v)) = frame.cosines(l, v) else { return Terms::default() };
        let r_s = self.k_s * self.specular_colour;
        let slope = half_slope(l, v, frame);
        let squared = slope * slope;
        let tan2 = squared.x + squared.y;
        // (N·H)^n by cos² θ_h = 1/(1 + tan² θ_h): large exponents need all digits of the angle.
        let n = if tan2 > 0.0 {
            self.exponent_u * (squared.x / tan2) + self.exponent_v * (squared.y / tan2)
        } else {
            0.0
        };
        let lobe = (self.exponent_u + 1.0).sqrt() * (self.exponent_v + 1.0).sqrt() / 8.0
            * (-0.5 * n * tan2.ln_1p()).exp();
        let cos_d = (0.5 * (l + v).length()).clamp(1e-12, 1.0);
        // 1 − (1 − μ/2)⁵
        let left = |mu: f32| {
            let x = 0.5 * mu;
            x * (5.0 + x * (-10.0 + x * (10.0 + x * (-5.0 + x))))
        };
        let diffuse = 28.0 / 23.0 * cos_l * left(cos_l) * left(cos_v) * self.base_colour * (1.0 - r_s);
        let specular = lobe * (cos_l / cos_l.max(cos_v)) / cos_d * schlick(r_s, cos_d);
        Terms::of(diffuse, specular)
    }

    fn lobes(&self) -> Lobes {
        let r_s = self.k_s * self.specular_colour;
        let highlight = Lobe::of_half_vectors(self.exponent_u, self.exponent_v);
        Lobes::diffuse_and(highlight, (1.0 - r_s) * self.base_colour, schlick(r_s, lobes::OBLIQUE))
    }

    fn readouts(&self) -> Vec<Readout> {
        vec![Readout::of_f0(self.k_s * self.specular_colour)]
    }

    fn factor(&self, factor: Factor) -> Option<Vec3> {
        match factor {
            Factor::Fresnel { cos_d } => Some(schlick(self.k_s * self.specular_colour, cos_d)),
            _ => None,
        }
    }

    /// Sets F_0 as the colour of the highlight. A metal has no diffuse reflection.
    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        let mut values =
            vec![(K_S.name, Value::Number(1.0)), (SPECULAR_COLOUR.name, preset::colour(material.f0))];
        if material.metal {
            values.push((BASE_COLOUR.name, Value::Colour([0; 3])));
        }
        values
    }
}
