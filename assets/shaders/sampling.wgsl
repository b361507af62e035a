// Directions chosen at random and their densities, the twin of `src/optics/sequence.rs`, `sampling.rs` and `lobes.rs`. Composed
// only where a scene has light with extent.

// A well-mixed number of another one: the output permutation of PCG (M. O'Neill 2014).
fn sequence_hash(x: u32) -> u32 {
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

// Flips each bit of a number depending on those above it: Owen's scrambling (B. Burley 2020; hash of N. Vegdahl 2021).
fn sequence_scramble(value: u32, seed: u32) -> u32 {
    var x = reverseBits(value);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16u) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverseBits(x);
}

// A point of Sobol's sequence with a number, for a pixel or vertex with a seed.
fn sequence_point(seed: u32, number: u32, index: u32) -> vec2<f32> {
    let order = sequence_hash(sequence_hash(seed) ^ number);
    let across = sequence_hash(order);
    let i = sequence_scramble(index & 0xfffffu, order) & 0xfffffu;
    // The second dimension: Pascal's triangle modulo 2, as five factors, times the index.
    var y = i ^ (i >> 16u);
    y ^= (y & 0xff00ff00u) >> 8u;
    y ^= (y & 0xf0f0f0f0u) >> 4u;
    y ^= (y & 0xccccccccu) >> 2u;
    y ^= (y & 0xaaaaaaaau) >> 1u;
    let point = vec2(
        sequence_scramble(reverseBits(i), across),
        sequence_scramble(reverseBits(y), sequence_hash(across)),
    );
    return vec2<f32>(point >> vec2(8u)) / 16777216.0;
}

// The angle of a cosine in [−1, 1], radians.
fn angle_of_cosine(cosine: f32) -> f32 {
    let angle = arc_cosine(abs(cosine));
    return select(angle, PI - angle, cosine < 0.0);
}

// A point of the unit disc for one of the unit square (P. Shirley, K. Chiu 1997).
fn sample_disc_map(u: vec2<f32>) -> vec2<f32> {
    let ab = 2.0 * u - 1.0;
    if ab.x == 0.0 && ab.y == 0.0 {
        return vec2(0.0);
    }
    let wide = abs(ab.x) > abs(ab.y);
    let radius = select(ab.y, ab.x, wide);
    let ratio = 0.25 * PI * select(ab.x, ab.y, wide) / radius;
    let angle = select(0.5 * PI - ratio, ratio, wide);
    return radius * vec2(cos(angle), sin(angle));
}

// A direction within a cone about z, for 1 minus the cosine of its half angle; its density is 1/(2π rise).
fn sample_cone(u: vec2<f32>, rise: f32) -> vec3<f32> {
    let down = u.x * rise;
    let phi = 2.0 * PI * u.y;
    return vec3(sqrt(max(down * (2.0 - down), 0.0)) * vec2(cos(phi), sin(phi)), 1.0 - down);
}

// A direction of the frame about a unit vector.
fn about(axis: vec3<f32>, local: vec3<f32>) -> vec3<f32> {
    let frame = frame_from_normal(axis);
    return local.x * frame.t + local.y * frame.b + local.z * axis;
}

// The density per solid angle of a point of a surface that is sampled by area: d²/(A cos θ).
fn area_pdf(at: vec3<f32>, normal: vec3<f32>, area: f32) -> f32 {
    let squared = dot(at, at);
    let facing = abs(dot(at, normal)) * area;
    if facing > 1e-12 * squared {
        return squared * sqrt(squared) / facing;
    }
    return 0.0;
}

// A rectangle seen from a point (C. Ureña, M. Fajardo, A. King 2013): the twin of `SphericalRectangle`.
struct SphericalRectangle {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>,
    low: vec2<f32>,
    high: vec2<f32>,
    depth: f32,
    b0: f32,
    b1: f32,
    k: f32,
    // Zero if its area is sampled.
    solid_angle: f32,
}

fn spherical_rectangle(middle: vec3<f32>, x: vec3<f32>, y: vec3<f32>, half: vec2<f32>) -> SphericalRectangle {
    var seen: SphericalRectangle;
    seen.x = x;
    seen.y = y;
    seen.z = cross(x, y);
    seen.depth = dot(middle, seen.z);
    if seen.depth > 0.0 {
        seen.z = -seen.z;
        seen.depth = -seen.depth;
    }
    let at = vec2(dot(middle, x), dot(middle, y));
    seen.low = at - half;
    seen.high = at + half;
    let squared = seen.depth * seen.depth;
    let low = seen.low / sqrt(squared + seen.low * seen.low);
    let high = seen.high / sqrt(squared + seen.high * seen.high);
    seen.b0 = -low.y;
    seen.b1 = high.y;
    let g0 = angle_of_cosine(low.y * high.x);
    let g1 = angle_of_cosine(-high.x * high.y);
    let g2 = angle_of_cosine(high.y * low.x);
    let g3 = angle_of_cosine(-low.x * low.y);
    seen.k = 2.0 * PI - g2 - g3;
    let solid_angle = g0 + g1 - seen.k;
    if solid_angle > 0.02 && -seen.depth >= 1e-6 {
        seen.solid_angle = solid_angle;
    }
    return seen;
}

fn spherical_rectangle_sample(seen: SphericalRectangle, u: vec2<f32>) -> vec3<f32> {
    var on = mix(seen.low, seen.high, u);
    if seen.solid_angle > 0.0 {
        let angle = u.x * seen.solid_angle + seen.k;
        let f = (cos(angle) * seen.b0 - seen.b1) / sin(angle);
        let c = clamp(sign(f) * inverseSqrt(f * f + seen.b0 * seen.b0), -1.0, 1.0);
        let x = clamp(-c * seen.depth / sqrt(max((1.0 - c) * (1.0 + c), 1e-12)), seen.low.x, seen.high.x);
        let squared = x * x + seen.depth * seen.depth;
        let ends = vec2(seen.low.y, seen.high.y);
        let slopes = ends / sqrt(squared + ends * ends);
        let h = mix(slopes.x, slopes.y, u.y);
        on = vec2(x, clamp(h * sqrt(squared / max((1.0 - h) * (1.0 + h), 1e-12)), seen.low.y, seen.high.y));
    }
    return seen.x * on.x + seen.y * on.y + seen.z * seen.depth;
}

fn spherical_rectangle_pdf(seen: SphericalRectangle, at: vec3<f32>) -> f32 {
    if seen.solid_angle > 0.0 {
        return 1.0 / seen.solid_angle;
    }
    let sides = seen.high - seen.low;
    return area_pdf(at, seen.z, sides.x * sides.y);
}

// The sides of a rectangle that shines in a direction, turned about it by degrees: the second, its height, points up as nearly
// as the direction allows.
struct Sides {
    x: vec3<f32>,
    y: vec3<f32>,
}

fn rectangle_sides(direction: vec3<f32>, turn: vec2<f32>) -> Sides {
    let across = cross(vec3(0.0, 1.0, 0.0), direction);
    let squared = dot(across, across);
    var x = vec3(1.0, 0.0, 0.0);
    if squared > 1e-12 {
        x = across / sqrt(squared);
    }
    let y = cross(direction, x);
    return Sides(x * turn.y + y * turn.x, y * turn.y - x * turn.x);
}

// The weight of a direction that one of two ways of sampling chose: the power heuristic (E. Veach, L. Guibas 1995).
fn power_heuristic(own: f32, other: f32) -> f32 {
    if own <= 0.0 {
        return 0.0;
    }
    let ratio = other / own;
    return 1.0 / (1.0 + ratio * ratio);
}

// The lobes of a model: kind (0 cosine, 1 GGX, 2 power; below the surface 3 cosine, 4 plus the refractive index GGX), two numbers,
// share.
const LOBES: u32 = 3u;

// A viewer above the surface: at the horizon, rounding may have put it below.
fn lobe_view(v: vec3<f32>) -> vec3<f32> {
    if v.z >= 1e-4 {
        return v;
    }
    return normalize(vec3(v.xy, 1e-4));
}

fn lobe_sample(lobe: vec4<f32>, u: vec2<f32>, v: vec3<f32>) -> vec3<f32> {
    if lobe.x == 0.0 {
        let d = sample_disc_map(u);
        return vec3(d, sqrt(max(1.0 - dot(d, d), 0.0)));
    }
    if lobe.x == 3.0 {
        let d = sample_disc_map(u);
        return -vec3(d, sqrt(max(1.0 - dot(d, d), 0.0)));
    }
    let phi = 2.0 * PI * select(u.x, u.y, lobe.x == 2.0);
    let turn = vec2(cos(phi), sin(phi));
    if lobe.x != 2.0 {
        // Visible normals of GGX (E. Heitz 2018; J. Dupuy, A. Benyoub 2023).
        let wide = normalize(vec3(v.xy * lobe.yz, v.z));
        let z = (1.0 - u.y) * (1.0 + wide.z) - wide.z;
        let cap = vec3(sqrt(max((1.0 - z) * (1.0 + z), 0.0)) * turn, z) + wide;
        let h = unit_or_zero(vec3(cap.xy * lobe.yz, max(cap.z, 0.0)));
        let mirrored = 2.0 * dot(v, h) * h - v;
        if lobe.x == 1.0 {
            return mirrored;
        }
        let eta = lobe.x - 4.0;
        if eta == 1.0 {
            return vec3(mirrored.xy, -mirrored.z);
        }
        let facing = dot(v, h);
        let squared = 1.0 - (1.0 - facing * facing) / (eta * eta);
        if squared <= 0.0 {
            return vec3(0.0);
        }
        return (facing / eta - sqrt(squared)) * h - v / eta;
    }
    let cosine = power(u.x, 1.0 / (lobe.y + 1.0));
    let local = vec3(sqrt(max((1.0 - cosine) * (1.0 + cosine), 0.0)) * turn, cosine);
    return about(vec3(-v.xy, v.z), local);
}

// The density of visible GGX facets along h, of any length, over V·H.
fn lobe_facets(widths: vec2<f32>, h: vec3<f32>, v: vec3<f32>) -> f32 {
    let squared = dot(h, h);
    if h.z <= 0.0 || squared <= 0.0 {
        return 0.0;
    }
    let wide = vec3(h.xy / widths, h.z);
    let stretched = dot(wide, wide);
    let d = squared * squared / (PI * widths.x * widths.y * stretched * stretched);
    return 2.0 * d / (v.z + length(vec3(widths * v.xy, v.z)));
}

fn lobe_pdf_below(lobe: vec4<f32>, l: vec3<f32>, v: vec3<f32>) -> f32 {
    if lobe.x == 3.0 {
        return max(-l.z, 0.0) / PI;
    }
    let eta = lobe.x - 4.0;
    if eta == 1.0 {
        return lobe_facets(lobe.yz, vec3(l.xy, -l.z) + v, v) / 4.0;
    }
    let sum = v + eta * l;
    let h = unit_or_zero(sum) * select(1.0, -1.0, sum.z < 0.0);
    let to_viewer = dot(v, h);
    let to_light = dot(l, h);
    if to_viewer <= 0.0 || to_light >= 0.0 {
        return 0.0;
    }
    let across = to_viewer + eta * to_light;
    let turned = to_viewer * eta * eta * -to_light / max(across * across, 1e-12);
    return lobe_facets(lobe.yz, h, v) * turned;
}

fn lobe_pdf(lobe: vec4<f32>, l: vec3<f32>, v: vec3<f32>) -> f32 {
    if lobe.x > 2.0 {
        return lobe_pdf_below(lobe, l, v);
    }
    if lobe.x == 0.0 {
        return max(l.z, 0.0) / PI;
    }
    if lobe.x == 1.0 {
        return lobe_facets(lobe.yz, l + v, v) / 4.0;
    }
    let cosine = min(v.z * l.z - dot(v.xy, l.xy), 1.0);
    if cosine <= 0.0 {
        return 0.0;
    }
    return (lobe.y + 1.0) / (2.0 * PI) * power(cosine, lobe.y);
}

// True if none is wider along the tangent than across. They are sampled in the frame of the normal alone.
fn lobes_are_isotropic() -> bool {
    var same = true;
    for (var i = 0u; i < LOBES; i++) {
        let lobe = lobe_row(i);
        same = same && ((lobe.x != 1.0 && lobe.x < 4.0) || lobe.y == lobe.z);
    }
    return same;
}

fn lobes_sample(u: vec2<f32>, v: vec3<f32>) -> vec3<f32> {
    var x = u.x;
    var chosen = vec4(0.0);
    for (var i = 0u; i < LOBES; i++) {
        chosen = lobe_row(i);
        if x < chosen.w {
            break;
        }
        x -= select(0.0, chosen.w, i + 1u < LOBES);
    }
    let rest = select(0.5, min(x / chosen.w, 0.99999994), chosen.w > 0.0);
    return lobe_sample(chosen, vec2(rest, u.y), v);
}

fn lobes_pdf(l: vec3<f32>, v: vec3<f32>) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < LOBES; i++) {
        let lobe = lobe_row(i);
        if lobe.w > 0.0 {
            sum += lobe.w * lobe_pdf(lobe, l, v);
        }
    }
    return sum;
}

// A direction to a light with extent, the radiance that arrives from there without the colour of the light, and the density of
// the direction: the twin of Rust's `Sample`.
struct LightSample {
    l: vec3<f32>,
    radiance: vec3<f32>,
    pdf: f32,
}

// What a light with extent is in a direction; the distance is negative for light from infinitely far away, zero where there is
// none.
struct LightSeen {
    radiance: vec3<f32>,
    pdf: f32,
    distance: f32,
}

const NOTHING_SEEN: LightSeen = LightSeen(vec3(0.0), 0.0, 0.0);

// True if a light shines towards a point: to its front, or to both sides.
fn light_shines(facing: f32, two_sided: u32) -> bool {
    return facing > 0.0 || (two_sided != 0u && facing < 0.0);
}
