//! The pixels that the display cuts off.

use glam::Vec3;

use super::{
    Declaration, Leaving, Legend, Made, Shows,
    colours::{CLIPPED, NAN},
};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "clipped",
    name: "Clipped pixels",
    explanation: "Stripes where red, green or blue is above 1 after exposure: the display cuts that off. Tone mapping, \
        which this channel leaves out, may bring it back.",
    legend: |_| {
        Legend::new("Clipped pixels, before tone mapping")
            .colours(&[(CLIPPED, "striped: above 1"), (NAN, "not a number")])
    },
    shows: Shows::Light(clipped, include_str!("clipped.wgsl")),
    ..Declaration::PLAIN
};

/// Value above which a channel of the picture counts as clipped.
const WHITE: f32 = 1.0005;
/// Width of a diagonal stripe, in pixels.
const STRIPE: u32 = 4;

fn clipped(leaving: &Leaving<'_>) -> Made {
    if leaving.exposed.max_element() > WHITE {
        let [x, y] = (leaving.pixel)();
        return Made::colour(if (x + y) / STRIPE % 2 == 1 { [0; 3] } else { CLIPPED });
    }
    let shown = leaving.exposed.clamp(Vec3::ZERO, Vec3::ONE);
    if leaving.unencoded { Made::Codes(shown) } else { Made::Light(shown) }
}
