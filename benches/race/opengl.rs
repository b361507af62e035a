//! The default scene in the lab and in a handwritten OpenGL program (`benches/opengl`), alternating in one
//! run: medians of the whole process, from its start to a PNG file, and of a frame off screen; and the lines
//! that a user writes in each.

use std::{
    fs,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    time::Instant,
};

use lights_camera_models::{
    render::capture::gpu::{GpuRenderer, Output, find_adapter},
    scene::Scene,
};

const SIZE: (u32, u32) = (1280, 720);
/// Number of runs of each whole process.
const RUNS: usize = 31;
/// Number of alternating rounds of frames; frames counted in each, and frames before them.
const ROUNDS: usize = 12;
const FRAMES: usize = 100;
const FIRST: usize = 10;

pub(super) fn race() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let lab = Path::new(env!("CARGO_BIN_EXE_lcm"));
    let opengl = lab.with_file_name("default-scene-in-opengl");
    if !opengl.exists() {
        println!("skipped: {} is missing; scripts/race builds it", opengl.display());
        return;
    }
    let adapter = find_adapter().map_or_else(|e| e.to_string(), |adapter| adapter.name);
    println!("{adapter}, {}×{}, one sample, medians", SIZE.0, SIZE.1);
    println!("{:<34} {:>10} {:>10} {:>7}", "", "lab", "OpenGL", "ratio");

    let folder = tempfile::tempdir().expect("a folder");
    let size = format!("{}x{}", SIZE.0, SIZE.1);
    let mut processes = [Vec::new(), Vec::new()];
    for _ in 0..RUNS {
        let scene = root.join("scenes/default.json");
        let render = ["render", "--quiet", "--samples", "1", "--size", &size, "-o"];
        processes[0].push(run(Command::new(lab).args(render).arg(folder.path().join("lab.png")).arg(scene)));
        processes[1]
            .push(run(Command::new(&opengl).args(["--size", &size, "-o"]).arg(folder.path().join("gl.png"))));
    }
    report("whole process, start to PNG", processes, "ms");

    let mut renderer = GpuRenderer::new(SIZE.0, SIZE.1, 1, Output::Display).expect("a Vulkan driver");
    renderer.set_scene(Scene::default());
    renderer.settle().expect("the GPU draws");
    let mut frames = [Vec::new(), Vec::new()];
    for _ in 0..ROUNDS {
        for i in 0..FIRST + FRAMES {
            let begin = Instant::now();
            renderer.step();
            renderer.wait();
            if i >= FIRST {
                frames[0].push(milliseconds(begin));
            }
        }
        frames[1].extend(frames_of(&opengl, &folder.path().join("gl.png"), &size));
    }
    report("a frame off screen", frames, "ms");

    let scene = lines(&[root.join("scenes/default.json")], "//");
    let sources = ["main.rs", "context.rs", "vertex.glsl", "fragment.glsl"];
    let program = lines(&sources.map(|file| root.join("benches/opengl/src").join(file)), "//");
    // One more for the command that renders the scene.
    report("lines that a user writes", [vec![(scene + 1) as f64], vec![program as f64]], "");
}

pub(super) fn milliseconds(begin: Instant) -> f64 {
    begin.elapsed().as_secs_f64() * 1e3
}

fn run(command: &mut Command) -> f64 {
    let begin = Instant::now();
    let status = command.stdout(Stdio::null()).status().expect("it can be started");
    assert!(status.success(), "{command:?}");
    milliseconds(begin)
}

/// The times of frames of the OpenGL program, without the first.
fn frames_of(program: &Path, picture: &Path, size: &str) -> Vec<f64> {
    let frames = (FIRST + FRAMES).to_string();
    let output = Command::new(program)
        .args(["--size", size, "--frames", &frames, "-o"])
        .arg(picture)
        .output()
        .expect("it can be started");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = String::from_utf8_lossy(&output.stdout);
    let times: Vec<f64> = text.lines().map(|line| line.parse().expect("a number")).collect();
    times[FIRST..].to_vec()
}

/// The number of lines in files that are neither empty nor only comments.
fn lines(files: &[PathBuf], comment: &str) -> usize {
    let of = |file: &PathBuf| {
        let text = fs::read_to_string(file).expect("it is there");
        let written = |line: &&str| !line.trim().is_empty() && !line.trim().starts_with(comment);
        text.lines().filter(written).count()
    };
    files.iter().map(of).sum()
}

fn report(what: &str, values: [Vec<f64>; 2], unit: &str) {
    let [lab, opengl] = values.map(median);
    let show = |value: f64| if unit.is_empty() { format!("{value}") } else { format!("{value:.2} {unit}") };
    println!("{what:<34} {:>10} {:>10} {:>7.2}", show(lab), show(opengl), lab / opengl);
}

pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}
