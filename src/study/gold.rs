//! Phenomenon 3: material parameters that stay valid when the light changes.

use glam::Vec3;
use maud::html;

use super::{
    Chapter, Lab, StudyError, Table, fixed, image,
    lobe::{Contestant, paint_samples},
    percent, pictures, words,
};
use crate::{
    curves::data::PAINTS,
    optics::{TermSelection, colour::luminance},
    parameter::Value,
    reference::Picture,
    reflection::preset,
    scene::{Light, Object, Scene},
};

const SCENE: &str = include_str!("../../scenes/gold_three_lights.json");
/// The exponents tried.
const EXPONENTS: [i64; 20] = [1, 2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16, 20, 24, 28, 32, 40, 48, 64, 96];

/// Parameters of Blinn–Phong: linear colours of the diffuse part (k_d = 1) and of the highlight (k_s = 1).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Blinn {
    diffuse: Vec3,
    specular: Vec3,
    exponent: i64,
}

impl Blinn {
    /// Channels at the upper bound of the fit.
    fn bounds(&self) -> Vec<String> {
        let mut all = Vec::new();
        for (part, colour) in [("diffuse", self.diffuse), ("specular", self.specular)] {
            for (name, x) in ["red", "green", "blue"].into_iter().zip(colour.to_array()) {
                if x >= 1.0 {
                    all.push(format!("{part} {name}"));
                }
            }
        }
        all
    }

    fn put(&self, object: &mut Object) {
        let settings = [
            ("base_colour", preset::colour(self.diffuse)),
            ("specular_colour", preset::colour(self.specular)),
            ("k_a", Value::Number(0.0)),
            ("k_d", Value::Number(1.0)),
            ("k_s", Value::Number(1.0)),
            ("alpha", Value::Integer(self.exponent)),
        ];
        for (name, value) in settings {
            object.material.set(name, value);
        }
    }
}

/// The numbers d and s from 0 to 1 that minimise `Σ (d a + s b − y)²`, and that sum.
fn bounded(a: &[f64], b: &[f64], y: &[f64]) -> (f64, f64, f64) {
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let (aa, ab, bb, ay, by, yy) = (dot(a, a), dot(a, b), dot(b, b), dot(a, y), dot(b, y), dot(y, y));
    let sum = |d: f64, s: f64| d * d * aa + 2.0 * d * s * ab + s * s * bb - 2.0 * (d * ay + s * by) + yy;
    let over = |x: f64, by: f64| if by > 0.0 { (x / by).clamp(0.0, 1.0) } else { 0.0 };
    let determinant = aa * bb - ab * ab;
    let free = ((ay * bb - by * ab) / determinant, (by * aa - ay * ab) / determinant);
    let mut candidates = vec![];
    if (0.0..=1.0).contains(&free.0) && (0.0..=1.0).contains(&free.1) {
        candidates.push(free);
    }
    // On an edge, the other number is free.
    for edge in [0.0, 1.0] {
        candidates.push((edge, over(by - edge * ab, bb)));
        candidates.push((over(ay - edge * ab, aa), edge));
    }
    let best =
        candidates.into_iter().min_by(|p, q| sum(p.0, p.1).total_cmp(&sum(q.0, q.1))).unwrap_or_default();
    (best.0, best.1, sum(best.0, best.1))
}

/// One channel of a picture.
fn channel(picture: &Picture, c: usize) -> Vec<f64> {
    picture.pixels.iter().map(|p| f64::from(p[c])).collect()
}

/// Blinn–Phong's parameters closest to a picture, in linear light.
fn tune(lab: &Lab, scene: &Scene, wanted: &Picture, size: (u32, u32)) -> Blinn {
    let with = |exponent: i64, terms: TermSelection| {
        let mut scene = scene.clone();
        let white = Blinn { diffuse: Vec3::ONE, specular: Vec3::ONE, exponent };
        scene.objects.iter_mut().for_each(|o| white.put(o));
        lab.render(&scene, "blinn_phong", terms, size)
    };
    let matte = with(1, TermSelection::Diffuse);
    let of = |exponent: i64| {
        let gloss = with(exponent, TermSelection::Specular);
        let mut found = Blinn { diffuse: Vec3::ZERO, specular: Vec3::ZERO, exponent };
        let mut rest = 0.0;
        for c in 0..3 {
            let (d, s, off) = bounded(&channel(&matte, c), &channel(&gloss, c), &channel(wanted, c));
            found.diffuse[c] = d as f32;
            found.specular[c] = s as f32;
            rest += off / channel(wanted, c).iter().map(|y| y * y).sum::<f64>().max(1e-12);
        }
        (found, rest)
    };
    EXPONENTS
        .into_iter()
        .map(of)
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map_or(Blinn { diffuse: Vec3::ONE, specular: Vec3::ONE, exponent: 1 }, |best| best.0)
}

/// The difference of a picture from the reference: root mean square of the difference over that of the
/// reference, mean of the channels; and the mean brightness relative to the reference.
fn distance(picture: &Picture, wanted: &Picture) -> (f64, f64) {
    let mut rms = 0.0;
    for c in 0..3 {
        let (a, b) = (channel(picture, c), channel(wanted, c));
        let off: f64 = a.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum();
        rms += (off / b.iter().map(|b| b * b).sum::<f64>().max(1e-12)).sqrt() / 3.0;
    }
    let mean = |p: &Picture| p.pixels.iter().map(|p| f64::from(luminance(p.truncate()))).sum::<f64>();
    (rms, mean(picture) / mean(wanted).max(1e-12))
}

/// The shipped scene with a single object, under that object's light.
fn case(scene: &Scene, i: usize) -> Scene {
    let mut scene = scene.clone();
    scene.objects = vec![scene.objects.swap_remove(i)];
    scene.lights = vec![scene.lights.swap_remove(i)];
    scene.observer.position = scene.objects[0].position + Vec3::new(0.0, 1.5, 5.6);
    scene.observer.direction = Vec3::new(0.0, -1.5, -5.6);
    scene.observer.field_of_view = 21.0;
    scene
}

pub(super) fn chapter(lab: &mut Lab) -> Result<Chapter, StudyError> {
    let shipped = lab.scene(SCENE)?;
    let size = lab.size(480, 320);
    let mut cases: Vec<(&str, &str, Scene)> = vec![
        ("A", "white lamp in front", case(&shipped, 0)),
        ("B", "bulb of 2700 K in front, half as strong", case(&shipped, 1)),
        ("C", "cool light from behind", case(&shipped, 2)),
    ];
    let mut sky = case(&shipped, 0);
    sky.lights =
        vec![Light { light_type: "ambient".to_owned(), position: None, intensity: 1.0, ..Light::default() }];
    cases.push(("D", "uniform light", sky));

    let wanted: Vec<Picture> =
        cases.iter().map(|(_, _, scene)| lab.render(scene, "microfacet", TermSelection::All, size)).collect();
    let tuned: Vec<Blinn> = cases
        .iter()
        .zip(&wanted)
        .take(3)
        .map(|((_, _, scene), wanted)| tune(lab, scene, wanted, size))
        .collect();
    let with = |lab: &Lab, scene: &Scene, blinn: &Blinn| {
        let mut scene = scene.clone();
        scene.objects.iter_mut().for_each(|o| blinn.put(o));
        lab.render(&scene, "blinn_phong", TermSelection::All, size)
    };
    let kept: Vec<Picture> = cases.iter().map(|(_, _, scene)| with(lab, scene, &tuned[0])).collect();
    // A picture under a lamp leaves one question open: the response to uniform light.
    let open = {
        let mut scene = cases[3].2.clone();
        scene.objects.iter_mut().for_each(|o| {
            tuned[0].put(o);
            o.material.set("k_a", Value::Number(1.0));
        });
        distance(&lab.render(&scene, "blinn_phong", TermSelection::All, size), &wanted[3])
    };
    let distances: Vec<(f64, f64)> = kept.iter().zip(&wanted).map(|(a, b)| distance(a, b)).collect();
    let again: Vec<f64> = cases
        .iter()
        .zip(&wanted)
        .zip(&tuned)
        .map(|(((_, _, scene), wanted), blinn)| distance(&with(lab, scene, blinn), wanted).0)
        .collect();
    let mut raw = Table::new("gold_lights", "light,rms_with_A,brightness_with_A,rms_retuned");
    for (i, (id, name, _)) in cases.iter().enumerate() {
        if i == 3 {
            raw.row(&[&format!("{id} {name}, k_a = 0")], &[distances[i].0, distances[i].1, f64::NAN]);
            raw.row(&[&format!("{id} {name}, k_a = 1")], &[open.0, open.1, f64::NAN]);
        } else {
            raw.row(&[&format!("{id} {name}")], &[distances[i].0, distances[i].1, again[i]]);
        }
    }
    let mut figure = Vec::new();
    for (i, (id, name, scene)) in cases.iter().enumerate() {
        let pair = [(&wanted[i], "microfacet, measured gold"), (&kept[i], "Blinn–Phong, tuned under A")];
        for (picture, model) in pair {
            let alt = format!("Gold teapot, {name}, {model}");
            figure.push((
                image(&picture.to_rgb8(&scene.display), size, &alt)?,
                format!("{id}, {name}: {model}"),
            ));
        }
    }
    let figure: Vec<_> = figure.iter().map(|(m, w)| (m.clone(), w.as_str())).collect();
    let figure = lab.figure(
        &html! { div .pairs { @for pair in figure.chunks(2) { (pictures(pair)) } } },
        &html! {
            "Gold under four lights. Left: GGX microfacets (α = 0.5) with the measured n and k of gold, the same parameters everywhere. Right: Blinn–Phong with the parameters that come closest under light A. Scene "
            code { "gold_three_lights.json" } " has A, B and C. Under D, " (words("k_a")) " is undetermined; 0 is shown."
        },
    );
    let table = lab.table(
        &html! {
            "Difference of the Blinn–Phong picture from the physically based one: root mean square difference in linear light as a share of the picture’s own root mean square (mean of three channels), and mean brightness. "
            "“Retuned” is the same after fitting Blinn–Phong under that light itself. Light D reaches Blinn–Phong through " (words("k_a")) " alone, which a fit under a lamp leaves undetermined: "
            "the brightness is given for " (words("k_a")) " = 0 and 1. Nothing is tuned under D (–): only the product of " (words("k_a")) " and the diffuse colour answers there, and it can be given any colour."
        },
        &["Light", "RMS, tuned under A", "brightness", "RMS, retuned"],
        &cases
            .iter()
            .enumerate()
            .map(|(i, (id, name, _))| {
                if i == 3 {
                    let range = format!("{} to {}", percent(distances[i].1 - 1.0), percent(open.1 - 1.0));
                    return vec![format!("{id}, {name}"), "undetermined".to_owned(), range, "–".to_owned()];
                }
                vec![
                    format!("{id}, {name}"),
                    format!("{}\u{a0}%", fixed(100.0 * distances[i].0, 1)),
                    percent(distances[i].1 - 1.0),
                    again.get(i).map_or_else(|| "–".to_owned(), |x| format!("{}\u{a0}%", fixed(100.0 * x, 1))),
                ]
            })
            .collect::<Vec<_>>(),
    );
    let colour = |c: Vec3| format!("{:.2} {:.2} {:.2}", c.x, c.y, c.z);
    let mut parameters = Table::new("gold_parameters", "tuned_under,d_r,d_g,d_b,s_r,s_g,s_b,exponent");
    for ((id, ..), b) in cases.iter().zip(&tuned) {
        let numbers: Vec<f64> = b
            .diffuse
            .to_array()
            .into_iter()
            .chain(b.specular.to_array())
            .map(f64::from)
            .chain([b.exponent as f64])
            .collect();
        parameters.row(&[id], &numbers);
    }
    let parameter_table = lab.table(
        &html! { "The parameters of Blinn–Phong closest to the same gold under each light: linear diffuse and specular colour (red, green, blue) and exponent. One material should have one row." },
        &["Tuned under", "diffuse colour", "specular colour", "n"],
        &cases
            .iter()
            .zip(&tuned)
            .map(|((id, name, _), b)| {
                vec![format!("{id}, {name}"), colour(b.diffuse), colour(b.specular), b.exponent.to_string()]
            })
            .collect::<Vec<_>>(),
    );

    // The same question for measured paints, where no model is the reference.
    let mut transfer = Table::new("gold_paints", "paint,model,error_fitted_below_30,error_at_60_and_70");
    let mut rows = Vec::new();
    let mut moved: Vec<(&str, f64)> = Vec::new();
    for (id, name) in PAINTS {
        let near = paint_samples(id, |theta| theta <= 31.0)?;
        let far = paint_samples(id, |theta| theta >= 59.0)?;
        for contestant in Contestant::all() {
            if !["Blinn–Phong", "GGX"].contains(&contestant.name) {
                continue;
            }
            let fit = contestant.fit(lab.registry, &near);
            let there = contestant.error(lab.registry, &fit, &far);
            transfer.row(&[name, contestant.name], &[fit.error, there]);
            rows.push(vec![format!("{name}, {}", contestant.name), fixed(fit.error, 3), fixed(there, 3)]);
            moved.push((contestant.name, there));
        }
    }
    let transfer_table = lab.table(
        &html! {
            "Three measured paints: each model is fitted to light from within 30° of the normal and then, unchanged, compared with the measurement for light from 60° and 70°. Log error (0.1 is about 10\u{a0}%)."
        },
        &["Paint, model", "fitted, θ ≤ 30°", "predicted, θ = 60°, 70°"],
        &rows,
    );
    let of = |model: &str| -> Vec<f64> { moved.iter().filter(|m| m.0 == model).map(|m| m.1).collect() };
    let (blinn, ggx) = (of("Blinn–Phong"), of("GGX"));
    let wins = blinn.iter().zip(&ggx).filter(|(b, g)| g < b).count();

    let bounds = tuned[2].bounds();
    let control = (distances[1].0 - distances[0].0).abs() < 0.01;
    let rises = distances[2].0 / distances[0].0;
    let confirmed = control && rises > 1.5 && wins * 2 > blinn.len();
    let finding = format!(
        "Blinn–Phong tuned to gold under one lamp is {:.1}\u{a0}% off there and {:.1}\u{a0}% under a light from behind; light from 60° and more on measured paints is predicted better by GGX for {wins} of {}.",
        100.0 * distances[0].0,
        100.0 * distances[2].0,
        blinn.len()
    );
    let body = html! {
        h3 { "Question" }
        p { "The same material should need the same parameters under every light. For which models is that so?" }
        h3 { "Method" }
        p {
            "A teapot of gold is rendered with GGX microfacets, α = 0.5, and the exact Fresnel equations for the optical constants that Johnson and Christy (1972) measured at 630, 532 and 465 nm. "
            "Only the roughness is set by eye. Blinn–Phong is then tuned to that picture under light A, as an artist would do, but by least squares: the diffuse and the "
            "specular colour, each from 0 to 1 per channel, and the exponent that minimise the mean square difference in linear light. The ambient coefficient " (words("k_a")) " has no part in this picture and stays 0. With these parameters it is rendered under three other lights and compared again."
        }
        p {
            "Both models are linear in the light. A change of intensity or colour alone must therefore leave the relative difference unchanged; light B is this control. Light C changes the direction, light D the extent of the light."
        }
        p {
            "Because the physically based picture is the reference here, the comparison cannot tell whether it is right. The last table therefore uses measured paints: parameters fitted to light near the normal have to predict light from the side."
        }
        h3 { "Results" }
        (figure)
        (table)
        (parameter_table)
        (transfer_table)
        h3 { "Conclusion" }
        div .conclusion {
            p {
                @if control {
                    "The control holds: under B the difference is " (fixed(100.0 * distances[1].0, 1)) "\u{a0}%, as under A (" (fixed(100.0 * distances[0].0, 1)) "\u{a0}%). Blinn–Phong’s parameters do not depend on intensity and colour of the light. "
                } @else {
                    "The control fails: under B the difference is " (fixed(100.0 * distances[1].0, 1)) "\u{a0}% instead of " (fixed(100.0 * distances[0].0, 1)) "\u{a0}%, which is not expected of linear models. "
                }
                @if rises > 1.5 {
                    "They do depend on its direction. Under C the difference is " (fixed(100.0 * distances[2].0, 1)) "\u{a0}%, " (fixed(rises, 1)) " times as large, and the picture has " (fixed(100.0 * distances[2].1, 0)) "\u{a0}% of the brightness. "
                    "Retuning under C leaves " (fixed(100.0 * again[2], 1)) "\u{a0}%, at the price of other parameters for the same gold (the diffuse colour " (colour(tuned[0].diffuse)) " becomes " (colour(tuned[2].diffuse)) ")."
                    @if !bounds.is_empty() { " Some of these are at the bound of the fit, 1: " (bounds.join(", ")) "." }
                } @else {
                    "Under C the difference is " (fixed(100.0 * distances[2].0, 0)) "\u{a0}%, only " (fixed(rises, 1)) " times as large."
                }
            }
            p {
                "Uniform light (D) reaches Blinn–Phong through the coefficient " (words("k_a")) " alone, about which a picture under a lamp says nothing. Its answer is undetermined: with the diffuse colour found under A, "
                (words("k_a")) " from 0 to 1 gives " (fixed(100.0 * distances[3].1, 0)) "\u{a0}% to " (fixed(100.0 * open.1, 0)) "\u{a0}% of the brightness of gold, which answers by its albedo. "
                @if open.1 < 1.0 - 0.01 { "No legal " (words("k_a")) " reaches it." } @else { "The right " (words("k_a")) " has to be known from elsewhere." }
            }
            p {
                "On measured paints, GGX predicts the light from the side better than Blinn–Phong for " (wins) " of " (blinn.len()) " paints "
                @if let (Some(b), Some(g)) = (blinn.first(), ggx.first()) { "(Krylon blue: log error " (fixed(*g, 2)) " against " (fixed(*b, 2)) ")" }
                @if wins * 2 > blinn.len() { ". The parameters of the physically based model carry over to a light that they were not fitted to." } @else { ". The paints do not support the claim." }
            }
        }
    };
    Ok(Chapter {
        title: "Material parameters that stay valid when the light changes",
        body,
        finding,
        shown: confirmed,
        tables: vec![raw, parameters, transfer],
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_numbers_within_bounds_are_found() {
        let a = [1.0, 0.5, 0.2, 0.0];
        let b = [0.0, 0.3, 0.9, 1.0];
        let mix = |d: f64, s: f64| -> Vec<f64> { a.iter().zip(b).map(|(a, b)| d * a + s * b).collect() };
        let (d, s, rest) = bounded(&a, &b, &mix(0.3, 0.8));
        assert!((d - 0.3).abs() < 1e-9 && (s - 0.8).abs() < 1e-9 && rest.abs() < 1e-9);
        // Beyond the allowed range: the bound, and the best value of the other.
        let y = mix(0.3, 1.7);
        let (d, s, rest) = bounded(&a, &b, &y);
        assert_eq!(s, 1.0);
        for i in 0..=100 {
            let other = f64::from(i) / 100.0;
            let sum: f64 = mix(other, 1.0).iter().zip(&y).map(|(m, y)| (m - y).powi(2)).sum();
            assert!(sum >= rest - 1e-9, "{d} {other}");
        }
        assert_eq!(bounded(&a, &[0.0; 4], &mix(0.4, 0.0)).1, 0.0);
    }
}
