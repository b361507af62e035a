//! Directions at a surface point. All vectors are unit vectors; `l` points from the surface
//! **to** the light, `v` to the observer.

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI, SQRT_2};

use glam::{DVec3, Vec2, Vec3, Vec4};

/// The local frame of a surface point: normal, tangent, bitangent; orthonormal, right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// The shading normal.
    pub n: Vec3,
    /// The tangent: the direction along which anisotropic surfaces are brushed.
    pub t: Vec3,
    /// The bitangent, `n × t`.
    pub b: Vec3,
}

impl Frame {
    /// The frame in which models are measured: normal +z, tangent +x.
    pub const LOCAL: Self = Self { n: Vec3::Z, t: Vec3::X, b: Vec3::Y };

    /// The frame of a surface point with a shading normal and a tangent, which need be neither perpendicular nor of
    /// length 1: J. Gram and E. Schmidt's `t = T − (N·T) N`, normalised. If the tangent vanishes or runs along the
    /// normal (the sine of their angle is below 10⁻⁴), the frame is made [from the normal](Self::from_normal) alone.
    #[must_use]
    pub fn new(n: Vec3, tangent: Vec3) -> Self {
        let across = tangent - n.dot(tangent) * n;
        let squared = across.length_squared();
        if squared > (1e-8 * tangent.length_squared()).max(1e-30) {
            let t = across / squared.sqrt();
            Self { n, t, b: n.cross(t) }
        } else {
            Self::from_normal(n)
        }
    }

    /// A frame around a normal alone, for surfaces without a preferred direction: the branchless
    /// basis of T. Duff et al. (2017), *Building an Orthonormal Basis, Revisited*.
    #[must_use]
    pub fn from_normal(n: Vec3) -> Self {
        let sign = if n.z >= 0.0 { 1.0 } else { -1.0 };
        let a = -1.0 / (sign + n.z);
        let c = n.x * n.y * a;
        Self {
            n,
            t: Vec3::new(1.0 + sign * n.x * n.x * a, sign * c, -sign * n.x),
            b: Vec3::new(c, sign + n.y * n.y * a, -n.y),
        }
    }

    /// The cosines `N·L` and `N·V`; `None` if the light or the viewer is not above the surface.
    #[must_use]
    #[inline]
    pub fn cosines(&self, l: Vec3, v: Vec3) -> Option<(f32, f32)> {
        let (cos_l, cos_v) = (self.n.dot(l), self.n.dot(v));
        if cos_l <= 0.0 || cos_v <= 0.0 { None } else { Some((cos_l, cos_v)) }
    }

    /// A direction in the room, in the local frame: components along tangent, bitangent and normal.
    #[must_use]
    pub fn to_local(&self, d: Vec3) -> Vec3 {
        Vec3::new(self.t.dot(d), self.b.dot(d), self.n.dot(d))
    }
}

/// The angles of four points from the x axis in radians, −π to π, to a relative error of 2e-7: faster than [`f32::atan2`].
/// At the origin 0. The polynomial is the one of its degree with the least relative error up to π/8.
#[must_use]
#[inline]
pub fn polar_angles(x: Vec4, y: Vec4) -> Vec4 {
    const WIDE: f32 = SQRT_2 - 1.0;
    const C: [f32; 4] = [-0.333_329_5, 0.199_777_04, -0.138_776_08, 0.080_534_756];
    let only = |condition, a: Vec4| Vec4::select(condition, a, Vec4::ZERO);
    let (a, b) = (x.abs(), y.abs());
    let (least, most) = (a.min(b), a.max(b));
    // Beyond π/8, the angle from the diagonal.
    let wide = least.cmpgt(WIDE * most);
    let t = (least - only(wide, most)) / (most + only(wide, least)).max(Vec4::splat(f32::MIN_POSITIVE));
    let s = t * t;
    let angle =
        t + t * s * (C[0] + C[1] * s + s * s * (C[2] + C[3] * s)) + only(wide, Vec4::splat(FRAC_PI_4));
    let angle = Vec4::select(a.cmplt(b), FRAC_PI_2 - angle, angle);
    let angle = Vec4::select(x.cmplt(Vec4::ZERO), PI - angle, angle);
    angle.copysign(y)
}

/// The unit vector with these spherical angles in degrees, in the local frame: the normal is +z, the tangent
/// +x. Calculated in 64 bits, so that 90° is not slightly above the surface.
#[must_use]
pub fn direction(theta: f64, phi: f64) -> Vec3 {
    let (sin_theta, cos_theta) = theta.to_radians().sin_cos();
    let (sin_phi, cos_phi) = phi.rem_euclid(360.0).to_radians().sin_cos();
    // cos 90° is not exactly zero in binary.
    let z = if theta == 90.0 { 0.0 } else { cos_theta };
    DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, z).as_vec3()
}

/// The mirror direction `R = 2(N·L)N − L` (law of reflection, T1: the angle of incidence equals the
/// angle of reflection).
#[must_use]
pub fn mirror(l: Vec3, n: Vec3) -> Vec3 {
    2.0 * n.dot(l) * n - l
}

/// The half vector `H = (L + V) / |L + V|` (J. Blinn 1977). For opposite vectors it does not exist, and the zero vector
/// is returned, for which every lobe is zero.
#[must_use]
pub fn half_vector(l: Vec3, v: Vec3) -> Vec3 {
    (l + v).normalize_or_zero()
}

/// The slope of the facet that mirrors `l` to `v`: `(H·T, H·B) / (H·N)`. The squared length is tan² θ_h. The
/// slope is calculated from `L + V` directly, since tan² θ_h from a cosine, 1/cos² θ_h − 1, would lose digits
/// near highlights. Finite for opposite vectors too.
#[must_use]
pub fn half_slope(l: Vec3, v: Vec3, frame: &Frame) -> Vec2 {
    let h = l + v;
    Vec2::new(h.dot(frame.t), h.dot(frame.b)) / h.dot(frame.n).max(1e-12)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn directions() -> impl Iterator<Item = Vec3> {
        (0..400).map(|i| {
            let z = 1.0 - (2.0 * i as f32 + 1.0) / 400.0;
            let r = (1.0 - z * z).max(0.0).sqrt();
            let phi = i as f32 * 2.399_963;
            Vec3::new(r * phi.cos(), r * phi.sin(), z)
        })
    }

    #[test]
    fn angle_of_incidence_equals_angle_of_reflection() {
        let n = Vec3::new(1.0, 2.0, -3.0).normalize();
        for l in directions() {
            let r = mirror(l, n);
            assert!((r.dot(n) - l.dot(n)).abs() < 1e-5);
            assert!((r.length() - 1.0).abs() < 1e-5);
            // In the plane of incidence.
            assert!(r.dot(n.cross(l)).abs() < 1e-5);
        }
    }

    #[test]
    fn half_vector_bisects_and_vanishes_for_opposite_directions() {
        let v = Vec3::new(0.2, -0.4, 0.8).normalize();
        for l in directions() {
            let h = half_vector(l, v);
            if h != Vec3::ZERO {
                assert!((h.dot(l) - h.dot(v)).abs() < 1e-4);
            }
        }
        assert_eq!(half_vector(v, -v), Vec3::ZERO);
    }

    #[test]
    fn frames_are_orthonormal_and_right_handed() {
        for n in directions().chain([Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::Y]) {
            let f = Frame::from_normal(n);
            for (a, b, expected) in
                [(f.t, f.t, 1.0), (f.b, f.b, 1.0), (f.t, f.n, 0.0), (f.b, f.n, 0.0), (f.t, f.b, 0.0)]
            {
                assert!((a.dot(b) - expected).abs() < 1e-5, "{n}: {f:?}");
            }
            assert!(f.n.cross(f.t).dot(f.b) > 0.999);
        }
    }

    #[test]
    fn a_frame_turns_its_tangent_onto_the_surface() {
        for (i, n) in directions().enumerate() {
            // Of any length, leaning towards the normal by any angle except the last 0.3°.
            let beside = Frame::from_normal(n).t;
            let lean = 1.57 * (i as f32 / 200.0 - 1.0);
            let f = Frame::new(n, 10f32.powi(i as i32 % 9 - 4) * (lean.cos() * beside + lean.sin() * n));
            assert!((f.t - beside).length() < 1e-3, "{n} {lean}: {f:?}");
            assert!((f.b - n.cross(beside)).length() < 1e-3 && f.n == n);
            assert!(f.t.dot(n).abs() < 1e-3 && (f.t.length() - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn without_a_tangent_the_frame_is_that_of_the_normal() {
        for n in directions() {
            for tangent in [Vec3::ZERO, n, -3.0 * n, 1e-20 * n, Vec3::splat(1e-25), Vec3::NAN, Vec3::INFINITY]
            {
                assert_eq!(Frame::new(n, tangent), Frame::from_normal(n), "{n} {tangent}");
            }
        }
        // A zero normal, as for a degenerate polygon: finite.
        let f = Frame::new(Vec3::ZERO, Vec3::X);
        assert!(f.t.is_finite() && f.b.is_finite());
    }

    #[test]
    fn polar_angles_are_those_of_the_standard_library_up_to_rounding() {
        for d in directions() {
            for size in [1e-30, 1e-6, 1.0, 1e6] {
                // Directions at all angles, and near the axes and diagonals.
                let (x, y) =
                    (size * Vec4::new(d.x, d.x, d.z, d.z + d.x), size * Vec4::new(d.y, 1e-6 * d.z, d.z, d.z));
                let found = polar_angles(x, y);
                for k in 0..4 {
                    let expected = f64::from(y[k]).atan2(f64::from(x[k]));
                    let error = (f64::from(found[k]) - expected).abs();
                    assert!(error <= 3e-7 * expected.abs(), "{} {}: {} {expected}", x[k], y[k], found[k]);
                }
            }
        }
        let axes = polar_angles(Vec4::new(0.0, 1.0, 0.0, -1.0), Vec4::new(0.0, 0.0, 1.0, 0.0));
        assert_eq!(axes, Vec4::new(0.0, 0.0, FRAC_PI_2, PI));
    }

    #[test]
    fn angles_become_unit_vectors_around_the_normal() {
        for (theta, phi, expected) in [
            (0.0, 77.0, Vec3::Z),
            (90.0, 0.0, Vec3::X),
            (90.0, 90.0, Vec3::Y),
            (90.0, -270.0, Vec3::Y),
            (180.0, 0.0, Vec3::NEG_Z),
        ] {
            assert!((direction(theta, phi) - expected).length() < 1e-6, "{theta} {phi}");
        }
        assert_eq!(direction(90.0, 33.0).z, 0.0);
    }
}
