//! Light that is not finite is reported with the light or model that gives it, by every command and by the window.

use std::{fs, path::Path, sync::atomic::AtomicBool};

use bevy::app::PluginGroup as _;
use glam::Vec3;
use lights_camera_models::{
    channel::{DebugChannel, Setting},
    explain::finite::{NotFinite, Scope, Tried, marked, probe, traced},
    light::{self, Incident, LightRecord, LightType},
    optics::{Frame, Terms},
    panel::state::{Session, Severity},
    parameters,
    reference::{self, Settings},
    reflection::{self, ReflectionModel},
    registry::{Register as _, Registry},
    scene::{
        Light, Object, Scene,
        load::{self, Defaults},
        save,
    },
    shader::Source,
    window::LabPlugins,
};

use crate::{
    plugins::app,
    support::{Run, lcm_in, shipped_scenes},
};

parameters! {
    /// Paper that gives no number where light is steep.
    struct Torn {}
}

impl ReflectionModel for Torn {
    const DECLARATION: reflection::Declaration = reflection::Declaration::new(
        "torn",
        "Torn",
        Source::new(
            "torn.wgsl",
            "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let c = max(dot(frame.n, l), 0.0);
    return Terms(vec3(0.0), vec3(select(c, sqrt(0.5 - c), c > 0.8)), vec3(0.0));
}
fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> { return vec3(1.0); }
",
        ),
    );
    fn response(&self, l: Vec3, _: Vec3, frame: &Frame) -> Terms {
        let c = frame.n.dot(l).max(0.0);
        let c = if c > 0.8 { (0.5 - c).sqrt() } else { c };
        Terms { diffuse: Vec3::splat(c), ..Terms::default() }
    }
    fn ambient_response(&self, _: Vec3, _: &Frame) -> Vec3 {
        Vec3::ONE
    }
}

parameters! {
    /// A lamp that divides by no distance.
    struct Broken {}
}

impl LightType for Broken {
    const DECLARATION: light::Declaration = light::Declaration::new(
        "broken",
        "Broken",
        Source::new(
            "broken.wgsl",
            "fn incident_broken(light: Light, p: vec3<f32>) -> Incident {
    let d = light.position - light.position;
    return Incident(vec3(0.0, 1.0, 0.0), vec3(light.intensity / dot(d, d)), 0u);
}
",
        ),
    )
    .at_position()
    .candela(10.0, 100.0);
    fn incident(&self, light: &LightRecord, _: Vec3) -> Incident {
        let none = 0.0 * light.position.length_squared();
        Incident::From { l: Vec3::Y, intensity: Vec3::splat(light.intensity / none) }
    }
}

fn registry() -> Registry {
    let mut registry = Registry::builtin();
    registry.add_reflection_model::<Torn>();
    registry.add_light_type::<Broken>();
    registry
}

/// A white ball under a lamp, with a torn one beside it.
fn torn() -> Scene {
    let ball = |x: f32, name: &str, model: Option<&str>| Object {
        position: Vec3::new(x, 5.0, 5.0),
        size: 1.5,
        name: Some(name.to_owned()),
        reflection_model: model.map(str::to_owned),
        shading_model: Some("phong".to_owned()),
        ..Object::default()
    };
    Scene { objects: vec![ball(4.0, "Good", None), ball(6.0, "Bad", Some("torn"))], ..Scene::default() }
}

fn broken() -> Scene {
    let mut scene = Scene::default();
    let lamp =
        Light { light_type: "broken".to_owned(), name: Some("Flare".to_owned()), ..scene.lights[0].clone() };
    scene.lights.push(lamp);
    scene
}

fn paths(found: &[NotFinite]) -> Vec<String> {
    found.iter().map(|odd| odd.path.to_string()).collect()
}

#[test]
fn a_probe_names_the_light_and_the_model() {
    let registry = registry();
    for scope in [Scope::All, Scope::Untested] {
        let mut tried = Tried::default();
        let found = probe(&torn(), &registry, scope, &mut tried);
        assert_eq!(paths(&found), ["objects[1]"]);
        let said = found[0].to_string();
        let expected =
            "objects[1] (\"Bad\") has the reflection model torn, which gives (NaN, NaN, NaN) for light at 0°";
        assert!(said.starts_with(expected), "{said}");
        // What is known is not tried again, and is said again.
        assert_eq!(probe(&torn(), &registry, scope, &mut tried), found);
        let found = probe(&broken(), &registry, scope, &mut tried);
        assert_eq!(paths(&found), ["lights[1]"]);
        let said = found[0].to_string();
        assert!(said.contains("lights[1] (\"Flare\") is of the type broken, whose intensity at ("), "{said}");
        assert!(said.contains("is (∞, ∞, ∞); it must be finite"), "{said}");
    }
}

#[test]
fn no_scene_that_ships_is_reported() {
    let registry = Registry::builtin();
    for path in shipped_scenes() {
        let scene = load::file(&path, &registry, Defaults::Use).expect("legal").scene;
        let found = probe(&scene, &registry, Scope::All, &mut Tried::default());
        assert_eq!(found, [], "{}", path.display());
    }
}

#[test]
fn the_cpu_renderer_notes_it_and_pixels_lead_to_it() {
    let registry = registry();
    let settings = Settings { width: 160, height: 90, samples: 1, ..Settings::default() };
    for (scene, expected) in
        [(torn(), vec!["objects[1]"]), (broken(), vec!["lights[1]"]), (Scene::default(), vec![])]
    {
        let odd = AtomicBool::default();
        let picture = reference::render_rgb8_noting(&scene, &registry, &settings, &odd);
        assert_eq!(picture, reference::render_rgb8(&scene, &registry, &settings));
        assert_eq!(odd.into_inner(), !expected.is_empty());
        let eye = scene.observer.position;
        let setting = Setting::new(DebugChannel::NotANumber, &scene, &registry, eye, None);
        let channel = reference::render_channel(&scene, &registry, &settings, &setting);
        let pixels = marked(&channel, settings.width);
        assert_eq!(pixels.is_empty(), expected.is_empty());
        assert_eq!(paths(&traced(&scene, &registry, &settings, &pixels)), expected);
    }
}

/// A custom model of which light at more than 37° to the normal alone is finite.
const TORN: &str = r#"/* lcm
{ "name": "Torn file", "summary": "Torn.", "equation": [{ "term": "diffuse", "text": "I_d = √(0.5 − N·L)" }],
  "laws": [], "parameters": ["base_colour"] }
*/
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    let c = max(dot(frame.n, l), 0.0);
    return Terms(vec3(0.0), m.base_colour * select(c, sqrt(0.5 - c), c > 0.8), vec3(0.0));
}
fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> { return m.base_colour; }
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("models")).expect("made");
    fs::write(folder.path().join("models/torn_file.wgsl"), TORN).expect("written");
    let text = save::to_json(&torn(), None, &Registry::builtin());
    fs::write(folder.path().join("s.json"), text.replace("\"torn\"", "\"torn_file\"")).expect("written");
    folder
}

fn run(folder: &Path, arguments: &[&str]) -> Run {
    lcm_in(folder, &[arguments, &["--models", "models"]].concat(), b"")
}

#[test]
fn check_and_render_report_a_custom_model_that_gives_no_number() {
    let folder = folder();
    let said = run(folder.path(), &["check", "s.json"]);
    assert_eq!((said.status, said.out.as_str()), (Some(1), ""), "{}", said.err);
    let expected = "s.json: objects[1] (\"Bad\") has the reflection model torn_file, which gives (NaN, NaN, NaN) for \
                    light at 0°";
    assert!(said.err.starts_with(expected), "{}", said.err);
    let json = run(folder.path(), &["check", "s.json", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!((json.status, &report[0]["valid"]), (Some(1), &serde_json::json!(false)));
    assert!(report[0]["problems"][0]["message"].as_str().expect("a text").contains("torn_file"));

    for renderer in ["cpu", "gpu"] {
        let arguments = ["render", "s.json", "-o", "p.png", "--size", "160x90", "--renderer", renderer];
        let drawn = run(folder.path(), &arguments);
        assert_eq!(drawn.status, Some(0), "{}", drawn.err);
        let count =
            drawn.err.strip_prefix("s.json: ").and_then(|rest| rest.split_once(" pixels of 160×90 are"));
        let count: u32 = count.and_then(|(count, _)| count.parse().ok()).unwrap_or_default();
        assert!((20..2000).contains(&count), "{renderer}: {}", drawn.err);
        let whose = "objects[1] (\"Bad\") has the reflection model torn_file";
        assert!(drawn.err.contains(whose) && !drawn.err.contains("objects[0]"), "{}", drawn.err);
    }
}

/// A custom model that divides by zero, which drivers may take for anything.
const DIVIDED: &str = r#"/* lcm
{ "name": "Divided", "laws": [], "parameters": ["base_colour"] }
*/
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), m.base_colour / (dot(frame.n, l) * 0.0), vec3(0.0));
}
"#;

#[test]
fn no_renderer_is_silent_about_what_a_driver_makes_finite() {
    let folder = folder();
    fs::write(folder.path().join("models/torn_file.wgsl"), DIVIDED).expect("written");
    for renderer in ["cpu", "gpu"] {
        for more in [&["--samples", "4"][..], &["--channel", "not_a_number"]] {
            let arguments = ["render", "s.json", "-o", "p.png", "--size", "96x54", "--renderer", renderer];
            let drawn = run(folder.path(), &[&arguments[..], more].concat());
            assert_eq!(drawn.status, Some(0), "{}", drawn.err);
            let whose =
                "objects[1] (\"Bad\") has the reflection model torn_file, which gives (∞, ∞, ∞) for light";
            assert!(drawn.err.contains(whose), "{renderer} {more:?}: {}", drawn.err);
            assert!(drawn.err.contains("finite") && !drawn.err.contains("objects[0]"), "{}", drawn.err);
        }
    }
    // Nothing is said of what is finite.
    fs::write(folder.path().join("models/torn_file.wgsl"), DIVIDED.replace(" * 0.0", " * 0.0 + 1.0"))
        .expect("written");
    let drawn =
        run(folder.path(), &["render", "s.json", "-o", "p.png", "--size", "96x54", "--renderer", "gpu"]);
    assert_eq!((drawn.status, drawn.err.as_str()), (Some(0), "wrote p.png\n"));
}

#[test]
fn the_window_says_once_which_model_gives_no_number() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("s.json");
    fs::write(&file, save::to_json(&torn(), None, &registry())).expect("written");
    let plugins = LabPlugins::default().scene(&file).size(120, 90).exit_after(100_000).headless();
    let mut app = app(plugins.build(), |app| {
        app.add_reflection_model::<Torn>();
    });
    for _ in 0..5 {
        app.update();
    }
    let session = app.world().resource::<Session>();
    let said: Vec<_> = session.messages.iter().filter(|m| m.text.contains("must be finite")).collect();
    assert_eq!(said.len(), 1, "{:?}", session.messages);
    assert_eq!(said[0].severity, Severity::Warning);
    let expected = "objects[1] (\"Bad\") has the reflection model torn";
    assert!(said[0].text.starts_with(expected), "{}", said[0].text);
}
