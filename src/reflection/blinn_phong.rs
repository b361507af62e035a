use glam::Vec3;

use super::{Declaration, Readout, ReflectionModel, built_in};
use crate::{
    optics::{
        Frame, Terms,
        geometry::half_vector,
        lobes::{Lobe, Lobes},
    },
    parameter::{ALPHA, BASE_COLOUR, K_A, K_D, K_S, SPECULAR_COLOUR, meaning},
    parameters,
};

parameters! {
    /// **Blinn–Phong** — Phong's highlight with the half vector, instance model 4 of the Commonality Analysis.
    ///
    /// ```text
    /// I_a = k_a C_b     I_d = k_d max(0, N·L) C_b     I_s = k_s max(0, N·H)^α C_s
    /// H = (L + V)/|L + V|;  I_s = 0 where N·L ≤ 0
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `specular_colour` | C_s | sRGB | 0–255 | white |
    /// | `k_a` | k_a | – | 0–1 | 0.1 |
    /// | `k_d` | k_d | – | 0.5–1 | 0.8 |
    /// | `k_s` | k_s | – | 0–1 | 0.5 |
    /// | `alpha` | α | – | whole, ≥ 0 | 32 |
    ///
    /// Source: J. F. Blinn (1977), *Models of Light Reflection for Computer Synthesized Pictures*, SIGGRAPH. The same α
    /// gives a wider highlight than Phong's (about four times α matches it head on), and a narrower one at grazing
    /// angles, as on measured surfaces. Not reciprocal (the lobe is divided by cos θ_i) and not energy conserving.
    pub struct BlinnPhong {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `C_s`, linear.
        specular_colour: colour = SPECULAR_COLOUR,
        /// `k_a`.
        k_a: number = K_A,
        /// `k_d`.
        k_d: number = K_D,
        /// `k_s`.
        k_s: number = K_S,
        /// `α`.
        alpha: number = ALPHA.stands_for(&meaning::BLINN_PHONG_EXPONENT),
    }
}

impl ReflectionModel for BlinnPhong {
    const DECLARATION: Declaration = built_in!("blinn_phong", "Blinn–Phong", Basic).lit_from_below();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let cos_i = frame.n.dot(l);
        let specular = if cos_i > 0.0 {
            self.k_s * frame.n.dot(half_vector(l, v)).max(0.0).powf(self.alpha) * self.specular_colour
        } else {
            Vec3::ZERO
        };
        Terms {
            ambient: self.k_a * self.base_colour,
            diffuse: self.k_d * cos_i.max(0.0) * self.base_colour,
            specular,
            transmitted: Vec3::ZERO,
        }
    }

    fn lobes(&self) -> Lobes {
        // The brightness of the highlight does not depend on its width: a narrow one has little light, and
        // needs no narrower lobe.
        let exponent = self.alpha.min(200.0);
        let highlight = Lobe::of_half_vectors(exponent, exponent);
        let reflected = self.k_s * 8.0 / (exponent + 8.0) * self.specular_colour;
        Lobes::diffuse_and(highlight, (self.k_a + self.k_d) * self.base_colour, reflected)
    }

    fn ambient_response(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        self.k_a * self.base_colour
    }

    fn readouts(&self) -> Vec<Readout> {
        Readout::of_exponent(self.alpha)
    }
}
