// Light that comes through a solid body, the twin of src/reference/through.rs: the ray of view goes in, follows the mesh of
// the object, and leaves into the lights with extent and uniform light. The wrapper defines `interior_row(i: u32) -> vec4<f32>`
// and `solid_placement() -> mat4x4<f32>`, the place, rotation and size of the object.

// What has left a smooth body so far.
var<private> solid_light: vec3<f32>;
// What remains inside a rough one.
var<private> solid_remaining: vec3<f32>;

fn uniform_light(position: vec3<f32>) -> vec3<f32> {
    var sum = vec3(0.0);
    for (var i = 0u; i < min(illumination.count, MAX_LIGHTS); i++) {
        let light = light_at(i);
        let arriving = incident(light, position);
        if arriving.everywhere != 0u {
            sum += arriving.intensity * light.colour;
        }
    }
    return sum;
}

fn leaves_solid(position: vec3<f32>, direction: vec3<f32>, part: vec3<f32>) {
    solid_light += part * (PI * radiance_from(position, direction) + uniform_light(position));
}

// The object as a solid in its place.
fn solid_here() -> Solid {
    let room = solid_placement();
    let size = length(room[0].xyz);
    let rotation = mat3x3(room[0].xyz / size, room[1].xyz / size, room[2].xyz / size);
    return Solid(rotation, room[3].xyz, size, 0u, u32(interior_row(0u).w));
}

// The pane that stands for a body whose mesh is not closed.
fn through_pane(position: vec3<f32>, view: vec3<f32>, frame: Frame, ior: f32) -> vec3<f32> {
    let cosine = dot(frame.n, view);
    if cosine <= 0.0 {
        return vec3(0.0);
    }
    let first = dielectric(select(ior, 1.0, is_matched(ior)), cosine);
    let both = slab(vec3(first), vec3(1.0));
    solid_light = vec3(0.0);
    for (var side = 0u; side < 2u; side++) {
        let passes = side == 1u;
        let part = select(max(both.reflectance - first, vec3(0.0)), both.transmittance, passes);
        leaves_solid(position, select(mirror(view, frame.n), -view, passes), part);
    }
    return solid_light;
}

// A direction at a rough boundary, zero if there is none.
fn walk_direction(facets: Interface, order: u32, index: u32, v: vec3<f32>) -> vec3<f32> {
    if is_matched(facets.ior) {
        return -v;
    }
    let first = 65537u + 2u * order;
    let a = sequence_point(sample_seed, sequence_hash(first), index);
    let b = sequence_point(sample_seed, sequence_hash(first + 1u), index);
    return interface_sample(facets, vec3(a, b.x), v);
}

// The part of the light from that direction; negative if there is none.
fn walk_weight(facets: Interface, l: vec3<f32>, v: vec3<f32>) -> f32 {
    if is_matched(facets.ior) {
        return 1.0;
    }
    let pdf = interface_pdf(facets, l, v);
    if pdf > 0.0 {
        return interface_bsdf(facets, l, v) * abs(l.z) / pdf;
    }
    return -1.0;
}

// What a rough boundary lets through from lights without extent and from a sample of each with extent.
fn boundary_light(
    position: vec3<f32>, facets: Interface, frame: Frame, v: vec3<f32>, seed: u32, index: u32,
) -> vec3<f32> {
    var sum = vec3(0.0);
    for (var i = 0u; i < min(illumination.count, MAX_LIGHTS); i++) {
        let light = light_at(i);
        var l = vec3(0.0);
        var arriving = vec3(0.0);
        if has_extent(light.light_type) {
            let chosen = sample_light(light, position, sequence_point(seed, i + 1u, index));
            if chosen.pdf > 0.0 {
                l = to_local(frame, chosen.l);
                let weight = power_heuristic(chosen.pdf, interface_pdf(facets, l, v));
                arriving = chosen.radiance * (weight / chosen.pdf);
            }
        } else {
            let from_point = incident(light, position);
            if from_point.everywhere == 0u {
                l = to_local(frame, from_point.l);
                arriving = from_point.intensity;
            }
        }
        if l.z > 0.0 && any(arriving != vec3(0.0)) {
            sum += PI * l.z * interface_transmitted(facets, l, v) * arriving * light.colour;
        }
    }
    return sum;
}

// One ray through a rough body.
fn walk_inside(
    solid: Solid, facets: Interface, sigma: vec3<f32>,
    position: vec3<f32>, view: vec3<f32>, normal_outside: vec3<f32>, index: u32,
) -> vec3<f32> {
    solid_remaining = vec3(0.0);
    // The facets are alike in all directions, whatever the tangent.
    var frame = frame_from_normal(normal_outside);
    var v = to_local(frame, view);
    var l = walk_direction(facets, 0u, index, v);
    if l.z >= 0.0 {
        return vec3(0.0);
    }
    let entered = walk_weight(facets, l, v);
    if entered < 0.0 {
        return vec3(0.0);
    }
    var part = vec3(entered);
    let to_mesh = transpose(solid.rotation);
    var direction = frame.t * l.x + frame.b * l.y + frame.n * l.z;
    var ray = MeshRay(to_mesh * (position - solid.position) / solid.size, unit_or_zero(to_mesh * direction));
    var light = vec3(0.0);
    for (var order = 1u; order <= INSIDE_ORDERS; order++) {
        let hit = hierarchy_nearest(solid.base, ray, -INSIDE_BEHIND, 1e30, true);
        if hit.met == 0u || all(part == vec3(0.0)) {
            break;
        }
        part *= absorption_left(sigma, solid.size * hit.distance);
        let face = solid.rotation * hierarchy_triangle_normal(solid.base, hit.triangle);
        var shading = hierarchy_triangle(solid.base, hit.triangle)[3];
        if solid.by_polygon == 0u {
            shading = hierarchy_vertex_normal(solid.base, hit);
        }
        shading = solid.rotation * shading;
        let origin = hierarchy_point(solid.base, hit);
        let place = solid.rotation * (solid.size * origin) + solid.position;
        let back = -(solid.rotation * ray.direction);
        var normal = shading;
        if dot(shading, back) >= 0.0 {
            normal = select(-back, face, dot(face, back) < 0.0);
        }
        frame = frame_from_normal(normal);
        v = to_local(frame, back);
        let seed = sequence_hash(sample_seed ^ sequence_hash(order));
        light += part * boundary_light(place, facets, frame, v, seed, index);
        l = walk_direction(facets, order, index, v);
        if l.z == 0.0 {
            break;
        }
        let weight = walk_weight(facets, l, v);
        if weight < 0.0 {
            break;
        }
        part *= weight;
        direction = frame.t * l.x + frame.b * l.y + frame.n * l.z;
        if l.z > 0.0 {
            let seen = radiance_beside(place, direction, interface_pdf(facets, l, v));
            return light + part * (PI * seen + uniform_light(place));
        }
        if dot(face, direction) >= 0.0 {
            break;
        }
        ray = MeshRay(origin, unit_or_zero(to_mesh * direction));
    }
    solid_remaining = part;
    return light;
}

fn through(position: vec3<f32>, view: vec3<f32>, frame: Frame, selection: u32) -> vec3<f32> {
    return entering(view, frame, parameters) * from_within(position, view, frame, selection);
}

fn from_within(position: vec3<f32>, view: vec3<f32>, frame: Frame, selection: u32) -> vec3<f32> {
    let remains = selection == TERM_REMAINING;
    if selection != TERM_ALL && selection != TERM_TRANSMITTED && !remains {
        return vec3(0.0);
    }
    let inside = interior_row(0u);
    let sigma = interior_row(1u).xyz;
    if hierarchy_row(0u).x == 0u {
        return select(through_pane(position, view, frame, inside.x), vec3(0.0), remains);
    }
    let solid = solid_here();
    let rough = inside.z >= MINIMUM_ALPHA;
    let disperses = inside.y != 0.0;
    let samples = max(illumination.sample_count, 1u);
    let first = illumination.first_sample;
    var count = 1u;
    if rough {
        count = samples;
    } else if disperses {
        count = 16u * clamp(samples / 16u, 1u, 4u);
    }
    var colour = vec3(0.0);
    for (var i = 0u; i < count; i++) {
        var ior = inside.x;
        var weight = vec3(1.0);
        if disperses {
            var u = sequence_point(sample_seed, 65536u, first + select(0u, i, rough)).x;
            if !rough {
                u = (f32(i) + u) / f32(count);
            }
            let wave = spectrum(u);
            ior = cauchy(inside.x, inside.y, wave.nm);
            weight = wave.weight;
        }
        if rough {
            let facets = Interface(0u, vec2(inside.z), select(ior, 1.0, is_matched(ior)));
            let light = walk_inside(solid, facets, sigma, position, view, frame.n, first + i);
            colour += weight * select(light, solid_remaining, remains);
        } else {
            solid_light = vec3(0.0);
            let remaining = follow_inside(solid, ior, sigma, position, view, frame.n, frame.n);
            colour += weight * select(solid_light, remaining, remains);
        }
    }
    return colour / f32(count);
}
