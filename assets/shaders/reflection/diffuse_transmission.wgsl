// Diffuse transmission: Lambert's law on both sides. Where the two colours add up to more than 1, both are scaled.

fn diffuse_transmission_scale(m: Parameters) -> vec3<f32> {
    return vec3(1.0) / max(m.base_colour + m.transmittance_colour, vec3(1.0));
}

fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(frame.n, l);
    if dot(frame.n, v) <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let colour = select(m.base_colour, m.transmittance_colour, cos_l < 0.0);
    return Terms(vec3(0.0), abs(cos_l) * colour * diffuse_transmission_scale(m), vec3(0.0));
}

fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return (m.base_colour + m.transmittance_colour) * diffuse_transmission_scale(m);
}
