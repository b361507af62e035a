//! The light inside solid bodies that is not followed any further.

use super::{Declaration, Legend, Made, Shows, colours::NAN};

/// The largest part that is drawn black.
const LEAST: f32 = 1e-4;

pub(super) static CHANNEL: Declaration = Declaration {
    id: "remaining_light",
    name: "Remaining light",
    explanation: "The part of the light that is still inside a solid body after 16 boundaries, where it is not followed any \
        further: what the picture lacks there. A ball keeps almost nothing, a cut gem and the edges of a cube more. Other \
        objects are black.",
    legend: |_| {
        Legend::new("Light left inside after 16 boundaries, as a fraction")
            .scale(["0.0001", "0.01", "1"])
            .colours(&[([0; 3], "less than 0.0001"), (NAN, "not a number")])
    },
    of_remaining: true,
    shows: Shows::Light(
        |leaving| match leaving.bright {
            ..LEAST => Made::colour([0; 3]),
            bright => Made::Place((bright.log10() + 4.0) / 4.0),
        },
        include_str!("remaining_light.wgsl"),
    ),
    ..Declaration::PLAIN
};
