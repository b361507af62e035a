//! Exported shaders: other compilers accept them, and their manifests contain the numbers of the scene.

use std::{fs, path::Path, process::Command};

use serde_json::{Value, json};

use crate::helpers::{
    skipped::skip,
    support::{full_scene, lcm_in, shipped_scenes},
};

/// Exports one object of a scene, and returns the manifest.
fn export(folder: &Path, scene: &str, form: &str, more: &[&str]) -> Value {
    let run =
        lcm_in(folder, &[&["export", scene, "--as", form, "-o", form, "--overwrite"], more].concat(), &[]);
    assert_eq!(run.status, Some(0), "{}", run.err);
    let text = fs::read_to_string(folder.join(form).join("manifest.json")).expect("a manifest");
    serde_json::from_str(&text).expect("JSON")
}

/// Runs a compiler from the package glslang-tools or spirv-tools, which scripts/test installs.
fn accepted(tool: &str, arguments: &[&str], folder: &Path) {
    let output = match Command::new(tool).args(arguments).current_dir(folder).output() {
        Ok(output) => output,
        Err(_) if !cfg!(target_os = "linux") => return skip(&format!("{tool} is not installed")),
        Err(error) => {
            panic!("{tool}: {error}; on Debian and Ubuntu: apt-get install glslang-tools spirv-tools")
        }
    };
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{tool} {arguments:?}: {said}");
}

fn other_compilers_accept(folder: &Path, scene: &str, more: &[&str]) {
    export(folder, scene, "glsl", more);
    accepted("glslangValidator", &["shader.vert", "shader.frag"], &folder.join("glsl"));
    export(folder, scene, "spirv", more);
    accepted("spirv-val", &["shader.spv"], &folder.join("spirv"));
    export(folder, scene, "hlsl", more);
    let out = folder.join("out.spv");
    let out = out.to_str().expect("Unicode");
    for (stage, entry) in [("vert", "vertex"), ("frag", "fragment")] {
        let arguments = ["-D", "-V", "-S", stage, "-e", entry, "-o", out, "shader.hlsl"];
        accepted("glslangValidator", &arguments, &folder.join("hlsl"));
    }
}

#[test]
fn other_compilers_accept_the_shaders_of_every_model() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scene = full_scene();
    scene["lights"].as_array_mut().expect("a list").push(json!(
        { "type": "photometric", "position": [8, 9, 6], "direction": [0, -1, 0], "intensity": 0.5 }
    ));
    let shadings = ["flat", "gouraud", "phong", "derivative"];
    let registry = lights_camera_models::registry::Registry::builtin();
    let models = registry.models().iter().filter(|model| model.file().is_none());
    let models = models.filter(|model| !model.passage(&Default::default()).solid);
    for (model, shading) in models.zip(shadings.iter().cycle()) {
        let mut scene = scene.clone();
        scene["reflection_model"] = model.declaration.id.into();
        scene["shading_model"] = (*shading).into();
        scene["objects"] = json!([{ "type": "cube", "position": [8, 5, 5] }]);
        fs::write(folder.path().join("scene.json"), scene.to_string()).expect("writable");
        other_compilers_accept(folder.path(), "scene.json", &[]);
    }
    // The wrong twin: a compiler reports an error.
    let broken =
        fs::read_to_string(folder.path().join("glsl/shader.frag")).expect("text").replace("vec3(", "vec5(");
    fs::write(folder.path().join("glsl/shader.frag"), broken).expect("writable");
    let found = std::panic::catch_unwind(|| {
        accepted("glslangValidator", &["shader.frag"], &folder.path().join("glsl"));
    });
    assert!(found.is_err() || !cfg!(target_os = "linux"));
}

#[test]
fn every_shipped_scene_can_be_exported_as_shaders_or_says_why_not() {
    let folder = tempfile::tempdir().expect("a folder");
    for scene in shipped_scenes() {
        let path = scene.to_str().expect("Unicode");
        for form in ["wgsl", "msl"] {
            let run = lcm_in(folder.path(), &["export", path, "--as", form, "-o", form, "--overwrite"], &[]);
            let reasons = ["display.tone_mapping", "glass follows the mesh of the object"];
            let refused = reasons.iter().any(|why| run.err.contains(why)) && run.status == Some(1);
            assert!(run.status == Some(0) || refused, "{path}: {}", run.err);
        }
    }
}

#[test]
fn the_manifest_has_the_numbers_of_the_scene_at_their_offsets() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.json"), full_scene().to_string()).expect("writable");
    let manifest = export(folder.path(), "scene.json", "wgsl", &["--object", "ball", "--size", "200x100"]);
    assert_eq!(manifest["object"], "ball");
    assert_eq!(manifest["reflection_model"], "blinn_phong");
    assert_eq!(manifest["shading_model"], "flat");
    let binding = |name: &str| {
        let all = manifest["bindings"].as_array().expect("a list");
        all.iter().find(|b| b["name"] == name).unwrap_or_else(|| panic!("{name} in {manifest:#}")).clone()
    };
    let field = |of: &str, name: &str| {
        let binding = binding(of);
        let all = binding["fields"].as_array().expect("a list");
        all.iter().find(|f| f["name"] == name).unwrap_or_else(|| panic!("{name} in {binding:#}")).clone()
    };
    assert_eq!(field("parameters", "alpha")["value"], 32.0);
    assert_eq!(field("illumination", "lights[0].position")["value"], json!([1.0, 2.0, 3.0]));
    assert_eq!(field("illumination", "lights[1].cone_angle")["value"], 20.0);
    let edge = field("illumination", "lights[1].outer_rise")["value"].as_f64().expect("a number");
    assert!((edge - (1.0 - 20_f64.to_radians().cos())).abs() < 1e-7, "{edge}");
    assert_eq!(field("illumination", "lights[0].light_type")["value"], 0);
    assert_eq!(field("view", "observer_position")["value"], json!([5.0, 5.0, 9.5]));
    let exposure = field("view", "exposure")["value"].as_f64().expect("a number");
    assert!((exposure - (-1.5f64).exp2()).abs() < 1e-6);
    // The offsets are those of the shader: vectors begin at multiples of 16, and the next number may fill the
    // gap.
    assert_eq!(field("view", "observer_position")["offset"], 64);
    assert_eq!(field("view", "exposure")["offset"], 76);
    // A vertex has as many attributes as the shader reads.
    let stride = manifest["vertices"]["stride"].as_u64().expect("a number");
    assert_eq!(stride, 6 * 12);
    let bytes = fs::metadata(folder.path().join("wgsl/vertices.bin")).expect("there").len();
    assert_eq!(bytes, stride * manifest["vertices"]["count"].as_u64().expect("a number"));
    let shader = fs::read_to_string(folder.path().join("wgsl/shader.wgsl")).expect("there");
    assert!(shader.contains("@location(5) face_centre") && shader.contains("fn tone_aces"), "{shader}");
    assert!(shader.contains("light.outer_rise") && !shader.contains("radians("), "{shader}");
}

#[test]
fn the_manifest_has_the_background_and_a_gradient_is_left_to_the_program() {
    let folder = tempfile::tempdir().expect("a folder");
    let exported = |display: Value| {
        let mut scene = full_scene();
        scene["display"] = display;
        fs::write(folder.path().join("scene.json"), scene.to_string()).expect("writable");
        let background = export(folder.path(), "scene.json", "wgsl", &[])["background"].clone();
        let arguments = ["export", "scene.json", "--as", "wgsl", "-o", "wgsl", "--overwrite"];
        let said = lcm_in(folder.path(), &arguments, &[]).err;
        (background, said.contains("The background is a gradient, and the shader of an object does not draw"))
    };
    assert_eq!(exported(json!({})), (json!([46, 46, 46]), false));
    // It is as it is picked, whatever the curve.
    let colour = json!({ "background": "colour", "background_colour": [200, 0, 30], "tone_mapping": "aces" });
    assert_eq!(exported(colour), (json!([200, 0, 30]), false));
    let gradient = json!({ "background": "gradient", "background_colour": [200, 0, 30] });
    let expected = json!({ "top": [200, 0, 30], "bottom": [184, 184, 184] });
    assert_eq!(exported(gradient), (expected, true));
}

#[test]
fn what_shaders_cannot_hold_is_refused_and_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scene = full_scene();
    scene["display"]["tone_mapping"] = "agx".into();
    fs::write(folder.path().join("scene.json"), scene.to_string()).expect("writable");
    let run = |arguments: &[&str]| {
        lcm_in(folder.path(), &[&["export", "scene.json", "-o", "out"], arguments].concat(), &[])
    };
    let refused = run(&["--as", "glsl"]);
    assert_eq!(refused.status, Some(1));
    assert_eq!(
        refused.err.trim_end(),
        "scene.json: cannot be exported as glsl: display.tone_mapping: agx is a table of colours, but a \
         stand-alone shader has only formulas; these can be exported: none, reinhard, reinhard_luminance, aces and khronos_pbr_neutral"
    );
    let unknown = run(&["--as", "glsl", "--object", "bal"]);
    assert_eq!(unknown.status, Some(1));
    assert!(
        unknown.err.contains(
            "there is no object \"bal\"; it must be a name, or an index from 0 to 3; did you mean \"ball\"?"
        ),
        "{}",
        unknown.err
    );
    scene["display"]["tone_mapping"] = "none".into();
    scene["objects"][1]["visible"] = false.into();
    fs::write(folder.path().join("scene.json"), scene.to_string()).expect("writable");
    scene["objects"][0]["reflection_model"] = "glass".into();
    scene["objects"][0]["material"] = json!({});
    fs::write(folder.path().join("scene.json"), scene.to_string()).expect("writable");
    for form in ["wgsl", "glsl", "hlsl", "msl", "spirv"] {
        let body = run(&["--as", form, "--object", "0"]);
        assert_eq!(body.status, Some(1));
        assert!(
            body.err.contains("glass follows the mesh of the object, which these shaders do not hold"),
            "{}",
            body.err
        );
    }
    let hidden = run(&["--as", "glsl", "--object", "1"]);
    assert_eq!(hidden.status, Some(1));
    assert!(hidden.err.contains("objects[1] is hidden"), "{}", hidden.err);
    assert_eq!(crate::helpers::support::names(folder.path()), ["scene.json"]);
}
