// The way of light within a smooth solid, the twin of src/reference/inside.rs. The wrapper defines
// `leaves_solid(position: vec3<f32>, direction: vec3<f32>, part: vec3<f32>)`, which takes each part that leaves: where it
// does, where it goes, and how much of the radiance from there reaches the viewer.

const INSIDE_ORDERS: u32 = 16u;
const INSIDE_LEAST: f32 = 1e-7;
const INSIDE_BEHIND: f32 = 1e-5;

// A solid in its place: the first row of its hierarchy, and 1 if its boundary has the normals of polygons, not of vertices.
struct Solid {
    rotation: mat3x3<f32>,
    position: vec3<f32>,
    size: f32,
    base: u32,
    by_polygon: u32,
}

// What happens to a ray at a boundary: where it leaves, zero for total reflection; the part that is reflected.
struct Boundary {
    out: vec3<f32>,
    reflected: vec3<f32>,
    reflectance: f32,
}

fn boundary_with(direction: vec3<f32>, outer: vec3<f32>, eta: f32) -> Boundary {
    let out = refracted(-direction, -outer, 1.0 / eta);
    var reflectance = 1.0;
    if any(out != vec3(0.0)) {
        reflectance = refracting_reflectance(dot(out, outer), dot(direction, outer), 1.0 / eta);
    }
    return Boundary(out, -mirror(direction, outer), reflectance);
}

// The boundary by the normal of the shading, unless that leads to the wrong side of the triangle.
fn boundary_of(direction: vec3<f32>, shading: vec3<f32>, face: vec3<f32>, eta: f32) -> Boundary {
    let boundary = boundary_with(direction, shading, eta);
    let leaves = all(boundary.out == vec3(0.0)) || dot(boundary.out, face) > 0.0;
    if leaves && dot(direction, shading) > 0.0 && dot(boundary.reflected, face) < 0.0 {
        return boundary;
    }
    return boundary_with(direction, face, eta);
}

// The direction of a ray of view inside; zero where everything is reflected.
fn inwards(view: vec3<f32>, normal: vec3<f32>, face_normal: vec3<f32>, eta: f32) -> vec3<f32> {
    let direction = refracted(view, normal, eta);
    if all(direction == vec3(0.0)) || dot(direction, face_normal) < 0.0 {
        return direction;
    }
    let by_face = refracted(view, face_normal, eta);
    return select(by_face, -view, all(by_face == vec3(0.0)));
}

// Follows a ray of view that meets the solid at a point; sigma is the absorption coefficient. Returns the part that remains.
fn follow_inside(
    solid: Solid, ior: f32, sigma: vec3<f32>,
    position: vec3<f32>, view: vec3<f32>, normal: vec3<f32>, face_normal: vec3<f32>,
) -> vec3<f32> {
    let eta = select(ior, 1.0, is_matched(ior));
    let first = inwards(view, normal, face_normal, eta);
    var part = vec3(1.0 - dielectric(eta, dot(view, normal)));
    if all(first == vec3(0.0)) || part.x <= 0.0 {
        return vec3(0.0);
    }
    // Matrices of rotations: the transpose turns back.
    let to_mesh = transpose(solid.rotation);
    var ray = MeshRay(to_mesh * (position - solid.position) / solid.size, unit_or_zero(to_mesh * first));
    for (var order = 0u; order < INSIDE_ORDERS; order++) {
        let hit = hierarchy_nearest(solid.base, ray, -INSIDE_BEHIND, 1e30, true);
        // It only touches the rim, beside which the normal of the shading leads it, and goes straight on.
        let touches = hit.met == 0u && order == 0u;
        if hit.met == 0u && !touches {
            break;
        }
        var place = position;
        var out = -view;
        var leaving = part;
        if touches {
            part = vec3(0.0);
        } else {
            part *= absorption_left(sigma, solid.size * hit.distance);
            let face = hierarchy_triangle_normal(solid.base, hit.triangle);
            var shading = hierarchy_triangle(solid.base, hit.triangle)[3];
            if solid.by_polygon == 0u {
                shading = hierarchy_vertex_normal(solid.base, hit);
            }
            let boundary = boundary_of(ray.direction, shading, face, eta);
            let origin = hierarchy_point(solid.base, hit);
            place = solid.rotation * (solid.size * origin) + solid.position;
            out = solid.rotation * boundary.out;
            leaving = part * (1.0 - boundary.reflectance);
            part *= boundary.reflectance;
            ray = MeshRay(origin, unit_or_zero(boundary.reflected));
        }
        // In one place, as each call would stand in the shader in full.
        if any(out != vec3(0.0)) {
            leaves_solid(place, out, leaving);
        }
        if max(part.x, max(part.y, part.z)) < INSIDE_LEAST {
            break;
        }
    }
    return part;
}
