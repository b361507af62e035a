#import "../optics/panorama.wgsl"

// Environment: light from all around, infinitely far away: uniform, a studio of three softboxes, a picture, or the CIE general sky
// (CIE S 011 / ISO 15469). The twin of environment.rs, studio.rs and sky.rs in src/light.

const ENVIRONMENT_STUDIO: u32 = 1u;
const ENVIRONMENT_SKY: u32 = 2u;
const ENVIRONMENT_FILE: u32 = 3u;

// The luminance of a direction, and the density at which it is sampled.
struct EnvironmentSeen {
    luminance: f32,
    pdf: f32,
}

// The softboxes: the direction of the middle; the tangents of half the angles, the luminance, the share of the samples.
const STUDIO_ROOM: f32 = 0.04;
const STUDIO_ROOM_SHARE: f32 = 0.1;
const STUDIO_MIDDLES: array<vec3<f32>, 3> = array<vec3<f32>, 3>(
    vec3(-0.6, 0.6, 0.55), vec3(0.9, 0.15, 0.35), vec3(0.3, 0.8, -0.75)
);
const STUDIO_BOXES: array<vec4<f32>, 3> = array<vec4<f32>, 3>(
    vec4(0.55, 0.4, 1.8, 0.45), vec4(0.25, 0.8, 0.7, 0.25), vec4(0.8, 0.2, 2.4, 0.2)
);

fn studio_seen(d: vec3<f32>) -> EnvironmentSeen {
    var seen = EnvironmentSeen(STUDIO_ROOM, STUDIO_ROOM_SHARE / (4.0 * PI));
    for (var i = 0u; i < 3u; i++) {
        var middles = STUDIO_MIDDLES;
        var boxes = STUDIO_BOXES;
        let axis = normalize(middles[i]);
        let box = boxes[i];
        let sides = rectangle_sides(-axis, vec2(0.0, 1.0));
        let along = dot(d, axis);
        if along > 0.0 && abs(dot(d, sides.x)) <= box.x * along && abs(dot(d, sides.y)) <= box.y * along {
            seen.luminance = box.z;
            let rectangle = spherical_rectangle(axis, sides.x, sides.y, box.xy);
            seen.pdf += box.w * spherical_rectangle_pdf(rectangle, axis);
        }
    }
    return seen;
}

fn studio_sample(u: vec2<f32>) -> vec3<f32> {
    var x = u.x;
    for (var i = 0u; i < 3u; i++) {
        var middles = STUDIO_MIDDLES;
        var boxes = STUDIO_BOXES;
        let box = boxes[i];
        if x < box.w {
            let axis = normalize(middles[i]);
            let sides = rectangle_sides(-axis, vec2(0.0, 1.0));
            let rectangle = spherical_rectangle(axis, sides.x, sides.y, box.xy);
            return normalize(spherical_rectangle_sample(rectangle, vec2(x / box.w, u.y)));
        }
        x -= box.w;
    }
    return sample_cone(vec2(x / STUDIO_ROOM_SHARE, u.y), 2.0);
}

const SKY_GROUND_SHARE: f32 = 0.2;
const SKY_SUN_SHARE: f32 = 0.3;
const SKY_SHARE: f32 = 0.5;
const SKY_AROUND: f32 = 8.0;

fn sky_sun(m: EnvironmentParameters) -> vec3<f32> {
    return vec3(m.sun_x, m.sun_y, m.sun_z);
}

fn sky_seen(m: EnvironmentParameters, d: vec3<f32>) -> EnvironmentSeen {
    let cosine = clamp(dot(d, sky_sun(m)), -1.0, 1.0);
    let around = power(max(cosine, 0.0), SKY_AROUND) * (SKY_AROUND + 1.0) * SKY_SUN_SHARE;
    if d.y <= 0.0 {
        return EnvironmentSeen(m.ground, (SKY_GROUND_SHARE + around) / (2.0 * PI));
    }
    let gradation = 1.0 + m.sky_a * exp(m.sky_b / max(d.y, 0.01));
    let rest = exp(m.sky_d * angle_of_cosine(cosine)) - exp(0.5 * m.sky_d * PI);
    let indicatrix = 1.0 + m.sky_c * rest + m.sky_e * cosine * cosine;
    return EnvironmentSeen(m.sky_scale * gradation * indicatrix, (SKY_SHARE + around) / (2.0 * PI));
}

fn sky_sample(m: EnvironmentParameters, u: vec2<f32>) -> vec3<f32> {
    if u.x < SKY_GROUND_SHARE {
        let down = sample_cone(vec2(u.x / SKY_GROUND_SHARE, u.y), 1.0);
        return vec3(down.x, -down.z, down.y);
    }
    let x = u.x - SKY_GROUND_SHARE;
    if x < SKY_SUN_SHARE {
        let cosine = power(x / SKY_SUN_SHARE, 1.0 / (SKY_AROUND + 1.0));
        return about(sky_sun(m), sample_cone(vec2(1.0 - cosine, u.y), 1.0));
    }
    let up = sample_cone(vec2((x - SKY_SUN_SHARE) / SKY_SHARE, u.y), 1.0);
    return vec3(up.x, up.z, up.y);
}

// The radiance of a direction, and in w its density.
fn environment_seen(m: EnvironmentParameters, d: vec3<f32>) -> vec4<f32> {
    var seen = EnvironmentSeen(1.0, 1.0 / (4.0 * PI));
    switch m.source {
        case ENVIRONMENT_STUDIO: { seen = studio_seen(d); }
        case ENVIRONMENT_SKY: { seen = sky_seen(m, d); }
        case ENVIRONMENT_FILE: { return panorama_seen(m.path, d); }
        default: {}
    }
    return vec4(vec3(seen.luminance), seen.pdf);
}

fn sample_environment(light: Light, m: EnvironmentParameters, p: vec3<f32>, u: vec2<f32>) -> LightSample {
    var d: vec3<f32>;
    switch m.source {
        case ENVIRONMENT_STUDIO: { d = studio_sample(u); }
        case ENVIRONMENT_SKY: { d = sky_sample(m, u); }
        case ENVIRONMENT_FILE: { d = panorama_sample(m.path, u).xyz; }
        default: { d = sample_cone(u, 2.0); }
    }
    let seen = environment_seen(m, d);
    let l = vec3(d.x * m.turn_cosine + d.z * m.turn_sine, d.y, d.z * m.turn_cosine - d.x * m.turn_sine);
    return LightSample(l, light.intensity * seen.rgb, seen.w);
}

fn seen_environment(light: Light, m: EnvironmentParameters, p: vec3<f32>, l: vec3<f32>) -> LightSeen {
    let d = vec3(l.x * m.turn_cosine - l.z * m.turn_sine, l.y, l.x * m.turn_sine + l.z * m.turn_cosine);
    let seen = environment_seen(m, d);
    return LightSeen(light.intensity * seen.rgb, seen.w, -1.0);
}
