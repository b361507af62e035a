// The vocabulary of every reflection model, the twin of `src/optics/`: the same function names,
// written separately on purpose. No bindings, no state.

const PI: f32 = 3.14159265358979;

// The local frame of a surface point: normal, tangent, bitangent.
struct Frame {
    n: vec3<f32>,
    t: vec3<f32>,
    b: vec3<f32>,
}

// The response of a model to one light of unit intensity, split into the terms of the equation. Of light from below the
// surface, for models that it passes through, the sum is the transmitted term.
struct Terms {
    ambient: vec3<f32>,
    diffuse: vec3<f32>,
    specular: vec3<f32>,
}

// Light that comes through the surface.
fn terms_through(transmitted: vec3<f32>) -> Terms {
    return Terms(vec3(0.0), vec3(0.0), transmitted);
}

// T. Duff et al. (2017), Building an Orthonormal Basis, Revisited.
fn frame_from_normal(n: vec3<f32>) -> Frame {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let c = n.x * n.y * a;
    return Frame(n, vec3(1.0 + s * n.x * n.x * a, s * c, -s * n.x), vec3(c, s + n.y * n.y * a, -n.y));
}

// A direction of the room in the local frame: components along tangent, bitangent and normal.
fn to_local(frame: Frame, d: vec3<f32>) -> vec3<f32> {
    return vec3(dot(frame.t, d), dot(frame.b, d), dot(frame.n, d));
}

// The frame of a shading normal and a tangent of any length (Gram and Schmidt); that of the normal
// alone where the tangent vanishes or runs along it.
fn frame_new(n: vec3<f32>, tangent: vec3<f32>) -> Frame {
    let across = tangent - dot(n, tangent) * n;
    let squared = dot(across, across);
    if squared > max(1e-8 * dot(tangent, tangent), 1e-30) {
        let t = across * inverseSqrt(squared);
        return Frame(n, t, cross(n, t));
    }
    return frame_from_normal(n);
}

// The vector normalised, or zero if it has no direction.
fn unit_or_zero(x: vec3<f32>) -> vec3<f32> {
    let squared = dot(x, x);
    return select(vec3(0.0), x * inverseSqrt(max(squared, 1e-37)), squared > 1e-37);
}

// x^p for x ≥ 0, with 0^0 = 1 as in the equations; undefined for WGSL's pow.
fn power(x: f32, p: f32) -> f32 {
    if p == 0.0 {
        return 1.0;
    }
    if x <= 0.0 {
        return 0.0;
    }
    return pow(x, p);
}

// The mirror direction R = 2(N·L)N − L.
fn mirror(l: vec3<f32>, n: vec3<f32>) -> vec3<f32> {
    return 2.0 * dot(n, l) * n - l;
}

// The half vector H = (L + V)/|L + V| (J. Blinn 1977); zero where L and V are opposite.
fn half_vector(l: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    return unit_or_zero(l + v);
}

// The slope of the facet that mirrors l to v: (H·T, H·B)/(H·N); its squared length is tan² θ_h.
fn half_slope(l: vec3<f32>, v: vec3<f32>, frame: Frame) -> vec2<f32> {
    let across = vec2(dot(l, frame.t) + dot(v, frame.t), dot(l, frame.b) + dot(v, frame.b));
    return across / max(dot(l, frame.n) + dot(v, frame.n), 1e-12);
}

// Squared distances below (1 mm)² count as (1 mm)²: the guard against division by zero.
const MINIMUM_DISTANCE_SQUARED: f32 = 1e-6;

// 1/d².
fn inverse_square(to_light: vec3<f32>) -> f32 {
    return 1.0 / max(dot(to_light, to_light), MINIMUM_DISTANCE_SQUARED);
}

// Cosines of angles from 0° to 90°, by the polynomial of fourth degree in x² with the smallest largest error: 6e-8
// before rounding. Drivers may be off by 2⁻¹¹ (WGSL, Accuracy of expressions).
fn cos_degrees(angles: vec2<f32>) -> vec2<f32> {
    let x = radians(angles);
    let s = x * x;
    return 1.0 - s * (0.499999323 - s * (0.0416639896 - s * (0.00138559281 - s * 0.0000231944086)));
}

// The tangent of an angle from 0° to below 90°; the sine by M. Abramowitz, I. Stegun (1964), Handbook of Mathematical
// Functions, 4.3.97.
fn tan_degrees(angle: f32) -> f32 {
    let x = radians(angle);
    let s = x * x;
    let ratio = 1.0 - s * (0.1666666664 - s * (0.0083333315 - s * (0.000198409 - s * (0.0000027526 - s * 0.0000000239))));
    return x * ratio / cos_degrees(vec2(angle)).x;
}

// The profile of a spotlight: 1 inside, 0 outside, Hermite's cubic of the cosine between.
// axis and ray: unit vectors away from the light; edges: 1 − cos θ of the outer and the inner edge, between which the
// light fades. Cosines near 1 have too few bits for narrow cones. Of the ray, 1 − cos θ is calculated from its chord.
fn cone(axis: vec3<f32>, ray: vec3<f32>, edges: vec2<f32>) -> f32 {
    let chord = ray - axis;
    let rise = 0.5 * dot(chord, chord);
    if edges.y >= edges.x {
        return step(rise, edges.x);
    }
    let t = clamp((edges.x - rise) / (edges.x - edges.y), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

// sRGB-encoded [0, 1] to linear light (IEC 61966-2-1).
fn srgb_decode(encoded: f32) -> f32 {
    if encoded <= 0.04045 {
        return encoded / 12.92;
    }
    return pow((encoded + 0.055) / 1.055, 2.4);
}
