//! Light with extent on the command line: samples and noise as requested and as reached, in captions,
//! channels and comparisons; progress, and early termination.

use std::{fs, path::Path, process::Stdio, sync::atomic::AtomicBool, thread, time::Duration};

use lights_camera_models::{
    caption::{self, Sampled},
    channel::{DebugChannel, Setting},
    progress::Progress,
    reference::{self, LightSamples, Reached, Settings, Until},
    registry::Registry,
    scene::{
        Light, Scene,
        load::{self, Defaults},
        save,
    },
};
use serde_json::{Value, json};

use crate::{
    helpers::pictures::close_up,
    helpers::support::{Run, command_in, lcm_in, names, peak},
    renderers::golden::read_png,
};

const SIZE: [u32; 2] = [64, 36];

fn settings() -> Settings {
    Settings { width: SIZE[0], height: SIZE[1], samples: 1, ..Settings::default() }
}

/// A folder with a scene under a softbox, one with one of two views under it, and one under a point light.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let put = |name: &str, scene: &Value| {
        fs::write(folder.path().join(name), scene.to_string()).expect("written");
    };
    let text = |light: &str| save::to_json(&close_up("sphere", light), None, &Registry::builtin());
    let mut softbox: Value = serde_json::from_str(&text("rectangle")).expect("JSON");
    softbox["shading_model"] = json!("phong");
    softbox["lights"][0]["intensity"] = json!(5);
    put("softbox.json", &softbox);
    put("point.json", &serde_json::from_str(&text("point")).expect("JSON"));
    softbox["variants"] = json!([{ "reflection_model": "metallic_roughness" }]);
    put("two.json", &softbox);
    folder
}

fn scene(folder: &Path, name: &str) -> Scene {
    load::file(&folder.join(name), &Registry::builtin(), Defaults::Use).expect("legal").scene
}

fn render(folder: &Path, more: &[&str]) -> Run {
    let usual = ["render", "--renderer", "cpu", "--size", "64x36", "--samples", "1", "-o", "p.png"];
    let more =
        if more.contains(&"--renderer") { [&["render"], more].concat() } else { [&usual, more].concat() };
    lcm_in(folder, &more, b"")
}

fn drawn(folder: &Path, more: &[&str]) -> (Vec<u8>, String) {
    let run = render(folder, more);
    assert_eq!(run.status, Some(0), "{more:?}: {}", run.err);
    (read_png(&folder.join("p.png")).expect("a picture").2, run.err)
}

/// The note of a PNG file about its lights with extent.
fn light_text(file: &Path) -> Option<String> {
    let bytes = std::io::BufReader::new(fs::File::open(file).expect("a picture"));
    let picture = png::Decoder::new(bytes).read_info().expect("a PNG file");
    let texts = &picture.info().uncompressed_latin1_text;
    texts.iter().find(|text| text.keyword == "Light").map(|text| text.text.clone())
}

fn converged(scene: &Scene, samples: u32, noise: Option<f32>) -> (reference::Picture, Reached) {
    let (odd, until) = (AtomicBool::default(), Until { samples, noise });
    reference::render_until(scene, &Registry::builtin(), &settings(), until, &odd, &Progress::NONE)
        .expect("nobody cancels")
}

#[test]
fn the_gpu_takes_as_many_samples_as_it_is_told() {
    let folder = folder();
    let samples = |renderer: &str, count: &str| {
        let (picture, said) = drawn(
            folder.path(),
            &[
                "--renderer",
                renderer,
                "--light-samples",
                count,
                "--size",
                "64x36",
                "--samples",
                "1",
                "-o",
                "p.png",
                "softbox.json",
            ],
        );
        assert!(said.contains(&format!("{count} samples of each light")), "{said}");
        picture
    };
    let off = |a: &[u8], b: &[u8]| a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b))).sum::<u64>();
    let few = samples("gpu", "2");
    assert!(
        off(&few, &samples("cpu", "2")) * 4 < off(&few, &samples("cpu", "256")),
        "others than on the CPU"
    );
    assert!(off(&samples("gpu", "300"), &samples("cpu", "300")) * 4 < off(&few, &samples("cpu", "300")));
}

#[test]
fn both_renderers_end_at_the_same_noise() {
    let folder = folder();
    let ends = |renderer: &str, more: &[&str]| {
        let usual =
            ["softbox.json", "--renderer", renderer, "--size", "64x36", "--samples", "1", "-o", "p.png"];
        let (picture, said) = drawn(folder.path(), &[&usual, more].concat());
        let told =
            said.split_once("wrote p.png: ").and_then(|(_, told)| told.split_once(" samples of each light"));
        let samples: f32 = told.and_then(|(count, _)| count.parse().ok()).expect("a number of samples");
        (picture, said, samples)
    };
    let (picture, said, samples) = ends("gpu", &["--noise", "0.1"]);
    assert!(said.contains(" samples of each light, noise 0.09") || said.contains(", noise 0.1 %"), "{said}");
    let (_, _, on_cpu) = ends("cpu", &["--noise", "0.1"]);
    assert!(on_cpu > 128.0, "else the first noise that is known would do: {on_cpu}");
    assert!((0.7..1.4).contains(&(samples / on_cpu)), "{samples} {on_cpu}");
    // How fast the machine is does not matter, and a channel takes as many as the picture.
    let (again, ..) = ends("gpu", &["--noise", "0.1"]);
    assert!(again == picture);
    let (channel, _, of_channel) = ends("gpu", &["--noise", "0.1", "--channel", "luminance"]);
    assert!(of_channel == samples && channel != picture);
    // What cannot be reached is told.
    let (_, said, _) = ends("gpu", &["--noise", "0.01", "--light-samples", "64"]);
    assert!(said.starts_with("softbox.json: after 64 samples the noise is "), "{said}");
}

#[test]
fn wrong_samples_and_noise_are_refused_with_what_would_be_right() {
    let folder = folder();
    let whole = "it must be a whole number from 1 to 1048576, e.g. 1000";
    let percent = "it must be a percentage from 0.01 to 100, e.g. 1 or 0.5%";
    for (option, value, rule) in [
        ("--light-samples", "0", whole),
        ("--light-samples", "-1", whole),
        ("--light-samples", "1e9", whole),
        ("--light-samples", "1048577", whole),
        ("--light-samples", "many", whole),
        ("--noise", "0", percent),
        ("--noise", "-1", percent),
        ("--noise", "abc", percent),
        ("--noise", "200%", percent),
        ("--noise", "nan", percent),
        ("--noise", "1,5", percent),
        ("--noise", "1%%", percent),
    ] {
        for command in [&["render", "softbox.json"][..], &["compare", "two.json"]] {
            let run = lcm_in(folder.path(), &[command, &[option, value]].concat(), b"");
            assert_eq!((run.status, run.out.as_str()), (Some(2), ""), "{}", run.err);
            let named = format!("invalid value '{value}' for '{option} <");
            assert!(run.err.contains(&named) && run.err.contains(rule), "{}", run.err);
        }
    }
    for (more, expected) in [
        (
            &["--renderer", "gpu", "--light-samples", "4097"][..],
            "--light-samples is 4097, but with --renderer gpu it must be at most 4096; use --renderer cpu",
        ),
        (
            &["--renderer", "gpu", "--noise", "1", "--light-samples", "99", "-o", "p.exr"],
            "--noise cannot be used with --renderer gpu for linear pictures, whose noise it does not measure; use --light-samples, or \
             --renderer cpu",
        ),
        (
            &["--channel", "normals", "--noise", "1"],
            "--noise cannot be used with --channel normals, which does not depend on light samples; channels that do are luminance, \
             clipped, not_a_number, remaining_light and one_light",
        ),
        (
            &["--channel", "wireframe", "--light-samples", "9"],
            "--light-samples cannot be used with --channel wireframe",
        ),
    ] {
        let run = render(folder.path(), &[more, &["softbox.json"]].concat());
        assert_eq!((run.status, run.out.as_str()), (Some(2), ""), "{}", run.err);
        assert!(run.err.contains(expected), "{}", run.err);
        assert!(!folder.path().join("p.png").exists());
    }
}

#[test]
fn options_without_effect_are_told() {
    let folder = folder();
    let (plain, said) = drawn(folder.path(), &["point.json"]);
    assert_eq!(said, "wrote p.png\n");
    let (same, said) = drawn(folder.path(), &["point.json", "--light-samples", "7"]);
    let told = "point.json: no light has extent and no body is rough, so the picture has no noise, and --light-samples changes nothing\n";
    assert_eq!((same == plain, said), (true, format!("{told}wrote p.png\n")));
    let (_, said) = drawn(folder.path(), &["point.json", "--light-samples", "7", "--noise", "1"]);
    assert!(said.contains("and --light-samples and --noise change nothing\n"), "{said}");
    // Too few samples to know.
    let (_, said) = drawn(folder.path(), &["softbox.json", "--light-samples", "48", "--noise", "1"]);
    let told = "softbox.json: the noise is not known with fewer than 64 --light-samples, so --noise changes nothing\n";
    assert_eq!(said, format!("{told}wrote p.png: 48 samples of each light\n"));
    // And too few for the request.
    let (_, said) = drawn(folder.path(), &["softbox.json", "--light-samples", "64", "--noise", "0.01"]);
    assert!(said.starts_with("softbox.json: after 64 samples the noise is "), "{said}");
    assert!(
        said.contains(" %; more --light-samples lower it\nwrote p.png: 64 samples of each light, noise "),
        "{said}"
    );
}

#[test]
fn captions_and_pictures_say_samples_and_noise_as_reached() {
    let folder = folder();
    let registry = Registry::builtin();
    let scene = scene(folder.path(), "softbox.json");
    for (more, samples, noise) in [
        (&["--light-samples", "16"][..], 16, None),
        (&["--light-samples", "96"], 96, None),
        (&["--noise", "1%"], 1 << 16, Some(0.01)),
        (&[], 256, None),
    ] {
        let (picture, Reached { samples, noise }) = converged(&scene, samples, noise);
        let reached = [Sampled { samples, noise }];
        let words = caption::line(&caption::sampled(&reached));
        assert!(words.starts_with(&format!("{samples} samples of each light")), "{words}");
        assert_eq!(words.contains("noise"), samples >= 64, "{words}");
        let shown = [(0, &scene, settings().terms)];
        let with = caption::of_picture(&scene, &shown, &registry).resting_on(&reached);
        assert!(caption::line(&with.facts).ends_with(&format!(" · {words}")));
        let (expected, _) = caption::draw(&with, picture.to_rgb8(&scene.display), SIZE);
        let (found, said) = drawn(folder.path(), &[&["softbox.json", "--caption"], more].concat());
        assert!(found == expected, "{more:?}");
        assert_eq!(said, format!("wrote p.png: {words}\n"));
        let file = fs::read(folder.path().join("p.png")).expect("readable");
        assert!(file.windows(words.len()).any(|bytes| bytes == words.as_bytes()), "the file says it, too");
    }
    // The GPU renderer takes as many at once, and measures their noise only if it is asked for.
    let gpu = ["softbox.json", "--renderer", "gpu", "--size", "64x36", "-o", "p.png"];
    assert_eq!(drawn(folder.path(), &gpu).1, "wrote p.png: 256 samples of each light\n");
    // Nothing is reported where samples have no effect.
    let point = self::scene(folder.path(), "point.json");
    let plain = caption::of_picture(&point, &[(0, &point, settings().terms)], &registry);
    let picture = reference::render_rgb8(&point, &registry, &settings());
    let (found, said) = drawn(folder.path(), &["point.json", "--caption"]);
    assert_eq!(said, "wrote p.png\n");
    assert!(found == caption::draw(&plain, picture, SIZE).0);
}

#[test]
fn channels_of_light_take_the_samples_that_are_asked_for() {
    let folder = folder();
    let registry = Registry::builtin();
    let mut scene = scene(folder.path(), "softbox.json");
    let channel =
        |scene: &Scene, channel| Setting::new(channel, scene, &registry, scene.observer.position, None);
    let luminance = channel(&scene, DebugChannel::Luminance);
    let by = |samples| {
        let samples = LightSamples::of(samples);
        reference::render_channel_by(&scene, &registry, &settings(), &luminance, samples)
    };
    let asked = |more: &[&str]| {
        drawn(folder.path(), &[&["softbox.json", "--no-legend", "--channel", "luminance"], more].concat())
    };
    assert!(by(1) != by(64), "else this would prove nothing");
    for samples in [1, 64] {
        let (found, said) = asked(&["--light-samples", &samples.to_string()]);
        assert!(found == by(samples), "{samples}");
        let words = if samples == 1 { "1 sample" } else { "64 samples" };
        assert_eq!(said, format!("wrote p.png: {words} of each light\n"));
    }
    // As many as the picture takes for that noise.
    let (_, reached) = converged(&scene, 1 << 16, Some(0.02));
    let (found, said) = asked(&["--noise", "2"]);
    assert!(found == by(reached.samples));
    assert!(said.contains(&format!("{} samples of each light, noise ", reached.samples)), "{said}");

    // One light alone is a picture.
    let dim =
        Light { light_type: "point".to_owned(), direction: None, intensity: 1e-3, ..scene.lights[0].clone() };
    scene.lights.push(Light { parameters: Default::default(), ..dim });
    fs::write(folder.path().join("more.json"), save::to_json(&scene, None, &registry)).expect("written");
    let lit = channel(&scene, DebugChannel::Light).lit(&scene);
    assert!(lit.lights[0].enabled && !lit.lights[1].enabled, "the softbox is brighter");
    let (picture, _) = converged(&lit, 16, None);
    let more = ["more.json", "--channel", "one_light", "--no-legend", "--light-samples", "16"];
    assert!(drawn(folder.path(), &more).0 == picture.to_rgb8(&scene.display));
    let (_, said) = drawn(folder.path(), &["more.json", "--channel", "normals"]);
    assert_eq!(said, "wrote p.png\n", "geometry rests on no samples");
}

#[test]
fn every_view_of_a_comparison_takes_them() {
    let folder = folder();
    let registry = Registry::builtin();
    let scene = scene(folder.path(), "two.json");
    let reached = [0, 1].map(|view| {
        let (seen, _) = scene.seen(view, &registry).expect("there are two");
        converged(&seen, 1 << 16, Some(0.001)).1
    });
    assert_ne!(reached[0].samples, reached[1].samples, "else this would prove nothing");
    let words = caption::line(&caption::sampled(
        &reached.map(|Reached { samples, noise }| Sampled { samples, noise }),
    ));
    for layout in ["wipe", "difference"] {
        let (_, said) = drawn(folder.path(), &["two.json", "--layout", layout, "--noise", "0.1"]);
        assert_eq!(said, format!("wrote p.png: {words}\n"), "{layout}");
    }
    let (_, said) = drawn(folder.path(), &["two.json", "--view", "B", "--noise", "0.1"]);
    assert!(said.starts_with(&format!("wrote p.png: {} samples", reached[1].samples)), "{said}");
    let compared = |more: &[&str]| {
        let usual = ["compare", "two.json", "--size", "64x36", "--samples", "1"];
        let run = lcm_in(folder.path(), &[&usual, more].concat(), b"");
        assert_eq!(run.status, Some(0), "{}", run.err);
        serde_json::from_str::<Value>(&run.out).expect("JSON")
    };
    let report = compared(&["--noise", "0.1"]);
    for (side, reached) in [("a", reached[0]), ("b", reached[1])] {
        assert_eq!(report[side]["light_samples"], json!(reached.samples));
        let noise = report[side]["noise"].as_f64().expect("a number");
        assert!((noise - f64::from(reached.noise.expect("known"))).abs() < 1e-6, "{report:#}");
    }
    assert_eq!(compared(&["--light-samples", "32"])["a"]["light_samples"], json!(32));
    assert_eq!(compared(&[])["b"]["light_samples"], json!(256));
    let run = lcm_in(
        folder.path(),
        &["compare", "point.json", "point.json", "--size", "16x9", "--noise", "1"],
        b"",
    );
    assert!(run.err.contains("point.json: no light has extent") && !run.out.contains("noise"), "{}", run.err);
    // The picture of a comparison says what it rests on; pictures that are read are as they are.
    let run = lcm_in(
        folder.path(),
        &["compare", "two.json", "--size", "64x36", "--light-samples", "32", "-o", "c.png"],
        b"",
    );
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert_eq!(light_text(&folder.path().join("c.png")).as_deref(), Some("32 samples of each light"));
    let run = lcm_in(folder.path(), &["compare", "c.png", "c.png", "--noise", "1"], b"");
    assert_eq!(run.err, "both files are pictures, already rendered: --noise changes nothing\n");
}

#[test]
fn a_picture_with_so_many_samples_is_one_picture_whatever_the_threads() {
    let folder = folder();
    let file = folder.path().join("p.png");
    let mut all = Vec::new();
    for threads in ["1", "2", "5"] {
        for more in [&["--light-samples", "48"][..], &["--noise", "1"]] {
            let usual = ["render", "--renderer", "cpu", "--size", "96x54", "-o", "p.png", "two.json"];
            let mut command = command_in(folder.path(), [&usual, more].concat());
            let run = Run::from(command.env("RAYON_NUM_THREADS", threads).output().expect("it starts"));
            assert_eq!(run.status, Some(0), "{}", run.err);
            all.push(fs::read(&file).expect("written"));
        }
    }
    assert!(all[0] != all[1], "the wrong twin");
    assert!(all.chunks(2).all(|both| both == &all[..2]));
}

/// Runs the program on a terminal until it has said all of some words, or for some seconds, then interrupts it; returns its
/// output.
#[cfg(target_os = "linux")]
fn on_terminal(folder: &Path, seconds: u32, words: &[&str], arguments: &str) -> String {
    on_terminal_of(None, folder, seconds, words, arguments)
}

/// Like [`on_terminal`], on a terminal of a kind.
#[cfg(target_os = "linux")]
fn on_terminal_of(
    kind: Option<&str>,
    folder: &Path,
    seconds: u32,
    words: &[&str],
    arguments: &str,
) -> String {
    use std::io::Read as _;

    // Whoever runs the tests may ignore some signals, and programs respect that. `timeout` hands on those that it gets.
    let command = format!(
        "echo $$; exec timeout --foreground -s INT {seconds} env --default-signal=INT {} {arguments}",
        env!("CARGO_BIN_EXE_lcm")
    );
    let mut script = std::process::Command::new("script")
        .args(["-qec", &command, "/dev/null"])
        .envs(kind.map(|kind| ("TERM", kind)))
        .current_dir(folder)
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .expect("script is a part of every Linux");
    let mut output = script.stdout.take().expect("piped");
    let (mut said, mut part, mut asked) = (Vec::new(), [0; 4096], words.is_empty());
    loop {
        let count = output.read(&mut part).expect("readable");
        if count == 0 {
            break;
        }
        said.extend_from_slice(&part[..count]);
        let text = String::from_utf8_lossy(&said);
        if !asked && words.iter().all(|word| text.contains(word)) {
            asked = true;
            let process = text.lines().next().unwrap_or_default().trim();
            // It may have ended by itself.
            std::process::Command::new("kill").args(["-INT", process]).status().expect("kill");
        }
    }
    script.wait().expect("it ends");
    String::from_utf8_lossy(&said).into_owned()
}

#[test]
#[cfg(target_os = "linux")]
fn long_work_has_a_bar_on_a_terminal_that_goes_on_by_samples() {
    let folder = folder();
    let says = |seconds: u32, words: &[&str], arguments: &str| {
        let said = on_terminal(folder.path(), seconds, words, arguments);
        assert!(words.iter().all(|word| said.contains(word)), "{said}");
        said
    };
    let (samples, time) = (" of 1000000 samples, ", "s so far; Ctrl+C ends it");
    let long = "--renderer cpu --size 320x180 --light-samples 1000000";
    let bar = ["drawing softbox.json, ", samples, time, "░"];
    says(60, &bar, &format!("render softbox.json -o p.png {long}"));
    let view = ["drawing two.json, view A, ", time];
    says(60, &view, &format!("render two.json --layout wipe -o p.png {long}"));
    says(60, &["2 of 2, softbox.json, ", samples], &format!("render point.json softbox.json -o many {long}"));
    // The time left is told once enough is done.
    let short = "--renderer cpu --size 320x180 --light-samples 5000";
    let said = says(90, &[" left; Ctrl+C ends it"], &format!("render softbox.json -o p.png {short}"));
    let early = said.split('\r').find(|line| line.contains(" 0 % ") && line.contains(" left"));
    assert_eq!(early, None, "{said}");
    let noise = "--renderer cpu --size 320x180 --noise 0.01 --light-samples 1000000";
    let until = [" samples, noise ", " %, until 0.01 %"];
    says(60, &until, &format!("render softbox.json -o p.png {noise}"));
    let gold = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/compare_gold.json");
    says(60, &["matching, ", time], &format!("match {gold} --on picture"));
    says(60, &[" % matching, ", time], &format!("match {gold} --on picture --each"));
    let said = says(6, &[], &format!("render --quiet softbox.json -o p.png {long}"));
    assert!(!said.contains("samples"), "{said}");
    let left = names(folder.path());
    assert_eq!(left, ["many", "point.json", "softbox.json", "two.json"], "nothing is left of what was ended");
    assert_eq!(names(&folder.path().join("many")), ["point.png"], "and what was whole stays");
}

#[test]
#[cfg(target_os = "linux")]
fn a_long_picture_ends_cleanly() {
    use std::os::unix::process::ExitStatusExt as _;
    let folder = folder();
    for (signal, number) in [("INT", 2), ("TERM", 15)] {
        for more in
            [&["render", "softbox.json", "-o", "new/p.png"][..], &["compare", "two.json", "-o", "c.png"]]
        {
            let lcm = command_in(
                folder.path(),
                [more, &["--size", "640x360", "--light-samples", "1000000"]].concat(),
            );
            let mut command = std::process::Command::new("env");
            command.arg("--default-signal=INT,TERM").arg(lcm.get_program()).args(lcm.get_args());
            command.current_dir(folder.path()).stdout(Stdio::null()).stderr(Stdio::piped());
            let program = command.spawn().expect("it starts");
            thread::sleep(Duration::from_millis(1500));
            let killed = std::process::Command::new("kill")
                .args([&format!("-{signal}"), &program.id().to_string()])
                .status();
            assert!(killed.expect("kill").success());
            let output = program.wait_with_output().expect("it ends");
            assert_eq!(output.status.signal(), Some(number), "{more:?}: {}", output.status);
            assert_eq!(String::from_utf8_lossy(&output.stderr), "", "no bar without a terminal");
            assert_eq!(names(folder.path()), ["point.json", "softbox.json", "two.json"]);
        }
    }
}

#[cfg(target_os = "linux")]
#[test]
fn the_frames_of_a_converging_picture_leave_no_memory_behind() {
    let folder = folder();
    // Eight samples a frame.
    let [few, many] = ["264", "1288"].map(|samples| {
        let arguments = ["render", "softbox.json", "--renderer", "gpu", "--size", "32x18", "--samples", "1"];
        let mut command = command_in(folder.path(), arguments);
        command.args(["--light-samples", samples, "-o", "p.png"]);
        peak(command)
    });
    assert!(many < few + 64, "33 frames take {few} MiB, 161 take {many} MiB");
}

#[cfg(target_os = "linux")]
#[test]
fn an_explanation_that_takes_long_says_so_on_a_terminal() {
    let folder = folder();
    let arguments = "explain softbox.json --at 32,18 --size 64x36 --light-samples 1048576 --derivatives";
    let words = ["explaining the pixel", "so far"];
    let shown = on_terminal_of(Some("xterm"), folder.path(), 8, &words, arguments);
    assert!(words.iter().all(|word| shown.contains(word)), "{shown}");
}
