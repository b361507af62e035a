// Microfacet: D, G, F, diffuse base and multiple scattering as choices, in the order of their lists in
// src/reflection/microfacet.rs.

fn microfacet_alpha(m: Parameters) -> vec2<f32> {
    return max(vec2(m.alpha_x, m.alpha_y), vec2(MINIMUM_ALPHA));
}

fn microfacet_d(h: vec3<f32>, m: Parameters) -> f32 {
    let alpha = microfacet_alpha(m);
    switch m.distribution {
        case 0u: { return blinn_phong(h, alpha); }
        case 1u: { return beckmann(h, alpha); }
        case 2u: { return ggx(h, alpha); }
        default: { return gtr(h, alpha, m.gamma); }
    }
}

fn microfacet_lambda(d: vec3<f32>, m: Parameters) -> f32 {
    if m.distribution < 2u {
        return smith_beckmann(d, microfacet_alpha(m));
    }
    return smith_ggx(d, microfacet_alpha(m));
}

fn microfacet_visibility(l: vec3<f32>, v: vec3<f32>, h: vec3<f32>, m: Parameters) -> f32 {
    let cos_d = dot(h, l);
    switch m.masking {
        case 0u: { return implicit(); }
        case 1u: { return v_cavity(l.z, v.z, h.z, cos_d); }
        case 2u: { return neumann(l.z, v.z); }
        case 3u: { return kelemen(cos_d); }
        case 4u: {
            let alpha = microfacet_alpha(m);
            return schlick_smith(l.z, v.z, karis_k(sqrt(alpha.x * alpha.y)));
        }
        case 5u: { return separable(l.z, v.z, microfacet_lambda(l, m), microfacet_lambda(v, m)); }
        default: { return height_correlated(l.z, v.z, microfacet_lambda(l, m), microfacet_lambda(v, m)); }
    }
}

fn microfacet_f0(m: Parameters) -> vec3<f32> {
    if m.fresnel == 0u {
        return vec3(1.0);
    }
    return normal_reflectance_rgb(m.ior, select(m.extinction, vec3(0.0), m.fresnel == 2u));
}

fn microfacet_f(cos_d: f32, m: Parameters) -> vec3<f32> {
    switch m.fresnel {
        case 0u: { return vec3(1.0); }
        case 1u: { return schlick(microfacet_f0(m), cos_d); }
        case 2u: { return dielectric_rgb(m.ior, cos_d); }
        default: { return conductor_rgb(m.ior, m.extinction, cos_d); }
    }
}

// 2 ∫ F(μ) μ dμ by Gauss and Legendre's rule with eight points on [0, 1].
fn microfacet_average_f(m: Parameters) -> vec3<f32> {
    var sum = vec3(0.0);
    sum += 0.050614268 * (0.01985507 * microfacet_f(0.01985507, m) + 0.98014493 * microfacet_f(0.98014493, m));
    sum += 0.111190517 * (0.10166676 * microfacet_f(0.10166676, m) + 0.89833324 * microfacet_f(0.89833324, m));
    sum += 0.156853323 * (0.23723380 * microfacet_f(0.23723380, m) + 0.76276620 * microfacet_f(0.76276620, m));
    sum += 0.181341892 * (0.40828268 * microfacet_f(0.40828268, m) + 0.59171732 * microfacet_f(0.59171732, m));
    return 2.0 * sum;
}

// The factor of the diffuse base on Lambert's law.
fn microfacet_body(l: vec3<f32>, v: vec3<f32>, cos_d: f32, m: Parameters) -> f32 {
    let alpha = microfacet_alpha(m);
    let mean = sqrt(alpha.x * alpha.y);
    switch m.diffuse {
        case 0u: { return 0.0; }
        case 1u: { return 1.0; }
        case 2u: { return burley(l.z, v.z, cos_d, sqrt(mean)); }
        default: { return oren_nayar_qualitative(l.z, v.z, dot(l, v), mean / sqrt(2.0)); }
    }
}

fn response(l_room: vec3<f32>, v_room: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let l = to_local(frame, l_room);
    let v = to_local(frame, v_room);
    if l.z <= 0.0 || v.z <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let h = half_vector(l, v);
    let cos_d = clamp(dot(h, l), 0.0, 1.0);
    var specular = microfacet_f(cos_d, m) * (PI * microfacet_d(h, m) * microfacet_visibility(l, v, h, m) * l.z);
    if m.multiple_scattering == 1u {
        let mean = average_lobe_albedo();
        let f = microfacet_average_f(m);
        let bounced = f * f * mean / (vec3(1.0) - f * (1.0 - mean));
        let missing = max(vec2(1.0 - lobe_albedo(l.z), 1.0 - lobe_albedo(v.z)), vec2(0.0));
        let shape = missing.x * missing.y / max(1.0 - mean, 1e-6);
        specular += bounced * shape * l.z;
    } else if m.multiple_scattering == 2u {
        let seen = max(lobe_albedo(v.z), 1e-3);
        specular *= vec3(1.0) + microfacet_f0(m) * ((1.0 - seen) / seen);
    }
    // Nothing lies below the reflecting surface, or no light gets there.
    if m.diffuse == 0u || m.fresnel == 0u {
        return Terms(vec3(0.0), vec3(0.0), specular);
    }
    let entering = (vec3(1.0) - microfacet_f(l.z, m)) * (vec3(1.0) - microfacet_f(v.z, m));
    return Terms(vec3(0.0), m.base_colour * entering * (microfacet_body(l, v, cos_d, m) * l.z), specular);
}
