//! Solid bodies in exports: on pages, light is followed through them as in `lcm render`.

#![cfg(target_os = "linux")]

use std::{fs, path::Path, sync::atomic::AtomicBool};

use lights_camera_models::{
    export::{Export, Progress, Request, html},
    optics::TermSelection,
    reference::{self, LightSamples, Settings},
    registry::Registry,
    scene::Scene,
};
use serde_json::{Value, json};

use super::pages::{BEYOND, MEAN, difference, page, scene, set};
use crate::helpers::{browser::Browser, support::root};

const WIDTH: u32 = 112;
const HEIGHT: u32 = 63;

/// The picture of the program, with as many samples as a page takes.
fn rendered(scene: &Scene, registry: &Registry) -> Vec<u8> {
    let settings = Settings { width: WIDTH, height: HEIGHT, samples: 1, terms: TermSelection::All };
    let samples = LightSamples { first: 0, count: 64 };
    let picture = reference::render_samples(scene, registry, &settings, samples, &AtomicBool::default());
    picture.to_rgb8(&scene.display)
}

/// A scene read from JSON.
fn read(text: &Value, folder: &Path) -> Scene {
    let file = folder.join("scene.json");
    fs::write(&file, text.to_string()).expect("written");
    scene(&file)
}

/// Opens the page of a scene.
fn open(browser: &Browser, of: &Scene, renderer: &str, folder: &Path) {
    let file = folder.join("page.html");
    fs::write(&file, page(of).expect("a page")).expect("written");
    browser.open(&file, &format!("renderer={renderer}&picture={WIDTH}x{HEIGHT}&samples=1"));
}

/// A body in a studio, with a lamp.
fn body(model: &str, object_type: &str, shading: &str, material: &Value) -> Value {
    json!({
        "scene_size": { "height": 10, "width": 10, "depth": 10 },
        "observer": { "position": [5, 5, 9.9], "direction": [0, 0, -1], "field_of_view": 40 },
        "reflection_model": model, "shading_model": shading,
        "lights": [
            { "type": "environment", "source": "studio", "visible": false },
            { "type": "rectangle", "position": [3, 8, 2], "direction": [1, -1, 1], "intensity": 20, "visible": false },
            { "type": "point", "position": [8, 8, 9], "intensity": 50 },
            { "type": "ambient", "intensity": 0.2 }
        ],
        "objects": [{
            "type": object_type, "position": [5.2, 5, 5], "rotation": [20, 30, 40], "size": 1.4, "tessellation": 24,
            "material": material
        }]
    })
}

/// The shipped scene, without the lights themselves, which pages do not show.
#[test]
fn pages_follow_light_through_glass_balls() {
    let Some(browser) = Browser::start() else { return };
    browser.resize(WIDTH, HEIGHT);
    let folder = tempfile::tempdir().expect("a folder");
    let registry = Registry::builtin();
    let text = fs::read_to_string(root().join("scenes/glass_thin_and_solid.json")).expect("readable");
    let mut text: Value = serde_json::from_str(&text).expect("JSON");
    text.as_object_mut().expect("an object").remove("$schema");
    for light in text["lights"].as_array_mut().expect("a list") {
        light["visible"] = false.into();
    }
    let balls = read(&text, folder.path());
    let expected = rendered(&balls, &registry);
    for renderer in ["webgpu", "webgl"] {
        open(&browser, &balls, renderer, folder.path());
        let off = difference(&browser.look().0, &expected);
        println!("{renderer}: {off:?}");
        assert!(off.mean < MEAN && off.beyond < BEYOND, "{renderer}: {off:?}");
    }
    // The wrong twin: glass without an inside.
    text["reflection_model"] = "thin_glass".into();
    for object in text["objects"].as_array_mut().expect("a list") {
        object["material"] = json!({});
    }
    let off = difference(&rendered(&read(&text, folder.path()), &registry), &expected);
    assert!(off.mean > MEAN && off.beyond > BEYOND, "{off:?}");
}

/// Shapes, shading models and knobs: in the page, the inside follows the knobs.
#[test]
fn bodies_on_pages_follow_their_knobs_and_shading_models() {
    let Some(browser) = Browser::start() else { return };
    browser.resize(WIDTH, HEIGHT);
    let folder = tempfile::tempdir().expect("a folder");
    let registry = Registry::builtin();
    let smooth = json!({});
    let clear = json!({ "transmission_weight": 1, "roughness": 0, "transmission_colour": [90, 160, 220], "transmission_depth": 0.5 });
    let mut strong = clear.clone();
    strong["transmission_dispersion_abbe_number"] = 4.into();
    let cases = [
        (
            "glass torus",
            "phong",
            json!({ "transmittance_colour": [120, 200, 140] }),
            ("distance", json!(0.4), "0.4"),
        ),
        ("glass cube", "phong", smooth.clone(), ("refractive_index", json!(1.3), "1.3")),
        ("glass sphere", "flat", smooth.clone(), ("transmittance_colour", json!([255, 180, 90]), "#ffb45a")),
        ("glass sphere", "gouraud", smooth.clone(), ("refractive_index", json!(2.0), "2")),
        ("glass torus", "phong", smooth, ("dispersion", json!(0.05), "0.05")),
        ("glass sphere", "phong", json!({ "dispersion": 0.02 }), ("roughness", json!(0.3), "0.3")),
        // The teapot is open: a pane.
        (
            "glass teapot",
            "phong",
            json!({ "refractive_index": 3 }),
            ("refractive_index", json!(1.05), "1.05"),
        ),
        ("openpbr sphere", "phong", clear.clone(), ("specular_ior", json!(1.3), "1.3")),
        ("openpbr torus", "phong", clear.clone(), ("transmission_depth", json!(2.0), "2")),
        ("openpbr sphere", "phong", strong, ("transmission_dispersion_scale", json!(1.0), "1")),
        ("openpbr sphere", "phong", clear, ("roughness", json!(0.5), "0.5")),
    ];
    for (i, (of, shading, material, (name, value, control))) in cases.into_iter().enumerate() {
        let (model, shape) = of.split_once(' ').expect("two words");
        let mut text = body(model, shape, shading, &material);
        // The page samples by the lobes of the material as exported, so that the noise is another one under light with extent.
        if name == "roughness" {
            text["lights"]
                .as_array_mut()
                .expect("a list")
                .retain(|light| ["point", "ambient"].iter().any(|of| light["type"] == *of));
        }
        let before = read(&text, folder.path());
        text["objects"][0]["material"][name] = value;
        let expected = rendered(&read(&text, folder.path()), &registry);
        // Half of the cases each, as drawing takes a while.
        let renderer = ["webgpu", "webgl"][i % 2];
        let what = format!("{of} {shading} {name} {renderer}");
        open(&browser, &before, renderer, folder.path());
        let unturned = rendered(&before, &registry);
        let first = difference(&browser.look().0, &unturned);
        set(&browser, &format!("[data-name={name}] input:not([type=range])"), control);
        let off = difference(&browser.look().0, &expected);
        println!("{what}: {first:?}, then {off:?}");
        for off in [first, off] {
            assert!(off.mean < MEAN && off.beyond < BEYOND, "{what}: {off:?}");
        }
        // The wrong twin: the knob has not moved.
        let off = difference(&unturned, &expected);
        assert!(off.mean > MEAN || off.beyond > BEYOND, "{what}: {off:?}");
    }
}

/// Under uniform light, the page integrates what a model transmits, and what does not spread.
#[test]
fn the_albedo_of_models_that_transmit_follows_their_knobs() {
    let Some(browser) = Browser::start() else { return };
    browser.resize(WIDTH, HEIGHT);
    let folder = tempfile::tempdir().expect("a folder");
    let registry = Registry::builtin();
    let sheet = json!({ "transmission_weight": 0.5, "geometry_thin_walled": true });
    for (i, (model, material, name, value)) in [
        ("glass", json!({ "transmittance_colour": [120, 200, 140] }), "refractive_index", 2.5),
        ("glass", json!({ "roughness": 0.5 }), "refractive_index", 2.5),
        ("rough_dielectric", json!({}), "refractive_index", 2.0),
        ("openpbr", sheet, "transmission_weight", 1.0),
    ]
    .into_iter()
    .enumerate()
    {
        let mut text = body(model, "sphere", "phong", &material);
        text["lights"] = json!([{ "type": "ambient", "intensity": 0.5 }]);
        let before = read(&text, folder.path());
        text["objects"][0]["material"][name] = value.into();
        let expected = rendered(&read(&text, folder.path()), &registry);
        let renderer = ["webgpu", "webgl"][i % 2];
        open(&browser, &before, renderer, folder.path());
        set(&browser, &format!("[data-name={name}] input[type=number]"), &value.to_string());
        let off = difference(&browser.look().0, &expected);
        println!("{model} {name} {renderer}: {off:?}");
        // The page sums a refracted lobe over the directions of the reflected one, which are not as dense where it is narrow.
        let [mean, beyond] = if model == "rough_dielectric" { [0.5, 0.03] } else { [MEAN, BEYOND] };
        assert!(off.mean < mean && off.beyond < beyond, "{model} {name} {renderer}: {off:?}");
        let off = difference(&rendered(&before, &registry), &expected);
        assert!(off.mean > MEAN || off.beyond > BEYOND, "{model} {name}, the wrong twin: {off:?}");
    }
}

#[test]
fn a_body_with_an_open_mesh_is_told_at_export() {
    let folder = tempfile::tempdir().expect("a folder");
    let registry = Registry::builtin();
    let export = |shape: &str| -> Export {
        let scene = read(&body("glass", shape, "phong", &json!({})), folder.path());
        let request = Request {
            scene: &scene,
            registry: &registry,
            stem: "scene",
            size: (WIDTH, HEIGHT),
            object: 0,
            point: None,
        };
        (html::HTML.make)(&request, &Progress::NONE).expect("a page")
    };
    let about =
        |notes: &[String]| notes.iter().filter(|note| note.contains("is drawn as thin glass")).count();
    let open = export("teapot").notes;
    assert!(
        open.iter().any(|note| note.starts_with("objects[0] is drawn as thin glass: it is open: ")),
        "{open:?}"
    );
    assert_eq!((about(&open), about(&export("torus").notes)), (1, 0));
}
