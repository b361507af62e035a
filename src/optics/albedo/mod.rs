//! Directional albedo: the fraction of uniform light that a surface sends towards the viewer,
//! `E(v) = ∫ f_r(l, v) cos θ_l dω_l = (1/π) ∫ response dω_l`, over the hemisphere above the surface.
//!
//! [`directional`] integrates one model for one view to [`ACCURACY`]; [`AlbedoCurve`] stores the result as a
//! function of the view, for pictures; [`LobeAlbedo`] covers a specular lobe alone, with a Fresnel factor of
//! 1, for compensation of multiple scattering. A [`NamedCurve`] stores any other curve that a model needs.
//!
//! Twin: `assets/shaders/optics/albedo.wgsl`, which reads the curves but does not calculate them.
//!
//! # Method
//!
//! The diffuse term is integrated over directions to the light in spherical coordinates, the specular term over half
//! vectors in spherical coordinates, `dω_l = 4 (v·h) dω_h`: these turn a lobe around the mirror direction into one
//! around the normal, however oblique the view. The half vectors that put the light above the surface reach, at the
//! azimuth φ from the plane of incidence, up to `θ_max = (π/2 + atan2(sin θ_v cos φ, cos θ_v))/2`; so `θ_h = θ_max t⁴`,
//! 0 ≤ t ≤ 1, meets the horizon exactly, and gives narrow lobes as much room as wide ones. Both domains are rectangles,
//! which are halved where the estimated error is largest, by the rule of degree 7 with an embedded one of degree 5 of
//! A. C. Genz, A. A. Malik (1980), *Remarks on Algorithm 006: An Adaptive Algorithm for Numerical Integration over an
//! N-dimensional Rectangular Region*. Responses are requested in batches, so that a GPU may answer; sums are in 64
//! bits.

use std::convert::Infallible;

use glam::{DVec3, Vec3};

use super::{Frame, Terms, lobes::Lobes, sequence::Sequence};
use cubature::{Plan, integrate};

mod cubature;
mod curve;
mod named;

pub use cubature::ACCURACY;
pub use curve::{AlbedoCurve, LobeAlbedo, NODES};
pub use named::{Albedos, Lines, NamedCurve, Spacing, lobe_albedos};

/// The directional albedos for views in the local frame (normal +z, tangent +x), each to [`ACCURACY`], of the model
/// behind `ask`, which returns the responses to pairs of directions, to the light and to the viewer, in a few large
/// batches. Zero for a viewer below the surface.
///
/// # Errors
/// Returns any error of `ask`.
pub fn directional_in_batches<E>(
    views: &[Vec3],
    mut ask: impl FnMut(&[(Vec3, Vec3)]) -> Result<Vec<Terms>, E>,
) -> Result<Vec<DVec3>, E> {
    let views: Vec<_> =
        views.iter().map(|v| (*v, Plan::accurate(f64::from(v.y).atan2(f64::from(v.x))))).collect();
    integrate(&views, |pairs, answers| {
        *answers = ask(pairs)?;
        Ok(())
    })
}

/// The directional albedo for one view, to [`ACCURACY`]: diffuse and specular response to uniform
/// light. Zero for a viewer below the surface.
#[must_use]
pub fn directional(response: impl Fn(Vec3) -> Terms, v: Vec3, frame: &Frame) -> DVec3 {
    let local = Vec3::new(v.dot(frame.t), v.dot(frame.b), v.dot(frame.n));
    let Ok(albedos) = directional_in_batches(&[local], |pairs| {
        let room = |l: Vec3| l.x * frame.t + l.y * frame.b + l.z * frame.n;
        Ok::<_, Infallible>(pairs.iter().map(|(l, _)| response(room(*l))).collect())
    });
    albedos[0]
}

/// The fraction of uniform light from below the surface that reaches the viewer: the mean of a transmitted response over
/// `count` samples of the lobes below the surface.
#[must_use]
pub fn through(
    transmitted: impl Fn(Vec3) -> Vec3,
    lobes: &Lobes,
    v: Vec3,
    frame: &Frame,
    count: u32,
) -> Vec3 {
    let (sequence, local, lobes) = (Sequence::new(0, 0), frame.to_local(v), lobes.below());
    let response = |i| {
        let l = lobes.sample(sequence.point(i), local);
        let pdf = lobes.pdf(l, local);
        if l.z >= 0.0 || pdf <= 0.0 {
            return DVec3::ZERO;
        }
        (transmitted(l.x * frame.t + l.y * frame.b + l.z * frame.n) / pdf).as_dvec3()
    };
    let sum: DVec3 = (0..count).map(response).sum();
    (sum / (std::f64::consts::PI * f64::from(count.max(1)))).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::albedo::cubature::ACCURACY;
    use std::f64::consts::PI;

    /// GGX with height-correlated Smith masking and F = 1 (B. Walter et al. 2007; E. Heitz 2014), in forms without
    /// cancellation.
    pub(super) fn ggx(alpha: f32, correlated: bool) -> impl Fn(Vec3, Vec3) -> f32 {
        move |l, v| {
            if l.z <= 0.0 || v.z <= 0.0 {
                return 0.0;
            }
            let h = (l + v).normalize();
            let tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
            let a2 = alpha * alpha;
            let d = a2 / (std::f32::consts::PI * h.z.powi(4) * (a2 + tan2).powi(2));
            let lambda = |w: Vec3| 0.5 * ((1.0 + a2 * (w.x * w.x + w.y * w.y) / (w.z * w.z)).sqrt() - 1.0);
            let g = if correlated {
                1.0 / (1.0 + lambda(l) + lambda(v))
            } else {
                1.0 / ((1.0 + lambda(l)) * (1.0 + lambda(v)))
            };
            std::f32::consts::PI * d * g / (4.0 * v.z)
        }
    }

    pub(super) fn specular(response: impl Fn(Vec3, Vec3) -> f32) -> impl Fn(Vec3, Vec3) -> Terms {
        move |l, v| Terms { specular: Vec3::splat(response(l, v)), ..Terms::default() }
    }

    pub(super) fn view(mu: f32) -> Vec3 {
        Vec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu)
    }

    pub(super) fn albedo(response: impl Fn(Vec3, Vec3) -> Terms, mu: f32) -> f64 {
        directional(|l| response(l, view(mu)), view(mu), &Frame::LOCAL).x
    }

    #[test]
    fn the_quadrature_gives_the_closed_forms() {
        let ln = |mu: f64| 1.0 - mu * (1.0 / mu).ln_1p();
        let mut twin = 0.0f64;
        for mu in [0.001, 0.02, 0.1, 0.5, 0.9, 1.0] {
            let m = f64::from(mu);
            let lambert = |l: Vec3, _: Vec3| Terms { diffuse: Vec3::splat(l.z), ..Terms::default() };
            assert!((albedo(lambert, mu) - 1.0).abs() < 3e-5);
            // GGX with α = 1 is the Lommel–Seeliger law.
            let correlated = albedo(specular(ggx(1.0, true)), mu);
            assert!((correlated - ln(m)).abs() < 3e-5, "{mu}: {correlated} {}", ln(m));
            let separable = albedo(specular(ggx(1.0, false)), mu);
            let expected = 2.0 * (1.0 - 2f64.ln()) / (1.0 + m);
            assert!((separable - expected).abs() < 3e-5, "{mu}: {separable} {expected}");
            twin = twin.max((separable - correlated).abs());
        }
        assert!(twin > 1e-2);
    }

    #[test]
    fn narrow_lobes_keep_what_they_hold() {
        // Powers of the cosine to the mirror direction, from the angle: the cosine itself has no digits left.
        let phong = |n: f64| {
            move |l: Vec3, v: Vec3| {
                let mirrored = v.as_dvec3() * DVec3::new(-1.0, -1.0, 1.0);
                let chord2 = (l.as_dvec3().normalize() - mirrored.normalize()).length_squared();
                let lobe = 0.5 * (n + 2.0) * (1.0 - 0.5 * chord2).max(0.0).powf(n);
                Terms { specular: Vec3::splat((lobe * f64::from(l.z)) as f32), ..Terms::default() }
            }
        };
        // As long as the horizon cuts nothing off, E = μ.
        for (n, mus) in [(1e3, &[0.3, 0.7, 1.0][..]), (1e5, &[0.02, 0.3, 1.0]), (1e6, &[0.01, 0.3, 0.8, 1.0])]
        {
            for &mu in mus {
                let e = albedo(phong(n), mu);
                assert!((e - f64::from(mu)).abs() < ACCURACY, "n {n} μ {mu}: {e}");
            }
        }
        // The exact normalisation of Blinn's lobe at normal incidence.
        for n in [16f64, 1e3, 1e6] {
            let norm = PI * (n + 2.0) * (n + 4.0) / (8.0 * PI * ((-0.5 * n).exp2() + n));
            let blinn = |l: Vec3, v: Vec3| {
                let h = (l.as_dvec3() + v.as_dvec3()).normalize();
                let power = (-0.5 * n * ((h.x * h.x + h.y * h.y) / (h.z * h.z)).ln_1p()).exp();
                Terms { specular: Vec3::splat((norm * power * f64::from(l.z)) as f32), ..Terms::default() }
            };
            let e = albedo(blinn, 1.0);
            assert!((e - 1.0).abs() < ACCURACY, "n {n}: {e}");
        }
    }

    #[test]
    fn the_smallest_roughness_loses_nothing_but_at_grazing_angles() {
        // B. Walter's lobe at α = 0.001: 1 − E is about α² / μ² and beyond.
        for (mu, at_least) in [(0.1, 0.9999), (0.5, 0.9999), (1.0, 0.9999)] {
            let e = albedo(specular(ggx(1e-3, true)), mu);
            assert!((at_least..=1.0 + ACCURACY).contains(&e), "{mu}: {e}");
        }
    }

    #[test]
    fn ridges_of_anisotropic_lobes_are_found_wherever_they_lie() {
        // A Gaussian of the slopes of facets, D, and the response π D cos θ_h / (4 v·h): the integral is
        // that of D cos θ_h over half vectors, which is 1.
        for (a, b) in [(0.2, 0.2), (0.3, 0.01), (0.003, 0.4), (0.001, 0.1)] {
            let response = |l: Vec3, v: Vec3| {
                let (l, v) = (l.as_dvec3(), v.as_dvec3());
                let h = (l + v).normalize();
                let slopes = (h.x / (h.z * a)).powi(2) + (h.y / (h.z * b)).powi(2);
                let d = (-slopes).exp() / (PI * a * b * h.z.powi(4));
                let jacobian = 4.0 * h.dot(v);
                Terms { specular: Vec3::splat((PI * d * h.z / jacobian) as f32), ..Terms::default() }
            };
            let e = albedo(response, 1.0);
            // The part beyond the horizon: slopes above 1.
            let horizon = (-1.0 / (a.max(b) * a.max(b))).exp();
            assert!((e - 1.0).abs() < ACCURACY + horizon, "{a} {b}: {e}");
        }
    }

    #[test]
    fn a_view_from_below_sees_nothing_and_every_frame_the_same() {
        let response = specular(ggx(0.3, true));
        assert_eq!(directional(|_| Terms::default(), Vec3::NEG_Z, &Frame::LOCAL), DVec3::ZERO);
        let v = Vec3::new(0.48, 0.6, 0.64);
        let turned = Frame::from_normal(Vec3::new(0.36, -0.48, 0.8));
        let local = |w: Vec3| Vec3::new(w.dot(turned.t), w.dot(turned.b), w.dot(turned.n));
        let room = |w: Vec3| w.x * turned.t + w.y * turned.b + w.z * turned.n;
        let e = directional(|l| response(local(l), local(room(v))), room(v), &turned);
        let straight = directional(|l| response(l, v), v, &Frame::LOCAL);
        assert!((e - straight).abs().max_element() < 1e-5);
    }
}
