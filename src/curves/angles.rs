//! The angles of curves.

/// The largest angle of the viewer, degrees: at 90° a direction is in the surface, and every BRDF is 0 by
/// definition.
pub(super) const GRAZING: f64 = 89.9;

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
