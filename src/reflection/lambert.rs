use glam::Vec3;

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{Frame, Terms},
    parameter::BASE_COLOUR,
    parameters,
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
    const DECLARATION: Declaration = built_in!("lambert", "Lambert", Basic).matte();

    fn response(&self, l: Vec3, _v: Vec3, frame: &Frame) -> Terms {
        Terms { diffuse: frame.n.dot(l).max(0.0) * self.base_colour, ..Terms::default() }
    }

    fn ambient_response(&self, _v: Vec3, _frame: &Frame) -> Vec3 {
        self.base_colour
    }
}
