// Directional albedo from the curve in the row of the object that is drawn, the twin of the curves in
// src/optics/albedo.rs; where they come from is calculated there alone. `curve_node(i)`, `lobe_mean()`
// and HARMONICS are generated for the layout of the row.

// Nodes at μ = (i/15)², values linear in √μ between them.
const NODES: u32 = 16u;

// The values at μ = cos θ of the harmonic of that index: red, green, blue, and the lobe's.
fn curve_at(mu: f32, harmonic: u32) -> vec4<f32> {
    let x = sqrt(clamp(mu, 0.0, 1.0)) * f32(NODES - 1u);
    let i = min(u32(x), NODES - 2u);
    let first = harmonic * NODES + i;
    return mix(curve_node(first), curve_node(first + 1u), x - f32(i));
}

// The directional albedo: a0(μ) + a2(μ) cos 2φ + a4(μ) cos 4φ, φ from the tangent.
fn directional_albedo(v: vec3<f32>, frame: Frame) -> vec3<f32> {
    let mu = dot(frame.n, v);
    if mu <= 0.0 {
        return vec3(0.0);
    }
    var e = curve_at(mu, 0u).rgb;
    if HARMONICS > 1u {
        let x = dot(frame.t, v);
        let y = dot(frame.b, v);
        let squared = x * x + y * y;
        // Along the normal there is no azimuth, and nothing depends on it.
        let cos_2 = select(0.0, (x * x - y * y) / max(squared, 1e-37), squared > 0.0);
        let cos_4 = 2.0 * cos_2 * cos_2 - 1.0;
        e += curve_at(mu, 1u).rgb * cos_2 + curve_at(mu, 2u).rgb * cos_4;
    }
    return max(e, vec3(0.0));
}

// The directional albedo of the specular lobe alone with F = 1.
fn lobe_albedo(mu: f32) -> f32 {
    return curve_at(mu, 0u).w;
}

// Its mean over the hemisphere, 2 ∫ E μ dμ.
fn average_lobe_albedo() -> f32 {
    return lobe_mean();
}
