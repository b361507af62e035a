use std::f32::consts::FRAC_2_PI;

use glam::Vec3;

use super::{Declaration, Measured, ReflectionModel, built_in, preset};
use crate::{
    optics::{
        Frame, Terms,
        lobe::{mirror_tangent_squared, power_of_cosine},
        lobes::{Lobe, Lobes},
    },
    parameter::{BASE_COLOUR, METALLIC, Parameter, Value, meaning},
    parameters,
};

/// Strauss's smoothness.
const SMOOTHNESS: Parameter = Parameter::number("smoothness", 0.0..=1.0, 0.6)
    .symbol("s")
    .help("0 is dull, 1 is a mirror. One number sharpens the highlight and darkens the diffuse part.")
    .stands_for(&meaning::SMOOTHNESS);

/// Strauss's transparency.
const TRANSPARENCY: Parameter = Parameter::number("transparency", 0.0..=1.0, 0.0).symbol("t").help(
    "The fraction of light that would pass through and is lost here: nothing is visible behind the surface.",
)
    .stands_for(&meaning::TRANSMISSION);

/// Shape of F, which replaces Fresnel's equations, as published.
const K_F: f32 = 1.12;
/// Shape of G, which replaces masking, as published.
const K_G: f32 = 1.01;
/// The reflection of even dull surfaces at grazing angles, as published.
const K_J: f32 = 0.1;
/// Maximum exponent of the highlight, in place of infinity at s = 1.
const SHARPEST: f32 = 30_000.0;

parameters! {
    /// **Strauss** — few parameters that mean something to an animator.
    ///
    /// ```text
    /// I_d = r_d (1 − m s) C_b max(0, N·L)             r_d = (1 − s³)(1 − t)
    /// I_s = r_j C_s max(0, R·V)^h                     h = 3/(1 − s)
    /// r_j = min(1, r_n + (r_n + k_j) F(α) G(α) G(γ))  r_n = 1 − t − r_d
    /// C_s = 1 + m (1 − F(α)) (C_b − 1)
    /// F(x) = (1/(x − k_f)² − 1/k_f²)/(1/(1 − k_f)² − 1/k_f²)
    /// G(x) = (1/(1 − k_g)² − 1/(x − k_g)²)/(1/(1 − k_g)² − 1/k_g²)
    /// ```
    ///
    /// α and γ are the angles of light and view from the normal in right angles (0–1); k_f = 1.12,
    /// k_g = 1.01, k_j = 0.1. F rises from 0 to 1 as Fresnel reflection does, G falls from 1 to 0 as
    /// masking does. 0 where N·L ≤ 0 or N·V ≤ 0. At s = 1 the exponent is 30 000 instead of infinite.
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `smoothness` | s | – | 0–1 | 0.6 |
    /// | `metallic` | m | – | 0–1 | 0 |
    /// | `transparency` | t | – | 0–1 | 0 |
    ///
    /// Published as a colour per unit of light, not as a BRDF, so the formula serves as the response unchanged: the
    /// highlight has no factor N·L. It is the ancestor of today's smoothness and metalness. Compare it with the
    /// metallic–roughness model to see which ideas are older.
    ///
    /// Not reciprocal, since F depends only on the angle of the light and the highlight is in effect divided by N·L.
    /// Energy is conserved except for dull surfaces (s < 0.15), which reflect up to 0.5 % too much: the part k_j is
    /// added on top. The highlight of smooth surfaces loses light, because its brightness does not grow as it narrows.
    ///
    /// Source: P. S. Strauss (1990), *A Realistic Lighting Model for Computer Animators*, IEEE Computer
    /// Graphics and Applications 10(6), 56–64.
    pub struct Strauss {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `s`.
        smoothness: number = SMOOTHNESS,
        /// `m`.
        metallic: number = METALLIC,
        /// `t`.
        transparency: number = TRANSPARENCY,
    }
}

/// The angle of a direction above the surface, as a fraction of a right angle: 1 − x of the published
/// functions. Measured from the horizon, near which it is exact and F and G are steep.
fn elevation(cosine: f32, d: Vec3, n: Vec3) -> f32 {
    FRAC_2_PI * cosine.atan2((d - cosine * n).length())
}

/// F(x) of x = 1 − `elevation`, multiplied out to avoid cancellation.
fn strauss_fresnel(elevation: f32) -> f32 {
    let (x, e) = (1.0 - elevation, K_F - 1.0);
    let q = e / (e + elevation);
    x * (2.0 * K_F - x) * q * q / (K_F * K_F - e * e)
}

/// G(x) of x = 1 − `elevation`, multiplied out to avoid cancellation.
fn strauss_masking(elevation: f32) -> f32 {
    let e = K_G - 1.0;
    let q = K_G / (e + elevation);
    elevation * (2.0 * e + elevation) * q * q / (K_G * K_G - e * e)
}

impl Strauss {
    /// `h`.
    fn exponent(&self) -> f32 {
        3.0 / (1.0 - self.smoothness).max(3.0 / SHARPEST)
    }
}

impl ReflectionModel for Strauss {
    const DECLARATION: Declaration = built_in!("strauss", "Strauss", Classical).ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_i, cos_o)) = frame.cosines(l, v) else { return Terms::default() };
        let (s, m) = (self.smoothness, self.metallic);
        let diffuse = (1.0 - s * s * s) * (1.0 - self.transparency);
        let straight = s * s * s * (1.0 - self.transparency);
        let (up_l, up_v) = (elevation(cos_i, l, frame.n), elevation(cos_o, v, frame.n));
        let f = strauss_fresnel(up_l);
        let mirrored =
            (straight + (straight + K_J) * f * strauss_masking(up_l) * strauss_masking(up_v)).min(1.0);
        let lobe = power_of_cosine(mirror_tangent_squared(l, v, frame.n), self.exponent());
        let tint = Vec3::ONE + m * (1.0 - f) * (self.base_colour - 1.0);
        Terms::of(self.base_colour * (diffuse * (1.0 - m * s) * cos_i), tint * (mirrored * lobe))
    }

    fn lobes(&self) -> Lobes {
        let (s, passed) = (self.smoothness, 1.0 - self.transparency);
        let straight = s * s * s;
        let diffuse = (1.0 - straight) * passed * (1.0 - self.metallic * s) * self.base_colour;
        // The brightness of the highlight does not depend on its width: a narrow one has little light, and
        // needs no narrower lobe.
        let exponent = self.exponent().min(50.0);
        let reflected = (straight * passed + K_J) * 2.0 / (exponent + 2.0);
        Lobes::diffuse_and(Lobe::Power { exponent }, diffuse, Vec3::splat(reflected))
    }

    /// Sets metals only: the specular fraction follows from the smoothness, not from the material.
    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        if material.metal { preset::base_colour_metallic(material) } else { Vec::new() }
    }
}
