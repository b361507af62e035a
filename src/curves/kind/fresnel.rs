//! The reflectance `F` of a facet by the angle between light and facet.

use glam::Vec3;

use super::{Declaration, Horizontal};
use crate::{curves::angles::grid, optics::geometry::direction, reflection::Factor};

pub(super) static KIND: Declaration = Declaration {
    id: "fresnel",
    name: "Fresnel factor F",
    row: "the Fresnel factor F by the angle between light and facet",
    choice: [
        "Fresnel factor F",
        "The part of the light that a mirror of this material reflects, by the angle between light and facet. A factor of microfacet models.",
    ],
    quantity: "F",
    column: "fresnel",
    symbols: |_| &["F", "F_s"],
    horizontal: Horizontal::from_normal("angle between light and facet (°)"),
    has_light: false,
    has_azimuth: false,
    up_to_one: true,
    factor: Some(Factor::Fresnel { cos_d: 1.0 }),
    value: |subject, _, angle| {
        let cos_d = direction(angle, 0.0).z;
        subject.factor(Factor::Fresnel { cos_d }).unwrap_or(Vec3::NAN)
    },
    angles: |_, _| grid(0, 90, 2, &[]),
    ..Declaration::UNMEASURED
};
