// Where a ray first meets a mesh: the twin of src/shape/hierarchy/traverse.rs, whose mod.rs has the layout of the rows.
// The wrapper defines `hierarchy_row(i: u32) -> vec4<u32>`; `base` is the first row of a mesh's hierarchy.

const HIERARCHY_NO_CHILD: u32 = 0xffffffffu;
const HIERARCHY_LEAF: u32 = 0x80000000u;
const HIERARCHY_COUNT_SHIFT: u32 = 28u;
const HIERARCHY_NODE_ROWS: u32 = 7u;
const HIERARCHY_TRIANGLE_ROWS: u32 = 3u;
// Three children for each of the levels, and one; `STACK` in Rust.
const HIERARCHY_STACK: u32 = 37u;
// Drivers may round a product before the difference of two, or not: edges count for both triangles within that.
const HIERARCHY_EDGE_SLACK: f32 = 2.4e-7;

// A ray in the units of the mesh; distances are multiples of its direction.
struct MeshRay {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

// Where a ray meets a triangle: `leaves` is 1 from inside, 0 from outside; `met` is 0 if there is nothing.
struct MeshHit {
    distance: f32,
    weights: vec3<f32>,
    triangle: u32,
    leaves: u32,
    met: u32,
}

// A ray, prepared: the inverse of its direction for boxes; for triangles, the axes with the main one last, the
// shear along the first two and the scale of the last.
struct PreparedRay {
    origin: vec3<f32>,
    inverse: vec3<f32>,
    axes: vec3<u32>,
    shear: vec3<f32>,
}

fn hierarchy_numbers(row: u32) -> vec4<f32> {
    return bitcast<vec4<f32>>(hierarchy_row(row));
}

fn ray_component(v: vec3<f32>, axis: u32) -> f32 {
    return select(select(v.z, v.y, axis == 1u), v.x, axis == 0u);
}

fn ray_inverse(c: f32) -> f32 {
    return select(1.0, -1.0, c < 0.0) / max(abs(c), 1e-20);
}

fn prepare_ray(ray: MeshRay) -> PreparedRay {
    let d = ray.direction;
    let size = abs(d);
    var axes = vec3<u32>(1u, 2u, 0u);
    if size.y > size.x && size.y >= size.z {
        axes = vec3<u32>(2u, 0u, 1u);
    } else if size.z > size.x {
        axes = vec3<u32>(0u, 1u, 2u);
    }
    // Backwards, left and right are exchanged, so that signs tell the side.
    if ray_component(d, axes.z) < 0.0 {
        axes = axes.yxz;
    }
    let scale = 1.0 / ray_component(d, axes.z);
    let shear = vec3(ray_component(d, axes.x) * scale, ray_component(d, axes.y) * scale, scale);
    return PreparedRay(ray.origin, vec3(ray_inverse(d.x), ray_inverse(d.y), ray_inverse(d.z)), axes, shear);
}

// Where a ray enters the boxes of the children of a node; 1e30 where it misses them, or where there is no child.
fn hierarchy_enter(ray: PreparedRay, row: u32, children: vec4<u32>, least: f32, most: f32) -> vec4<f32> {
    var near = vec4(least);
    var far = vec4(most);
    for (var axis = 0u; axis < 3u; axis++) {
        let origin = ray_component(ray.origin, axis);
        let inverse = ray_component(ray.inverse, axis);
        let low = (hierarchy_numbers(row + axis) - origin) * inverse;
        let high = (hierarchy_numbers(row + 3u + axis) - origin) * inverse;
        near = max(near, min(low, high));
        far = min(far, max(low, high));
    }
    let meets = (near <= far) & (children != vec4(HIERARCHY_NO_CHILD));
    return select(vec4(1e30), near, meets);
}

// Where a ray meets a triangle; nothing where the distance is out of range.
fn hierarchy_meet(ray: PreparedRay, base: u32, triangle: u32, least: f32, most: f32, only_inside: bool) -> MeshHit {
    let nothing = MeshHit(most, vec3(0.0), 0u, 0u, 0u);
    let row = base + hierarchy_row(base).y + HIERARCHY_TRIANGLE_ROWS * triangle;
    let z = hierarchy_numbers(row + ray.axes.z).xyz - ray_component(ray.origin, ray.axes.z);
    let x = hierarchy_numbers(row + ray.axes.x).xyz - ray_component(ray.origin, ray.axes.x) - ray.shear.x * z;
    let y = hierarchy_numbers(row + ray.axes.y).xyz - ray_component(ray.origin, ray.axes.y) - ray.shear.y * z;
    let first = x.yzx * y.zxy;
    let second = y.yzx * x.zxy;
    var edges = first - second;
    let slack = HIERARCHY_EDGE_SLACK * (abs(first) + abs(second));
    let inside = all(edges >= -slack);
    if !inside && (only_inside || !all(edges <= slack)) {
        return nothing;
    }
    // Within the slack, the nearest point of the triangle, so that weights are between 0 and 1.
    edges = select(min(edges, vec3(0.0)), max(edges, vec3(0.0)), inside);
    let sum = edges.x + edges.y + edges.z;
    if sum == 0.0 || (only_inside && sum < 0.0) {
        return nothing;
    }
    let weights = edges / sum;
    let distance = ray.shear.z * dot(weights, z);
    if !(distance >= least && distance < most) {
        return nothing;
    }
    return MeshHit(distance, weights, triangle, select(0u, 1u, sum > 0.0), 1u);
}

// Where a ray first meets a triangle within a range of distances, from both sides or from inside alone.
fn hierarchy_nearest(base: u32, ray: MeshRay, least: f32, most: f32, only_inside: bool) -> MeshHit {
    let ready = prepare_ray(ray);
    let nodes = base + hierarchy_row(base).x;
    var best = MeshHit(most, vec3(0.0), 0u, 0u, 0u);
    var waiting: array<u32, HIERARCHY_STACK>;
    var enters: array<f32, HIERARCHY_STACK>;
    waiting[0] = 0u;
    enters[0] = least;
    var count = 1u;
    while count > 0u {
        count -= 1u;
        let child = waiting[count];
        if enters[count] > best.distance {
            continue;
        }
        if (child & HIERARCHY_LEAF) != 0u {
            let first = child & ((1u << HIERARCHY_COUNT_SHIFT) - 1u);
            let last = first + ((child >> HIERARCHY_COUNT_SHIFT) & 7u);
            for (var triangle = first; triangle <= last; triangle++) {
                let hit = hierarchy_meet(ready, base, triangle, least, best.distance, only_inside);
                if hit.met != 0u {
                    best = hit;
                }
            }
            continue;
        }
        // The farthest child first, so that the nearest is next: a sorting network (K. Batcher 1968), since software Vulkan
        // ends all loops of a pixel after 65 536 turns together.
        let row = nodes + HIERARCHY_NODE_ROWS * child;
        var who = hierarchy_row(row + 6u);
        var far = hierarchy_enter(ready, row, who, least, best.distance);
        if far.x < far.y {
            who = who.yxzw;
            far = far.yxzw;
        }
        if far.z < far.w {
            who = who.xywz;
            far = far.xywz;
        }
        if far.x < far.z {
            who = who.zyxw;
            far = far.zyxw;
        }
        if far.y < far.w {
            who = who.xwzy;
            far = far.xwzy;
        }
        if far.y < far.z {
            who = who.xzyw;
            far = far.xzyw;
        }
        if far.x < 1e30 {
            waiting[count] = who.x;
            enters[count] = far.x;
            count += 1u;
        }
        if far.y < 1e30 {
            waiting[count] = who.y;
            enters[count] = far.y;
            count += 1u;
        }
        if far.z < 1e30 {
            waiting[count] = who.z;
            enters[count] = far.z;
            count += 1u;
        }
        if far.w < 1e30 {
            waiting[count] = who.w;
            enters[count] = far.w;
            count += 1u;
        }
    }
    return best;
}

// The corners of a triangle, counter-clockwise seen from outside, and the normal of its polygon.
fn hierarchy_triangle(base: u32, triangle: u32) -> mat4x3<f32> {
    let row = base + hierarchy_row(base).y + HIERARCHY_TRIANGLE_ROWS * triangle;
    return transpose(mat3x4(hierarchy_numbers(row), hierarchy_numbers(row + 1u), hierarchy_numbers(row + 2u)));
}

fn hierarchy_point(base: u32, hit: MeshHit) -> vec3<f32> {
    let corners = hierarchy_triangle(base, hit.triangle);
    return corners[0] * hit.weights.x + corners[1] * hit.weights.y + corners[2] * hit.weights.z;
}

// The unit normal of a triangle itself; that of its polygon if the triangle has no area.
fn hierarchy_triangle_normal(base: u32, triangle: u32) -> vec3<f32> {
    let corners = hierarchy_triangle(base, triangle);
    let sides = abs(corners[1] - corners[0]) + abs(corners[2] - corners[0]);
    let extent = max(max(sides.x, sides.y), max(sides.z, 1e-37));
    let normal = cross((corners[1] - corners[0]) / extent, (corners[2] - corners[0]) / extent);
    let squared = dot(normal, normal);
    if squared > 0.0 {
        return normal / sqrt(squared);
    }
    return corners[3];
}

// The mean of the normals of a triangle's vertices at a hit, of length 1.
fn hierarchy_vertex_normal(base: u32, hit: MeshHit) -> vec3<f32> {
    let begins = hierarchy_row(base);
    let vertices = hierarchy_row(base + begins.z + hit.triangle);
    let normals = base + begins.w;
    let a = hierarchy_numbers(normals + vertices.x).xyz;
    let b = hierarchy_numbers(normals + vertices.y).xyz;
    let c = hierarchy_numbers(normals + vertices.z).xyz;
    return unit_or_zero(a * hit.weights.x + b * hit.weights.y + c * hit.weights.z);
}
