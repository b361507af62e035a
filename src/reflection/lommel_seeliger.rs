use glam::Vec3;

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{Frame, Terms},
    parameter::BASE_COLOUR,
    parameters,
};

parameters! {
    /// **Lommel–Seeliger** — single scattering in a deep, dark powder.
    ///
    /// ```text
    /// f_r = C_b/2π · 1/(cos θ_i + cos θ_r)
    /// response = π f_r max(0, N·L), 0 where N·V ≤ 0
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    ///
    /// Light and view are each attenuated exponentially inside the powder; the single scattering summed over all depths
    /// is 1/(cos θ_i + cos θ_r). For isotropically scattering particles of single-scattering albedo w, f_r = w/4π ·
    /// 1/(cos θ_i + cos θ_r): here w = 2 C_b, the normalisation under which white reflects everything at grazing
    /// angles. The directional albedo is E(μ) = C_b (1 − μ ln(1 + 1/μ)), from 0.31 C_b at normal incidence to C_b. By
    /// coincidence, GGX microfacets with α = 1, height-correlated masking and F = 1 have the same BRDF.
    ///
    /// Use it for the Moon: lit from behind the observer, every point of a ball is equally bright. Keeps all laws.
    ///
    /// Source: H. Seeliger (1888), *Zur Photometrie zerstreut reflectirender Substanzen*,
    /// Sitzungsberichte der Bayerischen Akademie der Wissenschaften 18; E. Lommel (1889), *Die Photometrie
    /// der diffusen Zurückwerfung*, Annalen der Physik 272(2), 473–502.
    pub struct LommelSeeliger {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
    }
}

impl ReflectionModel for LommelSeeliger {
    const DECLARATION: Declaration =
        built_in!("lommel_seeliger", "Lommel–Seeliger", Classical).matte().ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_i, cos_o)) = frame.cosines(l, v) else { return Terms::default() };
        Terms { diffuse: self.base_colour * (0.5 * cos_i / (cos_i + cos_o)), ..Terms::default() }
    }
}
