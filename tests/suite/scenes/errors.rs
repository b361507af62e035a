//! Every kind of error in a scene has its own message: the error, its position, and the remedy.

use std::{fs, time::Instant};

use lights_camera_models::{
    registry::Registry,
    scene::{
        error::MOST_LISTED,
        load::{self, Defaults},
    },
};
use proptest::prelude::*;
use serde_json::{Value, json};

use crate::helpers::support::{
    assert_quick, changed, check_wording, full_scene, lcm, lcm_in, said, said_of_bytes,
};

#[test]
fn the_full_scene_is_valid() {
    assert_eq!(said(&full_scene().to_string()), "");
    assert_eq!(said(&changed(|_| {})), "");
    assert_eq!(said(&format!("\u{FEFF}{}", full_scene())), "", "after a byte order mark");
}

#[test]
fn a_message_names_file_line_column_path_value_and_rule() {
    let text = r#"{
  "scene_size": { "height": 10, "width": 10, "depth": 10 },
  "reflection_model": "lambert", "shading_model": "gouraud",
  "lights": [{ "type": "point", "position": [7.5, 8, 9] }],
  "observer": { "position": [5, 5, 9.5], "direction": [0, 0, -1] },
  "objects": [
    { "type": "sphere", "position": [5, 5, 5],
      "material": { "k_d": 0.20, "alpha": 3.5 } }
  ]
}"#;
    assert_eq!(
        said(text),
        "scene.json:8:28: objects[0].material.k_d is 0.20, but the diffuse coefficient must be between 0.5 and 1\n\
         scene.json:8:43: objects[0].material.alpha is 3.5, but the shininess must be a whole number, 0 or more"
    );
}

/// A change of the full scene, and the expected part of the message.
type Case = (&'static str, Value, &'static str);

#[test]
fn every_constraint_has_its_message() {
    let number = "it must be a number";
    let cases: &[Case] = &[
        // Scene size.
        (
            "/scene_size/height",
            json!(0),
            "scene_size.height is 0, but the height of the room must be greater than 0 and at most 100 m",
        ),
        (
            "/scene_size/width",
            json!(100.5),
            "scene_size.width is 100.5, but the width of the room must be greater than 0 and at most 100 m",
        ),
        ("/scene_size/depth", json!(-1), "scene_size.depth is -1"),
        (
            "/scene_size/depth",
            json!("10"),
            "scene_size.depth is \"10\", but it must be a number, without quotes",
        ),
        (
            "/scene_size",
            json!([10, 10, 10]),
            "scene_size is [10, 10, 10], but scene_size must be an object, with the keys height, width and depth",
        ),
        // Models.
        (
            "/reflection_model",
            json!("fong"),
            "reflection_model is \"fong\", but the reflection model must be \"lambert\"",
        ),
        ("/reflection_model", json!("fong"), "did you mean \"phong\"?"),
        ("/reflection_model", json!("Blinn-Phong"), "did you mean \"blinn_phong\"?"),
        ("/reflection_model", json!(null), "reflection_model is null, but the reflection model must be"),
        ("/objects/0/material/fresnel", json!("conducter"), "did you mean \"conductor\"?"),
        ("/shading_model", json!("gourad"), "did you mean \"gouraud\"?"),
        (
            "/shading_model",
            json!(3),
            "shading_model is 3, but the shading model must be \"flat\", \"gouraud\", \"phong\" or \"derivative\"",
        ),
        // Lights.
        ("/lights", json!([]), "lights is [], but a scene must have between 1 and 256 lights"),
        ("/lights", json!({}), "lights is {}, but a scene must have a list of lights"),
        ("/lights/0", json!("lamp"), "lights[0] is \"lamp\", but a light must be an object"),
        (
            "/lights/0/type",
            json!("pont"),
            "lights[0].type is \"pont\", but the light type must be \"point\", \"spot\", \"photometric\", \"directional\", \"ambient\", \"rectangle\", \"disc\", \"sphere\", \"cylinder\", \"sun\" or \"environment\"; did you mean \"point\"?",
        ),
        ("/lights/0/position", json!([1, 2]), "a position must be three numbers: [x, y, z]"),
        (
            "/lights/0/position",
            json!([1, "2", 3]),
            "lights[0].position[1] is \"2\", but a position must be three numbers",
        ),
        (
            "/lights/0/position",
            json!([1, 0, 3]),
            "but a position must be inside the room: 0 < x ≤ 20 (width), 0 < y ≤ 10 (height), 0 < z ≤ 30.5 (depth)",
        ),
        ("/lights/0/position", json!([20.5, 1, 3]), "must be inside the room"),
        (
            "/lights/0/position",
            json!([5, 5, 9.5]),
            "but the observer is there; a light must not be where the observer is",
        ),
        (
            "/lights/0/direction",
            json!([0, -1, 0]),
            "lights[0].direction is given, but a point light has no direction",
        ),
        (
            "/lights/0/cone_angle",
            json!(20),
            "lights[0].cone_angle is given, but a point light has no cone_angle",
        ),
        ("/lights/1/direction", json!([0, 0, 0]), "but a direction must not be zero"),
        (
            "/lights/1/direction",
            json!("down"),
            "lights[1].direction is \"down\", but a direction must be three numbers",
        ),
        (
            "/lights/1/cone_angle",
            json!(0),
            "lights[1].cone_angle is 0, but the cone angle must be greater than 0 and at most 90 degrees",
        ),
        ("/lights/1/cone_angle", json!(91), "lights[1].cone_angle is 91"),
        ("/lights/1/penumbra", json!(1.1), "lights[1].penumbra is 1.1, but it must be between 0 and 1"),
        (
            "/lights/2/position",
            json!([1, 1, 1]),
            "lights[2].position is given, but a directional light has no position",
        ),
        (
            "/lights/0/colour",
            json!([255, 256, 0]),
            "lights[0].colour[1] is 256, but a colour must be three whole numbers from 0 to 255",
        ),
        (
            "/lights/0/colour",
            json!([255, 1.5, 0]),
            "lights[0].colour[1] is 1.5, but a colour must be three whole numbers",
        ),
        (
            "/lights/0/colour",
            json!("#ff8000"),
            "lights[0].colour is \"#ff8000\", but a colour must be three whole numbers from 0 to 255: [red, green, blue]; write [255, 128, 0]",
        ),
        (
            "/lights/0/intensity",
            json!(-0.5),
            "lights[0].intensity is -0.5, but an intensity must be at least 0",
        ),
        (
            "/lights/0/intensity",
            json!("20"),
            "lights[0].intensity is \"20\", but it must be a number, without quotes",
        ),
        ("/lights/0/intensity", json!(true), number),
        (
            "/lights/0/luminous_flux",
            json!(800),
            "lights[0].luminous_flux conflicts with intensity; a light has one or the other",
        ),
        (
            "/lights/1/luminous_flux",
            json!(-1),
            "lights[1].luminous_flux is -1, but a luminous flux must be at least 0",
        ),
        (
            "/lights/1/luminous_flux",
            json!(1e39),
            "lights[1].luminous_flux is 1e+39, but a luminous flux must be at most 3.4e38",
        ),
        (
            "/lights/1/luminous_flux",
            json!("800 lm"),
            "lights[1].luminous_flux is \"800 lm\", but it must be a number: a luminous flux must be at least 0",
        ),
        (
            "/lights/2/luminous_flux",
            json!(800),
            "lights[2].luminous_flux is given, but a directional light has no luminous_flux",
        ),
        (
            "/lights/0/colour_temperature",
            json!(2700),
            "lights[0].colour_temperature conflicts with colour; a light has one or the other",
        ),
        (
            "/lights/1/colour_temperature",
            json!(999),
            "lights[1].colour_temperature is 999, but a colour temperature must be between 1000 and 40000 K",
        ),
        (
            "/lights/1/colour_temperature",
            json!([2700]),
            "lights[1].colour_temperature is [2700], but it must be a number: a colour temperature must be between",
        ),
        (
            "/lights/1/lumens",
            json!(800),
            "lights[1].lumens is not a key of a light; did you mean \"luminous_flux\"?",
        ),
        ("/lights/0/name", json!(7), "lights[0].name is 7, but it must be text"),
        // Observer.
        ("/observer", json!([]), "observer is a list of 0, but a scene has exactly one observer"),
        (
            "/observer",
            json!(5),
            "observer is 5, but it must be an object, with the keys position, direction and field_of_view",
        ),
        ("/observer/position", json!([5, 5, 31]), "observer.position is"),
        ("/observer/direction", json!([0, 0, 0]), "but a direction must not be zero"),
        ("/observer/direction", json!([1e-30, 0, 0]), "too long or too short"),
        (
            "/observer/field_of_view",
            json!(0.5),
            "observer.field_of_view is 0.5, but the field of view must be between 1 and 170 degrees",
        ),
        ("/observer/field_of_view", json!(171), "observer.field_of_view is 171"),
        // Objects.
        ("/objects", json!([]), "objects is [], but a scene must have between 1 and 10000 objects"),
        ("/objects/0/type", json!("sphear"), "did you mean \"sphere\"?"),
        ("/objects/0/type", json!(1), "objects[0].type is 1, but the object type must be"),
        (
            "/objects/0/position",
            json!([1, 2, 3]),
            "but lights[0] is there; an object must not be where a light is",
        ),
        (
            "/objects/0/position",
            json!([5, 5, 9.5]),
            "but the observer is there; an object must not be where the observer is",
        ),
        ("/objects/0/size", json!(0), "objects[0].size is 0, but a size must be greater than 0"),
        ("/objects/0/rotation", json!([0, 1]), "but a rotation must be three numbers"),
        (
            "/objects/0/tessellation",
            json!(1000000),
            "but the tessellation of a sphere must be a whole number between",
        ),
        (
            "/objects/0/tessellation",
            json!(-1),
            "but the tessellation of a sphere must be a whole number between",
        ),
        (
            "/objects/0/tessellation",
            json!(2.5),
            "but the tessellation of a sphere must be a whole number between",
        ),
        (
            "/objects/0/reflection_model",
            json!("x"),
            "objects[0].reflection_model is \"x\", but the reflection model must be",
        ),
        (
            "/objects/0/shading_model",
            json!({}),
            "objects[0].shading_model is {}, but the shading model must be",
        ),
        // Parameters of the object type.
        (
            "/objects/2/tube_radius",
            json!(0.3),
            "objects[2].tube_radius is 0.3, but the tube radius must be between 0.02 and 0.24",
        ),
        (
            "/objects/2/tube_radius",
            json!("0.1"),
            "objects[2].tube_radius is \"0.1\", but it must be a number, without quotes: the tube radius must be between",
        ),
        (
            "/objects/0/tube_radius",
            json!(0.1),
            "objects[0].tube_radius is given, but a sphere has no tube_radius",
        ),
        (
            "/objects/2/vertical_exponent",
            json!(1),
            "objects[2].vertical_exponent is given, but a torus has no vertical_exponent",
        ),
        (
            "/objects/3/horizontal_exponent",
            json!(0),
            "objects[3].horizontal_exponent is 0, but the horizontal exponent must be between 0.1 and 3",
        ),
        // Material.
        ("/objects/0/material", json!([]), "objects[0].material is [], but a material must be an object"),
        (
            "/objects/0/material/k_a",
            json!(1.01),
            "material.k_a is 1.01, but the ambient coefficient must be between 0 and 1",
        ),
        (
            "/objects/0/material/k_d",
            json!(0.49),
            "material.k_d is 0.49, but the diffuse coefficient must be between 0.5 and 1",
        ),
        (
            "/objects/0/material/k_s",
            json!(-0.01),
            "material.k_s is -0.01, but the specular coefficient must be between 0 and 1",
        ),
        (
            "/objects/0/material/k_s",
            json!("shiny"),
            "but it must be a number: the specular coefficient must be between 0 and 1",
        ),
        (
            "/objects/0/material/alpha",
            json!(-1),
            "material.alpha is -1, but the shininess must be a whole number, 0 or more",
        ),
        (
            "/objects/0/material/alpha",
            json!(1e308),
            "material.alpha is 1e+308, but the shininess must be a whole number, 0 or more and at most 9007199254740992",
        ),
        ("/objects/0/material/metallic", json!(2), "material.metallic is 2, but it must be between 0 and 1"),
        (
            "/objects/0/material/base_colour",
            json!([1, 2, 3, 4]),
            "but the base colour must be three whole numbers from 0 to 255",
        ),
        ("/objects/0/material/base_colour", json!([-1, 2, 3]), "material.base_colour[0] is -1"),
        (
            "/objects/0/material/wrap_exponent",
            json!(9),
            "material.wrap_exponent is 9, but the wrap exponent must be between 1 and 4",
        ),
        // Display.
        ("/display/exposure", json!(16.5), "display.exposure is 16.5, but it must be between -16 and 16 EV"),
        (
            "/display/tone_mapping",
            json!("ACES"),
            "display.tone_mapping is \"ACES\", but the tone mapping must be \"none\", \"reinhard\", \"reinhard_luminance\", \"aces\", \"agx\", \"tony_mc_mapface\", \"blender_filmic\" or \"khronos_pbr_neutral\"; did you mean \"aces\"?",
        ),
        (
            "/display/encoding",
            json!("linear"),
            "display.encoding is \"linear\", but it must be \"srgb\" or \"off\"",
        ),
        (
            "/display/background",
            json!("white"),
            "display.background is \"white\", but it must be \"environment\", \"colour\" or \"gradient\"",
        ),
        (
            "/display/background",
            json!([255, 255, 255]),
            "display.background is [255, 255, 255], but it must be \"environment\", \"colour\" or \"gradient\"",
        ),
        (
            "/display/background_colour",
            json!([255, 255]),
            "but the colour of the background must be three whole numbers from 0 to 255",
        ),
        ("/display/background_bottom", json!([0, 0, 256]), "display.background_bottom[2] is 256"),
        ("/name", json!(1), "name is 1, but it must be text"),
        ("/description", json!(["x"]), "description is [\"x\"], but it must be text"),
    ];
    for (pointer, value, expected) in cases {
        let text = changed(|scene| put(scene, pointer, value.clone()));
        let said = said(&text);
        check_wording(&said);
        assert!(said.contains(expected), "{pointer} = {value}\n  said: {said}\n  not: {expected}");
        assert_eq!(said.lines().count(), 1, "one mistake, one message:\n{said}");
        assert!(said.starts_with("scene.json:"), "{said}");
    }
}

/// Sets the value at a JSON pointer, adding the key if it is new.
fn put(scene: &mut Value, pointer: &str, value: Value) {
    if let Some(there) = scene.pointer_mut(pointer) {
        *there = value;
        return;
    }
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
    scene.pointer_mut(parent).expect("a parent")[key] = value;
}

#[test]
fn what_is_required_is_missed() {
    for (parent, key, expected) in [
        ("", "lights", "lights is missing; a scene must have a list of lights"),
        ("", "observer", "observer is missing; a scene needs one observer"),
        ("", "objects", "objects is missing; a scene must have a list of objects"),
        ("/lights/0", "type", "lights[0].type is missing; the light type must be \"point\""),
        ("/lights/0", "position", "lights[0].position is missing; a point light needs one"),
        ("/lights/1", "direction", "lights[1].direction is missing; a spot light needs one"),
        ("/lights/2", "direction", "lights[2].direction is missing; a directional light needs one"),
        ("/observer", "position", "observer.position is missing; the observer needs one"),
        ("/observer", "direction", "observer.direction is missing; the observer needs one"),
        ("/objects/0", "type", "objects[0].type is missing; the object type must be \"sphere\""),
        ("/objects/0", "position", "objects[0].position is missing; an object needs one"),
    ] {
        let text = changed(|scene| {
            let parent = scene.pointer_mut(parent).expect("there");
            parent.as_object_mut().expect("an object").remove(key);
        });
        let said = said(&text);
        check_wording(&said);
        assert!(said.contains(expected), "{parent}/{key}: {said}");
    }
}

#[test]
fn unknown_keys_name_the_nearest_known_one_or_where_they_belong() {
    for (pointer, expected) in [
        ("/scene_sise", "scene_sise is not a key of a scene; did you mean \"scene_size\"?"),
        ("/sceneSize", "did you mean \"scene_size\"?"),
        ("/camera", "did you mean \"observer\"?"),
        ("/lights/0/colr", "lights[0].colr is not a key of a light; did you mean \"colour\"?"),
        ("/lights/0/brightness", "did you mean \"intensity\"?"),
        ("/lights/1/coneAngle", "did you mean \"cone_angle\"?"),
        ("/observer/fov", "did you mean \"field_of_view\"?"),
        ("/objects/0/positon", "did you mean \"position\"?"),
        (
            "/objects/2/tubeRadius",
            "objects[2].tubeRadius is not a key of an object; did you mean \"tube_radius\"?",
        ),
        ("/objects/2/minor_radius", "did you mean \"tube_radius\"?"),
        ("/objects/3/vertical_exponant", "did you mean \"vertical_exponent\"?"),
        ("/objects/0/k_d", "objects[0].k_d is not a key of an object; it is a material parameter"),
        ("/objects/0/material/shininess", "did you mean \"alpha\"?"),
        ("/objects/0/material/kd", "did you mean \"k_d\"?"),
        ("/objects/0/material/basecolor", "did you mean \"base_colour\"?"),
        ("/display/gamma", "did you mean \"encoding\"?"),
        ("/exposure", "exposure is not a key of a scene; it is a key of \"display\": display.exposure"),
        ("/display/field_of_view", "it is a key of \"observer\": observer.field_of_view"),
        ("/observer/background_color", "it is a key of \"display\": display.background_colour"),
        ("/cone_angle", "cone_angle is not a key of a scene; it is a key of the entries of \"lights\""),
        ("/display/variants", "display.variants is not a key of display; it is a key of the scene itself"),
        (
            "/k_d",
            "k_d is not a key of a scene; it is a material parameter: write it in \"material\" of an object",
        ),
        (
            "/scene_size/zzzzzz",
            "zzzzzz is not a key of scene_size; scene_size has the keys height, width and depth",
        ),
    ] {
        let said = said(&changed(|scene| put(scene, pointer, json!(1))));
        check_wording(&said);
        assert!(said.contains(expected), "{pointer}: {said}");
    }
    // Lights and objects have one.
    let several = said(&changed(|scene| put(scene, "/display/position", json!(1))));
    assert!(several.contains("is not a key of display") && !several.contains("it is a key of"), "{several}");
}

#[test]
fn keys_given_twice_name_both_places() {
    let text = full_scene().to_string().replacen("\"k_a\":0.1", "\"k_a\":0.1,\n\"k_a\":0.2", 1);
    let said_of = said(&text);
    assert!(
        said_of.contains("scene.json:2:1: objects[0].material.k_a is given twice; first given at 1:"),
        "{said_of}"
    );
    let text = full_scene().to_string().replacen("\"colour\":", "\"color\":[1,2,3],\n\"colour\":", 1);
    let said_of = said(&text);
    assert!(said_of.contains("lights[0].colour is given twice as colour; first given at 1:"), "{said_of}");
}

#[test]
fn american_spelling_is_read() {
    let text = full_scene().to_string().replace("colour", "color");
    assert_eq!(said(&text), "");
    let text = text.replacen("255,250,240", "256,250,240", 1);
    assert!(said(&text).contains("lights[0].colour[0] is 256"), "{}", said(&text));
}

#[test]
fn numbers_too_large_for_32_bits_break_the_rule_of_their_field() {
    for huge in ["1e999", "1e39", "-1e999", "-1e39"] {
        for (from, expected) in [
            ("\"k_a\":0.1", "but the ambient coefficient must be between 0 and 1"),
            ("\"intensity\":20", "but an intensity must be"),
            ("\"size\":2", "but a size must be"),
            ("\"field_of_view\":45", "but the field of view must be between 1 and 170 degrees"),
            ("\"alpha\":32", "but the shininess must be a whole number, 0 or more"),
            ("\"exposure\":-1.5", "but it must be between"),
            ("\"height\":10", "but the height of the room must be"),
        ] {
            let key = from.split(':').next().expect("a key");
            let text = full_scene().to_string().replacen(from, &format!("{key}:{huge}"), 1);
            let said = said(&text);
            assert!(said.contains(&format!("is {huge}, {expected}")), "{from} {huge}: {said}");
        }
    }
    // Directions and rotations have no range.
    let rule = "numbers must be between -3.4e38 and 3.4e38, the largest of 32 bits";
    let text = full_scene().to_string().replacen("[0,45,0]", "[0,1e39,0]", 1);
    assert!(said(&text).contains(&format!(".rotation[1] is 1e39, but {rule}")), "{}", said(&text));
    let said_of = said(&changed(|s| s["observer"]["direction"] = json!([0, 1, -1e300])));
    assert!(said_of.contains(&format!("observer.direction[2] is -1e+300, but {rule}")), "{said_of}");
    let said_of = said(&changed(|s| s["observer"]["direction"] = json!([0, 1, -1e38])));
    assert!(!said_of.contains(rule), "{said_of}");
    let text = full_scene().to_string().replacen("[1,2,3]", "[1,1e999,3]", 1);
    assert!(said(&text).contains("must be inside the room"), "{}", said(&text));
}

#[test]
fn whole_numbers_may_be_written_with_a_point() {
    let text = full_scene().to_string().replacen("\"alpha\":32", "\"alpha\":3.2e1", 1);
    assert_eq!(said(&text.replacen("\"tessellation\":20", "\"tessellation\":20.0", 1)), "");
}

#[test]
fn counts_have_limits() {
    let light = json!({ "type": "ambient" });
    assert_eq!(said(&changed(|s| s["lights"] = vec![light.clone(); 256].into())), "");
    let said_of = said(&changed(|s| s["lights"] = vec![light.clone(); 257].into()));
    assert!(
        said_of.contains("lights is a list of 257, but a scene must have between 1 and 256 lights"),
        "{said_of}"
    );
    let object = json!({ "type": "cube", "position": [8, 5, 5] });
    assert_eq!(said(&changed(|s| s["objects"] = vec![object.clone(); 10_000].into())), "");
    let said_of = said(&changed(|s| s["objects"] = vec![object.clone(); 10_001].into()));
    assert!(
        said_of.contains("objects is a list of 10001, but a scene must have between 1 and 10000 objects")
    );
}

#[test]
fn of_ten_thousand_broken_objects_some_are_reported_and_the_rest_is_counted_quickly() {
    let object = json!({ "type": "cub", "position": [80, 5, 5], "material": { "k_d": 0.1, "kd": 1 } });
    let timed = |count: usize| {
        let text = changed(|s| s["objects"] = vec![object.clone(); count].into());
        let start = Instant::now();
        (said(&text), start.elapsed())
    };
    let (said, took) = timed(10_000);
    assert_eq!(said.lines().count(), MOST_LISTED + 1);
    assert!(said.contains("the scene has 39800 more problems, which are not listed"), "{said}");
    assert_quick(took, || timed(1000).1);
}

#[test]
fn half_a_character_is_named_as_what_it_is() {
    let said = said("{\"name\": \"\\ud800\"}");
    assert!(said.contains("an escape from \\ud800 to \\udfff is half a character"), "{said}");
}

#[test]
fn hostile_files_do_not_take_all_memory() {
    let lights = format!("[{}1]", "1,".repeat(3_000_000));
    let said_of =
        said(&full_scene().to_string().replacen("\"lights\":[", &format!("\"lights\":{lights},\"x\":["), 1));
    assert!(said_of.contains("lights is a list of 3000001, but"), "{}", said_of.len());
    assert_eq!(said_of.lines().count(), 2);
    let keys = "\"q\":1,".repeat(1_000_000);
    let said_of = said(&full_scene().to_string().replacen('{', &format!("{{{keys}"), 1));
    assert!(said_of.contains("the scene has 999800 more problems, which are not listed"));
    assert_eq!(said_of.lines().count(), MOST_LISTED + 1);
}

#[test]
fn the_check_lists_the_first_problems_and_counts_the_rest_for_programs_too() {
    let keys: String = (0..MOST_LISTED + 1).map(|i| format!("\"q{i}\":1,")).collect();
    let text = full_scene().to_string().replacen('{', &format!("{{{keys}"), 1);
    let told = lcm(&["check", "-"], &text);
    assert!(
        told.err.lines().count() == MOST_LISTED + 1 && told.err.contains("q199 is not a key"),
        "{}",
        told.err
    );
    assert!(told.err.contains("the scene has 1 more problem, which is not listed"), "{}", told.err);
    let told = lcm(&["check", "--json", "-"], &text);
    let report: Value = serde_json::from_str(&told.out).expect("JSON");
    let problems = report[0]["problems"].as_array().expect("a list");
    assert_eq!(problems.len(), MOST_LISTED + 1);
    assert_eq!(problems[MOST_LISTED]["message"], "the scene has 1 more problem, which is not listed");
}

#[test]
fn problems_are_found_quickly_in_one_huge_line_too() {
    let object = json!({ "type": "cube", "name": "é".repeat(50), "position": [80, 5, 5] });
    let mut scene = full_scene();
    let mut timed = |count: usize| {
        scene["objects"] = vec![object.clone(); count].into();
        let text = scene.to_string();
        let start = Instant::now();
        (said(&text), start.elapsed())
    };
    let (told, took) = timed(10_000);
    assert!(told.contains("the scene has 9800 more problems"));
    assert_quick(took, || timed(1000).1);
}

#[test]
fn what_is_missing_is_asked_for() {
    let registry = Registry::builtin();
    let text = changed(|s| {
        let s = s.as_object_mut().expect("an object");
        s.remove("scene_size");
        s.remove("reflection_model");
        s.remove("shading_model");
        // Fits into the default room.
        s["lights"] = json!([{ "type": "ambient" }]);
    });
    for defaults in [Defaults::Ask, Defaults::Use] {
        let loaded = load::from_text(&text, "scene.json", &registry, defaults).expect("valid with defaults");
        let missing: Vec<_> = loaded.missing.iter().map(ToString::to_string).collect();
        assert_eq!(
            missing,
            [
                "scene_size (default: 10 × 10 × 10 m)",
                "reflection_model (default: lambert)",
                "shading_model (default: gouraud)"
            ]
        );
        assert_eq!(loaded.scene.scene_size, Default::default());
        assert_eq!(loaded.scene.reflection_model, "lambert");
        assert_eq!(loaded.scene.shading_model, "gouraud");
    }
    assert_eq!(
        said(&text),
        "scene.json:1:1: scene_size (default: 10 × 10 × 10 m), reflection_model (default: lambert) and \
         shading_model (default: gouraud) are missing; --use-defaults accepts the defaults, --no-defaults rejects them"
    );
}

#[test]
fn one_missing_extent_counts_as_missing_and_the_others_are_kept() {
    let text = changed(|s| drop(s["scene_size"].as_object_mut().expect("an object").remove("depth")));
    let loaded = load::from_text(&text, "scene.json", &Registry::builtin(), Defaults::Ask).expect("valid");
    assert_eq!(
        loaded.missing.iter().map(ToString::to_string).collect::<Vec<_>>(),
        ["scene_size.depth (default: 10 m)"]
    );
    assert_eq!(loaded.scene.scene_size.width, 20.0);
    assert_eq!(loaded.scene.scene_size.depth, 10.0);
}

#[test]
fn missing_parts_and_other_problems_are_reported_together() {
    let text = changed(|s| {
        s.as_object_mut().expect("an object").remove("shading_model");
        s["lights"][0]["intensity"] = json!(-1);
    });
    let said = said(&text);
    assert!(said.contains("shading_model is missing; --use-defaults accepts the default, gouraud"), "{said}");
    assert!(said.contains("lights[0].intensity is -1"), "{said}");
}

#[test]
fn what_is_not_utf_8_json_is_recognised() {
    let utf16 = |bom: &[u8], bytes: fn(u16) -> [u8; 2]| {
        let text: Vec<u8> = "{\"a\": 1}".encode_utf16().flat_map(bytes).collect();
        [bom, &text].concat()
    };
    for (bytes, expected) in [
        (
            utf16(b"\xFF\xFE", u16::to_le_bytes),
            "scene.json:1:1: not UTF-8 text: the file is UTF-16 (little-endian)",
        ),
        (
            utf16(b"\xFE\xFF", u16::to_be_bytes),
            "scene.json:1:1: not UTF-8 text: the file is UTF-16 (big-endian)",
        ),
        (utf16(b"", u16::to_le_bytes), "scene.json:1:1: not UTF-8 text: the file seems to be UTF-16"),
        (
            b"\xEF\xBB\xBF{\"a\": \xE9}".to_vec(),
            "scene.json:1:7: not UTF-8 text: unexpected byte 0xE9; the file may be Latin-1",
        ),
        (
            b"\x89PNG\r\n\x1a\n\0\0".to_vec(),
            "the file is a PNG picture; a scene in it is read if the name of the file ends in .png",
        ),
        (
            b"{\n \"name\": \"caf\xE9\" }".to_vec(),
            "scene.json:2:14: not UTF-8 text: unexpected byte 0xE9; the file may be Latin-1",
        ),
        (b"{\"a\": \0}".to_vec(), "scene.json:1:7: not UTF-8 text: there is a zero byte"),
        (b"\x7FELF\x01\x01\x02\xFF\xFE\x90".to_vec(), "binary"),
        (b"{\"a\": \"\xE2\x82".to_vec(), "the file ends within a character; it seems to be truncated"),
        (Vec::new(), "scene.json is empty; --use-defaults loads the default scene"),
        (b" \n\t\n".to_vec(), "scene.json is empty; --use-defaults loads the default scene"),
        (b"\xEF\xBB\xBF".to_vec(), "scene.json is empty; --use-defaults loads the default scene"),
        (b"\xEF\xBB\xBF{\"a\": nul}".to_vec(), "scene.json:1:7: not JSON: nul is not JSON"),
        (b"[]".to_vec(), "scene.json:1:1: the scene is [], but a scene must be an object"),
        (b"\"x\"".to_vec(), "scene.json:1:1: the scene is \"x\", but a scene must be an object"),
        (br#"{"name": "\ud800"}"#.to_vec(), "not JSON"),
    ] {
        let said = said_of_bytes(&bytes);
        check_wording(&said);
        assert!(said.contains(expected), "{}: {said}", String::from_utf8_lossy(&bytes));
    }
}

#[test]
fn every_truncation_of_a_scene_is_an_error_and_none_panics() {
    let text = changed(|_| {});
    for end in (0..text.len() - 1).filter(|end| text.is_char_boundary(*end)) {
        assert_ne!(said(&text[..end]), "", "cut off at {end}");
    }
}

#[test]
fn files_that_cannot_be_read_say_why() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let at = folder.path();
    fs::create_dir(at.join("scenes")).expect("created");
    fs::write(at.join("scenes/room.json"), full_scene().to_string()).expect("written");
    fs::write(at.join("empty.json"), "").expect("written");
    let huge = fs::File::create(at.join("huge.json")).expect("created");
    huge.set_len(65 << 20).expect("a hole takes no space");
    fs::write(at.join("picture.png"), b"\x89PNG\r\n\x1a\n").expect("written");
    let picture = fs::File::options().write(true).open(at.join("picture.png")).expect("there");
    picture.set_len(1025 << 20).expect("a hole takes no space");
    fs::write(at.join("broken.json"), "{\"lights\": [").expect("written");
    for (file, expected) in [
        ("scenes/rom.json", "scenes/rom.json: file not found. Did you mean scenes/room.json?"),
        ("nowhere/x.json", "nowhere/x.json: file not found"),
        ("scenes", "scenes is a folder; a scene is a single file; this one holds room.json"),
        ("empty.json", "empty.json is empty; --use-defaults loads the default scene"),
        ("huge.json", "huge.json is larger than 64 MiB, the most allowed for a scene; it was not read"),
        (
            "picture.png",
            "picture.png is larger than 1024 MiB, the most allowed for a picture with a scene in it; it was not read",
        ),
        ("broken.json", "broken.json:1:13: not JSON: the file ends within a list; it seems to be truncated"),
        ("scenes/room.json/x", "scenes/room.json/x could not be read"),
    ] {
        let run = lcm_in(at, &["check", file], b"");
        assert_eq!(run.status, Some(1), "{file}: {}", run.err);
        assert!(run.err.contains(expected), "{file}: {}", run.err);
        assert_eq!(run.err.lines().count(), 1, "{}", run.err);
        let run = lcm_in(at, &["check", "--json", file], b"");
        assert_eq!((run.status, run.err.as_str()), (Some(1), ""));
        let report: Value = serde_json::from_str(&run.out).expect("JSON");
        assert_eq!(report[0]["valid"], false);
        assert_eq!(report[0]["problems"].as_array().map(Vec::len), Some(1));
    }
}

#[cfg(target_os = "linux")]
#[test]
fn endless_devices_are_refused() {
    let run = lcm_in(std::path::Path::new("/"), &["check", "/dev/zero"], b"");
    assert_eq!(run.status, Some(1));
    assert!(run.err.contains("/dev/zero is larger than 64 MiB"), "{}", run.err);
}

#[cfg(unix)]
#[test]
fn a_file_without_permission_says_so() {
    use std::os::unix::fs::PermissionsExt as _;
    let folder = tempfile::tempdir().expect("a temporary folder");
    let file = folder.path().join("secret.json");
    fs::write(&file, "{}").expect("written");
    fs::set_permissions(&file, fs::Permissions::from_mode(0o000)).expect("set");
    // The superuser may read everything; then there is nothing to test.
    if fs::read(&file).is_ok() {
        return;
    }
    let run = lcm_in(folder.path(), &["check", "secret.json"], b"");
    assert_eq!(run.status, Some(1));
    assert!(run.err.contains("secret.json: no permission to read this file"), "{}", run.err);
}

/// Any JSON, shallow.
fn any_json() -> impl Strategy<Value = Value> {
    let leaf = prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        any::<f64>().prop_map(|v| serde_json::Number::from_f64(v).map_or(Value::Null, Value::Number)),
        "\\PC{0,8}".prop_map(Value::from),
        prop::sample::select(vec!["point", "spot", "sphere", "phong", "flat", "color"]).prop_map(Value::from),
    ];
    leaf.prop_recursive(4, 40, 5, |inner| {
        let keys = prop_oneof![
            prop::sample::select(vec![
                "scene_size",
                "height",
                "lights",
                "type",
                "position",
                "direction",
                "colour",
                "color",
                "observer",
                "objects",
                "material",
                "k_d",
                "display",
                "exposure",
                "name",
                "$schema",
            ])
            .prop_map(str::to_owned),
            "\\PC{0,6}",
        ];
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..5).prop_map(Value::from),
            prop::collection::vec((keys, inner), 0..6)
                .prop_map(|fields| Value::Object(fields.into_iter().collect())),
        ]
    })
}

/// The pointers of all values in a JSON value.
fn pointers(value: &Value, at: &str, all: &mut Vec<String>) {
    all.push(at.to_owned());
    match value {
        Value::Object(map) => map.iter().for_each(|(k, v)| pointers(v, &format!("{at}/{k}"), all)),
        Value::Array(list) => {
            list.iter().enumerate().for_each(|(i, v)| pointers(v, &format!("{at}/{i}"), all))
        }
        _ => {}
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn any_bytes_are_read_without_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        said_of_bytes(&bytes);
    }

    #[test]
    fn any_text_is_read_without_panic(text in "\\PC{0,200}") {
        said(&text);
    }

    #[test]
    fn any_json_is_read_without_panic(json in any_json()) {
        prop_assert_ne!(said(&json.to_string()), "");
    }

    #[test]
    fn a_scene_with_changed_bytes_is_read_without_panic(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..6),
    ) {
        let mut bytes = full_scene().to_string().into_bytes();
        for (index, byte) in changes {
            let at = index.index(bytes.len());
            bytes[at] = byte;
        }
        said_of_bytes(&bytes);
    }

    #[test]
    fn a_scene_with_removed_or_repeated_pieces_is_read_without_panic(
        cut in any::<(prop::sample::Index, prop::sample::Index, prop::sample::Index)>(), repeat in any::<bool>(),
    ) {
        let text = full_scene().to_string();
        let (a, b, c) = (cut.0.index(text.len()), cut.1.index(text.len()), cut.2.index(text.len()));
        let (from, to) = (a.min(b), a.max(b));
        let changed = if repeat {
            format!("{}{}{}", &text[..c], &text[from..to], &text[c..])
        } else {
            format!("{}{}", &text[..from], &text[to..])
        };
        said(&changed);
    }

    #[test]
    fn a_scene_with_any_value_replaced_is_read_without_panic(index in any::<prop::sample::Index>(), json in any_json()) {
        let mut scene = full_scene();
        let mut all = Vec::new();
        pointers(&scene, "", &mut all);
        let at = index.get(&all).clone();
        if let Some(value) = scene.pointer_mut(&at) {
            *value = json;
        }
        let said = said(&scene.to_string());
        for line in said.lines() {
            prop_assert!(line.starts_with("scene.json:"), "{}", line);
        }
    }
}
