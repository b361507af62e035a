use glam::Vec3;

use super::{Declaration, Readout, ReflectionModel, built_in};
use crate::{
    optics::{
        Frame, Terms, equivalence,
        geometry::mirror,
        lobes::{Lobe, Lobes},
    },
    parameter::{ALPHA, BASE_COLOUR, K_A, K_D, K_S, SPECULAR_COLOUR, meaning},
    parameters,
};

parameters! {
    /// **Phong** — the first highlight, instance model 3 of the Commonality Analysis.
    ///
    /// ```text
    /// I_a = k_a C_b     I_d = k_d max(0, N·L) C_b     I_s = k_s max(0, R·V)^α C_s
    /// R = 2(N·L)N − L;  I_s = 0 where N·L ≤ 0
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
    /// Source: B. T. Phong (1975), *Illumination for Computer Generated Pictures*, CACM 18(6). An
    /// empirical model: its BRDF is not reciprocal and reflects more light than it receives, most at
    /// grazing angles.
    pub struct Phong {
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
        alpha: number = ALPHA.stands_for(&meaning::PHONG_EXPONENT),
    }
}

impl ReflectionModel for Phong {
    const DECLARATION: Declaration = built_in!("phong", "Phong", Basic).lit_from_below();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let cos_i = frame.n.dot(l);
        let specular = if cos_i > 0.0 {
            self.k_s * mirror(l, frame.n).dot(v).max(0.0).powf(self.alpha) * self.specular_colour
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
        let exponent = self.alpha.min(50.0);
        let reflected = self.k_s * 2.0 / (exponent + 2.0) * self.specular_colour;
        Lobes::diffuse_and(Lobe::Power { exponent }, (self.k_a + self.k_d) * self.base_colour, reflected)
    }

    fn ambient_response(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        self.k_a * self.base_colour
    }

    fn readouts(&self) -> Vec<Readout> {
        Readout::of_exponent(equivalence::blinn_of_phong(self.alpha))
    }
}
