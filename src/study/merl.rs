//! Fits of the MERL materials by published metrics: which published orders of models come out again?

use std::f64::consts::{FRAC_1_PI, PI};

use rayon::prelude::*;

use super::{
    Chapter, Lab, StudyError, Table,
    fit::Sample,
    fixed, grid,
    lobe::{Contestant, median},
    text::values,
};
use crate::{
    curves::data::{Abc, LARGEST_ANGLE, Sgd},
    matching::{
        Metric, directions,
        least_squares::{Limits, Residuals, Stop, descend},
    },
};

/// Widths of lobes that are tried, evenly spaced in their logarithms.
const WIDTHS: usize = 40;
/// The smallest width.
const NARROWEST: f64 = 0.005;
/// The end of the search for the scales.
const LIMITS: Limits = Limits { steps: 12, least_gain: 1e-5, least_move: 1e-6, first_step: 1.0 };

/// A published order of two models: by whom, by which metric, and the indices of the nearer and the farther one.
struct Order {
    says: &'static str,
    metric: Metric,
    nearer: &'static str,
    farther: &'static str,
}

/// The published orders.
const ORDERS: [Order; 4] = [
    Order {
        says: "Ngan 2005: a lobe about the half vector is nearer than one about the mirror direction",
        metric: Metric::Cosine,
        nearer: "Blinn–Phong",
        farther: "Phong",
    },
    Order {
        says: "Ngan 2005: physically based lobes are nearer",
        metric: Metric::Cosine,
        nearer: "Cook–Torrance",
        farther: "Blinn–Phong",
    },
    Order {
        says: "Ngan 2005: physically based lobes are nearer",
        metric: Metric::Cosine,
        nearer: "Cook–Torrance",
        farther: "Ward",
    },
    Order {
        says: "Löw 2012, Bagher 2012: long tails are nearer",
        metric: Metric::Log,
        nearer: "GGX",
        farther: "Cook–Torrance",
    },
];

/// The lobes of a contestant at all pairs of directions, each of another width.
struct Lobes {
    name: &'static str,
    all: Vec<Vec<f64>>,
}

/// The reflected light of a material, `π f cos θ`, and that of lobes.
struct Light<'a> {
    cosines: &'a [f64],
    data: &'a [f64],
}

/// The difference of a metric as a function of the logarithms of the scales.
struct Scales<'a> {
    light: &'a Light<'a>,
    lobe: &'a [f64],
    metric: Metric,
}

impl Residuals for Scales<'_> {
    fn count(&self) -> usize {
        self.lobe.len()
    }

    fn at(&mut self, point: &[f64], residuals: &mut [f64]) -> Result<(), Stop> {
        let (d, s) = (point[0].exp(), point[1].exp());
        let Light { cosines, data } = self.light;
        for (i, to) in residuals.iter_mut().enumerate() {
            let reflected = cosines[i] * (d + s * PI * self.lobe[i]);
            *to = self.metric.of(reflected) - self.metric.of(data[i]);
        }
        Ok(())
    }

    fn derivatives(
        &mut self,
        point: &[f64],
        residuals: &mut [f64],
        columns: &mut [Vec<f64>],
    ) -> Result<(), Stop> {
        let (d, s) = (point[0].exp(), point[1].exp());
        for (i, cos) in self.light.cosines.iter().enumerate() {
            let parts = [cos * d, cos * s * PI * self.lobe[i]];
            let slope = slope(self.metric, parts[0] + parts[1]);
            columns.iter_mut().zip(parts).for_each(|(column, part)| column[i] = slope * part);
        }
        self.at(point, residuals)
    }
}

/// The derivative of a metric's number with respect to the reflected light.
fn slope(metric: Metric, reflected: f64) -> f64 {
    let x = FRAC_1_PI * reflected;
    match metric {
        Metric::Cosine => 1.0,
        Metric::Log => FRAC_1_PI / (1.0 + x),
        Metric::CubeRoot => FRAC_1_PI / (3.0 * x.max(1e-12).cbrt().powi(2)),
    }
}

/// The root mean square that is left by the best scales of a lobe.
fn rest(light: &Light, lobe: &[f64], metric: Metric) -> f64 {
    let mut scales = Scales { light, lobe, metric };
    // The diffuse part from where it is darkest, the lobe from where it is brightest.
    let ratios = light.data.iter().zip(light.cosines).map(|(data, cos)| data / cos);
    let diffuse = ratios.fold(f64::INFINITY, f64::min).max(1e-6);
    let peak = (0..lobe.len()).max_by(|a, b| lobe[*a].total_cmp(&lobe[*b])).unwrap_or_default();
    let height = lobe[peak] * light.cosines[peak] * PI;
    let scale = if height > 0.0 { (light.data[peak] / height).max(1e-9) } else { 1e-9 };
    let mut at = [diffuse.ln(), scale.ln()];
    // Nothing ends it early.
    let _ = descend(&mut scales, &mut at, &[(-27.0, 27.0); 2], LIMITS);
    let mut residuals = vec![0.0; lobe.len()];
    let _ = scales.at(&at, &mut residuals);
    (residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len().max(1) as f64).sqrt()
}

/// The errors of all contestants for all materials by a metric, and the difference of the two published fits.
struct Errors {
    metric: Metric,
    /// For each material, those of the contestants.
    of: Vec<Vec<f64>>,
    /// For each material, that of the ABC fit.
    abc: Vec<f64>,
}

impl Errors {
    fn median(&self, contestant: usize) -> f64 {
        median(self.of.iter().map(|errors| errors[contestant]).collect())
    }

    /// The number of materials for which one contestant is nearer than another.
    fn nearer(&self, [a, b]: [usize; 2]) -> usize {
        self.of.iter().filter(|errors| errors[a] < errors[b]).count()
    }

    /// The number of materials for which the ABC fit is nearer than any contestant.
    fn abc_nearest(&self) -> usize {
        let least = |errors: &[f64]| errors.iter().copied().fold(f64::INFINITY, f64::min);
        self.of.iter().zip(&self.abc).filter(|(errors, abc)| **abc < least(errors)).count()
    }
}

fn errors(lab: &Lab, samples: &[Sample], lobes: &[Lobes], metric: Metric) -> Errors {
    let cosines: Vec<f64> = samples.iter().map(|s| f64::from(s.l.z)).collect();
    let light = |of: &dyn Fn(&Sample) -> f64| -> Vec<f64> {
        samples.iter().zip(&cosines).map(|(s, cos)| PI * cos * of(s)).collect()
    };
    let step = if lab.settings.quick { 10 } else { 1 };
    let published: Vec<_> =
        Sgd::all().into_iter().step_by(step).filter_map(|sgd| Some((Abc::named(sgd.name)?, sgd))).collect();
    let both = published.par_iter().map(|(abc, sgd)| {
        let data = light(&|s| sgd.luminance(s.l, s.v));
        let target = Light { cosines: &cosines, data: &data };
        let best = |lobes: &Lobes| {
            lobes.all.iter().map(|lobe| rest(&target, lobe, metric)).fold(f64::INFINITY, f64::min)
        };
        let other = light(&|s| abc.luminance(s.l, s.v));
        let squares = data.iter().zip(&other).map(|(a, b)| (metric.of(*a) - metric.of(*b)).powi(2));
        let apart = (squares.sum::<f64>() / data.len().max(1) as f64).sqrt();
        (lobes.iter().map(best).collect(), apart)
    });
    let (of, abc) = both.unzip();
    Errors { metric, of, abc }
}

pub(super) fn chapter(lab: &mut Lab) -> Result<Chapter, StudyError> {
    let pairs = directions(0.0, LARGEST_ANGLE.into());
    let samples: Vec<Sample> = pairs.into_iter().map(|(l, v)| Sample { l, v, value: 1.0 }).collect();
    let width = |i: usize| NARROWEST.powf(1.0 - i as f64 / (WIDTHS - 1) as f64);
    let contestants = Contestant::with_phong();
    let lobes = contestants.iter().map(|contestant| {
        contestant.check(lab)?;
        let of = |i: usize| contestant.lobes(lab.registry, width(i), &samples);
        Ok(Lobes { name: contestant.name, all: (0..WIDTHS).flat_map(of).collect() })
    });
    let lobes = lobes.collect::<Result<Vec<_>, StudyError>>()?;
    let by: Vec<Errors> = Metric::ALL.iter().map(|metric| errors(lab, &samples, &lobes, *metric)).collect();

    let mut raw = Table::new("merl_metrics", "metric,model,median_error");
    let mut rows = Vec::new();
    for (i, contestant) in lobes.iter().enumerate() {
        let medians: Vec<f64> = by.iter().map(|errors| errors.median(i)).collect();
        by.iter().zip(&medians).for_each(|(e, m)| raw.row(&[e.metric.id(), contestant.name], &[*m]));
        rows.push(
            [contestant.name.to_owned()].into_iter().chain(medians.iter().map(|m| fixed(*m, 4))).collect(),
        );
    }
    let apart: Vec<f64> = by.iter().map(|errors| median(errors.abc.clone())).collect();
    by.iter().zip(&apart).for_each(|(e, m)| raw.row(&[e.metric.id(), "ABC"], &[*m]));
    rows.push(
        ["ABC, as published".to_owned()].into_iter().chain(apart.iter().map(|m| fixed(*m, 4))).collect(),
    );
    let heads: Vec<&str> = ["Model"].into_iter().chain(Metric::ALL.map(Metric::id)).collect();
    let medians = grid(&heads, &rows);

    let materials = by[0].of.len();
    let mut orders = Table::new("merl_orders", "order,metric,nearer,farther,materials,of,reproduced");
    let mut rows = Vec::new();
    let mut reproduced = 0;
    for Order { says, metric, nearer, farther } in ORDERS {
        let find = |name: &str| lobes.iter().position(|lobes| lobes.name == name).unwrap_or_default();
        let of = |metric: Metric| {
            by.iter().find(|e| e.metric == metric).map_or(0, |e| e.nearer([find(nearer), find(farther)]))
        };
        let count = of(metric);
        let holds = 2 * count > materials;
        reproduced += usize::from(holds);
        let numbers = [count as f64, materials as f64, f64::from(u8::from(holds))];
        orders.row(&[says, metric.id(), nearer, farther], &numbers);
        let mut row = vec![says.to_owned(), format!("{nearer} before {farther}"), metric.id().to_owned()];
        row.push(format!("{count} of {materials}"));
        row.extend(
            Metric::ALL
                .iter()
                .filter(|m| **m != metric)
                .map(|m| format!("{} ({})", of(*m), m.id()))
                .reduce(|a, b| format!("{a}, {b}")),
        );
        row.push(if holds { "reproduced" } else { "not reproduced" }.to_owned());
        rows.push(row);
    }
    let verdicts =
        grid(&["Published order", "models", "metric", "holds for", "by the others", "verdict"], &rows);
    let log = &by[1];
    let values = values! {
        medians, verdicts, materials, reproduced, orders: ORDERS.len(), all: reproduced == ORDERS.len(),
        directions: samples.len(), largest_angle: f64::from(LARGEST_ANGLE), widths: WIDTHS,
        apart: apart[1], abc_nearest: log.abc_nearest(), abc_mostly: 2 * log.abc_nearest() > materials,
    };
    lab.chapter(include_str!("merl.html"), &values, reproduced == ORDERS.len(), vec![raw, orders])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_scales_that_made_the_light_leave_nothing_by_any_metric() {
        let cosines: Vec<f64> = (1..=60).map(|i| f64::from(i) / 60.0).collect();
        let bell = |n: f64| -> Vec<f64> { cosines.iter().map(|c| c.powf(n)).collect() };
        let (right, wrong) = (bell(30.0), bell(6.0));
        let data: Vec<f64> =
            cosines.iter().zip(&right).map(|(cos, lobe)| cos * (0.2 + 0.7 * PI * lobe)).collect();
        let light = Light { cosines: &cosines, data: &data };
        for metric in Metric::ALL {
            let [good, bad] = [&right, &wrong].map(|lobe| rest(&light, lobe, metric));
            assert!(good < 1e-3, "{metric:?}: {good}");
            assert!(bad > 10.0 * good && bad > 0.01, "the wrong twin, {metric:?}: {bad}");
            // The slope is that of the numbers.
            let (x, step) = (0.7, 1e-6);
            let expected = (metric.of(x + step) - metric.of(x - step)) / (2.0 * step);
            assert!((slope(metric, x) / expected - 1.0).abs() < 1e-5, "{metric:?}");
        }
    }
}
