//! `f` as a polar plot: the length of the ray to each viewer.

use super::{Declaration, Form};

pub(super) static KIND: Declaration = Declaration {
    id: "polar",
    name: "BRDF",
    remark: "f as a polar plot",
    row: "the BRDF as a polar plot",
    choice: [
        "Polar lobe",
        "The BRDF around a point of the surface: the length of the ray to each viewer is f.",
    ],
    quantity: "f (sr⁻¹)",
    column: "f",
    form: Form::Polar,
    ..Declaration::IN_PLANE
};
