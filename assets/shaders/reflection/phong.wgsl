// Phong (B. T. Phong 1975): I_a + I_d + I_s, the highlight around the mirror direction.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_i = dot(frame.n, l);
    var specular = vec3(0.0);
    if cos_i > 0.0 {
        specular = m.k_s * power(max(dot(mirror(l, frame.n), v), 0.0), m.alpha) * m.specular_colour;
    }
    return Terms(m.k_a * m.base_colour, m.k_d * max(cos_i, 0.0) * m.base_colour, specular);
}

fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return m.k_a * m.base_colour;
}
