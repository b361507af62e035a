//! The normals of the vertices, as lines.

use super::{AXES, Declaration, Legend, Shows};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "vertex_normals",
    name: "Vertex normals",
    explanation: "A line at each visible vertex along its normal, which is the mean of those of its polygons or comes \
        from the file of the mesh; its colour is (1 + N)/2 as display codes. The surface is dim and grey. \
        Where the lines stand askew on the polygons, smooth shading and true shape differ.",
    legend: |_| Legend::new("Vertex normals").colours(&AXES),
    shows: Shows::Normals(|vertex| vertex.codes_of_normal()),
    ..Declaration::PLAIN
};
