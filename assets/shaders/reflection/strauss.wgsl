// P. S. Strauss (1990), A Realistic Lighting Model for Computer Animators.

// The angle of a direction above the surface, in right angles.
fn elevation(cosine: f32, d: vec3<f32>, n: vec3<f32>) -> f32 {
    return atan2(cosine, length(d - cosine * n)) * 2.0 / PI;
}

// F(x) with k_f = 1.12 and x = 1 − elevation: 1/(x − k)² − 1/k² is x (2k − x)/(k (k − x))².
fn strauss_fresnel(elevation: f32) -> f32 {
    let k = 1.12;
    let e = 0.12;
    let x = 1.0 - elevation;
    let steep = (e + elevation) * (e + elevation);
    return x * (2.0 * k - x) * e * e / (steep * (k * k - e * e));
}

// G(x) with k_g = 1.01 and x = 1 − elevation, likewise.
fn strauss_masking(elevation: f32) -> f32 {
    let k = 1.01;
    let e = 0.01;
    let steep = (e + elevation) * (e + elevation);
    return elevation * (2.0 * e + elevation) * k * k / (steep * (k * k - e * e));
}

fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_i = dot(frame.n, l);
    let cos_o = dot(frame.n, v);
    if cos_i <= 0.0 || cos_o <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let s3 = m.smoothness * m.smoothness * m.smoothness;
    let opaque = 1.0 - m.transparency;
    let r_n = opaque * s3;
    let light = elevation(cos_i, l, frame.n);
    let f = strauss_fresnel(light);
    let r_j = min(1.0, r_n + (r_n + 0.1) * f * strauss_masking(light) * strauss_masking(elevation(cos_o, v, frame.n)));
    let h = min(3.0 / max(1.0 - m.smoothness, 1e-6), 30000.0);
    let colour = mix(vec3(1.0), m.base_colour, m.metallic * (1.0 - f));
    let diffuse = opaque * (1.0 - s3) * (1.0 - m.metallic * m.smoothness) * cos_i;
    let lobe = power_of_cosine(mirror_tangent_squared(l, v, frame.n), h);
    return Terms(vec3(0.0), diffuse * m.base_colour, r_j * lobe * colour);
}
