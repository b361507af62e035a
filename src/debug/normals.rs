//! The vertex normals, interpolated.

use super::{AXES, Declaration, Legend, Made, Shows};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "normals",
    name: "Interpolated normals",
    explanation: "The unit normals of the vertices, interpolated across each triangle and renormalised: (1 + N)/2 as \
        display codes. Phong shading calculates with them. Where they change smoothly, so does the shading, \
        whatever the triangles are.",
    legend: |_| Legend::new("Interpolated normals: x, y, z as red, green, blue").colours(&AXES),
    shows: Shows::Geometry(|point| Made::Direction(point.normal), "return vec4(normal, CHANNEL_DIRECTION);"),
    ..Declaration::PLAIN
};
