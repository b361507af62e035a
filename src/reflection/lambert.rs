use glam::Vec3;

use super::{Ambient, Declaration, EquationPart, Family, Laws, ReflectionModel, Term};
use crate::{
    optics::{Frame, Terms, lobes::Lobes},
    parameter::BASE_COLOUR,
    parameters,
    shader::wgsl,
};

parameters! {
    /// **Lambert** — the ideal matte surface, instance model 1 of the Commonality Analysis.
    ///
    /// ```text
    /// response = max(0, N·L) · C_b          f_r = C_b / π
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `base_colour` | C_b | sRGB | 0–255 | white |
    ///
    /// Source: J. H. Lambert (1760), *Photometria sive de mensura et gradibus luminis, colorum et umbrae*. Keeps every
    /// law: the reference for all others. Paper and plaster come close.
    pub struct Lambert {
        /// `C_b`, linear.
        base_colour: colour = BASE_COLOUR,
    }
}

impl ReflectionModel for Lambert {
    const DECLARATION: Declaration = Declaration {
        id: "lambert",
        name: "Lambert",
        family: Family::Basic,
        author: "J. H. Lambert 1760",
        source: "J. H. Lambert (1760), Photometria sive de mensura et gradibus luminis, colorum et umbrae",
        summary: "The ideal matte surface: equally bright from every direction. The reference for all others.",
        synonyms: &["matte", "diffuse reflector"],
        equation: &[EquationPart { term: Term::Diffuse, text: "I_d = max(0, N·L) C_b" }],
        quantities: &[],
        laws: Laws { reciprocal: true, energy_conserving: true, non_negative: true },
        ambient: Ambient::Formula,
        anisotropic: false,
        wgsl: wgsl!("reflection/lambert.wgsl"),
    };

    fn response(&self, l: Vec3, _v: Vec3, frame: &Frame) -> Terms {
        Terms { diffuse: frame.n.dot(l).max(0.0) * self.base_colour, ..Terms::default() }
    }

    fn lobes(&self) -> Lobes {
        Lobes::cosine()
    }

    fn ambient_response(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        self.base_colour
    }
}
