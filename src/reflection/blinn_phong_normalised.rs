use glam::Vec3;

use super::{Declaration, Readout, ReflectionModel, built_in};
use crate::{
    optics::{
        Frame, Terms,
        lobe::{half_tangent_squared, power_of_cosine},
        lobes::{Lobe, Lobes},
    },
    parameter::{ALPHA, BASE_COLOUR, K_S, SPECULAR_COLOUR, meaning},
    parameters,
};

parameters! {
    /// **Normalised Blinn–Phong** — Blinn's highlight as an energy-conserving BRDF.
    ///
    /// ```text
    /// f_r = (1 − k_s C_s) C_b/π + k_s C_s (α + 2)(α + 4)/(8π (2^{−α/2} + α)) (N·H)^α
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
    /// The factor makes the lobe reflect all light at normal incidence, for every α; at other angles it reflects less.
    /// So a sharper highlight is a brighter one, as on real surfaces. The common approximation (α + 8)/8π is 7 % too
    /// large at α = 16. The share of the lobe, `k_s C_s`, is taken from the diffuse part: light is divided, not added.
    /// α = 0 is Lambert.
    ///
    /// Use it to see what Blinn–Phong lacks: switch between the two and turn α. Keeps all laws; at grazing angles it
    /// loses light, where real surfaces reflect more.
    ///
    /// Source: the lobe is J. F. Blinn's (1977), *Models of Light Reflection for Computer Synthesized
    /// Pictures*; the exact factor is derived in F. Giesen (2009), *Phong Normalization Factor
    /// Derivation*.
    pub struct BlinnPhongNormalised {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `C_s`, linear.
        specular_colour: colour = SPECULAR_COLOUR,
        /// `k_s`.
        k_s: number = K_S,
        /// `α`.
        alpha: number = ALPHA.stands_for(&meaning::BLINN_PHONG_EXPONENT),
    }
}

impl ReflectionModel for BlinnPhongNormalised {
    const DECLARATION: Declaration =
        built_in!("blinn_phong_normalised", "Normalised Blinn–Phong", Classical).ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_i, _)) = frame.cosines(l, v) else { return Terms::default() };
        let n = self.alpha;
        let mirrored = self.k_s * self.specular_colour;
        let norm = (n + 2.0) * ((n + 4.0) / (8.0 * ((-0.5 * n).exp2() + n)));
        let lobe = power_of_cosine(half_tangent_squared(l, v, frame.n), n);
        Terms::of((1.0 - mirrored) * self.base_colour * cos_i, mirrored * (norm * lobe * cos_i))
    }

    fn lobes(&self) -> Lobes {
        let mirrored = self.k_s * self.specular_colour;
        let highlight = Lobe::of_half_vectors(self.alpha, self.alpha);
        Lobes::diffuse_and(highlight, (1.0 - mirrored) * self.base_colour, mirrored)
    }

    fn readouts(&self) -> Vec<Readout> {
        Readout::of_exponent(self.alpha)
    }
}
