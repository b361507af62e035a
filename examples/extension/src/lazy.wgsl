// Phong shading that brings interpolated normals back to length 1 in part only.
fn shade_vertex(corner: Corner) -> Varying {
    return Varying(corner.position, corner.normal, corner.tangent, vec3(0.0), vec3(0.0));
}

fn shade_pixel(passed: Varying) -> vec3<f32> {
    let normal = mix(passed.normal, unit_or_zero(passed.normal), shading_parameters().share);
    return illuminate(passed.position, normal, passed.tangent);
}
