// Sun: a disc infinitely far away, of the luminance E/(π sin²(δ/2)).
fn sun_luminance(light: Light, m: SunParameters) -> vec3<f32> {
    return vec3(light.intensity / (PI * m.sine_squared));
}

fn sample_sun(light: Light, m: SunParameters, p: vec3<f32>, u: vec2<f32>) -> LightSample {
    let l = about(-light.direction, sample_cone(u, m.rise));
    return LightSample(l, sun_luminance(light, m), 1.0 / (2.0 * PI * m.rise));
}

fn seen_sun(light: Light, m: SunParameters, p: vec3<f32>, l: vec3<f32>) -> LightSeen {
    let across = cross(light.direction, l);
    if dot(light.direction, l) >= 0.0 || dot(across, across) > m.sine_squared {
        return NOTHING_SEEN;
    }
    return LightSeen(sun_luminance(light, m), 1.0 / (2.0 * PI * m.rise), -1.0);
}
