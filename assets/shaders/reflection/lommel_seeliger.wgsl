// H. Seeliger (1888), E. Lommel (1889): single scattering in a deep powder.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_i = dot(frame.n, l);
    let cos_o = dot(frame.n, v);
    if cos_i <= 0.0 || cos_o <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    return Terms(vec3(0.0), 0.5 * m.base_colour * (cos_i / (cos_i + cos_o)), vec3(0.0));
}
