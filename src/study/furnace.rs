//! Phenomenon 2: no surface reflects more light than it receives.

use glam::Vec3;
use maud::html;

use super::{
    Chapter, Lab, StudyError, Table, albedo_at, at, cells, ends, fixed, grid, image, labels, percent,
    pictures, plot, series, text::values, words,
};
use crate::{
    curves::draw::{Axis, Line, Mark, Series},
    optics::{Frame, TermSelection, colour::luminance},
    parameter::Value,
    reference::{Picture, encode8},
    scene::{Light, Scene},
};

const SCENE: &str = include_str!("../../scenes/white_furnace.json");
/// Number of light directions in the furnace of lamps: the maximum for a scene.
const LAMPS: u16 = 256;
/// Exponents tried for the largest albedo. It decreases as the highlight narrows, so it is enough to start at
/// the smallest legal one.
const EXPONENTS: [i64; 6] = [0, 1, 2, 4, 8, 16];
/// Deviation from 1 beyond which a model loses or gains light.
const TOLERANCE: f64 = 0.01;

/// A white surface.
struct White {
    name: &'static str,
    /// True if the surface should return all light: nothing is absorbed or transmitted.
    whole: bool,
}

/// The largest albedo of a model of the Phong family over exponents and angles, and the exponent.
fn largest(lab: &Lab, id: &str, angles: &[f64]) -> Result<(f64, i64), StudyError> {
    let mut best = (0.0, 0);
    for n in EXPONENTS {
        let surface = lab.surface(id, &format!("k_d=1 k_s=1 alpha={n}"))?;
        let most = angles.iter().map(|a| albedo_at(&*surface, *a).0).fold(0.0, f64::max);
        if most > best.0 {
            best = (most, n);
        }
    }
    Ok(best)
}

/// The verdict on a curve of albedos.
pub(super) fn verdict(least: f64, most: f64) -> &'static str {
    match (least < 1.0 - TOLERANCE, most > 1.0 + TOLERANCE) {
        (false, false) => "conserves",
        (true, false) => "loses",
        (false, true) => "gains",
        (true, true) => "loses and gains",
    }
}

/// The picture in front of a white wall: the wall is uniform light at half the display's white.
fn before_white(picture: &Picture) -> Vec<u8> {
    picture
        .pixels
        .iter()
        .flat_map(|p| {
            let c = 0.5 * (p.truncate() + (1.0 - p.w) * Vec3::ONE);
            c.to_array().map(encode8)
        })
        .collect()
}

/// Evenly distributed lamps (a Fibonacci lattice) that together make uniform light of 1 lx: a Lambertian
/// surface under them has its base colour.
fn lamps() -> Vec<Light> {
    let golden = std::f32::consts::PI * (3.0 - 5f32.sqrt());
    (0..LAMPS)
        .map(|i| {
            let y = 1.0 - 2.0 * (f32::from(i) + 0.5) / f32::from(LAMPS);
            let (s, c) = (golden * f32::from(i)).sin_cos();
            let r = (1.0 - y * y).sqrt();
            Light {
                light_type: "directional".to_owned(),
                position: None,
                direction: Some(Vec3::new(r * c, y, r * s)),
                // Radiance 1/π from 4π sr, times the response's factor π.
                intensity: 4.0 / f32::from(LAMPS),
                ..Light::default()
            }
        })
        .collect()
}

/// Mean luminance of the pixels that objects cover fully, and the largest.
fn of_objects(picture: &Picture) -> (f64, f64) {
    let all: Vec<f64> =
        picture.pixels.iter().filter(|p| p.w > 0.999).map(|p| f64::from(luminance(p.truncate()))).collect();
    (all.iter().sum::<f64>() / all.len().max(1) as f64, all.iter().copied().fold(0.0, f64::max))
}

pub(super) fn chapter(lab: &mut Lab) -> Result<Chapter, StudyError> {
    let angles: Vec<f64> = if lab.settings.quick {
        vec![0.0, 60.0, 85.0]
    } else {
        vec![0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 75.0, 80.0, 85.0]
    };
    let mut raw = Table::new("furnace_albedo", "model,angle_deg,albedo");
    let mut curves = Vec::new();
    for [name, id, settings, whole] in cells(include_str!("furnace.txt")) {
        let surface = lab.surface(id, settings)?;
        let curve: Vec<(f64, f64)> = angles.iter().map(|a| (*a, albedo_at(&*surface, *a).0)).collect();
        for (a, e) in &curve {
            raw.row(&[name], &[*a, *e]);
        }
        let ambient = f64::from(surface.ambient_response(Vec3::Z, &Frame::LOCAL).y);
        let (least, _) = ends(&curve);
        let most = curve.iter().fold((0.0, 0.0), |m, p| if p.1 > m.1 { *p } else { m });
        curves.push((White { name, whole: whole == "whole" }, curve, ambient, least, most));
    }
    let rows: Vec<Vec<String>> = curves
        .iter()
        .map(|(white, curve, ambient, least, most)| {
            let mut row = vec![white.name.to_owned()];
            row.extend([0.0, 60.0, 85.0].map(|angle| fixed(at(curve, angle), 3)));
            row.push(format!("{} at {:.0}°", fixed(most.1, 3), most.0));
            row.extend([fixed(*ambient, 3), verdict(*least, most.1).to_owned()]);
            row
        })
        .collect();
    let albedos = grid(&["Model", "E(0°)", "E(60°)", "E(85°)", "largest E", "ambient", "energy"], &rows);
    let styles = [
        ("Lambert", 6, Line::Dotted, Mark::None),
        ("Phong, k_d = k_s = 1, n = 8", 3, Line::Solid, Mark::Square),
        ("Blinn–Phong, k_d = k_s = 1, n = 8", 1, Line::Solid, Mark::Triangle),
        ("Burley diffuse, roughness 1", 5, Line::Dotted, Mark::None),
        ("Ward–Dür 2006, k_s = 1, α = 0.3", 4, Line::Dashed, Mark::None),
        ("EON, roughness 1", 2, Line::Solid, Mark::Ring),
        ("GGX α = 0.8, F = 1", 0, Line::Dashed, Mark::Disc),
        ("… with Kulla–Conty", 0, Line::Solid, Mark::Cross),
    ];
    let lines: Vec<Series> = styles
        .iter()
        .filter_map(|(name, colour, line, mark)| {
            let (_, curve, ..) = curves.iter().find(|c| c.0.name == *name)?;
            let short = name.split(',').next().unwrap_or(name).replace('…', "GGX");
            Some(series(short, curve.clone(), (*colour, *line, *mark)))
        })
        .collect();
    let top = lines.iter().flat_map(|s| &s.points).map(|p| p.1).fold(1.2, f64::max);
    let plotted = plot(
        "Directional albedo of white surfaces against the angle of view",
        Axis::new("angle of view (°)", 0.0, 90.0, 10),
        Axis::new("directional albedo E", 0.0, (top * 5.0).ceil() / 5.0, 8),
        380,
        lines,
    );

    // Pictures of the furnace.
    let mut scene = lab.scene(SCENE)?;
    // A row of spheres, without the room above and below it.
    scene.observer.field_of_view = 4.769;
    let size = lab.size(1200, 210);
    let uniform = lab.render(&scene, "", TermSelection::All, size);
    let mut lit: Scene = scene.clone();
    lit.lights = lamps();
    // All light here has a direction, so nothing replaces uniform light.
    lit.objects.iter_mut().for_each(|o| o.material.set("k_a", Value::Number(0.0)));
    let lamps = lab.render(&lit, "", TermSelection::All, size);
    let names: Vec<&str> = scene.objects.iter().map(|o| o.name.as_deref().unwrap_or_default()).collect();
    let strip = |picture: &Picture, alt: &str| image(&before_white(picture), size, alt);
    let shown = html! {
        (pictures(&[(strip(&uniform, "White spheres in ambient light in front of a white wall")?, "")]))
        (pictures(&[(strip(&lamps, "White spheres in the light of 256 lamps in front of a white wall")?, "")]))
        (labels(&names))
    };
    let mut from_pictures = Table::new("furnace_pictures", "object,ambient_mean,lamps_mean,lamps_max");
    let picture_rows: Vec<Vec<String>> = names
        .iter()
        .enumerate()
        .map(|(i, name)| {
            let alone = |scene: &Scene| {
                let objects = vec![scene.objects[i].clone()];
                let scene = Scene { objects, ..scene.clone() };
                of_objects(&lab.render(&scene, "", TermSelection::All, (size.0 / 2, size.1 / 2)))
            };
            let (a, (b, c)) = (alone(&scene).0, alone(&lit));
            from_pictures.row(&[name], &[a, b, c]);
            vec![(*name).to_owned(), percent(a - 1.0), percent(b - 1.0), percent(c - 1.0)]
        })
        .collect();
    let head = ["Sphere", "ambient light, mean", "lamps, mean", "lamps, largest"];
    let brightness = grid(&head, &picture_rows);

    let find = |name: &str| curves.iter().find(|c| c.0.name == name);
    let range = |name: &str| find(name).map_or((f64::NAN, f64::NAN), |c| (c.3, c.4.1));
    let blinn = range("Blinn–Phong, k_d = k_s = 1, n = 8");
    let phong = range("Phong, k_d = k_s = 1, n = 8");
    let (blinn_most, phong_most) =
        (largest(lab, "blinn_phong", &[0.0, 60.0])?, largest(lab, "phong", &[0.0, 60.0])?);
    let single = range("GGX α = 0.8, F = 1");
    let compensated = range("… with Kulla–Conty");
    let k_a = find("Blinn–Phong, defaults").map_or(f64::NAN, |c| c.2);
    // Rounded up, so that the sentence is true.
    let off = (1000.0 * (compensated.0 - 1.0).abs().max((compensated.1 - 1.0).abs())).ceil() / 1000.0;
    let kept = |(least, most): (f64, f64)| verdict(least, most) == "conserves";
    let named = |keep: &dyn Fn(&White, &str) -> bool| {
        let kept = curves.iter().filter(|c| keep(&c.0, verdict(c.3, c.4.1)));
        kept.map(|c| c.0.name.trim_start_matches("… ")).collect::<Vec<_>>().join("; ")
    };
    let phong_family = |name: &str| name.starts_with("Phong") || name.starts_with("Blinn–Phong");
    let gaining = named(&|white, energy| energy.contains("gains") && !phong_family(white.name));
    let [incomplete, others] =
        [true, false].map(|whole| named(&|white, energy| energy.contains("loses") && white.whole == whole));
    let values = values! {
        albedos, curves: plotted, pictures: shown, brightness,
        lamps: f64::from(LAMPS), tolerance: TOLERANCE,
        exceeds: blinn.1 > 1.0 + TOLERANCE || phong.1 > 1.0 + TOLERANCE, blinn: blinn.1, phong: phong.1, k_a,
        blinn_most: blinn_most.0, blinn_exponent: blinn_most.1 as f64,
        phong_most: phong_most.0, phong_exponent: phong_most.1 as f64,
        kept: kept(compensated), never_gains: single.1 <= 1.0 + TOLERANCE, single_loss: 1.0 - single.0,
        off: off.max(0.001), compensated_least: compensated.0, compensated_most: compensated.1,
        none_gains: gaining.is_empty(), gaining: words(&gaining),
        none_loses: incomplete.is_empty(), incomplete: words(&incomplete),
        has_others: !others.is_empty(), others: words(&others),
    };
    let confirmed = blinn.1 > 1.0 + TOLERANCE && kept(compensated);
    lab.chapter(include_str!("furnace.html"), &values, confirmed, vec![raw, from_pictures])
}
