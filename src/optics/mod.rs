//! The vocabulary of every reflection model: pure functions on [`glam`] vectors, no Bevy.
//!
//! Functions needed by shaders have a twin in `assets/shaders/terms.wgsl` or `assets/shaders/optics/` with the same
//! name. The two are written separately on purpose: each checks the other.

pub mod absorption;
pub mod albedo;
#[cfg(test)]
pub(crate) mod chi_squared;
pub mod colour;
pub mod diffuse;
pub mod dispersion;
pub mod distribution;
pub mod equivalence;
pub mod film;
pub mod fresnel;
pub mod geometry;
pub mod half_difference;
pub mod interface;
pub mod interior;
pub mod lobe;
pub mod lobes;
pub mod masking;
pub mod radiometry;
pub mod refraction;
pub mod sampling;
pub mod sequence;
pub mod sharp;
pub mod slab;
pub mod table;
pub mod temperature;
pub mod tone;
pub mod viridis;

pub use geometry::Frame;

use glam::Vec3;

use crate::declared::ids;

/// The response of a reflection model to one light of unit intensity, split into the terms of the
/// equation.
///
/// The sum is the **response** `π · f(l, v) · |cos θ_i|` (dimensionless, linear RGB); the ambient
/// term does not depend on any direction (`I_a`, CA DD3).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Terms {
    /// The term without a direction, `I_a` (CA DD3).
    pub ambient: Vec3,
    /// The term scattered in all directions, `I_d` (CA DD4).
    pub diffuse: Vec3,
    /// The term concentrated around the mirror direction, `I_s` (CA DD5).
    pub specular: Vec3,
    /// The term of the light that comes through the surface, `I_t`; zero for light from the viewer's side, and for
    /// models that only reflect.
    pub transmitted: Vec3,
}

impl From<[Vec3; TERMS]> for Terms {
    fn from([ambient, diffuse, specular, transmitted]: [Vec3; TERMS]) -> Self {
        Self { ambient, diffuse, specular, transmitted }
    }
}

/// The number of terms.
pub const TERMS: usize = 4;

impl Terms {
    /// Light reflected in a diffuse and a specular term.
    #[must_use]
    #[inline]
    pub fn of(diffuse: Vec3, specular: Vec3) -> Self {
        Self { ambient: Vec3::ZERO, diffuse, specular, transmitted: Vec3::ZERO }
    }

    /// Light that comes through the surface.
    #[must_use]
    #[inline]
    pub fn through(transmitted: Vec3) -> Self {
        Self { transmitted, ..Self::default() }
    }

    /// The terms as shaders return them: three, whose sum is the transmitted term if light and viewer are on different sides
    /// of a surface that transmits.
    #[must_use]
    pub fn of_shader([ambient, diffuse, specular]: [Vec3; 3], through: bool) -> Self {
        if through {
            return Self::through(ambient + diffuse + specular);
        }
        Self { ambient, ..Self::of(diffuse, specular) }
    }

    /// The ambient, the diffuse, the specular and the transmitted term.
    #[must_use]
    pub fn each(self) -> [Vec3; TERMS] {
        [self.ambient, self.diffuse, self.specular, self.transmitted]
    }

    /// The selected terms; the others are zero.
    #[must_use]
    pub fn only(self, selection: TermSelection) -> Self {
        match selection {
            TermSelection::All => self,
            TermSelection::Ambient => Self { ambient: self.ambient, ..Self::default() },
            TermSelection::Diffuse => Self { diffuse: self.diffuse, ..Self::default() },
            TermSelection::Specular => Self { specular: self.specular, ..Self::default() },
            TermSelection::Transmitted => Self::through(self.transmitted),
        }
    }

    /// The sum of the selected terms.
    #[must_use]
    pub fn select(self, selection: TermSelection) -> Vec3 {
        match selection {
            TermSelection::All => {
                let reflected = self.ambient + self.diffuse + self.specular;
                // Adding 0 would take time in each model that only reflects.
                if self.transmitted == Vec3::ZERO { reflected } else { reflected + self.transmitted }
            }
            TermSelection::Ambient => self.ambient,
            TermSelection::Diffuse => self.diffuse,
            TermSelection::Specular => self.specular,
            TermSelection::Transmitted => self.transmitted,
        }
    }
}

ids! {
    /// The displayed terms of the equation: a teaching aid that shows each part of `I = I_a + I_d + I_s + I_t` alone. Shaders
    /// have their numbers, `TERM_…` in `lights.wgsl`.
    #[derive(Default)]
    TermSelection {
        /// The whole equation.
        #[default]
        All = "all",
        /// `I_a` alone. Ambient lights belong to this term.
        Ambient = "ambient",
        /// `I_d` alone.
        Diffuse = "diffuse",
        /// `I_s` alone.
        Specular = "specular",
        /// `I_t` alone.
        Transmitted = "transmitted",
    }
}
