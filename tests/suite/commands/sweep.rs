//! `lcm sweep`: sheets, films and folders; the same bytes each time; going on after an interruption; what is wrong.

#![cfg(target_os = "linux")]

use std::{
    fs,
    os::unix::{fs::symlink, process::ExitStatusExt as _},
    path::Path,
    process::{Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use lights_camera_models::{
    reference::{self, Settings},
    registry::Registry,
    scene::{
        Scene,
        load::{self, Defaults},
        save,
    },
    sweep::MAX_PICTURES,
};

use crate::{
    helpers::pictures::close_up,
    helpers::support::{Run, command_in, lcm_in, names},
    renderers::golden::read_png,
};

const SIZES: &str = "objects[0].size=1..3:3";

/// Runs a sweep of the default scene with small pictures.
fn sweep(folder: &Path, arguments: &[&str]) -> Run {
    lcm_in(folder, &[&["sweep", "--size", "64x36"], arguments].concat(), b"")
}

fn done(folder: &Path, arguments: &[&str]) -> Run {
    let run = sweep(folder, arguments);
    assert_eq!(run.status, Some(0), "{arguments:?}: {}", run.err);
    assert_eq!(run.out, "");
    run
}

fn refused(run: &Run, status: i32, expected: &str) {
    assert_eq!(run.status, Some(status), "{}", run.err);
    assert!(run.err.contains(expected), "{:?} should contain {expected:?}", run.err);
}

#[test]
fn a_folder_gets_a_picture_with_its_scene_for_each_value() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = done(folder.path(), &["--vary", SIZES, "-o", "all"]);
    assert_eq!(run.err.trim(), "wrote 3 pictures into all");
    let all = folder.path().join("all");
    assert_eq!(names(&all), ["1_size_1.png", "2_size_2.png", "3_size_3.png"]);
    let registry = Registry::builtin();
    for (name, size) in names(&all).iter().zip([1.0, 2.0, 3.0]) {
        let scene = load::file(&all.join(name), &registry, Defaults::Refuse).expect("has a scene").scene;
        let mut expected = Scene::default();
        expected.objects[0].size = size;
        assert_eq!(scene, expected);
        // The same picture as that of the scene alone.
        let settings = Settings { width: 64, height: 36, ..Settings::default() };
        let (_, _, rgb8) = read_png(&all.join(name)).expect("a picture");
        assert!(rgb8 == reference::render_rgb8(&scene, &registry, &settings), "{name}");
    }
    // The same command goes on, and draws what is missing.
    let before = fs::read(all.join("2_size_2.png")).expect("there");
    fs::remove_file(all.join("2_size_2.png")).expect("removed");
    let run = done(folder.path(), &["--vary", SIZES, "-o", "all"]);
    assert_eq!(run.err.trim(), "wrote 1 picture into all; 2 were there already");
    assert!(fs::read(all.join("2_size_2.png")).expect("there") == before);
    let run = done(folder.path(), &["--vary", "objects[0].size=4,5", "-o", "all"]);
    assert_eq!(
        run.err.trim(),
        "wrote 2 pictures into all\nall has 3 more pictures that this sweep did not write"
    );
}

#[test]
fn pictures_of_something_else_are_replaced_only_when_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    done(folder.path(), &["--vary", SIZES, "-o", "all"]);
    let before = fs::read(at("all/2_size_2.png")).expect("there");
    // Another scene, and other settings.
    let mut other = Scene::default();
    other.display.exposure = 1.0;
    fs::write(at("other.json"), save::to_json(&other, None, &Registry::builtin())).expect("written");
    let others = [&["other.json"][..], &["--samples", "1"]];
    for more in others {
        let arguments = [more, &["--vary", SIZES, "-o", "all"]].concat();
        let run = sweep(folder.path(), &arguments);
        refused(&run, 4, "all has 3 pictures in the place of this sweep's, such as 1_size_1.png");
        assert!(run.err.contains("--overwrite replaces them"), "{}", run.err);
        assert!(fs::read(at("all/2_size_2.png")).expect("there") == before);
        assert_eq!(names(&at("all")).len(), 3);
    }
    for more in others {
        let arguments = [more, &["--vary", SIZES, "-o", "all", "--overwrite"]].concat();
        assert_eq!(done(folder.path(), &arguments).err.trim(), "wrote 3 pictures into all");
    }
    refused(
        &sweep(folder.path(), &["--vary", SIZES, "-o", "x.png", "--overwrite"]),
        2,
        "--overwrite is for folders",
    );
    // A model from a file is part of the scene.
    let scene = r#"{ "scene_size": { "height": 10, "width": 10, "depth": 10 }, "reflection_model": "lambert",
        "shading_model": "flat", "lights": [{ "type": "ambient", "intensity": 1 }],
        "observer": { "position": [5, 5, 9.5], "direction": [0, 0, -1] },
        "objects": [{ "type": "mesh", "path": "m.obj", "position": [5, 5, 5], "size": 3 }] }"#;
    fs::write(at("mesh.json"), scene).expect("written");
    let sweep_of_mesh = ["mesh.json", "--vary", SIZES, "-o", "meshes"];
    fs::write(at("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").expect("written");
    done(folder.path(), &sweep_of_mesh);
    let again = done(folder.path(), &sweep_of_mesh);
    assert_eq!(again.err.trim(), "wrote 0 pictures into meshes; 3 were there already");
    fs::write(at("m.obj"), "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n").expect("written");
    refused(&sweep(folder.path(), &sweep_of_mesh), 4, "meshes has 3 pictures in the place of this sweep's");
    let run = done(folder.path(), &[&sweep_of_mesh[..], &["--overwrite"]].concat());
    assert_eq!(run.err.trim(), "wrote 3 pictures into meshes");
}

#[test]
fn sheets_and_films_are_the_same_bytes_each_time_and_open_as_scenes() {
    let folder = tempfile::tempdir().expect("a folder");
    let models = "reflection_model=lambert,phong";
    let both = ["--vary", SIZES, "--vary", models];
    for (name, more) in [
        ("sheet.png", &[][..]),
        ("differences.png", &["--against", "1", "--sign", "signed"]),
        ("bare.png", &["--no-labels"]),
        ("turning.gif", &["--turn", "360:4"]),
        ("moving.apng", &["--path", "lights[0]=[1,8,9]..[9,8,9]:3", "--fps", "5"]),
        ("film.png", &["--film"]),
    ] {
        let arguments = [&both[..], more, &["-o", name]].concat();
        done(folder.path(), &arguments);
        let first = fs::read(folder.path().join(name)).expect("written");
        done(folder.path(), &arguments);
        assert!(fs::read(folder.path().join(name)).expect("written") == first, "{name}");
    }
    let at = |name: &str| folder.path().join(name);
    assert_eq!(names(folder.path()).len(), 6, "nothing else is left: {:?}", names(folder.path()));
    let size = |name: &str| read_png(&at(name)).map(|(w, h, _)| [w, h]).expect("a picture");
    let [sheet, differences, bare] = ["sheet.png", "differences.png", "bare.png"].map(size);
    assert!(bare[0] >= 3 * 64 && bare[1] >= 2 * 36 && sheet[1] > bare[1], "{sheet:?} {bare:?}");
    assert!(differences[1] > sheet[1] + 2 * 36 - 1, "maps are below the pictures");
    let registry = Registry::builtin();
    for name in ["sheet.png", "moving.apng", "film.png"] {
        // No scene has this extension.
        let path = if name == "moving.apng" { at("copy.png") } else { at(name) };
        if path != at(name) {
            fs::copy(at(name), &path).expect("copied");
        }
        let scene = load::file(&path, &registry, Defaults::Refuse).expect(name).scene;
        assert_eq!(scene, Scene::default(), "{name}");
    }
    assert!(fs::read(at("turning.gif")).expect("there").starts_with(b"GIF89a"));
    // Time is the last that varies: two pictures of three columns.
    let decoder = png::Decoder::new(std::io::BufReader::new(fs::File::open(at("film.png")).expect("there")));
    let frames =
        decoder.read_info().expect("a PNG").info().animation_control.map(|control| control.num_frames);
    assert_eq!(frames, Some(2));
}

#[test]
fn without_words_a_sheet_is_its_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    done(folder.path(), &["--vary", SIZES, "-o", "sheet.png", "--no-labels"]);
    done(folder.path(), &["--vary", SIZES, "-o", "all"]);
    let (width, _, sheet) = read_png(&folder.path().join("sheet.png")).expect("a picture");
    let width = width as usize;
    let gap = (width - 3 * 64) / 4;
    for (i, name) in names(&folder.path().join("all")).iter().enumerate() {
        let (_, _, picture) = read_png(&folder.path().join("all").join(name)).expect("a picture");
        for y in 0..36 {
            let start = 3 * ((gap + y) * width + gap + i * (64 + gap));
            assert!(sheet[start..start + 3 * 64] == picture[3 * 64 * y..3 * 64 * (y + 1)], "{name}, row {y}");
        }
    }
}

#[test]
fn what_is_wrong_is_said_before_anything_is_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let many =
        ["--vary", "objects[0].size=1..2:1000", "--vary", "lights[0].intensity=1..2:1000", "-o", "all"];
    let three = [
        "--vary",
        SIZES,
        "--vary",
        "reflection_model=lambert,phong",
        "--vary",
        "display.exposure=0,1",
        "-o",
        "x.png",
    ];
    let limit = format!("1000000 pictures, but a sweep has at most {MAX_PICTURES}");
    let cases: &[(&[&str], &str)] = &[
        (&["-o", "x.png"], "nothing varies; name a value"),
        (&["--vary", "objects[0].material.roughnes=0.1,0.2", "-o", "x.png"], "did you mean \"roughness\"?"),
        (
            &["--vary", "objects[0].material.k_d=0.5..2:4", "-o", "x.png"],
            "but the diffuse coefficient must be between",
        ),
        (&["--vary", "objects[0].size=1..9", "-o", "x.png"], "the number of values is missing"),
        (&["--vary", "objects[0].size=1,1.0", "-o", "all"], "objects[0].size is 1 twice"),
        (&["--vary", SIZES, "--vary", SIZES, "-o", "all"], "objects[0].size is varied twice"),
        (&many, &limit),
        (&three, "a sheet has columns and rows, but 3 values vary; write a film"),
        (
            &["--turn", "360:4", "--path", "lights[0]=[1,1,1]..[2,2,2]:3", "-o", "x.gif"],
            "cannot be used with",
        ),
        (&["--turn", "sun=360:4", "-o", "x.gif"], "\"sun\" cannot turn"),
        (&["--vary", SIZES, "-o", "x.webm"], "videos cannot be written; name a folder"),
        (&["--vary", SIZES, "-o", "x.jpg"], "sheets are .png files"),
        (&["--vary", SIZES, "-o", "all", "--film"], "a film is one file"),
        (&["--vary", SIZES, "-o", "all", "--against", "1"], "--against compares pictures on a sheet"),
        (&["--vary", SIZES, "-o", "x.png", "--against", "4"], "it must be one from 1 to 3"),
        (&["--vary", SIZES, "-o", "x.png", "--sign", "signed"], "need --against"),
        (&["--vary", SIZES, "-o", "x.gif", "--against", "1"], "there is only one column"),
        (&["--vary", SIZES, "-o", "x.png", "--view", "B"], "there is no view \"B\""),
        (&["--vary", SIZES, "-o", "x.gif", "--fps", "99"], "it must be a whole number from 1 to 50"),
        (&["--vary", SIZES, "-o", "-"], "results go to files"),
    ];
    for (arguments, expected) in cases {
        refused(&sweep(folder.path(), arguments), 2, expected);
    }
    let run = lcm_in(folder.path(), &["sweep", "--vary", SIZES, "-o", "x.png", "--size", "9000x10"], b"");
    refused(&run, 2, "each side must have at most 16384; make the pictures smaller");
    // With its caption.
    let column = ["sweep", "--vary", SIZES, "--columns", "1", "-o", "x.png", "--size"];
    let fits = (5300..=5461).rev().step_by(20).find(|height| {
        lcm_in(folder.path(), &[&column[..], &[&format!("8x{height}")]].concat(), b"").status == Some(0)
    });
    let (_, height, _) = read_png(&folder.path().join("x.png")).expect("drawn");
    assert!(fits.is_some() && height <= 16_384, "{fits:?}, {height}");
    fs::remove_file(folder.path().join("x.png")).expect("removed");
    assert_eq!(names(folder.path()), Vec::<String>::new());
}

#[test]
fn what_a_model_does_not_use_is_refused_and_where_some_do_not_it_is_said() {
    let folder = tempfile::tempdir().expect("a folder");
    let roughness = ["--vary", "objects[0].material.roughness=0.1..0.9:3", "-o", "x.png"];
    let run = sweep(folder.path(), &roughness);
    refused(&run, 2, "objects[0].material.roughness has no effect: Lambert has no roughness; it belongs to ");
    assert!(run.err.contains("eon"), "{}", run.err);
    assert_eq!(names(folder.path()), Vec::<String>::new());
    // A model from the command line uses it, as in lcm render.
    let run = done(folder.path(), &[&roughness[..], &["--reflection", "eon", "--shading", "phong"]].concat());
    assert!(!run.err.contains("no effect"), "{}", run.err);
    let scene = load::file(&folder.path().join("x.png"), &Registry::builtin(), Defaults::Refuse);
    let scene = scene.expect("has a scene").scene;
    assert_eq!((&*scene.reflection_model, &*scene.shading_model), ("eon", "phong"));
    let run = done(folder.path(), &[&roughness[..], &["--vary", "reflection_model=lambert,eon"]].concat());
    let said = "objects[0].material.roughness has no effect in 3 of 6 pictures: Lambert has no roughness";
    assert!(run.err.contains(said), "{}", run.err);
    // Typing errors in models have the nearest.
    for (arguments, expected) in [
        (["--vary", "reflection_model=lamber,phong"], "did you mean \"lambert\"?"),
        (["--vary", "objects[0].shading_model=goraud,flat"], "did you mean \"gouraud\"?"),
        (["--reflection", "fong"], "did you mean \"phong\"?"),
    ] {
        refused(
            &sweep(folder.path(), &[&arguments[..], &["--vary", SIZES, "-o", "y.png"]].concat()),
            2,
            expected,
        );
    }
    let twice = ["--reflection", "eon", "--vary", "reflection_model=phong,eon", "-o", "y.png"];
    refused(
        &sweep(folder.path(), &twice),
        2,
        "--reflection sets reflection_model, but --vary reflection_model=…",
    );
}

#[test]
fn a_single_value_is_fixed_and_needs_no_axis() {
    let folder = tempfile::tempdir().expect("a folder");
    let two = ["--vary", SIZES, "--vary", "reflection_model=lambert,phong"];
    done(
        folder.path(),
        &[&two[..], &["--vary", "display.exposure=1", "-o", "fixed.png", "--no-labels"]].concat(),
    );
    done(folder.path(), &[&two[..], &["--exposure", "1", "-o", "given.png", "--no-labels"]].concat());
    done(folder.path(), &[&two[..], &["-o", "usual.png", "--no-labels"]].concat());
    let read = |name: &str| read_png(&folder.path().join(name)).expect("a picture");
    assert!(read("fixed.png") == read("given.png"));
    assert!(read("fixed.png") != read("usual.png"));
    // Wherever it stands, and in films and maps, too.
    let first = [&["--vary", "display.exposure=1"][..], &two, &["-o", "first.png", "--no-labels"]].concat();
    done(folder.path(), &first);
    assert!(read("first.png") == read("fixed.png"));
    for more in [&["-o", "film.gif"][..], &["-o", "maps.png", "--against", "2"]] {
        done(folder.path(), &[&["--vary", "display.exposure=1"][..], &two, more].concat());
    }
    done(folder.path(), &["--vary", "display.exposure=1", "-o", "one.png"]);
}

#[test]
fn a_turn_that_leaves_the_room_says_what_is_possible() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scene = Scene::default();
    scene.scene_size.width = 8.0;
    let scene = save::to_json(&scene, None, &Registry::builtin());
    fs::write(folder.path().join("narrow.json"), scene).expect("written");
    let run = sweep(folder.path(), &["narrow.json", "--turn", "360:8", "-o", "x.gif"]);
    refused(&run, 2, "observer.position is ");
    assert!(run.err.contains("possible: --turn "), "{}", run.err);
    assert!(run.err.contains("--turn objects=360:8"), "{}", run.err);
    done(folder.path(), &["narrow.json", "--turn", "objects=360:8", "-o", "x.gif"]);
}

#[test]
fn nothing_is_replaced_that_is_no_picture_and_nothing_is_half_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("notes.png"), "mine").expect("written");
    fs::write(at("notes.gif"), "mine").expect("written");
    fs::create_dir(at("all")).expect("made");
    fs::write(at("all/2_size_2.png"), "mine").expect("written");
    for output in ["notes.png", "notes.gif", "all"] {
        let run = sweep(folder.path(), &["--vary", SIZES, "-o", output]);
        refused(&run, 4, "it was not overwritten");
    }
    assert_eq!(names(&at("all")), ["2_size_2.png"]);
    // A scene in a picture is no place for its sheet.
    fs::remove_file(at("notes.png")).expect("removed");
    done(folder.path(), &["--vary", SIZES, "-o", "notes.png"]);
    let run = sweep(folder.path(), &["notes.png", "--vary", SIZES, "-o", "notes.png"]);
    refused(&run, 4, "notes.png is read by this command");
    // A full disk, at the end and in the middle.
    symlink("/dev/full", at("full.png")).expect("linked");
    symlink("/dev/full", at("full.gif")).expect("linked");
    for output in ["full.png", "full.gif"] {
        refused(&sweep(folder.path(), &["--vary", SIZES, "-o", output]), 4, "the disk is full");
    }
    fs::remove_file(at("all/2_size_2.png")).expect("removed");
    symlink("/dev/full", at("all/2_size_2.png")).expect("linked");
    let run = sweep(folder.path(), &["--vary", SIZES, "-o", "all"]);
    refused(&run, 4, "all/2_size_2.png could not be written: the disk is full");
    for name in names(&at("all")).iter().filter(|name| !name.starts_with("2_")) {
        assert!(name.ends_with(".png"), "no drafts: {name}");
        read_png(&at("all").join(name)).expect("what is there is whole");
    }
    assert!(!names(folder.path()).iter().any(|name| name.contains(".parts") || name.starts_with(".lcm")));
}

#[test]
fn a_sweep_ended_by_a_signal_goes_on_from_its_finished_pictures() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let scene = save::to_json(&close_up("sphere", "rectangle"), None, &Registry::builtin());
    fs::write(at("s.json"), scene).expect("written");
    let of = |output: &'static str| {
        let start = ["sweep", "s.json", "--vary", "display.exposure=-2..2:9", "--size", "320x180"];
        [&start[..], &["--light-samples", "512", "-o", output]].concat()
    };
    let own = command_in(folder.path(), of("sheet.png"));
    let mut command = Command::new("env");
    command.arg("--default-signal=INT,HUP,TERM").arg(own.get_program()).args(own.get_args());
    command.current_dir(folder.path()).env("LCM_DATA_DIR", at("none"));
    let mut child = command.stdin(Stdio::null()).stderr(Stdio::null()).spawn().expect("it starts");
    let begin = Instant::now();
    let parts = at("sheet.png.parts");
    let some = || parts.is_dir() && names(&parts).iter().any(|name| name.ends_with(".png"));
    while !some() && child.try_wait().expect("asked").is_none() && begin.elapsed() < Duration::from_secs(120)
    {
        thread::sleep(Duration::from_millis(5));
    }
    if child.try_wait().expect("asked").is_none() {
        let sent = Command::new("kill").args(["-s", "INT", &child.id().to_string()]).status();
        assert!(sent.expect("there is kill").success());
    }
    let status = child.wait().expect("it ends");
    if status.success() {
        // A machine this fast needs no parts.
        assert!(!parts.exists());
        return;
    }
    assert_eq!(status.signal(), Some(2));
    assert!(!at("sheet.png").exists(), "nothing half written");
    let run = lcm_in(folder.path(), &of("sheet.png"), b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert!(run.err.contains("there already"), "{}", run.err);
    assert!(!parts.exists(), "they are removed at the end");
    let run = lcm_in(folder.path(), &of("again.png"), b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert!(fs::read(at("sheet.png")).expect("there") == fs::read(at("again.png")).expect("there"));
}
