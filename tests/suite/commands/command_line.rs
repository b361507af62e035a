//! The command line as seen by users: output, messages, exit status.

use std::{
    fs,
    io::Read as _,
    process::{Command, Stdio},
};

use serde_json::Value;

use crate::helpers::support::{Run, changed, command_in, full_scene, lcm, lcm_in, peak, root};

/// Asserts the status and one line on standard error that contains a text.
fn refused(run: &Run, status: i32, expected: &str) {
    assert_eq!(run.status, Some(status), "{}", run.err);
    assert!(run.err.contains(expected), "{}\nnot: {expected}", run.err);
    assert_eq!(run.out, "");
}

#[test]
fn help_and_version_are_results() {
    for arguments in [&["--help"][..], &["render", "--help"], &["--version"]] {
        let run = lcm(arguments, "");
        assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
        assert!(!run.out.is_empty());
    }
    assert!(lcm(&["--help"], "").out.contains("Exit status: 0 success"));
    for words in [&["help"][..], &["help", "render"]] {
        let twice = lcm(&[words, &["--help"]].concat(), "");
        assert_eq!((twice.status, twice.out), (Some(0), lcm(words, "").out), "{}", twice.err);
    }
}

#[test]
fn wrong_usage_has_status_2() {
    for (arguments, expected) in [
        (&["check"][..], "required"),
        (&["render", "--size", "800"], "WIDTHxHEIGHT in pixels"),
        (&["render", "--samples", "3"], "1 or 4"),
        (&["render", "--samples", "-1"], "invalid value '-1' for '--samples <SAMPLES>': it must be 1 or 4"),
        (&["render", "--size", "-8x8"], "WIDTHxHEIGHT in pixels"),
        (&["render", "--size", "-8"], "WIDTHxHEIGHT in pixels"),
        (&["sweep", "--fps", "-1"], "it must be a whole number from 1 to "),
        (&["sweep", "--columns", "-2"], "it must be a whole number from 1 to 4294967295"),
        (&["materials", "--size", "-1"], "it must be a whole number of pixels from 16 to 1024"),
        (
            &["compare", "a.json", "--amplification", "-1"],
            "invalid value '-1' for '--amplification <FACTOR>'",
        ),
        (&["view", "--exit-after", "-1"], "it must be a whole number from 1 to 4294967295"),
        (&["--exit-after", "-1"], "it must be a whole number from 1 to 4294967295"),
        (&["render", "--renderer", "x"], "auto, gpu, cpu"),
        (&["render", "--term", "specualr"], "did you mean specular?"),
        (&["render", "--channel", "luminence"], "did you mean luminance?"),
        (&["render", "--reflection", "fong"], "--reflection is \"fong\", but the reflection model must be"),
        (&["render", "--shading", "x"], "--shading is \"x\", but the shading model must be"),
        (&["render", "--tone-mapping", "acess"], "did you mean \"aces\"?"),
        (&["render", "--exposure", "17"], "--exposure is \"17\", but it must be between -16 and 16 EV"),
        (&["render", "--exposure", "1e308"], "--exposure is \"1e308\", but it must be between -16 and 16 EV"),
        (&["render", "--exposure", "-17"], "it must be between -16 and 16 EV"),
        (&["render", "a.json", "b.json", "-o", "x.png"], "-o x.png is one file, but there are 2 scenes"),
        (&["render", "a/x.json", "b/x.json"], "would both be written to renders/x.png"),
        (
            &["render", "-o", "x.jpg"],
            "only PNG, OpenEXR and Radiance files can be written; did you mean x.png?",
        ),
        (&["render", "-", "-"], "- can be given only once"),
        (&["render", "--exposure", "x"], "it must be a number of EV, e.g. -1.5"),
        (&["plot", "phong", "--theta-i", "x"], "it must be a number of degrees, e.g. 22.5"),
        (&["plot", "phong", "--phi-i", "1,5"], "it must be a number of degrees, e.g. 22.5"),
        (&["view", "--exit-after", "0"], "it must be a whole number from 1 to 4294967295"),
        (&["view", "--exit-after", "x"], "it must be a whole number from 1 to 4294967295"),
        (&["view", "--lesson", "x", "--step", "0"], "it must be a whole number from 1 to 4294967295"),
        (
            &["view", "--lesson", "01_reflection_models", "--step", "99"],
            "--step is 99, but the lesson has 8 steps",
        ),
        (
            &["view", "--lesson", "lessons/01_reflection_models.md", "--step", "9"],
            "--step is 9, but the lesson has 8 steps",
        ),
        (
            &["view", "--exit-after", "1", "--capture", "x.jpg"],
            "--capture x.jpg: only PNG files can be written; did you mean x.png?",
        ),
        (&["view", "--exit-after", "1", "--capture", "x"], "--capture x: name a PNG file"),
        (&["--use-defaults", "--no-defaults", "check", "x"], "cannot be used with"),
        (&["room.json", "models"], "room.json must come after the command"),
        (&["rendr"], "did you mean lcm render?"),
        (&["evaluate", "fong"], "did you mean \"phong\"?"),
        (
            &["evaluate", "phong", "--set", "k_d=0.2"],
            "k_d is 0.2, but the diffuse coefficient must be between 0.5 and 1",
        ),
        (&["evaluate", "phong", "--set", "kd=0.7"], "phong has no parameter kd; did you mean k_d?"),
        (&["evaluate", "openpbr", "--set", "k_d=1"], "openpbr has no parameter k_d; it has base_"),
        (&["evaluate", "phong", "--set", "k_d"], "it must be NAME=VALUE"),
        (&["albedo", "fong"], "did you mean \"phong\"?"),
        (&["albedo", "phong", "--set", "k_d=0.2"], "but the diffuse coefficient must be between 0.5 and 1"),
        (&["albedo", "phong", "--on", "paper"], "invalid value 'paper'"),
        (&["new", ""], "the path is empty; name a file or a folder"),
        (&["render", "-o", ""], "the path is empty; name a file or a folder"),
        (&["explain", "--at", "1,1", "--hemisphere", "h.xyz"], "--hemisphere h.xyz: name a PNG file"),
        (
            &["explain", "--at", "1,1", "--hemisphere", "h.bmp"],
            "only PNG files can be written; did you mean h.png?",
        ),
    ] {
        refused(&lcm(arguments, ""), 2, expected);
    }
}

#[test]
fn check_reports_each_scene() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("good.json"), full_scene().to_string()).expect("written");
    let bad = changed(|s| {
        s["lights"][0]["intensity"] = (-1).into();
        s["objects"][0]["size"] = 0.into();
    });
    fs::write(folder.path().join("bad.json"), &bad).expect("written");
    let run = lcm_in(folder.path(), &["check", "good.json", "bad.json"], b"");
    assert_eq!(run.status, Some(1));
    assert_eq!(run.out, "good.json: valid: 4 lights, 4 objects, 2 variants\n");
    let lines: Vec<_> = run.err.lines().collect();
    assert_eq!(lines.len(), 3, "{}", run.err);
    assert!(lines[0].starts_with("bad.json:") && lines[0].contains(": lights[0].intensity is -1, but"));
    assert!(lines[1].starts_with("bad.json:") && lines[1].contains(": objects[0].size is 0, but"));
    assert_eq!(lines[2], "1 of 2 scenes is invalid");
    let run = lcm_in(folder.path(), &["check", "--quiet", "good.json"], b"");
    assert_eq!((run.status, run.out.as_str(), run.err.as_str()), (Some(0), "", ""));
}

#[test]
fn check_speaks_json() {
    let bad = changed(|s| s["lights"][0]["intensity"] = (-1).into());
    let run = lcm(&["check", "--json", "-"], &bad);
    assert_eq!((run.status, run.err.as_str()), (Some(1), ""));
    let report: Value = serde_json::from_str(&run.out).expect("JSON");
    let problem = &report[0]["problems"][0];
    assert_eq!(report[0]["file"], "standard input");
    assert_eq!(problem["path"], "lights[0].intensity");
    assert_eq!(problem["value"], "-1");
    assert_eq!(problem["message"], "lights[0].intensity is -1, but an intensity must be at least 0");
    let line = bad.lines().position(|l| l.contains("\"intensity\": -1")).expect("there") + 1;
    assert_eq!(problem["line"], line);
    assert!(problem["column"].as_u64().is_some_and(|c| c > 1));
}

#[test]
fn missing_parts_need_an_answer() {
    let text = changed(|s| drop(s.as_object_mut().expect("an object").remove("shading_model")));
    for arguments in [&["check", "-"][..], &["check", "-", "--no-defaults"], &["render", "-"]] {
        let run = lcm(arguments, &text);
        refused(
            &run,
            1,
            "standard input:1:1: shading_model (default: gouraud) is missing; --use-defaults accepts the defaults, --no-defaults",
        );
        assert_eq!(run.err.lines().count(), 1);
    }
    assert_eq!(lcm(&["check", "-", "--use-defaults"], &text).status, Some(0));
    let empty = "standard input is empty; --use-defaults loads the default scene";
    for arguments in [&["check", "-"][..], &["check", "-", "--no-defaults"], &["render", "-"]] {
        let run = lcm(arguments, "");
        refused(&run, 1, empty);
        // There is nobody to ask.
        assert!(!run.err.contains('?'), "{}", run.err);
    }
    assert_eq!(lcm(&["check", "-", "--use-defaults"], "").status, Some(0));
}

#[test]
fn render_says_everything_that_is_wrong_with_all_scenes() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    fs::write(folder.path().join("a.json"), "{").expect("written");
    fs::write(folder.path().join("b.json"), "[]").expect("written");
    let run = lcm_in(folder.path(), &["render", "a.json", "b.json", "c.json"], b"");
    refused(&run, 1, "a.json:1:2: not JSON");
    assert!(run.err.contains("b.json:1:1: the scene is []") && run.err.contains("c.json: file not found"));
    assert!(!folder.path().join("renders").exists());
}

#[test]
fn new_writes_the_default_scene_and_overwrites_nothing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let run = lcm_in(folder.path(), &["new", "a.json"], b"");
    assert_eq!((run.status, run.err.as_str()), (Some(0), "wrote a.json\n"));
    assert_eq!(lcm_in(folder.path(), &["check", "a.json"], b"").status, Some(0));
    refused(
        &lcm_in(folder.path(), &["new", "a.json"], b""),
        4,
        "a.json already exists; it was not overwritten",
    );
    let run = lcm_in(folder.path(), &["new", "x/y/a.json"], b"");
    assert_eq!((run.status, run.err.as_str()), (Some(0), "wrote x/y/a.json\n"));
    // Folders that were made for nothing do not stay.
    refused(&lcm_in(folder.path(), &["new", "z/a.png"], b""), 4, "was not written");
    assert!(!folder.path().join("z").exists());
    refused(&lcm_in(folder.path(), &["new", "."], b""), 4, "is a folder; choose a file name");
}

#[test]
fn models_are_listed_for_people_and_programs() {
    let table = lcm(&["models"], "").out;
    for expected in [
        "Basic",
        "mod_lambert",
        "Modified Lambert",
        "not energy conserving",
        "k_d (diffuse coefficient): between 0.5 and 1, default 0.8",
    ] {
        assert!(table.contains(expected), "{table}");
    }
    let models: Value = serde_json::from_str(&lcm(&["models", "--json"], "").out).expect("JSON");
    let phong = models.as_array().expect("a list").iter().find(|m| m["id"] == "phong").expect("there");
    assert_eq!(phong["name"], "Phong");
    assert_eq!(phong["laws"]["kept"], serde_json::json!(["non-negative"]));
    assert_eq!(phong["laws"]["broken"], serde_json::json!(["reciprocal", "energy conserving"]));
    let k_d =
        phong["parameters"].as_array().expect("a list").iter().find(|p| p["name"] == "k_d").expect("there");
    assert_eq!(
        (k_d["min"].as_f64(), k_d["max"].as_f64(), k_d["default"].as_f64()),
        (Some(0.5), Some(1.0), Some(0.8))
    );
    assert_eq!(k_d["type"], "number");
    // The rest follows them.
    let headings = ["Basic", "\nShading models\n", "\nLight types\n", "\nObject types\n"];
    let places: Vec<_> = headings.iter().map(|heading| table.find(heading).expect(heading)).collect();
    assert!(places.is_sorted());
    for (heading, expected) in [
        (1, "  gouraud "),
        (2, "cone_angle (cone angle) °"),
        (2, "intensity in cd"),
        (3, "tessellation 2 to 256"),
        (3, "tube_radius"),
    ] {
        let section = &table[places[heading]..places.get(heading + 1).copied().unwrap_or(table.len())];
        assert!(section.contains(expected), "{expected}: {section}");
    }
    let registry = lights_camera_models::registry::Registry::builtin();
    let kinds = [
        ("reflection model", registry.models().len()),
        ("shading model", registry.shading_models().len()),
        ("light type", registry.lights().len()),
        ("object type", registry.shapes().len()),
    ];
    let listed: Vec<_> =
        models.as_array().expect("a list").iter().map(|m| m["kind"].as_str().expect("a kind")).collect();
    let expected: Vec<_> = kinds.iter().flat_map(|(kind, count)| vec![*kind; *count]).collect();
    assert_eq!(listed, expected);
    let spot = models.as_array().expect("a list").iter().find(|m| m["id"] == "spot").expect("there");
    assert_eq!((&spot["unit"], &spot["parameters"][0]["name"]), (&"cd".into(), &"cone_angle".into()));
}

#[test]
fn evaluate_gives_the_brdf_of_lambert() {
    let run = lcm(
        &["evaluate", "lambert", "--set", "base_colour=255,188,0"],
        "theta_i,phi_i,theta_o,phi_o\n0,0,0,0\n 60 ,10,30.50,270\n95,0,0,0\n0,0,90,0\n",
    );
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    let lines: Vec<_> = run.out.lines().collect();
    assert_eq!(lines[0], "theta_i,phi_i,theta_o,phi_o,f_r,f_g,f_b");
    assert!(lines[2].starts_with("60,10,30.50,270,"), "{}", lines[2]);
    for line in &lines[1..3] {
        let f: Vec<f32> = line.split(',').skip(4).map(|v| v.parse().expect("a number")).collect();
        assert!((f[0] - std::f32::consts::FRAC_1_PI).abs() < 1e-6, "{line}");
        assert!((f[1] - 0.502_886 * std::f32::consts::FRAC_1_PI).abs() < 1e-5, "{line}");
        assert_eq!(f[2], 0.0);
    }
    assert_eq!(&lines[3..], ["95,0,0,0,0,0,0", "0,0,90,0,0,0,0"], "nothing below the surface");
}

#[test]
fn evaluate_reports_every_bad_line() {
    let run = lcm(&["evaluate", "phong"], "theta_i,phi_i,theta_o,phi_o\n0,0,0\n-1,0,x,0\n");
    refused(
        &run,
        1,
        "standard input:2: there are 3 columns, but there must be 4: theta_i,phi_i,theta_o,phi_o",
    );
    assert!(run.err.contains("standard input:3: theta_i is \"-1\", but it must be between 0 and 180"));
    assert!(run.err.contains("standard input:3: theta_o is \"x\", but it must be a finite number"));
    refused(
        &lcm(&["evaluate", "phong"], "0,0,0,0\n"),
        1,
        "standard input:1: the header is \"0,0,0,0\", but it must be theta_i",
    );
    refused(&lcm(&["evaluate", "phong"], ""), 1, "standard input is empty");
    refused(&lcm_in(root(), &["evaluate", "phong"], b"theta\xFF"), 1, "not UTF-8");
}

#[test]
fn albedo_integrates_on_both_machines() {
    for machine in ["cpu", "gpu"] {
        let run = lcm(
            &["albedo", "lambert", "--set", "base_colour=255,188,0", "--on", machine],
            "mu\n1.0\n 0.25\n1e-6\n",
        );
        assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
        let lines: Vec<_> = run.out.lines().collect();
        assert_eq!((lines.len(), lines[0]), (4, "mu,e_r,e_g,e_b"));
        for (line, mu) in lines[1..].iter().zip(["1.0", "0.25", "1e-6"]) {
            let cells: Vec<_> = line.split(',').collect();
            let e: Vec<f32> = cells[1..].iter().map(|v| v.parse().expect("a number")).collect();
            assert_eq!((cells[0], e[2]), (mu, 0.0));
            assert!((e[0] - 1.0).abs() < 1e-4 && (e[1] - 0.502_886).abs() < 1e-4, "{line}");
        }
        // A narrow lobe at normal incidence. The response of this family has no cosine.
        let set = ["k_d=0.5", "k_s=1", "alpha=998", "base_colour=0,0,0"];
        let mut arguments = vec!["albedo", "phong", "--on", machine];
        arguments.extend(set.iter().flat_map(|s| ["--set", *s]));
        let run = lcm(&arguments, "mu\n1\n");
        let e: f32 = run.out.lines().nth(1).and_then(|l| l.split(',').nth(1)).unwrap().parse().unwrap();
        // ∫ cos^998 over the hemisphere, over π. An exponent of 999 fails.
        assert!((e - 2.0 / 999.0).abs() < 5e-7, "{e}");
    }
}

#[test]
fn albedo_reports_every_bad_line() {
    let run = lcm(&["albedo", "phong"], "mu\n0\n1.5\nx\n1,2\n0.5\n");
    refused(&run, 1, "standard input:2: mu is \"0\", but it must be greater than 0 and at most 1");
    for expected in [
        "standard input:3: mu is \"1.5\", but it must be greater than 0 and at most 1",
        "standard input:4: mu is \"x\", but it must be a finite number",
        "standard input:5: there are 2 columns, but there must be 1: mu",
    ] {
        assert!(run.err.contains(expected), "{}\nnot: {expected}", run.err);
    }
    refused(&lcm(&["albedo", "phong"], "0.5\n"), 1, "the header is \"0.5\", but it must be mu");
    refused(&lcm(&["albedo", "phong"], ""), 1, "standard input is empty");
    assert_eq!(lcm(&["albedo", "phong", "--on", "gpu"], "mu\n").out, "mu,e_r,e_g,e_b\n");
}

#[test]
fn a_closed_pipe_is_no_error() {
    for arguments in [&["schema"][..], &["models", "--json"], &["evaluate", "lambert"]] {
        let mut child = Command::new(env!("CARGO_BIN_EXE_lcm"))
            .args(arguments)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("started");
        // Closes the reading end before anything is written.
        drop(child.stdout.take());
        let mut stdin = child.stdin.take().expect("piped");
        let table = format!("theta_i,phi_i,theta_o,phi_o\n{}", "1,2,3,4\n".repeat(20_000));
        let _ = std::io::Write::write_all(&mut stdin, table.as_bytes());
        drop(stdin);
        let mut said = String::new();
        child.stderr.take().expect("piped").read_to_string(&mut said).expect("text");
        assert_eq!((child.wait().expect("ended").code(), said.as_str()), (Some(0), ""), "{arguments:?}");
    }
}

/// Mesa looks for a Wayland display even without the variable, and one of its libraries complains.
#[cfg(target_os = "linux")]
#[test]
fn nothing_is_printed_about_a_runtime_folder_that_is_not_set() {
    let folder = tempfile::tempdir().expect("a folder");
    for value in [None, Some(""), Some("relative")] {
        let arguments = ["render", "--renderer", "gpu", "--size", "16x16", "-o", "x.png"];
        let mut command = command_in(folder.path(), arguments);
        command.env_remove("XDG_RUNTIME_DIR").envs(value.map(|v| ("XDG_RUNTIME_DIR", v)));
        let run = Run::from(command.output().expect("the program starts"));
        assert!(run.status == Some(0) && !run.err.contains("XDG_RUNTIME_DIR"), "{value:?}: {}", run.err);
    }
}

/// Counts the starts of the program, and the addresses that the dynamic linker relocates in one of them,
/// which make up the time of a start before `main`.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn starts(arguments: &[&str]) -> (usize, Vec<usize>) {
    let folder = tempfile::tempdir().expect("a folder");
    let mut command = command_in(folder.path(), arguments.iter().copied());
    command.env_remove("XDG_RUNTIME_DIR").env("LD_DEBUG", "statistics").env("LD_DEBUG_OUTPUT", "starts");
    let run = Run::from(command.output().expect("the program starts"));
    assert_eq!(run.status, Some(0), "{arguments:?}: {}", run.err);
    let reports: String = std::fs::read_dir(folder.path())
        .expect("readable")
        .filter_map(|file| Some(file.ok()?.path()))
        .filter(|file| file.file_name().is_some_and(|name| name.to_string_lossy().starts_with("starts.")))
        .map(|file| std::fs::read_to_string(file).expect("text"))
        .collect();
    let relative = reports.lines().filter_map(|line| line.split_once("number of relative relocations:"));
    let relative = relative.filter_map(|(_, count)| count.trim().parse().ok()).collect();
    (reports.matches("total startup time").count(), relative)
}

/// Only a driver needs the variable, so other commands do not pay for a second start.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
#[test]
fn the_program_starts_again_only_where_a_driver_is_loaded() {
    let cpu = ["render", "--renderer", "cpu", "--size", "16x16", "-o", "x.png"];
    for arguments in [&["--version"][..], &["models"], &["schema"], &["new", "x.json"], &cpu] {
        assert_eq!(starts(arguments).0, 1, "{arguments:?}");
    }
    let gpu = ["render", "--renderer", "gpu", "--size", "16x16", "-o", "x.png"];
    assert_eq!(starts(&gpu).0, 2);
}

/// A program started by `script` writes to a terminal.
#[test]
#[cfg(target_os = "linux")]
fn a_picture_that_takes_long_says_so_on_a_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let text = std::fs::read_to_string(root().join("scenes/default.json")).expect("readable");
    let mut scene: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    let place = |i: usize, n: usize| 0.5 + 9.0 * i as f32 / n as f32;
    let spheres = (0..10_000).map(|i| {
        let position = [place(i % 20, 19), place(i / 20 % 20, 19), place(i / 400, 24)];
        serde_json::json!({ "type": "sphere", "position": position, "size": 0.3, "tessellation": 48 })
    });
    scene["objects"] = spheres.collect::<Vec<_>>().into();
    std::fs::write(folder.path().join("many.json"), scene.to_string()).expect("written");
    // On one processor, where it takes more than a second on any machine.
    let command = format!(
        "taskset -c 0 {} render many.json -o many.png --renderer cpu --size 2560x1440",
        env!("CARGO_BIN_EXE_lcm")
    );
    let mut on_terminal = std::process::Command::new("script");
    on_terminal.args(["-qec", &command, "/dev/null"]).current_dir(folder.path());
    let output = on_terminal.output().expect("script is a part of every Linux");
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(said.contains("drawing many.json, 1s so far; Ctrl+C ends it"), "{said}");
    assert!(said.contains("wrote many.png"), "{said}");
    // Interrupted meanwhile, it leaves nothing.
    let command = format!(
        "exec taskset -c 0 {} render many.json -o new/many.png --renderer cpu",
        env!("CARGO_BIN_EXE_lcm")
    );
    let mut program = std::process::Command::new("sh")
        .args(["-c", &command])
        .current_dir(folder.path())
        .spawn()
        .expect("a shell");
    std::thread::sleep(std::time::Duration::from_millis(800));
    let ended = std::process::Command::new("kill").args(["-TERM", &program.id().to_string()]).status();
    assert!(ended.expect("kill").success());
    let status = program.wait().expect("it ends");
    assert!(!status.success() && !folder.path().join("new").exists(), "{status}");
}

/// Without a GPU, the driver keeps the triangles that it has not drawn yet.
#[test]
#[cfg(target_os = "linux")]
fn thousands_of_objects_take_little_more_memory_with_the_driver_than_without() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = |i: usize| 0.1 + 9.8 * i as f32 / 49.0;
    let spheres = (0..2500).map(|i| {
        serde_json::json!({ "type": "sphere", "position": [place(i % 50), place(i / 50), 1], "size": 0.16 })
    });
    let text = fs::read_to_string(root().join("scenes/default.json")).expect("readable");
    let mut scene: Value = serde_json::from_str(&text).expect("JSON");
    scene["objects"] = spheres.collect::<Vec<_>>().into();
    fs::write(folder.path().join("many.json"), scene.to_string()).expect("written");
    let [cpu, gpu] = ["cpu", "gpu"].map(|renderer| {
        let picture = format!("{renderer}.png");
        peak(command_in(
            folder.path(),
            ["render", "many.json", "--renderer", renderer, "-o", picture.as_str()],
        ))
    });
    assert!(gpu <= 3 * cpu + 150, "{gpu} MiB with the driver, {cpu} MiB without");
}

#[test]
#[cfg(target_os = "linux")]
fn a_new_scene_is_no_stream() {
    let ran = lcm(&["new", "/dev/stdout"], "");
    assert_eq!(ran.status, Some(4));
    assert!(
        ran.err.contains("/dev/stdout was not written: it is a named pipe, not a regular file"),
        "{}",
        ran.err
    );
}

#[test]
fn a_picture_with_a_caption_is_no_higher_than_a_picture_may_be() {
    let folder = tempfile::tempdir().expect("a folder");
    let draw = |size: &str| {
        let arguments = ["render", "-o", "x.png", "--renderer", "cpu", "--caption", "--size", size];
        lcm_in(folder.path(), &arguments, b"")
    };
    let run = draw("1x16384");
    assert_eq!(run.status, Some(2), "{}", run.err);
    assert!(run.err.contains("1x16384 with a caption of up to "), "{}", run.err);
    assert_eq!(draw("1x16000").status, Some(0));
}
