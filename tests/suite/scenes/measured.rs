//! Measured surfaces: files named in materials, from disk to both renderers, and models matched with them.

use std::{
    fs,
    path::{Path, PathBuf},
};

use glam::Vec3;
use lights_camera_models::{
    matching::{Match, Request, What, each::match_each, match_view, parameters},
    optics::{
        Frame, TermSelection,
        colour::{BACKGROUND, Encoding},
    },
    parameter::{NamedFile, Value, Values},
    progress::Progress,
    reference,
    reflection::{brdf, merl, rgl, samples},
    registry::Registry,
    render::capture::gpu::{GpuRenderer, Output},
    scene::{
        Scene, Variant,
        load::{self, Defaults},
        save,
    },
};

use crate::{
    helpers::pictures::{close_up, compare, on_gpu},
    helpers::support::lcm_in,
};

/// Directions to light and viewer in the local frame for half angle, difference angle and azimuth in radians.
fn directions([theta_h, theta_d, phi_d]: [f64; 3]) -> (Vec3, Vec3) {
    use glam::DVec3;
    let h = DVec3::new(theta_h.sin(), 0.0, theta_h.cos());
    let down = DVec3::new(theta_h.cos(), 0.0, -theta_h.sin());
    let l = theta_d.cos() * h + theta_d.sin() * (phi_d.cos() * down + phi_d.sin() * DVec3::Y);
    (l.as_vec3(), (2.0 * l.dot(h) * h - l).as_vec3())
}

/// Writes a file of the MERL database from a model of the registry.
fn write(path: &Path, model: &str, values: &Values) {
    let registry = Registry::builtin();
    let surface = registry.model(model).expect("built in").instantiate(values, Encoding::Srgb);
    let [n_h, n_d, n_phi] = merl::COUNTS;
    let middle = |i: usize, count: usize| (i as f64 + 0.5) / count as f64;
    let half_turn = std::f64::consts::PI;
    let mut all = [const { Vec::new() }; 3];
    for i in 0..n_h * n_d * n_phi {
        let (h, d, phi) = (i / (n_d * n_phi), i / n_phi % n_d, i % n_phi);
        let theta_h = 0.5 * half_turn * middle(h, n_h).powi(2);
        let (l, v) = directions([theta_h, 0.5 * half_turn * middle(d, n_d), half_turn * middle(phi, n_phi)]);
        let above = l.z > 0.0 && v.z > 0.0;
        let f = if above { brdf(&*surface, l, v, &Frame::LOCAL) } else { Vec3::NEG_ONE };
        for (k, values) in all.iter_mut().enumerate() {
            values.extend((f64::from(f[k]) / merl::SCALES[k]).to_le_bytes());
        }
    }
    let mut bytes: Vec<u8> = merl::COUNTS.iter().flat_map(|count| (*count as i32).to_le_bytes()).collect();
    all.iter().for_each(|values| bytes.extend(values));
    fs::write(path, bytes).expect("written");
}

/// A rough metal without a base.
fn metal(alpha: f32) -> Values {
    let text = |id: &'static str| Value::Choice(id.into());
    Values(
        [
            ("alpha_x".into(), Value::Number(alpha)),
            ("alpha_y".into(), Value::Number(alpha)),
            ("fresnel".into(), text("conductor")),
            ("ior".into(), Value::Triple([0.2, 0.9, 1.1])),
            ("extinction".into(), Value::Triple([3.9, 2.5, 2.4])),
            ("diffuse".into(), text("none")),
        ]
        .into(),
    )
}

/// A scene with a measured sphere, as the text of a scene file.
fn text(file: &str) -> String {
    let mut scene = close_up("sphere", "directional");
    scene.reflection_model = "measured_merl".to_owned();
    scene.shading_model = "phong".to_owned();
    let mut text: serde_json::Value =
        serde_json::from_str(&save::to_json(&scene, None, &Registry::builtin())).expect("JSON");
    text["objects"][0]["material"]["merl_file"] = file.into();
    text.to_string()
}

/// Writes a scene that names a file into a folder, and reads it.
fn read(folder: &Path, file: &str) -> Result<Scene, String> {
    let path = folder.join("room.json");
    fs::write(&path, text(file)).expect("written");
    let loaded = load::file(&path, &Registry::builtin(), Defaults::Refuse);
    loaded.map(|loaded| loaded.scene).map_err(|error| error.to_string())
}

fn file_of(scene: &Scene) -> &NamedFile {
    match scene.objects[0].material.0.get("merl_file") {
        Some(Value::File(file)) => file,
        other => panic!("{other:?}"),
    }
}

fn cpu(scene: &Scene) -> reference::Picture {
    let settings = reference::Settings { width: 96, height: 96, samples: 1, terms: TermSelection::All };
    reference::render(scene, &Registry::builtin(), &settings)
}

fn place(folder: &tempfile::TempDir, name: &str) -> PathBuf {
    folder.path().join(name)
}

#[test]
fn both_renderers_show_the_file_and_follow_it() {
    let folder = tempfile::tempdir().expect("a folder");
    write(&place(&folder, "metal.binary"), "microfacet", &metal(0.3));
    let scene = read(folder.path(), "metal.binary").expect("legal");
    let mut renderer = GpuRenderer::new(96, 96, 1, Output::Linear).expect("software Vulkan is installed");
    let alike = |gpu: &[Vec3], scene: &Scene, tolerance: f32| {
        let d = compare(gpu, &cpu(scene), Encoding::Srgb.decode(BACKGROUND), tolerance);
        d.covered > 500 && d.wrong * 1000 <= d.covered && d.edges * 50 <= d.covered
    };
    let before = on_gpu(&mut renderer, &scene);
    assert!(alike(&before, &scene, 1e-3));
    // As its original, but for the rim, where the table ends.
    let mut original = scene.clone();
    original.reflection_model = "microfacet".to_owned();
    original.objects[0].material = metal(0.3);
    let d = compare(&before, &cpu(&original), Encoding::Srgb.decode(BACKGROUND), 0.02);
    assert!(d.covered > 500 && (d.wrong + d.edges) * 20 <= d.covered, "{d:?}");
    // Objects of one file share its numbers; the shipped table is another.
    let mut two = scene.clone();
    two.objects.push(two.objects[0].clone());
    two.objects[1].position += Vec3::new(0.5, 0.5, 0.0);
    let numbers = [0, 1].map(|i| match &two.objects[i].material.0["merl_file"] {
        Value::File(file) => file.numbers().expect("read"),
        other => panic!("{other:?}"),
    });
    assert!(std::sync::Arc::ptr_eq(&numbers[0], &numbers[1]));
    // At most 30 MB with the copy on the GPU.
    assert!(8 * numbers[0].len() < 30_000_000, "{}", numbers[0].len());
    two.objects[1].material.0.remove("merl_file");
    let d = compare(&on_gpu(&mut renderer, &two), &cpu(&two), Encoding::Srgb.decode(BACKGROUND), 1e-3);
    assert!(d.covered > 500 && d.wrong * 1000 <= d.covered, "{d:?}");
    // The file changes: reading it again detects that, and so do both renderers.
    write(&place(&folder, "metal.binary"), "lambert", &Values::default());
    assert!(file_of(&scene).read_again());
    assert!(!alike(&before, &scene, 1e-3), "the new file goes unnoticed");
    assert!(alike(&on_gpu(&mut renderer, &scene), &scene, 1e-3));
}

#[test]
fn a_model_matched_with_a_file_written_from_it_finds_its_parameters_again() {
    let folder = tempfile::tempdir().expect("a folder");
    write(&place(&folder, "metal.binary"), "microfacet", &metal(0.25));
    let mut scene = read(folder.path(), "metal.binary").expect("legal");
    let mut variant = Variant { reflection_model: Some("microfacet".to_owned()), ..Variant::default() };
    variant.material = metal(0.6);
    scene.variants = vec![variant];
    let request =
        Request { scene: &scene, view: 1, measure: What::Lobe.into(), parameters: &["alpha_x", "alpha_y"] };
    let found = match_view(&request, &Registry::builtin(), &Progress::NONE).expect("a match");
    assert_eq!(found.values.len(), 2, "both were far off: {found:?}");
    for (name, value) in &found.values {
        assert!((value.numbers()[0] / 0.25 - 1.0).abs() < 0.01, "{name}: {found:?}");
    }
    assert!(found.after < 0.1 * found.before, "{found:?}");
}

/// What a model with all its numbers and colours free finds in a file written from itself. Choices are given.
fn fitted_back(model: &str, written: &[(&'static str, Value)]) -> Match {
    let folder = tempfile::tempdir().expect("a folder");
    let (mut all, mut chosen) = (Values::default(), Values::default());
    for (name, value) in written {
        all.set(*name, value.clone());
        if matches!(value, Value::Choice(_)) {
            chosen.set(*name, value.clone());
        }
    }
    write(&place(&folder, "own.binary"), model, &all);
    let mut scene = read(folder.path(), "own.binary").expect("legal");
    let variant =
        Variant { reflection_model: Some(model.to_owned()), material: chosen, ..Variant::default() };
    scene.variants = vec![variant];
    let registry = Registry::builtin();
    let free: Vec<_> = parameters(&scene, 1, &registry).into_iter().map(|(p, _)| p.name).collect();
    let request = Request { scene: &scene, view: 1, measure: What::Lobe.into(), parameters: &free };
    match_view(&request, &registry, &Progress::NONE).expect("a match")
}

/// The numbers that a match found for a parameter; the default if it kept it.
fn numbers(found: &Match, model: &str, name: &str) -> [f64; 3] {
    let value = found.values.iter().find(|(known, _)| *known == name).map(|(_, value)| value.clone());
    let registry = Registry::builtin();
    let parameter = registry.model(model).and_then(|model| model.parameter(name)).expect("declared");
    value.unwrap_or_else(|| parameter.default_value()).numbers()
}

/// The five models of docs/measured.md.
#[test]
fn five_models_come_back_from_their_files_with_their_parameters_within_a_hundredth() {
    let text = |id: &'static str| Value::Choice(id.into());
    let number = Value::Number;
    let colour = Value::Colour;
    let models: [(&str, &[(&'static str, Value)]); 5] = [
        ("oren_nayar", &[("base_colour", colour([200, 110, 70])), ("sigma", number(25.0))]),
        ("minnaert", &[("base_colour", colour([150, 140, 90])), ("limb_darkening", number(1.3))]),
        (
            "cook_torrance",
            &[
                ("base_colour", colour([150, 140, 90])),
                ("ior", Value::Triple([1.6; 3])),
                ("extinction", Value::Triple([0.0; 3])),
                ("slope", number(0.2)),
                ("specular_weight", number(0.35)),
            ],
        ),
        (
            "metallic_roughness",
            &[
                ("base_colour", colour([200, 150, 80])),
                ("metallic", number(0.3)),
                ("roughness", number(0.4)),
                ("reflectance", number(0.6)),
            ],
        ),
        (
            "microfacet",
            &[
                ("fresnel", text("conductor")),
                ("diffuse", text("none")),
                ("ior", Value::Triple([2.9, 2.8, 2.6])),
                ("extinction", Value::Triple([3.1, 2.9, 2.8])),
                ("alpha_x", number(0.2)),
                ("alpha_y", number(0.2)),
            ],
        ),
    ];
    for (model, written) in models {
        let found = fitted_back(model, written);
        for (name, value) in written.iter().filter(|(_, value)| !matches!(value, Value::Choice(_))) {
            for (wanted, own) in value.numbers().into_iter().zip(numbers(&found, model, name)) {
                // A small extinction reflects by its square.
                let slack = if wanted == 0.0 { 0.05 } else { 0.01 * wanted };
                assert!((own - wanted).abs() <= slack, "{model} {name}: {wanted} {own} {found:?}");
            }
        }
        assert!(found.after < 0.003 * found.before, "{model}: {found:?}");
        assert!(model == "cook_torrance" || found.ambiguous.is_empty(), "{model}: {found:?}");
    }
}

/// Where nearly all light is reflected, index and extinction do nearly the same, and every error of the file counts.
#[test]
fn index_and_extinction_of_a_bright_metal_come_back_within_three_hundredths() {
    let text = |id: &'static str| Value::Choice(id.into());
    let written = [
        ("fresnel", text("conductor")),
        ("diffuse", text("none")),
        ("ior", Value::Triple([0.27, 0.68, 1.32])),
        ("extinction", Value::Triple([3.6, 2.6, 2.3])),
        ("alpha_x", Value::Number(0.2)),
        ("alpha_y", Value::Number(0.2)),
    ];
    let found = fitted_back("microfacet", &written);
    for (name, value) in &written[2..] {
        let pairs = value.numbers().into_iter().zip(numbers(&found, "microfacet", name));
        // Between the entries of the table it would be 6 %.
        let is_near = |(wanted, own): (f64, f64)| (own - wanted).abs() <= 0.03 * wanted;
        assert!(pairs.clone().all(is_near), "{name}: {found:?}");
    }
}

#[test]
fn what_a_file_tells_only_together_comes_back_together_and_is_said() {
    const MODEL: &str = "blinn_phong_normalised";
    let written = [
        ("base_colour", Value::Colour([90, 110, 160])),
        ("specular_colour", Value::Colour([230, 220, 200])),
        ("k_s", Value::Number(0.3)),
        ("alpha", Value::Integer(60)),
    ];
    let found = fitted_back(MODEL, &written);
    let mut ambiguous = found.ambiguous.clone();
    ambiguous.sort_unstable();
    assert_eq!(ambiguous, ["k_s", "specular_colour"], "{found:?}");
    let note = found.ambiguity(|name| name).expect("it is said");
    assert!(note.contains("k_s") && note.ends_with(", changed together, come as near"), "{note}");
    let own = |name: &str| numbers(&found, MODEL, name);
    assert!((own("alpha")[0] - 60.0).abs() <= 1.0, "{found:?}");
    // The product is determined, and the body, as far as the steps of a colour go.
    let decoded = |colour: [f64; 3]| Encoding::Srgb.decode(colour.map(|code| code as u8));
    let product = own("k_s")[0] as f32 * decoded(own("specular_colour"));
    let expected = 0.3 * Encoding::Srgb.decode([230, 220, 200]);
    assert!((product / expected - 1.0).abs().max_element() < 0.01, "{product} {expected} {found:?}");
    let body = own("base_colour").into_iter().zip([90.0, 110.0, 160.0]);
    assert!(body.into_iter().all(|(own, wanted)| (own - wanted).abs() <= 2.0), "{found:?}");
}

#[test]
fn of_several_models_the_one_that_wrote_the_file_comes_nearest() {
    let folder = tempfile::tempdir().expect("a folder");
    write(&place(&folder, "metal.binary"), "ward", &Values([("k_s".into(), Value::Number(0.4))].into()));
    let scene = read(folder.path(), "metal.binary").expect("legal");
    let registry = Registry::builtin();
    let models = ["lambert", "ward", "phong"].map(|id| registry.model(id).expect("built in"));
    let ranking = match_each(&scene, models, What::Lobe.into(), &registry, &Progress::NONE);
    let order: Vec<_> = ranking.matched.iter().map(|matched| matched.model).collect();
    assert_eq!(order, ["ward", "phong", "lambert"], "{ranking:?}");
    let after = |i: usize| ranking.matched[i].found.after;
    assert!(after(0) < 0.01 && after(0) < 0.5 * after(1) && after(1) < after(2), "{ranking:?}");
    assert!(ranking.left_out.is_empty());
    let shown = |matched: &[&str]| {
        let arguments = [&["match", "room.json"], matched].concat();
        lcm_in(folder.path(), &arguments, b"")
    };
    let refused = shown(&["--each", "--free", "alpha"]);
    assert_eq!(refused.status, Some(2), "{}", refused.err);
}

#[test]
fn files_that_cannot_be_used_are_told_with_the_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(place(&folder, "short.binary"), [90u8, 0, 0, 0]).expect("written");
    let error = read(folder.path(), "short.binary").expect_err("it cannot be used");
    let about = "merl_file is \"short.binary\", but the measurement must be the name of a file of the MERL BRDF database";
    assert!(error.contains(about) && error.contains("it has 4 bytes"), "{error}");
    let file = fs::File::create(place(&folder, "huge.binary")).expect("created");
    file.set_len(1 << 30).expect("a hole takes no space");
    let error = read(folder.path(), "huge.binary").expect_err("too large");
    assert!(error.contains("huge.binary: "), "{error}");
    let inner = place(&folder, "inner");
    fs::create_dir(&inner).expect("created");
    let error = read(&inner, "../short.binary").expect_err("outside");
    assert!(error.contains("--allow-outside"), "{error}");
}

#[test]
fn exports_that_cannot_hold_a_table_refuse_it_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(place(&folder, "room.json"), text("calculated.binary")).expect("written");
    for (form, out) in [("html", "out.html"), ("bevy", "out"), ("wgsl", "out"), ("mitsuba", "out")] {
        let run = lcm_in(folder.path(), &["export", "room.json", "--as", form, "-o", out], b"");
        // Mitsuba's form says the id, which the scene has.
        let name = if form == "mitsuba" { "measured_merl" } else { "Measured (MERL)" };
        assert!(run.status == Some(1) && run.err.contains(name), "{form}: {}", run.err);
        assert!(!place(&folder, out).exists());
    }
    let run = lcm_in(folder.path(), &["models", "duplicate", "measured_table", "--models", "models"], b"");
    assert!(run.status == Some(2) && run.err.contains("measured_table reads a file"), "{}", run.err);
}

#[test]
fn samples_in_a_table_are_shown_by_both_renderers() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut rows = "theta_i,phi_i,theta_o,phi_o,r,g,b,sigma\n".to_owned();
    for i in 0..8 {
        for j in 0..8 {
            for k in 0..7 {
                rows += &format!("{},0,{},{},0.25,0.1,0.02,0.01\n", 10 * i, 10 * j, 30 * k);
            }
        }
    }
    fs::write(place(&folder, "paint.csv"), &rows).expect("written");
    let mut scene = close_up("sphere", "directional");
    scene.reflection_model = "measured_table".to_owned();
    scene.shading_model = "phong".to_owned();
    let file = NamedFile::named("paint.csv", folder.path(), &samples::FORMAT);
    assert_eq!(file.problem(), None);
    scene.objects[0].material.set("table_file", Value::File(file));
    let mut renderer = GpuRenderer::new(96, 96, 1, Output::Linear).expect("software Vulkan is installed");
    let shown = on_gpu(&mut renderer, &scene);
    let d = compare(&shown, &cpu(&scene), Encoding::Srgb.decode(BACKGROUND), 1e-3);
    assert!(d.covered > 500 && d.wrong * 1000 <= d.covered, "{d:?}");
    // Constant, it is matte: π times the value.
    let registry = Registry::builtin();
    let surface = registry.model("measured_table").expect("built in");
    let surface = surface.instantiate(&scene.objects[0].material, Encoding::Srgb);
    let f = brdf(&*surface, Vec3::new(0.6, 0.0, 0.8), Vec3::new(0.0, 0.28, 0.96), &Frame::LOCAL);
    assert!((f / Vec3::new(0.25, 0.1, 0.02) - 1.0).abs().max_element() < 1.1e-3, "{f}");
    assert_eq!(surface.readouts().len(), 1, "the uncertainty");
    let plain = registry.model("measured_table").expect("built in");
    assert!(plain.instantiate(&Values::default(), Encoding::Srgb).readouts().is_empty());
}

#[test]
fn tables_of_a_file_are_calculated_on_the_command_line() {
    let folder = tempfile::tempdir().expect("a folder");
    write(&place(&folder, "paper.binary"), "lambert", &Values::default());
    let set = ["--set", "merl_file=paper.binary"];
    let arguments = ["albedo", "measured_merl", set[0], set[1]];
    let run = lcm_in(folder.path(), &arguments, b"mu\n1\n0.5\n0.2\n");
    assert_eq!(run.status, Some(0), "{}", run.err);
    // White paper reflects everything, but for 16 bits and the quadrature.
    let numbers = run.out.lines().filter_map(|line| line.rsplit(',').next()?.parse::<f64>().ok());
    let albedos: Vec<_> = numbers.collect();
    // A file may be anywhere if it is typed, and must be legal.
    let inner = place(&folder, "inner");
    fs::create_dir(&inner).expect("created");
    let typed = |path: &str| {
        lcm_in(&inner, &["albedo", "measured_merl", "--set", &format!("merl_file={path}")], b"mu\n1\n")
    };
    assert_eq!(typed("../paper.binary").status, Some(0));
    let refused = typed("../lost.binary");
    assert!(refused.status == Some(2) && refused.err.contains("lost.binary: "), "{}", refused.err);
    assert!(albedos.len() == 3 && albedos.iter().all(|albedo| (albedo - 1.0).abs() < 2e-3), "{}", run.out);
}

#[test]
fn measurements_in_a_plot_are_told_apart_by_their_files() {
    let folder = tempfile::tempdir().expect("a folder");
    let inner = place(&folder, "inner");
    fs::create_dir(&inner).expect("created");
    for (name, model) in [("paper.binary", "lambert"), ("inner/gloss.binary", "ward")] {
        write(&place(&folder, name), model, &Values::default());
    }
    let of = |file: &str| format!("measured_merl:merl_file={file}");
    let run =
        lcm_in(folder.path(), &["plot", &of("paper.binary"), &of("inner/gloss.binary"), "-o", "p.csv"], b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
    let csv = fs::read_to_string(place(&folder, "p.csv")).expect("written");
    for name in ["Measured (MERL), paper.binary", "Measured (MERL), gloss.binary"] {
        assert!(csv.contains(name), "{}", &csv[..csv.len().min(400)]);
    }
}

#[test]
fn beside_a_measurement_the_colours_of_the_model_are_free_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let colour = |rgb: [u8; 3]| Values([("base_colour".into(), Value::Colour(rgb))].into());
    write(&place(&folder, "paint.binary"), "lambert", &colour([200, 120, 40]));
    let mut scene = read(folder.path(), "paint.binary").expect("legal");
    scene.variants = vec![Variant { reflection_model: Some("lambert".to_owned()), ..Variant::default() }];
    let text = save::to_json(&scene, None, &Registry::builtin());
    fs::write(place(&folder, "room.json"), text).expect("writable");
    let run = lcm_in(folder.path(), &["match", "room.json", "--json"], b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
    let found: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    let rgb = found["values"]["base_colour"].as_array().expect("it was searched").clone();
    let near = rgb.iter().zip([200.0, 120.0, 40.0]).all(|(a, b)| (a.as_f64().unwrap_or(0.0) - b).abs() < 3.0);
    assert!(rgb.len() == 3 && near, "{found}");
}

#[test]
fn a_brushed_measurement_is_shown_by_both_renderers_and_evaluated() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene_of = |name: &str, along: f32, across: f32| {
        crate::helpers::tensor::write(&place(&folder, name), along, across);
        let mut scene = close_up("sphere", "directional");
        (scene.reflection_model, scene.shading_model) = ("measured_rgl".to_owned(), "phong".to_owned());
        let file = NamedFile::named(name, folder.path(), &rgl::FORMAT);
        assert_eq!(file.problem(), None);
        scene.objects[0].material.set("rgl_file", Value::File(file));
        scene
    };
    let (scene, turned) = (scene_of("brushed.bsdf", 0.4, 0.2), scene_of("turned.bsdf", 0.2, 0.4));
    let mut renderer = GpuRenderer::new(96, 96, 1, Output::Linear).expect("software Vulkan is installed");
    let picture = on_gpu(&mut renderer, &scene);
    let d = compare(&picture, &cpu(&scene), Encoding::Srgb.decode(BACKGROUND), 1e-3);
    assert!(d.covered > 500 && d.wrong * 1000 <= d.covered && d.edges * 50 <= d.covered, "{d:?}");
    // The wrong twin: brushed the other way.
    let d = compare(&picture, &cpu(&turned), Encoding::Srgb.decode(BACKGROUND), 1e-3);
    assert!(d.wrong * 4 > d.covered, "{d:?}");
    // The laws depend on the file, and the report says so.
    let run =
        lcm_in(folder.path(), &["models", "check", "measured_rgl", "--set", "rgl_file=brushed.bsdf"], b"");
    let verdict = run.out.lines().find(|line| line.starts_with("energy conserving: "));
    assert!(verdict.is_some_and(|line| line.contains("depends on the file")), "{} {}", run.out, run.err);
    assert!(!run.out.contains("claim it?"), "{}", run.out);
}
