// Phong shading in bands of equal light.
fn shade_vertex(corner: Corner) -> Varying {
    return Varying(corner.position, corner.normal, corner.tangent, vec3(0.0), vec3(0.0));
}

fn shade_pixel(passed: Varying) -> vec3<f32> {
    let steps = shading_parameters().steps;
    let colour = illuminate(passed.position, unit_or_zero(passed.normal), passed.tangent);
    // The hue stays: the brightest channel is put on a step, and the others follow.
    let brightest = max(max(colour.r, max(colour.g, colour.b)), 1e-6);
    return colour * (ceil(steps * brightest) / (steps * brightest));
}
