// A table over half and difference angles (S. Rusinkiewicz 1998), linear between the middles of its bins: the twin of
// src/optics/half_difference.rs. From `table` on, the words of the file are: the numbers of half angles, difference angles and
// azimuths, five for other uses, and for each entry, azimuths fastest, two words with the roots of red and green, of blue and of
// 1, or 0 if it was not measured, as 16-bit floats.
const GRID_HEADER: u32 = 8u;

// The number of the low 16 bits of a word: no subnormal, infinity or NaN.
fn grid_number(bits: u32) -> f32 {
    return bitcast<f32>((bits & 0x7fffu) << 13u) * 5.1922969e33;
}

// The value of an entry.
fn grid_cell(at: u32) -> vec3<f32> {
    let word = file_word(at);
    let root = vec3(grid_number(word), grid_number(word >> 16u), grid_number(file_word(at + 1u)));
    return root * root;
}

// Two neighbours in azimuth; `row` is the first word of their row.
fn grid_around(row: u32, places: vec2<u32>, weight: f32) -> vec3<f32> {
    return mix(grid_cell(row + 2u * places.x), grid_cell(row + 2u * places.y), weight);
}

// The measured value in sr⁻¹ for three angles in radians.
fn grid_value(table: u32, theta_h: f32, theta_d: f32, phi_d: f32) -> vec3<f32> {
    let counts = vec3(bitcast<f32>(file_word(table)), bitcast<f32>(file_word(table + 1u)), bitcast<f32>(file_word(table + 2u)));
    let whole = vec3<u32>(counts);
    let h = clamp(counts.x * sqrt(theta_h / (0.5 * PI)) - 0.5, 0.0, counts.x - 1.0);
    let d = clamp(counts.y * (theta_d / (0.5 * PI)) - 0.5, 0.0, counts.y - 1.0);
    let phi = counts.z * (phi_d / PI) - 0.5;
    let i = min(u32(h), whole.x - 2u);
    let j = min(u32(d), whole.y - 2u);
    let low = floor(phi);
    let k = select(min(u32(max(low, 0.0)), whole.z - 1u), whole.z - 1u, low < 0.0);
    let around = vec2(k, select(k + 1u, 0u, k + 1u == whole.z));
    let row = 2u * whole.z;
    let first = table + GRID_HEADER + (i * whole.y + j) * row;
    let second = first + whole.y * row;
    let weights = vec3(h - f32(i), d - f32(j), phi - low);
    let near = mix(grid_around(first, around, weights.z), grid_around(first + row, around, weights.z), weights.y);
    let far = mix(grid_around(second, around, weights.z), grid_around(second + row, around, weights.z), weights.y);
    return mix(near, far, weights.x);
}

// The response of an isotropic surface whose BRDF is in a table.
fn grid_response(table: u32, l: vec3<f32>, v: vec3<f32>, frame: Frame) -> vec3<f32> {
    let cos_l = dot(frame.n, l);
    let cos_v = dot(frame.n, v);
    if cos_l <= 0.0 || cos_v <= 0.0 {
        return vec3(0.0);
    }
    let sum = l + v;
    let difference = l - v;
    let theta_h = polar_angle(dot(frame.n, sum), length(cross(frame.n, sum)));
    let theta_d = polar_angle(length(sum), length(difference));
    // The components of the light beside the half vector, both multiplied by the same number. The other half turn has the
    // same values, by reciprocity.
    var phi_d = polar_angle(-dot(frame.n, difference) * length(sum), 2.0 * dot(frame.n, cross(v, l)));
    if phi_d < 0.0 {
        phi_d += PI;
    }
    return PI * cos_l * grid_value(table, theta_h, theta_d, phi_d);
}
