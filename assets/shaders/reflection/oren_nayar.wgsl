// Oren–Nayar (M. Oren, S. K. Nayar 1994).
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(frame.n, l);
    let cos_v = dot(frame.n, v);
    if cos_l <= 0.0 || cos_v <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let sigma = radians(m.sigma);
    var factor = vec3(0.0);
    if m.oren_nayar_form == 0u {
        factor = oren_nayar_full(cos_l, cos_v, dot(l, v), sigma, m.base_colour);
    } else {
        factor = vec3(oren_nayar_qualitative(cos_l, cos_v, dot(l, v), sigma));
    }
    return Terms(vec3(0.0), factor * m.base_colour * cos_l, vec3(0.0));
}
