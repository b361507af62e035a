//! Results never replace inputs, are written whole or not at all, and leave nothing behind when a signal ends
//! the program.

#![cfg(target_os = "linux")]

use std::{
    fs,
    os::unix::{fs::symlink, process::ExitStatusExt as _},
    path::Path,
    process::{Child, Stdio},
    thread,
    time::{Duration, Instant},
};

use lights_camera_models::files;

use crate::helpers::support::{Run, command_in, lcm_in, names, root};

fn refused(run: &Run, status: i32, expected: &str) {
    assert_eq!(run.status, Some(status), "{}", run.err);
    assert!(run.err.contains(expected), "{:?} should contain {expected:?}", run.err);
}

/// A folder with a scene that has two views.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = root().join("scenes/compare_phong_blinn_phong.json");
    fs::copy(scene, folder.path().join("s.json")).expect("copied");
    folder
}

#[test]
fn match_never_replaces_the_scene_that_it_reads() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let before = fs::read(at("s.json")).expect("there");
    symlink("s.json", at("link.json")).expect("linked");
    fs::hard_link(at("s.json"), at("hard.json")).expect("linked");
    let matched = |scene: &str, output: &str, input: &[u8]| {
        let arguments = ["match", scene, "--free", "alpha", "-o", output, "--overwrite"];
        lcm_in(folder.path(), &arguments, input)
    };
    let same = "is the same file as s.json, which is read by this command; it was not overwritten";
    for (output, expected) in [
        ("s.json", "s.json is read by this command; it was not overwritten"),
        ("./s.json", "s.json is read by this command"),
        ("link.json", same),
        ("hard.json", same),
    ] {
        refused(&matched("s.json", output, b""), 4, expected);
    }
    // A shell may pass it the file as its standard input.
    let run = command_in(folder.path(), ["match", "-", "--free", "alpha", "-o", "s.json", "--overwrite"])
        .stdin(fs::File::open(at("s.json")).expect("readable"))
        .output()
        .expect("it runs");
    refused(&run.into(), 4, "which is read by this command");
    assert_eq!(fs::read(at("s.json")).expect("there"), before);
    // Any other file may be replaced.
    fs::copy(at("s.json"), at("other.json")).expect("copied");
    let run = matched("s.json", "other.json", b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert_ne!(fs::read(at("other.json")).expect("there"), before);
}

#[test]
fn match_says_before_its_search_that_a_file_cannot_hold_the_scene() {
    let folder = folder();
    for (output, expected) in [
        ("notes.txt", "notes.txt was not written: .txt is not the extension of a scene"),
        ("x.csv", "x.csv was not written: its format would lose comparison; save the scene as JSON"),
        ("new/x.csv", "new/x.csv was not written: its format would lose comparison"),
        ("x.png", "x.png was not written: files of the format PNG picture can only be read"),
    ] {
        let run = lcm_in(folder.path(), &["match", "s.json", "-o", output, "--overwrite"], b"");
        refused(&run, 4, expected);
        assert_eq!(run.out, "", "the search has not begun");
    }
    assert_eq!(names(folder.path()), ["s.json"]);
}

#[test]
fn where_a_result_cannot_be_written_its_command_says_so_before_it_draws() {
    let folder = folder();
    for arguments in [
        &["render", "s.json", "--size", "4096x4096", "--renderer", "cpu", "-o", "/proc/a.png"][..],
        &["render", "s.json", "--view", "A", "--size", "2048x2048", "-o", "/proc/a.exr"],
        &[
            "sweep",
            "s.json",
            "--size",
            "2048x2048",
            "--vary",
            "display.exposure=-2..2:5",
            "-o",
            "/proc/sw.gif",
        ],
        &["sweep", "s.json", "--size", "4096x4096", "--vary", "display.exposure=-2..2:9", "-o", "/proc/all"],
        &["materials", "--size", "1024", "-o", "/proc/m.png"],
        &["compare", "s.json", "--size", "4096x4096", "-o", "/proc/c.png"],
        &["match", "s.json", "--free", "alpha", "-o", "/proc/m.json"],
        &["manual", "/proc/man"],
    ] {
        let start = Instant::now();
        let run = lcm_in(folder.path(), arguments, b"");
        refused(
            &run,
            4,
            "could not be written: /proc is a folder of the system in which no files can be created",
        );
        assert!(start.elapsed().as_secs() < 10, "{arguments:?}: {:?}", start.elapsed());
    }
    let files = |place: &str| files::can_begin(&folder.path().join(place)).map_err(|error| error.to_string());
    // Nothing remains of the attempt.
    assert_eq!(files("new/er/a.png"), Ok(()));
    assert!(files("s.json/a.png").is_err_and(|error| error.ends_with("s.json is not a folder")));
    assert_eq!(names(folder.path()), ["s.json"]);
}

#[test]
fn no_folder_is_made_that_the_way_to_a_result_only_passes() {
    let folder = folder();
    let work = folder.path().join("work");
    fs::create_dir(&work).expect("made");
    let render = |output: &str| {
        let usual = ["render", "../s.json", "--size", "64x36", "--renderer", "cpu", "--samples", "1", "-o"];
        lcm_in(&work, &[&usual[..], &[output]].concat(), b"")
    };
    refused(&render("b/../../s.json/c.png"), 4, "s.json is not a folder");
    assert_eq!((names(&work), names(folder.path())), (vec![], vec!["s.json".to_owned(), "work".to_owned()]));
    let run = render("b/../../zz/c.png");
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert_eq!((names(&work), names(&folder.path().join("zz"))), (vec![], vec!["c.png".to_owned()]));
}

#[test]
fn attempts_to_write_into_one_new_folder_do_not_disturb_each_other() {
    let folder = folder();
    let place = folder.path().join("new/er/a.png");
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| (0..200).for_each(|_| files::can_begin(&place).expect("it can be made")));
        }
    });
}

#[test]
fn a_dash_is_no_output_of_any_command() {
    let folder = folder();
    for arguments in [
        &["render", "s.json", "-o", "-"][..],
        &["sweep", "s.json", "--vary", "objects[0].size=1,2", "-o", "-"],
        &["compare", "s.json", "-o", "-"],
        &["match", "s.json", "-o", "-"],
        &["export", "s.json", "--as", "html", "-o", "-"],
        &["export", "s.json", "--as", "bevy", "-o", "-"],
        &["plot", "phong", "-o", "-"],
        &["study", "--quick", "-o", "-"],
        &["view", "s.json", "--exit-after", "1", "--capture", "-"],
        &["new", "-"],
        &["assets", "export", "-"],
    ] {
        let run = lcm_in(folder.path(), arguments, b"");
        refused(&run, 2, "results go to files and folders; name one (./- for one called -)");
        assert_eq!(run.out, "");
    }
    assert_eq!(names(folder.path()), ["s.json"]);
    // Pictures go into a folder where the name has no extension.
    let run = lcm_in(
        folder.path(),
        &["render", "s.json", "--size", "64x36", "--renderer", "cpu", "-o", "./-"],
        b"",
    );
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert_eq!(names(&folder.path().join("-")), ["s.png"]);
    let run = lcm_in(folder.path(), &["new", "./-.json"], b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
}

/// Starts an export in a folder.
fn export(folder: &Path, arguments: &[&str]) -> Child {
    command_in(folder, [&["export", "s.json"], arguments].concat())
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts")
}

#[test]
fn of_four_exports_to_one_new_place_one_wins_and_the_others_say_so() {
    for (form, place) in [("bevy", "new"), ("html", "new.html"), ("executable", "new.exe")] {
        let folder = folder();
        let all: Vec<_> = (0..4).map(|_| export(folder.path(), &["--as", form, "-o", place])).collect();
        let ended: Vec<Run> =
            all.into_iter().map(|child| child.wait_with_output().expect("it ends").into()).collect();
        let won = ended.iter().filter(|run| run.status == Some(0) && run.err.contains("wrote")).count();
        assert_eq!(won, 1, "{form}: {:?}", ended.iter().map(|run| &run.err).collect::<Vec<_>>());
        for run in ended.iter().filter(|run| run.status != Some(0)) {
            assert_eq!(run.status, Some(4), "{form}: {}", run.err);
            let late = run.err.contains(&format!("{place} exists; it was not overwritten"));
            let lost = run.err.contains(&format!("another program wrote {place} during this export"));
            assert!(late || lost, "{form}: {}", run.err);
        }
        assert_eq!(names(folder.path()), [place, "s.json"], "{form}");
    }
}

/// Sends a signal.
fn signal(child: &Child, name: &str) {
    let sent = std::process::Command::new("kill").args(["-s", name, &child.id().to_string()]).status();
    assert!(sent.expect("there is kill").success());
}

#[test]
fn an_export_ended_by_a_signal_leaves_nothing() {
    for (name, number) in [("INT", 2), ("TERM", 15), ("HUP", 1)] {
        // A program is large, so it takes a while to write; a late signal means another try.
        let caught = (0..20).any(|_| {
            let folder = folder();
            let mut command = std::process::Command::new("env");
            let own = command_in(folder.path(), ["export", "s.json", "--as", "executable"]);
            command.arg("--default-signal=INT,HUP,TERM").arg(own.get_program()).args(own.get_args());
            command.current_dir(folder.path()).env("LCM_DATA_DIR", folder.path().join("none"));
            let mut child = command.stdin(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
            let exports = folder.path().join("exports");
            let begun = || exports.is_dir() && names(&exports).iter().any(|name| name.starts_with(".lcm-"));
            while !begun() && child.try_wait().expect("asked").is_none() {
                thread::sleep(Duration::from_micros(200));
            }
            signal_if_running(&mut child, name);
            let status = child.wait().expect("it ends");
            if status.signal() == Some(number) {
                assert_eq!(names(folder.path()), ["s.json"], "SIG{name}: not even the new folder stays");
                return true;
            }
            assert!(status.success(), "{status}");
            false
        });
        assert!(caught, "SIG{name} always came too late");
    }
}

fn signal_if_running(child: &mut Child, name: &str) {
    if child.try_wait().expect("asked").is_none() {
        signal(child, name);
    }
}

#[test]
fn a_list_of_models_with_a_broken_one_fails_and_names_it() {
    let folder = folder();
    let models = folder.path().join("models");
    fs::create_dir(&models).expect("made");
    let good = fs::read_to_string(root().join("assets/models/gooch.wgsl")).expect("there");
    fs::write(models.join("gooch.wgsl"), &good).expect("written");
    let list =
        |more: &[&str]| lcm_in(folder.path(), &[&["models", "--models", "models"], more].concat(), b"");
    let run = list(&[]);
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
    // A declaration, and an equation.
    let broken = good.replace("fn response(", "fn respons(");
    let undeclared = good.replacen("\"name\"", "name\"", 1);
    for (name, text) in [("odd.wgsl", &undeclared), ("wrong.wgsl", &broken)] {
        fs::write(models.join(name), text).expect("written");
        for more in [&[][..], &["--json"]] {
            let run = list(more);
            refused(&run, 1, name);
            assert!(run.out.contains("lambert") && run.out.contains("gooch"), "the rest is listed");
        }
        fs::remove_file(models.join(name)).expect("removed");
    }
}

#[test]
fn an_input_is_spared_whatever_leads_to_it() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir(at("in")).expect("made");
    fs::write(at("in/a"), "a").expect("written");
    fs::write(at("b"), "b").expect("written");
    symlink("in", at("link")).expect("linked");
    fs::hard_link(at("in/a"), at("hard")).expect("linked");
    let inputs = [at("in/a")];
    let spared = |output: &str| files::spare(&at(output), inputs.iter().map(|p| p.as_path())).is_err();
    for output in ["in/a", "in/../in/a", "link/a", "hard", "in", "link", "."] {
        assert!(spared(output), "{output}");
    }
    for output in ["b", "in/b", "new", "link/new"] {
        assert!(!spared(output), "{output}");
    }
}
