// Sphere: the same luminance from every point of it, by the cone of directions that it fills.

// The direction of its middle, and in w the squared sine of its angular radius; zero from within.
fn sphere_from(light: Light, m: SphereParameters, p: vec3<f32>) -> vec4<f32> {
    let middle = light.position - p;
    let distance = length(middle);
    if !(distance > m.radius) {
        return vec4(0.0);
    }
    let sine = m.radius / distance;
    return vec4(middle / distance, sine * sine);
}

// 1 minus the cosine of the angular radius.
fn sphere_rise(squared: f32) -> f32 {
    return squared / (1.0 + sqrt(max(1.0 - squared, 0.0)));
}

fn sample_sphere(light: Light, m: SphereParameters, p: vec3<f32>, u: vec2<f32>) -> LightSample {
    let seen_from = sphere_from(light, m, p);
    if seen_from.w <= 0.0 {
        return LightSample(vec3(0.0, 1.0, 0.0), vec3(0.0), 0.0);
    }
    let rise = sphere_rise(seen_from.w);
    return LightSample(about(seen_from.xyz, sample_cone(u, rise)), vec3(light.intensity), 1.0 / (2.0 * PI * rise));
}

fn seen_sphere(light: Light, m: SphereParameters, p: vec3<f32>, l: vec3<f32>) -> LightSeen {
    let seen_from = sphere_from(light, m, p);
    let cosine = dot(seen_from.xyz, l);
    let across = cross(seen_from.xyz, l);
    let off = dot(across, across);
    if seen_from.w <= 0.0 || cosine <= 0.0 || off > seen_from.w {
        return NOTHING_SEEN;
    }
    let distance = max(m.radius / sqrt(seen_from.w) * (cosine - sqrt(seen_from.w - off)), 0.0);
    return LightSeen(vec3(light.intensity), 1.0 / (2.0 * PI * sphere_rise(seen_from.w)), distance);
}
