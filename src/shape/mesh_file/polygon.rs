//! Polygons with any number of corners, cut into those that a mesh has: triangles, and quadrilaterals that
//! are split along their inner diagonal.

use glam::{Vec2, Vec3};

use crate::shading::normals::polygon_normal;

/// The length of M. Newell's sum over the edges: twice the area of a plane polygon. 0 if it is too small to
/// have a normal.
pub fn doubled_area(corners: &[Vec3]) -> f32 {
    let normal = polygon_normal(corners);
    let Some(origin) = corners.first() else { return 0.0 };
    corners[1..].windows(2).map(|pair| (pair[0] - origin).cross(pair[1] - origin).dot(normal)).sum()
}

/// Calls `each` with the pieces of a polygon, each with three or four of its corners. Polygons of up to four corners stay
/// whole; larger ones are cut into triangles by clipping ears: G. H. Meisters (1975), *Polygons Have Ears*, American
/// Mathematical Monthly 82(6).
pub fn pieces(corners: &[Vec3], mut each: impl FnMut(&[usize])) {
    let n = corners.len();
    if n < 4 {
        if n == 3 {
            each(&[0, 1, 2]);
        }
        return;
    }
    let flat = flat(corners);
    let turn = |a: usize, b: usize, c: usize| (flat[b] - flat[a]).perp_dot(flat[c] - flat[a]);
    let reflex = |i: usize| turn((i + n - 1) % n, i, (i + 1) % n) < 0.0;
    match n {
        // A mesh splits along the diagonal from the first corner.
        4 if reflex(1) || reflex(3) => each(&[1, 2, 3, 0]),
        4 => each(&[0, 1, 2, 3]),
        _ if !(0..n).any(reflex) => (2..n).for_each(|i| each(&[0, i - 1, i])),
        _ => ears(&flat, turn).iter().for_each(|triangle| each(triangle)),
    }
}

/// The corners in the plane of the polygon, anticlockwise.
fn flat(corners: &[Vec3]) -> Vec<Vec2> {
    let normal = polygon_normal(corners);
    let (x, y) = normal.try_normalize().map_or((Vec3::X, Vec3::Y), Vec3::any_orthonormal_pair);
    // `any_orthonormal_pair` does not specify the orientation.
    let y = if x.cross(y).dot(normal) < 0.0 { -y } else { y };
    corners.iter().map(|p| Vec2::new(p.dot(x), p.dot(y))).collect()
}

/// Cuts off one ear after the other: a corner whose triangle contains no other corner. The search continues
/// at the last ear.
fn ears(flat: &[Vec2], turn: impl Fn(usize, usize, usize) -> f32) -> Vec<[usize; 3]> {
    let mut remaining: Vec<usize> = (0..flat.len()).collect();
    let mut triangles = Vec::with_capacity(flat.len() - 2);
    let mut last = 0;
    while remaining.len() > 3 {
        let n = remaining.len();
        let corners = |i: usize| [remaining[(i + n - 1) % n], remaining[i], remaining[(i + 1) % n]];
        let inside = |[a, b, c]: [usize; 3], p: usize| {
            turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0
        };
        let is_ear = |i: &usize| {
            let ear = corners(*i);
            let [a, b, c] = ear;
            let others = remaining.iter().filter(|p| ![flat[a], flat[b], flat[c]].contains(&flat[**p]));
            turn(a, b, c) > 0.0 && !others.copied().any(|p| inside(ear, p))
        };
        let Some(i) = (last..n).chain(0..last.min(n)).find(is_ear) else {
            // A self-intersecting polygon may have none: any cut is as good as another.
            break;
        };
        triangles.push(corners(i));
        remaining.remove(i);
        last = i.min(n - 2);
    }
    triangles.extend(remaining[1..].windows(2).map(|pair| [remaining[0], pair[0], pair[1]]));
    triangles
}

#[cfg(test)]
mod tests {
    use super::*;

    fn in_plane(points: &[[f32; 2]]) -> Vec<Vec3> {
        points.iter().map(|[x, y]| Vec3::new(*x, *y, 0.5)).collect()
    }

    fn cut(corners: &[Vec3]) -> Vec<Vec<usize>> {
        let mut all = Vec::new();
        pieces(corners, |piece| all.push(piece.to_vec()));
        all
    }

    /// The doubled areas of the pieces' triangles; negative for those that face the other way.
    fn areas(corners: &[Vec3]) -> Vec<f32> {
        let triangles = cut(corners).into_iter().flat_map(|piece| match piece[..] {
            [a, b, c, d] => vec![[a, b, c], [a, c, d]],
            [a, b, c] => vec![[a, b, c]],
            _ => panic!("{piece:?}"),
        });
        let normal = polygon_normal(corners);
        let area = |t: [usize; 3]| {
            let [a, b, c] = t.map(|i| corners[i]);
            (b - a).cross(c - a).dot(normal)
        };
        triangles.map(area).collect()
    }

    #[test]
    fn pieces_cover_a_polygon_once_and_face_as_it_does() {
        let star: Vec<_> = (0..10)
            .map(|i| {
                let (s, c) = (std::f32::consts::TAU * i as f32 / 10.0).sin_cos();
                let r = if i % 2 == 0 { 1.0 } else { 0.3 };
                [r * c, r * s]
            })
            .collect();
        let circle: Vec<_> = (0..128)
            .map(|i| (std::f32::consts::TAU * i as f32 / 128.0).sin_cos())
            .map(|(s, c)| [c, s])
            .collect();
        let arrow = [[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [0.5, 1.0]];
        let arrow_from_its_notch = [[0.5, 1.0], [0.0, 0.0], [2.0, 1.0], [0.0, 2.0]];
        let comb = [
            [0.0, 0.0],
            [5.0, 0.0],
            [5.0, 2.0],
            [4.0, 2.0],
            [4.0, 1.0],
            [3.0, 1.0],
            [3.0, 2.0],
            [2.0, 2.0],
            [2.0, 1.0],
            [1.0, 1.0],
            [1.0, 2.0],
            [0.0, 2.0],
        ];
        for shape in [&star[..], &circle, &arrow, &arrow_from_its_notch, &comb] {
            let corners = in_plane(shape);
            let whole = doubled_area(&corners);
            for turned in 0..corners.len() {
                let mut corners = corners.clone();
                corners.rotate_left(turned);
                let areas = areas(&corners);
                assert!(areas.iter().all(|a| *a >= -1e-6), "{shape:?} {turned}: {areas:?}");
                assert!(
                    (areas.iter().sum::<f32>() - whole).abs() < 1e-4 * whole,
                    "{shape:?} {turned}: {areas:?}"
                );
            }
        }
        // The wrong twin: the arrow cut from the first corner has a triangle that faces the other way.
        let [a, b, c, d] = [0, 1, 2, 3].map(|i| in_plane(&arrow)[i]);
        assert!(((b - a).cross(c - a).z - 4.0).abs() < 1e-6 && (c - a).cross(d - a).z < 0.0);
    }

    #[test]
    fn polygons_that_cross_themselves_or_have_no_area_end_too() {
        let bow = [[0.0, 0.0], [1.0, 1.0], [1.0, 0.0], [0.0, 1.0], [0.5, 3.0]];
        assert_eq!(cut(&in_plane(&bow)).len(), 3);
        assert_eq!(cut(&[Vec3::ONE; 7]).len(), 5);
        assert_eq!(doubled_area(&[Vec3::ONE; 7]), 0.0);
        assert!(cut(&[]).is_empty() && doubled_area(&[]) == 0.0);
        assert_eq!(cut(&[Vec3::NAN; 6]).len(), 4);
    }
}
