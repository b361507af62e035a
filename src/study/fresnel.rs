//! Phenomenon 1: every surface becomes a mirror at grazing angles.

use glam::Vec3;
use maud::html;

use super::{
    Chapter, Lab, StudyError, Table, albedo_at, alpha, choice, fixed, image, number, pictures, svg, words,
};
use crate::{
    curves::draw::{Axis, Line, Mark, Plot, Series},
    optics::{
        TermSelection,
        colour::luminance,
        fresnel::{conductor, normal_reflectance, schlick},
    },
    parameter::Value,
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

/// A number for smooth glass, and for the lobe of each model.
struct Growth {
    smooth: f64,
    microfacet: f64,
    blinn_phong: f64,
}

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
    let mut series = Vec::new();
    for (m, name, colour) in &materials {
        let Some(colour) = *colour else { continue };
        let curve = |f: &dyn Fn(f64) -> f64| (0..=90).map(|a| (f64::from(a), f(f64::from(a)))).collect();
        series.push(Series {
            name: (*name).to_owned(),
            points: curve(&|a| exact(m, a)),
            colour,
            line: Line::Solid,
            mark: Mark::None,
        });
        series.push(Series {
            name: "… after Schlick".to_owned(),
            points: curve(&|a| approximate(m, a)),
            colour,
            line: Line::Dashed,
            mark: Mark::None,
        });
    }
    series.push(Series {
        name: "Blinn–Phong, kₛ = 0.04".to_owned(),
        points: vec![(0.0, 0.04), (90.0, 0.04)],
        colour: 6,
        line: Line::Dotted,
        mark: Mark::None,
    });
    let reflectance = Plot {
        title: "Fresnel reflectance against the angle of incidence".to_owned(),
        x: Axis::new("angle of incidence (°)", 0.0, 90.0, 10),
        y: Axis::new("reflectance at 532 nm", 0.0, 1.0, 6),
        series,
        size: (720, 380),
        legend: true,
        ..Plot::default()
    };
    let reflectance = lab.figure(
        &svg(&reflectance),
        &html! {
            "Reflectance of smooth boundaries for unpolarised light at 532 nm, from measured optical constants. Solid: the exact "
            "equations. Dashed: Schlick’s approximation from the same F₀. Dotted: a constant specular coefficient for glass."
        },
    );
    let table = lab.table(
        &html! {
            "Exact Fresnel reflectance at 532 nm by angle of incidence, and where Schlick’s approximation is furthest from it "
            "(approximation minus exact value). Refractive index n, extinction coefficient k."
        },
        &["Material", "n", "k", "0°", "45°", "60°", "75°", "85°", "Schlick’s largest error"],
        &rows,
    );

    // The curves of the models' lobes.
    let mut settings =
        vec![choice("fresnel", "dielectric"), choice("diffuse", "none"), ("ior", Value::Triple([1.5; 3]))];
    settings.extend(alpha(ALPHA));
    let glass = lab.surface("microfacet", &settings)?;
    let plastic = lab.surface(
        "blinn_phong",
        &[("alpha", Value::Integer(EXPONENT)), number("k_s", K_S), ("base_colour", Value::Colour([0; 3]))],
    )?;
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
    let at = |curve: &[(f64, f64)], angle: f64| {
        curve.iter().find(|p| (p.0 - angle).abs() < 0.1).map_or(f64::NAN, |p| p.1)
    };
    let all_at = |angle: f64| Growth {
        smooth: at(&ideal, angle),
        microfacet: at(&glass_lobe, angle),
        blinn_phong: at(&plastic_lobe, angle),
    };
    let (growth, grazing) = (all_at(75.0), all_at(85.0));
    let relative = Plot {
        title: "Reflection of the specular lobe relative to normal incidence".to_owned(),
        x: Axis::new("angle of view (°)", 0.0, 90.0, 10),
        y: Axis::log("reflection relative to 0°", 0.01, 30.0),
        series: vec![
            Series {
                name: "smooth glass, exact".to_owned(),
                points: ideal,
                colour: 6,
                line: Line::Dotted,
                mark: Mark::None,
            },
            Series {
                name: format!("microfacet, α = {ALPHA}"),
                points: glass_lobe,
                colour: 0,
                line: Line::Solid,
                mark: Mark::Disc,
            },
            Series {
                name: format!("Blinn–Phong, n = {EXPONENT}"),
                points: plastic_lobe,
                colour: 1,
                line: Line::Dashed,
                mark: Mark::Triangle,
            },
        ],
        size: (720, 360),
        legend: true,
        ..Plot::default()
    };
    let relative = lab.figure(
        &svg(&relative),
        &html! {
            "Fraction of uniform light that the specular lobe reflects (its directional albedo, without the diffuse part), relative to the view "
            "along the normal. Glass, n = 1.5. Each curve is relative to its own value at 0° and therefore starts at 1, whatever " (words("k_s")) " is. Logarithmic axis."
        },
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
    let shown = lab.figure(
        &html! { div .stack { (blinn_phong_picture) (microfacet_picture) } },
        &html! {
            "Objects of black glass (n = 1.5, α = " (ALPHA) ") with one lamp in front and three of the same intensity behind them. Blinn–Phong’s height and width are set so that "
            "the highlight of the front lamp is the same. Scene " code { "fresnel_effect.json" } "."
        },
    );
    let picture_table = lab.table(
        &html! { "Mean of the brightest 1\u{a0}% of the pixels covered by objects in the pictures above (luminance, linear, 1 is display white), with the lamp in front alone and the lamps behind alone." },
        &["Model", "lamp in front", "lamps behind", "behind / front"],
        &both.map(|(model, peaks)| {
            vec![
                model.name.to_owned(),
                fixed(peaks.front, 3),
                fixed(peaks.behind, 3),
                fixed(peaks.ratio(), 1),
            ]
        }),
    );

    let dip = preset::by_id(ALUMINIUM).and_then(dip);
    let physical = growth.microfacet > 2.0 && (growth.microfacet / growth.smooth).ln().abs() < 0.5;
    let classical = growth.blinn_phong > 2.0;
    let confirmed = physical && !classical;
    let finding = format!(
        "From the normal to 75° the reflection of smooth glass changes by a factor of {:.1}, that of the microfacet lobe by {:.1}, and that of Blinn–Phong’s lobe by {:.2}.",
        growth.smooth, growth.microfacet, growth.blinn_phong
    );
    let body = html! {
        h3 { "Question" }
        p { "A surface reflects more light the more obliquely it is seen, and almost everything at a grazing view. Which models show this?" }
        h3 { "Method" }
        p {
            "The reflectance of a smooth boundary to a medium of index n + ik follows from the Fresnel equations. The program has them exactly ("
            code { "optics::fresnel::dielectric" } ", " code { "conductor" } ") and in Schlick’s approximation,"
        }
        p .equation {
            span { "F(θ) ≈ F₀ + (1 − F₀)(1 − cos θ)⁵," }
            span { "F₀ = ((n − 1)² + k²) / ((n + 1)² + k²)." }
        }
        p {
            "Blinn–Phong has a specular coefficient " (words("k_s")) " in the place of F, equal at all angles. The optical constants are measurements "
            "collected by refractiveindex.info. To compare whole models and not only this factor, the directional albedo of the specular lobe is integrated "
            "numerically for glass: a GGX microfacet lobe of α = " (ALPHA) " with the exact equations, against a Blinn–Phong lobe of the same width and height at "
            "normal incidence (n = " (EXPONENT) ", " (words("k_s")) " = F₀/(4α²) = " (K_S) ")."
        }
        h3 { "Results" }
        (reflectance)
        (table)
        (relative)
        (shown)
        (picture_table)
        h3 { "Conclusion" }
        div .conclusion {
            p {
                @if physical {
                    "The microfacet model follows the Fresnel equations: at 75° its lobe reflects " (fixed(growth.microfacet, 1)) " times as much as at normal incidence, smooth glass "
                    (fixed(growth.smooth, 1)) " times; at 85° " (fixed(grazing.microfacet, 1)) " and " (fixed(grazing.smooth, 1)) " times."
                    @if grazing.microfacet < grazing.smooth { " It stays below at the very edge because at a grazing view a rough surface shows mostly facets that are tilted towards the viewer." }
                } @else {
                    "The microfacet model does not follow the Fresnel equations here: its lobe grows by " (fixed(growth.microfacet, 1)) ", smooth glass by " (fixed(growth.smooth, 1)) "."
                }
            }
            p {
                @if classical {
                    "Blinn–Phong’s lobe grows as well, by " (fixed(growth.blinn_phong, 2)) "."
                } @else {
                    "Blinn–Phong shows the opposite of the Fresnel effect. Its lobe reflects " (fixed(growth.blinn_phong, 2)) " times as much at 75°, since its height is fixed while the solid angle of light that it gathers shrinks with the cosine of the view. "
                    "In the brightest 1\u{a0}% of the pictures the lamps behind the objects are " (fixed(microfacet.ratio(), 1)) " times as bright as the lamp in front under the microfacet model and "
                    (fixed(blinn_phong.ratio(), 1)) " times under Blinn–Phong. No single " (words("k_s")) " serves both."
                }
            }
            p {
                "Schlick’s approximation is off by at most " (fixed(schlick_worst, 3)) " for these materials. "
                @if let Some((angle, least)) = dip {
                    "It cannot follow a reflectance that falls before it rises, as that of aluminium does, which is least at " (fixed(angle, 0)) "° (" (fixed(least, 3)) ")."
                }
            }
        }
    };
    Ok(Chapter {
        title: "Fresnel effect",
        body,
        finding,
        shown: confirmed,
        tables: vec![raw, lobes, from_pictures],
    })
}
