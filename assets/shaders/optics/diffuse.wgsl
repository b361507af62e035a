// Diffuse reflection of rough surfaces, the twin of src/optics/diffuse.rs: factors on Lambert's ρ/π.

// B. Burley (2012), Physically Based Shading at Disney.
fn burley(cos_l: f32, cos_v: f32, cos_d: f32, roughness: f32) -> f32 {
    let f_d90 = 0.5 + 2.0 * roughness * cos_d * cos_d;
    return mix(1.0, f_d90, schlick_weight(cos_l)) * mix(1.0, f_d90, schlick_weight(cos_v));
}

// The angle of a cosine in [0, 1]; M. Abramowitz, I. Stegun (1964), 4.4.46, error 2e-8. The built-in acos may be
// off by 4096 units in the last place.
fn arc_cosine(x: f32) -> f32 {
    let c = clamp(x, 0.0, 1.0);
    let low = 1.5707963050 + c * (-0.2145988016 + c * (0.0889789874 + c * -0.0501743046));
    let high = 0.0308918810 + c * (-0.0170881256 + c * (0.0066700901 + c * -0.0012624911));
    let c2 = c * c;
    return sqrt(1.0 - c) * (low + c2 * c2 * high);
}

// The angle of a sine in [0, 1]; by its series where the difference from a right angle would lose digits.
fn arc_sine(x: f32) -> f32 {
    if x > 0.3 {
        return 0.5 * PI - arc_cosine(x);
    }
    let x2 = x * x;
    return x * (1.0 + x2 * (1.0 / 6.0 + x2 * (3.0 / 40.0 + x2 * (5.0 / 112.0 + x2 * 35.0 / 1152.0))));
}

// The angle of a point from the x axis, −π to π; the built-in atan2 may be off by 4096 units in the last place.
fn polar_angle(x: f32, y: f32) -> f32 {
    let distance = sqrt(x * x + y * y);
    if distance < 1e-7 {
        return 0.0;
    }
    let a = abs(x) / distance;
    let b = abs(y) / distance;
    var angle = select(0.5 * PI - arc_sine(a), arc_sine(b), b < a);
    angle = select(angle, PI - angle, x < 0.0);
    return select(angle, -angle, y < 0.0);
}

fn sine_of(cosine: f32) -> f32 {
    let c = clamp(cosine, 0.0, 1.0);
    return sqrt((1.0 - c) * (1.0 + c));
}

// M. Oren, S. K. Nayar (1994), Generalization of Lambert's Reflectance Model: the short form. sigma in radians.
fn oren_nayar_qualitative(cos_l: f32, cos_v: f32, cos_lv: f32, sigma: f32) -> f32 {
    let s2 = sigma * sigma;
    let a = (0.5 * s2 + 0.33) / (s2 + 0.33);
    let b = 0.45 * s2 / (s2 + 0.09);
    return a + b * max(cos_lv - cos_l * cos_v, 0.0) / max(max(cos_l, cos_v), 1e-12);
}

// The same, in full: single reflection in three parts, and interreflection between two facets.
fn oren_nayar_full(cos_l: f32, cos_v: f32, cos_lv: f32, sigma: f32, rho: vec3<f32>) -> vec3<f32> {
    let s2 = sigma * sigma;
    let cos_alpha = min(cos_l, cos_v);
    let cos_beta = max(max(cos_l, cos_v), 1e-12);
    let sin_alpha = sine_of(cos_alpha);
    let sin_beta = sine_of(cos_beta);
    let alpha = arc_cosine(cos_alpha);
    let beta = arc_cosine(cos_beta);
    let s = cos_lv - cos_l * cos_v;
    var cos_phi = 0.0;
    if sin_alpha * sin_beta > 0.0 {
        cos_phi = clamp(s / (sin_alpha * sin_beta), -1.0, 1.0);
    }
    // b = 2β/π is 1 − e.
    let e = 2.0 / PI * arc_sine(cos_beta);
    let b = 1.0 - e;
    let slope = s2 / (s2 + 0.09);
    // C₂ cos φ tan β, where cos φ sin α tan β is s / cos β.
    var middle = 0.45 * slope * s / cos_beta;
    if s < 0.0 {
        // (sin α − b³)/sin α: 1 − b³ minus 1 − sin α.
        middle *= (e * (3.0 - e * (3.0 - e)) - cos_alpha * cos_alpha / (1.0 + sin_alpha)) / max(sin_alpha, 1e-4);
    }
    let c3 = 4.0 * alpha * beta / (PI * PI);
    let half_sum = (sin_alpha + sin_beta) / (max(cos_alpha, 0.0) + cos_beta);
    let once = (0.5 * s2 + 0.33) / (s2 + 0.33) + middle + 0.125 * slope * c3 * c3 * (1.0 - abs(cos_phi)) * half_sum;
    return vec3(once) + rho * (0.17 * s2 / (s2 + 0.13) * (1.0 - cos_phi * b * b));
}

const FON_1: f32 = 0.5 - 2.0 / (3.0 * PI);
const FON_2: f32 = 2.0 / 3.0 - 28.0 / (15.0 * PI);

// The loss of the FON BRDF for light at the angle of a cosine, (1 − E)/(A r).
fn fon_loss(cosine: f32) -> f32 {
    let mu = clamp(cosine, 0.0, 1.0);
    let s = sine_of(mu);
    // G/s, where tan θ (1 − sin³ θ) = s mu (1 + s²/(1 + s)).
    let g = arc_cosine(mu) - s * mu + (2.0 / 3.0) * (mu * (1.0 + s * s / (1.0 + s)) - 1.0);
    return max(FON_1 - s * g / PI, 0.0);
}

// J. Portsmouth, P. Kutz, S. Hill (2024), EON: A Practical Energy-Preserving Rough Diffuse BRDF.
fn eon(cos_l: f32, cos_v: f32, cos_lv: f32, roughness: f32, rho: vec3<f32>) -> vec3<f32> {
    let norm = 1.0 + FON_1 * roughness;
    var s = cos_lv - cos_l * cos_v;
    if s > 0.0 {
        s /= max(max(cos_l, cos_v), 1e-12);
    }
    let average = (1.0 + FON_2 * roughness) / norm;
    let compensation = roughness * fon_loss(cos_l) * fon_loss(cos_v) / ((FON_1 - FON_2) * norm);
    return vec3((1.0 + roughness * s) / norm)
        + rho * average / (vec3(1.0) - rho * (1.0 - average)) * compensation;
}
