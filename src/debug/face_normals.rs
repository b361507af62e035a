//! The normals of the triangles.

use super::{AXES, Declaration, Legend, Made, Shows};

pub(super) static CHANNEL: Declaration = Declaration {
    id: "face_normals",
    name: "Face normals",
    explanation: "The normal of the triangle in each pixel: (1 + N)/2 as display codes. Derivative shading calculates \
        with it, flat shading with that of the whole polygon. The true shape of the mesh shows.",
    legend: |_| Legend::new("Face normals: x, y, z as red, green, blue").colours(&AXES),
    shows: Shows::Geometry(
        |point| Made::Direction(point.face_normal),
        "return vec4(face_normal, CHANNEL_DIRECTION);",
    ),
    ..Declaration::PLAIN
};
