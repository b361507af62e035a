//! Light that is not a number, infinite or below 0.

use glam::Vec3;

use super::{
    Declaration, Legend, Made, Shows,
    colours::{INFINITE, NAN, NEGATIVE},
};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "not_a_number",
    name: "Not a number",
    explanation: "Light that is no light: not a number (0/0, the root of a negative number), infinite (1/0) or below \
        0. The picture hides what it cannot show; here nothing is hidden. All else is dim and grey.",
    legend: |_| {
        Legend::new("Light that is not a number").colours(&[
            (NAN, "not a number"),
            (INFINITE, "infinite"),
            (NEGATIVE, "below 0"),
        ])
    },
    shows: Shows::Light(
        |leaving| match leaving.light {
            light if !light.is_finite() => Made::colour(INFINITE),
            light if light.min_element() < 0.0 => Made::colour(NEGATIVE),
            _ => Made::Light(Vec3::splat(0.25 * (leaving.bright * leaving.exposure).clamp(0.0, 1.0))),
        },
        include_str!("not_a_number.wgsl"),
    ),
    ..Declaration::PLAIN
};
