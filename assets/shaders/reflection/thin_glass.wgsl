// Thin glass: the sums of G. G. Stokes (1862) for a plate; rough, it transmits the lobe that it reflects, mirrored in the
// surface (C. Kulla, A. Conty 2017).

// The roughness; smooth below MINIMUM_ALPHA.
fn thin_glass_alpha(m: Parameters) -> f32 {
    return m.roughness * m.roughness;
}

fn thin_glass_pane(cosine: f32, m: Parameters) -> Slab {
    let kept = oblique(m.transmittance_colour, refracted_cosine(cosine, m.refractive_index));
    return slab(vec3(dielectric(m.refractive_index, cosine)), kept);
}

fn response(l_room: vec3<f32>, v_room: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let l = to_local(frame, l_room);
    let v = to_local(frame, v_room);
    let alpha = vec2(thin_glass_alpha(m));
    if v.z <= 0.0 || l.z == 0.0 || alpha.x < MINIMUM_ALPHA {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    // From behind, mirrored to the side of the viewer.
    let near = vec3(l.xy, abs(l.z));
    let h = half_vector(near, v);
    let masked = height_correlated(near.z, v.z, smith_ggx(near, alpha), smith_ggx(v, alpha));
    let single = PI * near.z * ggx(h, alpha) * masked;
    let lost = lobe_loss(near.z) * lobe_loss(v.z);
    let bounced = lost / max(1.0 - average_lobe_albedo(), 2e-3) * near.z;
    let once = thin_glass_pane(dot(h, v), m);
    let often = thin_glass_pane(2.0 / 3.0, m);
    if l.z < 0.0 {
        return Terms(vec3(0.0), vec3(0.0), single * once.transmittance + bounced * often.transmittance);
    }
    return Terms(vec3(0.0), vec3(0.0), single * once.reflectance + bounced * often.reflectance);
}

fn sharp(i: u32, v: vec3<f32>, frame: Frame, m: Parameters) -> Sharp {
    let cosine = dot(frame.n, v);
    if cosine <= 0.0 || thin_glass_alpha(m) >= MINIMUM_ALPHA {
        return Sharp(-v, vec3(0.0));
    }
    let pane = thin_glass_pane(cosine, m);
    if i == 0u {
        return Sharp(mirror(v, frame.n), pane.reflectance);
    }
    return Sharp(-v, pane.transmittance);
}
