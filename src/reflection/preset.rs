//! Measured materials: optical constants from which models set their parameters.

use glam::Vec3;

/// A material whose refractive index was measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The name in files: lower case, underscores.
    pub id: &'static str,
    /// The name that people read.
    pub name: &'static str,
    /// Whether it is a metal: opaque, its colour is that of its reflection.
    pub metal: bool,
    /// Refractive index n at 630, 532 and 465 nm.
    pub n: [f32; 3],
    /// Extinction coefficient k at the same wavelengths; almost 0 for dielectrics.
    pub k: [f32; 3],
    /// Unpolarised reflectance at normal incidence, linear sRGB under D65, clamped to [0, 1].
    pub f0: Vec3,
    /// Who measured it, where published.
    pub source: &'static str,
}
