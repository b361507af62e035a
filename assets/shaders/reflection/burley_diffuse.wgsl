// Burley diffuse (B. Burley 2012).
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(frame.n, l);
    let cos_v = dot(frame.n, v);
    if cos_l <= 0.0 || cos_v <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let factor = burley(cos_l, cos_v, 0.5 * length(l + v), m.roughness);
    return Terms(vec3(0.0), factor * cos_l * m.base_colour, vec3(0.0));
}
