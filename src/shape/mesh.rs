//! Polygon meshes (AB10, AB11): a list of vertices and a set of polygons over them.

use glam::Vec3;

use crate::shading::normals::{polygon_centre, polygon_normal, vertex_normals};

/// Vertices and convex polygons of three or four corners, with the normals that the shading modes
/// need.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonMesh {
    /// The vertices; each place of a surface occurs once.
    pub positions: Vec<Vec3>,
    /// Corners of each polygon, counter-clockwise seen from outside.
    pub polygons: Vec<Polygon>,
}

/// A polygon of three or four corners.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Polygon {
    corners: [u32; 4],
    count: u8,
}

impl Polygon {
    /// A triangle.
    #[must_use]
    pub const fn triangle(a: u32, b: u32, c: u32) -> Self {
        Self { corners: [a, b, c, c], count: 3 }
    }

    /// A quadrilateral; where neighbouring corners are the same vertex (at a pole) a triangle.
    #[must_use]
    pub fn quad(a: u32, b: u32, c: u32, d: u32) -> Self {
        let mut corners = [0; 4];
        let mut count = 0;
        for (i, corner) in [a, b, c, d].into_iter().enumerate() {
            if (count == 0 || corners[count - 1] != corner) && !(i == 3 && corner == a) {
                corners[count] = corner;
                count += 1;
            }
        }
        if count == 3 {
            corners[3] = corners[2];
        }
        Self { corners, count: count as u8 }
    }

    /// The indices of the corners.
    #[must_use]
    pub fn corners(&self) -> &[u32] {
        &self.corners[..usize::from(self.count)]
    }

    /// The polygon cut into triangles, as positions within [`corners`](Self::corners).
    #[must_use]
    pub fn triangles(&self) -> &'static [[usize; 3]] {
        match self.count {
            4 => &[[0, 1, 2], [0, 2, 3]],
            3 => &[[0, 1, 2]],
            _ => &[],
        }
    }
}

impl PolygonMesh {
    /// The corners of a polygon in space.
    #[must_use]
    pub fn corner_positions(&self, polygon: &Polygon) -> ([Vec3; 4], usize) {
        let mut out = [Vec3::ZERO; 4];
        for (o, &i) in out.iter_mut().zip(polygon.corners()) {
            *o = self.positions[i as usize];
        }
        (out, polygon.corners().len())
    }

    /// The normal of every polygon, DD8.
    #[must_use]
    pub fn polygon_normals(&self) -> Vec<Vec3> {
        self.polygons
            .iter()
            .map(|p| {
                let (corners, n) = self.corner_positions(p);
                polygon_normal(&corners[..n])
            })
            .collect()
    }

    /// The centre of every polygon.
    #[must_use]
    pub fn polygon_centres(&self) -> Vec<Vec3> {
        self.polygons
            .iter()
            .map(|p| {
                let (corners, n) = self.corner_positions(p);
                polygon_centre(&corners[..n])
            })
            .collect()
    }

    /// The normal of every vertex, DD9.
    #[must_use]
    pub fn vertex_normals(&self) -> Vec<Vec3> {
        let normals = self.polygon_normals();
        vertex_normals(self.positions.len(), self.polygons.iter().zip(normals).map(|(p, n)| (p.corners(), n)))
    }

    /// Appends a surface made of loops of vertices, one row after the other, with a quadrilateral
    /// between each four neighbours. Seen from outside, rows follow each other downward and each goes
    /// from left to right. A row of one point is a pole, where triangles meet. With `ring` the last row
    /// is joined to the first.
    ///
    /// # Panics
    /// If rows that are not poles differ in length, or a row is empty: a mistake of the shape's author.
    pub fn append_loops(&mut self, rows: &[Vec<Vec3>], ring: bool) {
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        let mut starts = Vec::with_capacity(rows.len());
        for row in rows {
            assert!(row.len() == columns || row.len() == 1, "rows must be loops of one length, or poles");
            starts.push(self.positions.len());
            self.positions.extend_from_slice(row);
        }
        let index = |row: usize, column: usize| (starts[row] + column % rows[row].len()) as u32;
        let pairs = if ring { rows.len() } else { rows.len().saturating_sub(1) };
        for row in 0..pairs {
            let below = (row + 1) % rows.len();
            for column in 0..columns {
                self.polygons.push(Polygon::quad(
                    index(row, column),
                    index(below, column),
                    index(below, column + 1),
                    index(row, column + 1),
                ));
            }
        }
    }

    /// Moves and scales the vertices so that the largest extent is 1 and the bounding box is centred
    /// on the origin.
    pub fn normalise(&mut self) {
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for &p in &self.positions {
            low = low.min(p);
            high = high.max(p);
        }
        let extent = (high - low).max_element();
        if extent > 0.0 && extent.is_finite() {
            let centre = (low + high) * 0.5;
            for p in &mut self.positions {
                *p = (*p - centre) / extent;
            }
        }
    }
}
