use glam::{Vec2, Vec3};

use super::{Declaration, ObjectType, PolygonMesh};
use crate::parameters;

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

/// One row of four control points of a quarter turn, in the pot's own units (z up): with radius r,
/// handle length q and height h they are (r, 0, h), (r, −q, h), (q, −r, h), (0, −r, h).
struct Ring {
    radius: f32,
    handle: f32,
    height: f32,
}

const fn ring(radius: f32, handle: f32, height: f32) -> Ring {
    Ring { radius, handle, height }
}

/// One row of control points of handle or spout, a half loop with the plane of symmetry: from `inner`
/// (x, height), over two points moved sideways by `width`, to `outer` (x, height).
struct Loop {
    inner: Vec2,
    outer: Vec2,
    width: f32,
}

const fn half_loop(inner: (f32, f32), outer: (f32, f32), width: f32) -> Loop {
    Loop { inner: Vec2::new(inner.0, inner.1), outer: Vec2::new(outer.0, outer.1), width }
}

/// Control rows of the lid from the knob down. Every third is shared by two patches, here and below.
const LID: [Ring; 7] = [
    ring(0.0, 0.0, 3.15),
    ring(0.8, 0.45, 3.15),
    ring(0.0, 0.0, 2.85),
    ring(0.2, 0.112, 2.7),
    ring(0.4, 0.224, 2.55),
    ring(1.3, 0.728, 2.55),
    ring(1.3, 0.728, 2.4),
];

/// Control rows of the rim, the body (two) and the bottom.
const BODY: [Ring; 13] = [
    ring(1.4, 0.784, 2.4),
    ring(1.3375, 0.749, 2.53125),
    ring(1.4375, 0.805, 2.53125),
    ring(1.5, 0.84, 2.4),
    ring(1.75, 0.98, 1.875),
    ring(2.0, 1.12, 1.35),
    ring(2.0, 1.12, 0.9),
    ring(2.0, 1.12, 0.45),
    ring(1.5, 0.84, 0.225),
    ring(1.5, 0.84, 0.15),
    ring(1.5, 0.84, 0.075),
    ring(1.425, 0.798, 0.0),
    ring(0.0, 0.0, 0.0),
];

/// Control rows of the handle from its upper end.
const HANDLE: [Loop; 7] = [
    half_loop((-1.6, 2.025), (-1.5, 2.25), 0.3),
    half_loop((-2.3, 2.025), (-2.5, 2.25), 0.3),
    half_loop((-2.7, 2.025), (-3.0, 2.25), 0.3),
    half_loop((-2.7, 1.8), (-3.0, 1.8), 0.3),
    half_loop((-2.7, 1.575), (-3.0, 1.35), 0.3),
    half_loop((-2.5, 1.125), (-2.65, 0.9375), 0.3),
    half_loop((-2.0, 0.9), (-1.9, 0.6), 0.3),
];

/// Control rows of the spout from the body to the lip, which turns inward.
const SPOUT: [Loop; 7] = [
    half_loop((1.7, 1.425), (1.7, 0.6), 0.66),
    half_loop((2.6, 1.425), (3.1, 0.825), 0.66),
    half_loop((2.3, 2.1), (2.4, 2.025), 0.25),
    half_loop((2.7, 2.4), (3.3, 2.4), 0.25),
    half_loop((2.8, 2.475), (3.525, 2.49375), 0.25),
    half_loop((2.9, 2.475), (3.45, 2.5125), 0.15),
    half_loop((2.8, 2.4), (3.2, 2.4), 0.15),
];

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
fn turned(rings: &[Ring], steps: usize) -> Vec<Vec<Vec3>> {
    along(rings, steps, |rings, w| {
        let sum = |value: fn(&Ring) -> f32| rings.iter().zip(w).map(|(r, w)| w * value(r)).sum::<f32>();
        let (radius, handle, height) = (sum(|r| r.radius), sum(|r| r.handle), sum(|r| r.height));
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
fn mirrored(loops: &[Loop], steps: usize) -> Vec<Vec<Vec3>> {
    along(loops, steps, |loops, w| {
        let inner: Vec2 = loops.iter().zip(w).map(|(l, w)| w * l.inner).sum();
        let outer: Vec2 = loops.iter().zip(w).map(|(l, w)| w * l.outer).sum();
        let width: f32 = loops.iter().zip(w).map(|(l, w)| w * l.width).sum();
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
    const DECLARATION: Declaration = Declaration {
        id: "teapot",
        name: "Teapot",
        summary: "Newell's teapot of 1975, the test object of computer graphics: round, thin and hollow parts at once.",
        glyph: "☕",
        tessellation_help: "Polygons along each side of each of the 32 Bézier patches.",
        tessellation: 2..=32,
        default_tessellation: 10,
    };

    fn mesh(&self, tessellation: u32) -> PolygonMesh {
        let steps = tessellation.max(2) as usize;
        let mut mesh = PolygonMesh::default();
        mesh.append_loops(&turned(&BODY, steps), false);
        mesh.append_loops(&turned(&LID, steps), false);
        mesh.append_loops(&mirrored(&HANDLE, steps), false);
        mesh.append_loops(&mirrored(&SPOUT, steps), false);
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
        let rows = mirrored(&SPOUT, 4);
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
