//! Rows and grids in scene files: values, names, places, messages, and the way back into a file.

use glam::Vec3;
use lights_camera_models::{
    caption::{line, row_labels},
    parameter::Value,
    registry::Registry,
    scene::{Object, Repetition, Scene, check, rows::copies},
};
use serde_json::{Value as Json, json};

use crate::helpers::support::{read, said, written};

/// A scene whose first object has a row.
fn with_row(repeat: Json) -> String {
    with_objects(json!([
        { "type": "sphere", "name": "ball", "position": [1, 5, 5], "size": 0.5,
          "material": { "base_colour": [200, 100, 50] }, "repeat": repeat },
        { "type": "cube", "position": [5, 8, 5], "size": 0.5 }
    ]))
}

fn with_objects(objects: Json) -> String {
    json!({
        "name": "Row",
        "description": "A row.",
        "scene_size": { "height": 10, "width": 10, "depth": 10 },
        "reflection_model": "metallic_roughness",
        "shading_model": "phong",
        "lights": [{ "type": "point", "position": [7.5, 8, 9], "intensity": 20 }],
        "observer": { "position": [5, 5, 9.5], "direction": [0, 0, -1], "field_of_view": 45 },
        "objects": objects
    })
    .to_string()
}

/// The row of five with one varied value.
fn varying(varied: Json) -> String {
    with_row(json!({ "columns": 5, "spacing": [1.2, 0, 0], "vary": [varied] }))
}

fn numbers(scene: &Scene, name: &str) -> Vec<f32> {
    let of = |object: &Object| match object.material.0.get(name) {
        Some(Value::Number(v)) => Some(*v),
        Some(Value::Integer(n)) => Some(*n as f32),
        _ => None,
    };
    scene.objects.iter().filter_map(of).collect()
}

#[test]
fn an_entry_stands_for_copies_with_names_places_and_values() {
    let scene = read(&varying(json!({ "parameter": "material.roughness", "from": 0.1, "to": 0.9 })));
    assert_eq!(scene.objects.len(), 6);
    // As a person would calculate them, without the noise of 32 bits.
    assert_eq!(numbers(&scene, "roughness"), [0.1, 0.3, 0.5, 0.7, 0.9]);
    let places: Vec<_> = scene.objects[..5].iter().map(|o| o.position.x).collect();
    assert_eq!(places, [1.0, 2.2, 3.4, 4.6, 5.8]);
    let names: Vec<_> = scene.objects.iter().map(|o| o.name.as_deref()).collect();
    assert_eq!(names[..3], [Some("ball 1"), Some("ball 2"), Some("ball 3")]);
    assert_eq!(names[5], None);
    let row = scene.row(3).expect("a row");
    assert_eq!((row.range(), row.entry.name.as_deref()), (0..5, Some("ball")));
    assert!(scene.row(5).is_none());
    assert_eq!([0, 4, 5].map(|i| scene.place_in_file(i)), [(0, Some(0)), (0, Some(4)), (1, None)]);
}

#[test]
fn values_go_in_steps_in_factors_or_as_listed_and_end_exactly() {
    let of = |varied: Json| {
        numbers(
            &read(&varying(varied.clone())),
            varied["parameter"].as_str().expect("a path").trim_start_matches("material."),
        )
    };
    let log = of(json!({ "parameter": "material.roughness", "from": 0.01, "to": 1, "scale": "logarithmic" }));
    assert_eq!((log[0], log[4]), (0.01, 1.0));
    // The product of the ends is no number of 32 bits.
    let tiny = json!({ "parameter": "size", "from": 1e-25, "to": 1e-21, "scale": "logarithmic" });
    assert_eq!(read(&varying(tiny)).objects[2].size, 1e-23);
    assert!((log[2] - 0.1).abs() < 1e-7 && log.windows(2).all(|w| (w[1] / w[0] - 10f32.sqrt()).abs() < 1e-5));
    let list = of(json!({ "parameter": "material.roughness", "values": [0.2, 0.9, 0.3, 0.4, 0.35] }));
    assert_eq!(list, [0.2, 0.9, 0.3, 0.4, 0.35]);
    // Whole numbers stay whole.
    assert_eq!(of(json!({ "parameter": "material.alpha", "from": 1, "to": 10 })), [1.0, 3.0, 6.0, 8.0, 10.0]);
    let colours = read(&varying(json!({ "parameter": "material.base_colour",
        "values": [[255, 0, 0], [0, 255, 0], [0, 0, 255], [9, 9, 9], [1, 2, 3]] })));
    assert_eq!(colours.objects[4].material.0["base_colour"], Value::Colour([1, 2, 3]));
    let models = read(&varying(json!({ "parameter": "reflection_model",
        "values": ["lambert", "phong", "ward", "eon", "disney"] })));
    assert_eq!(models.objects[2].reflection_model.as_deref(), Some("ward"));
    assert!(models.models().contains("disney"));
    let sizes = read(&varying(json!({ "parameter": "size", "from": 0.5, "to": 1 })));
    assert_eq!(sizes.objects[4].size, 1.0);
    let one = read(&with_row(json!({ "columns": 1, "vary": [
        { "parameter": "material.roughness", "from": 0.25, "to": 0.5 }] })));
    assert_eq!(numbers(&one, "roughness"), [0.25]);
}

#[test]
fn a_grid_varies_one_value_across_and_another_down() {
    let scene = read(&with_row(json!({
        "columns": 3, "rows": 2, "spacing": [2, 0, 0], "row_spacing": [0, -1, 0],
        "vary": [
            { "parameter": "material.roughness", "from": 0.2, "to": 0.4 },
            { "parameter": "material.metallic", "from": 0, "to": 1, "along": "rows" },
            { "parameter": "size", "values": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6], "along": "all" }
        ]
    })));
    assert_eq!(numbers(&scene, "roughness"), [0.2, 0.3, 0.4, 0.2, 0.3, 0.4]);
    assert_eq!(numbers(&scene, "metallic"), [0.0, 0.0, 0.0, 1.0, 1.0, 1.0]);
    let sizes: Vec<_> = scene.objects[..6].iter().map(|o| o.size).collect();
    assert_eq!(sizes, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
    assert_eq!(scene.objects[5].position, Vec3::new(5.0, 4.0, 5.0));
}

#[test]
fn a_row_is_written_as_the_entry_that_was_read() {
    let text =
        varying(json!({ "parameter": "material.roughness", "from": 0.1, "to": 0.9, "scale": "logarithmic" }));
    let scene = read(&text);
    let back: Json = serde_json::from_str(&written(&scene)).expect("JSON");
    assert_eq!(back["objects"].as_array().map(Vec::len), Some(2));
    assert_eq!(
        back["objects"][0]["repeat"],
        serde_json::from_str::<Json>(&text).expect("JSON")["objects"][0]["repeat"]
    );
    assert_eq!(back["objects"][0]["name"], "ball");
    assert_eq!(read(&written(&scene)), scene);
    assert_eq!(
        serde_json::from_str::<Scene>(&serde_json::to_string(&scene).expect("JSON")).expect("a scene"),
        scene
    );
    assert_eq!(written(&read(&written(&scene))), written(&scene));
}

#[test]
fn copies_that_are_no_longer_those_of_their_entry_are_written_as_single_objects() {
    let mut scene = read(&varying(json!({ "parameter": "material.roughness", "from": 0.1, "to": 0.9 })));
    scene.objects[2].size = 0.75;
    let back = read(&written(&scene));
    assert_eq!(back.objects.len(), 6);
    assert!(back.objects.iter().all(|o| o.repeat == Repetition::None));
    assert_eq!((back.objects[2].size, back.objects[2].name.as_deref()), (0.75, Some("ball 3")));
    let mut scene = read(&varying(json!({ "parameter": "material.roughness", "from": 0.1, "to": 0.9 })));
    scene.objects.remove(1);
    assert!(scene.row(0).is_none());
    assert_eq!(read(&written(&scene)).objects.len(), 5);
}

#[test]
fn rows_are_found_beside_incomplete_ones() {
    let whole = read(&varying(json!({ "parameter": "material.roughness", "from": 0.1, "to": 0.9 })));
    let row = &whole.objects[..5];
    // Two copies, a row, and a row without its first copy.
    let objects = [&row[..2], row, &row[1..]].concat();
    let scene = Scene { objects, ..whole.clone() };
    let rows: Vec<_> = scene.rows().map(|row| row.range()).collect();
    assert_eq!((rows.len(), rows.first().cloned()), (1, Some(2..7)));
    assert!((0..11).all(|i| scene.row(i).map(|row| row.range()) == (2..7).contains(&i).then_some(2..7)));
    let places = [0, 1, 2, 6, 7, 10, 12].map(|i| scene.place_in_file(i));
    let expected = [(0, None), (1, None), (2, Some(0)), (2, Some(4)), (3, None), (6, None), (8, None)];
    assert_eq!(places, expected);
    assert_eq!(scene.gathered(&Registry::builtin()).objects.len(), 7);
}

#[test]
fn mistakes_are_reported_with_their_place_and_the_remedy() {
    let about = |varied: Json, expected: &str| {
        let said = said(&varying(varied));
        assert!(said.contains(expected), "{said}\nlacks\n{expected}");
        assert_eq!(said.lines().count(), 1, "{said}");
    };
    about(
        json!({ "parameter": "material.roughnes", "from": 0.1, "to": 0.9 }),
        "objects[0].repeat.vary[0].parameter is \"material.roughnes\", but it must be the path of a value",
    );
    about(
        json!({ "parameter": "roughness", "from": 0.1, "to": 0.9 }),
        "did you mean \"material.roughness\"?",
    );
    about(json!({ "parameter": "position", "from": 0.1, "to": 0.9 }), "it must be the path of a value");
    about(
        json!({ "parameter": "material.roughness", "from": 0.1, "to": 1.9 }),
        "objects[0].repeat.vary[0] gives copy 4 the value 1.45, but ",
    );
    about(
        json!({ "parameter": "material.roughness", "from": 0.1 }),
        "vary[0].to is missing; a varied value needs from and to, or values",
    );
    about(
        json!({ "parameter": "material.roughness", "values": [0.1, 0.2] }),
        "vary[0].values is [0.1, 0.2], but there must be one for each column: 5",
    );
    about(
        json!({ "parameter": "material.roughness", "from": 0.1, "to": 1, "values": [1, 1, 1, 1, 1] }),
        "values conflicts with from and to",
    );
    about(
        json!({ "parameter": "material.roughness", "from": 0, "to": 1, "scale": "logarithmic" }),
        "vary[0].scale is \"logarithmic\", but factors lead from 0 to 1 only if",
    );
    about(
        json!({ "parameter": "material.base_colour", "from": 0, "to": 1 }),
        "is not a number; give its values one by one",
    );
    about(
        json!({ "parameter": "material.roughness", "from": 0.1, "to": 0.9, "scale": "log" }),
        "vary[0].scale is \"log\"",
    );
    about(json!({ "parameter": "material.roughness", "from": "a", "to": 0.9 }), "vary[0].from is \"a\"");
    about(json!({ "from": 0.1, "to": 0.9 }), "vary[0].parameter is missing");
    about(
        json!({ "parameter": "material.roughness", "values": [0.1, 0.2, "x", 0.3, 0.4] }),
        "values[2] is \"x\"",
    );
    about(
        json!({ "parameter": "material.roughness", "form": 0.1, "from": 0.1, "to": 0.9 }),
        "did you mean \"from\"?",
    );

    let about = |repeat: Json, expected: &str| {
        let said = said(&with_row(repeat));
        assert!(said.contains(expected), "{said}\nlacks\n{expected}");
        assert_eq!(said.lines().count(), 1, "{said}");
    };
    about(
        json!({ "columns": 0 }),
        "objects[0].repeat.columns is 0, but the number of columns must be a whole number of at least 1",
    );
    about(json!({ "columns": -3 }), "objects[0].repeat.columns is -3");
    about(json!({ "columns": 1e300 }), "must be a whole number of at least 1 and at most 4294967295");
    about(json!({}), "objects[0].repeat.columns is missing; a row needs the number of its copies");
    about(
        json!({ "columns": 1_000_000 }),
        "repeat has 1000000 copies, but a scene must have at most 10000 objects",
    );
    about(json!({ "columns": 500, "rows": 500 }), "repeat has 500 × 500 copies, but a scene must have");
    about(
        json!({ "columns": 4_000_000_000u32, "rows": 4_000_000_000u32 }),
        "a scene must have at most 10000 objects",
    );
    about(
        json!({ "columns": 3, "spacing": [0, 0, 0] }),
        "spacing is [0, 0, 0], but it must be three finite numbers of metres, not all of them 0",
    );
    about(
        json!({ "columns": 9, "spacing": [1.2, 0, 0] }),
        "objects[0].repeat puts copy 9 at [10.6, 5, 5], but a position must be inside the room",
    );
    about(
        json!({ "columns": 2, "vary": 3 }),
        "repeat.vary is 3, but a row must have a list of varied values",
    );
    about(
        json!({ "columns": 2, "vary": [
            { "parameter": "size", "from": 1, "to": 2 }, { "parameter": "size", "from": 1, "to": 2 }] }),
        "vary[1].parameter is \"size\", but it varies already",
    );
    // Copies of an object without a place are nowhere, which says nothing new.
    let said = said(&with_objects(json!([
        { "type": "sphere", "position": [2.6, 5], "repeat": { "columns": 3, "spacing": [1, 0, 0] } }
    ])));
    assert!(said.contains("objects[0].position is [2.6, 5], but") && said.lines().count() == 1, "{said}");
}

#[test]
fn the_greatest_number_of_objects_counts_copies() {
    let row = json!({ "type": "sphere", "position": [1, 5, 5], "size": 0.1,
        "repeat": { "columns": 6000, "spacing": [0.0001, 0, 0] } });
    let said = said(&with_objects(json!([row, row])));
    assert!(said.contains("objects[1].repeat has 6000 copies beside 6000 objects before it"), "{said}");
    assert_eq!(read(&with_objects(json!([row]))).objects.len(), 6000);
}

#[test]
fn paths_of_problems_are_those_of_the_file() {
    let mut scene: Json =
        serde_json::from_str(&varying(json!({ "parameter": "material.roughness", "from": 0.1, "to": 0.9 })))
            .expect("JSON");
    scene["objects"][1]["size"] = (-1).into();
    let said_of_cube = said(&scene.to_string());
    assert!(said_of_cube.contains("objects[1].size is -1"), "{said_of_cube}");
    scene["objects"][1]["size"] = 1.into();
    // What all copies share is reported once.
    scene["objects"][0]["material"]["metallic"] = 7.into();
    let said = said(&scene.to_string());
    assert_eq!(said.matches("objects[0].material.metallic is 7").count(), 1, "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
}

#[test]
fn entries_are_expanded_by_one_function() {
    let registry = Registry::builtin();
    let scene = read(&varying(json!({ "parameter": "material.roughness", "from": 0.1, "to": 0.9 })));
    let entries = scene.gathered(&registry).into_owned();
    assert_eq!(entries.objects.len(), 2);
    assert_eq!(copies(&entries.objects[0], &registry).expect("a row"), scene.objects[..5]);
    assert_eq!(entries.expanded(&registry).expect("a scene"), scene);
    assert_eq!(check::scene(&scene, &registry), []);
}

#[test]
fn labels_say_the_values_that_vary() {
    let registry = Registry::builtin();
    let text = |labels: bool| {
        with_row(json!({ "columns": 2, "spacing": [1.2, 0, 0], "labels": labels, "vary": [
            { "parameter": "material.roughness", "from": 0.1, "to": 0.9 },
            { "parameter": "reflection_model", "values": ["eon", "phong"] }] }))
    };
    assert_eq!(row_labels(&read(&text(false)), &registry), []);
    let labels = row_labels(&read(&text(true)), &registry);
    let texts: Vec<_> = labels.iter().map(|(i, parts)| (*i, line(parts))).collect();
    // Phong's model has no roughness.
    let eon = registry.model("eon").expect("built in").declaration.name;
    assert_eq!(texts, [(0, format!("r 0.1 · {eon}")), (1, "Phong".to_owned())]);
}
