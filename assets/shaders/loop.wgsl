// The light loop: the colour of a point with a unit normal and a tangent under all lights, linear,
// before exposure. `illumination`, `light_at`, `parameters` and `observer_position` come from the wrapper.
fn illuminate(position: vec3<f32>, normal: vec3<f32>, tangent: vec3<f32>) -> vec3<f32> {
    // An interpolated normal may face away from a viewer who still sees the surface: the viewer is then
    // mirrored in the surface, or rims would be black.
    let eye = unit_or_zero(observer_position() - position);
    let v = eye - 2.0 * min(dot(normal, eye), 0.0) * normal;
    let frame = frame_new(normal, tangent);
    var colour = vec3(0.0);
    let count = min(illumination.count, MAX_LIGHTS);
    let selection = illumination.terms;
    for (var i = 0u; i < count; i++) {
        let light = light_at(i);
        let arriving = incident(light, position);
        var terms: Terms;
        if arriving.everywhere != 0u {
            terms = Terms(ambient_response(v, frame, parameters), vec3(0.0), vec3(0.0));
        } else {
            terms = response(arriving.l, v, frame, parameters);
        }
        colour += select_terms(terms, on_side(selection, dot(frame.n, arriving.l))) * arriving.intensity * light.colour;
    }
    return colour + extended(position, v, frame) + through(position, v, frame, selection);
}
