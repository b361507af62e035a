//! The vertices, as dots.

use super::{AXES, Declaration, Legend, Shows};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "vertices",
    name: "Vertices",
    explanation: "A dot at each visible vertex over the dim grey surface: with Gouraud shading in the colour that is \
        calculated there, between which the picture interpolates; otherwise in that of its normal, \
        (1 + N)/2 as display codes.",
    legend: |about| match (about.vertices)() {
        [true, false] => Legend::new("Vertices: the colour calculated there (Gouraud)"),
        [true, true] => {
            Legend::new("Vertices: Gouraud colour; where there is none, the normal").colours(&AXES)
        }
        _ => Legend::new("Vertices: normals, x, y, z as red, green, blue").colours(&AXES),
    },
    legend_of_shading: true,
    shows: Shows::Dots(|vertex| vertex.colour.map_or_else(|| vertex.codes_of_normal(), |colour| colour())),
    ..Declaration::PLAIN
};
