//! Curves of models and of measured data.

use std::f32::consts::PI;

use glam::{DVec3, Vec3};

use super::{Curve, CurveError, Detail, Kind, Point, Setup, Subject, adaptive, subject};
use crate::{
    optics::{Frame, albedo::directional, geometry::direction},
    progress::Progress,
    reflection::Factor,
    text::listed,
};

/// The largest angle of the viewer, degrees: at 90° a direction is in the surface, and every BRDF is 0 by
/// definition.
pub(super) const GRAZING: f64 = 89.9;

/// The direction to the viewer in the plane of incidence, and its angles θ and φ; positive angles are on the side of the
/// mirror direction.
pub(super) fn viewer(angle: f64, phi_i: f64) -> (f64, f64) {
    if angle < 0.0 { (-angle, phi_i) } else { (angle, phi_i + 180.0) }
}

/// The direction from which the albedo is seen, with the cosine μ in 64 bits, as in `lcm albedo`.
fn albedo_view(angle: f64, phi: f64) -> Vec3 {
    let mu = angle.to_radians().cos();
    let sin = (1.0 - mu * mu).max(0.0).sqrt();
    let (y, x) = phi.rem_euclid(360.0).to_radians().sin_cos();
    DVec3::new(sin * x, sin * y, mu).as_vec3()
}

/// The angles of a range with equal steps, and some special ones up to grazing, in increasing order.
fn grid(from: i32, to: i32, step: usize, special: &[f64]) -> Vec<f64> {
    let even = (from..=to).step_by(step).map(f64::from);
    let special = special.iter().copied().filter(|a| (-GRAZING..=GRAZING).contains(a));
    let mut angles: Vec<_> = even.chain(special).collect();
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    angles
}

/// The curve of a kind: of measured paints the points, of everything else a line.
///
/// # Errors
/// Returns an error if the subject has no such curve, if the CPU cannot run the model, or if the user
/// cancels.
pub fn curve(
    subject: &Subject,
    setup: &Setup,
    detail: Detail,
    progress: &Progress,
) -> Result<Curve, CurveError> {
    subject.has(setup.kind)?;
    subject.runs()?;
    if let Some(id) = subject.paint() {
        return measured(subject, id, setup);
    }
    let Setup { kind, theta_i, phi_i } = *setup;
    let l = direction(theta_i, phi_i);
    let seen = |angle: f64| {
        let (theta, phi) = viewer(angle, phi_i);
        direction(theta, phi)
    };
    let value = |angle: f64| -> Vec3 {
        match kind {
            Kind::Brdf | Kind::Polar | Kind::Slice => subject.brdf(l, seen(angle)),
            Kind::BrdfCos => l.z * subject.brdf(l, seen(angle)),
            Kind::Response => PI * l.z * subject.brdf(l, seen(angle)),
            Kind::Albedo => {
                let v = albedo_view(angle, phi_i);
                directional(|l| subject.response(l, v), v, &Frame::LOCAL).as_vec3()
            }
            Kind::Fresnel => {
                let cos_d = direction(angle, 0.0).z;
                subject.factor(Factor::Fresnel { cos_d }).unwrap_or(Vec3::NAN)
            }
            Kind::Distribution => {
                let h = direction(angle, phi_i);
                subject.factor(Factor::Distribution { h }).unwrap_or(Vec3::NAN)
            }
            Kind::Masking => {
                let v = seen(angle);
                subject.factor(Factor::Masking { l, v }).unwrap_or(Vec3::NAN)
            }
        }
    };
    let around = |centre: f64| [-0.5, -0.05, 0.0, 0.05, 0.5].map(|step| centre + step);
    let fine = detail == Detail::Fine;
    let angles = match (kind, fine) {
        (Kind::Albedo, true) => grid(0, 88, 2, &[87.0, 88.5, 89.0, 89.5, GRAZING]),
        (Kind::Albedo, false) => grid(0, 84, 6, &[87.0, 89.0, GRAZING]),
        (Kind::Fresnel, _) => grid(0, 90, 2, &[]),
        (Kind::Distribution, _) => grid(0, 89, 1, &[0.05, 0.5, GRAZING]),
        _ => {
            // The positions of lobes: the mirror direction, the direction back to the light, the normal.
            let lobes = [theta_i, -theta_i, 0.0].into_iter().flat_map(around);
            grid(-88, 88, 2, &lobes.chain([-GRAZING, GRAZING]).collect::<Vec<_>>())
        }
    };
    let mut points = adaptive::at(&angles, &value, progress)?;
    if fine && kind != Kind::Albedo {
        points = adaptive::refined(points, &value, progress)?;
    }
    subject.runs()?;
    Ok(Curve { name: subject.name.clone(), points, measured: false })
}

/// The measured points of a paint.
fn measured(subject: &Subject, id: &str, setup: &Setup) -> Result<Curve, CurveError> {
    let name = subject.name.clone();
    let cos = setup.theta_i.to_radians().cos() as f32;
    let factor = match setup.kind {
        Kind::BrdfCos => cos,
        Kind::Response => PI * cos,
        _ => 1.0,
    };
    let points = subject::in_plane(id, setup.theta_i).map_err(|known| {
        let known: Vec<_> = known.iter().map(|angle| format!("{angle}°")).collect();
        CurveError::OtherLight {
            name: name.trim_end_matches(subject::MEASURED).to_owned(),
            known: listed(&known, "and"),
            asked: setup.theta_i,
        }
    })?;
    let points = points.into_iter().map(|(angle, f)| Point { angle, rgb: factor * f }).collect();
    Ok(Curve { name, points, measured: true })
}
