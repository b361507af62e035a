//! OpenPBR layer by layer: the fraction of the light that each layer reflects.

use glam::Vec3;
use maud::{Markup, html};
use rayon::prelude::*;

use super::{
    Chapter, Lab, StudyError, Table, albedo_at, at, cells, directional, ends, fixed, furnace::verdict, grid,
    image, pictures, plot, series, set, text::values,
};
use crate::{
    curves::draw::{Axis, Line, Mark},
    optics::colour::{Encoding, luminance},
    parameter::Values,
    reference::encode8,
    reflection::{Factor, Surface, preset},
};

const MODEL: &str = "openpbr";
/// The thickest film of the pictures, in µm.
const THICKEST: f64 = 1.0;
/// The factor applied to the reflectance of the film over glass in its picture, which is only a few per cent.
const BRIGHTER: f32 = 6.0;

/// A grey diffuse base of albedo one half below a dielectric boundary, under a smooth coat and half fuzz.
const STACK: &str = "base_colour=188,188,188 coat_weight=1 coat_roughness=0.1 fuzz_weight=0.5";
/// A base that reflects nothing: no colour, and no boundary to the layer above.
const NOTHING: &str = "base_weight=0 specular_strength=0";

/// The albedo by layer for a viewer at an angle: fuzz, coat, boundary of the base, diffuse base.
///
/// A layer's share is the increase that it causes over a base that reflects nothing; the shares of the base
/// are the rest, by term.
fn shares(lab: &Lab, degrees: f64) -> Result<[f64; 4], StudyError> {
    let fuzz = lab.surface(MODEL, &format!("{STACK} {NOTHING} coat_weight=0"))?;
    let coat = lab.surface(MODEL, &format!("{STACK} {NOTHING}"))?;
    let all = lab.surface(MODEL, STACK)?;
    let (fuzz, coat) = (albedo_at(&*fuzz, degrees).0, albedo_at(&*coat, degrees).0);
    let (all, specular) = albedo_at(&*all, degrees);
    Ok([fuzz, coat - fuzz, specular - coat, all - specular])
}

/// One minus the smallest channel over the largest: 0 for greys.
fn saturation(rgb: Vec3) -> f64 {
    f64::from(1.0 - rgb.min_element() / rgb.max_element().max(1e-6))
}

/// Copper, bare and under coats: name and surface.
fn coppers(lab: &Lab) -> Result<Vec<(&'static str, std::sync::Arc<dyn Surface>)>, StudyError> {
    let missing = || StudyError::Data("copper has no optical constants".to_owned());
    let copper = preset::by_id("copper").ok_or_else(missing)?;
    let surface = |settings: &str| -> Result<_, StudyError> {
        let (model, set) = set(lab.registry, MODEL, &format!("roughness=0.3 {settings}"))?;
        let mut values = Values::default();
        (model.preset)(copper).into_iter().for_each(|(name, value)| values.set(name, value));
        values.0.extend(set.0);
        Ok(model.instantiate(&values, Encoding::Srgb))
    };
    Ok(vec![
        ("bare copper", surface("")?),
        ("clear coat, without darkening", surface("coat_weight=1 coat_roughness=0.1 coat_darkening=0")?),
        ("clear coat", surface("coat_weight=1 coat_roughness=0.1")?),
        ("amber coat", surface("coat_weight=1 coat_roughness=0.1 coat_colour=255,205,120")?),
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

/// Films over a base: name, settings, and the factor in pictures.
const FILMS: [(&str, &str, f32); 2] = [
    ("soap film on black glass", "thin_film_weight=1 thin_film_ior=1.33 base_colour=0,0,0", BRIGHTER),
    // The n and k of titanium by its two colours: 2.70 + 3.82i, 2.48 + 3.39i, 2.31 + 3.04i.
    (
        "oxide on titanium",
        "thin_film_weight=1 thin_film_ior=2.3 metallic=1 base_colour=206,200,194 specular_colour=217,216,215",
        1.0,
    ),
];

/// The reflectance of a film by thickness (µm, columns) and angle (0° to 90°, rows).
fn reflectances(lab: &Lab, film: &str, (width, height): (u32, u32)) -> Result<Vec<Vec<Vec3>>, StudyError> {
    (0..width)
        .into_par_iter()
        .map(|x| {
            let d = THICKEST * f64::from(x) / f64::from(width - 1);
            let surface = lab.surface(MODEL, &format!("{film} thin_film_thickness={d}"))?;
            let at = |y: u32| {
                let angle = 90.0 * (f64::from(y) + 0.5) / f64::from(height);
                let cos_d = angle.to_radians().cos() as f32;
                surface.factor(Factor::Fresnel { cos_d }).unwrap_or(Vec3::ZERO)
            };
            Ok((0..height).map(at).collect())
        })
        .collect()
}

pub(super) fn chapter(lab: &mut Lab) -> Result<Chapter, StudyError> {
    let angles: Vec<f64> = if lab.settings.quick {
        vec![0.0, 60.0, 80.0]
    } else {
        (0..=17).map(|i| 5.0 * f64::from(i)).collect()
    };
    let (energy, raw_energy, [least, most]) = by_layer(lab, &angles)?;
    let (bands, copper, raw_copper, [drop, enrichment]) = coated_metal(lab, &angles)?;
    let (films, raw_films, swing) = iridescence(lab)?;
    let (white, raw_white, (worst, worst_albedo)) = furnace_of(lab, &angles)?;
    let values = values! {
        energy, least, most, grows: most > least, last: angles.last().copied().unwrap_or_default(),
        bands, copper, drop, darkens: drop > 0.0, enriches: enrichment > 0.0,
        films, swing, thickest: THICKEST, brighter: f64::from(BRIGHTER),
        white, worst, worst_albedo, gains: worst_albedo > 1.01,
    };
    let shown = most > least && drop > 0.0 && swing > 2.0;
    lab.chapter(
        include_str!("layers.html"),
        &values,
        shown,
        vec![raw_energy, raw_copper, raw_films, raw_white],
    )
}

/// Energy by layer: the plot, the numbers, and the coat's share at the first and at the last angle.
fn by_layer(lab: &Lab, angles: &[f64]) -> Result<(Markup, Table, [f64; 2]), StudyError> {
    let mut raw = Table::new("layers_energy", "angle_deg,fuzz,coat,boundary,body,total");
    let mut all = Vec::new();
    for angle in angles {
        let shares = shares(lab, *angle)?;
        let total = shares.iter().sum::<f64>();
        raw.row(&[], &[*angle, shares[0], shares[1], shares[2], shares[3], total]);
        all.push((*angle, shares, total));
    }
    let of = |i: usize| all.iter().map(|(a, shares, _)| (*a, shares[i])).collect::<Vec<_>>();
    let plot = plot(
        "Directional albedo by layer against the angle of view",
        Axis::new("angle of view (°)", 0.0, 90.0, 10),
        Axis::new("directional albedo E", 0.0, 1.0, 6),
        360,
        vec![
            series("total", all.iter().map(|a| (a.0, a.2)).collect(), (6, Line::Solid, Mark::None)),
            series("body", of(3), (1, Line::Solid, Mark::Square)),
            series("boundary of the base", of(2), (0, Line::Dashed, Mark::Cross)),
            series("coat", of(1), (2, Line::Solid, Mark::Disc)),
            series("fuzz", of(0), (4, Line::Solid, Mark::Triangle)),
        ],
    );
    let ends = [all.first(), all.last()].map(|end| end.map_or(0.0, |(_, shares, _)| shares[1]));
    Ok((plot, raw, ends))
}

/// The colour of coated copper: the bands, the table, the numbers, the relative loss by a clear coat at 0°, and the
/// gain of saturation by its darkening.
fn coated_metal(lab: &Lab, angles: &[f64]) -> Result<(Markup, Markup, Table, [f64; 2]), StudyError> {
    let mut raw = Table::new("layers_coated_copper", "surface,angle_deg,red,green,blue,saturation");
    let size = lab.size(960, 48);
    let (mut bands, mut rows, mut normal) = (Vec::new(), Vec::new(), Vec::new());
    for (name, surface) in coppers(lab)? {
        let colours: Vec<_> =
            angles.iter().map(|a| (*a, directional(&*surface, *a, |terms| terms).as_vec3())).collect();
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
    let bands = html! { @for (name, band) in &bands { p .over { (name) } (band) } };
    let table = grid(&["Surface", "0°", "saturation", "80°", "saturation"], &rows);
    let loss = f64::from(1.0 - luminance(normal[2]) / luminance(normal[0]));
    let richer = saturation(normal[2]) - saturation(normal[1]);
    Ok((bands, table, raw, [loss, richer]))
}

/// The pictures of films, the numbers, and the ratio of the largest to the smallest green reflectance of the soap
/// film at normal incidence.
fn iridescence(lab: &Lab) -> Result<(Markup, Table, f64), StudyError> {
    let mut raw = Table::new("layers_film", "film,thickness_um,red,green,blue");
    let (columns, height) = lab.size(240, 160);
    let (mut shown, mut swing) = (Vec::new(), 0.0);
    for (name, film, factor) in FILMS {
        let all = reflectances(lab, film, (columns, height))?;
        let normal: Vec<Vec3> = all.iter().map(|column| column[0]).collect();
        for (x, rgb) in normal.iter().enumerate() {
            let d = THICKEST * x as f64 / f64::from(columns - 1);
            raw.row(&[name], &[d, f64::from(rgb.x), f64::from(rgb.y), f64::from(rgb.z)]);
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
            .flat_map(|rgb| (factor * rgb).to_array().map(encode8))
            .collect();
        let alt = format!("Reflectance of {name} by thickness and angle");
        shown.push((image(&pixels, (2 * columns, height), &alt)?, name));
    }
    Ok((pictures(&shown), raw, swing))
}

/// The furnace of white materials: the table, the numbers, and the material that reflects most.
fn furnace_of(lab: &Lab, angles: &[f64]) -> Result<(Markup, Table, (&'static str, f64)), StudyError> {
    let mut raw = Table::new("layers_white", "material,angle_deg,albedo");
    let (mut rows, mut worst) = (Vec::new(), ("", 0.0));
    // Materials that should reflect all the light that they receive.
    for [name, settings] in cells(include_str!("layers.txt")) {
        let surface = lab.surface(MODEL, &format!("base_colour=255,255,255 {settings}"))?;
        let curve: Vec<_> = angles.iter().map(|a| (*a, albedo_at(&*surface, *a).0)).collect();
        for (a, e) in &curve {
            raw.row(&[name], &[*a, *e]);
        }
        let (least, most) = ends(&curve);
        if most > worst.1 {
            worst = (name, most);
        }
        let albedos = [0.0, 60.0, 80.0].map(|angle| fixed(at(&curve, angle), 3));
        let row = [name.to_owned()].into_iter().chain(albedos).chain([verdict(least, most).to_owned()]);
        rows.push(row.collect());
    }
    Ok((grid(&["Material", "E(0°)", "E(60°)", "E(80°)", "energy"], &rows), raw, worst))
}
