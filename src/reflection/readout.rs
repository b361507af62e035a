//! Values derived from the parameters of a surface.

use glam::Vec3;

use crate::optics::{equivalence, fresnel::normal_reflectance, refraction::critical_angle};

/// A number or colour derived from the parameters of a surface.
#[derive(Clone, Debug, PartialEq)]
pub struct Readout {
    /// Symbol, e.g. `F_0`.
    pub symbol: &'static str,
    /// Name.
    pub label: &'static str,
    /// Meaning, in one sentence.
    pub help: &'static str,
    /// The number or colour.
    pub value: ReadoutValue,
}

impl Readout {
    /// The reflectance at normal incidence.
    #[must_use]
    pub fn of_f0(f0: Vec3) -> Self {
        Self {
            symbol: "F_0",
            label: "reflectance at normal incidence",
            help: "The fraction of light that the surface reflects at normal incidence, in red, green and blue.",
            value: ReadoutValue::Reflectance(f0),
        }
    }

    /// The reflectance at normal incidence and the critical angle of a clear body's refractive index.
    #[must_use]
    pub fn of_boundary(ior: f32) -> Vec<Self> {
        vec![
            Self::of_f0(Vec3::splat(normal_reflectance(ior, 0.0))),
            Self {
                symbol: "θ_c",
                label: "critical angle in degrees",
                help: "The largest angle from the inner normal at which light can leave the body, asin 1/n. Beyond it, all light is reflected back inside.",
                value: ReadoutValue::Number(critical_angle(ior).to_degrees()),
            },
        ]
    }

    /// The width of the distribution of microfacets.
    #[must_use]
    pub fn of_alpha(alpha: f32) -> Self {
        Self {
            symbol: "α",
            label: "width of the highlight",
            help: "The width of the distribution of microfacet slopes, on the scale of GGX and Beckmann; the square of the perceptual roughness.",
            value: ReadoutValue::Number(alpha),
        }
    }

    /// The width of the highlight on the scales of the microfacet models, from the exponent of the equally sharp
    /// Blinn–Phong lobe; see [`equivalence`].
    #[must_use]
    pub fn of_exponent(exponent: f32) -> Vec<Self> {
        let alpha = equivalence::alpha_of_exponent(exponent);
        vec![
            Self {
                symbol: "α_GGX",
                label: "equivalent GGX α",
                help: "The width of the GGX or Beckmann distribution as sharp as this highlight: √(2/(n + 2)) for Blinn–Phong's exponent n; Phong's n counts as 4n, since H turns half as far as R.",
                value: ReadoutValue::Number(alpha),
            },
            Self {
                symbol: "r",
                label: "equivalent roughness",
                help: "The roughness of metallic–roughness models with an equally sharp highlight: the square root of the width, r² = α.",
                value: ReadoutValue::Number(equivalence::roughness_of_alpha(alpha)),
            },
        ]
    }
}

/// The value of a [`Readout`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ReadoutValue {
    /// A number.
    Number(f32),
    /// A linear reflectance in red, green and blue.
    Reflectance(Vec3),
}
