// Directional albedo from the curve in the object's row, the twin of the curves in src/optics/albedo,
// which alone calculates them. `curve_node(i)`, `lobe_mean()`
// and HARMONICS are generated for the layout of the row.

// Nodes at μ = (i/15)³.
const NODES: u32 = 16u;

// The values at μ = cos θ of the curve whose nodes begin there; those of the albedo have red, green, blue and the lobe's,
// NODES for each harmonic. The cubic of E. Catmull and R. Rom (1974) over the cube
// root of μ, continued in a straight line at both ends.
fn curve_from(mu: f32, first: u32) -> vec4<f32> {
    return curve_above(mu, first, 0.0);
}

// The values less a number near to them, which keeps the digits of the difference.
fn curve_above(mu: f32, first: u32, base: f32) -> vec4<f32> {
    let x = power(clamp(mu, 0.0, 1.0), 1.0 / 3.0) * f32(NODES - 1u);
    let i = min(u32(x), NODES - 2u);
    let f = x - f32(i);
    let at = first + i;
    let b = curve_node(at) - base;
    let c = curve_node(at + 1u) - base;
    var a = 2.0 * b - c;
    if i > 0u {
        a = curve_node(at - 1u) - base;
    }
    var d = 2.0 * c - b;
    if i < NODES - 2u {
        d = curve_node(at + 2u) - base;
    }
    return b + 0.5 * f * (c - a + f * (2.0 * a - 5.0 * b + 4.0 * c - d + f * (3.0 * (b - c) + d - a)));
}

// The directional albedo: a0(μ) + a2(μ) cos 2φ + a4(μ) cos 4φ, φ from the tangent.
fn directional_albedo(v: vec3<f32>, frame: Frame) -> vec3<f32> {
    let mu = dot(frame.n, v);
    var e = curve_from(mu, 0u).rgb;
    if HARMONICS > 1u {
        let x = dot(frame.t, v);
        let y = dot(frame.b, v);
        // Along the normal there is no azimuth, and nothing depends on it.
        let cos_2 = (x * x - y * y) / max(x * x + y * y, 1e-37);
        let cos_4 = 2.0 * cos_2 * cos_2 - 1.0;
        e += curve_from(mu, NODES).rgb * cos_2 + curve_from(mu, 2u * NODES).rgb * cos_4;
    }
    return max(e, vec3(0.0));
}

// The directional albedo of the specular lobe alone with F = 1.
fn lobe_albedo(mu: f32) -> f32 {
    return clamp(curve_from(mu, 0u).w, 0.0, 1.0);
}

// 1 minus it, with all digits.
fn lobe_loss(mu: f32) -> f32 {
    return clamp(-curve_above(mu, 0u, 1.0).w, 0.0, 1.0);
}

// Its mean over the hemisphere, 2 ∫ E μ dμ.
fn average_lobe_albedo() -> f32 {
    return lobe_mean();
}
