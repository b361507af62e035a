//! Shader folders and custom models on the command line.

use std::{
    fs,
    path::{Path, PathBuf},
    process::Command,
};

use lights_camera_models::{
    library::assets::{self, EXAMPLES, export},
    registry::Registry,
};
use serde_json::Value as Json;

use crate::helpers::support::{Run, lcm_in, root};

/// A folder for the test, containing an empty folder `models`.
fn workplace() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("models")).unwrap();
    folder
}

/// Runs the program in a folder.
fn run(folder: &Path, arguments: &str, input: &str) -> Run {
    let arguments: Vec<_> = arguments.split(' ').collect();
    lcm_in(folder, &arguments, input.as_bytes())
}

/// A model that reflects `expression`.
fn model(expression: &str) -> String {
    format!(
        "/* lcm {{ \"laws\": [\"reciprocal\"], \"parameters\": [\"base_colour\"] }} */
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{
    let cos_l = max(dot(frame.n, l), 0.0);
    return Terms(vec3(0.0), m.base_colour * {expression}, vec3(0.0));
}}
"
    )
}

fn put(folder: &Path, name: &str, text: &str) -> PathBuf {
    let path = folder.join("models").join(name);
    fs::write(&path, text).unwrap();
    path
}

const ANGLES: &str = "theta_i,phi_i,theta_o,phi_o\n60,0,20,10\n";

#[test]
fn a_new_model_is_written_listed_evaluated_and_checked() {
    let folder = workplace();
    let at = folder.path();
    let made = run(at, "models new velvet_rim --models made/here", "");
    assert_eq!((made.status, made.out.trim()), (Some(0), "made/here/velvet_rim.wgsl"));
    assert!(made.err.contains("`lcm models check velvet_rim --models made/here`"), "{}", made.err);
    let again = run(at, "models new velvet_rim --models made/here", "");
    assert_eq!(again.status, Some(4));
    assert!(again.err.contains("velvet_rim.wgsl already exists and was kept"), "{}", again.err);

    let table = run(at, "models --models made/here", "").out;
    assert!(
        table.contains("Custom models\n  velvet_rim") && table.contains("made/here/velvet_rim.wgsl\n"),
        "{table}"
    );
    let json: Json = serde_json::from_str(&run(at, "--models made/here models --json", "").out).unwrap();
    let own = json.as_array().unwrap().iter().rfind(|m| m["kind"] == "reflection model").unwrap();
    assert_eq!((&own["id"], &own["family"]), (&"velvet_rim".into(), &"Custom models".into()));
    assert_eq!(own["file"], "made/here/velvet_rim.wgsl");
    assert_eq!(own["parameters"][1]["name"], "gloss");
    assert!(run(at, "schema --models made/here", "").out.contains("\"velvet_rim\""));

    let cpu = run(at, "evaluate velvet_rim --set gloss=1 --models made/here", ANGLES);
    let gpu = run(at, "evaluate velvet_rim --set gloss=1 --on gpu --models made/here", ANGLES);
    let value = |r: &Run| r.out.lines().nth(1).unwrap().split(',').nth(4).unwrap().parse::<f32>().unwrap();
    assert!(value(&cpu) > 0.0 && (value(&cpu) / value(&gpu) - 1.0).abs() < 1e-5, "{} {}", cpu.out, gpu.out);
    for on in ["cpu", "gpu"] {
        let albedo =
            run(at, &format!("albedo velvet_rim --set gloss=0 --on {on} --models made/here"), "mu\n0.5\n");
        let value: f32 = albedo.out.lines().nth(1).unwrap().split(',').nth(1).unwrap().parse().unwrap();
        assert!((value - 1.0).abs() < 2e-4, "{}", albedo.out);
    }
    let checked = run(at, "models check velvet_rim --models made/here", "");
    assert_eq!(checked.status, Some(0), "{}{}", checked.out, checked.err);
    assert_eq!(checked.out.matches("claimed and kept").count(), 3, "{}", checked.out);
    assert!(checked.out.contains("largest directional albedo: 1.000"), "{}", checked.out);

    for (name, expected) in [
        (
            "Über",
            "NAME is \"Über\", but a name must begin with a letter and have only letters a–z, digits and spaces, at most 40; for example ueber",
        ),
        (
            "3colours",
            "a name must begin with a letter and have only letters a–z, digits and spaces, at most 40; for example colours",
        ),
        ("phong", "is the id of a built-in model"),
    ] {
        let refused = run(at, &format!("models new {name}"), "");
        assert!(refused.status == Some(2) && refused.err.contains(expected), "{}", refused.err);
    }
}

#[test]
fn a_broken_claim_is_found_with_numbers_and_a_kept_one_that_nobody_makes_too() {
    let folder = workplace();
    put(folder.path(), "half.wgsl", &model("cos_l * 0.5"));
    put(folder.path(), "uneven.wgsl", &model("cos_l * (1.0 - 0.5 * cos_l)"));
    put(folder.path(), "holes.wgsl", &model("sqrt(0.5 - cos_l)"));
    let kept = run(folder.path(), "models check half --models models", "");
    assert_eq!(kept.status, Some(0));
    assert!(
        kept.out.contains("energy conserving: not claimed, but no violation found: claim it?"),
        "{}",
        kept.out
    );
    let broken = run(folder.path(), "models check uneven --models models", "");
    assert_eq!(broken.status, Some(1));
    assert!(broken.out.contains("reciprocal: claimed and BROKEN\n"), "{}", broken.out);
    assert!(broken.out.contains("f(v, l): 0.") && broken.out.contains("at l (θ "), "{}", broken.out);
    assert!(broken.err.contains("uneven claims to be reciprocal, but is not"), "{}", broken.err);
    let holes = run(folder.path(), "models check holes --models models", "");
    assert_eq!(holes.status, Some(1));
    assert!(holes.out.contains("finite: NOT everywhere"), "{}", holes.out);
    assert!(!holes.out.contains("claimed and kept") && !holes.out.contains("claim it?"), "{}", holes.out);
    // A driver may take 1/0 for 0; then the CPU tells.
    put(folder.path(), "poles.wgsl", &model("cos_l / (cos_l - cos_l)"));
    let poles = run(folder.path(), "models check poles --models models", "");
    assert_eq!(poles.status, Some(1));
    let told = "poles is finite on the GPU, which was given light from single directions and no ambient light; \
         on the CPU, an object has the reflection model poles, which gives (∞";
    assert!(poles.out.contains("finite: NOT everywhere") || poles.err.contains(told), "{}", poles.err);
    let everywhere = "fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {
    return vec3(sqrt(m.base_colour.r - 2.0));\n}\n";
    put(folder.path(), "haze.wgsl", &(model("cos_l * 0.5") + everywhere));
    let haze = run(folder.path(), "models check haze --models models", "");
    let told = "for light from everywhere and a viewer at 0°";
    assert!(haze.status == Some(1) && haze.err.contains(told), "{}{}", haze.out, haze.err);
    assert!(haze.err.contains("it must be finite: ambient_response at models/haze.wgsl:"), "{}", haze.err);
    let phong = run(folder.path(), "models check phong", "");
    assert_eq!(phong.status, Some(0));
    assert!(phong.out.contains("reciprocal: not claimed and broken"), "{}", phong.out);
    let set = run(folder.path(), "models check phong --set k_s=0", "");
    let expected = "reciprocal: not claimed for all parameters; with these, no violation was found";
    assert!(set.out.contains(expected) && !set.out.contains("claim it?"), "{}", set.out);
    assert!(set.out.contains("non-negative: claimed for all parameters, and kept with these"), "{}", set.out);
    assert_eq!(run(folder.path(), "models check banana", "").status, Some(2));
}

#[test]
fn a_model_is_duplicated_to_a_file() {
    let folder = workplace();
    let made = run(folder.path(), "models duplicate microfacet --models models", "");
    assert_eq!((made.status, made.out.trim()), (Some(0), "models/microfacet_copy.wgsl"), "{}", made.err);
    let set = "--set multiple_scattering=turquin --set alpha_x=0.9";
    let original = run(folder.path(), &format!("evaluate microfacet --on gpu {set}"), ANGLES).out;
    for on in ["gpu", "cpu"] {
        let copy =
            run(folder.path(), &format!("evaluate microfacet_copy --on {on} --models models {set}"), ANGLES)
                .out;
        let values = |text: &str| {
            text.lines()
                .nth(1)
                .unwrap()
                .split(',')
                .skip(4)
                .map(|v| v.parse::<f32>().unwrap())
                .collect::<Vec<_>>()
        };
        for (a, b) in values(&original).iter().zip(values(&copy)) {
            assert!((a / b - 1.0).abs() < 1e-4, "{on}: {original}{copy}");
        }
    }
    // A copy of the copy, with a given name.
    let again = run(folder.path(), "models duplicate microfacet_copy other --models models", "");
    assert_eq!(again.out.trim(), "models/other.wgsl", "{}", again.err);
    let table = run(folder.path(), "models --models models", "").out;
    assert!(table.contains("models/other.wgsl"), "{table}");
    let named = |id: &str, name: &str| {
        table.lines().any(|l| l.split_whitespace().next() == Some(id) && l.contains(name))
    };
    assert!(named("microfacet_copy", "Microfacet (copy)") && named("other", "Other"), "{table}");
    let unknown = run(folder.path(), "models duplicate fong --models models", "");
    assert!(unknown.status == Some(2) && unknown.err.contains("did you mean \"phong\"?"), "{}", unknown.err);
}

#[test]
fn pictures_of_custom_models_come_from_both_renderers() {
    let folder = workplace();
    put(folder.path(), "half.wgsl", &model("cos_l * 0.5"));
    let scene = root().join("scenes/default.json").display().to_string();
    for renderer in ["cpu", "gpu"] {
        let arguments = format!(
            "render {scene} --reflection half --size 64x48 --renderer {renderer} -o {renderer}.png --models models"
        );
        let run = run(folder.path(), &arguments, "");
        assert_eq!(run.status, Some(0), "{}", run.err);
    }
    let pixels = |name: &str| {
        let file = fs::File::open(folder.path().join(name)).unwrap();
        let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        bytes
    };
    let (cpu, gpu) = (pixels("cpu.png"), pixels("gpu.png"));
    let off = cpu.iter().zip(&gpu).filter(|(a, b)| a.abs_diff(**b) > 2).count();
    assert!(off * 50 < cpu.len(), "{off} of {}", cpu.len());
    assert!(cpu.iter().any(|v| *v > 60));
}

#[test]
fn what_the_cpu_does_not_know_is_said_and_the_graphics_card_does_it() {
    let folder = workplace();
    put(folder.path(), "table.wgsl", &model("parameter_table[object_row].parameters.base_colour.r * cos_l"));
    let run = |arguments: &str, input| run(folder.path(), &format!("{arguments} --models models"), input);
    for (command, input) in [("evaluate table", ANGLES), ("albedo table", "mu\n1\n")] {
        let said = run(command, input);
        assert_eq!(said.status, Some(3), "{command}: {}", said.err);
        let expected = "table cannot be run on the CPU, which interprets custom models: ";
        assert!(said.err.contains(expected) && said.err.contains("; use --on gpu"), "{}", said.err);
        assert_eq!(run(&format!("{command} --on gpu"), input).status, Some(0));
    }
    let said = run("render --reflection table --size 8x8 --renderer cpu -o x.png", "");
    assert!(said.status == Some(3) && said.err.contains("; use --renderer gpu"), "{}", said.err);
    assert!(!folder.path().join("x.png").exists());
    let drawn = run("render --reflection table --size 8x8 -o x.png", "");
    assert_eq!(drawn.status, Some(0), "{}", drawn.err);
    let file = fs::File::open(folder.path().join("x.png")).unwrap();
    let info = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    assert!(info.info().uncompressed_latin1_text.iter().any(|t| t.keyword == "Renderer" && t.text == "GPU"));
}

#[test]
fn a_broken_file_is_told_of_and_the_rest_goes_on() {
    let folder = workplace();
    put(folder.path(), "good.wgsl", &model("cos_l"));
    put(folder.path(), "bad.wgsl", &model("cos_m"));
    put(folder.path(), "helper.wgsl", "fn helped(x: f32) -> f32 { return 0.25 * x; }\n");
    put(
        folder.path(),
        "helped_model.wgsl",
        &model("helped(cos_l)").replace("*/\n", "*/\n#import \"helper.wgsl\"\n"),
    );
    fs::write(folder.path().join("models/notes.txt"), "no model").unwrap();
    // The list shows declarations, and that of the broken model is valid; its problem follows the list.
    let listed = run(folder.path(), "models --models models", "");
    assert_eq!(listed.status, Some(1));
    assert!(listed.err.contains("`cos_m` is not defined"), "{}", listed.err);
    for id in ["good", "helped_model", "bad"] {
        assert!(listed.out.contains(&format!("  {id}")), "{}", listed.out);
    }
    assert!(!listed.out.contains("  helper "), "{}", listed.out);

    let unchecked = run(folder.path(), "models check bad --models models", "");
    assert!(
        unchecked.status == Some(1) && unchecked.err.contains("bad was not checked"),
        "{}",
        unchecked.err
    );
    for expected in [
        "error: `cos_m` is not defined; did you mean `cos_l`?",
        "--> models/bad.wgsl:4:",
        "return Terms(vec3(0.0), m.base_colour * cos_m",
        "^",
    ] {
        assert!(unchecked.err.contains(expected), "{}", unchecked.err);
    }
    assert!(!unchecked.err.contains("helper"), "{}", unchecked.err);
    let caret = unchecked.err.lines().find(|l| l.contains('^')).unwrap().find('^');
    assert_eq!(caret, unchecked.err.lines().find(|l| l.contains("return Terms")).unwrap().find("cos_m"));
    let render = |id: &str| {
        run(folder.path(), &format!("render --reflection {id} --size 8x8 -o x.png --models models"), "")
    };
    let bad = render("bad");
    assert_eq!(bad.status, Some(1));
    assert!(
        bad.err.contains("bad\", but the file of that custom model has an error: models/bad.wgsl:4:"),
        "{}",
        bad.err
    );
    assert_eq!(bad.err.matches("cos_m`").count(), 1, "each mistake is told once: {}", bad.err);
    let gone = render("gone");
    assert!(gone.err.contains("the folder of custom models has no models/gone.wgsl"), "{}", gone.err);
    assert_eq!(render("helped_model").status, Some(0));

    let scene = fs::read_to_string(root().join("scenes/default.json")).unwrap();
    let scene = scene.replace("\"lambert\"", "\"bad\"");
    fs::write(folder.path().join("bad.json"), &scene).unwrap();
    let checked = run(folder.path(), "check bad.json --models models", "");
    assert_eq!(checked.status, Some(1));
    assert!(
        checked.err.contains("the file of that custom model has an error: models/bad.wgsl:4:"),
        "{}",
        checked.err
    );
    fs::write(folder.path().join("good.json"), scene.replace("\"bad\"", "\"good\"")).unwrap();
    assert_eq!(run(folder.path(), "check good.json --models models", "").status, Some(0));
    let refused = run(folder.path(), "check good.json --models elsewhere", "");
    assert!(
        refused.status == Some(2) && refused.err.contains("there is no folder elsewhere for --models"),
        "{}",
        refused.err
    );
}

#[test]
fn shaders_are_exported_edited_and_used() {
    let folder = workplace();
    let at = folder.path();
    let first = run(at, "assets export mine", "");
    assert_eq!(first.status, Some(0), "{}", first.err);
    let count = assets::built_in_sources(&Registry::builtin()).len() + EXAMPLES.len();
    assert_eq!(first.out.lines().count(), count);
    let lambert = at.join("mine/shaders/reflection/lambert.wgsl");
    let text = fs::read_to_string(&lambert).unwrap();
    assert_eq!(text, fs::read_to_string(root().join("assets/shaders/reflection/lambert.wgsl")).unwrap());
    assert!(at.join("mine/models/gooch.wgsl").is_file());
    // The exported files equal the built-in ones, and give the same numbers.
    let value = |arguments: &str| run(at, arguments, ANGLES).out;
    let original = value("evaluate lambert --on gpu");
    assert_eq!(value("evaluate lambert --on gpu --assets mine"), original);
    fs::write(&lambert, text.replace("* m.base_colour, vec3(0.0)", "* 0.5 * m.base_colour, vec3(0.0)"))
        .unwrap();
    let edited = value("evaluate lambert --on gpu --assets mine");
    let number = |text: &str| text.lines().nth(1).unwrap().split(',').nth(4).unwrap().parse::<f32>().unwrap();
    assert!((number(&edited) / number(&original) - 0.5).abs() < 1e-6, "{edited}");
    // The CPU renderer is Rust; a message says that it ignores edits.
    let said = |arguments: &str| run(at, &format!("render --size 8x8 --assets mine {arguments}"), "").err;
    let told = "the CPU renderer ignores the edited reflection/lambert.wgsl; --renderer gpu uses the edits";
    assert!(said("--renderer cpu --reflection lambert").contains(told));
    assert!(!said("--renderer cpu --reflection phong").contains("follow"));
    assert!(!said("--renderer gpu --reflection lambert").contains("follow"));
    assert_eq!(said("--renderer cpu --reflection lambert --quiet"), "");
    // Edited files are kept, and missing files come back.
    fs::remove_file(at.join("mine/shaders/loop.wgsl")).unwrap();
    let again = run(at, "assets export mine", "");
    assert_eq!(again.out.trim(), Path::new("mine/shaders/loop.wgsl").display().to_string());
    assert!(
        again
            .err
            .contains("mine/shaders/reflection/lambert.wgsl differs from the built-in file and was kept"),
        "{}",
        again.err
    );
    assert!(fs::read_to_string(&lambert).unwrap().contains("0.5 * m.base_colour"));
    // The copy as a function.
    let exported = export(&at.join("mine"), &Registry::builtin()).unwrap();
    assert_eq!((exported.written.len(), exported.kept, exported.same), (0, vec![lambert], count - 1));
    fs::write(at.join("file"), "").unwrap();
    assert_eq!(run(at, "assets export file", "").status, Some(4));
    assert!(run(at, "assets export mine --quiet", "").err.lines().count() == 1);
}

#[test]
fn a_broken_shader_is_an_error_where_it_is_used() {
    let folder = workplace();
    let at = folder.path();
    run(at, "assets export mine", "");
    let spoil = |name: &str, from: &str, to: &str| {
        let path = at.join("mine/shaders").join(name);
        let text = fs::read_to_string(&path).unwrap();
        assert!(text.contains(from), "{name}");
        let line = text.lines().position(|l| l.contains(from)).unwrap() + 1;
        fs::write(&path, text.replacen(from, to, 1)).unwrap();
        format!("--> mine/shaders/{name}:{line}:")
    };
    let lambert = spoil("reflection/lambert.wgsl", "m.base_colour", "m.base_color");
    for command in [
        "evaluate lambert --on gpu",
        "evaluate lambert",
        "albedo lambert",
        "render --size 8x8",
        "render --size 8x8 --renderer gpu",
    ] {
        let said = run(
            at,
            &format!("{command} --assets mine"),
            if command.starts_with('a') { "mu\n1\n" } else { ANGLES },
        );
        assert_eq!(said.status, Some(1), "{command}: {}", said.err);
        assert!(said.err.contains(&lambert) && said.err.contains('^'), "{command}: {}", said.err);
    }
    assert_eq!(run(at, "evaluate phong --assets mine", ANGLES).status, Some(0));
    let wrapper = spoil("wrapper.wgsl", "out.offset =", "out.ofset =");
    let said = run(at, "render --size 8x8 --reflection phong --assets mine", "");
    assert!(said.status == Some(1) && said.err.contains(&wrapper), "{}", said.err);
    // Not text at all.
    fs::write(at.join("mine/shaders/lights.wgsl"), b"// \xff").unwrap();
    let said = run(at, "evaluate phong --assets mine", ANGLES);
    assert!(said.status == Some(1) && said.err.contains("mine/shaders/lights.wgsl:1:4"), "{}", said.err);
    assert!(said.err.contains("the byte 0xff is not UTF-8"), "{}", said.err);
}

#[test]
fn folders_come_from_the_command_line_and_the_environment() {
    let folder = workplace();
    let at = folder.path();
    run(at, "assets export root/assets", "");
    for (arguments, expected) in [
        (
            "models --assets nowhere",
            "--assets is nowhere, but it must be a folder with a folder shaders in it; there is no such folder",
        ),
        ("models --assets root", "did you mean root/assets?"),
        ("models --assets root/assets/shaders", "did you mean root/assets?"),
        ("models --models root/assets/shaders/loop.wgsl", "but it must be a folder"),
    ] {
        let said = run(at, arguments, "");
        assert!(said.status == Some(2) && said.err.contains(expected), "{arguments}: {}", said.err);
    }
    let with = |name: &str, value: PathBuf| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_lcm"));
        command
            .arg("models")
            .env_remove("CARGO_MANIFEST_DIR")
            .env_remove("BEVY_ASSET_ROOT")
            .env("LCM_DATA_DIR", at.join("none"));
        Run::from(command.env(name, value).output().unwrap()).out
    };
    for name in ["CARGO_MANIFEST_DIR", "BEVY_ASSET_ROOT"] {
        assert!(with(name, at.join("root")).contains("root/assets/models/gooch.wgsl"), "{name}");
    }
    assert!(with("LCM_DATA_DIR", at.join("root/assets")).contains("root/assets/models/gooch.wgsl"));
    assert!(!run(at, "models", "").out.contains("gooch"));
    assert!(run(at, "models --assets root/assets", "").out.contains("root/assets/models/charlie_sheen.wgsl"));
}
