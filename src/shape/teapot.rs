use glam::{Vec2, Vec3};

use super::{Declaration, ObjectType, PolygonMesh};
use crate::{parameters, text::template::chosen};

parameters! {
    /// **Teapot**: the teapot of M. Newell (1975), *The Utilization of Procedure Models in Digital Image Synthesis*,
    /// University of Utah; lower by the factor 1/1.3 than the pot on his table, as usual since J. Blinn, and with the
    /// bottom that the original lacked.
    ///
    /// All 32 bicubic Bézier patches with Newell's numbers: rim 4, body 8, lid 8, bottom 4, handle 4,
    /// spout 4. y is up and the spout points along +x. It is tessellated from the patches; within each
    /// part (body with rim and bottom, lid, handle, spout) neighbouring patches share their vertices. The
    /// parts interpenetrate as Newell made them, so the mesh has six open edges: the lid's, the rim's, and
    /// both ends of handle and spout. Each part is brushed around itself: body and lid around their axis,
    /// handle and spout around the tube.
    pub struct Teapot {}
}

/// Control rows of a part: lid from the knob down; rim, the body (two) and the bottom; handle from its upper end; spout from
/// the body to the lip, which turns inward. Every third is shared by two patches.
///
/// A row of lid and body has four control points of a quarter turn, in the pot's own units (z up): with radius r,
/// handle length q and height h they are (r, 0, h), (r, −q, h), (q, −r, h), (0, −r, h). One of handle and spout has those of
/// a half loop with the plane of symmetry: from the inner one (x, height) to the outer one, over two points moved sideways by
/// a width.
fn control_rows<const N: usize>(part: &str) -> Vec<[f32; N]> {
    let text = chosen(include_str!("teapot.txt"), |name| name == part);
    let row = |line: &str| {
        let mut numbers = line.split(' ').filter_map(|number| number.parse().ok());
        std::array::from_fn(|_| numbers.next().unwrap_or_default())
    };
    text.lines().map(row).collect()
}

/// The weighted sum of control rows.
fn blended<const N: usize>(rows: &[[f32; N]], weights: [f32; 4]) -> [f32; N] {
    std::array::from_fn(|i| rows.iter().zip(weights).map(|(row, weight)| weight * row[i]).sum())
}

/// Bernstein's cubic polynomials: the weights of the four control points at `t`.
fn bernstein(t: f32) -> [f32; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// The rows of a chain of patches over control rows: for each step along the chain, the blend of four control
/// rows. The first row of each additional patch is the last of the one before.
fn along<R, B>(rows: &[R], steps: usize, blend: impl Fn(&[R], [f32; 4]) -> B) -> Vec<B> {
    let patches = rows.len() / 3;
    (0..=patches * steps)
        .map(|i| {
            let patch = (i / steps).min(patches - 1);
            let t = (i - patch * steps) as f32 / steps as f32;
            blend(&rows[3 * patch..3 * patch + 4], bernstein(t))
        })
        .collect()
}

/// The rows of vertices of a part that goes around the y axis in four quarter turns.
fn turned(part: &str, steps: usize) -> Vec<Vec<Vec3>> {
    along(&control_rows(part), steps, |rings, w| {
        let [radius, handle, height] = blended(rings, w);
        if radius == 0.0 {
            return vec![Vec3::Y * height];
        }
        let quarter: Vec<Vec2> = (0..steps)
            .map(|j| {
                let [a, b, c, d] = bernstein(j as f32 / steps as f32);
                Vec2::new((a + b) * radius + c * handle, b * handle + (c + d) * radius)
            })
            .collect();
        // Anticlockwise seen from above: +x, −z, −x, +z. Rotation by swapping preserves exact symmetry.
        let turns: [fn(Vec2) -> Vec2; 4] = [|p| p, Vec2::perp, |p| -p, |p| -p.perp()];
        turns
            .into_iter()
            .flat_map(|turn| quarter.iter().map(move |&p| turn(p)))
            .map(|p| Vec3::new(p.x, height, -p.y))
            .collect()
    })
}

/// The rows of vertices of handle or spout: two halves, mirrored in the plane z = 0.
fn mirrored(part: &str, steps: usize) -> Vec<Vec<Vec3>> {
    along(&control_rows(part), steps, |loops, w| {
        let [inner_x, inner_y, outer_x, outer_y, width] = blended(loops, w);
        let [inner, outer] = [Vec2::new(inner_x, inner_y), Vec2::new(outer_x, outer_y)];
        let at = |j: usize, side: f32| {
            let [a, b, c, d] = bernstein(j as f32 / steps as f32);
            let p = (a + b) * inner + (c + d) * outer;
            Vec3::new(p.x, p.y, side * (b + c) * width)
        };
        // Seen along the rows the loops run anticlockwise, which turns the walls outward.
        let first = (0..steps).map(|j| at(j, -1.0));
        let second = (1..=steps).rev().map(|j| at(j, 1.0));
        first.chain(second).collect()
    })
}

impl ObjectType for Teapot {
    const DECLARATION: Declaration = Declaration::new("teapot", "Teapot")
        .summary("Newell's teapot of 1975, the test object of computer graphics: round, thin and hollow parts at once.")
        .glyph("☕")
        .open("Newell's lid, body, handle and spout are separate surfaces that pass into each other")
        .tessellation(2..=32, 10, "Polygons along each side of each of the 32 Bézier patches.");

    fn mesh(&self, tessellation: u32) -> PolygonMesh {
        let steps = tessellation.max(2) as usize;
        let mut mesh = PolygonMesh::default();
        mesh.append_loops(&turned("body", steps), false);
        mesh.append_loops(&turned("lid", steps), false);
        mesh.append_loops(&mirrored("handle", steps), false);
        mesh.append_loops(&mirrored("spout", steps), false);
        mesh.normalise();
        mesh
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_those_of_32_patches_welded_along_their_edges() {
        let n = 8;
        let mesh = Teapot {}.mesh(n);
        let n = n as usize;
        assert_eq!(mesh.polygons.len(), 32 * n * n);
        let (body, lid) = (4 * n * (4 * n) + 1, 4 * n * (2 * n) + 1);
        let tubes = 2 * (2 * n * (2 * n + 1));
        assert_eq!(mesh.positions.len(), body + lid + tubes);
        // Poles of lid and bottom.
        assert_eq!(mesh.polygons.iter().filter(|p| p.corners().len() == 3).count(), 2 * 4 * n);
    }

    #[test]
    fn the_spout_points_along_x_and_the_lid_is_on_top() {
        let mesh = Teapot {}.mesh(8);
        let right = mesh.positions.iter().max_by(|a, b| a.x.total_cmp(&b.x)).expect("has vertices");
        let left = mesh.positions.iter().min_by(|a, b| a.x.total_cmp(&b.x)).expect("has vertices");
        let top = mesh.positions.iter().max_by(|a, b| a.y.total_cmp(&b.y)).expect("has vertices");
        // The spout's lip is high above the centre; the handle's outermost point is not.
        assert!(right.y > 0.1 && left.y < right.y, "{right} {left}");
        assert!(top.x.abs() < 0.05 && top.z.abs() < 0.05, "{top}");
    }

    #[test]
    fn walls_look_outward() {
        let mesh = Teapot {}.mesh(8);
        let normals = mesh.polygon_normals();
        let centres = mesh.polygon_centres();
        let n = 8;
        // The two bands of the body: away from the axis.
        let body = 4 * n * n..12 * n * n;
        for (centre, normal) in centres[body.clone()].iter().zip(&normals[body]) {
            assert!(centre.with_y(0.0).dot(*normal) > 0.0, "{centre} {normal}");
        }
        // Handle and spout: away from the centre of their cross-section.
        for start in [24 * n * n, 28 * n * n] {
            for row in 0..2 * n {
                let from = start + row * 2 * n;
                let middle = centres[from..from + 2 * n].iter().sum::<Vec3>() / (2 * n) as f32;
                let outward = (from..from + 2 * n).filter(|&i| (centres[i] - middle).dot(normals[i]) > 0.0);
                let count = outward.count();
                // The lip turns inward in the last rows of the spout.
                assert!(count == 2 * n || (start == 28 * n * n && row >= n), "row {row}: {count}");
            }
        }
    }

    #[test]
    fn the_mouth_of_the_spout_is_at_newells_points() {
        // In the pot's units: the last control row of the spout is on the surface.
        let rows = mirrored("spout", 4);
        let mouth = rows.last().expect("has rows");
        assert!((mouth[0] - Vec3::new(2.8, 2.4, 0.0)).length() < 1e-6);
        assert!((mouth[4] - Vec3::new(3.2, 2.4, 0.0)).length() < 1e-6);
        // The centre of a half circle of control width w is 3/4 w wide.
        assert!((mouth[2].z + 0.75 * 0.15).abs() < 1e-6);
    }

    #[test]
    fn body_handle_and_spout_are_brushed_around_themselves() {
        let n = 8;
        let mesh = Teapot {}.mesh(n);
        let n = n as usize;
        let (tangents, centres) = (mesh.polygon_tangents(), mesh.polygon_centres());
        // The pole of the bottom, the last vertex of the body: the axis goes through it.
        let axis = mesh.positions[4 * n * 4 * n];
        for (tangent, centre) in tangents.iter().zip(&centres).take(16 * n * n) {
            let around = Vec3::Y.cross(*centre - axis).normalize();
            assert!(tangent.dot(around) > 0.98, "{tangent} {around}");
        }
        // Around a tube the tangents nearly cancel.
        for start in [24 * n * n, 28 * n * n] {
            for row in 0..2 * n {
                let from = start + row * 2 * n;
                let sum: Vec3 = tangents[from..from + 2 * n].iter().sum();
                assert!(sum.length() < 0.5 * 2.0 * n as f32, "{row}: {sum}");
            }
        }
    }
}
