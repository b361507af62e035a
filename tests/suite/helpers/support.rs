//! Helpers of several tests.

use std::{
    ffi::OsStr,
    fs,
    io::Write as _,
    path::{Path, PathBuf},
    process::{Command, Output, Stdio},
    sync::LazyLock,
};

use lights_camera_models::{
    registry::Registry,
    scene::{
        Scene,
        load::{self, Defaults},
        save,
    },
};
use serde_json::{Value, json};

/// The folder of the package.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Messages are well-formed: a question is at the end, and nothing is joined twice.
pub fn check_wording(messages: &str) {
    for message in messages.lines().map(str::trim) {
        let wrong =
            ["?;", "?.", "? ", "..", ";;", " ,", ":;", ": ;"].into_iter().find(|bad| message.contains(bad));
        assert_eq!(wrong, None, "{message}");
        assert!(!message.contains("  ") && !message.ends_with(';'), "{message}");
    }
}

/// The built-in registry. It is made once, and clones share what takes long to calculate: the curves of surfaces.
pub fn builtin() -> Registry {
    static BUILTIN: LazyLock<Registry> = LazyLock::new(Registry::builtin);
    BUILTIN.clone()
}

/// The shipped scenes.
pub fn shipped_scenes() -> Vec<PathBuf> {
    let mut scenes: Vec<_> = fs::read_dir(root().join("scenes"))
        .expect("the folder scenes is there")
        .map(|entry| entry.expect("readable").path())
        .filter(|path| path.extension().is_some_and(|e| e == "json"))
        .filter(|path| !path.to_string_lossy().ends_with(".schema.json"))
        .collect();
    scenes.sort();
    assert!(!scenes.is_empty());
    scenes
}

/// A scene with every field, as JSON to break.
pub fn full_scene() -> Value {
    json!({
        "name": "Everything",
        "description": "Gives every field.",
        "scene_size": { "height": 10, "width": 20, "depth": 30.5 },
        "reflection_model": "phong",
        "shading_model": "phong",
        "lights": [
            { "type": "point", "name": "lamp", "position": [1, 2, 3], "colour": [255, 250, 240], "intensity": 20 },
            { "type": "spot", "position": [2, 2, 3], "direction": [0, -1, 0], "cone_angle": 20, "penumbra": 0.5,
              "luminous_flux": 400, "colour_temperature": 2700 },
            { "type": "directional", "direction": [0, -1, -1], "intensity": 2.5 },
            { "type": "ambient", "intensity": 0.1 }
        ],
        "observer": { "position": [5, 5, 9.5], "direction": [0, 0, -1], "field_of_view": 45 },
        "objects": [
            { "type": "sphere", "name": "ball", "position": [5, 5, 5], "size": 2, "rotation": [0, 45, 0],
              "tessellation": 20, "reflection_model": "blinn_phong", "shading_model": "flat",
              "material": { "base_colour": [200, 100, 50], "specular_colour": [255, 255, 255], "k_a": 0.1,
                            "k_d": 0.8, "k_s": 0.5, "alpha": 32, "wrap_exponent": 1.5 } },
            { "type": "cube", "position": [8, 5, 5] },
            { "type": "torus", "position": [8, 8, 5], "tube_radius": 0.1 },
            { "type": "superellipsoid", "position": [5, 8, 5], "vertical_exponent": 0.3, "horizontal_exponent": 1.5 }
        ],
        "display": { "tone_mapping": "aces", "exposure": -1.5, "encoding": "srgb", "background": "gradient",
                     "background_colour": [240, 244, 250], "background_bottom": [90, 100, 120] },
        "variants": [
            {
                "name": "shiny",
                "reflection_model": "blinn_phong",
                "shading_model": "phong",
                "material": { "alpha": 20, "base_colour": [200, 40, 40] },
                "terms": "specular",
                "tone_mapping": "agx",
                "exposure": 0.5,
                "encoding": "off",
                "tessellation": 12
            },
            { "name": "shinier", "based_on": "shiny", "material": { "alpha": 200 } }
        ],
        "comparison": {
            "layout": "wipe",
            "with": "C",
            "split": 0.25,
            "edge": "horizontal",
            "sign": "signed",
            "channel": "luminance",
            "values": "light",
            "amplification": 8
        }
    })
}

/// The full scene with one change.
pub fn changed(change: impl FnOnce(&mut Value)) -> String {
    let mut scene = full_scene();
    change(&mut scene);
    format!("{scene:#}")
}

/// The messages of reading a text; empty if it is a valid scene.
pub fn said(text: &str) -> String {
    said_of_bytes(text.as_bytes())
}

/// The messages of reading bytes; empty if they are a valid scene.
pub fn said_of_bytes(bytes: &[u8]) -> String {
    match load::from_bytes(bytes, "scene.json", &builtin(), Defaults::Refuse) {
        Ok(_) => String::new(),
        Err(error) => error.to_string(),
    }
}

/// Reads a valid scene.
pub fn read(text: &str) -> Scene {
    match load::from_text(text, "scene.json", &builtin(), Defaults::Refuse) {
        Ok(loaded) => loaded.scene,
        Err(error) => panic!("{error}\n{text}"),
    }
}

/// The text of a scene file.
pub fn written(scene: &Scene) -> String {
    save::to_json(scene, None, &builtin())
}

/// The result of a run of the program.
pub struct Run {
    pub status: Option<i32>,
    pub out: String,
    pub err: String,
}

impl From<Output> for Run {
    fn from(output: Output) -> Self {
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("output is UTF-8");
        let run = Self { status: output.status.code(), out: text(output.stdout), err: text(output.stderr) };
        assert!(!run.err.contains("panicked"), "{}", run.err);
        run
    }
}

/// The names in a folder, sorted.
pub fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("readable");
    let mut names: Vec<_> =
        entries.map(|e| e.expect("readable").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// The program in a folder.
pub fn command_in<A: AsRef<OsStr>>(folder: &Path, arguments: impl IntoIterator<Item = A>) -> Command {
    command_of(Path::new(env!("CARGO_BIN_EXE_lcm")), folder, arguments)
}

/// A program in a folder.
pub fn command_of<A: AsRef<OsStr>>(
    program: &Path,
    folder: &Path,
    arguments: impl IntoIterator<Item = A>,
) -> Command {
    let mut command = Command::new(program);
    command
        .args(arguments)
        .current_dir(folder)
        // Otherwise cargo's variables, and the user's files, would be found.
        .env_remove("CARGO_MANIFEST_DIR")
        .env_remove("BEVY_ASSET_ROOT")
        .env("LCM_DATA_DIR", root().join("no-such-folder"));
    command
}

/// Runs the program in a folder, with an input.
pub fn lcm_in(folder: &Path, arguments: &[&str], input: &[u8]) -> Run {
    run(command_in(folder, arguments), input)
}

/// The largest memory of a command that succeeds, in MiB; on Linux.
pub fn peak(mut command: Command) -> u64 {
    let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program starts");
    let mut peak = 0;
    loop {
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or_default();
        let kib: u64 = line.trim().trim_end_matches("kB").trim().parse().unwrap_or(0);
        peak = peak.max(kib >> 10);
        if let Some(status) = child.try_wait().expect("a child") {
            assert!(status.success() && peak > 0, "{status}");
            return peak;
        }
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
}

/// Asserts that work takes less than a second or, if the machine is busy, no longer than in proportion to a tenth of
/// the work.
pub fn assert_quick(took: std::time::Duration, tenth: impl FnOnce() -> std::time::Duration) {
    // In proportion to the square, it takes 100 times as long.
    assert!(took.as_secs_f32() < 1.0 || took < 30 * tenth(), "{took:?}");
}

/// Runs a command with an input.
pub fn run(mut command: Command, input: &[u8]) -> Run {
    let mut child = command
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut stdin = child.stdin.take().expect("piped");
    let input = input.to_vec();
    let feeder = std::thread::spawn(move || {
        // The program may end without reading everything.
        let _ = stdin.write_all(&input);
    });
    let output = child.wait_with_output().expect("the program ends");
    feeder.join().expect("no panic");
    output.into()
}

/// Runs the program.
pub fn lcm(arguments: &[&str], input: &str) -> Run {
    lcm_in(root(), arguments, input.as_bytes())
}
