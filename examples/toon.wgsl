// Lambert in a few tones: I_d = ceil(n max(0, N·L)) C_b / n.
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let tone = ceil(m.tones * max(dot(frame.n, l), 0.0)) / m.tones;
    return Terms(vec3(0.0), tone * m.base_colour, vec3(0.0));
}

fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return m.base_colour;
}
