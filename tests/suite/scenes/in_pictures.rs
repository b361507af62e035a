//! Pictures that contain their scene and metadata.

use std::{fs, io::Write as _, path::Path};

use bevy::{app::App, window::FileDragAndDrop};
use flate2::{Compression, Crc, write::ZlibEncoder};
use lights_camera_models::{
    caption,
    document::Edit,
    panel::state::{Action, Effect, Pick, Session},
    parameter::Value,
    registry::Registry,
    scene::{
        Comparison, Part, Scene, Variant,
        comparison::Layout,
        formats::SCENE_KEYWORD,
        load::{self, Defaults},
        save::to_json,
    },
};

#[cfg(target_os = "linux")]
use crate::helpers::screen::Screen;
use crate::{
    helpers::support::{check_wording, full_scene, lcm_in, root, written},
    library::plugins::{app, whole},
    scenes::formats::Desk,
};

/// A picture of a scene in a folder, drawn small by the CPU.
fn render(folder: &Path, arguments: &[&str]) {
    let size: &[&str] = if arguments.contains(&"--size") { &[] } else { &["--size", "64x36"] };
    let arguments = [&["render", "--renderer", "cpu"], size, arguments].concat();
    let run = lcm_in(folder, &arguments, b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
}

/// The size and the pixels of a picture.
fn pixels(path: &Path) -> ([u32; 2], Vec<u8>) {
    let file = std::io::BufReader::new(fs::File::open(path).expect("there"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG file");
    let mut bytes = vec![0; reader.output_buffer_size().expect("fits")];
    let info = reader.next_frame(&mut bytes).expect("a picture");
    ([info.width, info.height], bytes)
}

fn chunk(kind: &[u8; 4], content: &[u8]) -> Vec<u8> {
    let checked = [kind, content].concat();
    let mut crc = Crc::new();
    crc.update(&checked);
    [&(content.len() as u32).to_be_bytes()[..], &checked, &crc.sum().to_be_bytes()].concat()
}

/// A picture with a text, which is not a scene if the keyword is not ours.
fn with_text(keyword: &str, text: &[u8]) -> Vec<u8> {
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::fast());
    packed.write_all(text).expect("in memory");
    let packed = packed.finish().expect("in memory");
    let content = [keyword.as_bytes(), b"\0\x01\0\0\0", &packed].concat();
    [b"\x89PNG\r\n\x1a\n".to_vec(), chunk(b"IHDR", &[0; 13]), chunk(b"iTXt", &content), chunk(b"IEND", &[])]
        .concat()
}

#[test]
fn a_picture_opens_as_the_scene_that_it_shows() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("full.json"), full_scene().to_string()).expect("written");
    let changes = ["--reflection", "blinn_phong", "--exposure", "1", "--tone-mapping", "agx"];
    render(folder.path(), &[&["full.json", "-o", "a.png"], &changes[..]].concat());
    // The scene is the displayed one, with the changes from the command line.
    let shown = load::file(&at("a.png"), &Registry::builtin(), Defaults::Refuse).expect("has a scene").scene;
    assert_eq!((shown.reflection_model.as_str(), shown.display.exposure), ("blinn_phong", 1.0));
    let mut expected =
        load::file(&at("full.json"), &Registry::builtin(), Defaults::Refuse).expect("valid").scene;
    expected.reflection_model.clone_from(&shown.reflection_model);
    expected.display = shown.display;
    expected.objects[0].reflection_model = None;
    // Command-line options apply to every view.
    for variant in &mut expected.variants {
        (variant.reflection_model, variant.exposure, variant.tone_mapping) = (None, None, None);
    }
    assert_eq!(shown, expected);
    // It gives the same picture, and the same scene again.
    render(folder.path(), &["a.png", "-o", "b.png"]);
    assert!(pixels(&at("a.png")) == pixels(&at("b.png")));
    let again = load::file(&at("b.png"), &Registry::builtin(), Defaults::Refuse).expect("has a scene").scene;
    assert_eq!(again, shown);
    // From standard input, and without an extension, by its first bytes.
    let run = lcm_in(folder.path(), &["check", "a.png", "-"], &fs::read(at("b.png")).expect("there"));
    assert!(run.status == Some(0) && run.out.contains("a.png: valid: 4 lights, 4 objects"), "{}", run.err);
    assert!(run.out.contains("standard input: valid"), "{}", run.out);
    fs::copy(at("a.png"), at("picture")).expect("copied");
    assert_eq!(lcm_in(folder.path(), &["check", "picture"], b"").status, Some(0));
    // A picture is never drawn over the one being read.
    let run = lcm_in(folder.path(), &["render", "a.png", "-o", "a.png", "--size", "8x8"], b"");
    assert!(run.status == Some(4) && run.err.contains("a.png is read by this command"), "{}", run.err);
    // The wrong twin.
    render(folder.path(), &["full.json", "-o", "bare.png", "--no-scene"]);
    let run = lcm_in(folder.path(), &["check", "bare.png"], b"");
    assert_eq!(run.status, Some(1));
    assert!(
        run.err.contains("bare.png: there is no scene in this picture, only texts called "),
        "{}",
        run.err
    );
    assert!(run.err.contains("unless --no-scene is given"), "{}", run.err);
    assert_eq!(pixels(&at("bare.png")).0, [64, 36]);
}

#[test]
fn each_mistake_of_a_picture_is_told_and_ends_with_status_1() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = written(&Scene::default());
    let good = with_text(SCENE_KEYWORD, scene.as_bytes());
    let broken = scene.replace("\"height\": 10", "\"height\": 1000");
    assert_ne!(broken, scene);
    let cases: [(Vec<u8>, &str); 9] = [
        (
            with_text("XML:com.adobe.xmp", b"<x/>"),
            "only texts called \"XML:com.adobe.xmp\"; pictures that this program writes have one",
        ),
        (good[..40].to_vec(), "x.png: the picture is truncated, and there is no scene in what is left"),
        (scene.clone().into_bytes(), "x.png: this is not a PNG picture, though its name ends in .png"),
        (Vec::new(), "x.png: the file is empty"),
        (with_text(SCENE_KEYWORD, b" "), "x.png: the scene in the picture is empty"),
        (
            with_text(SCENE_KEYWORD, b"{\n  \"name\": nobody\n}"),
            "x.png: the scene in the picture is not JSON: ",
        ),
        (
            with_text(SCENE_KEYWORD, b"\xff\xfe"),
            "x.png: the scene in the picture is damaged: it is not UTF-8 text",
        ),
        // Without a position: nobody sees the text.
        (with_text(SCENE_KEYWORD, broken.as_bytes()), "x.png: scene_size.height is 1000, but "),
        (
            with_text(SCENE_KEYWORD, &vec![b' '; (64 << 20) + 1]),
            "x.png: the scene in the picture is larger than 64 MiB, the most allowed; it was not read",
        ),
    ];
    for (bytes, expected) in cases {
        fs::write(folder.path().join("x.png"), bytes).expect("written");
        for command in ["check", "render", "view"] {
            let run = lcm_in(folder.path(), &[command, "x.png"], b"");
            assert_eq!(run.status, Some(1), "{command}: {}", run.err);
            assert!(run.err.contains(expected), "{command}: {}", run.err);
            check_wording(&run.err);
        }
        let run = lcm_in(folder.path(), &["check", "--json", "x.png"], b"");
        assert!(run.status == Some(1) && run.out.contains("\"valid\": false"), "{}", run.out);
        assert!(!run.out.contains("\"line\": 1"), "{}", run.out);
    }
    fs::write(folder.path().join("x.png"), &good).expect("written");
    assert_eq!(lcm_in(folder.path(), &["check", "x.png"], b"").status, Some(0));
    assert!(!folder.path().join("renders").exists(), "nothing was drawn");
    // Under another name, the message explains what to do.
    fs::write(folder.path().join("x.json"), &good).expect("written");
    let run = lcm_in(folder.path(), &["check", "x.json"], b"");
    assert!(run.err.contains("a scene in it is read if the name of the file ends in .png"), "{}", run.err);
}

/// An OpenEXR file with a text and without pixels, and a Radiance file with these lines as its remarks.
fn linear(keyword: &str, text: &[u8]) -> [Vec<u8>; 2] {
    let length = (text.len() as u32).to_le_bytes();
    let exr =
        [b"v/1\x01\x02\0\0\0".as_slice(), keyword.as_bytes(), b"\0string\0", &length, text, b"\0"].concat();
    let lines = text.split(|byte| *byte == b'\n').flat_map(|line| [b"# ".as_slice(), line, b"\n"].concat());
    let hdr = format!("#?RADIANCE\n# {keyword} begins\n").into_bytes().into_iter().chain(lines);
    let hdr = hdr.chain(format!("# {keyword} ends\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 1\naaaa").into_bytes());
    [exr, hdr.collect()]
}

#[test]
fn each_mistake_of_a_linear_picture_is_told_and_ends_with_status_1() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = written(&Scene::default());
    let broken = scene.replace("\"height\": 10", "\"height\": 1000");
    assert_ne!(broken, scene);
    let cut = |whole: [Vec<u8>; 2]| whole.map(|bytes| bytes[..60].to_vec());
    let cases: [([Vec<u8>; 2], &str); 8] = [
        ([Vec::new(), Vec::new()], ": the file is empty"),
        (linear("comments", b"a"), "pictures that this program writes have one, unless --no-scene is given"),
        (
            cut(linear("comments", &[b'a'; 99])),
            "the picture is truncated, and there is no scene in what is left",
        ),
        ([scene.clone().into_bytes(), scene.clone().into_bytes()], "picture, though its name ends in ."),
        (linear(SCENE_KEYWORD, b" "), "the scene in the picture is empty"),
        (linear(SCENE_KEYWORD, b"{\n  \"name\": nobody\n}"), "the scene in the picture is not JSON: "),
        (linear(SCENE_KEYWORD, b"\xff\xfe"), "the scene in the picture is damaged: it is not UTF-8 text"),
        // Without a position: nobody sees the text.
        (linear(SCENE_KEYWORD, broken.as_bytes()), "scene_size.height is 1000, but "),
    ];
    for (files, expected) in cases {
        for (name, bytes) in ["x.exr", "x.hdr"].into_iter().zip(files) {
            fs::write(folder.path().join(name), bytes).expect("written");
            for command in ["check", "render", "view"] {
                let run = lcm_in(folder.path(), &[command, name], b"");
                assert_eq!(run.status, Some(1), "{command}: {}", run.err);
                assert!(run.err.starts_with(name) && run.err.contains(expected), "{command}: {}", run.err);
                check_wording(&run.err);
            }
        }
    }
    assert!(!folder.path().join("renders").exists(), "nothing was drawn");
    for (name, bytes) in ["x.exr", "x.hdr"].into_iter().zip(linear(SCENE_KEYWORD, scene.as_bytes())) {
        fs::write(folder.path().join(name), &bytes).expect("written");
        assert_eq!(lcm_in(folder.path(), &["check", name], b"").status, Some(0));
        assert_eq!(lcm_in(folder.path(), &["check", "-"], &bytes).status, Some(0), "by its first bytes");
        // Under another name, the message explains what to do.
        fs::write(folder.path().join("x.json"), &bytes).expect("written");
        let run = lcm_in(folder.path(), &["check", "x.json"], b"");
        let ending = &name[1..];
        let expected = format!("a scene in it is read if the name of the file ends in {ending}");
        assert!(run.err.contains(&expected), "{}", run.err);
    }
}

#[test]
fn files_that_a_scene_names_are_looked_for_beside_its_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    for name in ["photometric_lamps.json", "wall_washer.ies"] {
        fs::copy(root().join("scenes").join(name), at(name)).expect("copied");
    }
    let scene = fs::read_to_string(at("photometric_lamps.json")).expect("there");
    fs::rename(at("wall_washer.ies"), at("lamp.ies")).expect("renamed");
    let named = scene.replace("wall_washer.ies", "lamp.ies");
    let named = if named == scene {
        scene.replacen("\"type\": \"photometric\",", "\"type\": \"photometric\", \"file\": \"lamp.ies\",", 1)
    } else {
        named
    };
    fs::write(at("photometric_lamps.json"), named).expect("written");
    render(folder.path(), &["photometric_lamps.json", "-o", "lamps.png"]);
    assert_eq!(lcm_in(folder.path(), &["check", "lamps.png"], b"").status, Some(0));
    fs::create_dir(at("elsewhere")).expect("made");
    fs::rename(at("lamps.png"), at("elsewhere/lamps.png")).expect("moved");
    let run = lcm_in(folder.path(), &["check", "elsewhere/lamps.png"], b"");
    assert!(run.status == Some(1) && run.err.contains("lamp.ies"), "{}", run.err);
    fs::rename(at("lamp.ies"), at("elsewhere/lamp.ies")).expect("moved");
    let run = lcm_in(folder.path(), &["check", "elsewhere/lamps.png"], b"");
    assert_eq!(run.status, Some(0), "{}", run.err);
}

#[test]
fn a_scene_from_a_picture_is_saved_as_json() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("gold.png");
    let scene = Scene { name: Some("Gold".to_owned()), ..Scene::default() };
    let picture = with_text(SCENE_KEYWORD, written(&scene).as_bytes());
    fs::write(&path, &picture).expect("written");
    let mut desk = Desk::open(&path, Registry::builtin());
    assert_eq!(desk.session.title(), "Gold");
    desk.act(Action::Edit(Edit::set(Part::Scene, Scene::name, "Silver")));
    desk.act(Action::Save);
    assert!(desk.left.contains(&Effect::Pick(Pick::Save)), "{:?}", desk.left);
    let said = &desk.session.messages.last().expect("said").text;
    assert!(
        said.contains("gold.png was not written: files of the format PNG picture can only be read"),
        "{said}"
    );
    assert!(said.contains("gold.json"), "{said}");
    // A typed picture name is not a scene name.
    desk.act(Action::SaveAs(folder.path().join("silver.png")));
    assert!(folder.path().join("silver.png.json").is_file() && !desk.session.is_dirty());
    assert_eq!(fs::read(&path).expect("there"), picture);
}

#[cfg(target_os = "linux")]
#[test]
fn a_capture_of_the_window_holds_the_scene_of_the_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let scene = Scene { name: Some("Gold".to_owned()), ..Scene::default() };
    fs::write(at("gold.json"), written(&scene)).expect("written");
    let screen = Screen::new(640, 480);
    let capture = |scene: &str, flags: &[&str]| {
        let [scene, file] = [scene, "w.png"].map(|name| at(name).display().to_string());
        let arguments = ["view", &scene, "--exit-after", "3", "--capture", &file, "--size", "640x480"];
        let output = screen.lcm(&[&arguments, flags].concat(), folder.path());
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        load::file(&at("w.png"), &Registry::builtin(), Defaults::Refuse)
    };
    let held = capture("gold.json", &[]).expect("has a scene").scene;
    assert_eq!(held.name.as_deref(), Some("Gold"));
    // The window opens it, too.
    fs::rename(at("w.png"), at("v.png")).expect("renamed");
    assert_eq!(capture("v.png", &[]).expect("has a scene").scene, held);
    let said = capture("gold.json", &["--no-scene"]).expect_err("has none").to_string();
    assert!(said.contains("there is no scene in this picture"), "{said}");
}

#[test]
fn a_caption_is_added_below_the_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("full.json"), full_scene().to_string()).expect("written");
    render(folder.path(), &["full.json", "-o", "plain.png", "--size", "320x180"]);
    let (size, plain) = pixels(&at("plain.png"));
    assert_eq!(size, [320, 180]);
    render(
        folder.path(),
        &["full.json", "-o", "said.png", "--size", "320x180", "--caption", "--term", "diffuse"],
    );
    render(folder.path(), &["full.json", "-o", "all.png", "--size", "320x180", "--caption"]);
    let ([width, height], all) = pixels(&at("all.png"));
    assert!(width == 320 && (220..280).contains(&height), "{height}");
    assert!(all[..plain.len()] == plain, "the picture is as it was");
    let said = pixels(&at("said.png")).1;
    assert!(said[plain.len()..] != all[plain.len()..], "the term is said");
    // The scene in a captioned picture is the scene.
    let back = load::file(&at("all.png"), &Registry::builtin(), Defaults::Refuse).expect("has a scene").scene;
    let scene = load::file(&at("full.json"), &Registry::builtin(), Defaults::Refuse).expect("valid").scene;
    assert_eq!(to_json(&back, None, &Registry::builtin()), to_json(&scene, None, &Registry::builtin()));
}

#[test]
fn numbers_of_a_comparison_are_added_to_its_caption() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let variant = Variant { reflection_model: Some("phong".to_owned()), ..Variant::default() };
    let comparison = Comparison { layout: Layout::SideBySide, ..Comparison::default() };
    let scene = Scene { variants: vec![variant], comparison, ..Scene::default() };
    fs::write(at("pair.json"), to_json(&scene, None, &Registry::builtin())).expect("written");
    let drawn = |more: &[&str]| {
        let fixed = ["pair.json", "-o", "x.png", "--size", "640x360", "--caption"];
        render(folder.path(), &[&fixed, more].concat());
        pixels(&at("x.png")).1
    };
    let (plain, said) = (drawn(&[]), drawn(&["--numbers"]));
    let picture = 640 * 360 * 3;
    assert!(plain[..picture] == said[..picture] && plain[picture..] != said[picture..]);
    for (arguments, status, expected) in [
        (
            &["--numbers", "--caption", "--view", "A"][..],
            1,
            "pair.json: --numbers compares views, but the picture shows one",
        ),
        (&["--numbers"], 2, "--caption"),
    ] {
        let run = lcm_in(folder.path(), &[&["render", "pair.json", "-o", "y.png"], arguments].concat(), b"");
        assert!(run.status == Some(status) && run.err.contains(expected), "{}", run.err);
        assert!(!at("y.png").exists());
    }
}

#[test]
fn every_view_of_every_shipped_scene_has_a_caption_without_defaults_and_repetitions() {
    let registry = Registry::builtin();
    for path in crate::helpers::support::shipped_scenes() {
        let scene = load::file(&path, &registry, Defaults::Use).expect("valid").scene;
        let facts = |scene: &Scene, view| caption::of_view(scene, view, &registry).expect("is a view").facts;
        for view in 0..=scene.variants.len() {
            let of_view = facts(&scene, view);
            let (seen, _) = scene.seen(view, &registry).expect("is a view");
            for object in seen.shown() {
                let id = seen.model_of(object);
                let name = registry.model(id).map_or(id, |m| m.declaration.name);
                let says = |part: &&caption::Part| {
                    part.text.strip_prefix(name).is_some_and(|rest| rest.is_empty() || rest.starts_with(" ("))
                };
                let (path, line) = (path.display(), caption::line(&of_view));
                assert_eq!(of_view.iter().filter(says).count(), 1, "{path}, {view}: {name}: {line}");
            }
        }
        // A value equal to the default is omitted.
        let mut usual = Scene { variants: Vec::new(), ..scene };
        for object in &mut usual.objects {
            object.material.set("k_d", Value::Number(0.8));
        }
        let line = caption::line(&facts(&usual, 0));
        assert!(!line.contains("k_d ="), "{}: {line}", path.display());
    }
}

#[test]
fn a_file_that_is_dropped_on_the_window_opens() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let scene = Scene { name: Some("Gold".to_owned()), ..Scene::default() };
    fs::write(at("gold.png"), with_text(SCENE_KEYWORD, written(&scene).as_bytes())).expect("written");
    fs::write(at("notes.txt"), "Gold.").expect("written");
    let mut app = app(whole(), |_| ());
    let drop = |app: &mut App, names: &[&str]| {
        let window = app.world_mut().spawn_empty().id();
        for name in names {
            app.world_mut().write_message(FileDragAndDrop::HoveredFile { window, path_buf: at("gold.png") });
            app.world_mut().write_message(FileDragAndDrop::DroppedFile { window, path_buf: at(name) });
        }
        (0..3).for_each(|_| app.update());
    };
    let title = |app: &App| app.world().resource::<Session>().title().to_owned();
    let before = title(&app);
    // A picture without a scene is reported, and changes nothing.
    drop(&mut app, &["notes.txt"]);
    assert_eq!(title(&app), before);
    let said = |app: &App, what: &str| {
        app.world().resource::<Session>().messages.iter().any(|m| m.text.contains(what))
    };
    assert!(said(&app, ".txt is not the extension of a scene"));
    drop(&mut app, &["notes.txt", "gold.png"]);
    assert_eq!(title(&app), "Gold");
    // A linear picture with a scene is a scene; one without is a picture of surroundings.
    let silver = Scene { name: Some("Silver".to_owned()), ..Scene::default() };
    let [exr, hdr] = linear(SCENE_KEYWORD, written(&silver).as_bytes());
    fs::write(at("silver.exr"), exr).expect("written");
    fs::write(at("silver.hdr"), hdr).expect("written");
    fs::copy(root().join("scenes/room.hdr"), at("room.hdr")).expect("copied");
    let lights = |app: &App| app.world().resource::<Session>().document.lights.len();
    for name in ["silver.exr", "silver.hdr"] {
        drop(&mut app, &["gold.png"]);
        assert_eq!(title(&app), "Gold");
        drop(&mut app, &[name]);
        assert_eq!(title(&app), "Silver", "{name}");
    }
    let count = lights(&app);
    drop(&mut app, &["room.hdr"]);
    assert_eq!((title(&app), lights(&app)), ("Silver".to_owned(), count + 1));
    // A question about unsaved work comes first.
    app.world_mut().resource_mut::<Session>().document.amend(|scene| scene.name = Some("Mine".to_owned()));
    drop(&mut app, &["gold.png"]);
    assert_eq!(title(&app), "Mine");
}
