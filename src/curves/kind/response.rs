//! `π f cos θ_i`: the response of the program, 1 for a white matte surface that faces the light.

use std::f32::consts::PI;

use super::{
    Declaration,
    declaration::{light, seen},
};

pub(super) static KIND: Declaration = Declaration {
    id: "pi_f_cos",
    name: "response",
    remark: "the response",
    row: "the response π f cos θ: 1 for a white matte surface that faces the light",
    choice: [
        "Response π f cos θ",
        "π f cos θ_i: the response, which the picture shows. It is 1 for a white matte surface that faces the light.",
    ],
    quantity: "π f cos θ",
    column: "pi_f_cos",
    of_measured: Some(|cos| PI * cos),
    value: |subject, setup, angle| {
        let l = light(setup);
        PI * l.z * subject.brdf(l, seen(setup, angle))
    },
    ..Declaration::IN_PLANE
};
