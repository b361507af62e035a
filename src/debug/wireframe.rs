//! The edges of the polygons.

use super::{
    Declaration, Legend, Shows,
    colours::{EDGE, NAN},
};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "wireframe",
    name: "Wireframe",
    explanation: "The visible edges of the polygons over the dim grey surface; the diagonals along which quadrangles \
        are cut into triangles are left out. The tessellation shows, and with it where Gouraud shading can \
        miss a highlight.",
    legend: |_| {
        Legend::new("Wireframe: visible edges of polygons").colours(&[(EDGE, "edge"), (NAN, "not a number")])
    },
    shows: Shows::Edges,
    ..Declaration::PLAIN
};
