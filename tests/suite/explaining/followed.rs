//! Equations that can be followed by hand: every line of an explanation yields its own value.

use std::fs;

use lights_camera_models::{
    custom,
    explain::{self, Explainer, agrees, reading},
    reference::Settings,
    reflection::{Declaration, EquationPart, ModelEntry, Quantity, Term},
    registry::Registry,
    scene::{Light, Scene},
    testing::{equations, random, random_values},
};

use crate::helpers::support::{lcm_in, root};

#[test]
fn every_line_of_every_model_gives_its_own_value() {
    let registry = Registry::builtin();
    let wrong =
        |model: &ModelEntry| Some(format!("{}: {}", model.declaration.id, equations::followed(model).err()?));
    let failures: Vec<_> = registry.models().iter().filter_map(wrong).collect();
    assert!(failures.is_empty(), "{}", failures.join("\n\n"));
}

#[test]
fn shipped_custom_models_can_be_followed_too() {
    let registry = Registry::builtin();
    for id in ["gooch", "charlie_sheen"] {
        let file = root().join(format!("assets/models/{id}.wgsl"));
        let text = fs::read_to_string(&file).expect("shipped");
        let model = custom::read(&file, &text, &registry).unwrap_or_else(|what| panic!("{what:?}"));
        assert_eq!(equations::followed(&model.entry).err().unwrap_or_default(), "", "{id}");
    }
}

/// A built-in model with another declaration.
fn twin(id: &str, change: impl FnOnce(Declaration) -> Declaration) -> Result<(), String> {
    let mut entry = Registry::builtin().model(id).expect("built in").clone();
    entry.declaration = Box::leak(Box::new(change(*entry.declaration)));
    equations::followed(&entry)
}

#[test]
fn an_equation_that_is_off_by_a_hundredth_does_not_pass() {
    const OFF: &[EquationPart] = &[
        EquationPart::new(Term::Diffuse, "I_d = 1.01 C_b N·L f_L f_V"),
        EquationPart::new(
            Term::Diffuse,
            "f_L = 1 + (F_{90} − 1)(1 − N·L)^5, f_V = 1 + (F_{90} − 1)(1 − N·V)^5",
        ),
        EquationPart::new(Term::Diffuse, "F_{90} = 1/2 + 2 r (H·L)^2"),
    ];
    let why = twin("burley_diffuse", |d| d.equation(OFF)).expect_err("1.01");
    assert!(why.starts_with("I_d = 1.01 C_b N·L f_L f_V: gives "), "{why}");
}

#[test]
fn a_quantity_that_nobody_gives_does_not_pass() {
    for id in ["metallic_roughness", "torrance_sparrow", "eon", "openpbr", "microfacet"] {
        let why = twin(id, |d| d.quantities(&[])).expect_err(id);
        assert!(why.contains("has no number") || why.contains("no value"), "{id}: {why}");
    }
}

#[test]
fn degrees_that_are_taken_for_radians_do_not_pass() {
    const WRONG: &[EquationPart] =
        &[EquationPart::new(Term::Diffuse, "I_d = C_b N·L (1 − σ^2/(2 σ^2 + 0.66))")];
    let why = twin("oren_nayar", |d| d.equation(WRONG).quantities(&[])).expect_err("degrees");
    assert!(why.contains("angle"), "{why}");
}

#[test]
fn definitions_in_a_circle_and_without_end_are_told() {
    const ROUND: &[EquationPart] = &[EquationPart::new(Term::Diffuse, "I_d = x C_b")];
    const CIRCLE: &[Quantity] = &[Quantity::new("x = y", "one"), Quantity::new("y = x", "other")];
    const ENDLESS: &[Quantity] =
        &[Quantity::new("x = f(1)", "start"), Quantity::new("f(z) = f(z + 1)", "never ends")];
    for quantities in [CIRCLE, ENDLESS] {
        assert!(twin("lambert", |d| d.equation(ROUND).quantities(quantities)).is_err());
    }
}

/// A line without the units of light and length, which follow its numbers.
fn without_units(text: &str) -> String {
    [" cd", " 1/m²", " lx"].into_iter().fold(text.to_owned(), |text, unit| text.replace(unit, ""))
}

/// The lines of an explanation that yield something else than they state.
fn wrong_lines(text: &str) -> (usize, Vec<String>) {
    let mut wrong = Vec::new();
    let mut count = 0;
    let mut compare = |what: &str, value: &str| {
        count += 1;
        let both = reading(&without_units(what)).and_then(|a| Ok((a, reading(&without_units(value))?)));
        match both {
            Ok((a, b)) if agrees(&a, &b, 3) => {}
            Ok((a, b)) => wrong.push(format!("{what} = {value}: {:?}, {:?}", a.rgb, b.rgb)),
            Err(why) => wrong.push(format!("{what} = {value}: {why}")),
        }
    };
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    for pair in lines.windows(2) {
        if let [Some(numbers), Some(value)] = [0, 1].map(|i| pair[i].strip_prefix("= ")) {
            compare(numbers, value);
        }
    }
    for line in lines.iter().filter(|line| line.starts_with("I(p) = ") && line.contains('×')) {
        let parts: Vec<_> = line.split(" = ").collect();
        let [.., numbers, value] = parts.as_slice() else { panic!("{line}") };
        compare(numbers, value);
    }
    for line in &lines {
        let channel = ["red: ", "green: ", "blue: "].into_iter().find_map(|c| line.strip_prefix(c));
        if let Some((numbers, value)) = channel.and_then(|rest| rest.split_once(" = ")) {
            compare(numbers, value);
        }
    }
    (count, wrong)
}

#[test]
fn the_text_of_random_pixels_can_be_calculated_line_by_line() {
    let registry = Registry::builtin();
    let settings = Settings { width: 64, height: 48, samples: 1, ..Settings::default() };
    let mut seed = 4;
    let mut count = 0;
    let mut explainer = Explainer::default();
    for model in registry.models() {
        for shading in ["flat", "gouraud", "phong", "derivative"] {
            let mut scene = Scene { reflection_model: model.declaration.id.to_owned(), ..Scene::default() };
            scene.shading_model = shading.to_owned();
            scene.objects[0].material = random_values(model, &mut seed);
            let spot = |light: &mut Light| {
                light.set_type(
                    registry.light("spot").expect("built in"),
                    &registry,
                    Scene::default().scene_size,
                );
                light.colour = [255, 200, 90];
                light.direction = Some(glam::Vec3::new(-0.3, -0.7, -0.7));
            };
            scene.lights.push(scene.lights[0].clone());
            spot(&mut scene.lights[1]);
            for _ in 0..4 {
                let at = [18 + (28.0 * random(&mut seed)) as u32, 12 + (24.0 * random(&mut seed)) as u32];
                let explained = explainer.pixel(&scene, &registry, &settings, at).expect("inside");
                let text = explained.to_text();
                let (lines, wrong) = wrong_lines(&text);
                assert!(
                    wrong.is_empty(),
                    "{} at {at:?}:\n{}\n\n{text}",
                    model.declaration.id,
                    wrong.join("\n")
                );
                count += lines;
            }
        }
    }
    assert!(count > 3000, "{count} lines");
}

#[test]
fn a_line_with_another_number_is_found() {
    let explained = explain::pixel(&Scene::default(), &Registry::builtin(), &Settings::default(), [640, 360]);
    let text = explained.expect("inside").to_text();
    assert_eq!(wrong_lines(&text).1, [""; 0]);
    let wrong = text.replacen("= max(0, 0.6", "= max(0, 0.7", 1);
    assert_ne!(wrong, text);
    assert_eq!(wrong_lines(&wrong).1.len(), 1);
}

#[test]
fn markdown_has_the_same_lines_in_code() {
    let explained = explain::pixel(&Scene::default(), &Registry::builtin(), &Settings::default(), [640, 360]);
    let explained = explained.expect("inside");
    let markdown = explained.to_markdown();
    assert!(markdown.starts_with("# Pixel 640,360 of "), "{markdown}");
    let plain: Vec<_> = explained.to_text().lines().map(|line| line.trim().to_owned()).collect();
    for line in markdown.lines().filter(|line| line.contains('`')) {
        let text = line.trim().trim_start_matches("- ").replace('`', "");
        assert!(plain.contains(&text), "{text}");
    }
    assert!(markdown.contains("  - `= max(0, "), "{markdown}");
}

#[test]
fn the_equation_of_a_custom_model_names_the_lets_of_its_shader() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("models")).expect("writable");
    let model = "/* lcm {
    \"equation\": [
        { \"term\": \"diffuse\", \"text\": \"I_d = w D (N·L)\" },
        { \"term\": \"specular\", \"text\": \"I_s = C ρ_x F_{90} max(0, N·L)\" },
    ],
    \"parameters\": [{ \"name\": \"weight\", \"symbol\": \"w\", \"default\": 0.5 }],
} */
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let cosine = dot(frame.n, l);
    if cosine <= 0.0 {
        return Terms(vec3(0.0), vec3(0.0), vec3(0.0));
    }
    let D = 0.25 + 0.5 * cosine;
    let rho_x = sqrt(cosine);
    let C = vec3(0.2, 0.4, rho_x);
    var F_90 = 3.0;
    if cosine > 0.0 {
        let F_90 = 2.0;
        return Terms(vec3(0.0), vec3(m.weight * D * cosine), C * rho_x * F_90 * cosine);
    }
    return Terms(vec3(0.0), vec3(F_90), vec3(0.0));
}
";
    fs::write(folder.path().join("models/named.wgsl"), model).expect("writable");
    let mut scene: serde_json::Value =
        serde_json::from_str(&fs::read_to_string("scenes/default.json").expect("shipped")).expect("JSON");
    scene["reflection_model"] = "named".into();
    fs::write(folder.path().join("a.json"), scene.to_string()).expect("writable");
    let run = lcm_in(folder.path(), &["explain", "a.json", "--models", "models", "--at", "640,360"], b"");
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    let (count, wrong) = wrong_lines(&run.out);
    assert!(count >= 5 && wrong.is_empty(), "{wrong:?}\n{}", run.out);
    for expected in ["\n    D = 0.5", "\n    ρ_x = 0.7", "\n    F_90 = 2", "\n    C = (0.2, 0.4, 0.7"] {
        assert!(run.out.contains(expected), "{expected}\n{}", run.out);
    }
}

#[test]
fn the_command_line_takes_samples_of_light_with_extent() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let explained = |scene: &str, more: &[&str]| {
        let scene = root.join("scenes").join(scene);
        let scene = scene.to_str().expect("UTF-8");
        lcm_in(folder.path(), &[&["explain", scene, "--at", "640,360"], more].concat(), b"")
    };
    for (more, expected) in [(vec![], 256), (vec!["--light-samples", "1000"], 1000)] {
        let run = explained("studio.json", &more);
        assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
        assert!(run.out.contains(&format!("by {expected} samples of the light")), "{}", run.out);
        assert!(run.out.contains("it fills 12.57 sr."), "{}", run.out);
    }
    let run = explained("default.json", &["--light-samples", "1000"]);
    assert_eq!(run.status, Some(0));
    assert!(run.err.contains("--light-samples changes nothing"), "{}", run.err);
    let run = explained("studio.json", &["--light-samples", "0"]);
    assert_eq!(run.status, Some(2));
    assert!(run.err.contains("whole number from 1 to 1048576"), "{}", run.err);
}

#[test]
fn the_command_line_has_derivatives_and_two_views() {
    let folder = tempfile::tempdir().expect("a folder");
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let scene = root.join("scenes/compare_phong_blinn_phong.json");
    let scene = scene.to_str().expect("UTF-8");
    let run =
        lcm_in(folder.path(), &["explain", scene, "--at", "640,360", "--derivatives", "--beside", "B"], b"");
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    for expected in
        ["View A beside view B", "What would move this pixel most, by differences", "Δ light/Δ I = "]
    {
        assert!(run.out.contains(expected), "{expected}\n{}", run.out);
    }
    let run = lcm_in(folder.path(), &["explain", scene, "--at", "640,360", "--derivatives", "--json"], b"");
    let json: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    let derivatives = json["derivatives"].as_array().expect("a list");
    assert!(
        derivatives
            .iter()
            .any(|d| d["symbol"] == "I" && d["derivative"][0].as_f64().is_some_and(|v| v > 0.0))
    );
    let run = lcm_in(folder.path(), &["explain", scene, "--at", "640,360", "--json", "--markdown"], b"");
    assert_eq!(run.status, Some(2));
}
