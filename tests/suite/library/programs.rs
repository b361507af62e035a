//! Programs made with the library, with a separate name and folders: this file runs itself as one.

#![cfg(target_os = "linux")]

use std::{env, ffi::OsString, fs, path::Path, process::Command};

use bevy::{
    prelude::{DetectChangesMut as _, Local, Res, ResMut, Single, Update, Window, With},
    window::PrimaryWindow,
};
use bevy_egui::egui;
use lights_camera_models::{
    cli,
    document::Edit,
    panel::{
        Panel, PanelApp as _, PanelContext, Place, progress, settings,
        state::{Action, Past, Session, ViewChange},
    },
    program::{self, LAB},
    recovery::{
        About, Store,
        texts::{self, TextKeeper},
    },
    registry::{Register as _, Registry},
    scene::{Part, Scene},
};

use crate::{
    helpers::screen::{Screen, alone},
    helpers::support::root,
    library::extension::Toon,
    window::panels::Bench,
};

/// The arguments of the program run by a child process.
const ARGUMENTS: &str = "LCM_TEST_ARGUMENTS";

/// Set for a program that panics, and for one that says the title of its window.
const BREAKS: &str = "LCM_TEST_BREAKS";
const TITLE: &str = "LCM_TEST_TITLE";

/// The frame in which the system panics, after it changed the scene in an earlier one.
const LAST: u32 = 40;

fn breaking(mut frame: Local<u32>, mut session: ResMut<Session>, registry: Res<Registry>) {
    *frame += 1;
    if *frame == 5 {
        session.apply(Action::Edit(Edit::set(Part::Scene, Scene::name, "Unsaved")), &registry);
    }
    // So that there is another frame.
    session.set_changed();
    assert!(*frame < LAST, "the forty frames are over");
}

/// Says the title of the window once.
fn titled(window: Single<&Window, With<PrimaryWindow>>, mut frame: Local<u32>) {
    *frame += 1;
    if *frame == 3 {
        eprintln!("the title is {}", window.title);
    }
}

/// Run by the tests below in a separate process: windows need the main thread.
#[test]
#[ignore = "a program, run by other tests"]
fn a_program() {
    let Ok(arguments) = env::var(ARGUMENTS) else { return };
    let arguments = ["velvet"].into_iter().chain(arguments.split_whitespace()).map(OsString::from);
    let [breaks, says_title] = [BREAKS, TITLE].map(|name| env::var_os(name).is_some());
    let code = cli::run_with(
        arguments,
        |_| (),
        move |app| {
            app.add_reflection_model::<Toon>();
            if says_title {
                app.add_systems(Update, titled);
            }
            if breaks {
                app.add_panel(Fragile).add_systems(Update, breaking);
            }
        },
    );
    // What the command line would pass to the system.
    std::process::exit(i32::from(code != std::process::ExitCode::SUCCESS));
}

/// A panel that panics long before the system does, and is caught.
struct Fragile;

impl Panel for Fragile {
    fn id(&self) -> &'static str {
        "fragile"
    }

    fn title(&self) -> &'static str {
        "Fragile"
    }

    fn place(&self) -> Place {
        Place::Right
    }

    fn show(&mut self, _: &mut egui::Ui, _: &mut PanelContext<'_>) {
        panic!("the panel is fragile");
    }
}

fn program(arguments: &str, config: &Path) -> Command {
    let mut command = Command::new(env::current_exe().expect("it runs"));
    command.args(["--exact", "library::programs::a_program", "--ignored", "--nocapture", "--test-threads=1"]);
    alone(&mut command, config).env(ARGUMENTS, arguments);
    command
}

fn said(command: &mut Command) -> (String, String) {
    let output = command.output().expect("it starts");
    [output.stdout, output.stderr].map(|bytes| String::from_utf8_lossy(&bytes).into_owned()).into()
}

#[test]
fn its_help_and_its_errors_have_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let name =
        env::current_exe().expect("it runs").file_stem().expect("a name").to_string_lossy().into_owned();
    for arguments in ["--help", "render --help", "models new --help", "rendr"] {
        let (out, err) = said(&mut program(arguments, folder.path()));
        let all = [out, err].concat();
        assert!(all.contains(&name), "{arguments}: {all}");
        assert!(!all.contains("lcm ") && !all.contains("`lcm`"), "{arguments}: {all}");
    }
}

/// What the program says on a screen, with one of its variables if that has a name.
fn said_on_a_screen(arguments: &str, folder: &Path, variable: Option<&str>) -> String {
    let screen = Screen::new(800, 600);
    let mut open = program(arguments, folder);
    said(open.env("DISPLAY", screen.display()).envs(variable.map(|name| (name, "1")))).1
}

#[test]
fn its_window_has_its_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let err = said_on_a_screen("view --exit-after 5", folder.path(), Some(TITLE));
    let title = err.lines().find_map(|line| line.split_once("the title is ")).expect(&err).1;
    // The tests themselves are such a program, and have the name of the same file.
    assert!(title.ends_with(program::name()) && !title.contains("Lights, Camera"), "{title}");
    let mut bench = Bench::new(Session::default());
    bench.apply(Action::View(ViewChange::About(true)));
    let texts = bench.texts();
    assert!(texts.iter().any(|text| text == program::name()), "{texts:?}");
    assert!(!texts.iter().any(|text| text.starts_with("Lights, Camera")), "{texts:?}");
}

#[test]
fn what_the_window_registers_is_known_to_the_scene_that_it_opens() {
    let screen = Screen::new(800, 600);
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("toon.json");
    let text = fs::read_to_string(root().join("scenes/default.json")).expect("readable");
    let mut scene: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    scene["reflection_model"] = "toon".into();
    fs::write(&file, scene.to_string()).expect("written");
    let mut open = program(&format!("view {} --exit-after 3", file.display()), folder.path());
    let (_, err) = said(open.env("DISPLAY", screen.display()));
    assert!(!err.contains("toon"), "{err}");
    // Missing parts are asked about, accepted or refused, as in the lab itself.
    let mut lacking = scene.clone();
    lacking.as_object_mut().expect("an object").remove("shading_model");
    fs::write(&file, lacking.to_string()).expect("written");
    let said_of = |flags: &str| {
        let arguments = format!("view {} --exit-after 5 {flags}", file.display());
        said(program(&arguments, folder.path()).env("DISPLAY", screen.display())).1
    };
    for flags in ["", "--use-defaults"] {
        let err = said_of(flags);
        assert!(!err.contains("shading_model"), "{flags}: {err}");
    }
    let err = said_of("--no-defaults");
    assert!(err.contains("shading_model") && err.contains("--use-defaults"), "{err}");
    // An unregistered type is still an error.
    scene["reflection_model"] = "tune".into();
    fs::write(&file, scene.to_string()).expect("written");
    let (_, err) = said(open.env("DISPLAY", screen.display()));
    assert!(err.contains("tune") && err.contains("or \"toon\""), "{err}");
}

#[test]
fn a_panic_in_a_system_is_located_and_unsaved_work_is_kept_for_this_program_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let err = said_on_a_screen("view", folder.path(), Some(BREAKS));
    let line = err.lines().find(|line| line.contains("the window was closed: the system")).expect(&err);
    assert!(line.contains("programs.rs:") && line.contains("the forty frames are over"), "{line}");
    assert!(err.contains("the panel is fragile") && !line.contains("fragile"), "it was caught: {err}");
    let data = folder.path().join("data");
    assert!(
        Store::new(data.join("recovery")).abandoned().is_empty(),
        "nothing in the folder of the laboratory"
    );
    let name = env::current_exe().expect("it runs").file_stem().expect("a name").to_owned();
    let left = Store::new(data.join("programs").join(name).join("recovery")).abandoned();
    assert_eq!(left.len(), 1, "{err}");
    let scene = fs::read_to_string(left[0].journal.file()).expect("the copy");
    assert!(scene.contains("\"Unsaved\""), "{scene}");
    drop(left);
    // It is offered at the next start.
    let err = said_on_a_screen("view --exit-after 3", folder.path(), None);
    assert!(err.contains("unsaved"), "{err}");
}

/// The name of the program run by a child process, and the scale that it then stores in its settings.
const NAME: &str = "LCM_TEST_NAME";
const SCALE: &str = "LCM_TEST_SCALE";

/// Run by the test below under several names: says what it finds, and leaves settings, progress in a lesson and copies of
/// unsaved work behind.
#[test]
#[ignore = "a program, run by another test"]
fn a_program_with_settings() {
    let (Ok(name), Ok(scale)) = (env::var(NAME), env::var(SCALE)) else { return };
    assert!(program::set_name(&name), "before anything asks for it");
    let (mut own, unread) = settings::load_own();
    let store = Store::of_user().expect("a folder");
    let copies: Vec<_> = store.abandoned().into_iter().map(|copy| copy.about.title).collect();
    let of_texts = Store::of_texts().expect("a folder");
    let kept: Vec<_> = texts::left(&of_texts).into_iter().map(|kept| kept.text).collect();
    let (mut lessons, unread_too) = progress::load_own();
    println!("found {} {copies:?} {kept:?} {:?} {unread:?} {unread_too:?}", own.scale, lessons.last);
    own.scale = scale.parse().expect("a number");
    settings::save_own(&own).expect("writable");
    if copies.is_empty() {
        let about = About { title: format!("of {name}"), ..About::default() };
        store.begin().and_then(|mut journal| journal.write(&about, "{}")).expect("writable");
        let mut keeper = TextKeeper::start(Some(of_texts));
        keeper.keep([("/models/a.wgsl".into(), format!("by {name}").into())].into());
    }
    lessons.last = Some(format!("read by {name}"));
    lessons.lessons.insert(name.clone(), Past::default());
    progress::save_own(&lessons, &name).expect("writable");
}

#[test]
fn settings_and_copies_of_unsaved_work_are_those_of_the_program_of_that_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let found = |name: &str, scale: &str| {
        let mut command = Command::new(env::current_exe().expect("it runs"));
        let test = "library::programs::a_program_with_settings";
        command.args(["--exact", test, "--ignored", "--nocapture", "--test-threads=1"]);
        let (out, err) = said(alone(&mut command, folder.path()).env(NAME, name).env(SCALE, scale));
        let line = out.lines().find_map(|line| Some(line.split_once("found ")?.1.to_owned()));
        line.unwrap_or_else(|| panic!("{out}{err}"))
    };
    let nothing = "100 [] [] None None None";
    let own = |scale: &str, name: &str| {
        format!("{scale} [\"of {name}\"] [\"by {name}\"] Some(\"read by {name}\") None None")
    };
    assert_eq!(found("velvet", "150"), nothing);
    assert_eq!(found(LAB, "125"), nothing, "the lab does not read those of another program");
    assert_eq!(found("satin", "100"), nothing, "nor another program those of the lab");
    assert_eq!(found("velvet", "150"), own("150", "velvet"), "the others left them alone");
    assert_eq!(found(LAB, "125"), own("125", LAB));
    assert!(folder.path().join("settings.json").is_file());
    assert!(folder.path().join("programs/velvet/settings.json").is_file());
}
