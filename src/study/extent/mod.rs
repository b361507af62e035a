//! Light with extent: the same ball under a point light, a softbox and a sky, compared with two
//! approximations for real-time rendering.

mod ltc;
mod measure;
mod split_sum;
mod subject;

use std::sync::{Arc, atomic::AtomicBool};

use maud::{Markup, html};

use super::{
    Chapter, Lab, StudyError, Table, fixed, fresnel::brightest, image, percent, pictures, row, svg, words,
};
use crate::{
    compare::{Differences, Pair, Shown},
    curves::draw::{Axis, Line, Mark, Plot, Series},
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
    let shots = subject::all()
        .into_iter()
        .map(|s| shoot(lab, &scene, s, &mut fits))
        .collect::<Result<Vec<_>, _>>()?;

    let gallery = gallery(lab, &scene, &shots)?;
    let softbox = comparison(lab, &scene, &shots, &[0, 1])?;
    let sky = comparison(lab, &scene, &shots, &[2])?;
    let (errors, raw) = errors(lab, &shots);
    let (plots, by_angle) = plots(lab, &shots);

    let all = |way: usize| shots.iter().map(move |shot| shot.error(way));
    let least = |way: usize| all(way).fold(f64::INFINITY, f64::min);
    let most = |way: usize| all(way).fold(0.0, f64::max);
    let range =
        |way: usize| format!("{} to {}\u{a0}%", fixed(100.0 * least(way), 1), fixed(100.0 * most(way), 1));
    let noise = shots.iter().map(|s| s.noise).fold(0.0, f64::max);
    let finding = format!(
        "Off the converged pictures of three models are linearly transformed cosines by {} under a softbox, the split sum by {} there and by {} under a sky.",
        range(0),
        range(1),
        range(2)
    );
    let body = html! {
        h3 { "Question" }
        p { "The chapters before have lamps without extent. Materials are judged under windows, softboxes and skies. What does the extent of the light change, and how far off are the approximations by which programs draw it in real time?" }
        (method(noise))
        h3 { "Results" }
        (gallery)
        (softbox)
        (sky)
        (errors)
        (plots)
        h3 { "Conclusion" }
        (conclusion(&shots, noise))
    };
    Ok(Chapter {
        title: "Light with extent, and two approximations",
        body,
        finding,
        shown: most(0) > least(0),
        tables: vec![raw, by_angle, fits],
    })
}

/// Draws a model under all lights and by all approximations.
fn shoot(lab: &Lab, scene: &Scene, subject: Subject, fits: &mut Table) -> Result<Shot, StudyError> {
    let (width, height) = lab.size(160, 160);
    let settings = reference::Settings { width, height, samples: 4, terms: TermSelection::All };
    // Samples of a light and of the lobes for each pixel: of the converged picture, and of each mean in an
    // approximation.
    let (many, few) = if lab.settings.quick { (256, 128) } else { (512, 1024) };
    let scene = subject.put(scene);
    let known = Arc::new(subject.known(lab, few)?);
    for (angle, m, off) in known.ltc.all() {
        let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
        fits.row(&[subject.short], &[subject.alpha, angle, x.x, z.x, y.y, x.z, z.z, off]);
    }
    let observer = scene.observer.position;
    let instead = |leaving| reference::render_instead(&scene, lab.registry, &settings, leaving);
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

fn method(noise: f64) -> Markup {
    html! {
        h3 { "Method" }
        p {
            "A ball of three materials is lit by a point light, by a softbox of 3.2 m by 2.2 m in its place and with its intensity towards the front, and by the CIE’s clear sky (type 12) without the sun itself. "
            "What leaves a point is the integral of the model’s answer times the luminance L over all directions from which light arrives. The program’s CPU renderer takes samples of it from the light and from the model’s lobes, "
            "whatever the model is, until their noise is small (here at most " (fixed(100.0 * noise, 1)) "\u{a0}%, by the difference of pictures of half the samples). Such a picture is called converged."
        }
        p {
            "Programs that draw sixty pictures a second have no time for that. Two approximations are common; both were made for microfacets of the GGX distribution, and both are calculated here, for each pixel, in this study alone. "
            "The " b { "split sum" } " (Karis 2013) takes the mean of a product for the product of the means: the directional albedo E of the highlight, and the light averaged about the mirror direction r by a GGX lobe as it is for a view along the normal."
        }
        p .equation {
            span { "∫ f(l, v) L(l) cos θ dl ≈ E(v) · L̄(r)," }
            span { "L̄(r) = ∫ D(h) L(l) (r·l) dl / ∫ D(h) (r·l) dl,  h between r and l." }
        }
        p {
            "Games read E as A F₀ + B from a table, which is the same number for GGX with Schlick’s Fresnel factor, and L̄ from a blurred map. Here E is integrated for the model at hand, and L̄ for each point, so that the errors below are those of the idea and not of its tables."
        }
        p {
            b { "Linearly transformed cosines" } " (LTC; Heitz, Dupuy, Hill and Neubelt 2016) replace the highlight by a cosine lobe that a matrix M stretches and slants. Its integral over a polygon is that of the plain cosine over the polygon transformed by M⁻¹, "
            "and for this Lambert found a formula in 1760. M is fitted to the GGX lobe of a roughness at 16 angles of view, by least squares; between them it is interpolated. The height is E again. LTC need a light with corners, so the sky has none."
        }
        p {
            "Both know one number of a highlight, the roughness α of an isotropic GGX lobe. Gold (microfacet model) has α = " (GOLD_ALPHA) " and is what they were made for. The brushed metal (Disney’s model, roughness " (BRUSHED) ", anisotropy " (ANISOTROPY)
            ") has GGX of two widths; the mean of its model’s scale is taken, α = r² = √(" (words("α_x")) " " (words("α_y")) ") = " (fixed(BRUSHED * BRUSHED, 2)) ". The plastic (normalised Blinn–Phong, exponent n = " (EXPONENT) ") has no GGX at all; by the correspondence that this program uses everywhere, α = √(2/(n + 2)) = "
            (fixed((2.0 / (EXPONENT as f64 + 2.0)).sqrt(), 3)) ". Its diffuse part obeys Lambert’s law, for which both have the exact answer: irradiance times albedo."
        }
        p {
            "The error is the root mean square difference in luminance from the converged picture, over the pixels that the ball covers fully and that light reaches in either, as a share of the root mean square luminance of the converged picture there."
        }
    }
}

/// A picture for the page.
fn shown(picture: &Picture, scene: &Scene, alt: &str) -> Result<Markup, StudyError> {
    image(&picture.to_rgb8(&scene.display), (picture.width, picture.height), alt)
}

/// All models under all lights.
fn gallery(lab: &mut Lab, scene: &Scene, shots: &[Shot]) -> Result<Markup, StudyError> {
    let mut rows = Vec::new();
    for shot in shots {
        let mut all = Vec::new();
        for (picture, light) in shot.converged.iter().zip(LIGHTS) {
            let alt = format!("{}, {light}, converged", shot.subject.name);
            all.push((shown(picture, scene, &alt)?, light));
        }
        rows.push(html! { div { p .over { (shot.subject.name) } (pictures(&all)) } });
    }
    Ok(lab.figure(
        &html! { div .stack { @for row in &rows { (row) } } },
        &html! { "Three materials under three lights, converged. Under the point light the highlight has the shape of the lobe alone, under the softbox that of the light as well, and under the sky it is spread over the ball." },
    ))
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
    let end = format!("{}\u{a0}%", fixed(100.0 * FULL, 0));
    Ok(html! {
        p .key { span { "−" (end) } span style="flex: 0 1 12rem" { (band) } span { "+" (end) } }
    })
}

/// Converged and approximated pictures for some [`WAYS`], and their differences.
fn comparison(lab: &mut Lab, scene: &Scene, shots: &[Shot], ways: &[usize]) -> Result<Markup, StudyError> {
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
            all.push((map, format!("difference, {}\u{a0}%", fixed(100.0 * measured.rms, 1))));
        }
        let all: Vec<_> = all.iter().map(|(m, w)| (m.clone(), w.as_str())).collect();
        rows.push(html! { div { p .over { (shot.subject.name) } (row(all.len(), &all)) } });
    }
    let wide = if ways.len() > 1 { "stack wide" } else { "stack" };
    let methods: Vec<_> = ways.iter().map(|way| WAYS[*way].1.name()).collect();
    Ok(lab.figure(
        &html! { div class=(wide) { @for row in &rows { (row) } (key()?) } },
        &html! {
            "The " (LIGHTS[light]) ", converged and by " (methods.join(" and by ")) ". The maps show the difference in luminance, as a share of the picture’s root mean square: blue where the approximation is too dark, orange where it is too bright, light grey where it is right. The number is the root mean square of it."
        },
    ))
}

/// The table of errors, and the raw numbers.
fn errors(lab: &mut Lab, shots: &[Shot]) -> (Markup, Table) {
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
                format!("{}\u{a0}%", fixed(100.0 * found.rms, 1)),
                percent(found.mean - 1.0),
                percent(found.largest),
                format!("{}°, {hour} o’clock", fixed(angle, 0)),
            ]);
        }
    }
    let table = lab.table(
        &html! { "The errors of both approximations: root mean square, mean, and the largest with its place: the angle between normal and view, and the direction from the middle of the ball as on a clock. The first and the third are shares of the root mean square luminance of the converged picture, the second is one of its mean." },
        &["Light, approximation, material", "RMS", "mean", "largest", "where"],
        &rows,
    );
    (table, raw)
}

/// The error by angle of view: the plots, and the raw numbers.
fn plots(lab: &mut Lab, shots: &[Shot]) -> (Markup, Table) {
    let mut raw = Table::new("extent_by_angle", "model,light,approximation,angle_deg,rms");
    let mut plots = Vec::new();
    for light in [1, 2] {
        let mut series = Vec::new();
        for (i, (_, way)) in WAYS.iter().enumerate().filter(|(_, way)| way.0 == light) {
            for (colour, shot) in shots.iter().enumerate() {
                let points = &shot.approximated[i].1.by_angle;
                for (angle, rms) in points {
                    raw.row(&[shot.subject.short, LIGHTS[light], way.name()], &[*angle, *rms]);
                }
                let (line, mark) = match way {
                    Way::Ltc => (Line::Solid, Mark::Disc),
                    Way::SplitSum => (Line::Dashed, Mark::Triangle),
                };
                series.push(Series {
                    name: format!("{}, {}", shot.subject.short, way.name()),
                    points: points.iter().map(|(a, rms)| (*a, 100.0 * rms)).collect(),
                    colour,
                    line,
                    mark,
                });
            }
        }
        let highest = series.iter().flat_map(|s| &s.points).map(|p| p.1).fold(0.0, f64::max);
        let top = [5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0].into_iter().find(|top| highest <= *top);
        let plot = Plot {
            title: format!("Error under the {} against the angle of view", LIGHTS[light]),
            x: Axis::new("angle between normal and view (°)", 0.0, 90.0, 10),
            y: Axis::new("RMS difference (%)", 0.0, top.unwrap_or(highest), 6),
            series,
            size: (720, 340),
            legend: true,
            ..Plot::default()
        };
        plots.push((format!("Under the {}", LIGHTS[light]), svg(&plot)));
    }
    let figure = lab.figure(
        &html! { div .stack { @for (name, plot) in &plots { div { p .over { (name) } (plot) } } } },
        &html! { "The error by the angle between normal and view, in steps of 10°, as a share of the root mean square luminance of the whole ball." },
    );
    (figure, raw)
}

/// A fraction in per cent.
fn share(x: f64) -> String {
    format!("{}\u{a0}%", fixed(100.0 * x, 1))
}

fn conclusion(shots: &[Shot], noise: f64) -> Markup {
    let [gold, brushed, plastic] = shots else { return Markup::default() };
    let [point, softbox, sky] = gold.contrast;
    let home = gold.error(0);
    let farther = [brushed, plastic].map(|shot| shot.error(0) > home + 2.0 * noise);
    let better = shots.iter().filter(|shot| shot.error(0) < shot.error(1)).count();
    let worst = |way: usize| {
        shots.iter().max_by(|a, b| a.error(way).total_cmp(&b.error(way))).map_or(gold, |worst| worst)
    };
    let under_sky = [gold, brushed, plastic].map(|shot| shot.error(2));
    html! {
        div .conclusion {
            p {
                @if point > softbox && softbox > sky {
                    "Extent spreads a highlight. On gold the brightest hundredth of the ball is " (fixed(point, 1)) " times as bright as the mean under the point light, " (fixed(softbox, 1)) " times under the softbox and " (fixed(sky, 1))
                    " times under the sky. The material is the same; who sets its roughness by the size of a highlight under a point light sets it for that light."
                } @else {
                    "On gold the brightest hundredth of the ball is " (fixed(point, 1)) ", " (fixed(softbox, 1)) " and " (fixed(sky, 1)) " times as bright as the mean under point light, softbox and sky: here extent alone does not order the contrast."
                }
            }
            p {
                @if home < CLOSE {
                    "For what they were made for, LTC are close: gold under the softbox is off by " (share(home)) "."
                } @else {
                    "Even for what they were made for, LTC are visibly off: gold under the softbox by " (share(home)) "."
                }
                " For the brushed metal it is " (share(brushed.error(0)))
                @if farther[0] { ", since one roughness stands for two and the highlight is round where it should be stretched" } @else { ", no more than that" }
                "; for the plastic " (share(plastic.error(0)))
                @if farther[1] { ", although GGX of the same sharpness was taken: Blinn–Phong’s lobe has other flanks." } @else { ", as most of its light is diffuse, which both approximations have exactly." }
            }
            p {
                @if better == shots.len() {
                    "The split sum is farther off under the softbox for all three (up to " (share(worst(1).error(1))) ", " (worst(1).subject.short) "): a light near by has edges, and how they are blurred depends on the angle of view, which the filter does not know."
                } @else if better > 0 {
                    "Under the softbox LTC are nearer than the split sum for " (better) " of " (shots.len()) " materials."
                } @else {
                    "Under the softbox the split sum is nearer than LTC for all three materials."
                }
                " Under the sky, which changes slowly, "
                @if under_sky.iter().all(|e| *e < CLOSE) {
                    "it is close for all three (at most " (share(worst(2).error(2))) ")."
                } @else {
                    "it is off by " (share(under_sky[0])) ", " (share(under_sky[1])) " and " (share(under_sky[2])) ": the highlight that it assumes is neither longer at a grazing view nor cut off at the horizon of the surface, where sky and ground meet."
                }
                " Its largest error there is " (percent(worst(2).approximated[2].1.largest)) " (" (worst(2).subject.short) ", where normal and view are " (fixed(worst(2).approximated[2].1.at.0, 0)) "° apart)."
            }
            p {
                "Both are exact in uniform light, and both keep the energy of the model, since its own directional albedo is their height. They are good answers to another question: how to draw one family of materials quickly. A laboratory that compares families cannot use them, as their error "
                @if farther.iter().any(|f| *f) { "grows with the distance from that family" } @else { "is as large as what it would compare" }
                "; this program therefore takes samples."
            }
        }
    }
}

#[cfg(test)]
mod tests;
