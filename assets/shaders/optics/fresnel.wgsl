// Fresnel reflectance, the twin of src/optics/fresnel.rs. cos_i: cosine between the light and the
// normal of the (micro)facet.

// (1 − cos θ)⁵, C. Schlick (1994).
fn schlick_weight(cos_i: f32) -> f32 {
    let m = clamp(1.0 - cos_i, 0.0, 1.0);
    return m * m * m * m * m;
}

// C. Schlick (1994), An Inexpensive BRDF Model for Physically-based Rendering.
fn schlick(f0: vec3<f32>, cos_i: f32) -> vec3<f32> {
    return f0 + (vec3(1.0) - f0) * schlick_weight(cos_i);
}

// A dielectric of relative refractive index n, unpolarised light (A. Fresnel 1823).
fn dielectric(n: f32, cos_i: f32) -> f32 {
    let c = clamp(cos_i, 0.0, 1.0);
    let g2 = (n - 1.0) * (n + 1.0) + c * c;
    if g2 <= 0.0 {
        return 1.0;
    }
    let g = sqrt(g2);
    let s = (g - c) / (g + c);
    let p = (n * n * c - g) / (n * n * c + g);
    return 0.5 * (s * s + p * p);
}

// A conductor of relative refractive index n + ik, unpolarised light: with the complex square root
// a + ib of (n + ik)² − sin² θ.
fn conductor(n: f32, k: f32, cos_i: f32) -> f32 {
    let c = clamp(cos_i, 0.0, 1.0);
    if k == 0.0 {
        return dielectric(n, c);
    }
    let c2 = c * c;
    let s2 = 1.0 - c2;
    let t = (n - k) * (n + k) - s2;
    let modulus = length(vec2(t, 2.0 * n * k));
    // The real part, in the form without cancellation.
    var a = 0.0;
    if t > 0.0 {
        a = sqrt(0.5 * (modulus + t));
    } else if modulus - t > 0.0 {
        a = n * k / sqrt(0.5 * (modulus - t));
    }
    let ac = 2.0 * a * c;
    let r_s = (modulus + c2 - ac) / max(modulus + c2 + ac, 1e-37);
    let symmetric = c2 * modulus + s2 * s2;
    let r_p = r_s * (symmetric - ac * s2) / max(symmetric + ac * s2, 1e-37);
    return clamp(0.5 * (r_s + r_p), 0.0, 1.0);
}

fn conductor_rgb(n: vec3<f32>, k: vec3<f32>, cos_i: f32) -> vec3<f32> {
    return vec3(conductor(n.x, k.x, cos_i), conductor(n.y, k.y, cos_i), conductor(n.z, k.z, cos_i));
}

fn dielectric_rgb(n: vec3<f32>, cos_i: f32) -> vec3<f32> {
    return vec3(dielectric(n.x, cos_i), dielectric(n.y, cos_i), dielectric(n.z, cos_i));
}

// F0 = ((n − 1)² + k²)/((n + 1)² + k²).
fn normal_reflectance(n: f32, k: f32) -> f32 {
    return ((n - 1.0) * (n - 1.0) + k * k) / ((n + 1.0) * (n + 1.0) + k * k);
}

fn normal_reflectance_rgb(n: vec3<f32>, k: vec3<f32>) -> vec3<f32> {
    return vec3(normal_reflectance(n.x, k.x), normal_reflectance(n.y, k.y), normal_reflectance(n.z, k.z));
}
