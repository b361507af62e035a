//! Exported programs: a scene inside a copy of the program, with everything that it needs.

#![cfg(target_os = "linux")]

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Output},
};

use lights_camera_models::{
    registry::Registry,
    scene::{Scene, save},
};

use crate::{
    helpers::screen::{Picture, Screen, alone},
    helpers::support::{lcm_in, names, root},
    renderers::golden::read_png,
};

/// A folder with an exported program, and an empty one in which to run it.
struct Shelf {
    folder: tempfile::TempDir,
    empty: tempfile::TempDir,
}

impl Shelf {
    fn new() -> Self {
        Self { folder: tempfile::tempdir().expect("a folder"), empty: tempfile::tempdir().expect("a folder") }
    }

    fn at(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Runs the program itself, in the folder of the scenes.
    fn lcm(&self, arguments: &[&str]) {
        let run = lcm_in(self.folder.path(), arguments, b"");
        assert_eq!(run.status, Some(0), "{arguments:?}: {}", run.err);
    }

    /// The exported program, in the empty folder.
    fn command(&self, program: &str, arguments: &[&str]) -> Command {
        let mut command = Command::new(self.at(program));
        alone(&mut command, self.empty.path())
            .args(arguments)
            .current_dir(self.empty.path())
            .env_remove("CARGO_MANIFEST_DIR")
            .env_remove("BEVY_ASSET_ROOT");
        command
    }

    fn run(&self, program: &str, arguments: &[&str]) -> Output {
        self.command(program, arguments).output().expect("it runs")
    }

    /// The picture of its own scene, drawn by an exported program.
    fn picture(&self, program: &str) -> Vec<u8> {
        let output = self.run(program, &["render", "--renderer", "cpu", "--size", "160x90", "-o", "x.png"]);
        assert!(output.status.success(), "{}", said(&output));
        read_png(&self.empty.path().join("x.png")).expect("a picture").2
    }

    /// The picture drawn by the program itself.
    fn expected(&self, arguments: &[&str]) -> Vec<u8> {
        let more = ["--renderer", "cpu", "--size", "160x90", "-o", "expected.png"];
        self.lcm(&[&["render"], arguments, &more].concat());
        read_png(&self.at("expected.png")).expect("a picture").2
    }
}

fn said(output: &Output) -> String {
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!said.contains("panicked"), "{said}");
    said
}

fn shipped(name: &str) -> String {
    root().join("scenes").join(name).to_string_lossy().into_owned()
}

#[test]
fn a_program_renders_its_scene_as_the_lab_does() {
    let shelf = Shelf::new();
    let scene = shipped("shapes_and_lights.json");
    shelf.lcm(&["export", &scene, "--as", "executable", "-o", "shapes"]);
    let expected = shelf.expected(&[&scene]);
    assert_eq!(shelf.picture("shapes"), expected);
    // The wrong twin: the default scene, which a program without a scene shows.
    assert_ne!(shelf.expected(&[]), expected);

    // Without -o the picture has the name of the scene's file, and other scenes can still be read.
    assert!(shelf.run("shapes", &["render", "--renderer", "cpu", "--size", "16x9"]).status.success());
    assert!(shelf.empty.path().join("renders/shapes_and_lights.png").exists());
    let other = shelf.run("shapes", &["check", &shipped("default.json")]);
    assert!(String::from_utf8_lossy(&other.stdout).contains("valid"), "{}", said(&other));
    let models = shelf.run("shapes", &["models"]);
    assert!(String::from_utf8_lossy(&models.stdout).contains("blinn_phong"));
    assert!(shelf.run("shapes", &["--version"]).status.success());
    assert!(!shelf.empty.path().join("data").exists(), "a scene without files needs no folder");
}

#[test]
fn a_program_exported_from_an_exported_one_carries_one_scene() {
    let shelf = Shelf::new();
    let scene = shipped("shapes_and_lights.json");
    shelf.lcm(&["export", "--as", "executable", "-o", "first"]);
    let run = shelf.run("first", &["export", &scene, "--as", "executable", "-o", "second"]);
    assert!(run.status.success(), "{}", said(&run));
    fs::rename(shelf.empty.path().join("second"), shelf.at("second")).expect("moved");
    assert_eq!(shelf.picture("second"), shelf.expected(&[&scene]));
    let length = |path: &Path| fs::metadata(path).expect("there").len();
    let own = length(Path::new(env!("CARGO_BIN_EXE_lcm")));
    shelf.lcm(&["export", &scene, "--as", "executable", "-o", "straight"]);
    assert_eq!(length(&shelf.at("second")), length(&shelf.at("straight")));
    assert!(length(&shelf.at("second")) - own < 1 << 16);
    // Its own scene is the default.
    let run = shelf.run("second", &["export", "--as", "executable", "-o", "third"]);
    assert!(run.status.success(), "{}", said(&run));
    fs::rename(shelf.empty.path().join("third"), shelf.at("third")).expect("moved");
    assert_eq!(fs::read(shelf.at("second")).expect("there"), fs::read(shelf.at("third")).expect("there"));
}

#[test]
fn what_a_scene_needs_travels_along() {
    let shelf = Shelf::new();
    // A lamp from a file that no program has, in a separate folder.
    fs::create_dir(shelf.at("lamps")).expect("made");
    let lamp = "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 10\n0 90 180\n0\n900 300 30\n";
    fs::write(shelf.at("lamps/mine.ies"), lamp).expect("written");
    let text = save::to_json(&Scene::default(), None, &Registry::builtin());
    let text = text.replace(
        "\"type\": \"point\",",
        "\"type\": \"photometric\", \"file\": \"lamps/mine.ies\", \"direction\": [0, -1, -1],",
    );
    let text = text.replace("\"intensity\": 20", "\"intensity\": 0.1");
    // A custom model with a file that it shares with others.
    fs::create_dir(shelf.at("models")).expect("made");
    let model = include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/models/gooch.wgsl"));
    fs::write(shelf.at("models/mine.wgsl"), model.replace("gooch", "mine")).expect("written");
    fs::write(shelf.at("room.json"), text.replace("lambert", "mine")).expect("written");
    let arguments = ["room.json", "--models", "models"];
    let expected = shelf.expected(&arguments);
    shelf.lcm(&[&["export"], &arguments[..], &["--as", "executable", "-o", "room"]].concat());
    for name in ["lamps", "models"] {
        fs::remove_dir_all(shelf.at(name)).expect("removed");
    }
    // On the first start the files are unpacked, on the next they exist.
    for _ in 0..2 {
        assert_eq!(shelf.picture("room"), expected);
    }
    // Later changes to them are reported with a remedy.
    let inside = shelf.empty.path().join("data/inside");
    let folder = inside.join(&names(&inside)[0]);
    let remedy = format!("delete the folder {} to have it unpacked again", folder.display());
    let lamp = folder.join("files/0/mine.ies");
    for (damage, expected) in
        [(Some("IESNA"), "mine.ies"), (None, "has no files/0/mine.ies, which this program unpacked")]
    {
        match damage {
            Some(text) => fs::write(&lamp, text).expect("written"),
            None => fs::remove_file(&lamp).expect("removed"),
        }
        let output = shelf.run("room", &["render", "-o", "x.png"]);
        let message = said(&output);
        assert_eq!(output.status.code(), Some(1), "{message}");
        assert!(message.contains(expected) && message.contains(&remedy), "{message}");
    }
    fs::remove_dir_all(&folder).expect("removed");
    assert_eq!(shelf.picture("room"), expected);
    let output = shelf.command("room", &["render"]).env("LCM_DATA_DIR", "/proc/none").output().expect("runs");
    assert_eq!(output.status.code(), Some(4));
    let message = said(&output);
    assert!(message.contains("could not be unpacked to /proc/none/inside"), "{message}");
    assert!(message.contains("set LCM_DATA_DIR to use another folder"), "{message}");
}

#[test]
fn edited_shaders_travel_along() {
    let shelf = Shelf::new();
    shelf.lcm(&["assets", "export", "mine"]);
    let path = shelf.at("mine/shaders/reflection/lambert.wgsl");
    let text = fs::read_to_string(&path).expect("there");
    let broken = text.replace("fn response", "fn respond");
    assert_ne!(broken, text);
    // An edit that has an effect without a GPU: an invalid one.
    fs::write(&path, broken).expect("written");
    shelf.lcm(&["export", "--as", "executable", "-o", "plain"]);
    let run = lcm_in(
        shelf.folder.path(),
        &["export", "--assets", "mine", "--as", "executable", "-o", "edited"],
        b"",
    );
    assert_eq!(run.status, Some(1), "a scene that cannot be drawn is not exported: {}", run.err);
    fs::write(&path, format!("{text}// edited\n")).expect("written");
    shelf.lcm(&["export", "--assets", "mine", "--as", "executable", "-o", "edited"]);
    fs::remove_dir_all(shelf.at("mine")).expect("removed");
    let told = |program: &str| {
        said(&shelf.run(program, &["render", "--renderer", "cpu", "--size", "16x9", "-o", "x.png"]))
    };
    assert!(told("edited").contains("ignores the edited reflection/lambert.wgsl"), "{}", told("edited"));
    assert!(!told("plain").contains("edited"));
}

#[test]
fn a_damaged_program_says_so() {
    let shelf = Shelf::new();
    shelf.lcm(&["export", "--as", "executable", "-o", "whole"]);
    let whole = fs::read(shelf.at("whole")).expect("there");
    let try_with = |bytes: &[u8]| {
        fs::write(shelf.at("broken"), bytes).expect("written");
        fs::set_permissions(
            shelf.at("broken"),
            fs::metadata(shelf.at("whole")).expect("there").permissions(),
        )
        .expect("set");
        let output = shelf.run("broken", &["render", "-o", "x.png"]);
        (output.status.code(), said(&output))
    };
    assert_eq!(try_with(&whole).0, Some(0));
    for cut in [1, 100, 500] {
        let (status, message) = try_with(&whole[..whole.len() - cut]);
        assert_eq!(status, Some(1), "{message}");
        let expected =
            "the scene inside this program is damaged: its end is missing; export the program again";
        assert!(message.contains(expected), "{message}");
    }
    let mut changed = whole.clone();
    let last = changed.len() - 200;
    changed[last] ^= 4;
    let (status, message) = try_with(&changed);
    assert_eq!(status, Some(1), "{message}");
    assert!(message.contains("damaged: its content was changed"), "{message}");
}

#[test]
fn the_window_opens_on_the_scene() {
    let shelf = Shelf::new();
    let scene = shipped("shapes_and_lights.json");
    shelf.lcm(&["export", &scene, "--as", "executable", "-o", "shapes", "--size", "1000x600"]);
    let screen = Screen::new(1280, 720);
    let capture = |command: &mut Command| {
        let output = command.env("DISPLAY", screen.display()).output().expect("it runs");
        assert!(output.status.success(), "{}", said(&output));
        Picture::read(&shelf.empty.path().join("window.png"))
    };
    let arguments = ["--exit-after", "12", "--capture", "window.png"];
    let window = capture(&mut shelf.command("shapes", &arguments));
    assert_eq!((window.width, window.height), (1000, 600));
    let mut lab = Command::new(env!("CARGO_BIN_EXE_lcm"));
    alone(&mut lab, shelf.empty.path()).current_dir(shelf.empty.path()).arg("view").arg(&scene);
    let expected = capture(lab.args(arguments).args(["--size", "1000x600"]));
    // The picture between the panels is equal; the panels differ, since one of them knows a file.
    let mut same = 0;
    for x in (320..640).step_by(4) {
        for y in (100..500).step_by(4) {
            same += u32::from(window.at(x, y) == expected.at(x, y));
        }
    }
    assert_eq!(same, 80 * 100);
    assert!(window.colours(320..640, 100..500) > 100, "it shows something");
}
