// Flat shading: one colour per polygon, calculated at its centre with its face normal. Every
// corner of a polygon calculates the same colour, so interpolation leaves it constant.

fn shade_vertex(corner: Corner) -> Varying {
    let colour = illuminate(corner.face_centre, corner.face_normal, corner.face_tangent);
    return Varying(corner.position, corner.face_normal, corner.face_tangent, colour, vec3(0.0));
}

fn shade_pixel(passed: Varying) -> vec3<f32> {
    return passed.colour;
}
