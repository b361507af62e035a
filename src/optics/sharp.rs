//! Light that a smooth surface reflects or transmits without spreading it: a direction instead of a lobe.

use std::f32::consts::PI;

use arrayvec::ArrayVec;
use glam::Vec3;

use super::{TermSelection, Terms};

/// Maximum number of directions: one reflected, one transmitted.
pub const MOST: usize = 2;

/// The sharp directions of a model for one view.
pub type Sharps = ArrayVec<Sharp, MOST>;

/// A direction from which light reaches the viewer without spreading.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sharp {
    /// Unit vector to where the light comes from; on the viewer's side of the surface if it is reflected.
    pub l: Vec3,
    /// The fraction of the radiance from there that reaches the viewer.
    pub share: Vec3,
    /// True for transmitted light.
    pub transmitted: bool,
}

impl Sharp {
    /// Light reflected from `l`.
    #[must_use]
    pub fn reflected(l: Vec3, share: Vec3) -> Self {
        Self { l, share, transmitted: false }
    }

    /// Light transmitted from `l`.
    #[must_use]
    pub fn transmitted(l: Vec3, share: Vec3) -> Self {
        Self { l, share, transmitted: true }
    }

    /// The response to radiance from the direction by term. Unlike a response to illuminance it is not a density: of a
    /// radiance L, `π share L` leaves, as the integral `∫ response L dω` of a lobe that is narrow.
    #[must_use]
    pub fn terms(&self) -> Terms {
        let response = PI * self.share;
        if self.transmitted { Terms::through(response) } else { Terms::of(Vec3::ZERO, response) }
    }

    /// The part of [`terms`](Self::terms) that is shown.
    #[must_use]
    pub fn response(&self, terms: TermSelection) -> Vec3 {
        self.terms().select(terms)
    }
}
