//! `f cos θ_i` in sr⁻¹: the light that leaves, per unit of irradiance at normal incidence.

use super::{
    Declaration,
    declaration::{light, seen},
};

pub(super) static KIND: Declaration = Declaration {
    id: "f_cos",
    name: "BRDF times the cosine of the light",
    row: "the same times cos θ of the light",
    choice: [
        "f cos θ",
        "f cos θ_i in sr⁻¹: the light that leaves towards the viewer, per unit of irradiance at normal incidence.",
    ],
    quantity: "f cos θ (sr⁻¹)",
    column: "f_cos",
    of_measured: Some(|cos| cos),
    value: |subject, setup, angle| {
        let l = light(setup);
        l.z * subject.brdf(l, seen(setup, angle))
    },
    ..Declaration::IN_PLANE
};
