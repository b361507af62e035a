//! The luminance before exposure.

use glam::Vec3;

use super::{Declaration, Legend, Made, Shows, colours::NAN};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "luminance",
    name: "Luminance",
    explanation: "Y = 0.2126 R + 0.7152 G + 0.0722 B of the light that leaves the surface, before exposure and tone \
        mapping, on a logarithmic scale of four decades. 1 is white at 0 EV.",
    legend: |_| {
        Legend::new("Luminance, relative cd/m², before exposure")
            .scale(["0.001", "0.1", "10"])
            .colours(&[([0; 3], "none"), (NAN, "not a number")])
    },
    shows: Shows::Light(
        |leaving| match leaving.bright {
            bright if bright <= 0.0 => Made::Light(Vec3::ZERO),
            bright => Made::Place((bright.log10() + 3.0) / 4.0),
        },
        include_str!("luminance.wgsl"),
    ),
    ..Declaration::PLAIN
};
