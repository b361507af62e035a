// Gouraud shading (H. Gouraud 1971): colour calculated at the vertices, interpolated.

fn shade_vertex(corner: Corner) -> Varying {
    let colour = illuminate(corner.position, corner.normal, corner.tangent);
    return Varying(corner.position, corner.normal, corner.tangent, colour, vec3(0.0));
}

fn shade_pixel(passed: Varying) -> vec3<f32> {
    return passed.colour;
}
