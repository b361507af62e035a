//! Surface normals of polygons and of vertices, as the data definitions 8 and 9 of the Commonality Analysis (CA) have
//! them; tangents likewise.

use glam::Vec3;

/// The unit normal of a polygon whose corners run counter-clockwise seen from outside (CA DD8:
/// `n = (P × Q)/|P × Q|` for two tangents P, Q).
///
/// For triangles P and Q are two edges; for quadrilaterals they are the diagonals, which gives the area-weighted mean
/// of both ways to split a non-planar quadrilateral (M. Newell). Zero for degenerate polygons.
#[must_use]
pub fn polygon_normal(corners: &[Vec3]) -> Vec3 {
    // Newell's sum over the edges, taken about the first corner; equals the two cases above.
    let Some(&origin) = corners.first() else { return Vec3::ZERO };
    let mut sum = Vec3::ZERO;
    for pair in corners[1..].windows(2) {
        sum += (pair[0] - origin).cross(pair[1] - origin);
    }
    sum.normalize_or_zero()
}

/// The mean of the corners of a polygon: the point at which flat shading evaluates the model.
#[must_use]
pub fn polygon_centre(corners: &[Vec3]) -> Vec3 {
    corners.iter().sum::<Vec3>() / corners.len().max(1) as f32
}

/// Vertex normals: the normalised **unweighted** mean of the normals of all polygons that share the vertex (CA DD9:
/// `n_v = Σ n_i / |Σ n_i|`). Degenerate polygons do not count; a vertex without polygons gets zero.
#[must_use]
pub fn vertex_normals<'a>(
    vertex_count: usize,
    polygons: impl IntoIterator<Item = (&'a [u32], Vec3)>,
) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; vertex_count];
    for (corners, normal) in polygons {
        for &corner in corners {
            if let Some(sum) = sums.get_mut(corner as usize) {
                *sum += normal;
            }
        }
    }
    sums.into_iter().map(Vec3::normalize_or_zero).collect()
}

/// The unit tangent of a polygon with a unit normal, for a brush direction that need not lie in its plane. If
/// the brush direction is zero or along the normal, the polygon is brushed horizontally, `y × n`, and a
/// horizontal polygon along x.
#[must_use]
pub fn polygon_tangent(brushed: Vec3, normal: Vec3) -> Vec3 {
    [brushed, Vec3::Y.cross(normal), Vec3::X]
        .into_iter()
        .map(Vec3::normalize_or_zero)
        .map(|d| d - normal.dot(d) * normal)
        .find(|d| d.length_squared() > 1e-6)
        .map_or(Vec3::ZERO, Vec3::normalize_or_zero)
}

/// Minimum length of a vertex tangent between polygons brushed in different directions.
const DISPUTED: f32 = 1e-3;

/// Vertex tangents: the normalised unweighted mean of the tangents of all polygons that share the vertex, as
/// [`vertex_normals`] does for normals. Zero where they cancel: at a pole, around which they run. Short where
/// they are at right angles or more, as at an edge between two faces brushed differently: in interpolation
/// such a tangent has less weight than those of the other corners, so that each face is brushed uniformly up
/// to the edge.
#[must_use]
pub fn vertex_tangents<'a>(
    vertex_count: usize,
    polygons: impl IntoIterator<Item = (&'a [u32], Vec3)>,
) -> Vec<Vec3> {
    let mut sums = vec![(Vec3::ZERO, 0.0f32); vertex_count];
    for (corners, tangent) in polygons {
        for &corner in corners {
            if let Some((sum, count)) = sums.get_mut(corner as usize) {
                *sum += tangent;
                *count += 1.0;
            }
        }
    }
    sums.into_iter()
        .map(|(sum, count)| {
            // The length of the mean of two directions at right angles is 0.71.
            let agreement = sum.length() / count.max(1.0);
            match agreement {
                0.75.. => sum.normalize_or_zero(),
                1e-3.. => DISPUTED * sum.normalize_or_zero(),
                _ => Vec3::ZERO,
            }
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_triangle_has_the_normalised_cross_product_of_its_edges() {
        let n = polygon_normal(&[Vec3::ZERO, Vec3::X * 3.0, Vec3::Y * 0.1]);
        assert!((n - Vec3::Z).length() < 1e-6);
    }

    #[test]
    fn a_quadrilateral_has_the_normal_of_its_diagonals() {
        let q = [Vec3::ZERO, Vec3::new(1.0, 0.0, 0.2), Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 0.3)];
        let expected = (q[2] - q[0]).cross(q[3] - q[1]).normalize();
        assert!((polygon_normal(&q) - expected).length() < 1e-6);
    }

    #[test]
    fn degenerate_polygons_have_no_normal() {
        assert_eq!(polygon_normal(&[Vec3::ZERO, Vec3::X, Vec3::X * 2.0]), Vec3::ZERO);
        assert_eq!(polygon_normal(&[]), Vec3::ZERO);
    }

    #[test]
    fn vertex_normals_are_the_unweighted_mean() {
        // Two polygons of very different size meet at vertex 0: the mean must not depend on it.
        let normals = vertex_normals(2, [(&[0u32, 1][..], Vec3::X), (&[0u32][..], Vec3::Y)]);
        let diagonal = (Vec3::X + Vec3::Y).normalize();
        assert!((normals[0] - diagonal).length() < 1e-6);
        // The wrong twin, a mean weighted 1:9 by area, must be rejected.
        assert!((normals[0] - (Vec3::X + 9.0 * Vec3::Y).normalize()).length() > 0.1);
        assert_eq!(normals[1], Vec3::X);
    }

    #[test]
    fn polygons_are_brushed_as_said_or_horizontally() {
        let leaning = Vec3::new(0.0, 0.6, 0.8);
        assert!((polygon_tangent(Vec3::Y * 5.0, leaning) - Vec3::new(0.0, 0.8, -0.6)).length() < 1e-6);
        assert!((polygon_tangent(Vec3::ZERO, leaning) - Vec3::X).length() < 1e-6);
        assert_eq!(polygon_tangent(leaning * 2.0, leaning), polygon_tangent(Vec3::ZERO, leaning));
        assert_eq!(polygon_tangent(Vec3::ZERO, Vec3::Y), Vec3::X);
        assert!(polygon_tangent(Vec3::ZERO, Vec3::ZERO).is_finite());
    }

    #[test]
    fn vertex_tangents_are_means_zero_at_poles_and_short_where_disputed() {
        let at = |tangents: &[Vec3]| vertex_tangents(1, tangents.iter().map(|&t| (&[0u32][..], t)))[0];
        let slanted = Vec3::new(0.8, 0.6, 0.0);
        assert!((at(&[Vec3::X, slanted]) - (Vec3::X + slanted).normalize()).length() < 1e-6);
        assert!((at(&[Vec3::X, Vec3::Z]) - DISPUTED * (Vec3::X + Vec3::Z).normalize()).length() < 1e-9);
        assert_eq!(at(&[Vec3::X, Vec3::Z, -Vec3::X, -Vec3::Z]), Vec3::ZERO);
        assert_eq!(at(&[]), Vec3::ZERO);
    }
}
