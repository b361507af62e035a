//! Phenomenon 1: every surface becomes a mirror at grazing angles.

use glam::Vec3;
use maud::html;

use super::{
    Chapter, Lab, StudyError, Table, albedo_at, alpha, at, fixed, grid, image, pictures, plot, series,
    text::values,
};
use crate::{
    curves::draw::{Axis, Line, Mark},
    optics::{
        TermSelection,
        colour::luminance,
        fresnel::{conductor, normal_reflectance, schlick},
    },
    reference::Picture,
    reflection::{Measured, preset},
};

const SCENE: &str = include_str!("../../scenes/fresnel_effect.json");
/// Angles of the table, in degrees.
const ANGLES: [f64; 5] = [0.0, 45.0, 60.0, 75.0, 85.0];
/// The id of the material whose reflectance falls before it rises.
const ALUMINIUM: &str = "aluminium";
/// Measured materials: id, name, and the colour of its curves if the plot has them.
const MATERIALS: [(&str, &str, Option<usize>); 6] = [
    ("water", "Water", None),
    ("n_bk7", "Glass (N-BK7)", Some(0)),
    ("diamond", "Diamond", Some(2)),
    ("copper", "Copper", None),
    ("gold", "Gold", Some(4)),
    (ALUMINIUM, "Aluminium", Some(3)),
];
/// Blinn–Phong with the width of this α and, at normal incidence, the brightness of glass: n = 2/α² − 2 and
/// k_s = F₀/(4 α²). The shipped scene uses the same values.
const ALPHA: f64 = 0.15;
const EXPONENT: i64 = 87;
const K_S: f64 = 0.444;

/// A model of the pictures.
struct Pictured {
    id: &'static str,
    name: &'static str,
    /// The addition to the name where there is room.
    variety: &'static str,
}

const BLINN_PHONG: Pictured = Pictured { id: "blinn_phong", name: "Blinn–Phong", variety: "" };
const MICROFACET: Pictured =
    Pictured { id: "microfacet", name: "Microfacet", variety: " (GGX, exact Fresnel equations)" };

/// The brightness of the highlights with the lamp in front alone, and with those behind alone.
struct Peaks {
    front: f64,
    behind: f64,
}

impl Peaks {
    fn ratio(&self) -> f64 {
        self.behind / self.front
    }
}

fn cosine(degrees: f64) -> f32 {
    // The cosine of 90° is exactly zero.
    degrees.to_radians().cos().max(0.0) as f32
}

/// Refractive index and extinction at 532 nm; dielectrics do not absorb at the surface.
fn constants(material: &Measured) -> (f32, f32) {
    (material.n[1], if material.metal { material.k[1] } else { 0.0 })
}

fn exact(material: &Measured, degrees: f64) -> f64 {
    let (n, k) = constants(material);
    f64::from(conductor(n, k, cosine(degrees)))
}

fn approximate(material: &Measured, degrees: f64) -> f64 {
    let (n, k) = constants(material);
    f64::from(schlick(Vec3::splat(normal_reflectance(n, k)), cosine(degrees)).x)
}

/// The angle and the size of the largest error of Schlick's approximation.
fn worst(material: &Measured) -> (f64, f64) {
    (0..=180)
        .map(|i| f64::from(i) * 0.5)
        .map(|a| (a, approximate(material, a) - exact(material, a)))
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
        .unwrap_or_default()
}

/// The angle and the value of the lowest reflectance, if that is not at normal incidence.
fn dip(material: &Measured) -> Option<(f64, f64)> {
    (0..=90)
        .map(|a| (f64::from(a), exact(material, f64::from(a))))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|least| least.0 > 0.0)
}

/// Mean luminance of the brightest hundredth of the pixels that objects cover fully. A single pixel would depend on the
/// sample positions.
pub(super) fn brightest(picture: &Picture) -> f64 {
    let mut all: Vec<f64> =
        picture.pixels.iter().filter(|p| p.w > 0.999).map(|p| f64::from(luminance(p.truncate()))).collect();
    all.sort_by(|a, b| b.total_cmp(a));
    all.truncate((all.len() / 100).max(1));
    all.iter().sum::<f64>() / all.len().max(1) as f64
}

pub(super) fn chapter(lab: &mut Lab) -> Result<Chapter, StudyError> {
    let materials: Vec<_> = MATERIALS
        .into_iter()
        .filter_map(|(id, name, colour)| Some((preset::by_id(id)?, name, colour)))
        .collect();

    // Reflectance by angle.
    let mut raw = Table::new("fresnel_reflectance", "material,angle_deg,exact,schlick");
    for (m, name, _) in &materials {
        for i in 0..=180 {
            let a = f64::from(i) * 0.5;
            raw.row(&[name], &[a, exact(m, a), approximate(m, a)]);
        }
    }
    let rows: Vec<Vec<String>> = materials
        .iter()
        .map(|(m, name, _)| {
            let (n, k) = constants(m);
            let (angle, error) = worst(m);
            let mut row = vec![
                (*name).to_owned(),
                fixed(f64::from(n), 3),
                if m.metal { fixed(f64::from(k), 3) } else { "–".to_owned() },
            ];
            row.extend(ANGLES.iter().map(|a| fixed(exact(m, *a), 3)));
            row.push(format!("{} at {angle:.0}°", fixed(error, 3)));
            row
        })
        .collect();
    let schlick_worst = materials.iter().map(|(m, ..)| worst(m).1.abs()).fold(0.0, f64::max);
    let mut lines = Vec::new();
    for (m, name, colour) in &materials {
        let Some(colour) = *colour else { continue };
        let curve = |f: &dyn Fn(f64) -> f64| (0..=90).map(|a| (f64::from(a), f(f64::from(a)))).collect();
        lines.push(series(*name, curve(&|a| exact(m, a)), (colour, Line::Solid, Mark::None)));
        let approximate = curve(&|a| approximate(m, a));
        lines.push(series("… after Schlick", approximate, (colour, Line::Dashed, Mark::None)));
    }
    let constant = vec![(0.0, 0.04), (90.0, 0.04)];
    lines.push(series("Blinn–Phong, kₛ = 0.04", constant, (6, Line::Dotted, Mark::None)));
    let reflectance = plot(
        "Fresnel reflectance against the angle of incidence",
        Axis::new("angle of incidence (°)", 0.0, 90.0, 10),
        Axis::new("reflectance at 532 nm", 0.0, 1.0, 6),
        380,
        lines,
    );
    let head = ["Material", "n", "k", "0°", "45°", "60°", "75°", "85°", "Schlick’s largest error"];
    let table = grid(&head, &rows);

    // The curves of the models' lobes.
    let glass = format!("fresnel=dielectric diffuse=none ior=1.5 {}", alpha(ALPHA));
    let glass = lab.surface("microfacet", &glass)?;
    let plastic = format!("alpha={EXPONENT} k_s={K_S} base_colour=0,0,0");
    let plastic = lab.surface("blinn_phong", &plastic)?;
    let step = if lab.settings.quick { 15.0 } else { 5.0 };
    let mut angles: Vec<f64> = (0..=(85.0 / step) as u32).map(|i| f64::from(i) * step).collect();
    angles.extend((!lab.settings.quick).then_some(88.0));
    angles.extend(lab.settings.quick.then_some(85.0));
    let lobe = |surface: &dyn crate::reflection::Surface| -> Vec<(f64, f64)> {
        let start = albedo_at(surface, 0.0).1;
        angles.iter().map(|a| (*a, albedo_at(surface, *a).1 / start)).collect()
    };
    let (glass_lobe, plastic_lobe) = (lobe(&*glass), lobe(&*plastic));
    let ideal: Vec<(f64, f64)> =
        angles.iter().map(|a| (*a, f64::from(conductor(1.5, 0.0, cosine(*a))) / 0.04)).collect();
    let mut lobes = Table::new("fresnel_lobes", "angle_deg,smooth_glass,microfacet,blinn_phong");
    for i in 0..angles.len() {
        lobes.row(&[], &[angles[i], ideal[i].1, glass_lobe[i].1, plastic_lobe[i].1]);
    }
    let all_at = |angle: f64| [&ideal, &glass_lobe, &plastic_lobe].map(|curve| at(curve, angle));
    let [growth_smooth, growth_microfacet, growth_blinn_phong] = all_at(75.0);
    let [grazing_smooth, grazing_microfacet, _] = all_at(85.0);
    let relative = plot(
        "Reflection of the specular lobe relative to normal incidence",
        Axis::new("angle of view (°)", 0.0, 90.0, 10),
        Axis::log("reflection relative to 0°", 0.01, 30.0),
        360,
        vec![
            series("smooth glass, exact", ideal, (6, Line::Dotted, Mark::None)),
            series(format!("microfacet, α = {ALPHA}"), glass_lobe, (0, Line::Solid, Mark::Disc)),
            series(format!("Blinn–Phong, n = {EXPONENT}"), plastic_lobe, (1, Line::Dashed, Mark::Triangle)),
        ],
    );

    // Pictures.
    let mut scene = lab.scene(SCENE)?;
    // A row of objects, without the room above and below it.
    scene.observer.field_of_view = 19.6;
    let size = lab.size(960, 366);
    let peaks_of = |model: &Pictured| -> Result<_, StudyError> {
        let picture = lab.render(&scene, model.id, TermSelection::All, size);
        let name = format!("{}{}", model.name, model.variety);
        let shown = image(&picture.to_rgb8(&scene.display), size, &format!("Black glass under {name}"))?;
        let alone = |keep: &dyn Fn(usize) -> bool| {
            let mut scene = scene.clone();
            let mut i = 0;
            scene.lights.retain(|_| {
                i += 1;
                keep(i - 1)
            });
            brightest(&lab.render(&scene, model.id, TermSelection::All, size))
        };
        let peaks = Peaks { front: alone(&|i| i == 0), behind: alone(&|i| i > 0) };
        Ok((pictures(&[(shown, &name)]), peaks))
    };
    let (blinn_phong_picture, blinn_phong) = peaks_of(&BLINN_PHONG)?;
    let (microfacet_picture, microfacet) = peaks_of(&MICROFACET)?;
    let both = [(BLINN_PHONG, &blinn_phong), (MICROFACET, &microfacet)];
    let mut from_pictures = Table::new("fresnel_pictures", "model,front_peak,behind_peak");
    for (model, peaks) in &both {
        from_pictures.row(&[model.id], &[peaks.front, peaks.behind]);
    }
    let peaks = both.map(|(model, peaks)| {
        let numbers = [fixed(peaks.front, 3), fixed(peaks.behind, 3), fixed(peaks.ratio(), 1)];
        [model.name.to_owned()].into_iter().chain(numbers).collect::<Vec<_>>()
    });
    let peaks = grid(&["Model", "lamp in front", "lamps behind", "behind / front"], &peaks);
    let dip = preset::by_id(ALUMINIUM).and_then(dip);
    let physical = growth_microfacet > 2.0 && (growth_microfacet / growth_smooth).ln().abs() < 0.5;
    let classical = growth_blinn_phong > 2.0;
    let (dip_angle, least) = dip.unwrap_or_default();
    let values = values! {
        alpha: ALPHA, exponent: EXPONENT as f64, k_s: K_S,
        reflectance, materials: table, relative, pictures: html! { (blinn_phong_picture) (microfacet_picture) }, peaks,
        physical, classical, growth_smooth, growth_microfacet, growth_blinn_phong, grazing_smooth, grazing_microfacet,
        below: grazing_microfacet < grazing_smooth,
        ratio_microfacet: microfacet.ratio(), ratio_blinn_phong: blinn_phong.ratio(),
        schlick_worst, has_dip: dip.is_some(), dip_angle, dip: least,
    };
    let tables = vec![raw, lobes, from_pictures];
    lab.chapter(include_str!("fresnel.html"), &values, physical && !classical, tables)
}
