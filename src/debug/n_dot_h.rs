//! The cosine between normal and half vector.

use super::{Declaration, Legend, Made, Shows};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "n_dot_h",
    name: "N·H",
    explanation: "The cosine of the angle between the interpolated normal and the half vector, which is midway between \
        light and observer. Highlights of Blinn–Phong and of microfacet models are where it is nearly 1.",
    legend: |about| Legend::lit_cosine("N·H", about),
    has_light: true,
    shows: Shows::Geometry(
        |point| Made::cosine((point.l)().map(|l| point.normal.dot((l + point.v).normalize_or_zero()))),
        "return channel_lit(dot(normal, unit_or_zero(channel_to_light(position) + v)));",
    ),
    ..Declaration::PLAIN
};
