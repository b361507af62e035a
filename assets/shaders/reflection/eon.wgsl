// EON (J. Portsmouth, P. Kutz, S. Hill 2024).
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(frame.n, l);
    let cos_v = dot(frame.n, v);
    if cos_l <= 0.0 || cos_v <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let factor = eon(cos_l, cos_v, dot(l, v), m.roughness, m.base_colour);
    return Terms(vec3(0.0), factor * m.base_colour * cos_l, vec3(0.0));
}
