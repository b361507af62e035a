// A measured surface of the RGL database (J. Dupuy, W. Jakob 2018): the twin of src/reflection/measured_rgl/table.rs. From `table` on,
// the words of the file are: counts of azimuths and angles; columns and rows of density, values, distribution, area; the parts of
// a turn; 1 if values are relative to the density; four for other uses; then the arrays.
const RGL_HEADER: u32 = 16u;
const RGL_LEAST: f32 = 1e-12;

fn rgl_number(i: u32) -> f32 {
    return bitcast<f32>(file_word(i));
}

// The azimuth by the symmetry of the file.
fn rgl_azimuth(parts: f32, seen: f32, phi: f32) -> f32 {
    if parts < 0.5 {
        return phi - seen;
    }
    if parts < 1.5 {
        return phi;
    }
    if parts < 2.5 {
        return phi - select(0.0, PI, seen >= 0.0);
    }
    let up = select(phi, -phi, seen >= 0.0);
    return select(up, -PI - up, abs(seen) <= 0.5 * PI);
}

// The place of an angle among ascending ones.
fn rgl_place(first: u32, count: u32, angle: f32) -> f32 {
    if count < 2u || angle < rgl_number(first) {
        return 0.0;
    }
    var low = 0u;
    var high = count - 1u;
    while high - low > 1u {
        let middle = (low + high) / 2u;
        if rgl_number(first + middle) <= angle {
            low = middle;
        } else {
            high = middle;
        }
    }
    let a = rgl_number(first + low);
    return f32(low) + clamp((angle - a) / (rgl_number(first + high) - a), 0.0, 1.0);
}

// The place in a grid: column and row, and the fractions beyond them.
fn rgl_cell(size: vec2<u32>, at: vec2<f32>) -> vec4<f32> {
    let place = clamp(at, vec2(0.0), vec2(1.0)) * vec2<f32>(size - vec2(1u));
    let cell = min(floor(place), vec2<f32>(size - vec2(2u)));
    return vec4(cell, place - cell);
}

fn rgl_bilinear(first: u32, size: vec2<u32>, at: vec2<f32>) -> f32 {
    let cell = rgl_cell(size, at);
    let i = first + u32(cell.y) * size.x + u32(cell.x);
    let near = mix(rgl_number(i), rgl_number(i + 1u), cell.z);
    let far = mix(rgl_number(i + size.x), rgl_number(i + size.x + 1u), cell.z);
    return mix(near, far, cell.w);
}

// A number of an array with a part for each of four directions.
fn rgl_mixed(first: u32, slices: vec4<u32>, weights: vec4<f32>) -> f32 {
    let all = vec4(
        rgl_number(first + slices.x),
        rgl_number(first + slices.y),
        rgl_number(first + slices.z),
        rgl_number(first + slices.w),
    );
    return dot(all, weights);
}

// The same in two rows, and between them.
fn rgl_between(first: u32, row: u32, slices: vec4<u32>, weights: vec4<f32>, y: f32) -> f32 {
    return mix(rgl_mixed(first, slices, weights), rgl_mixed(first + row, slices, weights), y);
}

fn rgl_colour(i: u32) -> vec3<f32> {
    return vec3(rgl_number(i), rgl_number(i + 1u), rgl_number(i + 2u));
}

fn rgl_turn(phi: f32) -> f32 {
    let turn = phi / (2.0 * PI) + 0.5;
    return turn - floor(turn);
}

// The columns and rows of a grid.
fn rgl_size(at: u32) -> vec2<u32> {
    return vec2(u32(rgl_number(at)), u32(rgl_number(at + 1u)));
}

// f_r N·L for directions above the surface in the local frame.
fn rgl_value(table: u32, l: vec3<f32>, v: vec3<f32>) -> vec3<f32> {
    let counts = rgl_size(table);
    let density = rgl_size(table + 2u);
    let grid = rgl_size(table + 4u);
    let normals = rgl_size(table + 6u);
    let area = rgl_size(table + 8u);
    let parts = rgl_number(table + 10u);
    let pairs = counts.x * counts.y;
    let size = density.x * density.y;
    let phis = table + RGL_HEADER;
    let thetas = phis + counts.x;
    let ndf = thetas + counts.y;
    let sigma = ndf + normals.x * normals.y;
    let vndf = sigma + area.x * area.y;
    let rows = vndf + pairs * size;
    let marginal = rows + pairs * size;
    let values = marginal + pairs * density.y;

    let m = l + v;
    let seen = polar_angle(v.x, v.y);
    let phi = rgl_azimuth(parts, seen, seen);
    let theta = polar_angle(v.z, length(v.xy));
    let at = vec2(sqrt(polar_angle(m.z, length(m.xy)) / (0.5 * PI)), rgl_turn(rgl_azimuth(parts, seen, polar_angle(m.x, m.y))));

    let places = vec2(rgl_place(phis, counts.x, phi), rgl_place(thetas, counts.y, theta));
    let first = min(vec2<u32>(places), max(counts, vec2(2u)) - vec2(2u));
    let second = min(first + vec2(1u), counts - vec2(1u));
    let w = places - vec2<f32>(first);
    let weights = vec4((1.0 - w.x) * (1.0 - w.y), (1.0 - w.x) * w.y, w.x * (1.0 - w.y), w.x * w.y);
    let slices = vec4(
        first.x * counts.y + first.y,
        first.x * counts.y + second.y,
        second.x * counts.y + first.y,
        second.x * counts.y + second.y,
    );

    // The place of the normal by the density.
    let cell = rgl_cell(density, at);
    let x = cell.z;
    let y = cell.w;
    let row = u32(cell.y) * density.x;
    let i = row + u32(cell.x);
    let in_grid = slices * size;
    let left = rgl_between(vndf + i, density.x, in_grid, weights, y);
    let right = rgl_between(vndf + i + 1u, density.x, in_grid, weights, y);
    let low = rgl_mixed(rows + row + density.x - 1u, in_grid, weights);
    let high = rgl_mixed(rows + row + 2u * density.x - 1u, in_grid, weights);
    let whole = mix(low, high, y);
    let across = rgl_between(rows + i, density.x, in_grid, weights, y) + x * (left + 0.5 * x * (right - left));
    let up = rgl_mixed(marginal + u32(cell.y), slices * density.y, weights) + y * (low + 0.5 * y * (high - low));
    let place = rgl_cell(grid, vec2(select(0.0, across / max(whole, RGL_LEAST), whole > RGL_LEAST), up));

    var sum = vec3(0.0);
    // With one azimuth, the other two are the same, and count nothing.
    let near_count = select(4u, 2u, counts.x < 2u);
    for (var k = 0u; k < near_count; k++) {
        let j = values + 3u * (slices[k] * grid.x * grid.y + u32(place.y) * grid.x + u32(place.x));
        let near = mix(rgl_colour(j), rgl_colour(j + 3u), place.z);
        let far = mix(rgl_colour(j + 3u * grid.x), rgl_colour(j + 3u * grid.x + 3u), place.z);
        sum += weights[k] * mix(near, far, place.w);
    }
    if rgl_number(table + 11u) == 0.0 {
        return sum;
    }
    let projected = rgl_bilinear(sigma, area, vec2(sqrt(theta / (0.5 * PI)), rgl_turn(phi)));
    if projected <= RGL_LEAST {
        return vec3(0.0);
    }
    return sum * (rgl_bilinear(ndf, normals, at) / (4.0 * projected));
}

fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    if dot(frame.n, l) <= 0.0 || dot(frame.n, v) <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let local_l = vec3(dot(frame.t, l), dot(frame.b, l), dot(frame.n, l));
    let local_v = vec3(dot(frame.t, v), dot(frame.b, v), dot(frame.n, v));
    return Terms(vec3(0.0), vec3(0.0), PI * rgl_value(m.rgl_file, local_l, local_v));
}
