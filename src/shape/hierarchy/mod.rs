//! A bounding-volume hierarchy of a mesh's triangles, for the first intersection of a ray with the mesh.
//!
//! Built here since both renderers read one flat layout with one bound on the depth: of the crates, `bvh` is written for
//! nalgebra, and `obvhs` needs a later glam and has no such bound.
//!
//! Twin of [`nearest`](Hierarchy::nearest): `assets/shaders/hierarchy.wgsl`, which reads the same
//! [rows](Hierarchy::rows).
//!
//! # Layout
//! Rows of four words of 32 bits; f are floats by their bits. Numbers of rows count from the first row of the
//! hierarchy, so that hierarchies can follow each other in one buffer.
//!
//! | rows | words |
//! |---|---|
//! | 0 | the rows in which nodes, triangles, corners and normals begin |
//! | 1 | the numbers of nodes, of triangles and of vertices; 0 |
//! | nodes, 7 each | f least x of the four children; least y; least z; greatest x; greatest y; greatest z; the children |
//! | triangles, 3 each | f x of the three corners and of the polygon's normal; the same for y; for z |
//! | corners, 1 per triangle | the three vertices, the polygon |
//! | normals, 1 per vertex | f x, y and z of the vertex's normal; 0 |
//!
//! A child is [`NO_CHILD`]; or the number of a node; or, with the bit [`LEAF`], triangles one after the other: their number
//! less 1 in three bits from [`COUNT_SHIFT`] on, and that of the first below. Node 0 is the root. No way down leads through
//! more than [`LEVELS`] nodes.

use glam::{Vec3, Vec4};

mod build;
mod traverse;

use super::PolygonMesh;
pub use traverse::{Hit, Ray, Sides};

/// Four words of 32 bits.
pub type Row = [u32; 4];

/// The child that does not exist.
pub const NO_CHILD: u32 = u32::MAX;
/// The bit of children that are triangles.
pub const LEAF: u32 = 1 << 31;
/// The first bit of the number of triangles of a leaf.
pub const COUNT_SHIFT: u32 = 28;
/// Maximum number of nodes from the root to a triangle.
pub const LEVELS: usize = 12;
/// Maximum number of children that wait while a ray is followed: three per level, and the one that is next.
pub const STACK: usize = 3 * LEVELS + 1;

const NODE_ROWS: usize = 7;
const TRIANGLE_ROWS: usize = 3;
/// The row of the children in a node.
const CHILDREN: usize = 6;

/// The hierarchy of the triangles of a mesh, in the mesh's own units.
///
/// Triangles of which two corners are in one place are left out: no ray meets them, and their neighbours share all
/// of their edges.
#[derive(Clone, Debug, PartialEq)]
pub struct Hierarchy {
    rows: Vec<Row>,
    /// First rows of triangles, corners and normals; nodes begin in row 2.
    triangles: usize,
    corners: usize,
    normals: usize,
}

/// The first row of the nodes.
const NODES: usize = 2;

/// The numbers in a row.
#[inline]
fn floats(row: Row) -> Vec4 {
    Vec4::from_array(row.map(f32::from_bits))
}

fn bits(v: Vec3, last: f32) -> Row {
    [v.x, v.y, v.z, last].map(f32::to_bits)
}

impl Hierarchy {
    /// The hierarchy of a mesh.
    #[must_use]
    pub fn new(mesh: &PolygonMesh) -> Self {
        let (nodes, order) = build::build(mesh);
        let (polygon_normals, vertex_normals) = (mesh.polygon_normals(), mesh.vertex_normals());
        let triangles = NODES + NODE_ROWS * nodes.len();
        let corners = triangles + TRIANGLE_ROWS * order.len();
        let normals = corners + order.len();
        let counts = [nodes.len(), order.len(), vertex_normals.len(), 0];
        let mut rows = Vec::with_capacity(normals + vertex_normals.len());
        rows.extend([[NODES, triangles, corners, normals], counts].map(|row| row.map(|n| n as u32)));
        rows.extend(nodes.into_iter().flatten());
        for (polygon, corners) in &order {
            let [a, b, c] = corners.map(|i| mesh.positions[i as usize]);
            let n = polygon_normals[*polygon as usize];
            rows.extend([0, 1, 2].map(|axis| bits(Vec3::new(a[axis], b[axis], c[axis]), n[axis])));
        }
        rows.extend(order.iter().map(|(polygon, [a, b, c])| [*a, *b, *c, *polygon]));
        rows.extend(vertex_normals.into_iter().map(|n| bits(n, 0.0)));
        Self { rows, triangles, corners, normals }
    }

    /// The hierarchy as shaders read it; see the [layout](self#layout).
    #[must_use]
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Number of triangles.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.normals - self.corners
    }

    /// The rows of a triangle: x, y and z of its corners and of its polygon's normal.
    #[inline]
    fn triangle(&self, triangle: u32) -> &[Row; TRIANGLE_ROWS] {
        let first = self.triangles + TRIANGLE_ROWS * triangle as usize;
        // One check instead of three, and no copy.
        self.rows[first..].first_chunk().unwrap_or(&[[0; 4]; TRIANGLE_ROWS])
    }

    /// One of the four columns of a triangle.
    fn column(&self, triangle: u32, column: usize) -> Vec3 {
        Vec3::from_array(self.triangle(triangle).map(|row| f32::from_bits(row[column])))
    }

    /// The corners of a triangle, counter-clockwise seen from outside.
    #[must_use]
    pub fn places(&self, triangle: u32) -> [Vec3; 3] {
        [0, 1, 2].map(|corner| self.column(triangle, corner))
    }

    /// The point of a triangle with these weights of its corners.
    #[must_use]
    pub fn point(&self, triangle: u32, weights: Vec3) -> Vec3 {
        let [a, b, c] = self.places(triangle);
        weights.x * a + weights.y * b + weights.z * c
    }

    /// The vertices of a triangle.
    #[must_use]
    pub fn vertices(&self, triangle: u32) -> [u32; 3] {
        let [a, b, c, _] = self.rows[self.corners + triangle as usize];
        [a, b, c]
    }

    /// The polygon of a triangle.
    #[must_use]
    pub fn polygon(&self, triangle: u32) -> u32 {
        self.rows[self.corners + triangle as usize][3]
    }

    /// The unit normal of a triangle itself; that of its polygon if the triangle has no area.
    #[must_use]
    pub fn triangle_normal(&self, triangle: u32) -> Vec3 {
        let [a, b, c] = self.places(triangle);
        let (ab, ac) = (b - a, c - a);
        // Small triangles would lose digits in squares of squares.
        let long = ab.abs().max(ac.abs()).max_element().max(f32::MIN_POSITIVE);
        (ab / long).cross(ac / long).normalize_or(self.polygon_normal(triangle))
    }

    /// The unit normal of a triangle's polygon (CA DD8).
    #[must_use]
    pub fn polygon_normal(&self, triangle: u32) -> Vec3 {
        self.column(triangle, 3)
    }

    /// The mean of the normals of a triangle's vertices (CA DD9) with these weights, normalised. Zero where they
    /// cancel.
    #[must_use]
    pub fn vertex_normal(&self, triangle: u32, weights: Vec3) -> Vec3 {
        let [a, b, c] = self
            .vertices(triangle)
            .map(|vertex| floats(self.rows[self.normals + vertex as usize]).truncate());
        (weights.x * a + weights.y * b + weights.z * c).normalize_or_zero()
    }
}

#[cfg(test)]
mod tests;
