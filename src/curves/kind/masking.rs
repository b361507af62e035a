//! The masking `G` in the plane of incidence.

use glam::Vec3;

use super::{
    Declaration,
    declaration::{light, seen},
};
use crate::reflection::Factor;

pub(super) static KIND: Declaration = Declaration {
    id: "g",
    name: "masking factor G",
    remark: "factors of microfacet models",
    row: "the masking factor G by the angle of the viewer, in the plane of incidence",
    choice: [
        "Masking G",
        "The part of the microfacets that is neither in shadow nor hidden by others. A factor of microfacet models.",
    ],
    quantity: "G",
    column: "g",
    symbols: |_| &["G", "G_2", "G_s"],
    is_scalar: true,
    up_to_one: true,
    factor: Some(Factor::Masking { l: Vec3::Z, v: Vec3::Z }),
    value: |subject, setup, angle| {
        let (l, v) = (light(setup), seen(setup, angle));
        subject.factor(Factor::Masking { l, v }).unwrap_or(Vec3::NAN)
    },
    ..Declaration::UNMEASURED
};
