use std::ops::Range;

use glam::Vec3;

use super::*;
use crate::{
    registry::Registry,
    shape::{Cube, ObjectType as _, Sphere, Superellipsoid, Torus, mesh::Polygon},
    testing::{direction, meshes, random},
};

/// Any direction.
fn around(seed: &mut u64) -> Vec3 {
    let d = direction(seed);
    if random(seed) < 0.5 { d } else { -d }
}

/// A point of the cube of edge 2.
fn place(seed: &mut u64) -> Vec3 {
    Vec3::from([(); 3].map(|()| 2.0 * random(seed) - 1.0))
}

/// The nearest hit by all triangles, after T. Möller, B. Trumbore (1997), in 64 bits.
fn by_all(mesh: &PolygonMesh, ray: &Ray, range: Range<f32>, sides: Sides) -> Option<f64> {
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let distance = |corners: [u32; 3]| {
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize].as_dvec3());
        let (ab, ac, from) = (b - a, c - a, origin - a);
        let across = direction.cross(ac);
        let determinant = ab.dot(across);
        let (u, other) = (from.dot(across) / determinant, from.cross(ab));
        let v = direction.dot(other) / determinant;
        // From inside, the corners run clockwise.
        let seen = sides == Sides::Both || determinant < 0.0;
        (seen && u >= 0.0 && v >= 0.0 && u + v <= 1.0).then(|| ac.dot(other) / determinant)
    };
    let within = |t: &f64| (f64::from(range.start)..f64::from(range.end)).contains(t);
    mesh.triangles().filter_map(|(_, corners)| distance(corners)).filter(within).min_by(f64::total_cmp)
}

/// The number of levels, after checking that each triangle is in one leaf, and in all boxes above it.
fn levels(tree: &Hierarchy) -> usize {
    let mut seen = vec![false; tree.triangle_count()];
    let mut todo = vec![(0, vec![])];
    let mut most = 0;
    while let Some((node, above)) = todo.pop() {
        most = most.max(above.len() / 2 + 1);
        let rows: &[Row; NODE_ROWS] = tree.rows[NODES + NODE_ROWS * node..].first_chunk().expect("a node");
        for (i, &child) in rows[CHILDREN].iter().enumerate().filter(|(_, child)| **child != NO_CHILD) {
            let corner = |row: usize| Vec3::from([0, 1, 2].map(|axis| f32::from_bits(rows[row + axis][i])));
            let mut boxes: Vec<Vec3> = above.clone();
            boxes.extend([corner(0), corner(3)]);
            if child & LEAF == 0 {
                todo.push((child as usize, boxes));
                continue;
            }
            let first = child & ((1 << COUNT_SHIFT) - 1);
            for triangle in first..=first + (child >> COUNT_SHIFT & 7) {
                assert!(!seen[triangle as usize]);
                seen[triangle as usize] = true;
                for (p, sides) in tree.places(triangle).into_iter().zip(boxes.chunks_exact(2).cycle()) {
                    assert!(p.cmpge(sides[0]).all() && p.cmple(sides[1]).all(), "{p} {sides:?}");
                }
            }
        }
    }
    assert!(seen.into_iter().all(|seen| seen));
    most
}

/// Quadrilaterals that become smaller and smaller, and lie ever closer to each other.
fn shrinking(count: u32) -> PolygonMesh {
    let mut mesh = PolygonMesh::default();
    for i in 0..count {
        let at = 0.5f32.powi(i as i32 / 8) * (1.0 + (i % 8) as f32 / 16.0);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend([Vec3::new(at, at, 0.0), Vec3::new(at, -at, 0.0), Vec3::new(at, 0.0, at)]);
        mesh.polygons.push(Polygon::triangle(first, first + 1, first + 2));
    }
    mesh
}

#[test]
fn the_nearest_hit_is_that_of_all_triangles() {
    let mut seed = 5;
    let shapes = Registry::builtin();
    let mut met = [0; 2];
    for shape in shapes.shapes() {
        for case in meshes::cases(shape).filter(|case| case.mesh.polygons.len() < 2500) {
            let tree = Hierarchy::new(&case.mesh);
            for _ in 0..40 {
                let origin = place(&mut seed);
                // Past the middle, where there may be a hole.
                let direction = (0.4 * place(&mut seed) - origin).normalize();
                let ray = Ray { origin, direction };
                for sides in [Sides::Both, Sides::Inside] {
                    let range = 0.0..if random(&mut seed) < 0.5 { 0.7 } else { 10.0 };
                    let hit = tree.nearest(&ray, range.clone(), sides);
                    let all = by_all(&case.mesh, &ray, range, sides);
                    met[usize::from(all.is_some())] += 1;
                    let Some((hit, all)) = hit.zip(all) else {
                        assert_eq!(hit.map(|hit| hit.distance), None, "{all:?} {ray:?}");
                        assert_eq!(all, None, "{ray:?}");
                        continue;
                    };
                    assert!((f64::from(hit.distance) - all).abs() < 1e-5, "{hit:?} {all}");
                    let point = tree.point(hit.triangle, hit.weights);
                    assert!(point.distance(ray.at(hit.distance)) < 1e-5, "{hit:?} {point}");
                    let leaves = tree.triangle_normal(hit.triangle).dot(ray.direction) > 0.0;
                    assert_eq!(hit.leaves, leaves, "{hit:?}");
                }
            }
        }
    }
    assert!(met[0] > 1000 && met[1] > 1000, "{met:?}");
}

#[test]
fn no_ray_from_inside_passes_between_triangles() {
    let cubes = [1, 3].map(|n| Cube {}.mesh(n));
    let spheres = [2, 3, 16].map(|n| Sphere {}.mesh(n));
    let thin = Superellipsoid { vertical_exponent: 3.0, horizontal_exponent: 0.1 }.mesh(12);
    for mesh in cubes.into_iter().chain(spheres).chain([thin]) {
        let tree = Hierarchy::new(&mesh);
        let mut seed = 9;
        let inside = |origin: Vec3, towards: Vec3| {
            let ray = Ray { origin, direction: towards - origin };
            let hit = tree.nearest(&ray, 0.0..2.0, Sides::Inside);
            let hit = hit.unwrap_or_else(|| panic!("from {origin} to {towards} there is nothing"));
            assert!((hit.distance - 1.0).abs() < 1e-4, "{hit:?} {origin} {towards}");
        };
        for origin in [Vec3::ZERO, 0.01 * around(&mut seed), 0.05 * around(&mut seed)] {
            for polygon in &mesh.polygons {
                let (corners, n) = mesh.corner_positions(polygon);
                for i in 0..n {
                    let (a, b) = (corners[i], corners[(i + 1) % n]);
                    inside(origin, a);
                    inside(origin, a.midpoint(b));
                    inside(origin, a.lerp(b, random(&mut seed)));
                }
                if n == 4 {
                    inside(origin, corners[0].lerp(corners[2], random(&mut seed)));
                }
            }
        }
    }
}

#[test]
fn a_ray_that_begins_on_a_triangle_does_not_leave_by_it() {
    let tree = Hierarchy::new(&Torus::default().mesh(16));
    let mut seed = 1;
    for triangle in 0..tree.triangle_count() as u32 {
        let [a, b] = [random(&mut seed), random(&mut seed)];
        let weights = if a + b < 1.0 { Vec3::new(a, b, 1.0 - a - b) } else { Vec3::Y };
        let n = tree.triangle_normal(triangle);
        let direction = (around(&mut seed) - 1.5 * n).normalize();
        let ray = Ray { origin: tree.point(triangle, weights), direction };
        let hit = tree.nearest(&ray, -1e-5..9.0, Sides::Inside).expect("the torus is closed");
        assert!(hit.triangle != triangle && hit.leaves, "{hit:?}");
    }
}

#[test]
fn triangles_are_in_their_boxes_and_no_way_down_is_longer_than_promised() {
    let deepest = [12, 32].map(|n| levels(&Hierarchy::new(&Torus::default().mesh(n))));
    assert!(deepest.into_iter().all(|levels| levels <= LEVELS), "{deepest:?}");
    for count in [1, 2, 5, 9, 300, 1000] {
        assert!(levels(&Hierarchy::new(&shrinking(count))) <= LEVELS);
    }
    // By surface area alone it would be far deeper: all splits are used.
    assert_eq!(levels(&Hierarchy::new(&shrinking(1000))), LEVELS);
}

#[test]
fn triangles_in_one_place_are_divided_all_the_same() {
    let mut mesh = shrinking(1);
    mesh.polygons = vec![mesh.polygons[0]; 1000];
    let tree = Hierarchy::new(&mesh);
    assert!(levels(&tree) <= 5 && tree.triangle_count() == 1000);
    let ray = Ray { origin: Vec3::new(2.0, 0.0, 0.3), direction: Vec3::NEG_X };
    let hit = tree.nearest(&ray, 0.0..5.0, Sides::Both).expect("in the middle of it");
    assert!((hit.distance - 1.0).abs() < 1e-6, "{hit:?}");
}

#[test]
fn without_triangles_nothing_is_met() {
    let mut mesh = shrinking(3);
    // Three corners in one place, and two.
    mesh.polygons = vec![Polygon::triangle(4, 4, 4), Polygon::triangle(4, 4, 5)];
    for mesh in [PolygonMesh::default(), mesh] {
        let tree = Hierarchy::new(&mesh);
        assert_eq!(tree.triangle_count(), 0);
        let ray = Ray { origin: Vec3::ZERO, direction: Vec3::X };
        assert_eq!(tree.nearest(&ray, -9.0..9.0, Sides::Both), None);
    }
}

#[test]
fn a_triangle_knows_its_vertices_its_polygon_and_their_normals() {
    let mesh = Torus::default().mesh(8);
    let tree = Hierarchy::new(&mesh);
    let (polygons, vertices) = (mesh.polygon_normals(), mesh.vertex_normals());
    let mut seen = vec![0; mesh.polygons.len()];
    for triangle in 0..tree.triangle_count() as u32 {
        let (polygon, corners) = (tree.polygon(triangle) as usize, tree.vertices(triangle));
        seen[polygon] += 1;
        assert_eq!(tree.places(triangle), corners.map(|i| mesh.positions[i as usize]));
        assert_eq!(tree.polygon_normal(triangle), polygons[polygon]);
        assert!(tree.triangle_normal(triangle).dot(polygons[polygon]) > 0.9);
        assert!(corners.iter().all(|i| mesh.polygons[polygon].corners().contains(i)));
        for (i, corner) in corners.into_iter().enumerate() {
            let at = tree.vertex_normal(triangle, Vec3::AXES[i]);
            assert!((at - vertices[corner as usize]).length() < 1e-6);
        }
        let middle = tree.vertex_normal(triangle, Vec3::splat(1.0 / 3.0));
        let mean: Vec3 = corners.iter().map(|i| vertices[*i as usize]).sum();
        assert!((middle - mean.normalize()).length() < 1e-6);
    }
    assert_eq!(seen, vec![2; mesh.polygons.len()]);
}

#[test]
fn rays_along_the_axes_and_in_planes_of_boxes_are_met() {
    let tree = Hierarchy::new(&Cube {}.mesh(4));
    for axis in Vec3::AXES {
        for sign in [-1.0, 1.0] {
            for [u, v] in [[0.0, 0.0], [0.25, 0.1], [0.25, 0.25], [0.5, 0.0], [0.5, 0.5]] {
                let direction = sign * axis;
                let aside =
                    u * Vec3::from([axis.y, axis.z, axis.x]) + v * Vec3::from([axis.z, axis.x, axis.y]);
                let ray = Ray { origin: aside - direction, direction };
                let first = tree.nearest(&ray, 0.0..9.0, Sides::Both).expect("a face");
                let last = tree.nearest(&ray, 0.0..9.0, Sides::Inside).expect("a face");
                assert!((first.distance - 0.5).abs() < 1e-6 && !first.leaves, "{ray:?} {first:?}");
                assert!((last.distance - 1.5).abs() < 1e-6 && last.leaves, "{ray:?} {last:?}");
            }
        }
    }
}
