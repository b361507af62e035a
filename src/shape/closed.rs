//! Solids: meshes that part inside from outside, which light can pass through.
//!
//! Vertices in one place count as one, and triangles that lose their area by that are left out, so poles and the
//! repeated vertices of files do no harm. A solid's edges each lie between as many triangles that run along them one
//! way as the other: two, or more where parts of the surface touch. Along every line the way goes out as often as in,
//! and never in twice: parts face outwards, lie beside each other, or bound a cavity within another part. This is
//! tested only along some lines, one of them through each of the first parts: a surface that passes through itself is
//! found unless it does so in less than about a hundredth of the picture, or less deep than a thousandth of the size.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use super::{
    Hierarchy, PolygonMesh,
    hierarchy::{Ray, Sides},
};
use crate::{
    optics::{Frame, sampling},
    text::plural,
};

/// Number of lines through the whole mesh.
const LINES: usize = 256;
/// Maximum number of parts with a line each.
const AIMED: usize = 256;
/// Maximum number of crossings on a line.
const CROSSINGS: usize = 4096;
/// Length within which a line may be inside twice, or outside twice: rounding, where parts touch.
const SHALLOW: f32 = 1e-3;
/// Largest volume of a part, relative to the power of its area, that is mere rounding.
const FLAT: f64 = 1e-7;
/// Distance of the second line that must agree before an error is reported.
const BESIDE: f32 = 1e-4;

/// A closed mesh that faces outwards.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solid {
    /// Number of connected surfaces, cavities included.
    pub parts: usize,
    /// Number of surfaces that face inwards: the walls of cavities.
    pub cavities: usize,
    /// Number of handles, as of a cup or a ring, of all parts: L. Euler's vertices − edges + faces is twice the parts less
    /// twice the handles.
    pub handles: usize,
    /// The enclosed volume, in the units of the mesh.
    pub volume: f64,
}

/// The rim of a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rim {
    /// Number of edges.
    pub edges: usize,
    /// The mean of their middles, in the units of the mesh.
    pub centre: Vec3,
}

/// The reason why a mesh is not a solid; all numbers count edges, except where parts are named.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NotSolid {
    /// Without triangles.
    #[error("it has no triangle with an area")]
    Empty,
    /// Edges of one triangle, by the rims that they form, the longest first.
    #[error("{}", open(.0))]
    Open(Vec<Rim>),
    /// Edges along which two triangles run in one direction.
    #[error(
        "the triangles on both sides of {} face opposite ways; make all faces point outwards", plural(*.0, "edge")
    )]
    Turned(usize),
    /// Edges of three triangles or more that do not pair up.
    #[error(
        "three triangles or more meet at {}; remove walls inside, and faces that lie on each other", plural(*.0, "edge")
    )]
    Branched(usize),
    /// Parts that enclose a negative volume, of all parts.
    #[error("{}", inside_out(*.0, *.1))]
    InsideOut(usize, usize),
    /// Parts that enclose nothing.
    #[error("it has {} without volume; remove such parts, or give them a thickness", plural(*.0, "part"))]
    Flat(usize),
    /// A surface within a surface that faces the same way.
    #[error(
        "its surface passes through itself near ({:.3}, {:.3}, {:.3}), or a part lies within another; unite the parts, or \
         turn inner ones inside out to make them cavities", .0.x, .0.y, .0.z
    )]
    Overlapping(Vec3),
}

fn open(rims: &[Rim]) -> String {
    let edges = rims.iter().map(|rim| rim.edges).sum();
    let at = rims.first().map_or(Vec3::ZERO, |rim| rim.centre);
    let largest = if rims.len() > 1 { ", the longest" } else { "" };
    format!(
        "it is open: {} with a triangle on one side only, in {}{largest} around ({:.3}, {:.3}, {:.3}); close the holes, or \
         merge vertices that nearly meet",
        plural(edges, "edge"),
        plural(rims.len(), "rim"),
        at.x,
        at.y,
        at.z
    )
}

fn inside_out(parts: usize, all: usize) -> String {
    let which = if parts == all { String::new() } else { format!(", {parts} of its {all} parts") };
    format!("it is inside out{which}; reverse the order of the corners, so that faces point outwards")
}

/// Checks that a mesh is a solid, as [above](self); the hierarchy is that of the mesh.
///
/// # Errors
/// Returns the first problem.
pub fn check(mesh: &PolygonMesh, hierarchy: &Hierarchy) -> Result<Solid, NotSolid> {
    let triangles = welded(mesh);
    if triangles.is_empty() {
        return Err(NotSolid::Empty);
    }
    let edges = edges(&triangles);
    paired(mesh, &edges)?;
    let parts = parts(mesh, &triangles, &edges);
    outward(&parts)?;
    alternating(mesh, hierarchy, &parts)?;
    Ok(Solid {
        parts: parts.len(),
        cavities: parts.iter().filter(|part| part.volume < 0.0).count(),
        handles: parts.iter().map(Part::handles).sum(),
        volume: parts.iter().map(|part| part.volume).sum(),
    })
}

/// The triangles between different places; the vertices of a place all have the number of the first.
fn welded(mesh: &PolygonMesh) -> Vec<[u32; 3]> {
    let mut first: HashMap<[u32; 3], u32> = HashMap::with_capacity(mesh.positions.len());
    let number = |(i, p): (usize, &Vec3)| {
        // −0 becomes 0.
        let place = (*p + Vec3::ZERO).to_array().map(f32::to_bits);
        *first.entry(place).or_insert(i as u32)
    };
    let number: Vec<u32> = mesh.positions.iter().enumerate().map(number).collect();
    let triangles = mesh.triangles().map(|(_, corners)| corners.map(|i| number[i as usize]));
    triangles.filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

/// An edge: the smaller vertex, the larger one, and the numbers of triangles that run along it upwards and downwards.
struct Edge {
    ends: [u32; 2],
    up: usize,
    down: usize,
}

fn edges(triangles: &[[u32; 3]]) -> Vec<Edge> {
    let mut all: Vec<[u32; 3]> = Vec::with_capacity(3 * triangles.len());
    for [a, b, c] in triangles {
        for (from, to) in [(*a, *b), (*b, *c), (*c, *a)] {
            all.push([from.min(to), from.max(to), u32::from(from > to)]);
        }
    }
    all.sort_unstable();
    let same = all.chunk_by(|a, b| a[..2] == b[..2]);
    same.map(|runs| {
        let down = runs.iter().filter(|run| run[2] == 1).count();
        Edge { ends: [runs[0][0], runs[0][1]], up: runs.len() - down, down }
    })
    .collect()
}

/// Checks that as many triangles run along each edge upwards as downwards.
fn paired(mesh: &PolygonMesh, edges: &[Edge]) -> Result<(), NotSolid> {
    let wrong = || edges.iter().filter(|edge| edge.up != edge.down);
    let open: Vec<_> = wrong().filter(|edge| edge.up + edge.down == 1).collect();
    if !open.is_empty() {
        return Err(NotSolid::Open(rims(mesh, &open)));
    }
    let turned = wrong().filter(|edge| edge.up + edge.down == 2).count();
    if turned > 0 {
        return Err(NotSolid::Turned(turned));
    }
    match wrong().count() {
        0 => Ok(()),
        branched => Err(NotSolid::Branched(branched)),
    }
}

/// Sets of vertices that are joined one by one.
struct Joined(Vec<u32>);

impl Joined {
    fn new(vertices: usize) -> Self {
        Self((0..vertices as u32).collect())
    }

    /// The vertex that stands for a set.
    fn of(&mut self, mut vertex: u32) -> u32 {
        while self.0[vertex as usize] != vertex {
            let above = self.0[self.0[vertex as usize] as usize];
            self.0[vertex as usize] = above;
            vertex = above;
        }
        vertex
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.of(a), self.of(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

/// The rims that open edges form, the longest first.
fn rims(mesh: &PolygonMesh, open: &[&Edge]) -> Vec<Rim> {
    let mut joined = Joined::new(mesh.positions.len());
    open.iter().for_each(|edge| joined.join(edge.ends[0], edge.ends[1]));
    let mut rims: HashMap<u32, Rim> = HashMap::new();
    for edge in open {
        let [a, b] = edge.ends.map(|i| mesh.positions[i as usize]);
        let rim = rims.entry(joined.of(edge.ends[0])).or_insert(Rim { edges: 0, centre: Vec3::ZERO });
        rim.edges += 1;
        rim.centre += (a.midpoint(b) - rim.centre) / rim.edges as f32;
    }
    let mut rims: Vec<_> = rims.into_values().collect();
    let order = |rim: &Rim| (std::cmp::Reverse(rim.edges), rim.centre.to_array().map(f32::to_bits));
    rims.sort_unstable_by_key(order);
    rims
}

/// A connected surface.
struct Part {
    vertices: usize,
    edges: usize,
    triangles: usize,
    volume: f64,
    area: f64,
    /// A point of its largest triangle, and twice the area of that.
    inner: Vec3,
    largest: f32,
}

impl Part {
    const NONE: Self = Self {
        vertices: 0,
        edges: 0,
        triangles: 0,
        volume: 0.0,
        area: 0.0,
        inner: Vec3::ZERO,
        largest: -1.0,
    };

    fn is_flat(&self) -> bool {
        self.volume.abs() <= FLAT * self.area.powf(1.5)
    }

    /// The number of handles by Euler's formula; 0 for parts that touch themselves so often that it would be negative.
    fn handles(&self) -> usize {
        (2 + self.edges).saturating_sub(self.vertices + self.triangles) / 2
    }
}

/// The connected surfaces.
fn parts(mesh: &PolygonMesh, triangles: &[[u32; 3]], edges: &[Edge]) -> Vec<Part> {
    let mut joined = Joined::new(mesh.positions.len());
    edges.iter().for_each(|edge| joined.join(edge.ends[0], edge.ends[1]));
    let mut numbers: HashMap<u32, usize> = HashMap::new();
    let mut parts: Vec<Part> = Vec::new();
    let mut known = vec![false; mesh.positions.len()];
    for corners in triangles {
        let number = *numbers.entry(joined.of(corners[0])).or_insert_with(|| {
            parts.push(Part::NONE);
            parts.len() - 1
        });
        let part = &mut parts[number];
        part.triangles += 1;
        for &corner in corners {
            part.vertices += usize::from(!std::mem::replace(&mut known[corner as usize], true));
        }
        let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
        part.volume += a.as_dvec3().dot(b.as_dvec3().cross(c.as_dvec3())) / 6.0;
        let doubled = (b - a).cross(c - a).length();
        part.area += f64::from(doubled) / 2.0;
        if doubled > part.largest {
            // Not the centre, as lines through it may pass through edges of a symmetrical mesh.
            (part.largest, part.inner) = (doubled, 0.31 * a + 0.36 * b + 0.33 * c);
        }
    }
    for edge in edges {
        let number = numbers[&joined.of(edge.ends[0])];
        parts[number].edges += edge.up;
    }
    parts
}

/// Checks that each part encloses a volume, and that not all face inwards.
fn outward(parts: &[Part]) -> Result<(), NotSolid> {
    let flat = parts.iter().filter(|part| part.is_flat()).count();
    if flat > 0 {
        return Err(NotSolid::Flat(flat));
    }
    let turned = parts.iter().filter(|part| part.volume < 0.0).count();
    // Cavities lie within other parts.
    if turned == parts.len() { Err(NotSolid::InsideOut(turned, turned)) } else { Ok(()) }
}

/// Checks that the way along lines goes in and out by turns.
fn alternating(mesh: &PolygonMesh, hierarchy: &Hierarchy, parts: &[Part]) -> Result<(), NotSolid> {
    let radius = mesh.positions.iter().map(|p| p.length()).fold(0.0, f32::max);
    // Without a pattern that a mesh may have, too: by the golden ratio and its relatives in higher dimensions.
    let steps = |i: usize, steps: [f64; 2]| {
        Vec2::from(steps.map(|step| (0.5 + step * (i + 1) as f64).fract() as f32))
    };
    let direction = |i| sampling::sphere(steps(i, [0.754_877_666, 0.569_840_291]));
    let through = |i: usize| {
        let (d, u) = (direction(i), sampling::disc(steps(i, [0.819_172_513, 0.671_043_606])));
        let frame = Frame::from_normal(d);
        (radius * (u.x * frame.t + u.y * frame.b), d)
    };
    let at_parts = parts.iter().take(AIMED).enumerate().map(|(i, part)| (part.inner, direction(LINES + i)));
    for (point, direction) in (0..LINES).map(through).chain(at_parts) {
        let aside = BESIDE * radius * Frame::from_normal(direction).t;
        let found = |point| along(hierarchy, point, direction, radius);
        if let (Some((_, below)), Some((at, _))) = (found(point), found(point + aside)) {
            let turned = parts.iter().filter(|part| part.volume < 0.0).count();
            let inside_out = below && turned > 0;
            return Err(if inside_out {
                NotSolid::InsideOut(turned, parts.len())
            } else {
                NotSolid::Overlapping(at)
            });
        }
    }
    Ok(())
}

/// The first place along a line through a point where the way goes in twice, or out twice (true).
fn along(hierarchy: &Hierarchy, through: Vec3, direction: Vec3, radius: f32) -> Option<(Vec3, bool)> {
    let ray = Ray { origin: through - 3.0 * radius * direction, direction };
    let mut depth = 0;
    let mut from = f32::NEG_INFINITY;
    let mut after = 0.0;
    for _ in 0..CROSSINGS {
        let hit = hierarchy.nearest(&ray, after..7.0 * radius, Sides::Both);
        let distance = hit.map_or(7.0 * radius, |hit| hit.distance);
        if !(0..=1).contains(&depth) && distance - from > SHALLOW * radius {
            return Some((ray.at(from), depth < 0));
        }
        let step = if hit?.leaves { -1 } else { 1 };
        depth += step;
        (from, after) = (distance, distance.next_up());
    }
    None
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::{
        parameter::{Shipped, Table},
        registry::Registry,
        shape::{
            Cube, MeshFile, ObjectType as _, Sphere, Superellipsoid, Teapot, Torus, mesh::Polygon, mesh_file,
        },
        testing::meshes,
    };

    fn of(mesh: &PolygonMesh) -> Result<Solid, NotSolid> {
        check(mesh, &Hierarchy::new(mesh))
    }

    /// The result of checking a mesh, as text.
    fn said(mesh: &PolygonMesh) -> String {
        of(mesh).map_or_else(|problem| problem.to_string(), |solid| format!("{solid:?}"))
    }

    /// Both meshes in one, the second scaled and moved.
    fn both(a: &PolygonMesh, b: &PolygonMesh, size: f32, position: Vec3) -> PolygonMesh {
        let first = a.positions.len() as u32;
        let mut mesh = a.clone();
        mesh.positions.extend(b.positions.iter().map(|p| size * *p + position));
        mesh.polygons.extend(b.polygons.iter().map(|polygon| match *polygon.corners() {
            [a, b, c, d] => Polygon::quad(first + a, first + b, first + c, first + d),
            [a, b, c] => Polygon::triangle(first + a, first + b, first + c),
            _ => unreachable!("polygons have three or four corners"),
        }));
        mesh
    }

    fn turned(mesh: &PolygonMesh) -> PolygonMesh {
        let mut mesh = mesh.clone();
        for polygon in &mut mesh.polygons {
            *polygon = match *polygon.corners() {
                [a, b, c, d] => Polygon::quad(d, c, b, a),
                [a, b, c] => Polygon::triangle(c, b, a),
                _ => unreachable!("polygons have three or four corners"),
            };
        }
        mesh
    }

    /// The mesh of an OBJ file.
    fn obj(text: &str) -> PolygonMesh {
        let numbers = (mesh_file::FORMAT.read)(text.as_bytes()).expect("an OBJ file");
        MeshFile { path: Table { file: None, numbers: Arc::from(numbers) }, normals: 0 }.mesh(1)
    }

    #[test]
    fn every_built_in_shape_but_the_teapot_is_a_solid() {
        for shape in Registry::builtin().shapes().iter().filter(|shape| shape.declaration.id != "teapot") {
            let id = shape.declaration.id;
            for case in meshes::cases(shape).filter(|case| case.mesh.polygons.len() < 5000) {
                let solid = of(&case.mesh);
                let handles = usize::from(["torus", "mesh"].contains(&id));
                let expected =
                    |solid: &Solid| (solid.parts, solid.cavities, solid.handles) == (1, 0, handles);
                assert!(
                    solid.as_ref().is_ok_and(expected),
                    "{id} {} {:?}: {solid:?}",
                    case.tessellation,
                    case.values
                );
            }
        }
    }

    #[test]
    fn superellipsoids_are_solids_whatever_their_exponents() {
        let exponents = [0.1, 0.2, 0.5, 1.0, 2.0, 3.0];
        for vertical_exponent in exponents {
            for horizontal_exponent in exponents {
                for n in [2, 5, 16] {
                    let shape = Superellipsoid { vertical_exponent, horizontal_exponent };
                    let solid = of(&shape.mesh(n));
                    assert!(solid.as_ref().is_ok_and(|s| s.handles == 0), "{shape:?} {n}: {solid:?}");
                }
            }
        }
    }

    #[test]
    fn volumes_are_those_of_the_shapes() {
        let volume = |mesh: &PolygonMesh| of(mesh).expect("a solid").volume;
        assert!((volume(&Cube {}.mesh(3)) - 1.0).abs() < 1e-6);
        assert!((volume(&Sphere {}.mesh(64)) - std::f64::consts::PI / 6.0).abs() < 2e-3);
        let torus = 2.0 * std::f64::consts::PI.powi(2) * 0.35 * 0.15 * 0.15;
        assert!((volume(&Torus::default().mesh(64)) - torus).abs() < 1e-3);
    }

    #[test]
    fn the_teapot_is_open_at_its_lid_its_rim_and_both_ends_of_handle_and_spout() {
        let n = 10;
        let Err(NotSolid::Open(rims)) = of(&Teapot {}.mesh(n)) else { panic!("it is open") };
        let edges: Vec<_> = rims.iter().map(|rim| rim.edges as u32).collect();
        assert_eq!(edges, [4 * n, 4 * n, 2 * n, 2 * n, 2 * n, 2 * n]);
        // Lid and rim of the body around the axis of the pot, which is not that of the bounding box; then the handle's ends on
        // one side of it, the spout's on the other.
        let axis = rims[0].centre.x;
        assert!((rims[1].centre.x - axis).abs() < 1e-3, "{rims:?}");
        let sides: Vec<_> = rims[2..].iter().map(|rim| rim.centre.x > axis).collect();
        assert_eq!(sides.iter().filter(|right| **right).count(), 2, "{rims:?}");
        let message = NotSolid::Open(rims).to_string();
        assert!(
            message.starts_with("it is open: 160 edges with a triangle on one side only, in 6 rims"),
            "{message}"
        );
    }

    #[test]
    fn files_are_solids_if_they_are_closed() {
        let roof = "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 1 0\nv 1 1 0\nf 4 3 6 5\nf 2 1 5 6\nf 1 4 5\nf 3 2 6\n";
        let closed = of(&obj(&format!("{roof}f 1 2 3 4\n"))).expect("closed");
        assert_eq!((closed.parts, closed.handles), (1, 0));
        assert!((closed.volume - 0.25).abs() < 1e-6, "{closed:?}");
        assert_eq!(
            said(&obj(roof)),
            "it is open: 4 edges with a triangle on one side only, in 1 rim around (0.000, -0.250, 0.000); close the holes, \
             or merge vertices that nearly meet"
        );
        assert_eq!(
            said(&obj(&format!("{roof}f 4 3 2 1\n"))),
            "the triangles on both sides of 4 edges face opposite ways; make all faces point outwards"
        );
    }

    #[test]
    fn the_shipped_models_are_solids_of_the_sizes_of_their_formulas() {
        for (name, handles, volume) in [
            ("gem.obj", 0, 1.589_54 / 8.0),
            ("steps.obj", 0, 1.35 / 15.625),
            ("lampshade.obj", 1, 0.067_750_6 / 9.025_5),
            ("slab.obj", 0, 4.32 / 27.0),
        ] {
            let shipped = mesh_file::FORMAT.shipped.iter().find(|(known, _)| *known == name);
            let Some((_, Shipped::Bytes(bytes))) = shipped else { panic!("{name}") };
            for normals in [0, 1] {
                let numbers = Arc::from((mesh_file::FORMAT.read)(bytes).expect("an OBJ file"));
                let mesh = MeshFile { path: Table { file: None, numbers }, normals }.mesh(1);
                let solid = of(&mesh).expect(name);
                assert_eq!((solid.parts, solid.cavities, solid.handles), (1, 0, handles), "{name}");
                assert!((solid.volume / volume - 1.0).abs() < 1e-3, "{name}: {}", solid.volume);
            }
        }
    }

    #[test]
    fn each_mistake_is_named_with_what_would_be_right() {
        let (cube, sphere) = (Cube {}.mesh(2), Sphere {}.mesh(12));
        assert_eq!(said(&PolygonMesh::default()), "it has no triangle with an area");
        let reverse = "reverse the order of the corners, so that faces point outwards";
        assert_eq!(said(&turned(&cube)), format!("it is inside out; {reverse}"));
        let beside = both(&cube, &turned(&sphere), 0.5, 2.0 * Vec3::X);
        assert_eq!(said(&beside), format!("it is inside out, 1 of its 2 parts; {reverse}"));
        // A wall within, joined to the outer ones.
        let mut walled =
            obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1 1 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
        assert!(of(&walled).is_ok());
        walled.polygons.push(walled.polygons[0]);
        assert!(said(&walled).starts_with("three triangles or more meet at 3 edges; "), "{}", said(&walled));
        let flat = both(&cube, &obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\nf 1 2 3\n"), 1.0, 3.0 * Vec3::Y);
        assert!(said(&flat).starts_with("it has 1 part without volume; "), "{}", said(&flat));
    }

    #[test]
    fn a_surface_within_another_is_a_cavity_only_if_it_faces_inwards() {
        let (cube, sphere) = (Cube {}.mesh(2), Sphere {}.mesh(12));
        let hollow = of(&both(&cube, &turned(&sphere), 0.8, Vec3::ZERO)).expect("a cavity");
        assert_eq!((hollow.parts, hollow.cavities, hollow.handles), (2, 1, 0));
        let beside = of(&both(&cube, &sphere, 0.8, 1.1 * Vec3::X)).expect("two parts");
        assert_eq!((beside.parts, beside.cavities), (2, 0));
        for (size, position) in [(0.8, Vec3::ZERO), (0.8, 0.5 * Vec3::X), (0.2, 0.5 * Vec3::Y)] {
            let within = of(&both(&cube, &sphere, size, position));
            assert!(matches!(within, Err(NotSolid::Overlapping(_))), "{size} {position}: {within:?}");
        }
        // A cavity that breaks through the wall is the outside of nothing.
        let broken = of(&both(&cube, &turned(&sphere), 0.8, 0.5 * Vec3::X));
        assert!(broken.is_err(), "{broken:?}");
    }

    #[test]
    fn parts_may_touch() {
        let cube = Cube {}.mesh(1);
        // Along an edge, and at a corner; the ends of the edge are one vertex each.
        for (position, parts) in
            [(Vec3::new(1.0, 1.0, 0.0), 1), (Vec3::ONE, 1), (Vec3::new(1.5, 0.0, 0.0), 2)]
        {
            let solid = of(&both(&cube, &cube, 1.0, position)).expect("closed");
            assert!(solid.parts == parts && (solid.volume - 2.0).abs() < 1e-5, "{position}: {solid:?}");
        }
        // Repeated vertices are one.
        let mut mesh = Sphere {}.mesh(8);
        for (i, polygon) in mesh.polygons.clone().into_iter().enumerate() {
            let again = mesh.positions.len() as u32;
            mesh.positions
                .extend(polygon.corners().iter().map(|c| mesh.positions[*c as usize]).collect::<Vec<_>>());
            mesh.polygons[i] = match polygon.corners().len() {
                4 => Polygon::quad(again, again + 1, again + 2, again + 3),
                _ => Polygon::triangle(again, again + 1, again + 2),
            };
        }
        assert_eq!(of(&mesh).expect("closed").parts, 1);
    }
}
