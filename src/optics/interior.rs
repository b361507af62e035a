//! The inside of a solid body.

use glam::{Vec3, Vec4};

use super::{
    Frame, absorption, dispersion,
    distribution::MINIMUM_ALPHA,
    fresnel::dielectric,
    geometry::mirror,
    refraction::is_matched,
    sharp::{Sharp, Sharps},
    slab::slab,
};

/// The optical properties of a solid body, at its boundary and inside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interior {
    /// Refractive index relative to the room, at the [d line](dispersion::LINES).
    pub ior: f32,
    /// Coefficient B of [Cauchy's equation](dispersion::cauchy), µm²; 0 without dispersion.
    pub cauchy_b: f32,
    /// Width α of the facets of the boundary; 0 for a smooth one.
    pub alpha: f32,
    /// [Absorption coefficient](absorption::coefficient) σ for red, green and blue, 1/m.
    pub absorption: Vec3,
}

impl Interior {
    /// No body at all.
    pub const AIR: Self = Self { ior: 1.0, cauchy_b: 0.0, alpha: 0.0, absorption: Vec3::ZERO };

    /// The body for light of a wavelength in nanometres alone, which is not dispersed.
    #[must_use]
    pub fn at(&self, nm: f32) -> Self {
        Self { ior: dispersion::cauchy(self.ior, self.cauchy_b, nm), cauchy_b: 0.0, ..*self }
    }

    /// True if light takes one of many ways through the boundary, by chance. Facets of an [invisible](is_matched) boundary
    /// turn no light.
    #[must_use]
    pub fn is_rough(&self) -> bool {
        let is_invisible = self.cauchy_b == 0.0 && is_matched(self.ior);
        self.alpha >= MINIMUM_ALPHA && !is_invisible
    }

    /// η for a ray that enters: the refractive index, or 1 for a body whose boundary is [invisible](is_matched).
    #[must_use]
    pub fn eta(&self) -> f32 {
        if is_matched(self.ior) { 1.0 } else { self.ior }
    }

    /// The pane that stands for a body without an inside: the light that two faces without distance transmit, and that
    /// they reflect in addition to the first one.
    #[must_use]
    pub fn pane(&self, v: Vec3, frame: &Frame) -> Sharps {
        let cosine = frame.n.dot(v);
        if cosine <= 0.0 {
            return Sharps::new();
        }
        let first = dielectric(self.eta(), cosine);
        let both = slab(Vec3::splat(first), Vec3::ONE);
        let more = (both.reflectance - first).max(Vec3::ZERO);
        Sharps::from([Sharp::reflected(mirror(v, frame.n), more), Sharp::transmitted(-v, both.transmittance)])
    }

    /// The two rows of shaders; with the normals of polygons instead of vertices if `by_polygon`.
    #[must_use]
    pub fn rows(&self, by_polygon: bool) -> [Vec4; 2] {
        let normals = if by_polygon { 1.0 } else { 0.0 };
        let alpha = if self.is_rough() { self.alpha } else { 0.0 };
        [Vec4::new(self.ior, self.cauchy_b, alpha, normals), self.absorption.extend(0.0)]
    }

    /// The part of the light left after a way in metres.
    #[must_use]
    pub fn left(&self, length: f32) -> Vec3 {
        // Clear glass needs no exponentials.
        if self.absorption == Vec3::ZERO { Vec3::ONE } else { absorption::left(self.absorption, length) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blue_light_is_bent_more_and_a_matched_body_not_at_all() {
        let flint = Interior {
            ior: 1.62,
            cauchy_b: dispersion::cauchy_of_abbe(1.62, 36.0),
            alpha: 0.0,
            absorption: Vec3::new(0.1, 0.0, 2.0),
        };
        let [f, d, c] = dispersion::LINES.map(|nm| flint.at(nm).ior);
        assert!((d - 1.62).abs() < 1e-6 && ((d - 1.0) / (f - c) - 36.0).abs() < 0.01, "{f} {d} {c}");
        assert_eq!(flint.at(400.0).at(700.0), flint.at(400.0));
        assert_eq!((flint.eta(), Interior { ior: 1.000_5, ..flint }.eta()), (1.62, 1.0));
        let rough = Interior { alpha: 0.3, ..flint };
        let matched = Interior { ior: 1.0, cauchy_b: 0.0, ..rough };
        assert!(rough.is_rough() && !matched.is_rough() && Interior { ior: 1.0, ..rough }.is_rough());
        assert_eq!((rough.rows(false)[0].z, matched.rows(false)[0].z), (0.3, 0.0));
        assert!((flint.left(0.5) - Vec3::new(-0.05, 0.0, -1.0).exp()).length() < 1e-6);
    }
}
