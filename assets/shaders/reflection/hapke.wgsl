// B. Hapke (1981, 1984, 1986): scattering grains, shadows between them, slopes.

const HAPKE_TINY: f32 = 1e-10;

// 1 − exp(−x) for x ≥ 0.
fn hapke_fall(x: f32) -> f32 {
    if x > 0.1 {
        return 1.0 - exp(-x);
    }
    return x * (1.0 - x * (0.5 - x * (1.0 / 6.0 - x * (1.0 / 24.0 - x / 120.0))));
}

// One lobe of the phase function (L. Henyey, J. Greenstein 1941) by the distance between the unit vectors.
fn hapke_lobe(b: f32, chord: f32) -> f32 {
    let s = (1.0 - b) * (1.0 - b) + b * chord * chord;
    return (1.0 - b * b) * inverseSqrt(s) / s;
}

// Chandrasekhar's H minus 1, Hapke's approximation of 1981.
fn hapke_h_less_one(x: f32, w: vec3<f32>, gamma: vec3<f32>) -> vec3<f32> {
    return 2.0 * x * w / ((vec3(1.0) + gamma) * (vec3(1.0) + 2.0 * x * gamma));
}

// The effective cosines, for the larger of the two given ones first, and the product of the
// shadowing factors; t: tangent of the mean slope.
fn hapke_roughen(l: vec3<f32>, v: vec3<f32>, n: vec3<f32>, t: f32) -> vec3<f32> {
    let swapped = dot(n, v) > dot(n, l);
    let a = select(l, v, swapped);
    let b = select(v, l, swapped);
    let cos_a = dot(n, a);
    let cos_b = dot(n, b);
    let flat_a = a - cos_a * n;
    let flat_b = b - cos_b * n;
    let rise_a = t * length(flat_a);
    let rise_b = t * length(flat_b);
    let chi = inverseSqrt(1.0 + PI * t * t);

    var s = 0.0;
    var c = 1.0;
    let way_a = unit_or_zero(flat_a);
    let way_b = unit_or_zero(flat_b);
    if dot(way_a, way_a) * dot(way_b, way_b) > 0.5 {
        s = 0.5 * length(way_a - way_b);
        c = 0.5 * length(way_a + way_b);
    }

    let x_a = cos_a / max(rise_a, HAPKE_TINY);
    let x_b = cos_b / max(rise_b, HAPKE_TINY);
    let less_a = hapke_fall(2.0 / PI * x_a);
    let less_b = hapke_fall(2.0 / PI * x_b);
    let e2_a = exp(-x_a * x_a / PI);
    let e2_b = exp(-x_b * x_b / PI);

    // E₂(b) − E₂(a), from the difference of the exponents.
    let sines = rise_a * rise_b / max(t, HAPKE_TINY);
    let spread = (cos_a - cos_b) * (cos_a + cos_b) / max(sines * sines, HAPKE_TINY * HAPKE_TINY);
    let difference = e2_b * hapke_fall(spread / PI);
    // 2 − E₁(b) − ψ/π E₁(a).
    let seen = max(less_a + less_b + (1.0 - less_a) * (2.0 / PI) * atan2(c, s), HAPKE_TINY);
    let mu_a = max(chi * (cos_a + rise_a * (c * c * e2_b - s * s * difference) / seen), 0.0);
    let mu_b = chi * (cos_b + rise_b * (c * c * e2_b + s * s * difference) / seen);

    let eta_a = max(chi * (cos_a + rise_a * e2_a / (1.0 + less_a)), HAPKE_TINY);
    let eta_b = max(chi * (cos_b + rise_b * e2_b / (1.0 + less_b)), HAPKE_TINY);
    let f = exp(-2.0 * s / max(c, HAPKE_TINY));
    let shadow = mu_a * mu_b / eta_a / eta_b * chi / (1.0 - f + f * chi * cos_a / eta_a);
    return vec3(mu_a, mu_b, shadow);
}

fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_i = dot(frame.n, l);
    if cos_i <= 0.0 || dot(frame.n, v) <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let rough = hapke_roughen(l, v, frame.n, tan_degrees(m.mean_slope));
    let apart = length(l - v);
    let together = length(l + v);
    let phase = 0.5 * (1.0 + m.backscatter) * hapke_lobe(m.grain_asymmetry, apart)
        + 0.5 * (1.0 - m.backscatter) * hapke_lobe(m.grain_asymmetry, together);
    let width = m.opposition_width * together;
    let surge = m.opposition_amplitude * width / (width + apart);
    let w = m.single_scattering_albedo * m.base_colour;
    let gamma = sqrt(max(vec3(1.0) - w, vec3(0.0)));
    let h_a = hapke_h_less_one(rough.x, w, gamma);
    let h_b = hapke_h_less_one(rough.y, w, gamma);
    let brackets = vec3((1.0 + surge) * phase) + h_a + h_b + h_a * h_b;
    let diffuse = 0.25 * w * brackets * (rough.z * cos_i / max(rough.x + rough.y, HAPKE_TINY));
    return Terms(vec3(0.0), diffuse, vec3(0.0));
}
