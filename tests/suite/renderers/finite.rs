//! Light that is not finite is reported, with the light or model that produces it, by every command and by
//! the window.

use std::{f32::consts::PI, fs, path::Path, sync::atomic::AtomicBool};

use bevy::app::{App, PluginGroup as _};
use glam::{Vec2, Vec3};
use lights_camera_models::{
    channel::{DebugChannel, Setting},
    document::Selection,
    explain::finite::{NotFinite, Scope, Tried, marked, probe, traced},
    library::assets::{export, read_shaders},
    light::{
        self, Incident, LightRecord, LightType,
        extent::{Sample, Seen},
    },
    optics::{Frame, TermSelection, Terms, sampling},
    panel::state::{Session, Severity},
    parameter::Value,
    parameters,
    reference::{self, Settings},
    reflection::{self, ReflectionModel},
    registry::{Register as _, Registry},
    scene::{
        Light, Object, Scene, Variant, check,
        load::{self, Defaults},
        save,
    },
    shader::Source,
    window::{LabPlugins, ViewOptions},
};

use crate::{
    helpers::pictures::sampled,
    helpers::support::{Run, lcm_in, shipped_scenes},
    library::plugins::app,
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

/// Panes of uniform light with a value that is not a finite number.
macro_rules! pane {
    ($name:ident, $id:literal, $sample:expr, $seen:expr) => {
        parameters! {
            /// A pane that gives no number.
            struct $name {}
        }
        impl LightType for $name {
            const DECLARATION: light::Declaration =
                light::Declaration::new($id, "Pane", Source::new(concat!($id, ".wgsl"), "")).with_extent();
            fn sample(&self, _: &LightRecord, _: Vec3, u: Vec2) -> Sample {
                let good = Sample { l: sampling::sphere(u), radiance: Vec3::ONE, pdf: 0.25 / PI };
                ($sample)(good)
            }
            fn seen(&self, _: &LightRecord, _: Vec3, l: Vec3) -> Seen {
                let good = Seen { radiance: Vec3::ONE, pdf: 0.25 / PI, distance: f32::INFINITY };
                ($seen)(good, l)
            }
        }
    };
}
pane!(Sound, "sound", |s| s, |s, _| s);
pane!(Glare, "glare", |s| Sample { radiance: Vec3::new(1.0, f32::INFINITY, 0.0), ..s }, |s, _| s);
pane!(Needle, "needle", |s| Sample { pdf: f32::INFINITY, ..s }, |s, _| s);
pane!(Astray, "astray", |s| Sample { l: Vec3::NAN, ..s }, |s, _| s);
pane!(Hole, "hole", |s| s, |s, l: Vec3| Seen {
    radiance: if l.y > 0.5 { Vec3::splat(f32::NAN) } else { Vec3::ONE },
    ..s
});
pane!(Blur, "blur", |s| s, |s, _| Seen { pdf: f32::NAN, ..s });
pane!(Minus, "minus", |s| Sample { pdf: -1.0, ..s }, |s, _| s);
pane!(Less, "less", |s| s, |s, _| Seen { pdf: -0.5, ..s });
pane!(Nowhere, "nowhere", |s| s, |s, _| Seen { distance: f32::NAN, ..s });

/// The panes with their faults.
const PANES: [(&str, &str); 8] = [
    ("glare", "radiance in sample at (1, ∞, 0); it must be finite"),
    ("needle", "density in sample at ∞; it must be finite"),
    ("astray", "direction in sample at (NaN, NaN, NaN); it must be finite"),
    ("hole", "radiance in seen at (NaN, NaN, NaN); it must be finite"),
    ("blur", "density in seen at NaN; it must be finite"),
    ("minus", "density in sample at −1; it must be 0 or more"),
    ("less", "density in seen at −0.5; it must be 0 or more"),
    ("nowhere", "distance in seen at NaN; it must be finite"),
];

fn panes() -> Registry {
    let mut registry = Registry::builtin();
    registry.add_light_type::<Sound>().add_light_type::<Glare>().add_light_type::<Needle>();
    registry.add_light_type::<Astray>().add_light_type::<Hole>();
    registry.add_light_type::<Blur>().add_light_type::<Nowhere>();
    registry.add_light_type::<Minus>().add_light_type::<Less>();
    registry
}

/// The default scene with a pane as its second light.
fn behind(pane: &str) -> Scene {
    let mut scene = Scene { shading_model: "phong".to_owned(), ..Scene::default() };
    let window = Light { light_type: pane.to_owned(), name: Some("Window".to_owned()), ..Light::default() };
    scene.lights.push(window);
    scene
}

#[test]
fn a_light_with_extent_is_named_with_what_it_gives() {
    let registry = panes();
    for scope in [Scope::All, Scope::Untested] {
        for (pane, wrong) in PANES {
            let found = probe(&behind(pane), &registry, scope, &mut Tried::default());
            assert_eq!(paths(&found), ["lights[1]"], "{pane}");
            let said = found[0].to_string();
            let (of, value) = wrong.split_once(" at ").expect("both");
            let begins = format!("lights[1] (\"Window\") is of the type {pane}, whose {of} at (");
            assert!(said.starts_with(&begins), "{said}");
            assert!(said.ends_with(&format!(" m is {value}")), "{said}");
        }
        assert_eq!(probe(&behind("sound"), &registry, scope, &mut Tried::default()), []);
    }
}

#[test]
fn pixels_lit_by_such_a_light_lead_to_it_and_not_to_the_model() {
    let registry = panes();
    let settings = Settings { width: 48, height: 27, samples: 1, ..Settings::default() };
    for (pane, shows) in [("glare", true), ("hole", true), ("blur", true), ("sound", false)] {
        let scene = behind(pane);
        let odd = AtomicBool::default();
        let _ = reference::render_rgb8_noting(&scene, &registry, &settings, &odd);
        assert_eq!(odd.into_inner(), shows, "{pane}");
        let eye = scene.observer.position;
        let setting = Setting::new(DebugChannel::NotANumber, &scene, &registry, eye, None);
        let pixels =
            marked(&reference::render_channel(&scene, &registry, &settings, &setting), settings.width);
        let expected: &[&str] = if shows { &["lights[1]"] } else { &[] };
        assert_eq!(paths(&traced(&scene, &registry, &settings, &pixels)), expected, "{pane}");
    }
    // A model that returns NaN is reported under lights with extent too.
    let mut registry = registry;
    registry.add_reflection_model::<Torn>();
    let scene = Scene { reflection_model: "torn".to_owned(), ..behind("sound") };
    let scene = Scene { lights: scene.lights[1..].to_vec(), ..scene };
    let setting = Setting::new(DebugChannel::NotANumber, &scene, &registry, scene.observer.position, None);
    let pixels = marked(&reference::render_channel(&scene, &registry, &settings, &setting), settings.width);
    assert!(!pixels.is_empty());
    assert_eq!(paths(&traced(&scene, &registry, &settings, &pixels)), ["objects[0]"]);
}

/// The text of a light type whose light is not a number.
fn without_numbers(id: &str) -> (&'static str, String) {
    let registry = Registry::builtin();
    let wgsl = registry.light(id).expect("built in").declaration.wgsl;
    let text = wgsl.text.replace("vec3(light.intensity", "vec3(sqrt(-1.0 - light.intensity)");
    assert_ne!(text, wgsl.text);
    (wgsl.path, text)
}

#[test]
fn an_edited_light_type_is_named_though_the_cpu_does_not_draw_it() {
    let settings = Settings { width: 48, height: 27, samples: 1, ..Settings::default() };
    let middle = [[24, 13]];
    for id in ["point", "rectangle"] {
        let mut scene = Scene { shading_model: "phong".to_owned(), ..Scene::default() };
        let (position, direction) = (Some(Vec3::new(5.0, 9.0, 8.0)), Some(Vec3::NEG_Y));
        let on = Light { light_type: id.to_owned(), position, direction, ..Light::default() };
        scene.lights = vec![Light { enabled: false, ..on.clone() }, on];
        let (path, text) = without_numbers(id);
        let mut registry = Registry::builtin();
        registry.sources_mut().edit(path, text);
        for scope in [Scope::All, Scope::Untested] {
            let mut tried = Tried::default();
            let found = probe(&scene, &registry, scope, &mut tried);
            assert_eq!(paths(&found), ["lights[1]"], "{id}");
            let said = found[0].to_string();
            assert!(said.starts_with(&format!("lights[1] is of the type {id}, whose ")), "{said}");
            assert!(said.ends_with(" m is (NaN, NaN, NaN); it must be finite"), "{said}");
            registry.sources_mut().forget(path);
            assert_eq!(probe(&scene, &registry, scope, &mut tried), [], "{id}");
            registry.sources_mut().edit(path, without_numbers(id).1);
        }
        assert_eq!(paths(&traced(&scene, &registry, &settings, &middle)), ["lights[1]"]);
        // What else only the GPU draws is the model's.
        registry.sources_mut().forget(path);
        registry.sources_mut().edit("reflection/lambert.wgsl", "// mine");
        assert_eq!(paths(&traced(&scene, &registry, &settings, &middle)), ["objects[0]"]);
    }
}

/// A folder with `assets`, in which light from points is not a number, and a scene.
fn dazzled() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    export(&folder.path().join("assets"), &Registry::builtin()).expect("written");
    let (path, text) = without_numbers("point");
    fs::write(folder.path().join("assets/shaders").join(path), text).expect("written");
    let scene = Scene { shading_model: "phong".to_owned(), ..Scene::default() };
    let text = save::to_json(&scene, None, &Registry::builtin());
    fs::write(folder.path().join("s.json"), text).expect("written");
    folder
}

#[test]
fn check_and_render_blame_an_edited_light_type() {
    let folder = dazzled();
    let said =
        |arguments: &[&str]| lcm_in(folder.path(), &[arguments, &["--assets", "assets"]].concat(), b"");
    let checked = said(&["check", "s.json"]);
    assert_eq!((checked.status, checked.out.as_str()), (Some(1), ""), "{}", checked.err);
    assert!(checked.err.starts_with("s.json: lights[0] is of the type point, whose "), "{}", checked.err);
    let json: serde_json::Value =
        serde_json::from_str(&said(&["check", "s.json", "--json"]).out).expect("JSON");
    assert_eq!(json[0]["problems"][0]["path"], "lights[0]", "{json}");
    let drawn = said(&["render", "s.json", "-o", "p.png", "--size", "96x54", "--renderer", "gpu"]);
    assert_eq!(drawn.status, Some(0), "{}", drawn.err);
    assert!(drawn.err.contains("lights[0] is of the type point"), "{}", drawn.err);
    assert!(!drawn.err.contains("objects[0]"), "{}", drawn.err);
}

#[test]
fn the_window_blames_an_edited_light_type() {
    let folder = dazzled();
    let mut registry = Registry::builtin();
    read_shaders(&folder.path().join("assets/shaders"), &mut registry).expect("readable");
    let mut options = ViewOptions::default();
    (options.registry, options.open) = (Some(registry), Some(folder.path().join("s.json")));
    let plugins = LabPlugins::new(options).size(120, 90).exit_after(100_000).headless();
    let mut app = app(plugins.build(), |_| {});
    for _ in 0..5 {
        app.update();
    }
    let session = app.world().resource::<Session>();
    let light = session.name_of(Selection::Light(0), app.world().resource::<Registry>());
    let said = format!("{light} is of the type point, whose ");
    assert!(session.messages.iter().any(|m| m.text.starts_with(&said)), "{:?}", session.messages);
    let odd = &session.facts.not_finite[0];
    assert_eq!(odd.iter().map(|odd| odd.part).collect::<Vec<_>>(), [Selection::Light(0)]);
}

fn registry() -> Registry {
    let mut registry = Registry::builtin();
    registry.add_reflection_model::<Torn>();
    registry.add_light_type::<Broken>();
    registry
}

/// A white ball under a lamp, next to a ball with the torn model.
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
        // Known results are not tried again, but reported again.
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

/// The window with a scene and [`Torn`], after its first frames.
fn window_with(file: &Path) -> App {
    let plugins = LabPlugins::default().scene(file).size(120, 90).exit_after(100_000).headless();
    let mut app = app(plugins.build(), |app| {
        app.add_reflection_model::<Torn>();
    });
    for _ in 0..5 {
        app.update();
    }
    app
}

#[test]
fn the_window_knows_which_view_has_light_that_is_no_number() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("s.json");
    let override_of_b = Variant { reflection_model: Some("torn".to_owned()), ..Variant::default() };
    let scene =
        Scene { shading_model: "phong".to_owned(), variants: vec![override_of_b], ..Scene::default() };
    fs::write(&file, save::to_json(&scene, None, &registry())).expect("written");
    let app = window_with(&file);
    let session = app.world().resource::<Session>();
    let odd = session.facts.not_finite.each_ref().map(Vec::len);
    assert_eq!(odd[..2], [0, 1], "{:?}", session.messages);
    let name = session.name_of(Selection::Object(0), &registry());
    let said = session.messages.iter().find(|m| m.text.contains("must be finite")).expect("a message");
    assert!(said.text.starts_with(&format!("{name} has the reflection model torn")), "{}", said.text);
}

/// A custom model that is finite only for light at more than 37° to the normal.
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
    let place = "it must be finite: response at models/torn_file.wgsl:5:4";
    assert!(said.err.contains(place), "{}", said.err);
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
        assert!(drawn.err.contains(place), "{}", drawn.err);
    }
}

/// A custom model that divides by zero, which drivers may evaluate to anything.
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
    // Nothing is reported about finite light.
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
    let app = window_with(&file);
    let session = app.world().resource::<Session>();
    let said: Vec<_> = session.messages.iter().filter(|m| m.text.contains("must be finite")).collect();
    assert_eq!(said.len(), 1, "{:?}", session.messages);
    assert_eq!(said[0].severity, Severity::Warning);
    // By the name in the list of the scene, not by the path in the file.
    assert!(said[0].text.starts_with("Bad has the reflection model torn"), "{}", said[0].text);
    let odd = &session.facts.not_finite;
    assert_eq!(odd[0].iter().map(|odd| odd.part).collect::<Vec<_>>(), [Selection::Object(1)]);
    assert!(odd[1..].iter().all(Vec::is_empty));
}

#[test]
fn a_lamp_within_an_object_lights_nothing_of_it_and_one_that_reaches_out_lights_what_is_around() {
    let registry = Registry::builtin();
    let settings = Settings { width: 48, height: 48, samples: 1, terms: TermSelection::All };
    let drawn = |place: Vec3, radius: f32| {
        let mut scene = Scene { shading_model: "phong".to_owned(), ..Scene::default() };
        let lamp = &mut scene.lights[0];
        lamp.light_type = "sphere".to_owned();
        (lamp.position, lamp.intensity) = (Some(place), 1.0);
        lamp.parameters.set("radius", Value::Number(radius));
        assert_eq!(check::scene(&scene, &registry), [], "{place}");
        sampled(&scene, &registry, &settings, 32)
    };
    // The centres of lamp and object differ by a little, for they must not be equal.
    let hidden = drawn(Vec3::new(5.0, 5.1, 5.0), 0.3);
    let middle = 3 * (24 * 48 + 24);
    assert_eq!(hidden[middle..middle + 3], [0, 0, 0]);
    let reaches = drawn(Vec3::new(5.0, 5.4, 5.6), 0.6);
    let background = reaches[0];
    let lit = reaches.iter().filter(|code| (1..255).contains(*code) && **code != background).count();
    assert!(reaches.contains(&255) && reaches.contains(&0) && lit > 30, "{lit}");
}
