// Photometric lamp: the candelas of a file, I(p) = I w(γ, C) / d². From `m.file` on, the numbers of the file are in
// `light_words`: how many vertical and horizontal angles there are, these angles in degrees, and the candelas,
// one vertical half plane after the other.
fn incident_photometric(light: Light, m: PhotometricParameters, p: vec3<f32>) -> Incident {
    let to_light = light.position - p;
    let l = unit_or_zero(to_light);
    let candela = web_candela(m.file, web_angles(light.direction, m.rotation, -l));
    return Incident(l, vec3(light.intensity * candela * inverse_square(to_light)), 0u);
}

// The vertical angle γ and the horizontal angle C of a direction, degrees. The half plane C = 0 of a lamp that points
// down looks along x, C = 90° along −z: seen from above, C grows anticlockwise. A lamp that points elsewhere is tilted
// by the shortest turn, and turned about its axis by `rotation`.
fn web_angles(axis: vec3<f32>, rotation: f32, d: vec3<f32>) -> vec2<f32> {
    var zero = vec3(1.0, 0.0, 0.0);
    if axis.y < 0.999999 {
        let tilt = axis.z / (1.0 - axis.y);
        zero = vec3(-axis.y + axis.z * tilt, axis.x, -axis.x * tilt);
    }
    let across = vec2(dot(d, zero), dot(d, cross(zero, axis)));
    let gamma = degrees(polar_angle(dot(d, axis), length(across)));
    let c = (degrees(polar_angle(across.x, across.y)) - rotation) / 360.0;
    return vec2(clamp(gamma, 0.0, 180.0), clamp(360.0 * (c - floor(c)), 0.0, 360.0));
}

// The candelas at γ and C, interpolated linearly in both; none beyond the vertical angles of the file.
fn web_candela(table: u32, angles: vec2<f32>) -> f32 {
    let gammas = u32(illumination_number(table));
    let planes = u32(illumination_number(table + 1u));
    let first = table + 2u;
    if angles.x < illumination_number(first) || angles.x > illumination_number(first + gammas - 1u) {
        return 0.0;
    }
    let i = web_before(first, gammas, angles.x);
    let g = vec2(illumination_number(first + i), illumination_number(first + i + 1u));
    let t = (angles.x - g.x) / (g.y - g.x);
    let candelas = first + gammas + planes;
    if planes == 1u {
        return web_along(candelas + i, t);
    }
    let j = web_before(first + gammas, planes, angles.y);
    let c = vec2(illumination_number(first + gammas + j), illumination_number(first + gammas + j + 1u));
    let s = (angles.y - c.x) / (c.y - c.x);
    return mix(web_along(candelas + j * gammas + i, t), web_along(candelas + (j + 1u) * gammas + i, t), s);
}

fn web_along(at: u32, t: f32) -> f32 {
    return mix(illumination_number(at), illumination_number(at + 1u), t);
}

// The index of the last but one of `count` angles from `first` on, or of an earlier one if the next is above x.
fn web_before(first: u32, count: u32, x: f32) -> u32 {
    var low = 0u;
    var high = count - 1u;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if illumination_number(first + middle) <= x {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}
