//! Phenomenon 4: the shape of the highlight.

use maud::{Markup, html};
use rayon::prelude::*;

use super::{
    Chapter, Lab, Setting, StudyError, Table, alpha, choice,
    data::{self, Sgd},
    fit::{self, Fit, Sample},
    fixed, grid, image, number, pictures,
    plot::{Axis, Line, Mark, Plot, Series},
    svg, words,
};
use crate::{
    optics::{Frame, TermSelection, colour::Encoding, equivalence, geometry::direction},
    parameter::{Value, Values},
    registry::Registry,
};

const SCENE: &str = include_str!("../../scenes/lobe_shape.json");
/// Beyond, measurements are unreliable and differ in reciprocity.
const LARGEST_ANGLE: f32 = 71.0;
/// The paints: id, name.
pub(super) const PAINTS: [(&str, &str); 3] =
    [("krylon_blue", "Krylon blue"), ("garnet_red", "Garnet red"), ("acryl_blue", "Acryl blue")];
/// Angles of the light in the plots of paints, degrees.
const INCIDENCES: [f32; 2] = [40.0, 60.0];
/// Widths that are tried.
const WIDTHS: (f64, f64) = (0.002, 1.0);

/// A material of which a constant is nearer than this has no lobe.
const MATTE: f64 = 0.01;
/// A lobe narrower than this is very shiny: the highlight of a lamp is about a degree wide.
const SHINY: f64 = 0.02;

/// A model that takes part: its specular lobe with a free width.
pub(super) struct Contestant {
    pub(super) name: &'static str,
    id: &'static str,
    settings: Vec<Setting>,
    /// Other settings that may be taken instead, if they fit better.
    instead: Option<Vec<Setting>>,
    width: fn(f64) -> Vec<Setting>,
    style: (usize, Line, Mark),
}

fn exponent(width: f64) -> Vec<Setting> {
    let n = equivalence::exponent_of_alpha(width as f32).round();
    vec![("alpha", Value::Integer(n as i64))]
}

fn both(width: f64) -> Vec<Setting> {
    alpha(width).to_vec()
}

impl Contestant {
    fn microfacet(name: &'static str, d: &'static str, g: &'static str, style: (usize, Line, Mark)) -> Self {
        let settings = |f| {
            vec![
                choice("distribution", d),
                choice("masking", g),
                choice("fresnel", f),
                choice("diffuse", "none"),
                ("ior", Value::Triple([1.5; 3])),
            ]
        };
        Self {
            name,
            id: "microfacet",
            settings: settings("dielectric"),
            instead: Some(settings("none")),
            width: both,
            style,
        }
    }

    /// Those of the comparison.
    pub(super) fn all() -> Vec<Self> {
        let simple =
            |name, id, settings, width, style| Self { name, id, settings, instead: None, width, style };
        vec![
            simple(
                "Blinn–Phong",
                "blinn_phong",
                vec![number("k_s", 1.0)],
                exponent,
                (1, Line::Dashed, Mark::Triangle),
            ),
            simple("Ward", "ward", vec![number("k_s", 1.0)], both, (4, Line::Dotted, Mark::Square)),
            Self::microfacet("Cook–Torrance", "beckmann", "v_cavity", (2, Line::Dashed, Mark::Cross)),
            Self::microfacet("GGX", "ggx", "smith_height_correlated", (0, Line::Solid, Mark::Disc)),
        ]
    }

    /// Microfacet models that differ in nothing but the distribution.
    fn distributions() -> Vec<Self> {
        let smith = "smith_height_correlated";
        vec![
            Self::microfacet("Blinn’s distribution", "blinn_phong", smith, (1, Line::Solid, Mark::None)),
            Self::microfacet("Beckmann’s distribution", "beckmann", smith, (2, Line::Solid, Mark::None)),
            Self::microfacet("GGX distribution", "ggx", smith, (0, Line::Solid, Mark::None)),
        ]
    }

    /// Whether every setting is one that the model has.
    fn check(&self, lab: &Lab) -> Result<(), StudyError> {
        for settings in [Some(&self.settings), self.instead.as_ref()].into_iter().flatten() {
            let mut settings = settings.clone();
            settings.extend((self.width)(0.1));
            lab.surface(self.id, &settings)?;
        }
        Ok(())
    }

    /// The specular lobe as a BRDF at every sample.
    fn lobe(&self, registry: &Registry, settings: &[Setting], width: f64, samples: &[Sample]) -> Vec<f64> {
        let mut values = Values::default();
        for (name, value) in settings.iter().cloned().chain((self.width)(width)) {
            values.set(name, value);
        }
        let Some(model) = registry.model(self.id) else { return vec![0.0; samples.len()] };
        let surface = model.instantiate(&values, Encoding::Srgb);
        let f = |s: &Sample| {
            let specular = surface.response(s.l, s.v, &Frame::LOCAL).specular.y;
            f64::from(specular) / (std::f64::consts::PI * f64::from(s.l.z))
        };
        samples.iter().map(f).collect()
    }

    /// The best fit, with the Fresnel term of a dielectric.
    pub(super) fn fit(&self, registry: &Registry, samples: &[Sample]) -> Fit {
        fit::fit(samples, WIDTHS, |width, samples| self.lobe(registry, &self.settings, width, samples))
    }

    /// The best fit and its settings; for models that have one, with the Fresnel term that fits better.
    fn fit_freely(&self, registry: &Registry, samples: &[Sample]) -> Found {
        let first = self.fit(registry, samples);
        let bound = first.error;
        let found = |fit, settings: &[Setting]| Found { fit, settings: settings.to_vec(), bound };
        let Some(instead) = &self.instead else { return found(first, &self.settings) };
        let second = fit::fit(samples, WIDTHS, |width, samples| self.lobe(registry, instead, width, samples));
        if second.error < bound { found(second, instead) } else { found(first, &self.settings) }
    }

    /// What a fit says at other samples.
    fn predict(&self, registry: &Registry, settings: &[Setting], fit: &Fit, samples: &[Sample]) -> Vec<f64> {
        let lobe = self.lobe(registry, settings, fit.width, samples);
        lobe.iter().map(|q| fit.diffuse / std::f64::consts::PI + fit.specular * q).collect()
    }

    /// The error of a fit at other samples.
    pub(super) fn error(&self, registry: &Registry, fit: &Fit, samples: &[Sample]) -> f64 {
        let values: Vec<f64> = samples.iter().map(|s| s.value).collect();
        fit::error(fit, &values, &self.lobe(registry, &self.settings, fit.width, samples))
    }
}

/// The samples of a paint that count: its brightest band, no grazing angles, and what `keep` keeps of the
/// angle of the light.
pub(super) fn paint_samples(id: &str, keep: impl Fn(f32) -> bool) -> Result<Vec<Sample>, StudyError> {
    let all = data::paint(id);
    let good =
        |m: &data::Measurement| m.theta_i <= LARGEST_ANGLE && m.theta_o <= LARGEST_ANGLE && keep(m.theta_i);
    let samples = data::samples(&all, data::brightest(&all), good);
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

/// Directions for the fits of MERL materials, dense about the mirror direction as the database is: by the
/// half vector and the difference of light and half vector (S. Rusinkiewicz 1998).
fn merl_directions() -> Vec<Sample> {
    let mut samples = Vec::new();
    for i in 0..26u8 {
        let theta_h = 80.0 * (f32::from(i) / 25.0).powi(2);
        for j in 0..8u8 {
            for k in 0..7u8 {
                let (theta_d, phi_d) = (f32::from(j) * 10.0, f32::from(k) * 30.0);
                let h = direction(theta_h.into(), 0.0);
                let d = direction(theta_d.into(), phi_d.into());
                // Turned from the normal to the half vector, about y.
                let (s, c) = theta_h.to_radians().sin_cos();
                let turn =
                    |d: glam::Vec3| glam::Vec3::new(c * d.x + s * d.z, d.y, c * d.z - s * d.x).normalize();
                let l = turn(d);
                let v = (2.0 * l.dot(h) * h - l).normalize();
                let least = LARGEST_ANGLE.to_radians().cos();
                if l.z >= least && v.z >= least {
                    samples.push(Sample { l, v, value: 1.0 });
                }
            }
        }
    }
    samples
}

/// What a contestant found for a material.
struct Found {
    fit: Fit,
    /// The settings that it took.
    settings: Vec<Setting>,
    /// The error without a choice of the Fresnel term.
    bound: f64,
}

struct MerlFit {
    name: &'static str,
    /// Of each contestant.
    fits: Vec<Found>,
    matte: f64,
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

fn median(mut all: Vec<f64>) -> f64 {
    all.sort_by(f64::total_cmp);
    match all.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => all[n / 2],
        n => 0.5 * (all[n / 2 - 1] + all[n / 2]),
    }
}

/// The plot of a paint in the plane of incidence, with the fits.
fn paint_plot(lab: &Lab, id: &str, name: &str, theta_i: f32) -> Result<Markup, StudyError> {
    let all = data::paint(id);
    let band = data::brightest(&all);
    let samples = paint_samples(id, |_| true)?;
    // Positive angles on the side of the mirror direction.
    let signed = |m: &data::Measurement| {
        let delta = m.delta_phi.rem_euclid(360.0);
        if (delta - 180.0).abs() < 1.0 {
            Some(m.theta_o)
        } else if !(1.0..=359.0).contains(&delta) {
            Some(-m.theta_o)
        } else {
            None
        }
    };
    let mut measured: Vec<(f64, f64)> = all
        .iter()
        .filter(|m| (m.theta_i - theta_i).abs() < 0.5 && m.theta_o <= LARGEST_ANGLE && m.f[band] > 0.0)
        .filter_map(|m| Some((f64::from(signed(m)?), m.f[band])))
        .collect();
    measured.sort_by(|a, b| a.0.total_cmp(&b.0));
    let dense: Vec<Sample> = (-71..=71)
        .map(|a: i16| {
            let (theta, phi) = if a < 0 { (-f64::from(a), 0.0) } else { (f64::from(a), 180.0) };
            Sample { l: direction(theta_i.into(), 0.0), v: direction(theta, phi), value: 1.0 }
        })
        .collect();
    let mut series = vec![Series {
        name: "measured".to_owned(),
        points: measured.clone(),
        colour: 6,
        line: Line::None,
        mark: Mark::Ring,
    }];
    for c in Contestant::all() {
        let found = c.fit(lab.registry, &samples);
        let predicted = c.predict(lab.registry, &c.settings, &found, &dense);
        let points = (-71..=71).map(f64::from).zip(predicted).collect();
        series.push(Series {
            name: c.name.to_owned(),
            points,
            colour: c.style.0,
            line: c.style.1,
            mark: Mark::None,
        });
    }
    let top = measured.iter().map(|p| p.1).fold(0.1, f64::max);
    let plot = Plot {
        title: format!("BRDF of {name} in the plane of incidence, light at {theta_i} degrees"),
        x: Axis::new("angle of the viewer (°), mirror side positive", -75.0, 75.0, 7),
        y: Axis::log("f (sr⁻¹)", 0.01, 10f64.powf((top * 1.5).log10().ceil())),
        series,
        size: (720, 360),
        legend: true,
    };
    svg(&plot)
}

/// The lobes of a MERL fit by the angle of the half vector.
fn merl_plot(
    lab: &Lab,
    material: &Sgd,
    found: &MerlFit,
    contestants: &[Contestant],
) -> Result<Markup, StudyError> {
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
    let mut series = vec![Series {
        name: "SGD fit".to_owned(),
        points: points(data).into_iter().step_by(5).collect(),
        colour: 6,
        line: Line::None,
        mark: Mark::Ring,
    }];
    for (c, Found { fit, settings, .. }) in contestants.iter().zip(&found.fits) {
        let values = c.predict(lab.registry, settings, fit, &samples);
        series.push(Series {
            name: c.name.to_owned(),
            points: points(values),
            colour: c.style.0,
            line: c.style.1,
            mark: Mark::None,
        });
    }
    let plot = Plot {
        title: format!("Lobe of {}", material.name),
        x: Axis::new("θₕ (°)", 0.0, 50.0, 6),
        y: Axis::log(
            "f (sr⁻¹)",
            10f64.powf((0.5 * low).log10().floor()),
            10f64.powf((1.2 * high).log10().ceil()),
        ),
        series,
        size: (430, 350),
        legend: false,
    };
    svg(&plot)
}

pub(super) fn chapter(lab: &mut Lab) -> Result<Chapter, StudyError> {
    let registry = lab.registry;
    // Pictures.
    let mut scene = lab.scene(SCENE)?;
    // A row of objects, without the room above and below it.
    scene.observer.field_of_view = 4.936;
    let size = lab.size(1200, 240);
    let picture = lab.render(&scene, "", TermSelection::All, size);
    let names: Vec<&str> = scene.objects.iter().map(|o| o.name.as_deref().unwrap_or_default()).collect();
    // The height of each lobe, with light and viewer along the normal.
    let heights: Vec<f64> = scene
        .objects
        .iter()
        .filter_map(|o| {
            let model = registry.model(o.reflection_model.as_deref()?)?;
            let surface = model.instantiate(&o.material, Encoding::Srgb);
            Some(f64::from(surface.response(glam::Vec3::Z, glam::Vec3::Z, &Frame::LOCAL).specular.y))
        })
        .collect();
    let lower: Vec<String> = names
        .iter()
        .zip(&heights)
        .filter(|(_, h)| **h < 0.95 * heights[0])
        .map(|(name, h)| format!("{name} ({:.0}\u{a0}%)", 100.0 * h / heights[0]))
        .collect();
    let shown = lab.figure(
        &html! {
            div .wide {
                (pictures(&[(image(&picture.to_rgb8(&scene.display), size, "Five highlights of the same roughness")?, "")]))
                div .labels style=(format!("--columns:{}", names.len())) { @for name in &names { span { (name) } } }
            }
        },
        &html! {
            "Black plastic under one lamp: five lobes of the same roughness (α = 0.15, n = 87). "
            @if lower.is_empty() { "All have the same height. " } @else { "All have the same height but those that reach less of it: " (lower.join("; ")) ". " }
            "They differ in their tails: GGX and GTR glow on where Blinn–Phong and Beckmann are dark. Scene "
            code { "lobe_shape.json" } "."
        },
    );

    // Measured paints.
    let mut raw_paints = Table::new("lobe_paints", "paint,model,diffuse,specular,width,log_error");
    let mut paints = Vec::new();
    for (id, name) in PAINTS {
        let fits = paint_errors(lab, id)?;
        for (model, f) in &fits {
            raw_paints.row(&[name, model], &[f.diffuse, f.specular, f.width, f.error]);
        }
        paints.push(fits);
    }
    let paint_rows: Vec<Vec<String>> = (0..paints[0].len())
        .map(|i| {
            let mut row = vec![paints[0][i].0.to_owned(), if i == 0 { "1" } else { "3" }.to_owned()];
            row.extend(paints.iter().map(|p| fixed(p[i].1.error, 3)));
            row.extend(paints.iter().map(|p| if i == 0 { "–".to_owned() } else { fixed(p[i].1.width, 3) }));
            row
        })
        .collect();
    let paint_table = lab.table(
        &html! {
            "Log error of fits to three measured paints (1001 pairs of directions each, up to " (LARGEST_ANGLE) "°, brightest band), and the widths α that were found. "
            "The last three rows are one microfacet model with three distributions; Fresnel term for n = 1.5."
        },
        &["Model", "free numbers", "Krylon blue", "Garnet red", "Acryl blue", "α Krylon", "α Garnet", "α Acryl"],
        &paint_rows,
    );
    // What the errors of the table are when the light stands at one angle.
    let at_incidence = |paint: usize, model: &str, theta: f32| -> Result<f64, StudyError> {
        let samples = paint_samples(PAINTS[paint].0, |t| (t - theta).abs() < 0.5)?;
        let fit = paints[paint].iter().find(|f| f.0 == model);
        let contestant = Contestant::all().into_iter().find(|c| c.name == model);
        Ok(contestant.zip(fit).map_or(f64::NAN, |(c, fit)| c.error(registry, &fit.1, &samples)))
    };
    let two_angles = |paint: usize| -> Result<Markup, StudyError> {
        let (id, name) = PAINTS[paint];
        Ok(html! { div .stack { @for theta in INCIDENCES {
            div { p .over { "light at " (theta) "°" } (paint_plot(lab, id, name, theta)?) }
        } } })
    };
    let errors = |paint: usize| -> Result<String, StudyError> {
        let mut parts = Vec::new();
        for theta in INCIDENCES {
            let [b, c, g] =
                ["Blinn–Phong", "Cook–Torrance", "GGX"].map(|model| at_incidence(paint, model, theta));
            parts.push(format!(
                "{} for Blinn–Phong, {} for Cook–Torrance and {} for GGX with light at {theta}°",
                fixed(b?, 3),
                fixed(c?, 3),
                fixed(g?, 3)
            ));
        }
        Ok(parts.join("; "))
    };
    let [krylon_plots, garnet_plots] = [two_angles(0)?, two_angles(1)?];
    let [krylon_errors, garnet_errors] = [errors(0)?, errors(1)?];
    let paint_figure = lab.figure(
        &krylon_plots,
        &html! {
            "Krylon blue paint in the plane of incidence: measured values and the fits of the table, which are made to all directions of light and viewer and not to these alone. "
            "A model may be far off in one plane and near elsewhere. The log error over all viewers is " (krylon_errors) ". Logarithmic axis."
        },
    );
    let garnet_figure = lab.figure(
        &garnet_plots,
        &html! { "The same for garnet red paint. The log error over all viewers is " (garnet_errors) "." },
    );

    // Fits of MERL materials.
    let materials = Sgd::all();
    let chosen: Vec<&Sgd> = materials.iter().step_by(if lab.settings.quick { 10 } else { 1 }).collect();
    let contestants = Contestant::all();
    let directions = merl_directions();
    let mut fits: Vec<MerlFit> =
        chosen.par_iter().map(|m| merl_fit(m, &directions, &contestants, registry)).collect();
    let last = contestants.len() - 1;
    // A material whose fit has no specular part has no lobe to compare.
    let flat = fits.iter().filter(|f| f.matte < MATTE).count();
    fits.retain(|f| f.matte >= MATTE);
    let error = |f: &MerlFit, i: usize| f.fits[i].fit.error;
    fits.sort_by(|a, b| error(a, last).total_cmp(&error(b, last)));
    let mut header = "material,lambert".to_owned();
    for c in &contestants {
        let n = c.name.to_lowercase().replace('–', "_");
        header.push_str(&format!(",{n},{n}_diffuse,{n}_specular,{n}_width"));
    }
    let mut raw_merl = Table::new("lobe_merl", &header);
    for f in &fits {
        let mut numbers = vec![f.matte];
        numbers
            .extend(f.fits.iter().flat_map(|Found { fit: f, .. }| [f.error, f.diffuse, f.specular, f.width]));
        raw_merl.row(&[f.name], &numbers);
    }
    // A tie is no win.
    let best = |i: usize| {
        let wins = |f: &&MerlFit| (0..contestants.len()).all(|j| j == i || error(f, i) < error(f, j));
        fits.iter().filter(wins).count()
    };
    let medians: Vec<f64> =
        (0..contestants.len()).map(|i| median(fits.iter().map(|f| error(f, i)).collect())).collect();
    let matte = median(fits.iter().map(|f| f.matte).collect());
    let mut merl_rows =
        vec![vec!["Lambert".to_owned(), "1".to_owned(), fixed(matte, 3), "–".to_owned(), "–".to_owned()]];
    for (i, c) in contestants.iter().enumerate() {
        let better = fits.iter().filter(|f| error(f, i) < error(f, 0)).count();
        merl_rows.push(vec![
            c.name.to_owned(),
            if c.instead.is_some() { "3 and choice of F" } else { "3" }.to_owned(),
            fixed(medians[i], 3),
            format!("{}", best(i)),
            if i == 0 { "–".to_owned() } else { format!("{better}") },
        ]);
    }
    let merl_table = lab.table(
        &html! {
            "Fits to " (fits.len()) " materials of the MERL database, as represented by the SGD fits of Bagher et al. (2012): median of the log error, the number of materials for which the model is the best of the four, "
            "and for which it is better than Blinn–Phong; a tie is no win. "
            @if flat > 0 { (flat) " more materials without a specular part, which every model fits exactly, are not counted." }
        },
        &["Model", "free numbers", "median error", "best for", "better than Blinn–Phong"],
        &merl_rows,
    );
    let errors = fits.iter().flat_map(|f| (0..contestants.len()).map(|i| error(f, i)));
    let (lowest, highest) = errors.fold((f64::INFINITY, 0.0), |(l, h): (f64, f64), e| (l.min(e), h.max(e)));
    let chart = Plot {
        title: "Log error by material, sorted by the error of GGX".to_owned(),
        x: Axis::new("materials, sorted by the error of GGX", 0.0, fits.len() as f64 + 1.0, 6),
        y: Axis::log("log error", lowest.min(0.006) / 1.2, 1.2 * highest.max(1.6)),
        series: contestants
            .iter()
            .enumerate()
            .map(|(i, c)| Series {
                name: c.name.to_owned(),
                points: fits.iter().enumerate().map(|(x, f)| (x as f64 + 1.0, error(f, i))).collect(),
                colour: c.style.0,
                line: Line::None,
                mark: c.style.2,
            })
            .collect(),
        size: (720, 400),
        legend: true,
    };
    let chart = lab.figure(
        &svg(&chart)?,
        &html! { "Error of the four models for each material, sorted. Logarithmic axis; it holds every point." @if flat > 0 { " The " (flat) " materials without a specular part have error 0 and no place on it." } },
    );
    let wanted = ["gold-metallic-paint", "alum-bronze", "red-plastic", "blue-acrylic"];
    let mut panels = Vec::new();
    for name in wanted {
        let (Some(material), Some(found)) =
            (materials.iter().find(|m| m.name == name), fits.iter().find(|f| f.name == name))
        else {
            continue;
        };
        panels.push((name.replace('-', " "), merl_plot(lab, material, found, &contestants)?));
    }
    let panels = (!panels.is_empty()).then(|| {
        lab.figure(
            &html! {
                div .panels { @for (name, plot) in &panels { div { p { (name) } (plot) } } }
                (key(&contestants))
            },
            &html! { "Lobes of four materials: BRDF by the angle " (words("θ_h")) " between normal and half vector, with 60° between light and viewer. Rings: the SGD fit that stands for the material." },
        )
    });
    let details: Vec<Vec<String>> = fits
        .iter()
        .map(|f| {
            let mut row = vec![f.name.to_owned()];
            row.extend(f.fits.iter().map(|f| fixed(f.fit.error, 3)));
            row
        })
        .collect();
    let mut head = vec!["Material"];
    head.extend(contestants.iter().map(|c| c.name));

    let of = |paint: usize, model: &str| {
        paints[paint].iter().find(|f| f.0 == model).map_or(f64::NAN, |f| f.1.error)
    };
    let wins = (0..2).filter(|p| of(*p, "GGX") < of(*p, "Blinn–Phong")).count();
    let ggx_first = medians[last] < medians[0];
    let confirmed = wins == 2 && ggx_first;
    let ratio = medians[0] / medians[last];
    // A log error as per cent.
    let off = |error: f64| 100.0 * (error.exp() - 1.0);
    let finding = format!(
        "Fitted to measured paint with the same freedom, Blinn–Phong is off by {:.1}\u{a0}% and {:.1}\u{a0}%, GGX by {:.1}\u{a0}% and {:.1}\u{a0}%; over {} MERL fits, where GGX may also choose its Fresnel term, the medians are {:.1}\u{a0}% and {:.1}\u{a0}%.",
        off(of(0, "Blinn–Phong")),
        off(of(1, "Blinn–Phong")),
        off(of(0, "GGX")),
        off(of(1, "GGX")),
        fits.len(),
        off(medians[0]),
        off(medians[last])
    );
    // From Blinn–Phong to the microfacet model with the same distribution, and from there to GGX.
    let frame = [0, 1].map(|p| of(p, "Blinn–Phong") - of(p, "Blinn’s distribution"));
    let tail = [0, 1].map(|p| of(p, "Blinn’s distribution") - of(p, "GGX distribution"));
    let share = [0, 1].map(|p| format!("{:.0}\u{a0}%", 100.0 * frame[p] / (frame[p] + tail[p])));
    // Where GGX is worse than Blinn–Phong, by the width of the latter.
    let mut worse: Vec<&MerlFit> = fits.iter().filter(|f| error(f, last) > error(f, 0)).collect();
    worse.sort_by(|a, b| a.fits[0].fit.width.total_cmp(&b.fits[0].fit.width));
    let shiny = |f: &MerlFit| f.fits[0].fit.width < SHINY;
    let (shiny_worse, all_shiny) =
        (worse.iter().filter(|f| shiny(f)).count(), fits.iter().filter(|f| shiny(f)).count());
    let short = contestants.iter().position(|c| c.name == "Cook–Torrance").unwrap_or(last);
    let short_better = worse.iter().filter(|f| error(f, short) < error(f, last)).count();
    let worse_names: Vec<String> = worse
        .iter()
        .map(|f| format!("{} ({})", f.name.replace('-', " "), fixed(f.fits[0].fit.width, 3)))
        .collect();
    let bound_median = median(fits.iter().map(|f| f.fits[last].bound).collect());
    let bound_better = fits.iter().filter(|f| f.fits[last].bound < error(f, 0)).count();
    let tails = (0..2).all(|p| of(p, "GGX distribution") < of(p, "Blinn’s distribution"));
    let acryl = [of(2, "Blinn–Phong"), of(2, "GGX")];
    let body = html! {
        h3 { "Question" }
        p { "Which model’s highlight has the shape of the highlights of real surfaces, when each is allowed its best parameters?" }
        h3 { "Method" }
        p { "Every model is fitted with three free numbers, the diffuse reflectance d, a scale s and the width α of its own specular lobe:" }
        p .equation { span { "f(l, v) = d/π + s · lobe(l, v; α)." } }
        p {
            "What is minimised is the root mean square of ln f − ln f" sub { "data" } " over all pairs of directions, the log error. For each width, d and s are found by Levenberg’s method; the width by "
            "search (" code { "study::fit" } "). The lobe is the specular term of the program’s own models: " code { "blinn_phong" } " (its response divided by π cos θ; n from α), " code { "ward" } ", and " code { "microfacet" }
            " as Cook–Torrance (Beckmann, V-cavities) and as GGX (Smith’s height-correlated masking)."
        }
        p {
            "Data are, first, three paints that were measured at Cornell University, in the band in which each is brightest. Directions beyond " (LARGEST_ANGLE) "° are left out, since the measurement is unreliable there. "
            "Second, the materials of the MERL database, not as measured but as represented by published fits of the SGD model, evaluated at " (directions.len())
            " pairs of directions that crowd about the mirror direction as the database does (luminance). "
            @if flat > 0 { "Of the " (flat + fits.len()) " materials " (flat) " are left out, because their SGD fit has no specular part. " }
            "The microfacet models may choose here between the Fresnel term for n = 1.5 and none, because metals need the latter."
        }
        h3 { "Results" }
        (shown)
        (paint_table)
        (paint_figure)
        (garnet_figure)
        (merl_table)
        (chart)
        @if let Some(panels) = panels { (panels) }
        details {
            summary { "Log error for each of the " (fits.len()) " materials" }
            (grid(&head, &details))
        }
        h3 { "Conclusion" }
        div .conclusion {
            p {
                @if wins == 2 {
                    "For both glossy paints GGX comes closest to the measurement: its log error is " (fixed(of(0, "GGX"), 3)) " and " (fixed(of(1, "GGX"), 3)) ", Blinn–Phong’s "
                    (fixed(of(0, "Blinn–Phong"), 3)) " and " (fixed(of(1, "Blinn–Phong"), 3)) ". Exchanging the distribution alone shows its part: with Blinn’s distribution inside the same microfacet model the errors are "
                    (fixed(of(0, "Blinn’s distribution"), 3)) " and " (fixed(of(1, "Blinn’s distribution"), 3)) ", with Beckmann’s " (fixed(of(0, "Beckmann’s distribution"), 3)) " and " (fixed(of(1, "Beckmann’s distribution"), 3))
                    ". "
                    @if tails {
                        "Of the way from Blinn–Phong to GGX, " (share[0]) " and " (share[1]) " are due to the frame of the microfacet model (its denominator, masking and Fresnel term), and the rest to the longer tail of GGX. "
                        @if frame[0] > tail[0] && frame[1] > tail[1] { "The frame is the larger part for both paints." }
                        @else if frame[0] < tail[0] && frame[1] < tail[1] { "The tail is the larger part for both paints." }
                        @else { "Which part is larger depends on the paint." }
                    }
                } @else {
                    "For the glossy paints GGX is better than Blinn–Phong in " (wins) " of two cases."
                }
            }
            p {
                "Acryl blue is nearly matte in this data: the errors of Blinn–Phong and GGX are " (fixed(acryl[0], 3)) " and " (fixed(acryl[1], 3)) ". "
                @if (acryl[0] - acryl[1]).abs() < 0.02 { "The shape of a highlight that is hardly there decides nothing." }
            }
            p {
                @if ggx_first {
                    "Over the " (fits.len()) " MERL fits the median error of GGX is " (fixed(medians[last], 2)) ", that of Blinn–Phong " (fixed(medians[0], 2)) ", " (fixed(ratio, 1)) " times as large. "
                } @else {
                    "Over the " (fits.len()) " MERL fits GGX has no smaller median error (" (fixed(medians[last], 2)) ") than Blinn–Phong (" (fixed(medians[0], 2)) "). "
                }
                "The best of the four is "
                @for (i, c) in contestants.iter().enumerate().rev() {
                    (c.name) " for " (best(i)) @if i > 1 { ", " } @else if i == 1 { " and " }
                }
                ". No model is best for every material: these are fits of one more model, and the tails of real materials differ."
            }
            p {
                @if worse.is_empty() {
                    "GGX is worse than Blinn–Phong for none of them. "
                } @else {
                    "GGX is worse than Blinn–Phong for " (worse.len()) " of them (in brackets the width α of Blinn–Phong’s lobe): " (worse_names.join(", ")) ". "
                    @if 2 * shiny_worse > worse.len() {
                        "Most of these, " (shiny_worse) ", are very shiny (α < " (SHINY) "); a narrow lobe alone does not decide, as GGX is better for " (all_shiny - shiny_worse) " of the " (all_shiny) " that are. "
                    } @else {
                        "Of these " (shiny_worse) " are very shiny (α < " (SHINY) "). "
                    }
                    @if 2 * short_better > worse.len() {
                        "For " (short_better) " of the " (worse.len()) " Cook–Torrance is better than GGX, too: their lobes fall off faster than GGX’s, which a short tail fits. "
                    }
                }
                "The microfacet models had one choice more, that of F. With F for n = 1.5 throughout, the median error of GGX is " (fixed(bound_median, 2)) ", and it is better than Blinn–Phong for " (bound_better) " of " (fits.len()) "."
            }
        }
    };
    Ok(Chapter {
        title: "Shape of the specular lobe",
        body,
        finding,
        shown: confirmed,
        tables: vec![raw_paints, raw_merl],
    })
}

/// What the lines of the panels are.
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
    use crate::study::Settings;

    /// Errors that were found by another program with other means (a general least-squares solver).
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
            // In this order, with room to spare.
            for pair in expected.windows(2) {
                assert!(error(pair[0].0) < error(pair[1].0), "{paint}: {pair:?}");
            }
            assert!(error("GGX distribution") < 0.85 * error("Blinn’s distribution"), "{paint}");
        }
    }

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
