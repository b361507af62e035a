//! Measured paints: their samples, the fits to them, plots in the plane of incidence.

use maud::Markup;

use super::contestant::Contestant;
use crate::{
    curves::{
        data::{self, LARGEST_ANGLE, Measurement, PAINTS},
        draw::{Axis, Line, Mark},
    },
    optics::geometry::direction,
    study::{
        Lab, StudyError, Table,
        fit::{self, Fit, Sample},
        fixed, grid, plot, series, stack,
        text::{Values, values},
    },
};

/// Angles of the light in the plots of paints, in degrees.
const INCIDENCES: [f32; 2] = [40.0, 60.0];

/// Measured values in one band as samples for fitting; non-positive values are skipped.
fn samples(paint: &[Measurement], band: usize, keep: impl Fn(&Measurement) -> bool) -> Vec<Sample> {
    paint
        .iter()
        .filter(|m| keep(m) && m.f[band] > 0.0)
        .map(|m| Sample {
            l: direction(m.theta_i.into(), m.phi_i.into()),
            v: direction(m.theta_o.into(), (m.phi_i + m.delta_phi).into()),
            value: m.f[band],
        })
        .collect()
}

/// The samples of a paint for the fits: in its brightest band, away from grazing angles, and with an angle of
/// the light accepted by `keep`.
pub(in crate::study) fn paint_samples(
    id: &str,
    keep: impl Fn(f32) -> bool,
) -> Result<Vec<Sample>, StudyError> {
    let all = data::paint(id);
    let good = |m: &Measurement| m.theta_i <= LARGEST_ANGLE && m.theta_o <= LARGEST_ANGLE && keep(m.theta_i);
    let samples = samples(&all, data::brightest(&all), good);
    if samples.is_empty() { Err(StudyError::Data(format!("there is no paint {id}"))) } else { Ok(samples) }
}

/// Fits of all distributions and of a matte surface to a paint.
fn paint_errors(lab: &Lab, id: &str) -> Result<Vec<(&'static str, Fit)>, StudyError> {
    let samples = paint_samples(id, |_| true)?;
    let values: Vec<f64> = samples.iter().map(|s| s.value).collect();
    let mut fits = vec![("Lambert", fit::diffuse_only(&values))];
    for contestant in Contestant::all().into_iter().chain(Contestant::distributions()) {
        contestant.check(lab)?;
        fits.push((contestant.name, contestant.fit(lab.registry, &samples)));
    }
    Ok(fits)
}

/// The fits to the paints, in the order of [`PAINTS`]: model and fit.
pub(super) struct Paints(Vec<Vec<(&'static str, Fit)>>);

impl Paints {
    /// Fits all models to all paints.
    pub(super) fn fit(lab: &Lab) -> Result<Self, StudyError> {
        PAINTS.iter().map(|(id, _)| paint_errors(lab, id)).collect::<Result<_, _>>().map(Self)
    }

    /// The log error of a model for a paint.
    pub(super) fn error(&self, paint: usize, model: &str) -> f64 {
        self.0[paint].iter().find(|f| f.0 == model).map_or(f64::NAN, |f| f.1.error)
    }

    /// The numbers of the fits.
    pub(super) fn raw(&self) -> Table {
        let mut raw = Table::new("lobe_paints", "paint,model,diffuse,specular,width,log_error");
        for ((_, name), fits) in PAINTS.iter().zip(&self.0) {
            for (model, f) in fits {
                raw.row(&[name, model], &[f.diffuse, f.specular, f.width, f.error]);
            }
        }
        raw
    }

    /// The table of the fits, and the plots and errors of the two glossy paints.
    pub(super) fn values(&self, lab: &Lab) -> Result<Values, StudyError> {
        Ok(values! {
            paints: self.table(), krylon: plots(lab, 0)?, garnet: plots(lab, 1)?,
            krylon_errors: self.errors_by_incidence(lab, 0)?, garnet_errors: self.errors_by_incidence(lab, 1)?,
        })
    }

    fn table(&self) -> Markup {
        let row = |i: usize| {
            // The first row is Lambert, which has no lobe.
            let mut row = vec![self.0[0][i].0.to_owned(), if i == 0 { "1" } else { "3" }.to_owned()];
            row.extend(self.0.iter().map(|p| fixed(p[i].1.error, 3)));
            row.extend(self.0.iter().map(|p| if i == 0 { "–".to_owned() } else { fixed(p[i].1.width, 3) }));
            row
        };
        let rows: Vec<Vec<String>> = (0..self.0[0].len()).map(row).collect();
        let paints = ["Krylon blue", "Garnet red", "Acryl blue", "α Krylon", "α Garnet", "α Acryl"];
        grid(&[&["Model", "free numbers"][..], &paints].concat(), &rows)
    }

    /// The errors in the table for one angle of the light.
    fn error_at(&self, lab: &Lab, paint: usize, model: &str, theta: f32) -> Result<f64, StudyError> {
        let samples = paint_samples(PAINTS[paint].0, |t| (t - theta).abs() < 0.5)?;
        let fit = self.0[paint].iter().find(|f| f.0 == model);
        let contestant = Contestant::all().into_iter().find(|c| c.name == model);
        Ok(contestant.zip(fit).map_or(f64::NAN, |(c, fit)| c.error(lab.registry, &fit.1, &samples)))
    }

    /// The errors of three models at each angle of the light, as part of a sentence.
    fn errors_by_incidence(&self, lab: &Lab, paint: usize) -> Result<String, StudyError> {
        let mut parts = Vec::new();
        for theta in INCIDENCES {
            let error = |model| self.error_at(lab, paint, model, theta).map(|error| fixed(error, 3));
            let (blinn, cook, ggx) = (error("Blinn–Phong")?, error("Cook–Torrance")?, error("GGX")?);
            let all = format!("{blinn} for Blinn–Phong, {cook} for Cook–Torrance and {ggx} for GGX");
            parts.push(format!("{all} with light at {theta}°"));
        }
        Ok(parts.join("; "))
    }
}

/// The plots of a paint, one for each angle of the light.
fn plots(lab: &Lab, paint: usize) -> Result<Markup, StudyError> {
    let (id, name) = PAINTS[paint];
    let plot = |theta: f32| Ok((format!("light at {theta}°"), paint_plot(lab, id, name, theta)?));
    let plots = INCIDENCES.into_iter().map(plot).collect::<Result<Vec<_>, StudyError>>()?;
    Ok(stack(&plots))
}

/// The plot of a paint in the plane of incidence, with the fits.
fn paint_plot(lab: &Lab, id: &str, name: &str, theta_i: f32) -> Result<Markup, StudyError> {
    let all = data::paint(id);
    let band = data::brightest(&all);
    let samples = paint_samples(id, |_| true)?;
    let mut measured: Vec<(f64, f64)> = all
        .iter()
        .filter(|m| (m.theta_i - theta_i).abs() < 0.5 && m.theta_o <= LARGEST_ANGLE && m.f[band] > 0.0)
        .filter_map(|m| Some((f64::from(m.in_plane()?), m.f[band])))
        .collect();
    measured.sort_by(|a, b| a.0.total_cmp(&b.0));
    let dense: Vec<Sample> = (-71..=71)
        .map(|a: i16| {
            let (theta, phi) = if a < 0 { (-f64::from(a), 0.0) } else { (f64::from(a), 180.0) };
            Sample { l: direction(theta_i.into(), 0.0), v: direction(theta, phi), value: 1.0 }
        })
        .collect();
    let top = measured.iter().map(|p| p.1).fold(0.1, f64::max);
    let mut lines = vec![series("measured", measured, (6, Line::None, Mark::Ring))];
    for c in Contestant::all() {
        let found = c.fit(lab.registry, &samples);
        let predicted = c.predict(lab.registry, &c.settings, &found, &dense);
        let points = (-71..=71).map(f64::from).zip(predicted).collect();
        lines.push(series(c.name, points, (c.style.0, c.style.1, Mark::None)));
    }
    Ok(plot(
        &format!("BRDF of {name} in the plane of incidence, light at {theta_i} degrees"),
        Axis::new("angle of the viewer (°), mirror side positive", -75.0, 75.0, 7),
        Axis::log("f (sr⁻¹)", 0.01, 10f64.powf((top * 1.5).log10().ceil())),
        360,
        lines,
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{registry::Registry, study::Settings};

    #[test]
    fn non_positive_values_have_no_logarithm() {
        let all = data::paint("krylon_blue");
        let kept = samples(&all, 0, |_| true);
        assert!(!kept.is_empty() && kept.iter().all(|s| s.value > 0.0));
    }

    /// Errors found by another program with another method (a general least-squares solver).
    #[test]
    fn the_paints_have_the_shape_that_others_found() {
        let registry = Registry::builtin();
        let lab = Lab { registry: &registry, settings: Settings::default(), figures: 0, tables: 0 };
        let cases = [
            (
                "krylon_blue",
                [
                    ("GGX distribution", 0.060),
                    ("Blinn’s distribution", 0.090),
                    ("Beckmann’s distribution", 0.092),
                    ("Lambert", 0.366),
                ],
                0.005,
            ),
            (
                "garnet_red",
                [
                    ("GGX distribution", 0.147),
                    ("Blinn’s distribution", 0.173),
                    ("Beckmann’s distribution", 0.181),
                    ("Lambert", 0.547),
                ],
                0.025,
            ),
        ];
        for (paint, expected, tolerance) in cases {
            let fits = paint_errors(&lab, paint).expect("can be fitted");
            let error = |name: &str| fits.iter().find(|f| f.0 == name).map_or(f64::NAN, |f| f.1.error);
            for (name, expected) in expected {
                assert!((error(name) - expected).abs() < tolerance, "{paint}, {name}: {}", error(name));
            }
            // In this order, with a margin.
            for pair in expected.windows(2) {
                assert!(error(pair[0].0) < error(pair[1].0), "{paint}: {pair:?}");
            }
            assert!(error("GGX distribution") < 0.85 * error("Blinn’s distribution"), "{paint}");
        }
    }
}
