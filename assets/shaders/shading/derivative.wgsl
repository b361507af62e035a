// Derivative shading (LC3): the face normal from the derivatives of position on the screen, colour
// per pixel. The screen's y points down, hence dpdy first.

fn shade_vertex(corner: Corner) -> Varying {
    return Varying(corner.position, corner.normal, corner.tangent, vec3(0.0), vec3(0.0));
}

fn shade_pixel(passed: Varying) -> vec3<f32> {
    let normal = unit_or_zero(cross(dpdy(passed.offset), dpdx(passed.offset)));
    return illuminate(passed.position, normal, passed.tangent);
}
