//! Curves of models and of measured data.

use super::{
    Curve, CurveError, Detail, Kind, Point, Setup, Subject, adaptive, angles::behind, kind, subject,
};
use crate::{
    optics::colour::Encoding, parameter::Values, progress::Progress, reflection::ModelEntry,
    registry::Registry, text::listed,
};

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
    let declared = setup.kind.declaration();
    let value = |angle: f64| (declared.value)(subject, setup, angle);
    let fine = detail == Detail::Fine;
    let above = (declared.angles)(setup.theta_i, fine);
    let [left, right] = if declared.is_around && subject.transmits() {
        behind(&ways(subject, setup.theta_i))
    } else {
        [vec![], vec![]]
    };
    let mut points = Vec::new();
    // Each side by itself: in the surface there are no values.
    for angles in [left, above, right] {
        let mut side = adaptive::at(&angles, &value, progress)?;
        if fine && declared.is_refined {
            side = adaptive::refined(side, &value, progress)?;
        }
        points.append(&mut side);
    }
    subject.runs()?;
    let sharp = declared.has_light && subject.is_sharp();
    let reflected = declared.is_reflected && subject.transmits();
    let sigma = uncertainties(subject, setup, &points);
    Ok(Curve { name: subject.name.clone(), points, sigma, measured: false, sharp, reflected })
}

/// The standard uncertainties of points of a measured surface, where its quantity follows from single values.
fn uncertainties(subject: &Subject, setup: &Setup, points: &[Point]) -> Vec<f64> {
    let Some(of) = setup.kind.declaration().of_measured else { return Vec::new() };
    let l = kind::light(setup);
    let sigma = |point: &Point| subject.uncertainty(l, kind::seen(setup, point.angle));
    let all: Option<Vec<_>> = points.iter().map(sigma).collect();
    all.unwrap_or_default().into_iter().map(|sigma| f64::from(sigma * of(l.z))).collect()
}

/// The angles to the normal behind a surface at which light from an angle goes on: straight, and bent; and 0.
fn ways(subject: &Subject, theta_i: f64) -> Vec<f64> {
    let bent = subject.refractive_index().map(|n| theta_i.to_radians().sin() / f64::from(n));
    let bent = bent.filter(|sine| *sine < 1.0).map(|sine| sine.asin().to_degrees());
    [theta_i, 0.0].into_iter().chain(bent).collect()
}

impl Subject {
    /// Fails if the subject has no curve of this kind.
    ///
    /// # Errors
    /// Returns the reason.
    pub fn has(&self, kind: Kind) -> Result<(), CurveError> {
        let declared = kind.declaration();
        let name = self.name.trim_end_matches(subject::MEASURED).to_owned();
        match declared.factor {
            Some(factor) if self.factor(factor).is_none() => {
                Err(CurveError::NoFactor { name, what: kind.name() })
            }
            None if self.paint().is_some() && declared.of_measured.is_none() => {
                Err(CurveError::NotMeasured { name, what: kind.name() })
            }
            _ => Ok(()),
        }
    }
}

/// The ids of the models that have curves of this kind.
#[must_use]
pub fn subjects_with(kind: Kind, registry: &Registry) -> Vec<&'static str> {
    let has =
        |entry: &&ModelEntry| Subject::model(entry, &Values::default(), Encoding::Srgb).has(kind).is_ok();
    registry.models().iter().filter(has).map(|entry| entry.declaration.id).collect()
}

/// The measured points of a paint.
fn measured(subject: &Subject, id: &str, setup: &Setup) -> Result<Curve, CurveError> {
    let name = subject.name.clone();
    let cos = setup.theta_i.to_radians().cos() as f32;
    let factor = setup.kind.declaration().of_measured.map_or(1.0, |of| of(cos));
    let points = subject::in_plane(id, setup.theta_i).map_err(|known| {
        let known: Vec<_> = known.iter().map(|angle| format!("{angle}°")).collect();
        CurveError::OtherLight {
            name: name.trim_end_matches(subject::MEASURED).to_owned(),
            known: listed(&known, "and"),
            asked: setup.theta_i,
        }
    })?;
    let points = points.into_iter().map(|(angle, f)| Point { angle, rgb: factor * f }).collect();
    Ok(Curve { name, points, sigma: Vec::new(), measured: true, sharp: false, reflected: false })
}
