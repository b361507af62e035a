// Disney (B. Burley 2012, Physically-Based Shading at Disney): diffuse or subsurface and sheen below, a GGX
// lobe, a clear coat.

// The subsurface term on C_b/π, after P. Hanrahan, W. Krueger (1993); 1.25 keeps its albedo.
fn flattened(cos_l: f32, cos_v: f32, cos_d: f32, roughness: f32) -> f32 {
    let f90 = roughness * cos_d * cos_d;
    let rim = mix(1.0, f90, schlick_weight(cos_l)) * mix(1.0, f90, schlick_weight(cos_v));
    return 1.25 * (rim * (1.0 / (cos_l + cos_v) - 0.5) + 0.5);
}

// 1/(N·X + √((α_x X·T)² + (α_y X·B)² + (N·X)²)): Smith's masking over twice the cosine.
fn unmasked(x: vec3<f32>, alpha: vec2<f32>) -> f32 {
    return 1.0 / (x.z + length(vec3(alpha * x.xy, x.z)));
}

fn response(l_room: vec3<f32>, v_room: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let l = to_local(frame, l_room);
    let v = to_local(frame, v_room);
    if min(l.z, v.z) < 1e-9 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let h = half_vector(l, v);
    let cos_d = length(l + v) / 2.0;
    let fresnel = schlick_weight(cos_d);

    let luminance = dot(m.base_colour, vec3(0.3, 0.6, 0.1));
    var tint = vec3(1.0);
    if luminance > 0.0 {
        tint = m.base_colour / luminance;
    }
    let scattered = mix(burley(l.z, v.z, cos_d, m.roughness), flattened(l.z, v.z, cos_d, m.roughness), m.subsurface);
    let sheen = m.sheen * fresnel * mix(vec3(1.0), tint, m.sheen_tint);
    let diffuse = (1.0 - m.metallic) * l.z * (scattered * m.base_colour + PI * sheen);

    let rough = m.roughness * m.roughness;
    let aspect = sqrt(1.0 - 0.9 * m.anisotropic);
    let alpha = max(vec2(rough / aspect, rough * aspect), vec2(MINIMUM_ALPHA));
    let f0 = mix(0.08 * m.specular * mix(vec3(1.0), tint, m.specular_tint), m.base_colour, m.metallic);
    let lobe = ggx(h, alpha) * unmasked(l, alpha) * unmasked(v, alpha) * mix(f0, vec3(1.0), fresnel);

    // GTR with exponent 1, and G of roughness 0.25, whatever the width.
    let a = mix(0.1, 0.001, m.clearcoat_gloss);
    let a2 = a * a;
    let norm = (1.0 - a2) / (-2.0 * PI * log(a));
    let d = norm / (dot(h.xy, h.xy) + a2 * h.z * h.z);
    let coat = d * unmasked(l, vec2(0.25)) * unmasked(v, vec2(0.25)) * mix(0.04, 1.0, fresnel);
    return Terms(vec3(0.0), diffuse, PI * l.z * (lobe + 0.25 * m.clearcoat * coat));
}
