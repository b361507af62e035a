//! Phenomenon 3: material parameters that stay valid when the light changes.

use glam::Vec3;
use maud::html;

use super::{
    Chapter, Lab, StudyError, Table, fixed, grid, image,
    lobe::{Contestant, paint_samples},
    percent, pictures, share,
    text::values,
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
    let light =
        Light { light_type: "ambient".to_owned(), position: None, intensity: 1.0, ..Light::default() };
    let cases = [
        ("A", "white lamp in front", case(&shipped, 0)),
        ("B", "bulb of 2700 K in front, half as strong", case(&shipped, 1)),
        ("C", "cool light from behind", case(&shipped, 2)),
        ("D", "uniform light", Scene { lights: vec![light], ..case(&shipped, 0) }),
    ];

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
    let mut shown = Vec::new();
    for (i, (id, name, scene)) in cases.iter().enumerate() {
        let pair = [(&wanted[i], "microfacet, measured gold"), (&kept[i], "Blinn–Phong, tuned under A")];
        for (picture, model) in pair {
            let alt = format!("Gold teapot, {name}, {model}");
            let picture = image(&picture.to_rgb8(&scene.display), size, &alt)?;
            shown.push((picture, format!("{id}, {name}: {model}")));
        }
    }
    let shown = html! { @for pair in shown.chunks(2) { (pictures(pair)) } };
    let mut rows = Vec::new();
    for (i, (id, name, _)) in cases.iter().enumerate() {
        let ((rms, brightness), none) = (distances[i], "–".to_owned());
        let brightness = percent(brightness - 1.0);
        let numbers = match again.get(i) {
            Some(again) => [share(rms, 1), brightness, share(*again, 1)],
            None => ["undetermined".to_owned(), format!("{brightness} to {}", percent(open.1 - 1.0)), none],
        };
        rows.push([format!("{id}, {name}")].into_iter().chain(numbers).collect());
    }
    let differences = grid(&["Light", "RMS, tuned under A", "brightness", "RMS, retuned"], &rows);
    let colour = |c: Vec3| format!("{:.2} {:.2} {:.2}", c.x, c.y, c.z);
    let mut parameters = Table::new("gold_parameters", "tuned_under,d_r,d_g,d_b,s_r,s_g,s_b,exponent");
    let mut rows = Vec::new();
    for ((id, name, _), b) in cases.iter().zip(&tuned) {
        let colours = b.diffuse.to_array().into_iter().chain(b.specular.to_array()).map(f64::from);
        parameters.row(&[id], &colours.chain([b.exponent as f64]).collect::<Vec<_>>());
        rows.push(vec![
            format!("{id}, {name}"),
            colour(b.diffuse),
            colour(b.specular),
            b.exponent.to_string(),
        ]);
    }
    let parameter_table = grid(&["Tuned under", "diffuse colour", "specular colour", "n"], &rows);

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
    let transferred = grid(&["Paint, model", "fitted, θ ≤ 30°", "predicted, θ = 60°, 70°"], &rows);

    let of = |model: &str| -> Vec<f64> { moved.iter().filter(|m| m.0 == model).map(|m| m.1).collect() };
    let (blinn, ggx) = (of("Blinn–Phong"), of("GGX"));
    let wins = blinn.iter().zip(&ggx).filter(|(b, g)| g < b).count();

    let bounds = tuned[2].bounds();
    let control = (distances[1].0 - distances[0].0).abs() < 0.01;
    let rises = distances[2].0 / distances[0].0;
    let carries = wins * 2 > blinn.len();
    let values = values! {
        pictures: shown, differences, parameters: parameter_table, transfer: transferred,
        control, off_a: distances[0].0, off_b: distances[1].0, off_c: distances[2].0,
        rises: rises > 1.5, rise: rises, brightness_c: distances[2].1, again_c: again[2],
        diffuse_a: colour(tuned[0].diffuse), diffuse_c: colour(tuned[2].diffuse),
        bound: !bounds.is_empty(), bounds: bounds.join(", "),
        brightness_d: distances[3].1, brightness_open: open.1, too_dark: open.1 < 1.0 - 0.01,
        wins, paints: blinn.len(), carries, blinn: blinn[0], ggx: ggx[0],
    };
    let confirmed = control && rises > 1.5 && carries;
    lab.chapter(include_str!("gold.html"), &values, confirmed, vec![raw, parameters, transfer])
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
