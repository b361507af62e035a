// Modified Lambert, diffuse wrap: max(0, (N·L) k_d + (1 − k_d))^p C_b.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let wrapped = dot(frame.n, l) * m.k_d + (1.0 - m.k_d);
    return Terms(vec3(0.0), power(max(wrapped, 0.0), m.wrap_exponent) * m.base_colour, vec3(0.0));
}

fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return m.base_colour;
}
