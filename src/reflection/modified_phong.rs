use glam::Vec3;

use super::{Declaration, Readout, ReflectionModel, built_in};
use crate::{
    optics::{
        Frame, Terms, equivalence,
        lobe::{mirror_tangent_squared, power_of_cosine},
        lobes::{Lobe, Lobes},
    },
    parameter::{ALPHA, BASE_COLOUR, K_S, SPECULAR_COLOUR, meaning},
    parameters,
};

parameters! {
    /// **Modified Phong** — Phong's highlight as a physically plausible BRDF.
    ///
    /// ```text
    /// f_r = (1 − k_s C_s) C_b/π + k_s C_s (α + 2)/2π max(0, R·V)^α
    /// response = π f_r max(0, N·L), 0 where N·V ≤ 0
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `specular_colour` | C_s | sRGB | 0–255 | white |
    /// | `k_s` | k_s | – | 0–1 | 0.5 |
    /// | `alpha` | α | – | whole, ≥ 0 | 32 |
    ///
    /// Lewis noted that Phong's lobe is reciprocal if it is not divided by cos θ_i, that is, if the whole response has
    /// the factor N·L; (α + 2)/2π makes it reflect all light at normal incidence. His condition k_d + k_s ≤ 1 holds
    /// here since k_d = (1 − k_s C_s) C_b. α = 0 is Lambert.
    ///
    /// Use it as the reciprocal twin of Phong. Keeps all laws. At grazing angles half of the lobe lies
    /// below the surface and is lost, so metals look too dark there.
    ///
    /// Source: R. R. Lewis (1993), *Making Shaders More Physically Plausible*, Eurographics Workshop on
    /// Rendering; E. P. Lafortune, Y. D. Willems (1994), *Using the Modified Phong Reflectance Model for
    /// Physically Based Rendering*, Report CW 197, KU Leuven.
    pub struct ModifiedPhong {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `C_s`, linear.
        specular_colour: colour = SPECULAR_COLOUR,
        /// `k_s`.
        k_s: number = K_S,
        /// `α`.
        alpha: number = ALPHA.stands_for(&meaning::PHONG_EXPONENT),
    }
}

impl ReflectionModel for ModifiedPhong {
    const DECLARATION: Declaration =
        built_in!("modified_phong", "Modified Phong", Classical).ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_i, _)) = frame.cosines(l, v) else { return Terms::default() };
        let mirrored = self.k_s * self.specular_colour;
        let lobe = power_of_cosine(mirror_tangent_squared(l, v, frame.n), self.alpha);
        let diffuse = (1.0 - mirrored) * self.base_colour * cos_i;
        let specular = mirrored * (0.5 * (self.alpha + 2.0) * lobe * cos_i);
        Terms::of(diffuse, specular)
    }

    fn lobes(&self) -> Lobes {
        let mirrored = self.k_s * self.specular_colour;
        Lobes::diffuse_and(
            Lobe::Power { exponent: self.alpha },
            (1.0 - mirrored) * self.base_colour,
            mirrored,
        )
    }

    fn readouts(&self) -> Vec<Readout> {
        Readout::of_exponent(equivalence::blinn_of_phong(self.alpha))
    }
}
