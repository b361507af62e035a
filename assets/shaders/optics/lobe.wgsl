// Lobes cos^n θ around the mirror direction, the twin of src/optics/lobe.rs: by the tangent of the
// angle, since a cosine near 1 has no digits left for it.

// ln(1 + x) for x ≥ 0: near 0 as 2 artanh(x/(2 + x)), whose series ends soon.
fn logarithm_of_one_plus(x: f32) -> f32 {
    if x > 0.5 {
        return log(1.0 + x);
    }
    let s = x / (2.0 + x);
    let t = s * s;
    return 2.0 * s * (1.0 + t * (1.0 / 3.0 + t * (0.2 + t / 7.0)));
}

// cos^n θ from tan² θ.
fn power_of_cosine(tan_squared: f32, n: f32) -> f32 {
    if n == 0.0 {
        return 1.0;
    }
    return exp(-0.5 * n * logarithm_of_one_plus(tan_squared));
}

// The part of a vector that lies in the surface, squared.
fn across_squared(x: vec3<f32>, n: vec3<f32>) -> f32 {
    let across = x - dot(n, x) * n;
    return dot(across, across);
}

// tan² of the angle between the normal and the half vector.
fn half_tangent_squared(l: vec3<f32>, v: vec3<f32>, n: vec3<f32>) -> f32 {
    let along = dot(n, l) + dot(n, v);
    return across_squared(l + v, n) / max(along * along, 1e-30);
}

// tan² of the angle between the mirror direction of the light and the view; 1e30 from 90° on.
fn mirror_tangent_squared(l: vec3<f32>, v: vec3<f32>, n: vec3<f32>) -> f32 {
    let along = dot(n, l) - dot(n, v);
    let versine = 0.5 * (across_squared(l + v, n) + along * along);
    if versine >= 1.0 {
        return 1e30;
    }
    return versine * (2.0 - versine) / ((1.0 - versine) * (1.0 - versine));
}
