//! The window as plugins: each part can be left out, registered types are known everywhere, and the order of
//! systems is checked. Tests that need a window run in a separate process, on a virtual screen: [`stage`].

use std::{
    collections::BTreeSet,
    env, fs,
    path::Path,
    process::{Command, ExitCode, Output},
};

use bevy::{
    app::{App, AppExit, PluginGroup as _, PluginGroupBuilder, PluginsState, Update},
    ecs::{
        prelude::*,
        schedule::{ScheduleBuildError, Schedules},
    },
    log::LogPlugin,
    transform::components::Transform,
    winit::WinitPlugin,
};
use bevy_egui::EguiPlugin;
use lights_camera_models::{
    cli,
    light::Spot,
    panel::{PanelApp as _, PanelPlugin, Panels, state::Session},
    registry::{Register, Registry},
    render::{
        drawn::Drawn,
        parts::{LightColour, LightPower, SceneLight, SceneObject},
        schedule::{LabFrame, LabSystems, strict},
        view::Drawing,
    },
    scene::formats::SceneFormats as _,
    window::{
        CameraPlugin, CapturePlugin, ClippingPlugin, DifferencePlugin, DocumentPlugin, GizmosPlugin,
        LabPlugins, PickingPlugin, PicturePlugin, RecoveryPlugin, RequirementsPlugin, ShaderFilesPlugin,
        ShellPlugin, WatchingPlugin,
    },
};

use crate::{
    helpers::pictures::{compare, on_gpu},
    helpers::screen::{Picture, Screen, alone},
};

#[path = "../../../examples/extension/src/main.rs"]
#[allow(dead_code)]
pub mod extension;
#[path = "../../../examples/lamp.rs"]
#[allow(dead_code)]
pub mod lamp;
#[path = "../../../examples/light.rs"]
#[allow(dead_code)]
pub mod light;
#[path = "../../../examples/shading_model.rs"]
#[allow(dead_code)]
pub mod shading_model;
#[path = "../../../examples/shape.rs"]
#[allow(dead_code)]
pub mod shape;
#[path = "../../../examples/window.rs"]
#[allow(dead_code)]
pub mod window;

use window::{panel, toon};

const SCENE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/shapes_and_lights.json");

/// An app that can be driven frame by frame.
pub fn app(plugins: PluginGroupBuilder, extend: impl FnOnce(&mut App)) -> App {
    let mut app = App::new();
    app.add_plugins(plugins.disable::<LogPlugin>());
    extend(&mut app);
    while app.plugins_state() == PluginsState::Adding {
        std::thread::yield_now();
    }
    app.finish();
    app.cleanup();
    app
}

/// All parts of the window, without the window itself and the user's data.
pub fn whole() -> PluginGroupBuilder {
    LabPlugins::default()
        .build()
        .disable::<WinitPlugin>()
        .disable::<RequirementsPlugin>()
        .disable::<RecoveryPlugin>()
        .set(DocumentPlugin::default())
}

fn count<T: Component>(app: &mut App) -> usize {
    app.world_mut().query::<&T>().iter(app.world()).count()
}

/// Runs frames until the picture is drawn.
pub fn draw(app: &mut App) {
    let done = |app: &mut App| {
        let mut views = app.world_mut().query::<&Drawing>();
        views.iter(app.world()).next().is_some_and(Drawing::is_done)
    };
    for _ in 0..6000 {
        app.update();
        if done(app) {
            return;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    panic!("no picture");
}

#[test]
fn each_part_can_be_left_out_and_the_rest_runs() {
    type Less = fn(PluginGroupBuilder) -> PluginGroupBuilder;
    let parts: [(&str, Less); 5] = [
        ("nothing", |group| group),
        ("gizmos", |group| group.disable::<GizmosPlugin>()),
        ("watching", |group| group.disable::<WatchingPlugin>()),
        ("shader files", |group| group.disable::<ShaderFilesPlugin>()),
        ("capture", |group| group.disable::<CapturePlugin>()),
    ];
    for (part, less) in parts {
        let mut app = app(less(LabPlugins::default().scene(SCENE).size(64, 36).headless().build()), |_| ());
        draw(&mut app);
        assert_eq!(app.world().resource::<Session>().title(), "Shapes and lights", "without {part}");
        assert_eq!(count::<SceneObject>(&mut app), count::<Drawn>(&mut app), "without {part}");
        assert!(count::<Drawn>(&mut app) > 2, "without {part}");
    }
}

#[test]
fn each_part_of_the_window_can_be_left_out_and_the_rest_runs() {
    type Less = fn(PluginGroupBuilder) -> PluginGroupBuilder;
    let parts: [(&str, Less); 9] = [
        ("panels", |group| group.disable::<PanelPlugin>()),
        ("egui", |group| group.disable::<PanelPlugin>().disable::<EguiPlugin>()),
        ("camera", |group| group.disable::<CameraPlugin>()),
        ("picking", |group| group.disable::<PickingPlugin>()),
        ("camera and picking", |group| group.disable::<CameraPlugin>().disable::<PickingPlugin>()),
        ("clipping", |group| group.disable::<ClippingPlugin>()),
        ("difference", |group| group.disable::<DifferencePlugin>()),
        ("shell", |group| group.disable::<ShellPlugin>()),
        ("picture", |group| group.disable::<PicturePlugin>()),
    ];
    for (part, less) in parts {
        let mut app = app(less(whole()), |_| ());
        (0..6).for_each(|_| app.update());
        assert_eq!(count::<SceneObject>(&mut app), 1, "without {part}");
        assert_eq!(app.world().contains_resource::<Panels>(), !["panels", "egui"].contains(&part), "{part}");
    }
}

#[test]
fn what_is_registered_after_the_plugins_is_known_to_the_scene_that_they_open() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("toon.json");
    let text = fs::read_to_string(SCENE).expect("there");
    fs::write(&file, toon_scene(&text)).expect("writable");
    let plugins = LabPlugins::default().scene(&file).size(64, 36).headless();
    let mut toon = app(plugins.clone().build(), |app| {
        app.add_reflection_model::<toon::Toon>();
    });
    draw(&mut toon);
    assert_eq!(toon.world().resource::<Session>().document.reflection_model, "toon");
    assert!(toon.world_mut().query::<&Drawn>().iter(toon.world()).all(|drawn| drawn.model() == "toon"));
    // Without it, the scene is refused and the reason is kept.
    let without = app(plugins.build(), |_| ());
    let session = without.world().resource::<Session>();
    assert!(session.messages.iter().any(|m| m.text.contains("toon")), "{:?}", session.messages);
    assert_ne!(session.document.reflection_model, "toon");
}

/// A scene with the model of the example.
fn toon_scene(text: &str) -> String {
    let mut scene: serde_json::Value = serde_json::from_str(text).expect("JSON");
    scene["reflection_model"] = "toon".into();
    if let Some(objects) = scene["objects"].as_array_mut() {
        for object in objects {
            object.as_object_mut().map(|o| o.remove("reflection_model"));
        }
    }
    scene.to_string()
}

#[test]
fn a_batch_writes_its_picture_and_ends() {
    let folder = tempfile::tempdir().expect("a folder");
    let batch = |file: &Path| {
        let plugins =
            LabPlugins::default().scene(SCENE).size(320, 180).exit_after(8).capture(file).headless();
        App::new().add_plugins(plugins.build().disable::<LogPlugin>()).run()
    };
    let file = folder.path().join("picture.png");
    assert_eq!(batch(&file), AppExit::Success);
    let picture = Picture::read(&file);
    assert_eq!((picture.width, picture.height), (320, 180));
    assert!(picture.colours(0..320, 0..180) > 300, "there is a picture");
    let nowhere = folder.path().join("picture.png/picture.png");
    assert_eq!(batch(&nowhere), AppExit::from_code(4), "a picture that cannot be written is an error");
}

// ── the order of systems ──

#[derive(Resource, Default)]
struct Shared(u32);

fn one(mut shared: ResMut<Shared>) {
    shared.0 += 1;
}

fn other(mut shared: ResMut<Shared>) {
    shared.0 *= 2;
}

fn dim(mut lights: Query<&mut SceneLight>) {
    lights.iter_mut().for_each(|mut light| light.power = LightPower::Intensity(1.0));
}

fn tint(mut lights: Query<&mut SceneLight>) {
    lights.iter_mut().for_each(|mut light| light.colour = LightColour::Rgb([9; 3]));
}

/// Builds the schedule of the lab anew.
fn built(app: &mut App) -> Result<(), String> {
    let mut schedule =
        app.world_mut().resource_mut::<Schedules>().remove(LabFrame).expect("the lab has a schedule");
    let said = schedule.initialize(app.world_mut());
    let said = said
        .map(drop)
        .map_err(|error: ScheduleBuildError| error.to_string(schedule.graph(), app.world()).to_string());
    app.world_mut().resource_mut::<Schedules>().insert(schedule);
    said
}

#[test]
fn no_two_systems_of_the_lab_leave_open_which_comes_first() {
    let mut app = app(whole(), strict);
    assert_eq!(built(&mut app), Ok(()));
    app.update();
}

#[test]
fn two_systems_that_leave_their_order_open_are_found() {
    let with = |systems: fn(&mut App)| {
        let mut app = app(whole(), |app| {
            strict(app);
            app.init_resource::<Shared>();
            systems(app);
        });
        built(&mut app)
    };
    let both = with(|app| {
        app.add_systems(LabFrame, (one, other));
    });
    let said = both.expect_err("they write the same");
    assert!(said.contains("one") && said.contains("other") && said.contains("Shared"), "{said}");
    let ordered = with(|app| {
        app.add_systems(
            LabFrame,
            (
                one.after(LabSystems::Spawn).before(LabSystems::Edit),
                other.after(LabSystems::Edit).before(LabSystems::Swap),
            ),
        );
    });
    assert_eq!(ordered, Ok(()));
}

#[test]
fn systems_of_others_run_before_and_after_the_sets_of_the_lab() {
    let mut app = app(LabPlugins::default().size(64, 36).headless().build(), |app| {
        app.init_resource::<Shared>().add_systems(
            LabFrame,
            (
                // There are no entities yet before the first spawning.
                (|objects: Query<&SceneObject>, mut s: ResMut<Shared>| s.0 = objects.iter().count() as u32)
                    .before(LabSystems::Spawn),
                (|objects: Query<&SceneObject>, mut s: ResMut<Shared>| {
                    s.0 = 10 * s.0 + objects.iter().count() as u32;
                })
                .after(LabSystems::Spawn)
                .before(LabSystems::Edit),
            ),
        );
    });
    app.update();
    assert_eq!(app.world().resource::<Shared>().0, 1);
    app.update();
    assert_eq!(app.world().resource::<Shared>().0, 11);
}

// ── programs ──

/// The variable that tells a child process which of the [`programs`](stage) it runs.
const STAGE: &str = "LCM_TEST_STAGE";

/// The file written by a stage, and the arguments of a stage that is a command line.
const FILE: &str = "LCM_TEST_FILE";
const ARGUMENTS: &str = "LCM_TEST_ARGUMENTS";

/// Programs started by tests: not a test unless the environment selects one.
#[test]
fn stage() {
    let Ok(program) = env::var(STAGE) else { return };
    let file = || env::var(FILE).expect("a file");
    let window = || LabPlugins::default().scene(SCENE).size(640, 480).exit_after(12).capture(file());
    match &*program {
        "window" => drop(window::main()),
        "panel" => drop(panel::main()),
        "animate" => drop(crate::library::animation::animate::main()),
        "lamp" => drop(lamp::main()),
        "light" => drop(light::main()),
        "shading_model" => drop(shading_model::main()),
        "shape" => drop(shape::main()),
        "without panels" => {
            let plugins = window().build().disable::<PanelPlugin>().disable::<EguiPlugin>();
            assert_eq!(App::new().add_plugins(plugins).run(), AppExit::Success);
        }
        "without gizmos and watching" => {
            let plugins = window().build().disable::<GizmosPlugin>().disable::<WatchingPlugin>();
            assert_eq!(App::new().add_plugins(plugins).run(), AppExit::Success);
        }
        "open order" => {
            let plugins = LabPlugins::default().size(64, 36).exit_after(3).headless();
            let mut app = App::new();
            app.add_plugins(plugins).init_resource::<Shared>().add_systems(LabFrame, (one, other, dim, tint));
            assert_eq!(app.run(), AppExit::Success);
        }
        "command line" => {
            let arguments = env::var(ARGUMENTS).expect("arguments");
            let arguments = ["lcm"].into_iter().chain(arguments.split('\n')).map(Into::into);
            let types = |registry: &mut Registry| {
                extension::types(registry);
                registry.add_reflection_model::<toon::Toon>();
                registry.add_scene_format(crate::scenes::formats::example::Spheres);
            };
            let code = cli::run_with(arguments, types, |app| {
                extension::window(app);
                app.add_panel(panel::Dimmer::default());
            });
            assert_eq!(code, ExitCode::SUCCESS);
        }
        other => panic!("{other} is no program"),
    }
}

fn program(stage: &str, config: &Path) -> Command {
    let mut command = Command::new(env::current_exe().expect("this program has a path"));
    alone(&mut command, config)
        .args(["--exact", "library::plugins::stage", "--nocapture", "--test-threads", "1"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .env(STAGE, stage)
        .env(FILE, config.join("window.png"));
    command
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr)
}

fn extended(arguments: &[&str], config: &Path) -> Command {
    let mut command = program("command line", config);
    command.env(ARGUMENTS, arguments.join("\n"));
    command
}

#[test]
fn a_warning_names_the_systems_of_others_whose_order_is_open() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = program("open order", folder.path()).output().expect("it runs");
    let said = said(&output);
    assert!(output.status.success(), "they may run: {said}");
    assert!(
        said.contains("WARN")
            && (said.contains("one and other") || said.contains("other and one"))
            && said.contains("Shared"),
        "{said}"
    );
    let lights = said.contains("dim and tint") || said.contains("tint and dim");
    assert!(lights && said.contains("SceneLight"), "{said}");
}

#[test]
fn every_command_knows_what_an_extended_program_registers() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("toon.json");
    fs::write(&file, toon_scene(&fs::read_to_string(SCENE).expect("there"))).expect("writable");
    let (file, picture) = (file.to_string_lossy(), folder.path().join("toon.png"));
    let run = |arguments: &[&str]| {
        let output = extended(arguments, folder.path()).output().expect("it runs");
        let said = said(&output);
        assert!(output.status.success(), "{arguments:?}: {said}");
        said
    };
    run(&["check", &file]);
    assert!(run(&["models"]).contains("\n  toon "));
    assert!(run(&["schema"]).contains("\"toon\""));
    assert!(run(&["models", "check", "toon"]).contains("non-negative"));
    let written = picture.to_string_lossy();
    for renderer in ["cpu", "gpu"] {
        run(&["render", &file, "--renderer", renderer, "--size", "64x36", "-o", &written]);
        assert!(picture.exists(), "{renderer}");
        fs::remove_file(&picture).expect("written");
    }
    let unknown = Command::new(env!("CARGO_BIN_EXE_lcm")).args(["check", &file]).output().expect("it runs");
    assert!(!unknown.status.success() && said(&unknown).contains("toon"), "{}", said(&unknown));
}

const EXTENSION: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/examples/extension/scene.json");

#[test]
fn the_crate_of_the_example_swings_its_spotlight_and_leaves_the_scene_as_it_is() {
    let mut app = app(LabPlugins::default().scene(EXTENSION).size(64, 36).headless().build(), |app| {
        extension::types(app);
        app.insert_resource(extension::Pace(0.8)).add_systems(Update, extension::swing);
    });
    (0..10).for_each(|_| app.update());
    assert_eq!(count::<Drawn>(&mut app), 2, "its objects are drawn");
    let direction = |app: &mut App| {
        let mut spots = app.world_mut().query_filtered::<&Transform, With<Spot>>();
        *spots.single(app.world()).expect("one spotlight").forward()
    };
    let before = direction(&mut app);
    (0..40).for_each(|_| app.update());
    assert!(direction(&mut app).distance(before) > 1e-4, "it turns");
    let session = app.world().resource::<Session>();
    assert!(!session.document.differs(), "nothing is stored");
    assert_eq!(session.document.lights[1].direction.map(|d| d.x), Some(0.0));
}

#[test]
fn the_examples_pass_the_public_tests_and_draw_alike_without_a_window() {
    use lights_camera_models::{
        optics::{
            TermSelection,
            colour::{BACKGROUND, Encoding},
        },
        reference,
        render::capture::gpu::{GpuRenderer, Output},
        scene::load::{self, Defaults},
        testing,
    };
    fn register(to: &mut impl Register) {
        to.add_light_type::<light::Blind>()
            .add_light_type::<lamp::RingLamp>()
            .add_object_type::<shape::Pear>()
            .add_shading_model::<shading_model::Banded>();
    }
    testing::assert_light::<light::Blind>();
    testing::assert_light::<lamp::RingLamp>();
    testing::assert_mesh::<shape::Pear>();
    testing::assert_shading::<shading_model::Banded>();
    let mut registry = Registry::builtin();
    register(&mut registry);
    let mut renderer =
        GpuRenderer::extended(160, 90, 1, Output::Linear, register).expect("software Vulkan is installed");
    for name in ["lamp", "light", "shape", "shading_model"] {
        let file = format!("{}/examples/{name}.json", env!("CARGO_MANIFEST_DIR"));
        let scene = load::file(Path::new(&file), &registry, Defaults::Refuse).expect(name).scene;
        let gpu = on_gpu(&mut renderer, &scene);
        let settings = reference::Settings { width: 160, height: 90, samples: 1, terms: TermSelection::All };
        let cpu = reference::render(&scene, &registry, &settings);
        let d = compare(&gpu, &cpu, Encoding::Srgb.decode(BACKGROUND), 1e-3);
        // At the edge of a stripe or band a rounded number decides.
        assert!(d.covered > 800 && d.wrong * 100 <= d.covered, "{name}: {d:?}");
    }
}

#[test]
fn every_command_reads_the_scene_format_of_an_extended_program() {
    let folder = tempfile::tempdir().expect("a folder");
    let (file, picture) = (folder.path().join("balls.spheres"), folder.path().join("balls.png"));
    fs::write(&file, "4 5 5 2\n6 5 5 2\n").expect("writable");
    let (balls, written) = (file.to_string_lossy(), picture.to_string_lossy());
    for arguments in [&["check", &*balls][..], &["render", &balls, "--size", "64x36", "-o", &written]] {
        let output = extended(arguments, folder.path()).output().expect("it runs");
        assert!(output.status.success(), "{arguments:?}: {}", said(&output));
    }
    assert!(picture.exists());
    fs::write(&file, "4 5 5 2\n6 5 55 2\n").expect("writable");
    let output = extended(&["check", &*balls], folder.path()).output().expect("it runs");
    assert!(
        said(&output).contains("balls.spheres:2:1: objects[1].position is [6, 5, 55]"),
        "{}",
        said(&output)
    );
    let unknown = Command::new(env!("CARGO_BIN_EXE_lcm")).args(["check", &*balls]).output().expect("it runs");
    assert!(said(&unknown).contains(".spheres is not the extension of a scene"), "{}", said(&unknown));
    // The window's plugins too, in any order.
    fs::write(&file, "4 5 5 2\n6 5 5 2\n").expect("writable");
    let mut app = app(LabPlugins::default().scene(&file).size(64, 36).headless().build(), |app| {
        app.add_scene_format(crate::scenes::formats::example::Spheres);
    });
    draw(&mut app);
    assert_eq!(count::<SceneObject>(&mut app), 2);
}

#[cfg(target_os = "linux")]
#[test]
fn a_program_without_a_display_says_so_and_ends() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = program("panel", folder.path()).output().expect("it runs");
    let said = said(&output);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("there is no display") && !said.contains("panicked"), "{said}");
}

#[cfg(target_os = "linux")]
mod on_screen {
    use super::*;

    /// The window captured by a stage.
    fn capture(mut command: Command, config: &Path, screen: &Screen) -> Picture {
        let output = command.env("DISPLAY", screen.display()).output().expect("it runs");
        assert!(output.status.success(), "{}", said(&output));
        Picture::read(&config.join("window.png"))
    }

    const PANEL: [u8; 3] = [21, 21, 21];

    #[test]
    fn the_window_runs_without_some_of_its_parts() {
        let folder = tempfile::tempdir().expect("a folder");
        let screen = Screen::new(640, 480);
        let stage = |name| capture(program(name, folder.path()), folder.path(), &screen);
        let picture = stage("without panels");
        assert_eq!((picture.width, picture.height), (640, 480));
        assert_eq!(picture.count(0..640, 0..480, |c| c == PANEL), 0, "the picture fills the window");
        assert!(picture.colours(100..540, 100..400) > 300, "there is a picture");
        let picture = stage("without gizmos and watching");
        assert!(picture.count(0..640, 0..480, |c| c == PANEL) > 10_000, "there are panels");
    }

    #[test]
    fn the_window_of_an_extended_program_knows_its_model_and_has_its_panel() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("toon.json");
        fs::write(&file, toon_scene(&fs::read_to_string(SCENE).expect("there"))).expect("writable");
        let screen = Screen::new(1280, 720);
        let window = folder.path().join("window.png");
        let (file, window) = (file.to_string_lossy(), window.to_string_lossy());
        let arguments = ["view", &*file, "--size", "1280x720", "--exit-after", "20", "--capture", &*window];
        let picture = capture(extended(&arguments, folder.path()), folder.path(), &screen);
        assert!(picture.colours(220..900, 60..600) > 100, "the picture has the scene");
        assert!(has_section(&picture));
    }

    /// True if the example panel's blue slider is at the lower right.
    fn has_section(picture: &Picture) -> bool {
        picture.count(940..1270, 560..690, |c| c == [0x1f, 0x3a, 0x57]) > 50
    }

    #[test]
    fn the_examples_open_their_windows() {
        let screen = Screen::new(1280, 720);
        // A picture with its scene: yellow pears, brown and white stripes, bands of blue.
        let shows = |name| {
            let mut running = screen.start_with(|config| program(name, config));
            running.until("the scene of the example", |picture: &Picture| {
                picture.colours(220..900, 60..600) > 60
            });
            assert!(!running.said().contains("ERROR"), "{name}: {}", running.said());
        };
        ["lamp", "light", "shading_model", "shape"].into_iter().for_each(shows);
        let mut running = screen.start_with(|config| program("animate", config));
        let mut seen = BTreeSet::new();
        running.until("the light that swings", |picture: &Picture| {
            let lit = picture.count(220..900, 60..600, |[r, g, b]| r > 200 && g > 200 && b > 200);
            seen.insert(lit);
            seen.len() > 3
        });
        // Its light is clipped, which is reported although the picture never rests.
        let badge = |picture: &Picture| picture.count(210..480, 40..75, |c| c == [0xf0, 0xc0, 0x50]) > 60;
        running.until("the badge of clipping", badge);
        for (name, logged) in [("window", "objects"), ("panel", "")] {
            let mut running = screen.start_with(|config| program(name, config));
            running.until("the panel of the example", has_section);
            assert!(running.said().contains(logged), "{}", running.said());
        }
    }
}
