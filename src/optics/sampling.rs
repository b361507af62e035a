//! Random directions, and their probability densities per solid angle.

use std::f32::consts::PI;

use glam::{Vec2, Vec3};

use super::geometry::Frame;

/// The angle of a cosine in [−1, 1], in radians: M. Abramowitz, I. Stegun (1964), *Handbook of Mathematical
/// Functions*, 4.4.46, with an error of at most 2e-8 before rounding. The shaders use the same polynomial, as
/// the functions of drivers are less accurate.
#[must_use]
pub fn arc_cosine(cosine: f32) -> f32 {
    const BY_POWER: [f32; 8] = [
        std::f32::consts::FRAC_PI_2,
        -0.214_598_8,
        0.088_978_99,
        -0.050_174_3,
        0.030_891_88,
        -0.017_088_126,
        0.006_670_09,
        -0.001_262_491_1,
    ];
    let c = cosine.abs().min(1.0);
    let angle = (1.0 - c).sqrt() * BY_POWER.iter().rev().fold(0.0, |sum, a| sum * c + a);
    if cosine < 0.0 { PI - angle } else { angle }
}

/// Maps a point of the unit square to the unit disc, with constant density: P. Shirley, K. Chiu (1997), *A
/// Low Distortion Map Between Disk and Square*.
#[must_use]
pub fn disc(u: Vec2) -> Vec2 {
    let [a, b] = (2.0 * u - Vec2::ONE).to_array();
    let (radius, angle) = if a.abs() > b.abs() {
        (a, 0.25 * PI * (b / a))
    } else if b != 0.0 {
        (b, 0.5 * PI - 0.25 * PI * (a / b))
    } else {
        return Vec2::ZERO;
    };
    radius * Vec2::new(angle.cos(), angle.sin())
}

/// A direction about z with the density `cos θ / π`: a point of the disc, projected up to the hemisphere (N.
/// Malley).
#[must_use]
pub fn cosine(u: Vec2) -> Vec3 {
    let d = disc(u);
    d.extend((1.0 - d.length_squared()).max(0.0).sqrt())
}

/// A direction within a cone about z, with constant density; `rise` is 1 minus the cosine of the cone's half
/// angle, so that small cones keep their digits. The density is `1 / (2π · rise)`.
#[must_use]
pub fn cone(u: Vec2, rise: f32) -> Vec3 {
    let down = u.x * rise;
    let sine = (down * (2.0 - down)).max(0.0).sqrt();
    let phi = 2.0 * PI * u.y;
    Vec3::new(sine * phi.cos(), sine * phi.sin(), 1.0 - down)
}

/// A direction in the frame about a unit vector.
#[must_use]
pub fn about(axis: Vec3, local: Vec3) -> Vec3 {
    let frame = Frame::from_normal(axis);
    local.x * frame.t + local.y * frame.b + local.z * axis
}

/// A direction on the whole sphere, with the density `1 / 4π`.
#[must_use]
pub fn sphere(u: Vec2) -> Vec3 {
    cone(u, 2.0)
}

/// A rectangle seen from a point, for sampling by solid angle: C. Ureña, M. Fajardo, A. King (2013), *An
/// Area-Preserving Parametrization for Spherical Rectangles*. If it covers little of the sphere, the
/// differences of angles lose digits, and its area is sampled instead.
#[derive(Clone, Copy, Debug)]
pub struct SphericalRectangle {
    x: Vec3,
    y: Vec3,
    z: Vec3,
    /// The corner with the smallest x and y, and the opposite one, in the frame of the rectangle relative to
    /// the point.
    low: Vec2,
    high: Vec2,
    depth: f32,
    b0: f32,
    b1: f32,
    k: f32,
    /// Solid angle; zero if the area is sampled.
    solid_angle: f32,
}

/// Solid angle below which rectangles are sampled by area.
const SMALLEST: f32 = 0.02;

impl SphericalRectangle {
    /// A rectangle with its centre relative to the point, unit vectors along its sides, and half their
    /// lengths.
    #[must_use]
    pub fn new(middle: Vec3, [x, y]: [Vec3; 2], half: Vec2) -> Self {
        let mut z = x.cross(y);
        let at = Vec2::new(middle.dot(x), middle.dot(y));
        let mut depth = middle.dot(z);
        // The rectangle is at a negative depth.
        if depth > 0.0 {
            (z, depth) = (-z, -depth);
        }
        let (low, high) = (at - half, at + half);
        // The z of the normals of the planes through the point and a side: bottom, right, top and left.
        let slope = |along: f32| along / (depth * depth + along * along).sqrt();
        let [n0, n1, n2, n3] = [-slope(low.y), slope(high.x), slope(high.y), -slope(low.x)];
        let corner = |a: f32, b: f32| arc_cosine(-a * b);
        let (g0, g1, g2, g3) = (corner(n0, n1), corner(n1, n2), corner(n2, n3), corner(n3, n0));
        let k = 2.0 * PI - g2 - g3;
        let solid_angle = g0 + g1 - k;
        let by_area = solid_angle.is_nan() || solid_angle <= SMALLEST || -depth < 1e-6;
        Self {
            x,
            y,
            z,
            low,
            high,
            depth,
            b0: n0,
            b1: n2,
            k,
            solid_angle: if by_area { 0.0 } else { solid_angle },
        }
    }

    /// The point of the rectangle, relative to the observer, for a point of the unit square.
    #[must_use]
    pub fn sample(&self, u: Vec2) -> Vec3 {
        let (x, y) = if self.solid_angle == 0.0 {
            (self.low.x + u.x * (self.high.x - self.low.x), self.low.y + u.y * (self.high.y - self.low.y))
        } else {
            self.by_solid_angle(u)
        };
        self.x * x + self.y * y + self.z * self.depth
    }

    fn by_solid_angle(&self, u: Vec2) -> (f32, f32) {
        let angle = u.x * self.solid_angle + self.k;
        let f = (angle.cos() * self.b0 - self.b1) / angle.sin();
        let c = 1.0 / (f * f + self.b0 * self.b0).sqrt();
        let c = (if f > 0.0 { c } else { -c }).clamp(-1.0, 1.0);
        let x = -(c * self.depth) / ((1.0 - c) * (1.0 + c)).max(1e-12).sqrt();
        let x = x.clamp(self.low.x, self.high.x);
        let squared = x * x + self.depth * self.depth;
        let [h0, h1] = [self.low.y, self.high.y].map(|y| y / (squared + y * y).sqrt());
        let h = h0 + u.y * (h1 - h0);
        let y = h * (squared / ((1.0 - h) * (1.0 + h)).max(1e-12)).sqrt();
        (x, y.clamp(self.low.y, self.high.y))
    }

    /// The density per solid angle at a point of the rectangle, relative to the observer.
    #[must_use]
    pub fn pdf(&self, at: Vec3) -> f32 {
        if self.solid_angle > 0.0 {
            return 1.0 / self.solid_angle;
        }
        let sides = self.high - self.low;
        area_pdf(at, self.z, sides.x * sides.y)
    }
}

/// The density per solid angle for a point of a surface that is sampled by area, as seen from elsewhere: `d²
/// / (A cos θ)`; zero where the surface is seen edge-on.
#[must_use]
pub fn area_pdf(at: Vec3, normal: Vec3, area: f32) -> f32 {
    let squared = at.length_squared();
    let facing = at.dot(normal).abs() * area;
    // d³ / (A |at · n|)
    if facing > 1e-12 * squared { squared * squared.sqrt() / facing } else { 0.0 }
}

/// The weight of a direction chosen by one of two sampling techniques: the power heuristic, E. Veach, L.
/// Guibas (1995), *Optimally Combining Sampling Techniques for Monte Carlo Rendering*. Zero if the technique
/// cannot choose it.
#[must_use]
pub fn power_heuristic(own: f32, other: f32) -> f32 {
    // Divided first, since squares of large densities overflow.
    if own <= 0.0 {
        return 0.0;
    }
    let ratio = other / own;
    1.0 / (1.0 + ratio * ratio)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::sequence::Sequence;

    #[test]
    fn the_angle_of_a_cosine_is_right_to_seven_digits() {
        for i in -1000..=1000 {
            let c = f64::from(i) / 1000.0;
            assert!((f64::from(arc_cosine(c as f32)) - c.acos()).abs() < 5e-7, "{c}");
        }
    }

    /// The mean of a function over a sequence of samples.
    fn mean(count: u32, f: impl Fn(Vec2) -> f64) -> f64 {
        let sequence = Sequence::new(3, 1);
        (0..count).map(|i| f(sequence.point(i))).sum::<f64>() / f64::from(count)
    }

    #[test]
    fn directions_have_the_moments_of_their_densities() {
        // ∫ z · cos θ / π dω over the hemisphere is 2/3, ∫ z over a cone of height h is 1 − h/2.
        assert!((mean(4096, |u| f64::from(cosine(u).z)) - 2.0 / 3.0).abs() < 1e-3);
        assert!((mean(4096, |u| f64::from(cone(u, 0.3).z)) - 0.85).abs() < 1e-4);
        assert!(mean(4096, |u| f64::from(sphere(u).z)).abs() < 1e-3);
        assert!((mean(4096, |u| f64::from(sphere(u).z).powi(2)) - 1.0 / 3.0).abs() < 1e-3);
        for u in [Vec2::ZERO, Vec2::new(0.999_999, 0.0), Vec2::splat(0.5), Vec2::new(0.25, 0.75)] {
            for d in [cosine(u), cone(u, 1e-6), cone(u, 2.0), about(Vec3::NEG_Z, cosine(u))] {
                assert!((d.length() - 1.0).abs() < 1e-6, "{u} {d}");
            }
        }
        assert!((cosine(Vec2::splat(0.5)).z - 1.0).abs() < 1e-6 && about(Vec3::X, Vec3::Z) == Vec3::X);
    }

    /// The solid angle of a rectangle by Oosterom's formula for its two triangles, in double precision.
    fn solid_angle(corners: [Vec3; 4]) -> f64 {
        let [a, b, c, d] = corners.map(|p| p.as_dvec3());
        let triangle = |a: glam::DVec3, b: glam::DVec3, c: glam::DVec3| {
            let (la, lb, lc) = (a.length(), b.length(), c.length());
            let under = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
            2.0 * a.dot(b.cross(c)).abs().atan2(under)
        };
        triangle(a, b, c) + triangle(a, c, d)
    }

    #[test]
    fn rectangles_have_their_solid_angle_and_lamberts_irradiance() {
        let rectangles = [
            (Vec3::new(0.5, 0.2, 1.5), Vec3::X, Vec3::Y, Vec2::new(0.6, 0.3)),
            (Vec3::new(-2.0, 0.0, 1.0), Vec3::Y, Vec3::Z, Vec2::new(1.0, 0.5)),
            (Vec3::new(0.0, 0.0, -0.01), Vec3::X, Vec3::Y, Vec2::new(3.0, 2.0)),
            (Vec3::new(5.0, 30.0, 4.0), Vec3::X, Vec3::Z, Vec2::new(0.5, 0.5)),
        ];
        for (middle, x, y, half) in rectangles {
            let seen = SphericalRectangle::new(middle, [x, y], half);
            let corner = |a: f32, b: f32| middle + x * half.x * a + y * half.y * b;
            let corners = [corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
            let exact = solid_angle(corners);
            let count = 1 << 14;
            let by_samples = mean(count, |u| 1.0 / f64::from(seen.pdf(seen.sample(u))));
            assert!((by_samples / exact - 1.0).abs() < 1e-3, "{middle}: {by_samples} {exact}");
            // The vector irradiance of a polygon, J. Lambert (1760): ½ Σ angle of an edge · normal of its plane.
            let mut lambert = glam::DVec3::ZERO;
            for i in 0..4 {
                let [a, b] = [corners[i], corners[(i + 1) % 4]].map(|p| p.as_dvec3().normalize());
                let across = a.cross(b);
                lambert += 0.5 * a.dot(b).clamp(-1.0, 1.0).acos() * across.normalize();
            }
            for axis in [Vec3::X, Vec3::Y, Vec3::Z] {
                let exact = lambert.dot(axis.as_dvec3());
                let by_samples = mean(count, |u| {
                    let at = seen.sample(u);
                    f64::from(at.normalize().dot(axis)) / f64::from(seen.pdf(at))
                });
                let same = (by_samples.abs() - exact.abs()).abs();
                assert!(same < 2e-3 * exact.abs().max(0.1), "{middle} {axis}: {by_samples} {exact}");
            }
            // The wrong twin: all points equally likely by area.
            if exact > 0.1 {
                let area = 4.0 * half.x * half.y;
                let wrong = mean(count, |u| {
                    let at = middle + x * half.x * (2.0 * u.x - 1.0) + y * half.y * (2.0 * u.y - 1.0);
                    1.0 / f64::from(seen.pdf(at)) * f64::from(at.normalize().z)
                });
                let right =
                    mean(count, |u| f64::from(seen.sample(u).normalize().z / seen.pdf(seen.sample(u))));
                assert!((wrong / right - 1.0).abs() > 5e-3, "{middle}: {wrong} {right} {area}");
            }
        }
    }

    #[test]
    fn a_rectangle_from_its_own_plane_gives_no_infinity() {
        for depth in [0.0, 1e-30, 1e-7] {
            let seen =
                SphericalRectangle::new(Vec3::new(0.0, 0.0, depth), [Vec3::X, Vec3::Y], Vec2::new(1.0, 2.0));
            for u in [Vec2::ZERO, Vec2::splat(0.5), Vec2::new(0.3, 0.999)] {
                let at = seen.sample(u);
                assert!(at.is_finite() && seen.pdf(at).is_finite(), "{depth} {u}");
            }
        }
        assert_eq!(area_pdf(Vec3::X, Vec3::Z, 1.0), 0.0);
        assert_eq!(area_pdf(Vec3::ZERO, Vec3::Z, 1.0), 0.0);
    }

    #[test]
    fn the_weights_of_both_ways_add_up_to_one() {
        for (a, b) in [(1.0, 2.0), (1e30, 1e-3), (5.0, 5.0), (1e-30, 1e30)] {
            assert!((power_heuristic(a, b) + power_heuristic(b, a) - 1.0).abs() < 1e-6);
        }
        assert_eq!(power_heuristic(0.0, 1.0), 0.0);
        assert_eq!(power_heuristic(1.0, 0.0), 1.0);
        assert_eq!(power_heuristic(f32::MIN_POSITIVE, f32::MAX), 0.0);
    }
}
