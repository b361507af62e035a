//! Exported Bevy projects: they are built with the libraries of this build, and draw the picture of `lcm
//! render`.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use lights_camera_models::{optics::tone::ToneMapping, render::camera::tonemapping};
use serde_json::json;

use crate::helpers::support::{lcm_in, root};

/// Every shading model, several models, a custom one, every light type, curves, tone mapping and exposure.
fn everything() -> String {
    let object = |i: u32, kind: &str, model: &str, shading: &str, material: serde_json::Value| {
        json!({
            "type": kind, "name": format!("{model} {shading}"), "size": 1.8, "rotation": [20, 30 * i, 10],
            "position": [2 + 2 * (i % 4), 3.5 + 3.0 * f64::from(i / 4), 5], "tessellation": 12,
            "reflection_model": model, "shading_model": shading, "material": material
        })
    };
    let gold = json!({ "alpha_x": 0.3, "alpha_y": 0.15, "fresnel": "schlick", "ior": [0.18, 0.42, 1.37],
        "base_colour": [80, 60, 10], "multiple_scattering": "kulla_conty" });
    format!(
        "{:#}",
        json!({
            "name": "Everything \"quoted\"\\", "description": "Every shading model.\nAnd a custom model.",
            "scene_size": { "height": 10, "width": 10, "depth": 10 },
            "reflection_model": "lambert", "shading_model": "gouraud",
            "lights": [
                { "type": "point", "name": "lamp", "position": [1, 9, 9], "colour": [255, 250, 240], "intensity": 20 },
                { "type": "spot", "position": [5, 9, 9], "direction": [0, -1, -1], "cone_angle": 30, "penumbra": 0.5,
                  "luminous_flux": 400, "colour_temperature": 2700 },
                { "type": "photometric", "position": [8, 9, 6], "direction": [0, -1, 0], "intensity": 0.5 },
                { "type": "directional", "direction": [0, -1, -1], "intensity": 0.5 },
                { "type": "ambient", "intensity": 0.1 },
                { "type": "point", "enabled": false, "position": [1, 1, 9], "intensity": 500 }
            ],
            "observer": { "position": [5, 5, 9.9], "direction": [0, 0, -1], "field_of_view": 60 },
            "objects": [
                object(0, "sphere", "lambert", "flat", json!({ "base_colour": [200, 40, 40] })),
                object(1, "torus", "blinn_phong", "gouraud", json!({ "k_a": 0.1, "alpha": 40 })),
                object(2, "teapot", "microfacet", "phong", gold),
                object(3, "cube", "oren_nayar", "derivative", json!({})),
                object(4, "superellipsoid", "gooch", "flat", json!({ "blue": 0.5 })),
                object(5, "sphere", "disney", "phong", json!({})),
                object(6, "sphere", "gooch", "phong", json!({})),
                { "type": "sphere", "visible": false, "position": [1, 1, 1], "reflection_model": "ward" }
            ],
            "display": { "tone_mapping": "aces", "exposure": 0.5 }
        })
    )
}

/// Seen from above, gamma-naive, with a table for tone mapping, and with a single light.
fn odd() -> String {
    format!(
        "{:#}",
        json!({
            "scene_size": { "height": 10, "width": 10, "depth": 10 },
            "reflection_model": "ward", "shading_model": "phong",
            "lights": [ { "type": "directional", "direction": [0.3, -1, -1], "intensity": 1 } ],
            "observer": { "position": [5, 9.5, 5], "direction": [0, -1, 0] },
            "objects": [ { "type": "torus", "position": [5, 5, 5], "size": 3, "material": { "base_colour": [120, 20, 200] } } ],
            "display": { "tone_mapping": "agx", "encoding": "off" }
        })
    )
}

/// A softbox, a tube and a dim studio, of which exported projects take 64 samples in each frame. They do not
/// draw the lamps themselves. Behind the objects is a gradient.
fn extent() -> String {
    let sphere = |x: f32, model: &str, shading: &str| json!({ "type": "sphere", "position": [x, 5, 5], "size": 3, "reflection_model": model, "shading_model": shading });
    format!(
        "{:#}",
        json!({
            "scene_size": { "height": 10, "width": 10, "depth": 10 },
            "reflection_model": "disney", "shading_model": "phong",
            "lights": [
                { "type": "rectangle", "position": [2, 8, 9], "direction": [1, -1, -1.2], "width": 2, "height": 1,
                  "intensity": 30, "visible": false },
                { "type": "cylinder", "position": [8, 8, 8], "direction": [0, 1, 1], "length": 3, "radius": 0.1,
                  "intensity": 60, "visible": false },
                { "type": "environment", "source": "studio", "intensity": 0.1, "visible": false }
            ],
            "observer": { "position": [5, 5, 9.9], "direction": [0, 0, -1], "field_of_view": 70 },
            "objects": [sphere(3.0, "disney", "phong"), sphere(7.0, "lambert", "gouraud")],
            "display": { "background": "gradient", "background_colour": [240, 200, 90], "background_bottom": [20, 60, 160] }
        })
    )
}

/// Solid bodies of a model, through which a studio and a lamp are seen: round and flat, coloured, and with dispersion.
fn bodies(model: &str) -> String {
    let object = |kind: &str, x: f32, shading: &str, material: serde_json::Value| {
        json!({ "type": kind, "position": [x, 5, 5], "rotation": [20, 30, 0], "size": 2.5, "shading_model": shading,
            "material": if model == "glass" { material } else { json!({}) } })
    };
    format!(
        "{:#}",
        json!({
            "scene_size": { "height": 10, "width": 10, "depth": 10 },
            "reflection_model": model, "shading_model": "phong",
            "lights": [
                { "type": "environment", "source": "studio", "visible": false },
                { "type": "rectangle", "position": [5, 9, 2], "direction": [0, -1, 1], "intensity": 10, "visible": false }
            ],
            "observer": { "position": [5, 5, 9.9], "direction": [0, 0, -1], "field_of_view": 50 },
            "objects": [
                object("sphere", 3.2, "phong", json!({ "transmittance_colour": [255, 200, 120] })),
                object("sphere", 5.2, "phong", json!({ "refractive_index": 1.2 })),
                object("cube", 7.2, "flat", json!({ "dispersion": 0.05 }))
            ]
        })
    )
}

/// The workspace folder in which exported projects are built, next to the libraries.
fn workspace() -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join("exported")
}

/// A package with the dependencies of this one, so that cargo builds the projects with the same features of
/// Bevy, which have already been built.
fn like_the_lab(folder: &Path) {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).expect("readable");
    let begin = manifest.find("[dependencies]").expect("dependencies");
    let end = manifest.find("[dev-dependencies]").expect("dev-dependencies");
    let package = "[package]\nname = \"like_the_lab\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n";
    fs::create_dir_all(folder.join("src")).expect("writable");
    fs::write(folder.join("Cargo.toml"), format!("{package}{}", &manifest[begin..end])).expect("writable");
    fs::write(folder.join("src/lib.rs"), "").expect("writable");
}

/// Builds projects in one workspace, and returns the folder of the programs.
fn build(names: &[&str]) -> PathBuf {
    let workspace = workspace();
    like_the_lab(&workspace.join("like_the_lab"));
    let members: Vec<_> = names.iter().chain(&["like_the_lab"]).map(|name| format!("\"{name}\"")).collect();
    let lab = fs::read_to_string(root().join("Cargo.toml")).expect("readable");
    let begin = lab.find("[profile.release]").expect("a profile");
    let profile = lab[begin..].split("\n\n").next().expect("its lines");
    let quick: String =
        names.iter().map(|name| format!("[profile.release.package.{name}]\nopt-level = 0\n")).collect();
    let manifest =
        format!("[workspace]\nresolver = \"3\"\nmembers = [{}]\n\n{profile}\n\n{quick}", members.join(", "));
    fs::write(workspace.join("Cargo.toml"), manifest).expect("writable");
    fs::copy(root().join("Cargo.lock"), workspace.join("Cargo.lock")).expect("writable");
    // The folder of the tests' temporary files is in the target folder.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("it has one");
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(["build", "--release", "--workspace", "--offline", "--target-dir"])
        .arg(target)
        .current_dir(&workspace)
        .output()
        .expect("cargo starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    assert!(!said.contains("Compiling bevy_render"), "Bevy was built once more:\n{said}");
    let unused: Vec<_> = said.lines().filter(|line| line.contains("warning: unused")).collect();
    assert!(unused.is_empty() && !said.contains("never used"), "{said}");
    target.join("release")
}

/// The pixels of a picture file.
fn pixels(file: &Path) -> Vec<u8> {
    let decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(file).expect("there")));
    let mut reader = decoder.read_info().expect("a PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("small")];
    let info = reader.next_frame(&mut bytes).expect("whole");
    assert_eq!(info.color_type, png::ColorType::Rgb);
    bytes.truncate(info.buffer_size());
    bytes
}

/// The largest difference of two pictures in codes.
fn difference(a: &[u8], b: &[u8]) -> u8 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0)
}

/// The fraction of bytes in two pictures that differ by more than two codes.
fn share_of_others(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let others = a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 2).count();
    others as f64 / a.len() as f64
}

#[test]
fn exported_projects_compile_without_warnings_and_draw_the_picture_of_the_lab() {
    let workspace = workspace();
    // Nothing remains from the export of another version.
    let _ = fs::remove_dir_all(&workspace);
    fs::create_dir_all(&workspace).expect("writable");
    let names = ["exported_default", "exported_everything", "exported_odd", "exported_models"];
    // More models at once than the maximum number of a system's parameters in Bevy.
    let matrix = fs::read_to_string(root().join("scenes/model_matrix.json")).expect("readable");
    let mut matrix: serde_json::Value = serde_json::from_str(&matrix).expect("JSON");
    matrix["objects"].as_array_mut().expect("a list").truncate(18);
    fs::write(workspace.join("exported_models.json"), matrix.to_string()).expect("writable");
    fs::write(workspace.join("exported_everything.json"), everything()).expect("writable");
    fs::write(workspace.join("exported_odd.json"), odd()).expect("writable");
    fs::write(workspace.join("exported_extent.json"), extent()).expect("writable");
    fs::write(workspace.join("exported_bodies.json"), bodies("glass")).expect("writable");
    fs::write(workspace.join("thin.json"), bodies("thin_glass")).expect("writable");
    let made = lcm_in(&workspace, &["new", "exported_default.json"], &[]);
    assert_eq!(made.status, Some(0), "{}", made.err);
    let assets = root().join("assets");
    let assets = assets.to_str().expect("Unicode");
    let with = ["--assets", assets, "--size", "320x180"];
    for name in names {
        let scene = format!("{name}.json");
        let run =
            lcm_in(&workspace, &[&["export", &scene, "--as", "bevy", "-o", name][..], &with].concat(), &[]);
        assert_eq!((run.status, run.out.as_str()), (Some(0), ""), "{}", run.err);
        let picture = format!("{name}.png");
        let render = ["render", &scene, "--renderer", "gpu", "-o", &picture];
        let run = lcm_in(&workspace, &[&render[..], &with].concat(), &[]);
        assert_eq!(run.status, Some(0), "{}", run.err);
    }
    // The CPU renderer takes as many samples as the exported project. Through a body much lies within a pixel, and the project
    // looks at its middle.
    const EXTENT: [&str; 2] = ["exported_extent", "exported_bodies"];
    for (name, samples) in [(EXTENT[0], "4"), (EXTENT[1], "1"), ("thin", "1")] {
        let scene = format!("{name}.json");
        if name != "thin" {
            let export = ["export", &scene, "--as", "bevy", "-o", name];
            let run = lcm_in(&workspace, &[&export[..], &with].concat(), &[]);
            assert_eq!((run.status, run.out.as_str()), (Some(0), ""), "{}", run.err);
        }
        let picture = format!("{name}.png");
        let render = ["render", &scene, "--renderer", "cpu", "--light-samples", "64", "--samples", samples];
        let run = lcm_in(&workspace, &[&render[..], &["-o", &picture], &with].concat(), &[]);
        assert_eq!(run.status, Some(0), "{}", run.err);
    }
    let names = [&names[..], &EXTENT].concat();
    let programs = build(&names);
    let mut pictures: Vec<Vec<u8>> = Vec::new();
    for name in names {
        let file = workspace.join(format!("{name}_own.png"));
        let output = Command::new(programs.join(name))
            .arg("--capture")
            .arg(&file)
            .env("CARGO_MANIFEST_DIR", workspace.join(name))
            .output()
            .expect("it starts");
        let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && !said.contains("ERROR"), "{name}: {said}");
        let own = pixels(&file);
        let lab = pixels(&workspace.join(format!("{name}.png")));
        if EXTENT.contains(&name) {
            // The CPU renderer smooths edges differently, or does not.
            let others = share_of_others(&own, &lab);
            assert!(others < if name == EXTENT[0] { 0.005 } else { 0.015 }, "{name}: {others}");
            let wrong =
                if name == EXTENT[0] { pictures[2].clone() } else { pixels(&workspace.join("thin.png")) };
            let others = share_of_others(&own, &wrong);
            assert!(others > if name == EXTENT[0] { 0.2 } else { 0.04 }, "{name}, the wrong twin: {others}");
        } else {
            assert!(difference(&own, &lab) <= 1, "{name}: {}", difference(&own, &lab));
        }
        pictures.push(own);
    }
    // The wrong twin: another scene's picture.
    assert!(difference(&pictures[0], &pictures[1]) > 50);
    let usage = Command::new(programs.join("exported_default")).arg("--picture").output().expect("it starts");
    assert_eq!(usage.status.code(), Some(2));
}

#[test]
fn exported_projects_have_the_background_of_the_scene() {
    let folder = tempfile::tempdir().expect("a folder");
    let assets = root().join("assets");
    let exported = |display: serde_json::Value| {
        let mut scene: serde_json::Value = serde_json::from_str(&everything()).expect("JSON");
        scene["display"] = display;
        fs::write(folder.path().join("scene.json"), scene.to_string()).expect("writable");
        let arguments = ["export", "scene.json", "--as", "bevy", "-o", "project", "--overwrite", "--assets"];
        let arguments = [&arguments[..], &[assets.to_str().expect("Unicode")]].concat();
        let run = lcm_in(folder.path(), &arguments, &[]);
        assert_eq!(run.status, Some(0), "{}", run.err);
        let file = folder.path().join("project/src/main.rs");
        let formatted = Command::new("rustfmt").args(["--edition", "2024", "--check"]).arg(&file).output();
        let formatted = formatted.expect("rustfmt is part of Rust");
        assert!(formatted.status.success(), "{}", String::from_utf8_lossy(&formatted.stdout));
        (fs::read_to_string(file).expect("text"), run.err)
    };
    let (grey, said) = exported(json!({}));
    assert!(!grey.contains("Bodies"), "{grey}");
    assert!(grey.contains("const BACKGROUND: Color = Color::srgb_u8(46, 46, 46);"), "{grey}");
    assert!(!grey.contains("BACKGROUND_BELOW") && !said.contains("background"), "{said}");
    let (colour, said) = exported(json!({ "background": "colour", "background_colour": [1, 2, 3] }));
    assert!(colour.contains("const BACKGROUND: Color = Color::srgb_u8(1, 2, 3);"), "{colour}");
    assert!(!colour.contains("BACKGROUND_BELOW") && !said.contains("background"), "{said}");
    let (gradient, said) = exported(json!({ "background": "gradient", "tone_mapping": "aces" }));
    assert!(
        gradient.contains("const BACKGROUND_BELOW: Color = Color::srgb_u8(184, 184, 184);"),
        "{gradient}"
    );
    assert!(said.contains("Bevy maps the background as well: with the tone mapping aces"), "{said}");
    // They are called as Bevy calls them.
    for tone in ToneMapping::ALL {
        let (text, _) = exported(json!({ "tone_mapping": tone.id() }));
        let expected = format!("Tonemapping::{:?},", tonemapping(tone));
        assert!(text.contains(&expected), "{expected}");
    }
}

#[test]
fn exported_projects_are_formatted_and_hold_nothing_of_the_lab() {
    for (scene, shaders) in [(everything(), 7), (bodies("glass"), 2)] {
        is_formatted_and_holds_nothing_of_the_lab(&scene, shaders);
    }
}

fn is_formatted_and_holds_nothing_of_the_lab(scene: &str, expected: usize) {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("scene.json"), scene).expect("writable");
    let assets = root().join("assets");
    let arguments = ["export", "scene.json", "--as", "bevy", "-o", "project", "--assets"];
    let arguments = [&arguments[..], &[assets.to_str().expect("Unicode")]].concat();
    let run = lcm_in(folder.path(), &arguments, &[]);
    assert_eq!(run.status, Some(0), "{}", run.err);
    let project = folder.path().join("project");
    let formatted = Command::new("rustfmt")
        .args(["--edition", "2024", "--check"])
        .arg(project.join("src/main.rs"))
        .output()
        .expect("rustfmt is part of Rust");
    assert!(formatted.status.success(), "{}", String::from_utf8_lossy(&formatted.stdout));
    // Nobody has to install system packages before the first build.
    let manifest = fs::read_to_string(project.join("Cargo.toml")).expect("text");
    for feature in ["wayland", "bevy_audio", "bevy_gilrs"] {
        assert!(!manifest.contains(feature), "{feature}");
    }
    let mut shaders: Vec<_> = fs::read_dir(project.join("assets/shaders"))
        .expect("there")
        .map(|e| e.expect("readable").path())
        .collect();
    shaders.sort();
    assert_eq!(shaders.len(), expected);
    for file in shaders.iter().map(PathBuf::as_path).chain([&*project.join("src/main.rs")]) {
        let text = fs::read_to_string(file).expect("text");
        for trace in
            ["lights_camera_models", "parameter_table", "select_terms", "src/", "#ifdef", "/* lcm", "(CA "]
        {
            assert!(!text.contains(trace), "{trace} in {}", file.display());
        }
    }
}
