// Ward (G. J. Ward 1992), and with the normalisation of A. Dür (2006).
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(frame.n, l);
    let cos_v = dot(frame.n, v);
    if cos_l <= 0.0 || cos_v <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let scaled = half_slope(l, v, frame) / vec2(m.alpha_x, m.alpha_y);
    var specular = m.k_s * exp(-dot(scaled, scaled)) / (4.0 * m.alpha_x * m.alpha_y * max(cos_v, 1e-12));
    if m.ward_form == 0u {
        specular *= sqrt(cos_l * max(cos_v, 1e-12));
    }
    return Terms(vec3(0.0), (1.0 - m.k_s) * cos_l * m.base_colour, specular * m.specular_colour);
}
