use glam::Vec3;

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{Frame, Terms},
    parameter::{BASE_COLOUR, Parameter},
    parameters,
};

/// Minnaert's exponent.
const LIMB_DARKENING: Parameter = Parameter::number("limb_darkening", 0.5..=2.0, 0.6)
    .symbol("k")
    .label("limb darkening")
    .help("1 is Lambert. Below 1 the rim of a ball brightens: at 0.5 the full moon is a flat disc. Above 1 the rim darkens, as on velvet lit from the front.");

/// The lower bound of cosines raised to a power, within 0.06° of the horizon: for k < 1 the formula is unbounded there,
/// and rounding would decide the brightness of a rim.
const RIM: f32 = 1e-3;

parameters! {
    /// **Minnaert** — the simplest reciprocal law for the brightness of a planet's disc.
    ///
    /// ```text
    /// f_r = C_b (k + 1)/2π · (cos θ_i cos θ_r)^{k − 1}
    /// response = π f_r max(0, N·L), 0 where N·V ≤ 0
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    /// | `limb_darkening` | k | – | 0.5–2 | 0.6 |
    ///
    /// Minnaert sought the reciprocal powers of the two cosines. The factor (k + 1)/2π makes the directional albedo
    /// E(μ) = C_b μ^{k − 1}: all light at normal incidence for white. Cosines below 0.001 count as 0.001, so that rims
    /// stay finite.
    ///
    /// Use it for moons and planets without an atmosphere (k between 0.5 and 1), and to see one exponent turn a ball
    /// into a disc. Reciprocal; not energy conserving for k < 1, where E grows towards grazing angles.
    ///
    /// Source: M. Minnaert (1941), *The Reciprocity Principle in Lunar Photometry*, Astrophysical Journal
    /// 93, 403–410.
    pub struct Minnaert {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
        /// `k`.
        limb_darkening: number = LIMB_DARKENING,
    }
}

impl ReflectionModel for Minnaert {
    const DECLARATION: Declaration = built_in!("minnaert", "Minnaert", Classical).matte().ambient_by_albedo();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_i, cos_o)) = frame.cosines(l, v) else { return Terms::default() };
        let k = self.limb_darkening;
        let raised = (cos_i.max(RIM) * cos_o.max(RIM)).powf(k - 1.0);
        let diffuse = self.base_colour * (0.5 * (k + 1.0) * cos_i * raised);
        Terms { diffuse, ..Terms::default() }
    }
}
