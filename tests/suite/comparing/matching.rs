//! Matching a view to view A: `lcm match`, and the window with its question, progress and history step.

use std::{fs, path::Path};

use bevy::{
    app::{App, PluginGroup as _},
    ecs::message::Messages,
};
use bevy_egui::egui::{Key, Modifiers};
use lights_camera_models::{
    document::Edit,
    matching::{self, Ended, Match, Measure, Metric, Request, What, match_view},
    panel::state::{Action, CompareCommand, Effect, MatchCommand, Running, Session, Severity},
    parameter::{Value, Values},
    progress::Progress,
    registry::Registry,
    scene::{
        Part, Scene, Variant,
        load::{self, Defaults},
    },
    window::LabPlugins,
};
use serde_json::json;

use crate::{
    helpers::support::{Run, lcm_in, names},
    library::plugins::app,
    window::panels::Bench,
};

/// View A with Phong's model, view B with Blinn's.
fn scene() -> Scene {
    let mut scene = Scene { reflection_model: "phong".to_owned(), ..Scene::default() };
    scene.objects[0].material.set("alpha", Value::Integer(32));
    let variant = Variant {
        name: Some("half".to_owned()),
        reflection_model: Some("blinn_phong".to_owned()),
        ..Variant::default()
    };
    scene.variants = vec![variant];
    scene
}

/// A folder with that scene.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let text = lights_camera_models::scene::save::to_json(&scene(), None, &Registry::builtin());
    fs::write(folder.path().join("a.json"), text).expect("writable");
    folder
}

fn material(file: &Path) -> Values {
    let loaded = load::file(file, &Registry::builtin(), Defaults::Refuse).expect("a scene");
    loaded.scene.variants[0].material.clone()
}

fn refused(run: &Run, status: i32, expected: &str) {
    assert_eq!(run.status, Some(status), "{}", run.err);
    assert!(run.err.contains(expected), "{}\nnot: {expected}", run.err);
    assert_eq!(run.out, "");
}

#[test]
fn the_command_finds_the_exponent_of_every_lecture_and_writes_the_scene() {
    let folder = folder();
    let at = folder.path();
    let run = lcm_in(at, &["match", "a.json", "--on", "highlight"], b"");
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    assert!(run.out.starts_with("view B matched to view A on the highlight\nalpha: 32 → 12"), "{}", run.out);
    assert!(run.out.contains("0.1 is about 10 %: 0."), "{}", run.out);
    assert!(run.out.contains("\nunchanged: k_a, k_d and k_s\n"), "{}", run.out);
    let about = "\nwithout effect in all that was tried: k_a, k_d and k_s\ncompared ";
    assert!(run.out.contains(about) && !run.out.contains("the search ended"), "{}", run.out);
    assert_eq!(names(at), ["a.json"], "nothing is written unasked");

    let arguments =
        ["match", "a.json", "--view", "half", "--on", "highlight", "--free", "alpha,k_s", "--json"];
    let json: serde_json::Value = serde_json::from_str(&lcm_in(at, &arguments, b"").out).expect("JSON");
    assert_eq!((&json["view"], &json["on"]), (&json!("B"), &json!("highlight")));
    let alpha = json["values"]["alpha"].as_i64().expect("it was found");
    assert!((124..=132).contains(&alpha), "{json:#}");
    assert_eq!(json["unchanged"], json!(["k_s"]));
    assert_eq!((&json["without_effect"], &json["ended"]), (&json!(["k_s"]), &json!("search")));
    assert!(json["evaluations"].as_u64().is_some_and(|count| count > 10), "{json:#}");
    assert_eq!(json["values"].as_object().map(serde_json::Map::len), Some(1), "{json:#}");
    let [before, after] = ["before", "after"].map(|key| json[key].as_f64().expect("a number"));
    assert!(before > 0.5 && after < 0.01, "{json:#}");

    let run = lcm_in(at, &["match", "a.json", "--on", "highlight", "-o", "b.json"], b"");
    assert_eq!((run.status, run.err.as_str()), (Some(0), "wrote b.json\n"));
    assert_eq!(material(&at.join("b.json")).0["alpha"], Value::Integer(alpha));
    // Nothing is replaced unasked, and this is checked before the search.
    let run = lcm_in(at, &["match", "a.json", "-o", "b.json"], b"");
    refused(&run, 4, "b.json already exists; it was not overwritten; --overwrite replaces it");
    let arguments = ["match", "a.json", "--on", "highlight", "-o", "b.json", "--overwrite", "-q"];
    assert_eq!(lcm_in(at, &arguments, b"").status, Some(0));
    assert_eq!(material(&at.join("b.json")).0["alpha"], Value::Integer(alpha));
    // Now it is as close as possible.
    let run = lcm_in(at, &["match", "b.json", "--on", "highlight"], b"");
    assert!(
        run.out.starts_with("view B stays as it is: no other values come nearer to view A\n"),
        "{}",
        run.out
    );
}

#[test]
fn lobes_and_pictures_come_nearer_too() {
    let folder = folder();
    for on in ["lobe", "picture"] {
        let arguments = ["match", "a.json", "--on", on, "--free", "k_s,alpha", "--json"];
        let run = lcm_in(folder.path(), &arguments, b"");
        let json: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
        let [before, after] = ["before", "after"].map(|key| json[key].as_f64().expect("a number"));
        assert!(after < 0.6 * before, "{json:#}");
        assert!(
            json["values"]["alpha"].as_i64().is_some_and(|alpha| (50..=160).contains(&alpha)),
            "{json:#}"
        );
    }
}

#[test]
fn the_metric_of_the_lobes_can_be_chosen_and_is_said() {
    let folder = folder();
    let at = folder.path();
    let run = lcm_in(at, &["match", "a.json", "--free", "k_s,alpha", "--metric", "log"], b"");
    assert!(run.out.starts_with("view B matched to view A on the lobe (log)\n"), "{}", run.out);
    assert!(run.out.contains("RMS difference of ln(1 + f cos θ), f in sr⁻¹: "), "{}", run.out);
    let arguments = ["match", "a.json", "--free", "k_s,alpha", "--metric", "cube-root", "--json"];
    let json: serde_json::Value = serde_json::from_str(&lcm_in(at, &arguments, b"").out).expect("JSON");
    assert_eq!((&json["on"], &json["metric"]), (&json!("lobe"), &json!("cube-root")));
    assert_eq!(json["unit"], json!(Metric::CubeRoot.unit()));
    refused(
        &lcm_in(at, &["match", "a.json", "--on", "picture", "--metric", "log"], b""),
        2,
        "--metric log is for lobes, but --on is picture",
    );
    refused(&lcm_in(at, &["match", "a.json", "--metric", "eye"], b""), 2, "invalid value 'eye'");
    let help = lcm_in(at, &["match", "--help"], b"").out;
    for name in ["Ngan", "Löw", "Fores"] {
        assert!(help.contains(name), "{name}: {help}");
    }
}

/// Runs `lcm match` on a terminal, with Ctrl+C after so many seconds.
#[cfg(target_os = "linux")]
fn interrupted(at: &Path, seconds: u32, arguments: &str) -> (Option<i32>, String) {
    // Whoever runs the tests may ignore some signals, and programs respect that.
    let command = format!(
        "timeout --foreground --preserve-status -s INT {seconds} env --default-signal=INT taskset -c 0 {} match {arguments}",
        env!("CARGO_BIN_EXE_lcm")
    );
    let mut script = std::process::Command::new("script");
    script.args(["-qec", &command, "/dev/null"]).current_dir(at);
    let output = script.stdin(std::process::Stdio::null()).output().expect("script is a part of every Linux");
    (output.status.code(), String::from_utf8_lossy(&output.stdout).into_owned())
}

/// A scene whose pictures take long to match: four objects of many polygons with all parameters of `disney`, lit by a photometric lamp.
fn slow(at: &Path) {
    let mut scene: serde_json::Value =
        serde_json::from_str(include_str!("../../../scenes/photometric_lamps.json")).expect("JSON");
    scene["objects"] = (0..4)
        .map(|i| {
            json!({
                "type": "superellipsoid", "position": [1.5 + 2.0 * f64::from(i), 4, 3], "size": 0.8,
                "tessellation": 256, "material": {},
            })
        })
        .collect();
    scene["reflection_model"] = json!("blinn_phong");
    scene["variants"] = json!([{ "reflection_model": "disney" }]);
    fs::write(at.join("wall_washer.ies"), include_str!("../../../scenes/wall_washer.ies")).expect("writable");
    fs::write(at.join("slow.json"), scene.to_string()).expect("writable");
}

/// A search ends with the nearest that it found, at Ctrl+C and at the time that it was given.
#[test]
#[cfg(target_os = "linux")]
fn a_long_search_ends_when_it_should_with_the_best_so_far() {
    let folder = folder();
    let at = folder.path();
    slow(at);
    let arguments = "slow.json --on picture --free base_colour,metallic,roughness,specular,sheen,clearcoat";
    let (status, said) = interrupted(at, 4, arguments);
    assert_eq!(status, Some(130), "{said}");
    assert!(said.contains("matching, ") && said.contains("; Ctrl+C ends it"), "{said}");
    assert!(
        said.contains("view B matched to view A") && said.contains("the search was interrupted"),
        "{said}"
    );
    let all = [
        &["match"],
        &*arguments.split(' ').collect::<Vec<_>>(),
        &["--seconds", "2", "-o", "b.json", "--json"],
    ];
    let begun = std::time::Instant::now();
    let run = lcm_in(at, &all.concat(), b"");
    assert!(begun.elapsed() < std::time::Duration::from_secs(20), "{:?}", begun.elapsed());
    assert_eq!((run.status, at.join("b.json").exists()), (Some(0), true), "{}", run.err);
    let json: serde_json::Value = serde_json::from_str(&run.out).expect("JSON");
    assert_eq!(json["ended"], "time", "{json:#}");
    assert!(json["after"].as_f64() < json["before"].as_f64(), "{json:#}");
    refused(&lcm_in(at, &["match", "a.json", "--seconds", "0"], b""), 2, "--seconds");
}

/// Ctrl+C ends the work with what it has, as the status says.
#[test]
#[cfg(target_os = "linux")]
fn every_model_is_matched_until_ctrl_c() {
    let folder = folder();
    let run = |arguments: &str| interrupted(folder.path(), 4, &format!("a.json --each {arguments}"));
    let (status, said) = run("--metric log");
    assert_eq!(status, Some(130), "{said}");
    assert!(said.contains("RMS difference of ln(1 + f cos θ), f in sr⁻¹\r\n"), "{said}");
    assert!(said.contains("  lambert") && said.contains("interrupted before "), "{said}");
    assert!(said.contains(" % matching, ") && said.contains(" so far; Ctrl+C ends it"), "{said}");
    let (status, said) = run("--json --quiet");
    assert_eq!(status, Some(130), "{said}");
    let json: serde_json::Value = serde_json::from_str(&said).expect("JSON");
    assert_eq!((&json["on"], &json["metric"]), (&json!("lobe"), &json!("cosine")));
    let count = |key: &str| json[key].as_array().map_or(0, Vec::len);
    assert!(count("models") > 0 && count("unfinished") > 0, "{json:#}");
}

#[test]
fn what_cannot_be_matched_has_a_message_and_an_exit_status() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("alone.json"), {
        let alone = Scene { variants: Vec::new(), ..scene() };
        lights_camera_models::scene::save::to_json(&alone, None, &Registry::builtin())
    })
    .expect("writable");
    let alone = "alone.json: the scene has no variants, so there is no view to match to view A";
    refused(&lcm_in(at, &["match", "alone.json"], b""), 1, alone);
    let view = "a.json: --view: there is no view \"D\"; it must be A or B (half)";
    refused(&lcm_in(at, &["match", "a.json", "--view", "D"], b""), 1, view);
    fs::write(at.join("plain.json"), {
        let mut plain = Scene { reflection_model: "burley_diffuse".to_owned(), ..scene() };
        plain.variants[0].reflection_model = Some("lambert".to_owned());
        lights_camera_models::scene::save::to_json(&plain, None, &Registry::builtin())
    })
    .expect("writable");
    let plain = "error: no parameter of view B is free by default; name some with --free: base_colour\n";
    refused(&lcm_in(at, &["match", "plain.json"], b""), 2, plain);
    let free = "--free: \"shine\" is free, but view B has no such parameter; free some of base_colour,";
    refused(&lcm_in(at, &["match", "a.json", "--free", "shine"], b""), 2, free);
    refused(&lcm_in(at, &["match", "a.json", "--on", "paper"], b""), 2, "invalid value 'paper'");
    refused(&lcm_in(at, &["match", "a.json", "--overwrite"], b""), 2, "--output");
    refused(&lcm_in(at, &["match"], b""), 2, "required");
    refused(&lcm_in(at, &["match", "none.json"], b""), 1, "none.json: file not found");
    let folder = lcm_in(at, &["match", "a.json", "--on", "highlight", "-o", "a.json/b.json"], b"");
    // Before the search, so that no result is lost.
    assert_eq!((folder.status, &*folder.out), (Some(4), ""));
    assert!(folder.err.contains("a.json is not a folder"), "{}", folder.err);
    let made = lcm_in(at, &["match", "a.json", "--on", "highlight", "-o", "x/b.json"], b"");
    assert!(made.status == Some(0) && at.join("x/b.json").is_file(), "{}", made.err);
    assert!(made.out.contains("alpha: 32 → 129"), "{}", made.out);
}

// ── the window ──

fn compared() -> Bench {
    let mut bench = Bench::new(Session::new(scene()));
    bench.apply(Action::Compare(CompareCommand::Layout(
        lights_camera_models::scene::comparison::Layout::SideBySide,
    )));
    bench
}

/// Opens the question how to match a view with this model.
pub fn ask(bench: &mut Bench, model: &str) {
    let layout = lights_camera_models::scene::comparison::Layout::SideBySide;
    bench.apply(Action::Compare(CompareCommand::Layout(layout)));
    bench.apply(Action::Edit(Edit::set(Part::Scene, Scene::reflection_model, model.to_owned())));
    bench.apply(Action::Match(MatchCommand::Ask(1)));
}

/// Runs the match, which has ended in the next frame.
pub fn run(bench: &mut Bench) {
    bench.apply(Action::Match(MatchCommand::Close));
    let values = vec![("k_s", Value::Number(0.3)), ("alpha", Value::Integer(128))];
    let found = Match { values, kept: vec!["k_a"], before: 0.0312, after: 0.00204, ..Match::default() };
    let scene = (*bench.session.document).clone();
    bench.session.matched(&scene, (1, What::Lobe.into()), Some(Ok(found)), &bench.registry);
    bench.session.facts.matching =
        Some(Running { label: 1, done: 0.4, step: "descending from start 2 of 5".to_owned() });
    bench.settle();
}

#[test]
fn the_menu_of_a_view_asks_how_it_shall_be_matched() {
    let mut bench = compared();
    bench.click("Menu of view A");
    assert!(bench.find("Match A to A…").is_none());
    bench.key(Key::Escape, Modifiers::NONE);
    bench.click("Menu of view B");
    bench.click("Match B to A…");
    assert!(bench.says("Match B to A") && bench.says("Free parameters of view B"));
    assert!(bench.says(What::Lobe.summary()));
    bench.click("Metric: log");
    let log = Measure { what: What::Lobe, metric: Metric::Log };
    assert_eq!(bench.session.match_draft.as_ref().map(|draft| draft.measure), Some(log));
    bench.click("Metric: cosine");
    bench.click("Compare: picture");
    assert!(bench.find("Metric: log").is_none());
    assert!(bench.says(What::Picture.summary()));
    // Numbers are free, colours are not.
    bench.click("Free: ambient coefficient");
    bench.click("Free: specular colour");
    bench.click("Match");
    let expected = Effect::Match {
        view: 1,
        measure: What::Picture.into(),
        parameters: vec!["specular_colour", "k_d", "k_s", "alpha"],
    };
    assert_eq!(bench.effects, [expected]);
    assert!(bench.session.match_draft.is_none());
}

#[test]
fn a_question_without_an_answer_is_closed() {
    let mut bench = compared();
    let ask = Action::Match(MatchCommand::Ask(1));
    bench.apply(ask.clone());
    bench.key(Key::Escape, Modifiers::NONE);
    assert!(bench.session.match_draft.is_none());
    bench.apply(ask.clone());
    // Nothing is free: nothing to start.
    for name in ["ambient coefficient", "diffuse coefficient", "specular coefficient", "shininess"] {
        bench.click(&format!("Free: {name}"));
    }
    assert!(bench.find("Match").is_some_and(|button| button.disabled));
    bench.click("Cancel");
    assert!(bench.session.match_draft.is_none());
    // The view is gone.
    bench.apply(ask);
    bench.apply(Action::Compare(CompareCommand::Remove(1)));
    assert!(bench.session.match_draft.is_none());
    assert_eq!(bench.effects, []);
}

#[test]
fn a_match_says_that_a_limit_ended_the_search() {
    let mut bench = compared();
    let scene = (*bench.session.document).clone();
    let some = vec![("k_s", Value::Number(0.3))];
    for values in [Vec::new(), some] {
        let found = Match { values, ended: Ended::Evaluations, ..Match::default() };
        bench.session.matched(&scene, (1, What::Lobe.into()), Some(Ok(found)), &bench.registry);
        let text = bench.session.messages.last().map(|message| message.text.clone()).unwrap_or_default();
        let end = ". The search ended at its limit of evaluations: fewer free parameters may come nearer.";
        assert!(text.ends_with(end), "{text}");
    }
}

#[test]
fn the_progress_of_a_match_is_shown_and_it_can_be_stopped() {
    let mut bench = compared();
    bench.session.facts.matching =
        Some(Running { label: 1, done: 0.4, step: "descending from start 2 of 5".to_owned() });
    bench.settle();
    assert!(bench.says("Matching B to A"));
    bench.apply(Action::Match(MatchCommand::Ask(1)));
    assert!(bench.session.match_draft.is_none(), "one at a time");
    assert!(bench.session.messages.iter().any(|m| m.text.starts_with("A match is still running")));
    bench.click("Cancel");
    assert_eq!(bench.effects, [Effect::CancelMatch]);
}

/// Runs a match in a windowless window, until it reports the result.
fn matched(app: &mut App, effects: Vec<Effect>) -> (Severity, String) {
    let before = app.world().resource::<Session>().messages.added();
    app.world_mut().resource_mut::<Messages<Effect>>().write_batch(effects);
    for _ in 0..24_000 {
        app.update();
        let messages = &app.world().resource::<Session>().messages;
        if messages.added() > before {
            let last = messages.last().expect("it was added");
            return (last.severity, last.text.clone());
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("the match does not end");
}

#[test]
fn a_match_of_the_window_is_one_step_that_undo_brings_back_and_cancel_leaves_everything() {
    let folder = folder();
    let plugins =
        LabPlugins::default().scene(folder.path().join("a.json")).size(64, 36).exit_after(100_000).headless();
    let mut app = app(plugins.build(), |_| ());
    let start =
        |what: What| Effect::Match { view: 1, measure: what.into(), parameters: vec!["k_s", "alpha"] };
    app.update();
    let before = app.world().resource::<Session>().document.clone();
    assert_eq!(before.variants.len(), 1);

    let said = matched(&mut app, vec![start(What::Picture), Effect::CancelMatch]);
    assert_eq!(said, (Severity::Info, "The match of view B was cancelled; nothing was changed.".to_owned()));
    assert_eq!(*app.world().resource::<Session>().document, *before);

    let (severity, text) = matched(&mut app, vec![start(What::Highlight)]);
    assert_eq!(severity, Severity::Info, "{text}");
    assert!(text.starts_with("View B matched to view A on the highlight: shininess 12"), "{text}");
    let mut session = app.world_mut().resource_mut::<Session>();
    let steps: Vec<_> = session.document.steps().collect();
    assert_eq!(steps, ["Match of view B"]);
    assert!(matches!(session.document.variants[0].material.0["alpha"], Value::Integer(124..=132)));
    assert_eq!(session.document.variants[0].material.0.len(), 1, "what does not matter is not set");
    let registry = Registry::builtin();
    session.apply(Action::Undo, &registry);
    assert_eq!(*session.document, *before);

    // A scene that changes meanwhile is a different one.
    app.world_mut().resource_mut::<Messages<Effect>>().write(start(What::Picture));
    app.update();
    let edit = Edit::set(Part::Variant(0), Variant::exposure, 1.0);
    app.world_mut().resource_mut::<Session>().apply(Action::Edit(edit), &registry);
    let (severity, text) = matched(&mut app, Vec::new());
    assert_eq!(severity, Severity::Warning);
    assert!(
        text.starts_with("The scene was changed while view B was matched, so nothing was applied"),
        "{text}"
    );
    assert_eq!(app.world().resource::<Session>().document.done(), 1);

    // Views that cannot be matched are reported.
    let unknown = Effect::Match { view: 2, measure: What::Lobe.into(), parameters: vec!["alpha"] };
    let said = matched(&mut app, vec![unknown]);
    let expected = "View C was not matched: there is no view C to match; the scene has 2 views: A and B.";
    assert_eq!(said, (Severity::Error, expected.to_owned()));
}

/// With all numbers of a model free, a view comes at least as close as with any single one.
#[test]
fn more_free_parameters_never_end_worse() {
    let registry = Registry::builtin();
    let cases: [(What, &str, &[(&'static str, Value)], f32); 3] = [
        (What::Highlight, "disney", &[("roughness", Value::Number(0.2))], 0.5),
        (What::Lobe, "disney", &[("roughness", Value::Number(0.06)), ("metallic", Value::Number(1.0))], 0.7),
        (What::Highlight, "blinn_phong", &[("alpha", Value::Integer(200))], 0.5),
    ];
    for (what, model, values, other) in cases {
        let mut scene = Scene { reflection_model: model.to_owned(), ..Scene::default() };
        values.iter().for_each(|(name, value)| scene.objects[0].material.set(*name, value.clone()));
        let mut variant = Variant { reflection_model: Some("disney".to_owned()), ..Variant::default() };
        variant.material.set("roughness", Value::Number(other));
        scene.variants = vec![variant];
        let all: Vec<_> = matching::parameters(&scene, 1, &registry)
            .into_iter()
            .filter(|(_, usual)| *usual)
            .map(|(parameter, _)| parameter.name)
            .collect();
        assert!(all.len() >= 8, "{all:?}");
        let matched = |parameters: &[&str]| {
            let request = Request { scene: &scene, view: 1, measure: what.into(), parameters };
            match_view(&request, &registry, &Progress::NONE).expect("a match")
        };
        let together = matched(&all);
        for alone in ["roughness", "metallic", "specular"] {
            let alone = matched(&[alone]);
            assert!(together.after <= 1.01 * alone.after + 1e-4, "{what:?} {model}: {together:?}\n{alone:?}");
        }
        // Unchanged parameters are reported, and nothing is reported twice.
        let mut told: Vec<_> = together.values.iter().map(|(name, _)| *name).chain(together.kept).collect();
        let mut expected = all.clone();
        told.sort_unstable();
        expected.sort_unstable();
        assert_eq!(told, expected, "{what:?} {model}");
    }
}
