//! Materials of the MERL database: the fits to them, a table, a chart by material, and the lobes of four of them.

use maud::{Markup, html};
use rayon::prelude::*;

use super::contestant::{Contestant, Found};
use crate::{
    curves::{
        data::{LARGEST_ANGLE, Sgd},
        draw::{Axis, Line, Mark, Plot},
    },
    matching,
    optics::geometry::direction,
    registry::Registry,
    study::{
        Lab, Table,
        fit::{self, Sample},
        fixed, grid, plot, series, svg,
        text::{Values, values},
    },
};

/// Distance from a constant below which a material has no lobe.
const MATTE: f64 = 0.01;
/// Materials whose lobes are shown.
const SHOWN: [&str; 4] = ["gold-metallic-paint", "alum-bronze", "red-plastic", "blue-acrylic"];

/// Directions for the fits of MERL materials, dense around the mirror direction like the database.
fn merl_directions() -> Vec<Sample> {
    let pairs = matching::directions(0.0, LARGEST_ANGLE.into());
    pairs.into_iter().map(|(l, v)| Sample { l, v, value: 1.0 }).collect()
}

/// The fits of all contestants to a material.
pub(super) struct MerlFit {
    pub(super) name: &'static str,
    /// One per contestant.
    pub(super) fits: Vec<Found>,
    /// The error of a matte surface.
    matte: f64,
}

impl MerlFit {
    /// The log error of a contestant.
    pub(super) fn error(&self, i: usize) -> f64 {
        self.fits[i].fit.error
    }
}

fn merl_fit(
    material: &Sgd,
    directions: &[Sample],
    contestants: &[Contestant],
    registry: &Registry,
) -> MerlFit {
    let samples: Vec<Sample> = directions
        .iter()
        .map(|s| Sample { value: material.luminance(s.l, s.v), ..*s })
        .filter(|s| s.value > 0.0 && s.value.is_finite())
        .collect();
    let values: Vec<f64> = samples.iter().map(|s| s.value).collect();
    let fits = contestants.iter().map(|c| c.fit_freely(registry, &samples)).collect();
    MerlFit { name: material.name, fits, matte: fit::diffuse_only(&values).error }
}

pub(in crate::study) fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    match all.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => all[n / 2],
        n => 0.5 * (all[n / 2 - 1] + all[n / 2]),
    }
}

/// The fits to the materials, sorted by the error of the last contestant, GGX.
pub(super) struct Merl {
    pub(super) contestants: Vec<Contestant>,
    pub(super) fits: Vec<MerlFit>,
    /// The number of materials without a specular part, which have no lobe to compare and no fit.
    pub(super) flat: usize,
    /// The number of pairs of directions of a fit.
    pub(super) directions: usize,
    materials: Vec<Sgd>,
}

impl Merl {
    /// Fits all models to all materials; in a quick study to a tenth of them.
    pub(super) fn fit(lab: &Lab) -> Self {
        let materials = Sgd::all();
        let chosen: Vec<&Sgd> = materials.iter().step_by(if lab.settings.quick { 10 } else { 1 }).collect();
        let contestants = Contestant::all();
        let directions = merl_directions();
        let mut fits: Vec<MerlFit> =
            chosen.par_iter().map(|m| merl_fit(m, &directions, &contestants, lab.registry)).collect();
        let flat = fits.iter().filter(|f| f.matte < MATTE).count();
        fits.retain(|f| f.matte >= MATTE);
        let last = contestants.len() - 1;
        fits.sort_by(|a, b| a.error(last).total_cmp(&b.error(last)));
        Self { contestants, fits, flat, directions: directions.len(), materials }
    }

    /// The index of GGX.
    pub(super) fn last(&self) -> usize {
        self.contestants.len() - 1
    }

    /// The number of materials for which a contestant is the best. Ties do not count.
    pub(super) fn best(&self, i: usize) -> usize {
        let wins = |f: &&MerlFit| (0..self.contestants.len()).all(|j| j == i || f.error(i) < f.error(j));
        self.fits.iter().filter(wins).count()
    }

    /// The median error of a contestant.
    pub(super) fn median(&self, i: usize) -> f64 {
        median(self.fits.iter().map(|f| f.error(i)).collect())
    }

    /// The median error of GGX without the choice of the Fresnel term, and the number of materials for which
    /// it still beats Blinn–Phong.
    pub(super) fn bound(&self) -> (f64, usize) {
        let bound = |f: &MerlFit| f.fits[self.last()].bound;
        let better = self.fits.iter().filter(|f| bound(f) < f.error(0)).count();
        (median(self.fits.iter().map(bound).collect()), better)
    }

    /// The numbers of the fits.
    pub(super) fn raw(&self) -> Table {
        let mut header = "material,lambert".to_owned();
        for c in &self.contestants {
            let n = c.name.to_lowercase().replace('–', "_");
            header.push_str(&format!(",{n},{n}_diffuse,{n}_specular,{n}_width"));
        }
        let mut raw = Table::new("lobe_merl", &header);
        for f in &self.fits {
            let mut numbers = vec![f.matte];
            numbers.extend(
                f.fits.iter().flat_map(|Found { fit: f, .. }| [f.error, f.diffuse, f.specular, f.width]),
            );
            raw.row(&[f.name], &numbers);
        }
        raw
    }

    /// The table, the chart, the lobes, and the errors for each material.
    pub(super) fn values(&self, lab: &Lab) -> Values {
        let mut head = vec!["Material"];
        head.extend(self.contestants.iter().map(|c| c.name));
        let errors = |f: &MerlFit| {
            let errors = f.fits.iter().map(|f| fixed(f.fit.error, 3));
            [f.name.to_owned()].into_iter().chain(errors).collect()
        };
        let errors: Vec<Vec<String>> = self.fits.iter().map(errors).collect();
        let panels = self.panels(lab);
        values! {
            fits: self.fits.len(), materials: self.flat + self.fits.len(), flat: self.flat, has_flat: self.flat > 0,
            directions: self.directions, largest_angle: f64::from(LARGEST_ANGLE),
            merl: self.table(), chart: self.chart(), errors: grid(&head, &errors),
            // A quick study may have skipped all of them.
            has_panels: !panels.is_empty(),
            panels: html! { @for (name, plot) in panels { div { p { (name) } (plot) } } }, key: key(&self.contestants),
        }
    }

    fn table(&self) -> Markup {
        let fits = &self.fits;
        let matte = median(fits.iter().map(|f| f.matte).collect());
        let mut rows = vec![["Lambert", "1", &fixed(matte, 3), "–", "–"].map(str::to_owned).to_vec()];
        for (i, c) in self.contestants.iter().enumerate() {
            let better = fits.iter().filter(|f| f.error(i) < f.error(0)).count();
            rows.push(vec![
                c.name.to_owned(),
                if c.instead.is_some() { "3 and choice of F" } else { "3" }.to_owned(),
                fixed(self.median(i), 3),
                self.best(i).to_string(),
                if i == 0 { "–".to_owned() } else { better.to_string() },
            ]);
        }
        grid(&["Model", "free numbers", "median error", "best for", "better than Blinn–Phong"], &rows)
    }

    fn chart(&self) -> Markup {
        let fits = &self.fits;
        let errors = fits.iter().flat_map(|f| (0..self.contestants.len()).map(|i| f.error(i)));
        let (lowest, highest) =
            errors.fold((f64::INFINITY, 0.0), |(l, h): (f64, f64), e| (l.min(e), h.max(e)));
        let of = |(i, c): (usize, &Contestant)| {
            let points = fits.iter().enumerate().map(|(x, f)| (x as f64 + 1.0, f.error(i))).collect();
            series(c.name, points, (c.style.0, Line::None, c.style.2))
        };
        plot(
            "Log error by material, sorted by the error of GGX",
            Axis::new("materials, sorted by the error of GGX", 0.0, fits.len() as f64 + 1.0, 6),
            Axis::log("log error", lowest.min(0.006) / 1.2, 1.2 * highest.max(1.6)),
            400,
            self.contestants.iter().enumerate().map(of).collect(),
        )
    }

    /// The lobes of some materials by name, without those that the study has skipped.
    fn panels(&self, lab: &Lab) -> Vec<(String, Markup)> {
        let panel = |name: &str| {
            let material = self.materials.iter().find(|m| m.name == name)?;
            let found = self.fits.iter().find(|f| f.name == name)?;
            Some((name.replace('-', " "), merl_plot(lab, material, found, &self.contestants)))
        };
        SHOWN.into_iter().filter_map(panel).collect()
    }
}

/// The lobes of a MERL fit by the angle of the half vector.
fn merl_plot(lab: &Lab, material: &Sgd, found: &MerlFit, contestants: &[Contestant]) -> Markup {
    // The difference angle is 30°, across, so that both directions stay above the surface.
    let angles: Vec<f32> = (0..=80u8).map(|i| 50.0 * (f32::from(i) / 80.0).powi(2)).collect();
    let samples: Vec<Sample> = angles
        .iter()
        .map(|theta| {
            let h = direction((*theta).into(), 0.0);
            let across = glam::Vec3::Y;
            let (s, c) = 30f32.to_radians().sin_cos();
            Sample { l: h * c + across * s, v: h * c - across * s, value: 1.0 }
        })
        .collect();
    let data: Vec<f64> = samples.iter().map(|s| material.luminance(s.l, s.v)).collect();
    let points = |values: Vec<f64>| angles.iter().map(|a| f64::from(*a)).zip(values).collect::<Vec<_>>();
    let (low, high) = data.iter().fold((f64::INFINITY, 0.0), |(l, h), v| (f64::min(l, *v), f64::max(h, *v)));
    let rings = points(data).into_iter().step_by(5).collect();
    let mut lines = vec![series("SGD fit", rings, (6, Line::None, Mark::Ring))];
    for (c, Found { fit, settings, .. }) in contestants.iter().zip(&found.fits) {
        let values = c.predict(lab.registry, settings, fit, &samples);
        lines.push(series(c.name, points(values), (c.style.0, c.style.1, Mark::None)));
    }
    let y = [(0.5 * low).log10().floor(), (1.2 * high).log10().ceil()].map(|power| 10f64.powf(power));
    svg(&Plot {
        title: format!("Lobe of {}", material.name),
        x: Axis::new("θₕ (°)", 0.0, 50.0, 6),
        y: Axis::log("f (sr⁻¹)", y[0], y[1]),
        series: lines,
        size: (430, 350),
        legend: false,
        ..Plot::default()
    })
}

/// The legend of the panels.
fn key(contestants: &[Contestant]) -> Markup {
    const COLOURS: [&str; 5] = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00"];
    html! {
        p .key {
            @for c in contestants {
                span {
                    svg viewBox="0 0 32 10" width="32" height="10" aria-hidden="true" {
                        line x1="0" y1="5" x2="32" y2="5" stroke-width="2.5" stroke=(COLOURS[c.style.0 % COLOURS.len()])
                            stroke-dasharray=(match c.style.1 { Line::Dashed => "8 5", Line::Dotted => "2 4", _ => "none" });
                    }
                    (c.name)
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_lie_above_the_surface_and_crowd_about_the_mirror() {
        let all = merl_directions();
        assert!(all.len() > 500, "{}", all.len());
        let half = |s: &Sample| (s.l + s.v).normalize().z.min(1.0).acos().to_degrees();
        for s in &all {
            assert!(s.l.is_normalized() && s.v.is_normalized() && s.l.z > 0.3 && s.v.z > 0.3);
        }
        let near = all.iter().filter(|s| half(s) < 10.0).count();
        assert!(near * 4 > all.len(), "{near} of {}", all.len());
    }

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(median(vec![3.0, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 2.0, 3.0]), 2.5);
        assert!(median(vec![]).is_nan());
    }
}
