// A picture of the surroundings, the twin of src/light/panorama/mod.rs. From `table` on there are: the number of columns, of
// rows, and the integral of the luminance over all directions; the shares of the rows above; row by row the shares of the
// pixels to the left; row by row red, green and blue of each pixel. Directions are of length 1, in the frame of the picture:
// up is y, its middle is −z, and to the right of the middle is x.

// The light from a direction, cd/m², and the probability density of that direction in `panorama_sample`.
fn panorama_seen(table: u32, d: vec3<f32>) -> vec4<f32> {
    let columns = u32(illumination_number(table));
    let rows = u32(illumination_number(table + 1u));
    let across = 0.5 + polar_angle(-d.z, d.x) / (2.0 * PI);
    let down = polar_angle(d.y, length(d.xz)) / PI;
    let column = min(u32(max(across, 0.0) * f32(columns)), columns - 1u);
    let row = min(u32(max(down, 0.0) * f32(rows)), rows - 1u);
    let at = table + 4u + rows + rows * (columns + 1u) + 3u * (row * columns + column);
    let light = vec3(illumination_number(at), illumination_number(at + 1u), illumination_number(at + 2u));
    let total = illumination_number(table + 2u);
    if total == 0.0 {
        return vec4(light, 0.25 / PI);
    }
    return vec4(light, dot(light, vec3(0.2126, 0.7152, 0.0722)) / total);
}

// A direction for a point of the unit square, and its probability density.
fn panorama_sample(table: u32, u: vec2<f32>) -> vec4<f32> {
    let columns = u32(illumination_number(table));
    let rows = u32(illumination_number(table + 1u));
    let row = panorama_place(table + 3u, rows, u.y);
    let first = table + 4u + rows + u32(row.x) * (columns + 1u);
    let column = panorama_place(first, columns, u.x);
    // Half a turn has all rows.
    let up = panorama_turn(0.5 * row.x / f32(rows)).x;
    let down = panorama_turn(0.5 * (row.x + 1.0) / f32(rows)).x;
    let cosine = up + row.y * (down - up);
    let around = panorama_turn((column.x + column.y) / f32(columns)) * sine_of(abs(cosine));
    let d = vec3(-around.y, cosine, around.x);
    // A direction at an edge may count to the next pixel by rounding: its own density belongs to it.
    return vec4(d, panorama_seen(table, d).w);
}

// The last of `count` bins that begins at u or before, and the place of u within it.
fn panorama_place(first: u32, count: u32, u: f32) -> vec2<f32> {
    // The largest number below 1.
    let x = clamp(u, 0.0, 0.99999994);
    var low = 0u;
    var high = count;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if illumination_number(first + middle) <= x {
            low = middle;
        } else {
            high = middle;
        }
    }
    let begin = illumination_number(first + low);
    return vec2(f32(low), clamp((x - begin) / (illumination_number(first + low + 1u) - begin), 0.0, 1.0));
}

// The cosine and the sine of a part of a full turn, by their series within an eighth of a turn; the built-in ones may be off
// by 4096 units in the last place.
fn panorama_turn(part: f32) -> vec2<f32> {
    let quarter = floor(4.0 * part + 0.5);
    let x = (4.0 * part - quarter) * (0.5 * PI);
    let s = x * x;
    let cosine = 1.0 - s * (0.5 - s * (1.0 / 24.0 - s * (1.0 / 720.0 - s / 40320.0)));
    let sine = x * (1.0 - s * (1.0 / 6.0 - s * (1.0 / 120.0 - s * (1.0 / 5040.0 - s / 362880.0))));
    switch u32(quarter) % 4u {
        case 0u: { return vec2(cosine, sine); }
        case 1u: { return vec2(-sine, cosine); }
        case 2u: { return vec2(-cosine, -sine); }
        default: { return vec2(sine, -cosine); }
    }
}
