//! Lobes `cos^n θ` around the mirror direction, accurate for exponents of a million and more.
//!
//! A cosine near 1 has no digits left for the angle: 1 − 10⁻⁸ is 1 in f32. These functions therefore use the
//! tangent of the angle, whose square is small where the cosine is near 1. All are symmetric in light and
//! view.
//!
//! Twin: `assets/shaders/optics/lobe.wgsl`.

use glam::Vec3;

/// `cos^n θ` from `tan² θ`, for angles below 90°: `(1 + tan² θ)^(−n/2)`. 1 where n = 0.
#[must_use]
pub fn power_of_cosine(tan_squared: f32, n: f32) -> f32 {
    if n == 0.0 { 1.0 } else { (-0.5 * n * tan_squared.ln_1p()).exp() }
}

/// The part of `l + v` perpendicular to the normal, squared: 0 in the mirror direction.
fn across_squared(l: Vec3, v: Vec3, n: Vec3) -> f32 {
    let sum = l + v;
    (sum - n.dot(sum) * n).length_squared()
}

/// `tan²` of the angle between the normal and the half vector; light and view are above the surface.
#[must_use]
pub fn half_tangent_squared(l: Vec3, v: Vec3, n: Vec3) -> f32 {
    let along = n.dot(l) + n.dot(v);
    across_squared(l, v, n) / (along * along).max(1e-30)
}

/// `tan²` of the angle α between the mirror direction of the light and the view. From 90° on, a number so large that
/// every lobe vanishes.
#[must_use]
pub fn mirror_tangent_squared(l: Vec3, v: Vec3, n: Vec3) -> f32 {
    // |R − V|²/2 = 1 − cos α; the difference along the normal is that of the cosines.
    let along = n.dot(l) - n.dot(v);
    let below_one = 0.5 * (across_squared(l, v, n) + along * along);
    if below_one >= 1.0 {
        return 1e30;
    }
    let cosine = 1.0 - below_one;
    below_one * (1.0 + cosine) / (cosine * cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_of_cosines_are_right_where_the_cosine_itself_has_no_digits_left() {
        for (angle, n) in [(0.3f64, 5.0f64), (0.05, 400.0), (1e-3, 1e6), (2e-4, 1e6), (1.2, 1.0), (0.7, 0.0)]
        {
            let got = f64::from(power_of_cosine((angle.tan() * angle.tan()) as f32, n as f32));
            let expected = angle.cos().powf(n);
            assert!((got - expected).abs() < 1e-5 * expected, "cos^{n} {angle}: {got} instead of {expected}");
        }
        // The cosine of 10⁻³ as f32 is off by half its last digit, which an exponent of a million magnifies.
        let naive = f64::from((1e-3f32).cos().powf(1e6));
        assert!((naive / (1e-3f64).cos().powf(1e6) - 1.0).abs() > 1e-3);
        assert_eq!(power_of_cosine(1e30, 1e18), 0.0);
        assert_eq!(power_of_cosine(1e30, 0.0), 1.0);
    }

    #[test]
    fn tangents_are_those_of_the_half_vector_and_of_the_mirror_direction() {
        use crate::optics::geometry::{half_vector, mirror};
        let n = Vec3::new(0.3, -0.5, 0.8).normalize();
        let l = Vec3::new(0.6, 0.1, 0.7).normalize();
        for v in [Vec3::new(-0.2, -0.9, 0.5), Vec3::new(0.1, -0.3, 0.9), Vec3::new(0.3, -0.6, 0.7)] {
            let v = v.normalize();
            let tan_squared = |cosine: f32| 1.0 / (cosine * cosine) - 1.0;
            let half = tan_squared(n.dot(half_vector(l, v)));
            assert!((half_tangent_squared(l, v, n) - half).abs() < 1e-5 * (1.0 + half));
            let cosine = mirror(l, n).dot(v);
            assert!(cosine > 0.1);
            let reflected = tan_squared(cosine);
            assert!((mirror_tangent_squared(l, v, n) - reflected).abs() < 1e-5 * (1.0 + reflected));
        }
        assert!(half_tangent_squared(l, mirror(l, n), n) < 1e-12);
        assert!(mirror_tangent_squared(l, mirror(l, n), n) < 1e-12);
        assert_eq!(mirror_tangent_squared(Vec3::X, Vec3::X, Vec3::Z), 1e30);
    }
}
