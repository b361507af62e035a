// M. Minnaert (1941): a power of both cosines, reciprocal.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_i = dot(frame.n, l);
    let cos_o = dot(frame.n, v);
    if cos_i <= 0.0 || cos_o <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let k = m.limb_darkening;
    // Within 0.06° of the horizon the power is constant.
    let f = 0.5 * (k + 1.0) * power(max(cos_i, 0.001), k - 1.0) * power(max(cos_o, 0.001), k - 1.0);
    return Terms(vec3(0.0), f * cos_i * m.base_colour, vec3(0.0));
}
