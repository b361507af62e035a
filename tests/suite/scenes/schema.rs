//! The JSON Schema: up to date with the program, and consistent with the reader.

use std::fs;

use jsonschema::Validator;
use lights_camera_models::{
    registry::Registry,
    scene::{
        Scene, save,
        schema::{FILE_NAME, schema, text},
    },
};
use serde_json::{Value, json};

use crate::helpers::support::{changed, full_scene, lcm, root, said, shipped_scenes, written};

fn validator() -> Validator {
    jsonschema::draft202012::new(&schema(&Registry::builtin())).expect("a valid schema")
}

/// Compares a shipped file with the program's output; writes it if `LCM_UPDATE` is set.
fn in_step(file: &str, expected: &str) {
    let path = root().join(file);
    if std::env::var_os("LCM_UPDATE").is_some() {
        fs::write(&path, expected).expect("written");
    }
    let shipped = fs::read_to_string(&path).unwrap_or_default();
    assert!(shipped == expected, "{file} is not up to date; run the tests once with LCM_UPDATE=1");
}

#[test]
fn the_shipped_schema_is_the_one_that_the_program_prints() {
    let schema = text(&Registry::builtin());
    in_step(&format!("scenes/{FILE_NAME}"), &schema);
    assert_eq!(lcm(&["schema"], "").out, schema);
}

#[test]
fn the_shipped_default_scene_is_the_default_scene() {
    let reference = format!("./{FILE_NAME}");
    in_step("scenes/default.json", &save::to_json(&Scene::default(), Some(&reference), &Registry::builtin()));
}

#[test]
fn the_schema_is_a_valid_schema() {
    assert!(jsonschema::meta::is_valid(&schema(&Registry::builtin())));
}

#[test]
fn shipped_scenes_are_valid_by_the_schema() {
    let validator = validator();
    for path in shipped_scenes() {
        let json: Value = serde_json::from_str(&fs::read_to_string(&path).expect("readable")).expect("JSON");
        let errors: Vec<_> =
            validator.iter_errors(&json).map(|e| format!("{} at {}", e, e.instance_path())).collect();
        assert_eq!(errors, [""; 0], "{}", path.display());
    }
    for json in [full_scene(), serde_json::from_str(&written(&Scene::default())).expect("JSON")] {
        let errors: Vec<_> =
            validator.iter_errors(&json).map(|e| format!("{} at {}", e, e.instance_path())).collect();
        assert_eq!(errors, [""; 0]);
    }
}

#[test]
fn broken_scenes_are_invalid_by_the_schema_and_by_the_reader() {
    let validator = validator();
    for (pointer, value) in [
        ("/scene_size/height", json!(0)),
        ("/scene_size/height", json!(101)),
        ("/scene_size/height", json!("10")),
        ("/scene_size/length", json!(10)),
        ("/reflection_model", json!("fong")),
        ("/reflection_model", json!(null)),
        ("/shading_model", json!("x")),
        ("/lights", json!([])),
        ("/lights", json!(vec![json!({ "type": "ambient" }); 257])),
        ("/lights/0", json!({ "type": "point" })),
        ("/lights/0/type", json!("pont")),
        ("/lights/0/position", json!([1, 2])),
        ("/lights/0/position", json!([1, 0, 2])),
        ("/lights/0/position", json!([1, 101, 2])),
        ("/lights/0/direction", json!([1, 0, 2])),
        ("/lights/0/cone_angle", json!(20)),
        ("/lights/0/colour", json!([256, 0, 0])),
        ("/lights/0/colour", json!([1.5, 0, 0])),
        ("/lights/0/colour", json!("white")),
        ("/lights/0/intensity", json!(-1)),
        ("/lights/0/luminous_flux", json!(800)),
        ("/lights/0/colour_temperature", json!(2700)),
        ("/lights/1/luminous_flux", json!(-1)),
        ("/lights/1/intensity", json!(20)),
        ("/lights/1/colour_temperature", json!(999)),
        ("/lights/1/colour_temperature", json!(40_001)),
        ("/lights/1/colour", json!([255, 255, 255])),
        ("/lights/3/luminous_flux", json!(800)),
        ("/lights/0/name", json!(null)),
        ("/lights/1", json!({ "type": "spot", "position": [1, 1, 1] })),
        ("/lights/1/cone_angle", json!(0)),
        ("/lights/1/cone_angle", json!(91)),
        ("/lights/1/penumbra", json!(1.5)),
        ("/lights/3/position", json!([1, 1, 1])),
        ("/observer/field_of_view", json!(0)),
        ("/observer/up", json!([0, 1, 0])),
        ("/observer", json!([])),
        ("/objects", json!([])),
        ("/objects/0/type", json!("sphear")),
        ("/objects/0/size", json!(0)),
        ("/objects/0/tessellation", json!(0)),
        ("/objects/0/tessellation", json!(1_000_000)),
        ("/objects/0/tube_radius", json!(0.1)),
        ("/objects/2/tube_radius", json!(0.3)),
        ("/objects/2/tube_radius", json!("thin")),
        ("/objects/3/tube_radius", json!(0.1)),
        ("/objects/3/vertical_exponent", json!(0)),
        ("/objects/0/material/k_d", json!(0.2)),
        ("/objects/0/material/alpha", json!(-1)),
        ("/objects/0/material/alpha", json!(1.5)),
        ("/objects/0/material/wrap_exponent", json!(0.5)),
        ("/objects/0/material/shininess", json!(3)),
        ("/objects/0/material/base_colour", json!([1, 2])),
        ("/objects/0/repeat", json!({})),
        ("/objects/0/repeat", json!({ "columns": 0 })),
        ("/objects/0/repeat", json!({ "columns": 20_000 })),
        ("/objects/0/repeat", json!({ "columns": 2, "gap": 1 })),
        ("/objects/0/repeat", json!({ "columns": 2, "spacing": 1 })),
        ("/objects/0/repeat", json!({ "columns": 2, "vary": [{ "from": 1, "to": 2 }] })),
        (
            "/objects/0/repeat",
            json!({ "columns": 2, "vary": [{ "parameter": "size", "from": "1", "to": 2 }] }),
        ),
        ("/display/exposure", json!(17)),
        ("/display/tone_mapping", json!("x")),
        ("/display/encoding", json!("x")),
        ("/display/background", json!("white")),
        ("/display/background_colour", json!("#ffffff")),
        ("/display/background_bottom", json!([1, 2])),
        ("/nonsense", json!(1)),
    ] {
        let mut scene = full_scene();
        match scene.pointer_mut(pointer) {
            Some(there) => *there = value.clone(),
            None => {
                let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
                scene.pointer_mut(parent).expect("there")[key] = value.clone();
            }
        }
        assert!(!validator.is_valid(&scene), "{pointer} = {value} is valid by the schema");
        assert_ne!(said(&scene.to_string()), "", "{pointer} = {value} is valid by the reader");
    }
    for key in ["scene_size", "reflection_model", "shading_model", "lights", "observer", "objects"] {
        let text = changed(|s| drop(s.as_object_mut().expect("an object").remove(key)));
        assert!(!validator.is_valid(&serde_json::from_str(&text).expect("JSON")), "{key} is not required");
    }
}

#[test]
fn the_schema_and_the_reader_know_the_same_keys() {
    let schema = schema(&Registry::builtin());
    let keys = |pointer: &str| -> Vec<String> {
        schema.pointer(pointer).and_then(Value::as_object).expect(pointer).keys().cloned().collect()
    };
    for (pointer, parent) in [
        ("/properties", ""),
        ("/properties/scene_size/properties", "/scene_size"),
        ("/properties/lights/items/properties", "/lights/0"),
        ("/properties/observer/properties", "/observer"),
        ("/properties/objects/items/properties", "/objects/0"),
        ("/properties/objects/items/properties/material/properties", "/objects/0/material"),
        ("/properties/objects/items/properties/repeat/properties", "/objects/3/repeat"),
        (
            "/properties/objects/items/properties/repeat/properties/vary/items/properties",
            "/objects/3/repeat/vary/0",
        ),
        ("/properties/display/properties", "/display"),
    ] {
        let mut scene = full_scene();
        let varied = json!({ "parameter": "size", "from": 1, "to": 1 });
        scene["objects"][3]["repeat"] = json!({ "columns": 1, "vary": [varied] });
        // The reader's message about an unknown key: the known keys.
        scene.pointer_mut(parent).expect("there")["qqqqqqqqqqqqqqqq"] = json!(1);
        let said = said(&scene.to_string());
        let list = said.split_once(" has the keys ").expect(&said).1.lines().next().unwrap_or_default();
        let mut known: Vec<_> = list.split([',', ' ']).filter(|w| !w.is_empty() && *w != "and").collect();
        known.sort_unstable();
        let mut described = keys(pointer);
        described.sort();
        assert_eq!(described, known, "{parent}");
    }
}

#[test]
fn editors_get_titles_defaults_and_explanations() {
    let schema = schema(&Registry::builtin());
    let k_d = &schema["properties"]["objects"]["items"]["properties"]["material"]["properties"]["k_d"];
    assert_eq!(k_d["title"], "diffuse coefficient (k_d)");
    assert_eq!(k_d["default"], 0.8);
    assert_eq!((&k_d["minimum"], &k_d["maximum"]), (&json!(0.5), &json!(1)));
    let models = &schema["properties"]["reflection_model"];
    assert_eq!(models["enum"].as_array().map(Vec::len), models["enumDescriptions"].as_array().map(Vec::len));
    assert!(schema["properties"]["observer"]["description"].is_string());
}
