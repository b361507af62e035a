// Phong shading (B. T. Phong 1975): normals interpolated and renormalised, colour per pixel.

fn shade_vertex(corner: Corner) -> Varying {
    return Varying(corner.position, corner.normal, corner.tangent, vec3(0.0), vec3(0.0));
}

fn shade_pixel(passed: Varying) -> vec3<f32> {
    return illuminate(passed.position, unit_or_zero(passed.normal), passed.tangent);
}
