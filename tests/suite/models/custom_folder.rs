//! A folder of many custom models, some of them broken: the files read, and the messages.

use std::{
    collections::BTreeSet,
    fs,
    path::{Path, PathBuf},
};

use lights_camera_models::{
    custom::{
        self,
        folder::{self, Reading, declare_folder, declare_rest, read_model},
    },
    registry::{Extent, Registry},
    scene::{
        Scene,
        load::{self, Defaults},
        save,
    },
};
use serde_json::{Value as Json, json};

use crate::helpers::support::{Run, check_wording, lcm_in};

/// Number of models in a large folder.
const MANY: usize = 500;

/// A model with a separate parameter.
fn model(parameter: &str) -> String {
    format!(
        "/* lcm {{ \"parameters\": [\"base_colour\", {{ \"name\": \"{parameter}\", \"max\": 9 }}] }} */
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{
    return Terms(vec3(0.0), m.base_colour * max(dot(frame.n, l), 0.0) / (1.0 + m.{parameter}), vec3(0.0));
}}
"
    )
}

/// A folder for the test.
struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::create_dir(folder.path().join("models")).unwrap();
        Self { folder }
    }

    /// Many valid models, fuzz_0 to fuzz_499, and files that are broken in various ways.
    fn crowded() -> Self {
        let bench = Self::new();
        for i in 0..MANY {
            bench.put(&format!("fuzz_{i}.wgsl"), &model(&format!("depth_{i}")));
        }
        bench.put("bad.wgsl", &model("x").replace("m.x)", "m.y)"));
        bench.put("worse.wgsl", "/* lcm { \"parameters\": [5] } */");
        bench.put("huge.wgsl", &"nonsense ".repeat(1 << 16));
        bench.put("larger.wgsl", &"nonsense ".repeat(1 << 18));
        fs::write(bench.models().join("bytes.wgsl"), b"// \xff").unwrap();
        fs::create_dir(bench.models().join("folder.wgsl")).unwrap();
        bench.put("nothing.wgsl", " \n");
        #[cfg(unix)]
        std::os::unix::fs::symlink("gone", bench.models().join("lost.wgsl")).unwrap();
        // Reading it would wait forever.
        #[cfg(target_os = "linux")]
        assert!(
            std::process::Command::new("mkfifo")
                .arg(bench.models().join("pipe.wgsl"))
                .status()
                .unwrap()
                .success()
        );
        bench
    }

    fn models(&self) -> PathBuf {
        self.folder.path().join("models")
    }

    fn put(&self, name: &str, text: &str) -> PathBuf {
        let path = self.models().join(name);
        fs::write(&path, text).unwrap();
        path
    }

    /// Runs the program, with or without details.
    fn run(&self, arguments: &str, input: &str) -> Run {
        let arguments: Vec<_> =
            format!("{arguments} --models models").split(' ').map(str::to_owned).collect();
        let arguments: Vec<_> = arguments.iter().map(String::as_str).collect();
        lcm_in(self.folder.path(), &arguments, input.as_bytes())
    }

    fn registry(&self) -> Registry {
        let mut registry = Registry::builtin();
        registry.set_custom_folder(&self.models());
        registry
    }
}

/// The completely read models, and the number of files searched for declarations, from `--verbose`.
fn read(run: &Run) -> (BTreeSet<String>, usize) {
    let lines = || run.err.lines();
    let whole = lines().filter_map(|l| l.strip_prefix("read ")).map(|file| {
        custom::id_of(Path::new(file)).unwrap_or_else(|| panic!("{file} is no model")).to_owned()
    });
    let declared = lines().filter_map(|l| l.strip_prefix("looked for declarations in ")?.split(' ').next());
    (whole.collect(), declared.map(|n| n.parse::<usize>().unwrap()).sum())
}

fn ids<const N: usize>(ids: [&str; N]) -> BTreeSet<String> {
    ids.map(str::to_owned).into()
}

/// A scene of two spheres.
fn scene(model: &str, material: &Json, other: Option<&str>) -> String {
    let mut scene = json!({
        "scene_size": { "height": 10, "width": 10, "depth": 10 },
        "reflection_model": model,
        "shading_model": "phong",
        "lights": [{ "type": "point", "position": [7.5, 8, 9], "intensity": 60 }],
        "observer": { "position": [5, 5, 9.5], "direction": [0, 0, -1] },
        "objects": [
            { "type": "sphere", "position": [5, 5, 5], "material": material },
            { "type": "sphere", "position": [3, 5, 5] },
        ],
    });
    if let Some(other) = other {
        scene["objects"][1]["reflection_model"] = other.into();
    }
    scene.to_string()
}

const ANGLES: &str = "theta_i,phi_i,theta_o,phi_o\n60,0,20,10\n";

#[test]
fn what_no_command_names_is_not_read_and_nobody_hears_of_it() {
    let bench = Bench::crowded();
    let plain = scene("lambert", &json!({ "k_d": 0.7 }), Some("phong"));
    fs::write(bench.folder.path().join("plain.json"), &plain).unwrap();
    for (command, input) in [
        ("check plain.json", ""),
        ("check -", plain.as_str()),
        ("render plain.json --size 8x8 --renderer cpu -o x.png", ""),
        ("render --size 8x8 --renderer cpu -o x.png", ""),
        ("render --reflection phong --size 8x8 --renderer cpu -o x.png", ""),
        ("evaluate lambert", ANGLES),
        ("albedo phong", "mu\n0.5\n"),
        ("models duplicate phong copy_of_phong", ""),
        ("models new fresh", ""),
    ] {
        let told = bench.run(&format!("{command} --verbose"), input);
        assert_eq!(told.status, Some(0), "{command}: {}", told.err);
        assert_eq!(read(&told), (ids([]), 0), "{command}: {}", told.err);
        assert!(!told.err.contains("error"), "{command}: {}", told.err);
    }
    for command in ["check plain.json", "render --size 8x8 --renderer cpu -o x.png"] {
        assert_eq!(bench.run(&format!("{command} --quiet"), "").err, "", "{command}");
    }
}

#[test]
fn what_a_command_names_is_read_and_no_more() {
    let bench = Bench::crowded();
    let custom = scene("fuzz_7", &json!({ "depth_7": 3 }), Some("fuzz_450"));
    fs::write(bench.folder.path().join("custom.json"), &custom).unwrap();
    fs::write(bench.folder.path().join("again.json"), scene("phong", &json!({}), Some("fuzz_7"))).unwrap();
    let both = ids(["fuzz_7", "fuzz_450"]);
    for (command, input, expected) in [
        ("check custom.json", "", both.clone()),
        ("check custom.json again.json", "", both.clone()),
        ("check -", custom.as_str(), both.clone()),
        ("render custom.json --size 8x8 --renderer cpu -o x.png", "", both.clone()),
        ("render - --size 8x8 --renderer cpu -o x.png", custom.as_str(), both),
        ("render --reflection fuzz_0 --size 8x8 --renderer cpu -o x.png", "", ids(["fuzz_0"])),
        ("evaluate fuzz_1 --set depth_1=2", ANGLES, ids(["fuzz_1"])),
        ("albedo fuzz_2", "mu\n0.5\n", ids(["fuzz_2"])),
        ("models duplicate fuzz_3 mine", "", ids(["fuzz_3"])),
    ] {
        let told = bench.run(&format!("{command} --verbose"), input);
        assert_eq!(told.status, Some(0), "{command}: {}", told.err);
        assert_eq!(read(&told), (expected, 0), "{command}: {}", told.err);
    }
    assert!(fs::read_to_string(bench.models().join("mine.wgsl")).unwrap().contains("m.depth_3"));
}

#[test]
fn a_bad_file_is_an_error_for_whoever_names_it() {
    let bench = Bench::crowded();
    let bad = "bad.wgsl:3:";
    let worse = "worse.wgsl:1:";
    fs::write(bench.folder.path().join("bad.json"), scene("bad", &json!({}), None)).unwrap();
    fs::write(bench.folder.path().join("worse.json"), scene("phong", &json!({}), Some("worse"))).unwrap();
    for (command, input, status, mistake) in [
        ("check bad.json", "", 1, bad),
        ("check worse.json", "", 1, worse),
        ("check worse.json bad.json", "", 1, bad),
        ("render bad.json --size 8x8 -o x.png", "", 1, bad),
        ("render --reflection worse --size 8x8 -o x.png", "", 1, worse),
        ("evaluate bad", ANGLES, 1, bad),
        ("albedo worse", "mu\n1\n", 1, worse),
        ("models check bad", "", 1, bad),
        ("models duplicate bad mine", "", 1, bad),
        ("evaluate bytes", ANGLES, 1, "bytes.wgsl:1:4"),
        ("evaluate larger", ANGLES, 1, "larger than 1 MiB"),
        ("evaluate folder", ANGLES, 1, "this is a folder, not a regular file"),
        #[cfg(target_os = "linux")]
        ("evaluate pipe", ANGLES, 1, "this is a named pipe, not a regular file"),
        ("evaluate nothing", ANGLES, 1, "the file is empty"),
        #[cfg(unix)]
        ("evaluate lost", ANGLES, 1, "this is a link to a file that is missing"),
    ] {
        let told = bench.run(command, input);
        assert_eq!(told.status, Some(status), "{command}: {}", told.err);
        assert!(told.err.contains(mistake), "{command}: {}", told.err);
        let others = ["bad.wgsl", "worse.wgsl", "bytes.wgsl", "larger.wgsl"];
        let named = |name: &&&str| command.contains(name.trim_end_matches(".wgsl"));
        for other in others.iter().filter(|name| !named(name)) {
            assert!(!told.err.contains(other), "{command} tells of {other}: {}", told.err);
        }
    }
    // A file that is not a model is not one of its errors.
    let told = bench.run("evaluate huge", ANGLES);
    assert!(told.status == Some(2) && told.err.contains("must be \"lambert\""), "{}", told.err);
    assert!(told.err.contains("models/huge.wgsl is not a model: it neither begins with"), "{}", told.err);
    // The folder is called as it is, wherever the mistake is.
    let elsewhere = bench.folder.path().join("elsewhere");
    fs::create_dir(&elsewhere).unwrap();
    let with = |import: &str| model("x").replace("*/\n", &format!("*/\n#import \"{import}\"\n"));
    for (name, text) in [
        ("imports.wgsl", with("latin.wgsl")),
        ("lacks.wgsl", with("none.wgsl")),
        ("round.wgsl", with("round.wgsl")),
        (
            "twice.wgsl",
            with("half.wgsl").replace("fn response", "fn half() -> f32 { return 0.5; }\nfn response"),
        ),
        ("half.wgsl", "fn half() -> f32 { return 0.5; }\n".to_owned()),
    ] {
        fs::write(elsewhere.join(name), text).unwrap();
    }
    fs::write(elsewhere.join("latin.wgsl"), b"// \xe9").unwrap();
    for (id, expected) in [
        ("imports", "--> elsewhere/latin.wgsl:1:4"),
        ("lacks", "there is no file `none.wgsl` to import"),
        ("round", "circular import: round.wgsl → round.wgsl"),
        ("twice", "half.wgsl defines half too"),
    ] {
        let told = lcm_in(bench.folder.path(), &["evaluate", id, "--models", "elsewhere"], ANGLES.as_bytes());
        assert!(told.status == Some(1) && told.err.contains(expected), "{}", told.err);
        assert!(!told.err.contains("models/"), "{}", told.err);
    }
    // So does the scene that names a model with a mistake in a file that it imports.
    fs::write(elsewhere.join("lib.wgsl"), "\nfn lib() -> f32 { return gone; }\n").unwrap();
    fs::write(elsewhere.join("of_lib.wgsl"), with("lib.wgsl")).unwrap();
    let text = scene("of_lib", &json!({}), None);
    let told = lcm_in(bench.folder.path(), &["check", "-", "--models", "elsewhere"], text.as_bytes());
    let said = "the file of that custom model has an error: elsewhere/lib.wgsl:2:";
    assert!(told.status == Some(1) && told.err.contains(said), "{}", told.err);
    // A scene names it too.
    let told = bench.run("check -", &scene("nothing", &json!({}), None));
    assert_eq!(told.status, Some(1));
    let said = "the file of that custom model has an error: models/nothing.wgsl:1:1";
    assert!(told.err.contains(said) && !told.err.contains("lambert"), "{}", told.err);
}

#[test]
fn parameters_that_only_a_declaration_knows_are_valid_and_saved() {
    let bench = Bench::crowded();
    let text = scene("lambert", &json!({ "depth_123": 4.5 }), None);
    let told = bench.run("check - --verbose", &text);
    assert_eq!(told.status, Some(0), "{}", told.err);
    let (whole, declared) = read(&told);
    assert!(whole.is_empty() && declared >= MANY, "{whole:?} {declared}");
    let wrong = bench.run("check -", &text.replace("4.5", "9.5"));
    assert!(wrong.err.contains("but the depth 123 must be between 0 and 9"), "{}", wrong.err);

    let mut registry = Registry::builtin();
    assert!(load::from_text(&text, "a.json", &registry, Defaults::Refuse).is_err());
    let declared = declare_folder(&bench.models(), &mut registry);
    assert!(declared.files >= MANY);
    assert!(
        registry.custom_models().all(|(m, _)| registry.extent(m.declaration.id) == Some(Extent::Declaration))
    );
    let loaded = load::from_text(&text, "a.json", &registry, Defaults::Refuse).unwrap();
    let saved = save::to_json(&loaded.scene, None, &registry);
    assert!(saved.contains("\"depth_123\": 4.5"), "{saved}");
    let again = load::from_text(&saved, "a.json", &registry, Defaults::Refuse).unwrap();
    assert_eq!(again.scene, loaded.scene);
}

#[test]
fn messages_list_and_suggest_what_only_declarations_know() {
    let bench = Bench::crowded();
    let unknown = bench.run("check -", &scene("fuzzz_321", &json!({ "depthh_321": 1 }), None));
    assert_eq!(unknown.status, Some(1));
    check_wording(&unknown.err);
    for expected in [
        "\"fuzz_0\"",
        "\"fuzz_499\"",
        "did you mean \"fuzz_321\"?",
        "the folder of custom models has no models/fuzzz_321.wgsl",
        "did you mean \"depth_321\"?",
    ] {
        assert!(unknown.err.contains(expected), "{expected} is not in {}", unknown.err);
    }
    // Sorted by name, after the built-in ones, even if one was read before the others.
    let mixed = bench.run("check -", &scene("fuzz_77", &json!({}), Some("fuzzz_321")));
    let places =
        ["\"phong\"", "\"fuzz_0\"", "\"fuzz_1\"", "\"fuzz_77\"", "\"fuzz_78\""].map(|id| mixed.err.find(id));
    assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{places:?} {}", mixed.err);
    let typo = bench.run("evaluate fuzzz_321", ANGLES);
    assert!(typo.status == Some(2) && typo.err.contains("did you mean \"fuzz_321\"?"), "{}", typo.err);
    let typo = bench.run("render --reflection fuzzz_321 --size 8x8", "");
    assert!(typo.status == Some(2) && typo.err.contains("did you mean \"fuzz_321\"?"), "{}", typo.err);
}

#[test]
fn the_list_has_all_declarations_and_tells_which_are_wrong() {
    let bench = Bench::crowded();
    let listed = bench.run("models --json --verbose", "");
    assert_eq!(listed.status, Some(1), "some declarations are wrong");
    assert!(listed.err.contains("custom models were read; `lcm models check ID`"), "{}", listed.err);
    let all: Vec<Json> = serde_json::from_str(&listed.out).unwrap();
    let models: Vec<_> = all.iter().filter(|entry| entry["kind"] == "reflection model").collect();
    // The declaration of the broken one is valid.
    assert_eq!(models.len(), Registry::builtin().models().len() + MANY + 1);
    assert!(read(&listed).0.is_empty(), "{}", listed.err);
    for expected in [
        "worse.wgsl:1:",
        "bytes.wgsl:1:4",
        "larger than 1 MiB",
        "nothing.wgsl:1:1",
        "the file is empty",
        "huge.wgsl:1:1",
        "this file is no model",
        "folder.wgsl:1:1",
        "this is a folder, not a regular file",
        #[cfg(unix)]
        "this is a link to a file that is missing",
        #[cfg(target_os = "linux")]
        "this is a named pipe, not a regular file",
    ] {
        assert!(listed.err.contains(expected), "{expected} is not in {}", listed.err);
    }
    for unexpected in ["bad.wgsl", "fuzz_"] {
        assert!(!listed.err.contains(unexpected), "{unexpected} is in {}", listed.err);
    }
    let schema = bench.run("schema", "");
    assert!(schema.out.contains("\"fuzz_499\"") && schema.out.contains("\"depth_499\""));
}

#[test]
fn files_that_are_of_no_use_to_models_are_reported_and_others_are_not() {
    let bench = Bench::new();
    bench.put("model.wgsl", &model("depth"));
    bench.put("shared.wgsl", "const HALF = 0.5;\nfn half() -> f32 { return HALF; }\n");
    bench.put("notes.wgsl", "// To do.\n");
    assert_eq!(bench.run("models", "").status, Some(0));
    bench.put("noise.wgsl", "3f2a 99c1, \"and so on\n");
    let listed = bench.run("models", "");
    assert_eq!(listed.status, Some(1), "{}", listed.err);
    assert!(
        listed.err.contains("noise.wgsl:1:1") && listed.err.contains("this file is no model"),
        "{}",
        listed.err
    );
    for other in ["shared.wgsl", "notes.wgsl", "model.wgsl"] {
        assert!(!listed.err.contains(other), "{other}: {}", listed.err);
    }
}

#[test]
fn the_registry_knows_how_much_was_read_and_what_is_wanted() {
    let bench = Bench::new();
    for id in ["a", "b", "c"] {
        bench.put(&format!("{id}.wgsl"), &model(&format!("depth_{id}")));
    }
    let mut registry = bench.registry();
    assert_eq!(read_model("b", &mut registry), Reading::Read);
    assert_eq!(read_model("b", &mut registry), Reading::Known);
    assert_eq!(read_model("lambert", &mut registry), Reading::Known);
    assert_eq!(read_model("../models/b", &mut registry), Reading::Missing);
    assert_eq!(registry.custom_models().count(), 1);
    assert_eq!(declare_rest(&mut registry).files, 2);
    let extents = |registry: &Registry| {
        registry
            .custom_models()
            .map(|(m, _)| (m.declaration.id, registry.extent(m.declaration.id).unwrap()))
            .collect::<Vec<_>>()
    };
    assert_eq!(
        extents(&registry),
        [("a", Extent::Declaration), ("b", Extent::Whole), ("c", Extent::Declaration)]
    );
    // A scene that begins to use models needs the rest of them.
    let mut scene = Scene { reflection_model: "c".to_owned(), ..Scene::default() };
    scene.objects[0].reflection_model = Some("b".to_owned());
    let wanted =
        |registry: &Registry| registry.wants_reading(scene.models()).map(Path::to_owned).collect::<Vec<_>>();
    assert_eq!(wanted(&registry), [bench.models().join("c.wgsl")]);
    assert!(
        folder::sources_with("c", &registry).unwrap().get("models/c.wgsl").unwrap().contains("m.depth_c")
    );
    assert_eq!(registry.sources().get("models/c.wgsl"), None);
    assert_eq!(read_model("c", &mut registry), Reading::Read);
    assert!(wanted(&registry).is_empty());

    // Unchanged files are not read again.
    assert_eq!(declare_rest(&mut registry).files, 0);
    bench.put("a.wgsl", &model("another_name"));
    bench.put("d.wgsl", &model("depth_d"));
    // Scenes that use a completely known model follow it.
    bench.put("b.wgsl", &model("renamed"));
    assert_eq!(declare_rest(&mut registry).files, 2);
    assert_eq!(registry.model("a").unwrap().parameters[1].name, "another_name");
    assert_eq!(registry.model("b").unwrap().parameters[1].name, "depth_b");
    assert_eq!(extents(&registry).len(), 4);
    // A file that is no longer a model.
    bench.put("a.wgsl", "fn helper() -> f32 { return 1.0; }");
    assert_eq!(declare_rest(&mut registry).files, 1);
    assert!(registry.model("a").is_none() && registry.sources().get("models/a.wgsl").is_some());
    // An error found in reading the rest leaves the fallback.
    bench.put("d.wgsl", &model("depth_d").replace("m.base_colour", "m.base_color"));
    assert!(matches!(read_model("d", &mut registry), Reading::Broken(_)));
    assert!(registry.broken_model("d").unwrap().contains("d.wgsl:3:"));
    assert_eq!(registry.extent("d"), Some(Extent::Declaration));
}

#[test]
fn declarations_agree_on_types_in_the_order_of_names() {
    let bench = Bench::new();
    let declared =
        |kind: &str| format!("/* lcm {{ \"parameters\": [{{ \"name\": \"x\", \"type\": \"{kind}\" }}] }} */");
    for (id, kind) in [("a", "number"), ("b", "colour"), ("c", "number"), ("d", "colour")] {
        bench.put(&format!("{id}.wgsl"), &declared(kind));
    }
    let mut registry = bench.registry();
    let problems = declare_rest(&mut registry).problems;
    let told: Vec<_> = problems.iter().map(|(_, problem)| problem.to_string()).collect();
    assert_eq!(told.len(), 2, "{told:?}");
    for (said, id) in told.iter().zip(["b", "d"]) {
        let place = format!("models/{id}.wgsl:1:");
        assert!(
            said.starts_with(&place) && said.contains("a has a parameter of that name with type number"),
            "{said}"
        );
    }
    assert_eq!(registry.custom_models().count(), 2);
}

#[test]
fn of_files_with_different_units_the_later_is_refused_everywhere() {
    let bench = Bench::new();
    let with_unit = |text: &str| text.replace("\"max\": 9", "\"max\": 9, \"unit\": \"degree\"");
    for id in ["good", "good_too", "third"] {
        bench.put(&format!("{id}.wgsl"), &model("polish"));
    }
    bench.put("other_unit.wgsl", &with_unit(&model("polish")));
    // The one that is refused decides about no other.
    let two = "{ \"name\": \"polish\", \"unit\": \"degree\" }, { \"name\": \"haze\", \"max\": 9 }";
    bench.put("pair.wgsl", &model("haze").replace("{ \"name\": \"haze\", \"max\": 9 }", two));
    bench.put("rest.wgsl", &with_unit(&model("haze")));
    let refused = ["other_unit", "pair"];
    let mut registry = bench.registry();
    let problems = declare_rest(&mut registry).problems;
    let told: Vec<_> = problems.iter().map(|(_, problem)| problem.to_string()).collect();
    assert_eq!(told.len(), refused.len(), "{told:?}");
    for (said, id) in told.iter().zip(refused) {
        assert!(said.starts_with(&format!("models/{id}.wgsl:1:")), "{said}");
        assert!(said.contains("it is in degree here, but without a unit in good;"), "{said}");
    }
    let ids: Vec<_> = registry.custom_models().map(|(model, _)| model.declaration.id).collect();
    assert_eq!(ids, ["good", "good_too", "rest", "third"]);
    for id in &ids {
        // The window reads them so, and commands below.
        let path = bench.models().join(format!("{id}.wgsl"));
        let text = fs::read_to_string(&path).unwrap();
        assert!(custom::read(&path, &text, &registry).is_ok(), "{id}");
        assert_eq!(read_model(id, &mut bench.registry()), Reading::Read, "{id}");
        let told = bench.run("check -", &scene(id, &json!({}), None));
        assert_eq!(told.status, Some(0), "{id}: {}", told.err);
    }
    for id in refused {
        assert!(matches!(read_model(id, &mut bench.registry()), Reading::Broken(_)), "{id}");
        for command in ["check -", "render - --size 8x8 --renderer cpu -o x.png"] {
            let told = bench.run(command, &scene(id, &json!({}), Some("good")));
            assert_eq!(told.status, Some(1), "{command}: {}", told.err);
            let named = |name: &str| told.err.contains(&format!("{name}.wgsl:1:"));
            assert!(named(id) && !named("good"), "{command}: {}", told.err);
        }
        assert_eq!(bench.run(&format!("models check {id}"), "").status, Some(1));
    }
    let listed = bench.run("models", "");
    assert!(listed.status == Some(1) && !listed.err.contains("good.wgsl"), "{}", listed.err);
    assert!(refused.iter().all(|id| listed.err.contains(&format!("{id}.wgsl:1:"))), "{}", listed.err);
}

#[test]
fn brackets_in_brackets_are_read_on_every_thread() {
    let bench = Bench::new();
    for i in 0..8 {
        bench.put(&format!("deep_{i}.wgsl"), &format!("/* lcm {}1{} */", "[".repeat(600), "]".repeat(600)));
        bench.put(&format!("deeper_{i}.wgsl"), &format!("/* lcm {} */", "{\"a\":".repeat(100_000)));
    }
    let problems = declare_rest(&mut bench.registry()).problems;
    assert_eq!(problems.len(), 16, "{problems:?}");
}

#[test]
fn a_model_brings_the_files_that_it_imports() {
    let bench = Bench::new();
    let with = |import: &str| model("x").replace("*/\n", &format!("*/\n#import \"{import}\"\n"));
    bench.put("one.wgsl", "#import \"two.wgsl\"\nfn one() -> f32 { return two(); }\n");
    bench.put("two.wgsl", "#import \"one.wgsl\"\nfn two() -> f32 { return 0.5; }\n");
    bench.put("three.wgsl", "#import \"four.wgsl\"\nfn three() -> f32 { return four(); }\n");
    bench.put("four.wgsl", "fn four() -> f32 { return 0.5; }\n");
    fs::write(bench.models().join("latin.wgsl"), b"// \xe9").unwrap();
    bench.put("good.wgsl", &with("three.wgsl").replace("(1.0 +", "(three() +"));
    bench.put("round.wgsl", &with("one.wgsl"));
    bench.put("itself.wgsl", &with("itself.wgsl"));
    bench.put("lost.wgsl", &with("latin.wgsl"));
    let mut registry = bench.registry();
    assert_eq!(read_model("good", &mut registry), Reading::Read);
    let read: Vec<_> = registry.sources().edited().collect();
    assert_eq!(read, ["models/four.wgsl", "models/good.wgsl", "models/three.wgsl"]);
    for (id, expected) in [
        ("round", "circular import"),
        ("itself", "circular import"),
        ("lost", "models/latin.wgsl:1:4: the byte 0xe9 is not UTF-8"),
    ] {
        let Reading::Broken(problems) = read_model(id, &mut registry) else { panic!("{id}") };
        let told: Vec<_> = problems.iter().map(|(_, problem)| problem.to_string()).collect();
        assert!(told.join("\n").contains(expected), "{id}: {told:?}");
    }
    assert!(registry.sources().get("models/itself.wgsl").is_none());
    // Shaders may import from the folder too.
    let at = bench.folder.path();
    assert_eq!(bench.run("assets export mine", "").status, Some(0));
    let lambert = at.join("mine/shaders/reflection/lambert.wgsl");
    let text = fs::read_to_string(&lambert).unwrap();
    fs::write(&lambert, format!("#import \"../models/three.wgsl\"\n{text}")).unwrap();
    let told = bench.run("evaluate lambert --on gpu --assets mine", ANGLES);
    assert_eq!(told.status, Some(0), "{}", told.err);
}

#[cfg(target_os = "linux")]
#[test]
fn an_import_is_a_file_in_the_folder_and_no_link_leads_out_of_it() {
    use std::os::unix::fs::symlink;
    let bench = Bench::new();
    let with = |import: &str| model("x").replace("*/\n", &format!("*/\n#import \"{import}\"\n"));
    fs::write(bench.folder.path().join("secret"), "root:x:0:0\n").unwrap();
    symlink("../secret", bench.models().join("pw.wgsl")).unwrap();
    symlink("/dev/zero", bench.models().join("zero.wgsl")).unwrap();
    symlink("half.wgsl", bench.models().join("same.wgsl")).unwrap();
    bench.put("half.wgsl", "fn half() -> f32 { return 0.5; }\n");
    fs::create_dir(bench.models().join("folder.wgsl")).unwrap();
    for import in ["pw", "zero", "same", "folder"] {
        bench.put(&format!("with_{import}.wgsl"), &with(&format!("{import}.wgsl")));
    }
    for (id, expected) in [
        ("with_pw", "this is a link that leads out of the folder models"),
        ("pw", "this is a link that leads out of the folder models"),
        ("with_zero", "this is a device, not a regular file"),
        ("with_folder", "this is a folder, not a regular file"),
    ] {
        let told = bench.run(&format!("evaluate {id}"), ANGLES);
        assert!(told.status == Some(1) && told.err.contains(expected), "{id}: {}", told.err);
        assert!(!told.err.contains("root:x") && !told.err.contains("there is no file"), "{}", told.err);
    }
    assert_eq!(bench.run("evaluate with_same", ANGLES).status, Some(0));
    // Neither do the declarations of the whole folder.
    let mut registry = bench.registry();
    assert_eq!(declare_rest(&mut registry).problems.len(), 3);
    assert_eq!(registry.sources().get("models/pw.wgsl"), None);
}
