use std::f32::consts::{FRAC_1_PI, PI};

use glam::Vec3;

use super::{
    CookTorrance, Declaration, Factor, Measured, Readout, ReflectionModel, built_in,
    cook_torrance::{SPECULAR_WEIGHT, conductor_preset},
};
use crate::{
    optics::{
        Frame, Terms,
        fresnel::{conductor_rgb, normal_reflectance_rgb},
        geometry::half_vector,
        lobes::{self, Lobe, Lobes},
        masking::v_cavity,
    },
    parameter::{BASE_COLOUR, EXTINCTION, IOR, Parameter, Value, meaning},
    parameters,
};

const FACET_SPREAD: Parameter = Parameter::number("facet_spread", 0.1..=60.0, 12.0)
    .symbol("β")
    .label("spread of the facets")
    .unit("°")
    .help("The angle from the normal at which facets are rarer by the factor e: smaller values sharpen the highlight. 5° is shiny, 30° nearly matte.")
    .stands_for(&meaning::FACET_ANGLE);

parameters! {
    /// **Torrance–Sparrow** — the first microfacet model: facets with Gaussian angles, in V-shaped cavities, with the
    /// exact Fresnel equations, over a Lambertian part.
    ///
    /// ```text
    /// f_r = (1 − s) C_b/π + s D F G / (4 (N·L)(N·V))
    /// D = c²/π exp(−c² θ_h²),   c = 1/β
    /// G = min(1, 2 (N·H)(N·V)/(V·H), 2 (N·H)(N·L)/(V·H))
    /// F = the Fresnel equations for unpolarised light, of n + ik, at the angle between L and H
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `ior` | n | – | 0.01–6, for red, green, blue | 1.5 |
    /// | `extinction` | k | – | 0–12, for red, green, blue | 0 |
    /// | `facet_spread` | β | ° | 0.1–60 | 12 |
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `specular_weight` | s | – | 0–1 | 0.5 |
    ///
    /// Source: K. E. Torrance, E. M. Sparrow (1967), *Theory for Off-Specular Reflection from Roughened Surfaces*,
    /// Journal of the Optical Society of America 57(9), 1105–1114. The paper writes the Gaussian of the facet's angle
    /// with c in 1/degree (0.05 there is β = 20° here), and leaves two factors free, one for each part, to be fitted.
    /// Here the distribution is normalised by c²/π, and s divides the light between the parts, so no light is gained.
    ///
    /// **The norm** c²/π is exact for narrow lobes, where the sine of an angle is the angle. For wide ones `∫ D cos θ_h
    /// dω` is less than 1: 0.97 at β = 12°, 0.84 at 30°; such surfaces are too dark, never too bright.
    ///
    /// **When to use it**: to see what was new in 1967. Under grazing light the highlight is brightest not in the
    /// mirror direction but beyond it, because F rises there and G falls only later: the off-specular peak that the
    /// paper set out to explain.
    ///
    /// **Laws**: all three hold.
    pub struct TorranceSparrow {
        /// `n`.
        ior: triple = IOR,
        /// `k`.
        extinction: triple = EXTINCTION,
        /// `β` in degrees.
        facet_spread: number = FACET_SPREAD,
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `s`.
        specular_weight: number = SPECULAR_WEIGHT,
    }
}

/// `c²/π exp(−c² θ²)`, from the sine and cosine of θ, with c = 1/`spread` (degrees).
fn gaussian(sin_h: f32, cos_h: f32, spread: f32) -> f32 {
    if cos_h <= 0.0 {
        return 0.0;
    }
    let c = 1.0 / spread.to_radians();
    let x = c * sin_h.atan2(cos_h);
    FRAC_1_PI * c * c * (-x * x).exp()
}

impl ReflectionModel for TorranceSparrow {
    const DECLARATION: Declaration = built_in!("torrance_sparrow", "Torrance–Sparrow", Microfacet)
        .quantities(CookTorrance::DECLARATION.quantities)
        .ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let (cos_l, cos_v) = (frame.n.dot(l), frame.n.dot(v));
        // Below the surface, or at such a grazing angle that the quotients would leave the range of f32.
        if cos_l.min(cos_v) < 1e-9 {
            return Terms::default();
        }
        let h = half_vector(l, v);
        let cos_h = frame.n.dot(h);
        // L·H without cancellation.
        let cos_d = 0.5 * (l + v).length();
        let d = gaussian(frame.n.cross(h).length(), cos_h, self.facet_spread);
        let visibility = v_cavity(cos_l, cos_v, cos_h, cos_d);
        let f = conductor_rgb(self.ior, self.extinction, cos_d);
        let diffuse = (1.0 - self.specular_weight) * cos_l * self.base_colour;
        let specular = self.specular_weight * PI * d * (visibility * cos_l) * f;
        Terms::of(diffuse, specular)
    }

    fn lobes(&self) -> Lobes {
        let (s, reflected) = (self.specular_weight, conductor_rgb(self.ior, self.extinction, lobes::OBLIQUE));
        Lobes::diffuse_and(
            Lobe::ggx(self.facet_spread.to_radians()),
            (1.0 - s) * self.base_colour,
            s * reflected,
        )
    }

    fn readouts(&self) -> Vec<Readout> {
        // Near the normal the tangent is the angle, so the width of slopes is β in radians.
        let alpha = self.facet_spread.to_radians();
        vec![Readout::of_f0(normal_reflectance_rgb(self.ior, self.extinction)), Readout::of_alpha(alpha)]
    }

    fn factor(&self, factor: Factor) -> Option<Vec3> {
        factor.by(
            |cos_d| conductor_rgb(self.ior, self.extinction, cos_d),
            |h| gaussian(h.truncate().length(), h.z, self.facet_spread),
            |l, v| v_cavity(l.z, v.z, half_vector(l, v).z, 0.5 * (l + v).length()),
        )
    }

    fn preset(material: &Measured) -> Vec<(&'static str, Value)> {
        conductor_preset(material)
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    use super::*;

    #[test]
    fn narrow_lobes_are_normalised_and_wide_ones_reflect_less() {
        // ∫ D cos θ dω over t³ = θ/(π/2).
        let norm = |spread: f32| -> f64 {
            let rows = 20_000;
            (0..rows)
                .map(|i| (f64::from(i) + 0.5) / f64::from(rows))
                .map(|t| {
                    let (sin, cos) = (FRAC_PI_2 * t.powi(3)).sin_cos();
                    let weight = FRAC_PI_2 * 3.0 * t * t / f64::from(rows) * TAU * sin * cos;
                    weight * f64::from(gaussian(sin as f32, cos as f32, spread))
                })
                .sum()
        };
        assert!((norm(0.1) - 1.0).abs() < 1e-4);
        // The series 1 − 2/3 β² + 4/15 β⁴ of Dawson's integral.
        let series = |spread: f64| {
            let b2 = (spread * PI / 180.0).powi(2);
            1.0 - 2.0 / 3.0 * b2 + 4.0 / 15.0 * b2 * b2
        };
        for spread in [2.0, 12.0] {
            assert!((norm(spread as f32) - series(spread)).abs() < 1e-4, "{spread}: {}", norm(spread as f32));
        }
        assert!((norm(12.0) - 1.0).abs() > 0.01, "the wrong twin passes");
        for spread in [20.0, 30.0, 60.0] {
            assert!(norm(spread) < 1.0);
        }
    }
}
