// Thin films, in which light interferes: the twin of src/optics/film.rs.

// (a − z)/(a + z) of a real and a complex number.
fn film_reflected(a: f32, z: vec2<f32>) -> vec2<f32> {
    let scale = 1.0 / max((a + z.x) * (a + z.x) + z.y * z.y, 1e-37);
    return scale * vec2(a * a - dot(z, z), -2.0 * a * z.y);
}

// |(r₁ + r₂ w)/(1 + r₁ r₂ w)|², |w| = 1.
fn film_sum(first: f32, second: vec2<f32>, wave: vec2<f32>) -> f32 {
    let first2 = first * first;
    let second2 = dot(second, second);
    let crossed = 2.0 * first * (second.x * wave.x - second.y * wave.y);
    return (first2 + second2 + crossed) / max(1.0 + first2 * second2 + crossed, 1e-30);
}

// The reflectance of a film of index n_2 between the indices n_1 and n + ik: G. Airy's sum.
fn thin_film(n_1: f32, n_2: f32, n: f32, k: f32, turns: f32, c: f32) -> f32 {
    let sin2 = 1.0 - c * c;
    let cos2 = 1.0 - (n_1 / n_2) * (n_1 / n_2) * sin2;
    if cos2 <= 0.0 {
        return 1.0;
    }
    let c_2 = sqrt(cos2);
    // Without whole turns: sine and cosine of large angles have few digits on GPUs.
    let phase = 2.0 * n_2 * turns * c_2;
    let angle = 2.0 * PI * (phase - round(phase));
    let wave = vec2(cos(angle), sin(angle));
    let n2 = vec2((n - k) * (n + k), 2.0 * n * k);
    // The root of n₃² − n₁² sin² θ with an imaginary part of at least 0.
    let x = n2.x - n_1 * n_1 * sin2;
    let modulus = length(vec2(x, n2.y));
    let large = sqrt(0.5 * (modulus + abs(x)));
    let small = 0.5 * n2.y / max(large, 1e-30);
    let q = select(vec2(small, large), vec2(large, small), x >= 0.0);
    let scale = 1.0 / max(dot(q, q), 1e-30);
    let other = scale * vec2(n2.x * q.x + n2.y * q.y, n2.y * q.x - n2.x * q.y);
    let s = film_sum((n_1 * c - n_2 * c_2) / (n_1 * c + n_2 * c_2), film_reflected(n_2 * c_2, q), wave);
    let y_1 = n_1 / max(c, 1e-9);
    let y_2 = n_2 / c_2;
    let p = film_sum((y_1 - y_2) / (y_1 + y_2), film_reflected(y_2, other), wave);
    return clamp(0.5 * (s + p), 0.0, 1.0);
}
