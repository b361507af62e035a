// Rough dielectric (B. Walter, S. Marschner, H. Li, K. Torrance 2007): a rough boundary between air and a clear body.

fn rough_dielectric_interface(m: Parameters) -> Interface {
    let alpha = max(vec2(m.alpha_x, m.alpha_y), vec2(MINIMUM_ALPHA));
    return Interface(1u - m.facets, alpha, m.refractive_index);
}

fn response(l_room: vec3<f32>, v_room: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let l = to_local(frame, l_room);
    let v = to_local(frame, v_room);
    if v.z <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let f = interface_bsdf(rough_dielectric_interface(m), l, v);
    return Terms(vec3(0.0), vec3(0.0), vec3(PI * abs(l.z) * f));
}

// An invisible boundary lets light go straight on.
fn sharp(i: u32, v: vec3<f32>, frame: Frame, m: Parameters) -> Sharp {
    let straight = i == 1u && is_matched(m.refractive_index) && dot(frame.n, v) > 0.0;
    return Sharp(-v, vec3(select(0.0, 1.0, straight)));
}
