//! Paths other than regular files, outputs that would overwrite something, leftovers of killed processes, and
//! texts unsafe for a terminal. Nothing here may hang: every wait has a limit.

#![cfg(target_os = "linux")]

use std::{
    env,
    ffi::OsStr,
    fs::{self, File},
    io::{Read as _, Write as _},
    os::unix::{
        ffi::OsStrExt as _,
        fs::{MetadataExt as _, PermissionsExt as _, chown, symlink},
        net::UnixListener,
    },
    path::{Path, PathBuf},
    process::{Command, Stdio},
    sync::mpsc,
    thread,
    time::{Duration, Instant, SystemTime, UNIX_EPOCH},
};

use lights_camera_models::{
    files::{self, Draft, FileError, Kind, printable},
    panel::{
        files::{Files as _, OnDisk, Opened, Saved},
        settings::{self, Settings},
        state::{Session, Severity},
    },
    parameter::Outside,
    registry::Registry,
    scene::{
        Object, Scene,
        load::{self, Defaults, Stamp},
        save::{self, Expected, SaveError},
    },
    window::files::DiskFiles,
};

use crate::{
    helpers::screen::{self, Screen},
    helpers::skipped::skip,
    helpers::support::{command_in, full_scene, names, read, root, written},
};

/// Long enough for anything tried here, even on a busy machine.
const LIMIT: Duration = Duration::from_secs(60);

/// Runs something that must finish.
fn bounded<T: Send + 'static>(what: &str, work: impl FnOnce() -> T + Send + 'static) -> T {
    let (done, wait) = mpsc::channel();
    thread::spawn(move || done.send(work()));
    wait.recv_timeout(LIMIT).unwrap_or_else(|e| panic!("{what}: {e}"))
}

/// The result of a run of a program.
struct Ran {
    status: Option<i32>,
    out: Vec<u8>,
    err: String,
}

/// Runs a program that must finish, and kills it if it does not.
fn run(command: &mut Command) -> Ran {
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("it starts");
    let all = |mut from: Box<dyn std::io::Read + Send>| {
        thread::spawn(move || {
            let mut bytes = Vec::new();
            from.read_to_end(&mut bytes).expect("readable");
            bytes
        })
    };
    let out = all(Box::new(child.stdout.take().expect("piped")));
    let err = all(Box::new(child.stderr.take().expect("piped")));
    let begin = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("asked") {
            break status;
        }
        if begin.elapsed() > LIMIT {
            child.kill().expect("killed");
            child.wait().expect("ended");
            panic!("{command:?} did not end");
        }
        thread::sleep(Duration::from_millis(5));
    };
    let err = String::from_utf8_lossy(&err.join().expect("no panic")).into_owned();
    assert!(!err.contains("panicked"), "{err}");
    Ran { status: status.code(), out: out.join().expect("no panic"), err }
}

/// The program in a folder, without a display and without input.
fn lcm<A: AsRef<OsStr>>(folder: &Path, arguments: impl IntoIterator<Item = A>) -> Command {
    let mut command = command_in(folder, arguments);
    command
        .env_remove("DISPLAY")
        .env_remove("WAYLAND_DISPLAY")
        .env("LCM_DATA_DIR", folder.join("no-such-folder"))
        .stdin(Stdio::null());
    command
}

/// A shell that runs the program as `"$LCM"` in a folder.
fn shell(folder: &Path, script: &str) -> Command {
    let mut command = lcm(folder, [] as [&str; 0]);
    let mut shell = Command::new("sh");
    shell.args(["-c", script]).env("LCM", command.get_program()).current_dir(folder).stdin(Stdio::null());
    for (name, value) in command.env("PATH", env::var_os("PATH").expect("set")).get_envs() {
        match value {
            Some(value) => shell.env(name, value),
            None => shell.env_remove(name),
        };
    }
    shell
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().expect("a folder")
}

fn pipe(path: &Path) {
    assert!(Command::new("mkfifo").arg(path).status().expect("mkfifo runs").success());
}

fn save(path: &Path, scene: &Scene, expected: Expected) -> Result<Stamp, SaveError> {
    save::write(path, scene, &Registry::builtin(), expected)
}

fn scene_in(path: &Path) -> Scene {
    load::file(path, &Registry::builtin(), Defaults::Refuse).unwrap_or_else(|e| panic!("{e}")).scene
}

/// Asserts the status and one line on standard error with a given text.
fn refused(ran: &Ran, status: i32, expected: &str) {
    assert_eq!(ran.status, Some(status), "{}", ran.err);
    assert!(ran.err.contains(expected), "{}\nnot: {expected}", ran.err);
    assert_eq!(ran.err.trim_end().lines().count(), 1, "{}", ran.err);
}

/// Things other than regular files, with a description of each.
fn no_files(at: &Path) -> Vec<(PathBuf, Kind)> {
    let named = |name: &str| at.join(name);
    pipe(&named("pipe.json"));
    symlink("pipe.json", named("link-to-pipe.json")).expect("linked");
    drop(UnixListener::bind(named("socket.json")).expect("bound"));
    let mut all = vec![
        (named("pipe.json"), Kind::Pipe),
        (named("link-to-pipe.json"), Kind::Pipe),
        (named("socket.json"), Kind::Socket),
    ];
    for device in ["null", "full", "zero"] {
        let link = named(&format!("{device}.json"));
        symlink(Path::new("/dev").join(device), &link).expect("linked");
        all.push((link, Kind::Device));
    }
    all
}

#[test]
fn a_document_is_only_saved_to_a_file() {
    let folder = folder();
    let all = no_files(folder.path());
    let before: Vec<_> = all.iter().map(|(path, _)| fs::metadata(path).expect("there").ino()).collect();
    let there = names(folder.path());
    for (path, kind) in &all {
        for expected in [Expected::Nothing, Expected::Anything, Expected::Unchanged(Stamp::of(b""))] {
            let at = path.clone();
            let error = bounded("saving", move || save(&at, &Scene::default(), expected));
            let said = error.expect_err("is no file").to_string();
            let rule = format!("{} was not written: it is {kind}, not a regular file", path.display());
            assert_eq!(said, rule, "{expected:?}");
        }
        let at = path.clone();
        let error = bounded("writing", move || files::write(&at, b"{}")).expect_err("is no file");
        assert!(matches!(error, FileError::Kind(found) if found == *kind), "{error}");
        let at = path.clone();
        let error = bounded("reading", move || files::read(&at, 1000)).expect_err("is no file");
        assert!(matches!(error, FileError::Kind(found) if found == *kind), "{error}");
        refused(&run(&mut lcm(folder.path(), [OsStr::new("new"), path.as_os_str()])), 4, &kind.to_string());
        let at = path.clone();
        let said = bounded("a draft", move || Draft::new(&at).map(drop)).expect_err("is no file").to_string();
        assert_eq!(said, format!("it is {kind}, but it must be a file"));
    }
    let after: Vec<_> = all.iter().map(|(path, _)| fs::metadata(path).expect("there").ino()).collect();
    assert_eq!((after, names(folder.path())), (before, there), "nothing was replaced or left");
}

#[test]
fn what_takes_the_place_of_a_file_before_it_is_replaced_is_not_replaced() {
    let folder = folder();
    let file = folder.path().join("a.json");
    fs::write(&file, "old").expect("written");
    let mut draft = Draft::new(&file).expect("a file");
    draft.write_all(b"new").expect("written");
    fs::remove_file(&file).expect("removed");
    pipe(&file);
    assert!(matches!(draft.replace(), Err(FileError::Kind(Kind::Pipe))));
    assert_eq!(names(folder.path()), ["a.json"]);
    assert_eq!(files::kind(&file).expect("there"), Kind::Pipe);
}

#[test]
fn a_file_that_is_larger_than_its_limit_is_not_read() {
    let folder = folder();
    let file = folder.path().join("a");
    fs::write(&file, [7; 1000]).expect("written");
    assert_eq!(files::read(&file, 1000).expect("fits").len(), 1000);
    assert!(matches!(files::read(&file, 999), Err(FileError::TooLarge(999))));
    assert_eq!(files::read_start(&file, 3).expect("readable"), [7; 3]);
    // Streams do not report their length.
    let status = files::read(Path::new("/proc/self/status"), 1 << 20).expect("readable");
    assert!(status.len() > 100);
    assert!(matches!(files::read(Path::new("/proc/self/status"), 100), Err(FileError::TooLarge(100))));
}

#[test]
fn an_open_document_that_becomes_a_pipe_or_a_device_is_kept_and_told_of() {
    for kind in [Kind::Pipe, Kind::Device] {
        let folder = folder();
        let file = folder.path().join("a.json");
        save(&file, &Scene::default(), Expected::Nothing).expect("written");
        let registry = Registry::builtin();
        let stamp = load::file(&file, &registry, Defaults::Ask).expect("valid").stamp;
        let mut disk = DiskFiles::new(Some(file.clone()), Some(stamp));
        assert_eq!(disk.check(&file, &registry, Outside::NONE), OnDisk::Same);
        fs::remove_file(&file).expect("removed");
        match kind {
            Kind::Pipe => pipe(&file),
            _ => symlink("/dev/zero", &file).expect("linked"),
        }
        let (found, opened, saved) = bounded("looking and saving", move || {
            let found = disk.check(&file, &registry, Outside::NONE);
            let opened = disk.open(&file, &registry, Outside::NONE);
            let saved = [true, false].map(|over| disk.save(&file, &Scene::default(), &registry, over));
            (found, opened, saved)
        });
        let told = |content: &Opened| match content {
            Opened::Failed(problems) => problems.join("\n"),
            other => panic!("{other:?}"),
        };
        let OnDisk::Changed { content, .. } = found else { panic!("{found:?}") };
        assert!(told(&content).contains(&kind.to_string()), "{content:?}");
        assert!(told(&opened).contains(&kind.to_string()), "{opened:?}");
        for saved in saved {
            assert!(matches!(&saved, Saved::Failed(why) if why.contains(&kind.to_string())), "{saved:?}");
        }
    }
}

#[test]
fn settings_that_are_no_small_file_are_the_defaults_at_once() {
    type Make = fn(&Path);
    let cases: [(Make, &str); 3] = [
        (|file| pipe(file), "a named pipe"),
        (|file| symlink("/dev/zero", file).expect("linked"), "a device"),
        (|file| File::create(file).and_then(|f| f.set_len(200 << 20)).expect("written"), "larger than 1 MiB"),
    ];
    let screen = Screen::new(640, 480);
    for (make, expected) in cases {
        let folder = folder();
        make(&folder.path().join("settings.json"));
        let at = folder.path().to_owned();
        let (settings, complaint) = bounded("loading settings", move || settings::load(&at));
        let complaint = complaint.expect("says so");
        assert_eq!(settings, Settings::default());
        assert!(complaint.contains("cannot be read") && complaint.contains(expected), "{complaint}");
        let at = folder.path().to_owned();
        let saved = bounded("saving settings", move || settings::save(&at, &Settings::default()));
        // A file too large for settings may be replaced by them.
        assert_eq!(saved.is_ok(), expected.contains("MiB"), "{saved:?}");
        let shown = run(screen
            .command(&["view", "--exit-after", "3", "--capture", "window.png"], folder.path())
            .current_dir(folder.path()));
        assert_eq!(shown.status, Some(0), "{}", shown.err);
        assert!(folder.path().join("window.png").exists());
    }
}

#[test]
fn a_command_reads_streams_but_waits_for_nobody() {
    let folder = folder();
    let at = folder.path();
    pipe(&at.join("pipe"));
    fs::write(at.join("a.json"), full_scene().to_string()).expect("written");
    refused(&run(&mut lcm(at, ["check", "pipe"])), 1, "pipe is a named pipe; a scene is a single file");
    refused(&run(&mut lcm(at, ["render", "pipe", "-o", "x.png"])), 1, "a named pipe");
    refused(&run(&mut lcm(at, ["view", "pipe"])), 1, "a named pipe");
    refused(&run(&mut lcm(at, ["check", "/dev/zero"])), 1, "/dev/zero is larger than 64 MiB");
    for script in [
        "cat a.json | \"$LCM\" check /dev/stdin",
        "(sleep 1; cat a.json) | \"$LCM\" check /dev/stdin",
        "(sleep 1; cat a.json) | \"$LCM\" check /dev/fd/3 3<&0",
        "\"$LCM\" check /dev/fd/3 3<a.json",
        "cat a.json > pipe & \"$LCM\" check pipe",
        "(sleep 1; cat a.json > pipe) & \"$LCM\" check pipe",
    ] {
        let ran = run(&mut shell(at, script));
        assert_eq!(ran.status, Some(0), "{script}: {}", ran.err);
        assert!(
            String::from_utf8_lossy(&ran.out).ends_with(": valid: 4 lights, 4 objects, 2 variants\n"),
            "{script}"
        );
    }
}

#[test]
fn models_and_shaders_that_are_no_files_hold_nothing_up() {
    let folder = folder();
    let at = folder.path();
    fs::create_dir(at.join("models")).expect("made");
    pipe(&at.join("models/pipe.wgsl"));
    symlink("/dev/zero", at.join("models/zero.wgsl")).expect("linked");
    let listed = run(&mut lcm(at, ["models", "--models", "models"]));
    assert_eq!(listed.status, Some(1), "{}", listed.err);
    for said in ["this is a named pipe, not a regular file", "this is a device, not a regular file"] {
        assert!(listed.err.contains(said), "{}", listed.err);
    }
    // An export must not be compared with an endless file.
    let shader = at.join("assets/shaders/loop.wgsl");
    fs::create_dir_all(shader.parent().expect("has one")).expect("made");
    pipe(&shader);
    refused(
        &run(&mut lcm(at, ["assets", "export", "assets"])),
        4,
        "it is a named pipe, but it must be a file",
    );
    let ran = run(&mut lcm(at, ["check", "--assets", "assets", "x.json"]));
    assert_eq!(ran.status, Some(1), "{}", ran.err);
    assert!(ran.err.contains("this is a named pipe, not a regular file"), "{}", ran.err);
}

/// The signature of PNG files.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Small pictures suffice.
const SMALL: [&str; 4] = ["--size", "32x32", "--renderer", "cpu"];

fn render(folder: &Path, arguments: &[&str]) -> Command {
    lcm(folder, ["render"].iter().chain(arguments).chain(&SMALL))
}

#[test]
fn a_link_to_nothing_says_so() {
    let folder = folder();
    let at = folder.path();
    symlink("nowhere/x.png", at.join("link.png")).expect("linked");
    let ran = run(&mut lcm(at, ["check", "link.png"]));
    refused(&ran, 1, "link.png: file not found; it is a link to nowhere/x.png, which does not exist\n");
}

#[test]
fn a_link_to_itself_and_a_name_without_end_are_said_in_a_few_words() {
    let folder = folder();
    let at = folder.path();
    symlink("loop.json", at.join("loop.json")).expect("linked");
    let circle = "loop.json could not be read: too many links, each leading to the next\n";
    refused(&run(&mut lcm(at, ["check", "loop.json"])), 1, circle);
    let endless = format!("{}… could not be read: the name is too long\n", "x".repeat(60));
    refused(&run(&mut lcm(at, ["check", &*"x".repeat(5000)])), 1, &endless);
}

#[test]
fn a_working_folder_that_is_gone_is_called_so() {
    let folder = folder();
    for (command, what) in [
        ("new a.json", "a.json was not"),
        ("render --size 8x8 --renderer cpu -o b.png", "b.png could not be"),
    ] {
        let script = format!("mkdir gone && cd gone && rmdir ../gone && exec \"$LCM\" {command}");
        let said = format!("{what} written: the working folder has been deleted\n");
        refused(&run(&mut shell(folder.path(), &script)), 4, &said);
    }
}

#[test]
fn pictures_go_to_devices_and_pipes() {
    let folder = folder();
    let at = folder.path();
    for stdout in ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"] {
        let ran = run(&mut render(at, &["-o", stdout]));
        assert_eq!(ran.status, Some(0), "{}", ran.err);
        assert!(ran.out.starts_with(PNG) && ran.out.ends_with(b"IEND\xaeB`\x82"), "{stdout}");
    }
    assert_eq!(run(&mut render(at, &["-o", "/dev/null"])).status, Some(0));
    assert_eq!(files::kind(Path::new("/dev/null")).expect("there"), Kind::Device);
    symlink("/dev/full", at.join("full.png")).expect("linked");
    for full in ["/dev/full", "full.png"] {
        refused(&run(&mut render(at, &["-o", full])), 4, "could not be written: the disk is full\n");
    }
    symlink("nowhere/x.png", at.join("dangling.png")).expect("linked");
    let said = "dangling.png could not be written: there is no folder nowhere\n";
    refused(&run(&mut render(at, &["-o", "dangling.png"])), 4, said);
    #[cfg(target_os = "linux")]
    for place in ["/proc/x.png", "/proc/none/x.png"] {
        let said = "could not be written: /proc is a folder of the system in which no files can be created\n";
        refused(&run(&mut render(at, &["-o", place])), 4, said);
    }
    // On failure, no new folder remains.
    let long = format!("new/folder/{}.png", "x".repeat(300));
    refused(&run(&mut render(at, &["-o", &long])), 4, "the name is too long");
    assert!(!at.join("new").exists());
    // A named pipe with a late reader.
    pipe(&at.join("pipe.png"));
    let from = at.join("pipe.png");
    let reader = thread::spawn(move || {
        thread::sleep(Duration::from_secs(1));
        fs::read(from).expect("readable")
    });
    let ran = run(&mut render(at, &["-o", "pipe.png"]));
    assert_eq!(ran.status, Some(0), "{}", ran.err);
    assert!(bounded("reading", move || reader.join().expect("no panic")).starts_with(PNG));
    assert_eq!(files::kind(&at.join("pipe.png")).expect("there"), Kind::Pipe);
    // And without a reader.
    refused(&run(&mut render(at, &["-o", "pipe.png"])), 4, "no process reads from it");
    // The content of the file on standard output is kept, and the open file is written to.
    let script = "echo before > all; \"$LCM\" render --size 32x32 --renderer cpu -o /dev/stdout >> all; echo after >> all";
    assert_eq!(run(&mut shell(at, script)).status, Some(0));
    let all = fs::read(at.join("all")).expect("readable");
    assert!(all.starts_with(b"before\n\x89PNG") && all.ends_with(b"after\n"));
    drop(UnixListener::bind(at.join("socket.png")).expect("bound"));
    refused(&run(&mut render(at, &["-o", "socket.png"])), 4, "is neither a file nor a folder");
    // A reader that stops early is not an error.
    let ran = run(&mut shell(
        at,
        "\"$LCM\" render --size 2000x2000 --renderer cpu --samples 1 -o /dev/stdout -q | head -c 1",
    ));
    assert_eq!((ran.status, ran.out.as_slice(), ran.err.as_str()), (Some(0), &b"\x89"[..], ""));
}

#[test]
fn a_picture_never_takes_the_place_of_what_is_read_or_of_what_is_no_picture() {
    let folder = folder();
    let at = folder.path();
    let scene = full_scene().to_string();
    fs::write(at.join("s.json"), &scene).expect("written");
    fs::write(at.join("notes.png"), "notes").expect("written");
    fs::write(at.join("notes.txt"), "notes").expect("written");
    fs::write(at.join("empty.png"), "").expect("written");
    symlink("s.json", at.join("link.png")).expect("linked");
    symlink("empty.png", at.join("empty.json")).expect("linked");
    fs::hard_link(at.join("s.json"), at.join("hard.png")).expect("linked");
    fs::create_dir(at.join("models")).expect("made");
    let model = at.join("models/mine.wgsl");
    fs::write(&model, fs::read(root().join("assets/models/gooch.wgsl")).expect("there")).expect("written");
    symlink(&model, at.join("model.png")).expect("linked");
    let same = "is the same file as s.json, which is read by this command; it was not overwritten";
    for (arguments, expected) in [
        (&["s.json", "-o", "link.png"][..], same),
        (&["s.json", "-o", "hard.png"], same),
        (&["s.json", "-o", "notes.png"], "notes.png exists and is not a PNG file; it was not overwritten"),
        (&["s.json", "-o", "notes.txt"], "notes.txt is not a PNG file; name a PNG file or a folder"),
        (&["-o", "link.png"], "link.png exists and is not a PNG file"),
        (
            &["s.json", "--models", "models", "--reflection", "mine", "-o", "model.png"],
            "model.png is the same file as",
        ),
        (&["empty.json", "--use-defaults", "-o", "empty.png"], "empty.png is the same file as empty.json"),
    ] {
        refused(&run(&mut render(at, arguments)), 4, expected);
    }
    // The folder of several pictures.
    fs::create_dir(at.join("renders")).expect("made");
    symlink("../s.json", at.join("renders/s.png")).expect("linked");
    refused(&run(&mut render(at, &["s.json"])), 4, same);
    for (capture, expected) in [
        ("s.json", "s.json is read by this command; it was not overwritten"),
        ("link.png", same),
        ("notes.txt", "notes.txt exists and is not a PNG file"),
        ("model.png", "model.png is the same file as"),
    ] {
        let mut command =
            lcm(at, ["view", "s.json", "--models", "models", "--exit-after", "5", "--capture", capture]);
        refused(&run(&mut command), 4, expected);
    }
    assert_eq!(fs::read_to_string(at.join("s.json")).expect("there"), scene);
    assert_eq!(fs::read_to_string(at.join("notes.png")).expect("there"), "notes");
    // An empty file and a replaceable picture have nothing to lose.
    for _ in 0..2 {
        let ran = run(&mut render(at, &["s.json", "-o", "empty.png"]));
        assert_eq!(ran.status, Some(0), "{}", ran.err);
    }
    assert!(fs::read(at.join("empty.png")).expect("there").starts_with(PNG));
}

#[test]
fn a_report_is_replaced_only_when_the_user_says_so() {
    let folder = folder();
    let at = folder.path();
    let study = |arguments: &[&str]| run(&mut lcm(at, ["study", "--quick"].iter().chain(arguments)));
    fs::create_dir(at.join("mine")).expect("made");
    fs::write(at.join("mine/index.html"), "<html>mine</html>").expect("written");
    for arguments in [&["-o", "mine"][..], &["-o", "mine", "--overwrite"]] {
        refused(&study(arguments), 4, "mine has files that are not a report");
    }
    assert_eq!(fs::read_to_string(at.join("mine/index.html")).expect("there"), "<html>mine</html>");
    // An empty folder counts as free.
    fs::create_dir(at.join("st")).expect("made");
    assert_eq!(study(&["-o", "st"]).status, Some(0));
    let page = at.join("st/index.html");
    let report = fs::metadata(&page).expect("there");
    refused(&study(&["-o", "st"]), 4, "st already has a report; --overwrite replaces it");
    assert_eq!(fs::metadata(&page).expect("there").ino(), report.ino());
    let again = study(&["-o", "st", "--overwrite"]);
    assert_eq!(again.status, Some(0), "{}", again.err);
    assert_ne!(fs::metadata(&page).expect("there").mtime_nsec(), report.mtime_nsec());
}

/// The file written by the child process of the next tests; only set there.
const LOOP_FILE: &str = "LCM_TEST_FILES_LOOP";

/// A scene whose file takes a moment to write.
fn large() -> Scene {
    Scene {
        objects: vec![Object { name: Some("x".repeat(200)), ..Object::default() }; 2000],
        ..Scene::default()
    }
}

/// Not a test by itself: saves forever, in a process that another test kills.
#[test]
fn save_in_a_loop_if_asked_to() {
    let Some(file) = env::var_os(LOOP_FILE) else { return };
    let texts = [large(), Scene::default()].map(|scene| written(&scene));
    for text in texts.iter().cycle() {
        files::write(Path::new(&file), text.as_bytes()).expect("written");
    }
}

/// Kills processes that save to a file, until one has left something or all attempts are used.
fn kill_while_saving(file: &Path, rounds: u64, mut enough: impl FnMut() -> bool) {
    let changed = || fs::metadata(file).and_then(|about| about.modified()).ok();
    for round in 0..rounds {
        let before = changed();
        let mut child = Command::new(env::current_exe().expect("this binary"))
            .args(["--exact", "commands::files::save_in_a_loop_if_asked_to", "--nocapture"])
            .env(LOOP_FILE, file)
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .spawn()
            .expect("started");
        // A busy machine takes a while to start it.
        let begin = Instant::now();
        while changed() == before && begin.elapsed() < LIMIT {
            thread::sleep(Duration::from_millis(2));
        }
        thread::sleep(Duration::from_millis(7 * round % 41));
        assert!(child.try_wait().expect("asked").is_none(), "it was still saving");
        child.kill().expect("killed");
        child.wait().expect("ended");
        if enough() {
            return;
        }
    }
}

#[test]
fn what_a_killed_process_left_is_gone_after_the_next_save() {
    let folder = folder();
    let at = folder.path();
    let file = at.join("a.json");
    save(&file, &Scene::default(), Expected::Nothing).expect("written");
    let litter = || names(at).iter().any(|name| name.starts_with(".lcm-"));
    for command in
        [&["new", "b.json"][..], &["render", "-o", "b.png", "--size", "16x16", "--renderer", "cpu"]]
    {
        kill_while_saving(&file, 200, litter);
        assert!(litter(), "no process was killed at the right moment");
        assert_eq!(run(&mut lcm(at, command)).status, Some(0));
        assert!(!litter(), "{:?}", names(at));
        let scene = scene_in(&file);
        assert!(scene == Scene::default() || scene == large());
    }
    assert_eq!(names(at), ["a.json", "b.json", "b.png"]);
}

/// Makes a file look two minutes old.
fn age(path: &Path) {
    let then = SystemTime::now() - Duration::from_secs(120);
    File::options().write(true).open(path).and_then(|f| f.set_modified(then)).expect("set");
}

#[test]
fn only_what_nobody_holds_and_this_program_wrote_is_litter() {
    let folder = folder();
    let at = folder.path();
    let put = |name: &str, text: &str, old: bool| {
        fs::write(at.join(name), text).expect("written");
        if old {
            age(&at.join(name));
        }
    };
    let mut stays = vec!["a.json"];
    let mut goes = Vec::new();
    for (name, text, old, is_litter) in [
        (".lcm-a1B2c3.tmp", "{", false, true),
        (".a.json.a1B2c3.tmp", "{\n  \"name\": \"x", true, true),
        (".b.json.Zz9Yy8.tmp", "", true, true),
        ("a.png.4711.partial", "\x7fPNG", true, false),
        ("b.png.4711.partial", "", true, true),
        // An older version may be working on it.
        (".c.json.a1B2c3.tmp", "{\n  \"name\": \"x", false, false),
        // Other programs name their files like that too.
        (".d.json.a1B2c3.tmp", "{\"a\": 1}", true, false),
        (".a.json.backup.tmp", "{\n  \"name\"", true, false),
        (".lcm-notes.txt", "", true, false),
        (".lcm-a1B2c3d.tmp", "", true, false),
        ("lcm-a1B2c3.tmp", "", true, false),
    ] {
        put(name, text, old);
        if is_litter { goes.push(name) } else { stays.push(name) }
    }
    fs::write(at.join("c.png.4711.partial"), PNG).expect("written");
    age(&at.join("c.png.4711.partial"));
    // Links and folders with such names are not litter, and a pipe must not be opened.
    symlink("a.json", at.join(".lcm-link01.tmp")).expect("linked");
    fs::create_dir(at.join(".lcm-fold01.tmp")).expect("made");
    pipe(&at.join(".lcm-pipe01.tmp"));
    stays.extend([".lcm-link01.tmp", ".lcm-fold01.tmp", ".lcm-pipe01.tmp"]);
    // A draft in use.
    let held = File::create(at.join(".lcm-held01.tmp")).expect("made");
    held.lock().expect("locked");
    let mut draft = Draft::new(&at.join("d.json")).expect("a draft");
    draft.write_all(b"{}").expect("written");

    let file = at.join("a.json");
    let (to, there) = (file.clone(), at.join("a.json"));
    bounded("saving", move || save(&to, &Scene::default(), Expected::Nothing).expect("written"));
    let found = names(at);
    for name in &stays {
        assert!(found.iter().any(|n| n == name), "{name} is gone: {found:?}");
    }
    for name in goes.iter().chain(&["c.png.4711.partial"]) {
        assert!(!found.iter().any(|n| n == name), "{name} is still there: {found:?}");
    }
    assert!(found.iter().any(|n| n == ".lcm-held01.tmp"), "somebody held it: {found:?}");
    draft.create().expect("its draft was left alone");
    assert_eq!(fs::read(at.join("d.json")).expect("there"), b"{}");
    drop(held);
    // Other tests start programs, which inherit the lock until they have started.
    for _ in 0..1200 {
        save(&there, &Scene::default(), Expected::Anything).expect("written");
        if !names(at).iter().any(|n| n == ".lcm-held01.tmp") {
            return;
        }
        thread::sleep(Duration::from_millis(50));
    }
    panic!("nobody holds it now, and it is still there");
}

#[test]
fn names_of_250_bytes_can_be_saved() {
    let folder = folder();
    let name = format!("{}.json", "n".repeat(245));
    let file = folder.path().join(&name);
    save(&file, &Scene::default(), Expected::Nothing).expect("written");
    save(&file, &large(), Expected::Anything).expect("written again");
    assert_eq!(scene_in(&file), large());
    let picture = format!("{}.png", "p".repeat(246));
    assert_eq!(run(&mut render(folder.path(), &["-o", &picture])).status, Some(0));
    assert_eq!(names(folder.path()), [name, picture]);
}

#[test]
fn owner_group_and_mode_stay_when_the_superuser_saves() {
    let folder = folder();
    let file = folder.path().join("a.json");
    save(&file, &Scene::default(), Expected::Nothing).expect("written");
    fs::set_permissions(&file, fs::Permissions::from_mode(0o640)).expect("set");
    if let Err(e) = chown(&file, Some(1234), Some(4321)) {
        return skip(&format!("only the superuser can give files away ({e})"));
    }
    let before = fs::metadata(&file).expect("there");
    save(&file, &large(), Expected::Anything).expect("written");
    let after = fs::metadata(&file).expect("there");
    assert_eq!((after.uid(), after.gid(), after.mode() & 0o7777), (1234, 4321, 0o640));
    assert_ne!(after.ino(), before.ino(), "it was replaced, not overwritten");
    assert_eq!(scene_in(&file), large());
    assert_eq!(names(folder.path()), ["a.json"]);
}

#[test]
fn hard_links_stay_one_file() {
    let folder = folder();
    let (a, b) = (folder.path().join("a.json"), folder.path().join("b.json"));
    save(&a, &large(), Expected::Nothing).expect("written");
    fs::hard_link(&a, &b).expect("linked");
    for scene in [Scene::default(), large()] {
        save(&a, &scene, Expected::Anything).expect("written");
        assert!(files::same(&a, &b));
        assert_eq!(scene_in(&b), scene);
        assert_eq!(names(folder.path()), ["a.json", "b.json"]);
    }
}

#[test]
fn a_picture_changes_no_other_file_that_is_linked_to_its_place() {
    let folder = folder();
    let at = folder.path();
    let picture = |arguments: &[&str]| {
        let ran = run(&mut render(at, &[arguments, &["-o", "a.png"]].concat()));
        assert_eq!(ran.status, Some(0), "{}", ran.err);
        fs::read(at.join("a.png")).expect("there")
    };
    let before = picture(&[]);
    // As `cp -l` makes copies.
    fs::hard_link(at.join("a.png"), at.join("kept.png")).expect("linked");
    let after = picture(&["--reflection", "ward"]);
    assert_ne!(after, before);
    assert_eq!(fs::read(at.join("kept.png")).expect("there"), before);
    assert_eq!(names(at), ["a.png", "kept.png"]);
}

#[test]
fn a_process_killed_while_it_overwrites_a_file_loses_nothing() {
    let folder = folder();
    let at = folder.path();
    let (a, b) = (at.join("a.json"), at.join("b.json"));
    save(&a, &Scene::default(), Expected::Nothing).expect("written");
    fs::hard_link(&a, &b).expect("linked");
    let mut interrupted = 0;
    kill_while_saving(&a, 60, || {
        let whole = |name: &String| name.ends_with(".whole");
        interrupted += u32::from(names(at).iter().any(whole));
        assert_eq!(files::tidy(at), []);
        let scene = scene_in(&a);
        assert!(scene == Scene::default() || scene == large());
        assert!(files::same(&a, &b));
        assert_eq!(names(at), ["a.json", "b.json"]);
        interrupted > 3
    });
    assert!(interrupted > 0, "no process was killed at the right moment");
}

#[test]
fn a_whole_copy_is_no_litter() {
    let folder = folder();
    let at = folder.path();
    let file = at.join("a.json");
    let text = written(&large());
    let copy = |inode: u64| at.join(format!(".lcm-a1B2c3.{inode}-1.whole"));
    // Interrupted at any point: finished at the start of the window and at the next save alike.
    for (length, command) in [(0, None), (1000, None), (text.len() - 1, Some("new.json")), (text.len(), None)]
    {
        fs::write(&file, &text[..length]).expect("written");
        let copy = copy(fs::metadata(&file).expect("there").ino());
        fs::write(&copy, &text).expect("written");
        match command {
            Some(new) => assert_eq!(run(&mut lcm(at, ["new", new])).status, Some(0)),
            None => assert_eq!(files::tidy(at), []),
        }
        assert_eq!(scene_in(&file), large(), "{length}");
        assert!(!copy.exists());
    }
    // Killed before the first byte was overwritten: the file is unchanged.
    save(&file, &Scene::default(), Expected::Anything).expect("written");
    let metadata = fs::metadata(&file).expect("there");
    let time = metadata.modified().expect("known").duration_since(UNIX_EPOCH).expect("later").as_nanos();
    let name = format!(".lcm-a1B2c3.{}-{time}.whole", metadata.ino());
    fs::write(at.join(&name), &text).expect("written");
    assert_eq!(files::tidy(at), []);
    assert_eq!(scene_in(&file), large());
    // Edited since, or gone: only the user can decide which one counts.
    fs::write(&file, "edited").expect("written");
    let left = copy(fs::metadata(&file).expect("there").ino());
    fs::write(&left, &text).expect("written");
    for _ in 0..2 {
        let unfinished = files::tidy(at);
        assert_eq!(unfinished.len(), 1);
        let said = unfinished[0].to_string();
        assert!(said.contains("a.json may be incomplete") && said.contains(".whole"), "{said}");
    }
    assert_eq!(fs::read_to_string(&file).expect("there"), "edited");
    assert_eq!(fs::read_to_string(&left).expect("there"), text);
    fs::remove_file(&file).expect("removed");
    assert!(files::tidy(at)[0].to_string().contains("no longer exists"));
    assert!(left.exists());
    // The copy of another user's file may come from anybody.
    fs::write(&file, "").expect("written");
    fs::rename(&left, copy(fs::metadata(&file).expect("there").ino())).expect("renamed");
    if chown(&file, Some(1234), None).is_ok() {
        assert_eq!(files::tidy(at).len(), 1);
        assert_eq!(fs::read(&file).expect("there"), b"");
    } else {
        skip("in part: only the superuser can give files away");
    }
}

#[test]
fn output_that_cannot_be_written_has_status_4() {
    let folder = folder();
    let at = folder.path();
    fs::write(at.join("a.json"), full_scene().to_string()).expect("written");
    for arguments in [
        "--help",
        "--version",
        "render --help",
        "help models",
        "models",
        "models --json",
        "schema",
        "completions bash",
        "check a.json",
        "check --json a.json",
        "assets export assets",
        "models new mine --models models",
    ] {
        let ran = run(&mut shell(at, &format!("\"$LCM\" {arguments} > /dev/full")));
        refused(&ran, 4, "standard output: the disk is full\n");
    }
    for (command, table) in
        [("evaluate", "theta_i,phi_i,theta_o,phi_o\\n1,2,3,4\\n"), ("albedo", "mu\\n1\\n")]
    {
        let script = format!("printf '{table}' | \"$LCM\" {command} lambert > /dev/full");
        refused(&run(&mut shell(at, &script)), 4, "standard output: the disk is full\n");
    }
    // There is nobody left to inform.
    let ran = run(&mut shell(at, "\"$LCM\" --help 2>&1 >&3 3>&- | cat; \"$LCM\" --hlp 2> /dev/full"));
    assert_eq!(ran.status, Some(2));
}

#[test]
fn rows_without_end_take_no_memory_without_end() {
    let folder = folder();
    let at = folder.path();
    // 600 MB of address space, part of which the program itself takes.
    let limited = |script: &str| run(&mut shell(at, &format!("ulimit -v 600000; {script}")));
    for command in ["evaluate", "albedo"] {
        let ran = limited(&format!("\"$LCM\" {command} phong < /dev/zero"));
        refused(&ran, 1, "standard input:1: the line is longer than 4096 bytes");
    }
    let ran = limited("(echo mu; yes x | head -n 1000020; echo 1,2) | \"$LCM\" albedo phong");
    assert_eq!((ran.status, ran.out.as_slice()), (Some(1), &b""[..]), "{}", ran.err);
    let lines: Vec<_> = ran.err.lines().collect();
    assert_eq!(lines.len(), 21, "{}", ran.err);
    assert_eq!(lines[0], "standard input:2: mu is \"x\", but it must be a finite number");
    assert_eq!(lines[20], "standard input: at least 999980 more problems");
    // Good rows are answered at once, without waiting for the end.
    let ran = limited(
        "(echo theta_i,phi_i,theta_o,phi_o; yes 10,20,30,40) | \"$LCM\" evaluate phong | head -n 3000000 | tail -n 1",
    );
    assert_eq!(ran.status, Some(0), "{}", ran.err);
    let last = String::from_utf8_lossy(&ran.out).into_owned();
    assert!(last.starts_with("10,20,30,40,0."), "{last}");
}

#[test]
fn a_picture_for_which_there_is_no_memory_is_refused() {
    let folder = folder();
    let at = folder.path();
    let limited = |script: &str| run(&mut shell(at, &format!("ulimit -v 1000000; {script}")));
    let ran = limited("\"$LCM\" render --renderer cpu --size 16384x16384 -o large.png");
    refused(&ran, 1, "16384×16384 pixels need 1024 MiB of memory, which are not free; choose a smaller size");
    assert!(!at.join("large.png").exists());
    let ran = limited("\"$LCM\" render --renderer cpu --size 8192x8192 -o large.exr");
    refused(&ran, 1, "8192×8192 pixels need");
    let ran = limited("\"$LCM\" render --renderer cpu --size 64x64 -o small.png");
    assert_eq!(ran.status, Some(0), "{}", ran.err);
}

/// Characters that a terminal acts on: colours, a bell, the beginning of the line, the other direction of writing.
const ODD: &str = "a\u{1b}[31m\u{7}\r\u{9b}2J\u{202e}b";
/// The characters made printable.
const SHOWN: &str = r"a\u{1b}[31m\u{7}\r\u{9b}2J\u{202e}b";

#[test]
fn what_a_terminal_obeys_does_not_reach_it() {
    let folder = folder();
    let at = folder.path();
    let named = |ending: &str| format!("{ODD}{ending}");
    let valid = named(".valid.json");
    fs::write(at.join(&valid), full_scene().to_string()).expect("written");
    fs::write(at.join(named(".bad.json")), "{").expect("written");
    let models = named(".models");
    fs::create_dir(at.join(&models)).expect("made");
    fs::write(at.join(&models).join("broken.wgsl"), "fn response(").expect("written");
    for arguments in [
        &["check", &valid][..],
        &["check", &named(".bad.json")],
        &["check", &named(".none.json")],
        &["view", &named(".none.json")],
        &["render", &named(".none.json")],
        &["render", &valid, "-o", &named(".png"), "--size", "16x16", "--renderer", "cpu"],
        &["render", &valid, "-o", &named(".jpg")],
        &["new", &valid],
        &["new", &named("/x.json")],
        &["models", "--models", &models],
        &["study", "-o", &valid],
        &["evaluate", ODD],
        &["evaluate", "phong", "--set", ODD],
        &["--size", ODD],
        &[&format!("--{ODD}")],
        &["render", "--reflection", ODD],
    ] {
        let ran = run(&mut lcm(at, arguments));
        let out = String::from_utf8_lossy(&ran.out).into_owned();
        for text in [&out, &ran.err] {
            let obeyed =
                text.chars().find(|c| c.is_control() && *c != '\n' && *c != '\t' || *c == '\u{202e}');
            assert_eq!(obeyed, None, "{arguments:?}: {text:?}");
        }
        // They lose clap's colours in its quotations.
        assert!(out.contains(r"\u{9b}") || ran.err.contains(r"\u{9b}"), "{arguments:?}: {out}{}", ran.err);
    }
    // Results for programs mean the same.
    let ran = run(&mut lcm(at, ["check", "--json", &valid]));
    let report: serde_json::Value = serde_json::from_slice(&ran.out).expect("JSON");
    assert_eq!(report[0]["file"], valid);
    assert!(!String::from_utf8_lossy(&ran.out).contains(['\u{9b}', '\u{202e}']), "escaped");
    // A name that is not text does no harm either.
    let bytes = OsStr::from_bytes(b"\xff\x1b[2J.json");
    assert!(!run(&mut lcm(at, [OsStr::new("check"), bytes])).err.contains('\u{1b}'));
}

#[test]
fn a_name_with_a_line_end_forges_no_line_of_a_message() {
    let folder = folder();
    let at = folder.path();
    let name = "a.json\nerror: rm -rf";
    let (valid, bad) = (format!("{name}.valid.json"), format!("{name}.bad.json"));
    fs::write(at.join(&valid), full_scene().to_string()).expect("written");
    fs::write(at.join(&bad), "{").expect("written");
    let models = format!("{name}.models");
    fs::create_dir(at.join(&models)).expect("made");
    fs::write(at.join(&models).join("broken.wgsl"), "fn response(").expect("written");
    for arguments in [
        &["check", &valid][..],
        &["check", &bad],
        &["check", &format!("{name}.none.json")],
        &["render", &bad],
        &["render", &valid, "-o", &format!("{name}.png"), "--size", "16x16", "--renderer", "cpu"],
        &["render", &valid, "-o", &format!("{name}.jpg")],
        &["new", &valid],
        &["export", &valid, "--as", "wgsl", "-o", &format!("{name}.out")],
        &["match", &valid, "-o", &valid],
        &["models", "--models", &models],
        &["study", "-o", &valid],
        &["lesson", "check", &bad],
    ] {
        let ran = run(&mut lcm(at, arguments));
        let said = [String::from_utf8_lossy(&ran.out).into_owned(), ran.err].concat();
        assert!(!said.contains("\nerror: rm"), "{arguments:?}: {said}");
        assert!(said.contains(r"a.json\nerror: rm"), "{arguments:?}: {said}");
    }
}

#[test]
fn messages_of_the_window_show_what_a_terminal_would_obey() {
    let mut session = Session::new(Scene { name: None, ..Scene::default() });
    session.say(Severity::Error, format!("{ODD}.json was not opened"));
    assert_eq!(session.messages[0].text, format!("{SHOWN}.json was not opened"));
    session.path = Some(PathBuf::from(format!("/x/{ODD}.json")));
    assert_eq!(session.title(), SHOWN);
    assert_eq!(printable(ODD), SHOWN);
}

#[test]
fn a_window_that_starts_cleans_up_after_the_one_that_was_killed() {
    let folder = folder();
    let at = folder.path();
    let text = written(&read(&full_scene().to_string()));
    let file = at.join("a.json");
    fs::write(&file, &text[..200]).expect("written");
    let inode = fs::metadata(&file).expect("there").ino();
    fs::write(at.join(format!(".lcm-a1B2c3.{inode}-1.whole")), &text).expect("written");
    fs::write(at.join(".lcm-a1B2c3.tmp"), "{").expect("written");
    let config = folder.path().join("config");
    fs::create_dir(&config).expect("made");
    fs::write(config.join(".lcm-a1B2c3.tmp"), "{").expect("written");
    let screen = Screen::new(640, 480);
    let shown = run(&mut screen.command(&["view", &file.to_string_lossy(), "--exit-after", "2"], &config));
    assert_eq!(shown.status, Some(0), "{}", shown.err);
    assert_eq!(fs::read_to_string(&file).expect("there"), text);
    assert_eq!(names(at), ["a.json", "config"]);
    assert!(!names(&config).iter().any(|name| name.ends_with(".tmp")));
    // A scene that is not a regular file is reported even without a display.
    let mut command = screen::lcm(&["view", "pipe"], &config);
    pipe(&at.join("pipe"));
    refused(&run(command.current_dir(at)), 1, "a named pipe");
}

/// Functions that open, write, rename or remove files.
const DOORS: [&str; 14] = [
    "fs::read(",
    "fs::read_to_string(",
    "read_to_string(&path",
    "fs::write(",
    "fs::copy(",
    "fs::rename(",
    "fs::remove_",
    "File::open",
    "File::create",
    "File::options",
    "OpenOptions",
    "tempfile",
    "persist(",
    "println!",
];

#[test]
fn files_are_opened_in_one_module_only() {
    let mut folders = vec![root().join("src")];
    let mut looked_at = 0;
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("readable") {
            let path = entry.expect("readable").path();
            let is_test = path.file_name().is_some_and(|name| name == "tests.rs");
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            // Templates are texts of exported programs.
            let is_rust = path.extension().is_some_and(|extension| extension == "rs");
            // The files of a browser are what the guard opens there.
            let is_guard =
                ["src/files", "src/platform"].iter().any(|folder| path.starts_with(root().join(folder)));
            if is_test || !is_rust || is_guard {
                continue;
            }
            let mut text = String::new();
            File::open(&path).and_then(|mut f| f.read_to_string(&mut text)).expect("readable");
            let program = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
            for line in program.lines().filter(|line| !line.trim_start().starts_with("//")) {
                // `files::read` is the guard itself.
                let line = line.replace("files::", "guard::");
                let door = DOORS.iter().find(|door| line.contains(*door));
                // Recovery copies have separate folders and locks; their content goes through the guard.
                let own = ["OpenOptions", "fs::remove_", "fs::rename("];
                let door = door.filter(|door| !path.ends_with("recovery/store.rs") || !own.contains(*door));
                assert_eq!(door, None, "{}: {line}", path.display());
            }
            looked_at += 1;
        }
    }
    assert!(looked_at > 100);
}
