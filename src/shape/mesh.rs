//! Polygon meshes: a list of vertices and a set of polygons over them, as the Commonality Analysis assumes (AB10, AB11).

use glam::{Vec2, Vec3};

use crate::{
    declared::setters,
    shading::normals::{polygon_centre, polygon_normal, polygon_tangent, vertex_normals, vertex_tangents},
};

/// Vertices and convex polygons of three or four corners, with the normals and tangents that shading models need.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonMesh {
    /// The vertices; each point of a surface occurs once.
    pub positions: Vec<Vec3>,
    /// Corners of each polygon, counter-clockwise seen from outside.
    pub polygons: Vec<Polygon>,
}

/// A polygon of three or four corners, its brush direction, and possibly explicit normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polygon {
    corners: [u32; 4],
    count: u8,
    brushed: Vec3,
    /// Zero where the vertex has the mean of the normals of its polygons.
    normals: [Vec3; 4],
}

impl Polygon {
    /// A triangle.
    #[must_use]
    pub const fn triangle(a: u32, b: u32, c: u32) -> Self {
        Self { corners: [a, b, c, c], count: 3, brushed: Vec3::ZERO, normals: [Vec3::ZERO; 4] }
    }

    /// A quadrilateral; a triangle if neighbouring corners are the same vertex (at a pole).
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
        Self { corners, count: count as u8, brushed: Vec3::ZERO, normals: [Vec3::ZERO; 4] }
    }

    setters! {
        /// The polygon with a brush direction, for anisotropic models. Without one, it is brushed horizontally.
        brushed(direction: Vec3) { brushed: direction }

        /// The polygon with the unit normals of the surface at its corners, for shapes that know them better than
        /// their polygons do. Zero stands for none. Polygons that share a vertex should agree on its normal,
        /// which is their mean.
        with_normals(normals: [Vec3; 4]) { normals }
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
    /// True if any polygon has [explicit normals](Polygon::with_normals).
    #[must_use]
    pub fn has_own_normals(&self) -> bool {
        self.polygons.iter().any(|polygon| polygon.normals.iter().any(|normal| *normal != Vec3::ZERO))
    }

    /// The triangles of all polygons: the index of the polygon, and three corners.
    pub fn triangles(&self) -> impl Iterator<Item = (usize, [u32; 3])> {
        self.polygons.iter().enumerate().flat_map(|(i, polygon)| {
            let corners = polygon.corners();
            polygon.triangles().iter().map(move |triangle| (i, triangle.map(|c| corners[c])))
        })
    }

    /// The corners of a polygon in space.
    #[must_use]
    pub fn corner_positions(&self, polygon: &Polygon) -> ([Vec3; 4], usize) {
        let mut out = [Vec3::ZERO; 4];
        for (o, &i) in out.iter_mut().zip(polygon.corners()) {
            *o = self.positions[i as usize];
        }
        (out, polygon.corners().len())
    }

    /// The normal of every polygon: the normalised cross product of two of its sides (CA DD8).
    #[must_use]
    pub fn polygon_normals(&self) -> Vec<Vec3> {
        self.of_polygons(polygon_normal)
    }

    /// The centre of every polygon.
    #[must_use]
    pub fn polygon_centres(&self) -> Vec<Vec3> {
        self.of_polygons(polygon_centre)
    }

    fn of_polygons(&self, of: impl Fn(&[Vec3]) -> Vec3) -> Vec<Vec3> {
        let of = |polygon| {
            let (corners, n) = self.corner_positions(polygon);
            of(&corners[..n])
        };
        self.polygons.iter().map(of).collect()
    }

    /// The normal of every vertex, CA DD9; that of the surface where polygons [have
    /// it](Polygon::with_normals).
    #[must_use]
    pub fn vertex_normals(&self) -> Vec<Vec3> {
        let normals = self.polygon_normals();
        let count = self.positions.len();
        let mut means =
            vertex_normals(count, self.polygons.iter().zip(&normals).map(|(p, n)| (p.corners(), *n)));
        // Those of polygons back to back cancel: one is better than none.
        for (polygon, normal) in self.polygons.iter().zip(&normals) {
            for corner in polygon.corners() {
                if let Some(mean) = means.get_mut(*corner as usize).filter(|mean| **mean == Vec3::ZERO) {
                    *mean = *normal;
                }
            }
        }
        if self.polygons.iter().any(|p| p.normals != [Vec3::ZERO; 4]) {
            let corners = self
                .polygons
                .iter()
                .flat_map(|p| (0..p.corners().len()).map(move |i| (&p.corners()[i..=i], p.normals[i])));
            for (mean, own) in means.iter_mut().zip(vertex_normals(count, corners)) {
                *mean = if own == Vec3::ZERO { *mean } else { own };
            }
        }
        means
    }

    /// The tangent of every polygon: the brush direction in its plane.
    #[must_use]
    pub fn polygon_tangents(&self) -> Vec<Vec3> {
        let normals = self.polygon_normals();
        self.polygons.iter().zip(normals).map(|(p, n)| polygon_tangent(p.brushed, n)).collect()
    }

    /// The tangent of every vertex: the mean of the tangents of its polygons, zero at a pole.
    #[must_use]
    pub fn vertex_tangents(&self) -> Vec<Vec3> {
        let tangents = self.polygon_tangents();
        vertex_tangents(
            self.positions.len(),
            self.polygons.iter().zip(tangents).map(|(p, t)| (p.corners(), t)),
        )
    }

    /// Brushes every polygon as on a lathe that turns the shape about an axis through the origin.
    pub fn turn_on_lathe(&mut self, axis: Vec3) {
        let centres = self.polygon_centres();
        for (polygon, centre) in self.polygons.iter_mut().zip(centres) {
            polygon.brushed = axis.cross(centre);
        }
    }

    /// A surface of height 1 from pole to pole of the y axis. `outline` contains the distance from the axis
    /// and the height of each row between them, from above; `parallel` contains the x and −z of the points
    /// around the axis, at distance 1.
    #[must_use]
    pub fn between_poles(outline: impl Iterator<Item = Vec2>, parallel: &[Vec2]) -> Self {
        let mut rows = vec![vec![Vec3::Y * 0.5]];
        for Vec2 { x: radius, y } in outline {
            rows.push(parallel.iter().map(|p| Vec3::new(radius * p.x, y, -radius * p.y)).collect());
        }
        rows.push(vec![Vec3::Y * -0.5]);
        let mut mesh = Self::default();
        mesh.append_loops(&rows, false);
        mesh
    }

    /// Appends a surface made of loops of vertices, one row after the other, with a quadrilateral between
    /// each four neighbours. Seen from outside, rows follow each other downwards and each runs from left to
    /// right. A row of one point is a pole, where triangles meet. With `ring` the last row is joined to the
    /// first. The polygons are brushed along the rows.
    ///
    /// # Panics
    /// Panics if rows other than poles differ in length, or a row is empty: an error of the shape's author.
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
                let corners = [
                    index(row, column),
                    index(below, column),
                    index(below, column + 1),
                    index(row, column + 1),
                ];
                let [a, b, c, d] = corners.map(|i| self.positions[i as usize]);
                let [i, j, k, l] = corners;
                self.polygons.push(Polygon::quad(i, j, k, l).brushed(d - a + c - b));
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
