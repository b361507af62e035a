// Ashikhmin–Shirley (M. Ashikhmin, P. Shirley 2000).

// ln(1 + x) for x ≥ 0; by the series of 2 artanh(x/(2 + x)) where 1 + x would lose digits.
fn log_1p(x: f32) -> f32 {
    if x > 0.25 {
        return log(1.0 + x);
    }
    let q = x / (2.0 + x);
    let q2 = q * q;
    return 2.0 * q * (1.0 + q2 * (1.0 / 3.0 + q2 * (1.0 / 5.0 + q2 * (1.0 / 7.0 + q2 / 9.0))));
}

fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cos_l = dot(frame.n, l);
    let cos_v = dot(frame.n, v);
    if cos_l <= 0.0 || cos_v <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let r_s = m.k_s * m.specular_colour;
    let r_d = m.base_colour;
    let below_l = 1.0 - schlick_weight(0.5 * cos_l);
    let below_v = 1.0 - schlick_weight(0.5 * cos_v);
    let diffuse = 28.0 / 23.0 * r_d * (vec3(1.0) - r_s) * below_l * below_v * cos_l;

    let slope = half_slope(l, v, frame);
    let tan2 = dot(slope, slope);
    var exponent = 0.0;
    if tan2 > 0.0 {
        let weight = slope * slope / tan2;
        exponent = 0.5 * dot(vec2(m.exponent_u, m.exponent_v), weight) * log_1p(tan2);
    }
    let norm = sqrt(m.exponent_u + 1.0) * sqrt(m.exponent_v + 1.0) / 8.0;
    let cos_d = clamp(0.5 * length(l + v), 1e-12, 1.0);
    let specular = norm * exp(-exponent) / cos_d * (cos_l / max(cos_l, cos_v)) * schlick(r_s, cos_d);
    return Terms(vec3(0.0), diffuse, specular);
}
