//! OpenPBR layer by layer: the fraction of the light that each layer reflects.

use glam::Vec3;
use maud::{Markup, html};
use rayon::prelude::*;

use super::{
    Chapter, Lab, Setting, StudyError, Table, albedo_at, fixed, furnace::verdict, image, number, pictures,
    svg,
};
use crate::{
    curves::draw::{Axis, Line, Mark, Plot, Series},
    optics::{Frame, albedo, colour::luminance, geometry::direction},
    parameter::Value,
    reference::encode8,
    reflection::{Factor, Surface, preset},
};

const MODEL: &str = "openpbr";
/// The thickest film of the pictures, in µm.
const THICKEST: f64 = 1.0;
/// The factor applied to the reflectance of the film over glass in its picture, which is only a few per cent.
const BRIGHTER: f32 = 6.0;

fn colour(name: &'static str, rgb: [u8; 3]) -> Setting {
    (name, Value::Colour(rgb))
}

/// Settings with more settings added; the latter take precedence.
fn with(settings: &[Setting], more: &[Setting]) -> Vec<Setting> {
    let kept = settings.iter().filter(|(name, _)| !more.iter().any(|m| m.0 == *name));
    kept.chain(more).cloned().collect()
}

/// A grey diffuse base of albedo one half below a dielectric boundary, under a smooth coat and half fuzz.
fn stack() -> Vec<Setting> {
    vec![
        colour("base_colour", [188; 3]),
        number("coat_weight", 1.0),
        number("coat_roughness", 0.1),
        number("fuzz_weight", 0.5),
    ]
}

/// A base that reflects nothing: no colour, and no boundary to the layer above.
fn nothing() -> [Setting; 2] {
    [number("base_weight", 0.0), number("specular_strength", 0.0)]
}

/// The albedo by layer for a viewer at an angle: fuzz, coat, boundary of the base, diffuse base.
///
/// A layer's share is the increase that it causes over a base that reflects nothing; the shares of the base
/// are the rest, by term.
fn shares(lab: &Lab, degrees: f64) -> Result<[f64; 4], StudyError> {
    let fuzz = lab.surface(MODEL, &with(&with(&stack(), &nothing()), &[number("coat_weight", 0.0)]))?;
    let coat = lab.surface(MODEL, &with(&stack(), &nothing()))?;
    let all = lab.surface(MODEL, &stack())?;
    let (fuzz, coat) = (albedo_at(&*fuzz, degrees).0, albedo_at(&*coat, degrees).0);
    let (all, specular) = albedo_at(&*all, degrees);
    Ok([fuzz, coat - fuzz, specular - coat, all - specular])
}

/// The albedo in red, green and blue for a viewer at an angle.
fn colour_at(surface: &dyn Surface, degrees: f64) -> Vec3 {
    let v = direction(degrees, 0.0);
    let frame = &Frame::LOCAL;
    albedo::directional(|l| surface.response(l, v, frame), v, frame).as_vec3()
}

/// One minus the smallest channel over the largest: 0 for greys.
fn saturation(rgb: Vec3) -> f64 {
    f64::from(1.0 - rgb.min_element() / rgb.max_element().max(1e-6))
}

/// Copper, bare and under coats: name and surface.
fn coppers(lab: &Lab) -> Result<Vec<(&'static str, std::sync::Arc<dyn Surface>)>, StudyError> {
    let missing = || StudyError::Data("copper has no optical constants".to_owned());
    let model = lab.registry.model(MODEL).ok_or_else(|| StudyError::NoModel(MODEL.to_owned()))?;
    let bare =
        with(&(model.preset)(preset::by_id("copper").ok_or_else(missing)?), &[number("roughness", 0.3)]);
    let coated = with(&bare, &[number("coat_weight", 1.0), number("coat_roughness", 0.1)]);
    let amber = with(&coated, &[colour("coat_colour", [255, 205, 120])]);
    Ok(vec![
        ("bare copper", lab.surface(MODEL, &bare)?),
        (
            "clear coat, without darkening",
            lab.surface(MODEL, &with(&coated, &[number("coat_darkening", 0.0)]))?,
        ),
        ("clear coat", lab.surface(MODEL, &coated)?),
        ("amber coat", lab.surface(MODEL, &amber)?),
    ])
}

/// A colour by angle as a band, starting with 0° at the left.
fn band(colours: &[(f64, Vec3)], (width, height): (u32, u32), alt: &str) -> Result<Markup, StudyError> {
    let last = colours.last().map_or(1.0, |c| c.0);
    let row: Vec<u8> = (0..width)
        .flat_map(|x| {
            let angle = last * (f64::from(x) + 0.5) / f64::from(width);
            let i = colours.partition_point(|c| c.0 <= angle).clamp(1, colours.len() - 1);
            let ((a, from), (b, to)) = (colours[i - 1], colours[i]);
            from.lerp(to, ((angle - a) / (b - a)) as f32).to_array().map(encode8)
        })
        .collect();
    image(&row.repeat(height as usize), (width, height), alt)
}

/// A film over a base.
struct Film {
    name: &'static str,
    settings: Vec<Setting>,
    factor: f32,
}

fn films() -> [Film; 2] {
    let film = |n: f64| [number("thin_film_weight", 1.0), number("thin_film_ior", n)];
    let black = colour("base_colour", [0; 3]);
    // Its n and k by these two: 2.70 + 3.82i, 2.48 + 3.39i, 2.31 + 3.04i.
    let titanium = [
        colour("base_colour", [206, 200, 194]),
        colour("specular_colour", [217, 216, 215]),
        number("metallic", 1.0),
    ];
    [
        Film { name: "soap film on black glass", settings: with(&film(1.33), &[black]), factor: BRIGHTER },
        Film { name: "oxide on titanium", settings: with(&film(2.3), &titanium), factor: 1.0 },
    ]
}

/// The reflectance of a film by thickness (µm, columns) and angle (0° to 90°, rows).
fn reflectances(lab: &Lab, film: &Film, (width, height): (u32, u32)) -> Result<Vec<Vec<Vec3>>, StudyError> {
    (0..width)
        .into_par_iter()
        .map(|x| {
            let d = THICKEST * f64::from(x) / f64::from(width - 1);
            let surface = lab.surface(MODEL, &with(&film.settings, &[number("thin_film_thickness", d)]))?;
            let at = |y: u32| {
                let angle = 90.0 * (f64::from(y) + 0.5) / f64::from(height);
                let cos_d = angle.to_radians().cos() as f32;
                surface.factor(Factor::Fresnel { cos_d }).unwrap_or(Vec3::ZERO)
            };
            Ok((0..height).map(at).collect())
        })
        .collect()
}

/// White materials that should reflect all the light that they receive: name and settings.
fn whites() -> Vec<(&'static str, Vec<Setting>)> {
    let white = [colour("base_colour", [255; 3])];
    let metal = with(&white, &[number("metallic", 1.0)]);
    let coat = [number("coat_weight", 1.0), number("coat_roughness", 0.2)];
    let film = [
        number("specular_ior", 1.1),
        number("thin_film_weight", 1.0),
        number("thin_film_ior", 2.0),
        number("thin_film_thickness", 0.2),
    ];
    vec![
        ("Body below a boundary, σ = 0", white.to_vec()),
        ("Body below a boundary, σ = 1", with(&white, &[number("base_diffuse_roughness", 1.0)])),
        ("Metal, r = 0.3", metal.clone()),
        ("Metal, r = 1", with(&metal, &[number("roughness", 1.0)])),
        (
            "Metal, r = 0.6, anisotropy 0.9",
            with(&metal, &[number("roughness", 0.6), number("specular_roughness_anisotropy", 0.9)]),
        ),
        ("Coat over the body", with(&white, &coat)),
        ("Coat over metal", with(&metal, &coat)),
        ("Fuzz over the body", with(&white, &[number("fuzz_weight", 1.0)])),
        ("Film of index 2 over a body of index 1.1", with(&white, &film)),
    ]
}

pub(super) fn chapter(lab: &mut Lab) -> Result<Chapter, StudyError> {
    let angles: Vec<f64> = if lab.settings.quick {
        vec![0.0, 60.0, 80.0]
    } else {
        (0..=17).map(|i| 5.0 * f64::from(i)).collect()
    };
    let (energy, raw_energy, [least, most], grown) = by_layer(lab, &angles)?;
    let (metal, raw_metal, drop) = coated_metal(lab, &angles)?;
    let (film, raw_film, swing) = iridescence(lab)?;
    let (white, raw_white, worst) = furnace_of(lab, &angles)?;

    let shown = grown > 0.0 && drop.0 > 0.0 && swing > 2.0;
    let finding = format!(
        "The coat sends back {} at 0° and {} at {:.0}°, and the body loses what it gains; a clear coat takes {:.0}\u{a0}% from the albedo of copper at normal incidence; the green reflectance of a soap film changes by a factor of {:.0} with its thickness.",
        fixed(least, 2),
        fixed(most, 2),
        angles.last().copied().unwrap_or_default(),
        100.0 * drop.0,
        swing
    );
    let body = html! {
        h3 { "Question" }
        p { "OpenPBR (Academy Software Foundation, version 1.1) stacks layers: fuzz over a coat over a mixture of metal and of a rough body below a dielectric boundary, which a thin film may cover. What does each of them add to the light that a surface sends back, and is the sum still at most what arrives?" }
        h3 { "Method" }
        p {
            "The measure is the directional albedo E(v) of the chapter on energy. The share of fuzz is the albedo of the material over a base that sends nothing back (weight of the base 0, specular strength 0) and without its coat; "
            "that of the coat is what the coat adds to it. What the complete material has beyond both is the share of the base, divided by term: its boundary and its body. The pictures of films show the reflectance F of the base, "
            "which is a factor of its microfacets, for every thickness and angle."
        }
        h3 { "Results" }
        (energy)
        (metal)
        (film)
        (white)
        h3 { "Conclusion" }
        div .conclusion {
            p {
                @if grown > 0.0 {
                    "The layers share one amount of light. Towards grazing angles the coat takes more of it (" (fixed(least, 2)) " at 0°, " (fixed(most, 2)) " at " (fixed(angles.last().copied().unwrap_or_default(), 0))
                    "°) and leaves less to the body."
                } @else {
                    "In these settings the share of the coat does not grow towards grazing angles."
                }
            }
            p {
                @if drop.0 > 0.0 {
                    "A clear coat is not neutral: it returns part of the light to the metal, which absorbs it again. Copper under it is darker by " (fixed(100.0 * drop.0, 0)) "\u{a0}% at normal incidence"
                    @if drop.1 > 0.0 { " and, with its darkening, more saturated than the metal below the same coat without it." } @else { "." }
                } @else {
                    "In these settings a clear coat does not darken copper."
                }
            }
            p {
                @if worst.1 > 1.01 {
                    "The sum is not always at most 1: “" (worst.0) "” sends back up to " (fixed(worst.1, 2)) ". The model subtracts from its body the albedo of a boundary without a film, returns to metal what an isotropic lobe would lose, and couples body and boundary in a way that gains a little where the body is rough; its declaration therefore does not claim that energy is conserved."
                } @else {
                    "No material of the table sends back more than arrives."
                }
            }
        }
    };
    Ok(Chapter {
        title: "OpenPBR, layer by layer",
        body,
        finding,
        shown,
        tables: vec![raw_energy, raw_metal, raw_film, raw_white],
    })
}

/// Energy by layer: the figure, the numbers, the coat's share at the first and at the last angle, and its
/// growth.
fn by_layer(lab: &mut Lab, angles: &[f64]) -> Result<(Markup, Table, [f64; 2], f64), StudyError> {
    let mut raw = Table::new("layers_energy", "angle_deg,fuzz,coat,boundary,body,total");
    let mut all = Vec::new();
    for angle in angles {
        let shares = shares(lab, *angle)?;
        let total = shares.iter().sum::<f64>();
        raw.row(&[], &[*angle, shares[0], shares[1], shares[2], shares[3], total]);
        all.push((*angle, shares, total));
    }
    let of = |i: usize| all.iter().map(|(a, shares, _)| (*a, shares[i])).collect::<Vec<_>>();
    let series =
        |name: &str, points, colour, line, mark| Series { name: name.to_owned(), points, colour, line, mark };
    let plot = Plot {
        title: "Directional albedo by layer against the angle of view".to_owned(),
        x: Axis::new("angle of view (°)", 0.0, 90.0, 10),
        y: Axis::new("directional albedo E", 0.0, 1.0, 6),
        series: vec![
            series("total", all.iter().map(|a| (a.0, a.2)).collect(), 6, Line::Solid, Mark::None),
            series("body", of(3), 1, Line::Solid, Mark::Square),
            series("boundary of the base", of(2), 0, Line::Dashed, Mark::Cross),
            series("coat", of(1), 2, Line::Solid, Mark::Disc),
            series("fuzz", of(0), 4, Line::Solid, Mark::Triangle),
        ],
        size: (720, 360),
        legend: true,
        ..Plot::default()
    };
    let figure = lab.figure(
        &svg(&plot),
        &html! { "The light that each layer sends back: a grey body of albedo 0.5 with the default boundary, under a clear coat of index 1.6 and fuzz of weight 0.5. The lines below “total” add up to it." },
    );
    let ends = [of(1).first().map_or(0.0, |p| p.1), of(1).last().map_or(0.0, |p| p.1)];
    Ok((figure, raw, ends, ends[1] - ends[0]))
}

/// The colour of coated copper: the figure, the numbers, the relative loss by a clear coat at 0°, and the gain of
/// saturation by its darkening.
fn coated_metal(lab: &mut Lab, angles: &[f64]) -> Result<(Markup, Table, (f64, f64)), StudyError> {
    let mut raw = Table::new("layers_coated_copper", "surface,angle_deg,red,green,blue,saturation");
    let size = lab.size(960, 48);
    let (mut bands, mut rows, mut normal) = (Vec::new(), Vec::new(), Vec::new());
    for (name, surface) in coppers(lab)? {
        let colours: Vec<_> = angles.iter().map(|a| (*a, colour_at(&*surface, *a))).collect();
        for (a, rgb) in &colours {
            raw.row(&[name], &[*a, f64::from(rgb.x), f64::from(rgb.y), f64::from(rgb.z), saturation(*rgb)]);
        }
        normal.push(colours[0].1);
        bands.push((name, band(&colours, size, name)?));
        let mut row = vec![name.to_owned()];
        for angle in [0.0, 80.0] {
            let rgb = colours.iter().find(|c| (c.0 - angle).abs() < 0.1).map_or(Vec3::ZERO, |c| c.1);
            let three = rgb.to_array().map(|x| fixed(f64::from(x), 2)).join("  ");
            row.extend([three, fixed(saturation(rgb), 2)]);
        }
        rows.push(row);
    }
    let figure = lab.figure(
        &html! { div .wide { @for (name, band) in &bands { p .over { (name) } (band) } } },
        &html! { "The colour of copper in uniform light, from normal incidence at the left to " (fixed(angles.last().copied().unwrap_or_default(), 0)) "° at the right." },
    );
    let table = lab.table(
        &html! { "Albedo in linear red, green and blue, and saturation (one minus the smallest over the largest of them)." },
        &["Surface", "0°", "saturation", "80°", "saturation"],
        &rows,
    );
    let loss = f64::from(1.0 - luminance(normal[2]) / luminance(normal[0]));
    let richer = saturation(normal[2]) - saturation(normal[1]);
    Ok((html! { (figure) (table) }, raw, (loss, richer)))
}

/// The pictures of films: the figure, the numbers, and the ratio of the largest to the smallest green
/// reflectance of the soap film at normal incidence.
fn iridescence(lab: &mut Lab) -> Result<(Markup, Table, f64), StudyError> {
    let mut raw = Table::new("layers_film", "film,thickness_um,red,green,blue");
    let (columns, height) = lab.size(240, 160);
    let (mut shown, mut swing) = (Vec::new(), 0.0);
    for film in films() {
        let all = reflectances(lab, &film, (columns, height))?;
        let normal: Vec<Vec3> = all.iter().map(|column| column[0]).collect();
        for (x, rgb) in normal.iter().enumerate() {
            let d = THICKEST * x as f64 / f64::from(columns - 1);
            raw.row(&[film.name], &[d, f64::from(rgb.x), f64::from(rgb.y), f64::from(rgb.z)]);
        }
        if shown.is_empty() {
            // From the thickness at which the film is complete: below 0.03 µm it fades.
            let green = || normal.iter().skip(columns as usize / 16).map(|rgb| f64::from(rgb.y));
            swing = green().fold(0.0, f64::max) / green().fold(f64::INFINITY, f64::min).max(1e-6);
        }
        // 0° at the bottom; each column is two pixels wide.
        let pixels: Vec<u8> = (0..height as usize)
            .rev()
            .flat_map(|y| all.iter().flat_map(move |column| [column[y]; 2]))
            .flat_map(|rgb| (film.factor * rgb).to_array().map(encode8))
            .collect();
        let alt = format!("Reflectance of {} by thickness and angle", film.name);
        shown.push((image(&pixels, (2 * columns, height), &alt)?, film.name));
    }
    let figure = lab.figure(
        &html! { div .wide { (pictures(&shown)) } },
        &html! {
            "The reflectance of films by thickness, from 0 at the left to " (fixed(THICKEST, 0)) " µm at the right, and angle, from 0° below to 90° above: soap water (index 1.33) on black glass, " (fixed(f64::from(BRIGHTER), 0))
            " times as bright as it is, and oxide (index 2.3) on titanium."
        },
    );
    Ok((figure, raw, swing))
}

/// The furnace of white materials: the table, the numbers, and the material that reflects most.
fn furnace_of(lab: &mut Lab, angles: &[f64]) -> Result<(Markup, Table, (&'static str, f64)), StudyError> {
    let mut raw = Table::new("layers_white", "material,angle_deg,albedo");
    let (mut rows, mut worst) = (Vec::new(), ("", 0.0));
    for (name, settings) in whites() {
        let surface = lab.surface(MODEL, &settings)?;
        let curve: Vec<_> = angles.iter().map(|a| (*a, albedo_at(&*surface, *a).0)).collect();
        for (a, e) in &curve {
            raw.row(&[name], &[*a, *e]);
        }
        let least = curve.iter().map(|p| p.1).fold(f64::INFINITY, f64::min);
        let most = curve.iter().map(|p| p.1).fold(0.0, f64::max);
        if most > worst.1 {
            worst = (name, most);
        }
        let at = |angle: f64| curve.iter().find(|p| (p.0 - angle).abs() < 0.1).map_or(f64::NAN, |p| p.1);
        rows.push(vec![
            name.to_owned(),
            fixed(at(0.0), 3),
            fixed(at(60.0), 3),
            fixed(at(80.0), 3),
            verdict(least, most).to_owned(),
        ]);
    }
    let table = lab.table(
        &html! { "Directional albedo of white materials: what absorbs nothing should have 1 at every angle." },
        &["Material", "E(0°)", "E(60°)", "E(80°)", "energy"],
        &rows,
    );
    Ok((table, raw, worst))
}
