//! Light with extent: the same ball under a point light, a softbox and a sky, compared with two
//! approximations for real-time rendering.

mod ltc;
mod measure;
mod split_sum;
mod subject;

use std::sync::{Arc, atomic::AtomicBool};

use maud::{Markup, html};

use super::{
    Chapter, Lab, StudyError, Table, fixed,
    fresnel::brightest,
    grid, image, percent, pictures, plot, row, series, share, stack,
    text::{Values, values},
};
use crate::{
    compare::{Differences, Pair, Shown},
    curves::draw::{Axis, Line, Mark},
    optics::TermSelection,
    reference::{self, LightSamples, Picture},
    scene::{
        Comparison, Scene,
        comparison::{Channel, Compared, Sign},
    },
};
use measure::{Measured, measure};
use subject::{ANISOTROPY, BRUSHED, EXPONENT, GOLD_ALPHA, Lamp, Subject, Way};

const SCENE: &str = include_str!("scene.json");
/// The lights of the scene, in order.
const LIGHTS: [&str; 3] = ["point light", "softbox", "sky"];
/// Light and approximation.
const WAYS: [(usize, Way); 3] = [(1, Way::Ltc), (1, Way::SplitSum), (2, Way::SplitSum)];
/// Difference, as a fraction of the root mean square luminance, shown in the last colour of the maps.
const FULL: f64 = 0.5;
/// Maximum error of approximations that are called close.
const CLOSE: f64 = 0.05;

/// A model under all lights.
struct Shot {
    subject: Subject,
    /// Converged pictures by light.
    converged: [Picture; 3],
    /// The largest noise of these.
    noise: f64,
    /// Approximated pictures by [`WAYS`].
    approximated: [(Picture, Measured); 3],
    /// The brightest hundredth relative to the mean, by light.
    contrast: [f64; 3],
}

impl Shot {
    fn error(&self, way: usize) -> f64 {
        self.approximated[way].1.rms
    }
}

pub(super) fn chapter(lab: &mut Lab) -> Result<Chapter, StudyError> {
    let scene = lab.scene(SCENE)?;
    let mut fits = Table::new("extent_ltc", "model,alpha,angle_deg,m11,m13,m22,m31,m33,misplaced");
    let [a, b, c] = subject::all().map(|subject| shoot(lab, &scene, subject, &mut fits));
    let shots = [a?, b?, c?];

    let (errors, raw) = errors(&shots);
    let (plots, by_angle) = plots(&shots);
    let (mut values, shown) = conclusion(&shots);
    values.extend(values! {
        gold_alpha: GOLD_ALPHA, brushed: BRUSHED, anisotropy: ANISOTROPY, brushed_alpha: BRUSHED * BRUSHED,
        exponent: EXPONENT as f64, plastic_alpha: (2.0 / (EXPONENT as f64 + 2.0)).sqrt(),
        gallery: gallery(&scene, &shots)?, errors, plots, key: key()?,
        maps_softbox: comparison(&scene, &shots, &[0, 1])?, maps_sky: comparison(&scene, &shots, &[2])?,
    });
    lab.chapter(include_str!("extent.html"), &values, shown, vec![raw, by_angle, fits])
}

/// Draws a model under all lights and by all approximations.
fn shoot(lab: &Lab, scene: &Scene, subject: Subject, fits: &mut Table) -> Result<Shot, StudyError> {
    let (width, height) = lab.size(160, 160);
    let settings = reference::Settings { width, height, samples: 4, terms: TermSelection::All };
    // Samples of a light and of the lobes for each pixel: of the converged picture, and of each mean in an
    // approximation.
    let (many, few) = if lab.settings.quick { (256, 128) } else { (512, 1024) };
    let scene = subject.put(scene, lab.registry)?;
    let known = Arc::new(subject.known(lab, few)?);
    for (angle, m, off) in known.ltc.all() {
        let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
        fits.row(&[subject.short], &[subject.alpha, angle, x.x, z.x, y.y, x.z, z.z, off]);
    }
    let observer = scene.observer.position;
    let shot = reference::Shot::new(&scene, lab.registry, &settings);
    let instead = |leaving| reference::render_instead(shot, leaving);
    let places = instead(Arc::new(move |p, n, _| measure::place(observer, p, n)));
    let mut noise = 0.0f64;
    let converged: [Picture; 3] = std::array::from_fn(|light| {
        let mut scene = scene.clone();
        scene.lights = vec![scene.lights.swap_remove(light)];
        // Two pictures with half the samples each: their mean is the picture with all, and half their
        // difference is its noise.
        let [mut a, b] = [0, many / 2].map(|first| {
            let samples = LightSamples { first, count: many / 2 };
            reference::render_samples(&scene, lab.registry, &settings, samples, &AtomicBool::default())
        });
        noise = noise.max(0.5 * measure(&a, &b, &places).rms);
        a.pixels.iter_mut().zip(b.pixels).for_each(|(a, b)| *a = 0.5 * (*a + b));
        a
    });
    let lamps: Vec<_> =
        scene.lights.iter().filter_map(|l| Lamp::new(l, lab.registry, &scene)).map(Arc::new).collect();
    let approximated = WAYS.map(|(light, way)| {
        let picture = instead(way.leaving(&known, &lamps[light], observer));
        let measured = measure(&picture, &converged[light], &places);
        (picture, measured)
    });
    let contrast =
        std::array::from_fn(|i| brightest(&converged[i]) / measure::mean_luminance(&converged[i]).max(1e-12));
    Ok(Shot { subject, converged, noise, approximated, contrast })
}

/// A picture for the page.
fn shown(picture: &Picture, scene: &Scene, alt: &str) -> Result<Markup, StudyError> {
    image(&picture.to_rgb8(&scene.display), (picture.width, picture.height), alt)
}

/// All models under all lights.
fn gallery(scene: &Scene, shots: &[Shot]) -> Result<Markup, StudyError> {
    let mut rows = Vec::new();
    for shot in shots {
        let mut all = Vec::new();
        for (picture, light) in shot.converged.iter().zip(LIGHTS) {
            let alt = format!("{}, {light}, converged", shot.subject.name);
            all.push((shown(picture, scene, &alt)?, light));
        }
        rows.push((shot.subject.name, pictures(&all)));
    }
    Ok(stack(&rows))
}

/// The differences between two pictures as colours.
fn map(picture: &Picture, converged: &Picture, scene: &Scene, full: f64) -> Result<Vec<u8>, StudyError> {
    let [a, b] = [converged, picture].map(|p| Shown::of_light(p.clone(), &scene.display));
    let comparison = signed(full);
    let differences = Pair::new(&a, &b).and_then(|pair| pair.differences(&comparison));
    differences.map(|d| d.colours(&comparison)).map_err(|e| StudyError::Figure(e.to_string()))
}

/// A comparison of signed luminance, in which this difference has the last colour.
fn signed(full: f64) -> Comparison {
    Comparison {
        sign: Sign::Signed,
        channel: Channel::Luminance,
        values: Compared::Light,
        amplification: Some((1.0 / full.max(1e-12)) as f32),
        ..Comparison::default()
    }
}

/// The colours of the maps, from the darkest to the brightest.
fn key() -> Result<Markup, StudyError> {
    const SIZE: (u32, u32) = (256, 8);
    let ramp = (0..SIZE.0).map(|x| (2.0 * x as f32 + 1.0) / SIZE.0 as f32 - 1.0).collect();
    let colours = Differences { pixels: ramp, largest: None }.colours(&signed(1.0));
    let band =
        image(&colours.repeat(SIZE.1 as usize), SIZE, "The colours of differences, from darker to brighter")?;
    let end = share(FULL, 0);
    Ok(html! { p .key { span { "−" (end) } span style="flex: 0 1 12rem" { (band) } span { "+" (end) } } })
}

/// Converged and approximated pictures for some [`WAYS`], and their differences.
fn comparison(scene: &Scene, shots: &[Shot], ways: &[usize]) -> Result<Markup, StudyError> {
    let light = WAYS[ways[0]].0;
    let mut rows = Vec::new();
    for shot in shots {
        let converged = &shot.converged[light];
        let name = |what: &str| format!("{}, {}, {what}", shot.subject.name, LIGHTS[light]);
        let mut all = vec![(shown(converged, scene, &name("converged"))?, "converged".to_owned())];
        for &way in ways {
            let (picture, measured) = &shot.approximated[way];
            let method = WAYS[way].1.name();
            all.push((shown(picture, scene, &name(method))?, method.to_owned()));
            let full = FULL * measure::rms_luminance(converged);
            let map = image(
                &map(picture, converged, scene, full)?,
                (picture.width, picture.height),
                &name(&format!("difference of {method}")),
            )?;
            all.push((map, format!("difference, {}", share(measured.rms, 1))));
        }
        rows.push((shot.subject.name, row(all.len(), &all)));
    }
    Ok(stack(&rows))
}

/// The table of errors, and the raw numbers.
fn errors(shots: &[Shot]) -> (Markup, Table) {
    let mut raw =
        Table::new("extent_errors", "model,light,approximation,rms,mean,largest,angle_deg,clock,noise");
    let mut rows = Vec::new();
    for (i, (light, way)) in WAYS.iter().enumerate() {
        for shot in shots {
            let found = &shot.approximated[i].1;
            let (angle, hour) = found.at;
            raw.row(
                &[shot.subject.short, LIGHTS[*light], way.name()],
                &[found.rms, found.mean, found.largest, angle, f64::from(hour), shot.noise],
            );
            rows.push(vec![
                format!("{}, {}: {}", LIGHTS[*light], way.name(), shot.subject.short),
                share(found.rms, 1),
                percent(found.mean - 1.0),
                percent(found.largest),
                format!("{}°, {hour} o’clock", fixed(angle, 0)),
            ]);
        }
    }
    (grid(&["Light, approximation, material", "RMS", "mean", "largest", "where"], &rows), raw)
}

/// The error by angle of view: the plots, and the raw numbers.
fn plots(shots: &[Shot]) -> (Markup, Table) {
    let mut raw = Table::new("extent_by_angle", "model,light,approximation,angle_deg,rms");
    let mut plots = Vec::new();
    for light in [1, 2] {
        let mut lines = Vec::new();
        for (i, (_, way)) in WAYS.iter().enumerate().filter(|(_, way)| way.0 == light) {
            let (line, mark) = match way {
                Way::Ltc => (Line::Solid, Mark::Disc),
                Way::SplitSum => (Line::Dashed, Mark::Triangle),
            };
            for (colour, shot) in shots.iter().enumerate() {
                let points = &shot.approximated[i].1.by_angle;
                for (angle, rms) in points {
                    raw.row(&[shot.subject.short, LIGHTS[light], way.name()], &[*angle, *rms]);
                }
                let name = format!("{}, {}", shot.subject.short, way.name());
                let points = points.iter().map(|(a, rms)| (*a, 100.0 * rms)).collect();
                lines.push(series(name, points, (colour, line, mark)));
            }
        }
        let highest = lines.iter().flat_map(|s| &s.points).map(|p| p.1).fold(0.0, f64::max);
        let top = [5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0].into_iter().find(|top| highest <= *top);
        let plot = plot(
            &format!("Error under the {} against the angle of view", LIGHTS[light]),
            Axis::new("angle between normal and view (°)", 0.0, 90.0, 10),
            Axis::new("RMS difference (%)", 0.0, top.unwrap_or(highest), 6),
            340,
            lines,
        );
        plots.push((format!("Under the {}", LIGHTS[light]), plot));
    }
    (stack(&plots), raw)
}

/// The values of the conclusion and of the finding, and true if the approximations differ from model to model.
fn conclusion(shots: &[Shot; 3]) -> (Values, bool) {
    let noise = shots.iter().map(|s| s.noise).fold(0.0, f64::max);
    let [point, softbox, sky] = shots[0].contrast;
    // The errors of each approximation by model.
    let [ltc, split_sum, under_sky] =
        [0, 1, 2].map(|way| [0, 1, 2].map(|shot: usize| shots[shot].error(way)));
    let ends = |errors: [f64; 3]| {
        (errors.into_iter().fold(f64::INFINITY, f64::min), errors.into_iter().fold(0.0, f64::max))
    };
    let range = |errors| {
        let (least, most) = ends(errors);
        format!("{} to {}", fixed(100.0 * least, 1), share(most, 1))
    };
    let farther = |shot: usize| ltc[shot] > ltc[0] + 2.0 * noise;
    let better = ltc.iter().zip(split_sum).filter(|(ltc, split_sum)| *ltc < split_sum).count();
    let worst = |way: usize| {
        let worst = shots.iter().max_by(|a, b| a.error(way).total_cmp(&b.error(way)));
        worst.unwrap_or(&shots[0])
    };
    let measured = &worst(2).approximated[2].1;
    let values = values! {
        noise, range_ltc: range(ltc), range_split_sum: range(split_sum), range_sky: range(under_sky),
        spreads: point > softbox && softbox > sky, point, softbox, sky,
        close: ltc[0] < CLOSE, gold: ltc[0], metal: ltc[1], brushed_farther: farther(1),
        plastic: ltc[2], plastic_farther: farther(2), any_farther: farther(1) || farther(2),
        all_better: better == shots.len(), any_better: better > 0, better, shots: shots.len(),
        worst_softbox: worst(1).error(1), worst_softbox_name: worst(1).subject.short,
        sky_close: under_sky.iter().all(|e| *e < CLOSE), worst_sky: worst(2).error(2),
        sky_gold: under_sky[0], sky_metal: under_sky[1], sky_plastic: under_sky[2],
        largest: measured.largest, worst_sky_name: worst(2).subject.short, largest_angle: measured.at.0,
    };
    let (least, most) = ends(ltc);
    (values, most > least)
}

#[cfg(test)]
mod tests;
