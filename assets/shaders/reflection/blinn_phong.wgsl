// Blinn–Phong (J. Blinn 1977): Phong with the half vector.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_i = dot(frame.n, l);
    var specular = vec3(0.0);
    if cos_i > 0.0 {
        specular = m.k_s * power(max(dot(frame.n, half_vector(l, v)), 0.0), m.alpha) * m.specular_colour;
    }
    return Terms(m.k_a * m.base_colour, m.k_d * max(cos_i, 0.0) * m.base_colour, specular);
}

fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return m.k_a * m.base_colour;
}
