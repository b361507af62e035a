//! The side of the interpolated normal on which the observer is.

use super::{
    Declaration, Legend, Made, Shows,
    colours::{AWAY, TOWARDS, codes},
};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "facing",
    name: "Facing",
    explanation: "Every triangle in the picture faces the observer, but an interpolated normal need not: where it \
        looks away, the light loop mirrors the observer in the surface. Brighter is more direct.",
    legend: |_| {
        Legend::new("Facing, by the interpolated normal")
            .colours(&[(TOWARDS, "towards the observer"), (AWAY, "away")])
    },
    shows: Shows::Geometry(
        |point| {
            let facing = point.normal.dot(point.v);
            Made::Codes((0.5 + 0.5 * facing.abs()) * codes(if facing < 0.0 { AWAY } else { TOWARDS }))
        },
        "
    let facing = dot(normal, v);
    let colour = select(CHANNEL_BLUE, CHANNEL_RED, facing < 0.0);
    return vec4((0.5 + 0.5 * abs(facing)) * colour, CHANNEL_CODES);
",
    ),
    ..Declaration::PLAIN
};
