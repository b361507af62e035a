//! The distribution `D` of microfacet normals in sr⁻¹ by the angle θ_h from the normal.

use glam::Vec3;

use super::{Declaration, Horizontal};
use crate::{
    curves::angles::{GRAZING, grid},
    optics::geometry::direction,
    reflection::Factor,
};

pub(super) static KIND: Declaration = Declaration {
    id: "d",
    name: "distribution D of microfacets",
    remark: "factors of microfacet models",
    row: "the distribution D of microfacets by the angle from the normal",
    choice: [
        "Distribution D",
        "How the normals of the microfacets are spread: D in sr⁻¹ by their angle from the normal of the surface. A factor of microfacet models.",
    ],
    quantity: "D (sr⁻¹)",
    column: "d",
    symbols: |_| &["D", "D_s"],
    horizontal: Horizontal::from_normal("angle between normal and half vector (°)"),
    has_light: false,
    is_scalar: true,
    factor: Some(Factor::Distribution { h: Vec3::Z }),
    value: |subject, setup, angle| {
        let h = direction(angle, setup.phi_i);
        subject.factor(Factor::Distribution { h }).unwrap_or(Vec3::NAN)
    },
    angles: |_, _| grid(0, 89, 1, &[0.05, 0.5, GRAZING]),
    ..Declaration::UNMEASURED
};
