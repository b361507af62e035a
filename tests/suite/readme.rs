//! The tables of the README are those of the registry, and its example is the example.

use std::fs;

use glam::Vec3;
use lights_camera_models::{
    optics::{Frame, colour::Encoding},
    parameter::{Parameter, Value, Values},
    reference::{self, Settings},
    reflection::ModelEntry,
    registry::Registry,
    render::capture::{evaluate::evaluate, png},
    scene::{
        Scene,
        load::{self, Defaults},
    },
    shader::compose::Sources,
};

use crate::{
    golden::{SAME_RENDERER, read_png, updating},
    support::root,
};

#[path = "../../examples/toon.rs"]
#[allow(dead_code)]
mod example;

#[test]
fn gouraud_shading_loses_the_highlight_as_the_tour_says() {
    let readme = fs::read_to_string(root().join("README.md")).expect("there");
    let number = |after: &str| {
        let digits: String = readme.split(after).nth(1)?.chars().take_while(char::is_ascii_digit).collect();
        digits.parse::<u32>().ok()
    };
    let tessellation = number("set the tessellation to ").expect("says it");
    let alpha = number("and α to ").expect("says it");
    // The brightest pixel of the sphere of the default scene.
    let brightest = |mode: &str| {
        let mut scene = Scene {
            reflection_model: "blinn_phong".to_owned(),
            shading_model: mode.to_owned(),
            ..Scene::default()
        };
        scene.objects[0].tessellation = Some(tessellation);
        scene.objects[0].material.set("alpha", Value::Integer(alpha.into()));
        let settings = Settings { width: 640, height: 360, ..Settings::default() };
        let picture = reference::render_rgb8(&scene, &Registry::builtin(), &settings);
        picture.into_iter().max().expect("has pixels")
    };
    assert_eq!(brightest("phong"), 255, "there is a highlight");
    assert!(brightest("gouraud") < 240, "it is lost");
}

/// Portraits side by side in the gallery.
const GALLERY_COLUMNS: usize = 4;

/// Rows of a table, with a heading.
fn table(heading: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let heading: Vec<_> = heading.iter().map(|h| (*h).to_owned()).collect();
    let rule = format!("|{}\n", "---|".repeat(heading.len()));
    std::iter::once(line(&heading)).chain([rule]).chain(rows.map(|r| line(&r))).collect()
}

fn code(id: &str) -> String {
    format!("`{id}`")
}

/// The text between two markers of the README, by name.
fn sections() -> Vec<(&'static str, String)> {
    let registry = Registry::builtin();
    let models = registry.models().iter().map(|m| {
        let d = m.declaration;
        let parameter = |p: &Parameter| match p.used_when {
            Some(u) => format!(
                "{} (with {})",
                code(p.name),
                u.choices.iter().map(|c| code(c)).collect::<Vec<_>>().join("/")
            ),
            None => code(p.name),
        };
        let parameters: Vec<_> = m.parameters.iter().map(parameter).collect();
        let kept: Vec<_> = d.laws.list().iter().filter(|(_, kept)| *kept).map(|(law, _)| *law).collect();
        vec![
            code(d.id),
            d.name.into(),
            d.author.into(),
            d.summary.into(),
            parameters.join(", "),
            kept.join(", "),
        ]
    });
    let modes = registry.modes().iter().map(|m| {
        let d = m.declaration;
        vec![code(d.id), d.name.into(), d.author.into(), d.stage.phrase().into(), d.summary.into()]
    });
    let lights = registry.lights().iter().map(|l| {
        let d = l.declaration;
        let mut fields = vec![];
        fields.extend(d.has_position.then(|| code("position")));
        fields.extend(d.has_direction.then(|| code("direction")));
        fields.extend(d.parameters.iter().map(|p| code(p.name)));
        vec![code(d.id), d.summary.into(), format!("`{}`", d.equation), d.unit.into(), fields.join(", ")]
    });
    let shapes = registry.shapes().iter().map(|s| {
        let d = s.declaration;
        let (from, to) = (d.tessellation.start(), d.tessellation.end());
        let tessellation = format!("{from}–{to}, default {}", d.default_tessellation);
        vec![code(d.id), d.summary.into(), tessellation, d.tessellation_help.into()]
    });
    let portraits: Vec<_> = registry
        .models()
        .chunks(GALLERY_COLUMNS)
        .flat_map(|models| {
            let pictures = models
                .iter()
                .map(|m| format!("![{0}](docs/images/models/{1}.png)", m.declaration.name, m.declaration.id));
            let names = models.iter().map(|m| code(m.declaration.id));
            [pictures.collect::<Vec<_>>(), names.collect()]
        })
        .map(|mut row| {
            row.resize(GALLERY_COLUMNS, String::new());
            row
        })
        .collect();
    let gallery = table(&[""; GALLERY_COLUMNS], portraits.into_iter());
    let example = |file: &str, language: &str| {
        let text = fs::read_to_string(root().join("examples").join(file)).expect("the example is there");
        format!("```{language}\n{text}```\n")
    };
    vec![
        ("models", table(&["id", "name", "author", "what it shows", "parameters", "laws kept"], models)),
        ("gallery", gallery),
        ("modes", table(&["id", "name", "author", "calculates", "what to look for"], modes)),
        ("lights", table(&["id", "what it does", "light at a point", "unit", "fields"], lights)),
        ("shapes", table(&["id", "what it shows", "tessellation", "meaning"], shapes)),
        ("toon.wgsl", example("toon.wgsl", "wgsl")),
        ("toon.rs", example("toon.rs", "rust")),
    ]
}

#[test]
fn the_tables_and_the_example_of_the_readme_are_up_to_date() {
    let path = root().join("README.md");
    let old = fs::read_to_string(&path).expect("the README is there");
    let mut text = old.clone();
    for (name, content) in sections() {
        let (open, close) = (format!("<!-- {name} -->\n"), format!("<!-- end of {name} -->"));
        let start = text.find(&open).unwrap_or_else(|| panic!("README.md lacks {open}")) + open.len();
        let end = text[start..].find(&close).unwrap_or_else(|| panic!("README.md lacks {close}")) + start;
        text.replace_range(start..end, &format!("\n{content}\n"));
    }
    if std::env::var_os("LCM_UPDATE").is_some() {
        fs::write(&path, &text).expect("README.md can be written");
    } else {
        assert!(text == old, "README.md is not up to date; run the tests once with LCM_UPDATE=1");
    }
}

#[test]
fn the_gallery_shows_every_model_as_it_is() {
    let registry = Registry::builtin();
    let path = root().join("scenes/portrait.json");
    let mut scene = load::file(&path, &registry, Defaults::Refuse).unwrap_or_else(|e| panic!("{e}")).scene;
    let settings = reference::Settings { width: 240, height: 180, ..reference::Settings::default() };
    let mut portraits = Vec::new();
    for model in registry.models() {
        scene.reflection_model = model.declaration.id.to_owned();
        let picture = reference::render_rgb8(&scene, &registry, &settings);
        let path = root().join(format!("docs/images/models/{}.png", model.declaration.id));
        let agrees = || {
            read_png(&path).is_ok_and(|(width, height, old)| {
                (width, height) == (settings.width, settings.height)
                    && SAME_RENDERER.broken(&picture, &old).is_none()
            })
        };
        if updating() && !agrees() {
            fs::create_dir_all(root().join("docs/images/models")).expect("the folder can be made");
            png::write(&path, settings.width, settings.height, &picture, &[])
                .expect("the picture can be written");
        }
        assert!(agrees(), "{} is not what the model looks like; accept with LCM_UPDATE=1", path.display());
        portraits.push((model.declaration.id, picture));
    }
    for (i, (a, one)) in portraits.iter().enumerate() {
        for (b, other) in &portraits[i + 1..] {
            assert!(SAME_RENDERER.broken(one, other).is_some(), "{a} and {b} look the same");
        }
    }
}

#[test]
fn every_file_that_a_document_points_to_is_there() {
    for document in ["README.md", "ARCHITECTURE.md", "CREDITS.md", "CHANGELOG.md"] {
        let text = fs::read_to_string(root().join(document)).expect(document);
        let targets = text.split("](").skip(1).filter_map(|rest| rest.split(')').next());
        for target in targets.filter(|t| !t.contains("://") && !t.starts_with('#')) {
            let file = target.split('#').next().unwrap_or_default();
            assert!(root().join(file).exists(), "{document} points to {file}, which is not there");
        }
    }
}

#[test]
fn the_model_of_the_example_is_the_same_in_rust_and_in_wgsl() {
    let model = ModelEntry::of::<example::Toon>();
    let values = Values::default();
    let frame = Frame::LOCAL;
    // Away from the edges of the tones, where the last bit decides.
    let directions = (0..4).map(|i| 0.125 + 0.25 * i as f32);
    let pairs: Vec<_> = directions.map(|z: f32| (Vec3::new((1.0 - z * z).sqrt(), 0.0, z), Vec3::Z)).collect();
    let answers = evaluate(&Sources::default(), &model, &values, Encoding::Srgb, &pairs)
        .expect("software Vulkan is installed");
    let surface = model.instantiate(&values, Encoding::Srgb);
    for (i, ((l, v), gpu)) in pairs.iter().zip(answers).enumerate() {
        let cpu = surface.response(*l, *v, &frame).diffuse;
        assert!((cpu - 0.25 * (i as f32 + 1.0)).abs().max_element() < 1e-6, "{l}: {cpu}");
        assert!((gpu.diffuse - cpu).abs().max_element() < 1e-6, "{l}: GPU {}, CPU {cpu}", gpu.diffuse);
    }
}
