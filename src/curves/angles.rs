//! The angles of curves.

/// The largest angle of the viewer, degrees: at 90° a direction is in the surface, and every BRDF is 0 by
/// definition.
pub(super) const GRAZING: f64 = 89.9;

/// The angle to the nearer of the two normals of a surface, for angles on both of its sides, degrees.
pub(super) fn from_surface(angle: f64) -> f64 {
    let angle = angle.abs();
    if angle > 90.0 { 180.0 - angle } else { angle }
}

/// The angles of viewers behind a surface, below −90° and beyond 90°, each in increasing order; those around the
/// directions of special angles to the normal there are denser.
pub(super) fn behind(special: &[f64]) -> [Vec<f64>; 2] {
    let around = |angle: &f64| [-0.5, -0.05, 0.0, 0.05, 0.5].map(|step| 180.0 - angle + step);
    let inside = special.iter().flat_map(around).filter(|a| (180.0 - GRAZING..=180.0).contains(a));
    let even = (92..=180).step_by(2).map(f64::from);
    let mut right: Vec<_> = even.chain(inside).chain([180.0 - GRAZING]).collect();
    right.sort_by(f64::total_cmp);
    right.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let left = right.iter().rev().map(|angle| -angle).collect();
    [left, right]
}

/// The direction to the viewer in the plane of incidence, and its angles θ and φ; positive angles are on the side of the
/// mirror direction.
pub(super) fn viewer(angle: f64, phi_i: f64) -> (f64, f64) {
    if angle < 0.0 { (-angle, phi_i) } else { (angle, phi_i + 180.0) }
}

/// The angles of a range with equal steps, and some special ones up to grazing, in increasing order.
pub(super) fn grid(from: i32, to: i32, step: usize, special: &[f64]) -> Vec<f64> {
    let even = (from..=to).step_by(step).map(f64::from);
    let special = special.iter().copied().filter(|a| (-GRAZING..=GRAZING).contains(a));
    let mut angles: Vec<_> = even.chain(special).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    angles
}
