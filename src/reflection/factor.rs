//! The factors of a microfacet lobe, one by one.

use glam::Vec3;

use crate::optics::interface::Interface;

/// A factor of the lobe `D F G / (4 (N·L)(N·V))`, with the directions or the angle at which it is evaluated.
/// All vectors are unit vectors in the local frame (normal +z, tangent +x), above the surface.
///
/// K. E. Torrance, E. M. Sparrow (1967), *Theory for Off-Specular Reflection from Roughened Surfaces*; R. L. Cook,
/// K. E. Torrance (1982), *A Reflectance Model for Computer Graphics*.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Factor {
    /// `F`: the fraction of light that a facet reflects, 0 to 1, in red, green and blue.
    Fresnel {
        /// The cosine of the angle θ_d between the light and the normal of the facet, 0 to 1.
        cos_d: f32,
    },
    /// `D` in sr⁻¹: the distribution of the normals of facets, with `∫ D cos θ_h dω = 1`. Equal in all three channels.
    Distribution {
        /// The normal of the facet.
        h: Vec3,
    },
    /// `G`: the fraction of the facets that are both lit and visible, 0 to 1. Equal in all three channels.
    Masking {
        /// Direction to the light.
        l: Vec3,
        /// Direction to the viewer.
        v: Vec3,
    },
}

impl Factor {
    /// The factor from the functions of a model: `F(cos_d)`, `D(h)`, and the quotient `G / (4 (N·L)(N·V))` of `l` and
    /// `v`.
    #[must_use]
    pub fn by(
        self,
        fresnel: impl Fn(f32) -> Vec3,
        distribution: impl Fn(Vec3) -> f32,
        visibility: impl Fn(Vec3, Vec3) -> f32,
    ) -> Option<Vec3> {
        Some(match self {
            Self::Fresnel { cos_d } => fresnel(cos_d),
            Self::Distribution { h } => Vec3::splat(distribution(h)),
            Self::Masking { l, v } => Vec3::splat(4.0 * l.z * v.z * visibility(l, v)),
        })
    }

    /// The factor of the light that a rough boundary reflects.
    pub(super) fn of_boundary(self, interface: &Interface) -> Option<Vec3> {
        self.by(
            |cos_d| Vec3::splat(interface.reflectance(cos_d)),
            |h| interface.distribution(h),
            |l, v| interface.visibility(l, v),
        )
    }
}
