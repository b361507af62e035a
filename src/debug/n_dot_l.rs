//! The cosine between normal and light.

use super::{Declaration, Legend, Made, Shows};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "n_dot_l",
    name: "N·L",
    explanation: "The cosine of the angle between the interpolated normal and the direction to the light, pixel by \
        pixel, whatever the shading model: the factor of Lambert’s law. Below 0 the light is behind the surface.",
    legend: |about| Legend::lit_cosine("N·L", about),
    has_light: true,
    shows: Shows::Geometry(
        |point| Made::cosine((point.l)().map(|l| point.normal.dot(l))),
        "return channel_lit(dot(normal, channel_to_light(position)));",
    ),
    ..Declaration::PLAIN
};
