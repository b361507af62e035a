//! OpenPBR against Adobe's implementation: values and albedos, with the tolerances by which its tables and
//! fits differ from integration.

use glam::{DVec3, Vec2, Vec3};
use lights_camera_models::{
    optics::{
        albedo::directional,
        colour::Encoding,
        distribution::ggx,
        fresnel::dielectric,
        geometry::half_vector,
        masking::{height_correlated, smith_ggx},
    },
    parameter::{ParameterSet as _, Value, Values},
    reflection::{Factor, OpenPbr, ReflectionModel as _, brdf_of, preset},
    registry::Registry,
    scene::examples::looks,
};
use serde_json::{Map, Value as Json};

use super::{LOCAL, cells, direction};

/// A material of the golden files.
struct Set {
    group: String,
    /// The non-default parameters, with OpenPBR's names.
    own: Map<String, Json>,
    material: OpenPbr,
}

/// The name of a parameter here.
fn ours(name: &str) -> String {
    match name {
        "base_metalness" => "metallic".into(),
        "specular_roughness" => "roughness".into(),
        "specular_weight" => "specular_strength".into(),
        _ => name.replace("color", "colour"),
    }
}

/// A material from OpenPBR's names; missing parameters have their defaults.
fn material(own: &Map<String, Json>) -> OpenPbr {
    let mut values = Values::default();
    for (name, value) in own {
        let name = ours(name);
        let parameter = OpenPbr::PARAMETERS.iter().find(|p| p.name == name).expect("a parameter");
        let value = match value {
            Json::Array(rgb) => {
                // Linear numbers that are 8-bit sRGB colours decoded.
                let encode = |x: &Json| {
                    let x = x.as_f64().expect("a number");
                    let s = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
                    (255.0 * s).round() as u8
                };
                Value::Colour([encode(&rgb[0]), encode(&rgb[1]), encode(&rgb[2])])
            }
            number => Value::Number(number.as_f64().expect("a number") as f32),
        };
        assert!(parameter.allows(&value), "{name}: {value:?}");
        values.set(parameter.name, value);
    }
    OpenPbr::from_values(&values, Encoding::Srgb)
}

/// One row: the material's text, the cells after it.
struct Row {
    set: usize,
    cells: Vec<f64>,
}

/// The sets and rows of a file.
fn read(text: &str) -> (Vec<Set>, Vec<Row>) {
    let (mut texts, mut sets, mut rows) = (Vec::<String>::new(), Vec::new(), Vec::new());
    for line in text.lines().skip(1) {
        let cells = cells(line);
        let set = texts.iter().position(|t| *t == cells[2]).unwrap_or_else(|| {
            let own: Map<String, Json> = serde_json::from_str(&cells[2]).expect("a material");
            sets.push(Set { group: cells[1].clone(), material: material(&own), own });
            texts.push(cells[2].clone());
            texts.len() - 1
        });
        rows.push(Row { set, cells: cells[3..].iter().map(|c| c.parse().expect("a number")).collect() });
    }
    (sets, rows)
}

fn values() -> (Vec<Set>, Vec<Row>) {
    read(include_str!("../../../data/golden/openpbr_values.csv"))
}

fn directions(row: &Row) -> (Vec3, Vec3) {
    (direction(row.cells[0], row.cells[1]), direction(row.cells[2], row.cells[3]))
}

fn f(material: &OpenPbr, l: Vec3, v: Vec3) -> DVec3 {
    brdf_of(material.response(l, v, &LOCAL), l, v, &LOCAL).as_dvec3()
}

/// The relative and the absolute tolerance of a group: Adobe's tables have 16 bits, those of albedos are
/// coarse near an index of 1, and its means of F are fits.
fn tolerance(set: &Set) -> (f64, f64) {
    match set.group.as_str() {
        "gloss" => (4e-5, 1e-7),
        "fuzz" if set.own["base_color"][0] == 0.0 => (4e-5, 1e-7),
        "fuzz" => (1e-3, 1e-7),
        "diffuse" => (1e-4, 1e-4),
        "metal" | "thin_film" => (7e-5, 3e-4),
        "glossy_diffuse" => (5e-4, 3e-4),
        "coat" => (6e-3, 3e-4),
        _ => (4e-3, 3e-4),
    }
}

/// The difference between two values, in tolerances.
fn distance(set: &Set, a: DVec3, b: DVec3) -> f64 {
    let (t, s) = tolerance(set);
    (0..3).map(|i| (a[i] - b[i]).abs() / (t * a[i].abs().max(b[i].abs()) + s)).fold(0.0, f64::max)
}

#[test]
fn openpbr_has_the_values_of_adobes_program() {
    let (sets, rows) = values();
    assert_eq!((sets.len(), rows.len()), (48, 288));
    let mut wrong = Vec::new();
    for row in &rows {
        let ((l, v), set) = (directions(row), &sets[row.set]);
        let expected = DVec3::from_slice(&row.cells[4..]);
        let got = f(&set.material, l, v);
        let off = distance(set, got, expected);
        if off > 1.0 || off.is_nan() {
            wrong.push(format!(
                "{} {:?} {:?}: {got} is not {expected}, {off:.1}",
                set.group,
                set.own,
                &row.cells[..4]
            ));
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), rows.len(), wrong.join("\n"));
}

/// The largest difference of a twin from the rows of a group.
fn worst(group: &str, twin: impl Fn(&Set, Vec3, Vec3) -> DVec3) -> f64 {
    let (sets, rows) = values();
    let of = |row: &Row| {
        let ((l, v), set) = (directions(row), &sets[row.set]);
        distance(set, twin(set, l, v), DVec3::from_slice(&row.cells[4..]))
    };
    rows.iter().filter(|row| sets[row.set].group == group).map(of).fold(0.0, f64::max)
}

/// A material with other parameters.
fn with(set: &Set, changes: &[(&str, f64)]) -> OpenPbr {
    let mut own = set.own.clone();
    for (name, value) in changes {
        own.insert((*name).to_owned(), Json::from(*value));
    }
    material(&own)
}

fn number(set: &Set, name: &str, default: f64) -> f64 {
    set.own.get(name).and_then(Json::as_f64).unwrap_or(default)
}

#[test]
fn openpbrs_wrong_twins_are_rejected() {
    // Height-correlated masking, for isotropic boundaries of index 1.5.
    let correlated = worst("gloss", |set, l, v| {
        if set.own.len() > 1 {
            return f(&set.material, l, v);
        }
        let alpha = Vec2::splat(0.09);
        let g = height_correlated(l.z, v.z, smith_ggx(l, alpha), smith_ggx(v, alpha));
        let of_facets = ggx(half_vector(l, v), alpha) * g * dielectric(1.5, 0.5 * (l + v).length());
        DVec3::splat(f64::from(of_facets))
    });
    assert!(correlated > 10.0, "{correlated}");
    // The albedo of the layers above for the light.
    for group in ["coat", "fuzz"] {
        let swapped = worst(group, |set, l, v| f(&set.material, v, l));
        assert!(swapped > 1.5, "{group}: {swapped}");
    }
    // The weight of the base outside the rough diffuse term.
    let outside = worst("diffuse", |set, l, v| {
        number(set, "base_weight", 1.0) * f(&with(set, &[("base_weight", 1.0)]), l, v)
    });
    assert!(outside > 10.0, "{outside}");
    // Twice the roughening by the coat, as in the text.
    let twice = worst("coat", |set, l, v| {
        let (r, c) = (number(set, "specular_roughness", 0.3), number(set, "coat_roughness", 0.0));
        let more = (r.powi(4) + (1.0 + 1.0 / number(set, "coat_ior", 1.6)) * c.powi(4)).min(1.0).powf(0.25);
        f(&with(set, &[("specular_roughness", more)]), l, v)
    });
    assert!(twice > 10.0, "{twice}");
    // Other wavelengths of the film: equivalent to another thickness in each channel.
    let other = worst("thin_film", |set, l, v| {
        let d = number(set, "thin_film_thickness", 0.5);
        let at = |ratio: f64| f(&with(set, &[("thin_film_thickness", d * ratio)]), l, v);
        DVec3::new(at(620.0 / 630.0).x, at(540.0 / 532.0).y, at(450.0 / 465.0).z)
    });
    assert!(other > 10.0, "{other}");
}

#[test]
fn openpbr_has_the_albedos_of_adobes_program() {
    let (sets, rows) = read(include_str!("../../../data/golden/openpbr_albedo.csv"));
    assert_eq!(rows.len(), 144);
    let mut wrong = Vec::new();
    let mut swapped = 0.0f64;
    for row in &rows {
        let set = &sets[row.set];
        let (mu, phi) = (row.cells[0] as f32, (row.cells[1] as f32).to_radians());
        let sin = (1.0 - mu * mu).sqrt();
        let v = Vec3::new(sin * phi.cos(), sin * phi.sin(), mu);
        let expected = DVec3::from_slice(&row.cells[2..]);
        let alone = set.own["base_color"][0] == 0.0;
        let tolerance = match set.group.as_str() {
            "gloss" => 1e-4,
            "fuzz" if alone => 1e-4,
            "diffuse" => 5e-4,
            // Adobe's table of E_1 has few nodes there.
            "metal" if mu < 0.03 && number(set, "specular_roughness", 0.3) < 0.15 => 0.05,
            "coat" | "mixture" => 1e-2,
            _ => 2e-3,
        };
        let got = directional(|l| set.material.response(l, v, &LOCAL), v, &LOCAL);
        let off = (got - expected).abs().max_element();
        if off > tolerance || off.is_nan() {
            wrong.push(format!(
                "{} {:?} {:?}: {got} is not {expected}, {off:.4}",
                set.group,
                set.own,
                &row.cells[..2]
            ));
        }
        if set.group == "fuzz" && alone {
            let twin = directional(
                |l| {
                    let terms = set.material.response(v, l, &LOCAL);
                    lights_camera_models::optics::Terms { specular: terms.specular * (l.z / mu), ..terms }
                },
                v,
                &LOCAL,
            );
            swapped = swapped.max((twin - expected).abs().max_element());
        }
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), rows.len(), wrong.join("\n"));
    // The wrong twin: fuzz by the angle of the light.
    assert!(swapped > 1e-2, "{swapped}");
}

#[test]
fn a_white_body_below_a_smooth_boundary_reflects_everything() {
    // Without roughness of the diffuse base and without film, coat and fuzz, nothing is lost or gained.
    for (roughness, strength) in [(0.3, 1.0), (0.7, 1.0), (1.0, 0.5)] {
        let own = serde_json::json!({
            "base_color": [1.0, 1.0, 1.0], "specular_roughness": roughness, "specular_weight": strength
        });
        let white = material(own.as_object().expect("an object"));
        for mu in [0.1f32, 0.4, 0.8, 1.0] {
            let v = Vec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
            let e = directional(|l| white.response(l, v, &LOCAL), v, &LOCAL);
            assert!((e - DVec3::ONE).abs().max_element() < 4e-3, "r {roughness} ξ {strength} μ {mu}: {e}");
            // The wrong twin: without the boundary's share.
            let body = directional(
                |l| {
                    let terms = white.response(l, v, &LOCAL);
                    lights_camera_models::optics::Terms { specular: Vec3::ZERO, ..terms }
                },
                v,
                &LOCAL,
            );
            assert!(body.x < 0.995, "{body}");
        }
    }
}

#[test]
fn a_measured_material_reflects_what_was_measured_whatever_was_chosen_before() {
    let registry = Registry::builtin();
    let model = registry.model("openpbr").expect("built in");
    for look in looks() {
        for material in preset::all() {
            let mut values = look.material.clone();
            for (name, value) in (model.preset)(material) {
                values.set(name, value);
            }
            let surface = model.instantiate(&values, Encoding::Srgb);
            let found = surface.factor(Factor::Fresnel { cos_d: 1.0 }).expect("a factor");
            let n = material.n[1];
            let expected =
                if material.metal { material.f0 } else { Vec3::splat(((n - 1.0) / (n + 1.0)).powi(2)) };
            let error = (found - expected).abs().max_element();
            // Colours of eight bits.
            assert!(error < 5e-3, "{} after {}: {found}, not {expected}", material.name, look.name);
            assert_eq!(values.number(model.parameter("coat_weight").expect("a layer")), 0.0);
        }
    }
}
