// Glass: the outer boundary of a solid body (A. Fresnel 1823; rough: B. Walter and others 2007). What comes through follows the
// mesh of the object, in inside.wgsl.

// The roughness; smooth below MINIMUM_ALPHA.
fn glass_alpha(m: Parameters) -> f32 {
    return m.roughness * m.roughness;
}

fn response(l_room: vec3<f32>, v_room: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let l = to_local(frame, l_room);
    let v = to_local(frame, v_room);
    let alpha = glass_alpha(m);
    if v.z <= 0.0 || l.z <= 0.0 || alpha < MINIMUM_ALPHA {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let f = interface_bsdf(Interface(0u, vec2(alpha), m.refractive_index), l, v);
    return Terms(vec3(0.0), vec3(0.0), vec3(PI * l.z * f));
}

fn sharp(i: u32, v: vec3<f32>, frame: Frame, m: Parameters) -> Sharp {
    let cosine = dot(frame.n, v);
    if i > 0u || cosine <= 0.0 || glass_alpha(m) >= MINIMUM_ALPHA {
        return Sharp(-v, vec3(0.0));
    }
    return Sharp(mirror(v, frame.n), vec3(dielectric(m.refractive_index, cosine)));
}
