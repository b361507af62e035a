// Lambert (J. H. Lambert 1760): max(0, N·L) C_b.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), max(dot(frame.n, l), 0.0) * m.base_colour, vec3(0.0));
}

fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return m.base_colour;
}
