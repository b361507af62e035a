//! Exports on disk: whole or not at all, never replacing anything without being asked, and refused with all
//! reasons.

use std::{
    fs,
    path::{Path, PathBuf},
    thread,
    time::Duration,
};

use lights_camera_models::{
    export::{
        Export, FORMS, File, Form, Makes, Progress, Request, form,
        write::{may_write, write},
    },
    files::Before,
    registry::Registry,
    scene::{Light, Object, Scene, save},
};

use crate::helpers::support::{Run, check_wording, command_in, lcm_in, names};

/// Runs an export in a folder.
fn export(folder: &Path, arguments: &[&str]) -> Run {
    lcm_in(folder, &[&["export"], arguments].concat(), b"")
}

fn refused(run: &Run, status: i32, expected: &str) {
    assert_eq!((run.status, run.out.as_str()), (Some(status), ""), "{}", run.err);
    assert!(run.err.contains(expected), "{}\nnot: {expected}", run.err);
    check_wording(&run.err);
}

/// All paths below a folder.
fn below(folder: &Path) -> Vec<String> {
    let mut found = Vec::new();
    for name in names(folder) {
        let path = folder.join(&name);
        if path.is_dir() {
            found.extend(below(&path).into_iter().map(|inner| format!("{name}/{inner}")));
        }
        found.push(name);
    }
    found.sort();
    found
}

fn write_scene(path: &Path, scene: &Scene) {
    fs::write(path, save::to_json(scene, None, &Registry::builtin())).expect("written");
}

#[test]
fn every_form_is_described_and_has_a_place_by_default() {
    let run = lcm_in(Path::new("."), &["export", "--help"], b"");
    for form in FORMS {
        assert!(run.out.contains(&format!("{}: {}", form.id, form.summary)), "{}", form.id);
        assert!(!form.summary.ends_with('.') && !form.name.is_empty());
        let expected = match form.makes {
            Makes::File("") => "exports/room".to_owned(),
            Makes::File(extension) => format!("exports/room.{extension}"),
            Makes::Folder => format!("exports/room_{}", form.id),
        };
        assert_eq!(form.default_path("room"), PathBuf::from(expected));
    }
    let ids: std::collections::BTreeSet<_> = FORMS.iter().map(|form| form.id).collect();
    assert_eq!(ids.len(), FORMS.len());
    assert!(form("executable").is_some() && form("paper").is_none());
}

#[test]
fn without_a_place_exports_go_to_the_folder_exports() {
    let folder = tempfile::tempdir().expect("a folder");
    write_scene(&folder.path().join("room.json"), &Scene::default());
    let run = export(folder.path(), &["room.json", "--as", "mitsuba"]);
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert!(run.err.contains("wrote exports/room_mitsuba"), "{}", run.err);
    let expected =
        ["meshes", "meshes/sphere_0.ply", "scene.xml"].map(|name| format!("exports/room_mitsuba/{name}"));
    let found = below(folder.path());
    assert!(expected.iter().all(|path| found.contains(path)), "{found:?}");
    // With --quiet only errors are printed.
    let run = export(folder.path(), &["room.json", "--as", "mitsuba", "-o", "quiet", "--quiet"]);
    assert_eq!((run.status, run.err.as_str()), (Some(0), ""));
}

#[test]
fn wrong_usage_is_reported() {
    let folder = tempfile::tempdir().expect("a folder");
    refused(&export(folder.path(), &[]), 2, "--as <FORM>");
    refused(&export(folder.path(), &["--as", "mitsbua"]), 2, "mitsuba");
    refused(
        &export(folder.path(), &["--as", "mitsuba", "--object", "0"]),
        2,
        "mitsuba always contains all objects; omit --object",
    );
    let object = "there is no object \"-1\"; it must be a name, or an index from 0 to 0";
    refused(&export(folder.path(), &["--as", "wgsl", "--object", "-1"]), 1, object);
    refused(&export(folder.path(), &["room.json", "--as", "mitsuba"]), 1, "room.json");
    refused(&lcm_in(folder.path(), &["exprt"], b""), 2, "did you mean lcm export?");
    assert_eq!(names(folder.path()), Vec::<String>::new());
}

#[test]
fn an_export_replaces_nothing_unasked_and_then_all_of_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("out");
    let mitsuba = ["--as", "mitsuba", "-o", "out"];
    assert_eq!(export(folder.path(), &mitsuba).status, Some(0));
    fs::write(place.join("mine.txt"), "mine").expect("written");
    refused(
        &export(folder.path(), &mitsuba),
        4,
        "out exists; it was not overwritten; --overwrite replaces it",
    );
    assert!(place.join("mine.txt").exists());
    let again = [&mitsuba[..], &["--overwrite"]].concat();
    refused(
        &export(folder.path(), &again),
        4,
        "out has mine.txt, which is not part of an export of this form",
    );
    assert!(place.join("mine.txt").exists());
    fs::remove_file(place.join("mine.txt")).expect("there");
    fs::write(place.join("scene.xml"), "changed").expect("written");
    let run = export(folder.path(), &again);
    assert_eq!(run.status, Some(0), "{}", run.err);
    assert_eq!(names(&place), ["meshes", "scene.xml"]);
    assert_ne!(fs::read(place.join("scene.xml")).expect("there"), b"changed");

    // An empty folder has nothing to lose.
    fs::create_dir(folder.path().join("empty")).expect("made");
    let run = export(folder.path(), &["--as", "mitsuba", "-o", "empty"]);
    assert_eq!(run.status, Some(0), "{}", run.err);

    // Confusing the destination with its enclosing folder loses nothing.
    let home = folder.path().join("home");
    fs::create_dir(&home).expect("made");
    fs::write(home.join("thesis.tex"), "years").expect("written");
    let run = export(folder.path(), &["--as", "mitsuba", "-o", "home", "--overwrite"]);
    refused(&run, 4, "home has no scene.xml, so it is not an export of this form; it was not overwritten");

    fs::write(folder.path().join("file"), "mine").expect("written");
    let program = ["--as", "executable", "-o", "file"];
    refused(&export(folder.path(), &program), 4, "file exists");
    assert_eq!(fs::read(folder.path().join("file")).expect("there"), b"mine");
    assert_eq!(names(folder.path()), ["empty", "file", "home", "out"], "no litter");
}

#[test]
fn a_file_is_no_place_for_a_folder_nor_a_folder_for_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("file"), "mine").expect("written");
    fs::create_dir(folder.path().join("folder")).expect("made");
    for more in [&[][..], &["--overwrite"]] {
        let run = export(folder.path(), &[&["--as", "mitsuba", "-o", "file"], more].concat());
        refused(&run, 4, "file is not a folder, but this form makes one; it was not overwritten");
        let run = export(folder.path(), &[&["--as", "executable", "-o", "folder"], more].concat());
        refused(&run, 4, "folder is a folder, but this form makes a file; it was not overwritten");
    }
    // A file in place of the enclosing folder.
    for place in ["file/out", "file/deep/out"] {
        let run = export(folder.path(), &["--as", "mitsuba", "-o", place]);
        refused(&run, 4, &format!("{place} could not be written: file is not a folder\n"));
    }
    assert_eq!(below(folder.path()), ["file", "folder"]);
}

#[test]
fn the_folder_of_the_terminal_is_not_replaced() {
    let folder = tempfile::tempdir().expect("a folder");
    let here = folder.path().join("here/deep");
    fs::create_dir_all(&here).expect("made");
    for place in [".", "..", "../deep", "../../here/deep"] {
        for more in [&[][..], &["--overwrite"]] {
            let run = export(&here, &[&["--as", "mitsuba", "-o", place], more].concat());
            // Without the flag, a folder with contents is kept anyway.
            let expected = match (place, more) {
                ("..", []) => ".. exists; it was not overwritten".to_owned(),
                _ => format!("{place} is the current folder, or contains it; name a new folder"),
            };
            assert_eq!(run.status, Some(4), "{}", run.err);
            assert!(run.err.contains(&expected), "{}", run.err);
        }
    }
    assert_eq!(below(folder.path()), ["here", "here/deep"]);
}

#[test]
fn an_object_that_shares_its_name_is_called_by_its_index() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scene = Scene::default();
    scene.objects[0].name = Some("ball".to_owned());
    let another = Object { position: glam::Vec3::splat(2.0), ..scene.objects[0].clone() };
    scene.objects.push(another);
    write_scene(&folder.path().join("two.json"), &scene);
    let wgsl =
        |object: &str| export(folder.path(), &["two.json", "--as", "wgsl", "-o", object, "--object", object]);
    refused(
        &wgsl("ball"),
        1,
        "two.json: objects[0] and objects[1] are called \"ball\"; name one by its index: --object 0",
    );
    for index in ["0", "1"] {
        assert_eq!(wgsl(index).status, Some(0));
    }
    let manifest = |index: &str| fs::read(folder.path().join(index).join("manifest.json")).expect("there");
    assert_ne!(manifest("0"), manifest("1"));
}

#[test]
fn a_folder_with_an_input_is_never_replaced() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    for name in ["out", "lamps", "models"] {
        fs::create_dir(at(name)).expect("made");
        // It looks like an export.
        fs::write(at(name).join("scene.xml"), "").expect("written");
    }
    write_scene(&at("out").join("room.json"), &Scene::default());
    let run = export(folder.path(), &["out/room.json", "--as", "mitsuba", "-o", "out", "--overwrite"]);
    refused(&run, 4, "out holds out/room.json, which is read by this command; it was not overwritten");

    // A lamp named in the scene, and a model that it uses.
    let lamp = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/wall_washer.ies"));
    fs::write(at("lamps").join("mine.ies"), lamp).expect("written");
    let text = save::to_json(&Scene::default(), None, &Registry::builtin());
    let lit = text.replace(
        "\"type\": \"point\",",
        "\"type\": \"photometric\", \"file\": \"lamps/mine.ies\", \"direction\": [0, -1, 0],",
    );
    fs::write(at("lit.json"), lit.replace("\"intensity\": 20", "\"intensity\": 1")).expect("written");
    let run = export(folder.path(), &["lit.json", "--as", "mitsuba", "-o", "lamps", "--overwrite"]);
    refused(&run, 4, "mine.ies, which is read by this command; it was not overwritten");

    let model = include_bytes!(concat!(env!("CARGO_MANIFEST_DIR"), "/assets/models/gooch.wgsl"));
    fs::write(at("models").join("gooch.wgsl"), model).expect("written");
    fs::write(at("gooch.json"), text.replace("lambert", "gooch")).expect("written");
    let arguments = ["gooch.json", "--models", "models", "--as", "mitsuba", "-o", "models", "--overwrite"];
    refused(&export(folder.path(), &arguments), 4, "gooch.wgsl, which is read by this command");

    // The program is one too.
    let copy = at("copy");
    fs::copy(env!("CARGO_BIN_EXE_lcm"), &copy).expect("copied");
    let length = fs::metadata(&copy).expect("there").len();
    let run =
        crate::helpers::support::command_in(folder.path(), ["export", "--as", "executable", "-o", "copy"])
            .arg("--overwrite")
            .output()
            .expect("it runs");
    assert!(run.status.success(), "another program may be replaced");
    let program = std::process::Command::new(&copy)
        .args(["export", "--as", "executable", "-o", "copy", "--overwrite"])
        .current_dir(folder.path())
        .output()
        .expect("it runs");
    let said = String::from_utf8_lossy(&program.stderr).into_owned();
    assert_eq!(program.status.code(), Some(4), "{said}");
    assert!(said.contains("copy is read by this command"), "{said}");
    assert!(fs::metadata(&copy).expect("there").len() > length);
}

#[test]
fn what_cannot_be_exported_is_refused_part_by_part_and_leaves_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scene = Scene { reflection_model: "strauss".to_owned(), ..Scene::default() };
    scene.objects[0].name = Some("Ball".to_owned());
    scene.objects.push(Object {
        reflection_model: Some("lambert".to_owned()),
        position: glam::Vec3::splat(2.0),
        ..Object::default()
    });
    scene.objects.push(Object { reflection_model: Some("hapke".to_owned()), ..scene.objects[1].clone() });
    scene.objects[2].position.x = 3.0;
    let registry = Registry::builtin();
    scene.lights[0].set_type(registry.light("photometric").expect("built in"), &registry, scene.scene_size);
    scene.lights[0].name = Some("Key".to_owned());
    write_scene(&folder.path().join("room.json"), &scene);
    for place in ["out", "deep/er/out"] {
        let run = export(folder.path(), &["room.json", "--as", "mitsuba", "-o", place]);
        let lines: Vec<_> = run.err.lines().collect();
        let expected = [
            "room.json: cannot be exported as mitsuba: lights[0] (\"Key\"): Mitsuba has no counterpart of the light type photometric",
            "room.json: cannot be exported as mitsuba: objects[0] (\"Ball\"): Mitsuba has no counterpart of the reflection model strauss",
            "room.json: cannot be exported as mitsuba: objects[2]: Mitsuba has no counterpart of the reflection model hapke",
        ];
        assert_eq!((run.status, lines.as_slice()), (Some(1), &expected[..]));
        assert_eq!(below(folder.path()), ["room.json"]);
    }
    // A reason that applies to several parts is given once.
    let strauss = scene.objects[0].clone();
    for x in [4.0, 5.0] {
        scene.objects.push(Object { name: None, position: glam::Vec3::splat(x), ..strauss.clone() });
    }
    write_scene(&folder.path().join("room.json"), &scene);
    let run = export(folder.path(), &["room.json", "--as", "mitsuba", "-o", "out"]);
    let expected = "objects[0] (\"Ball\"), objects[3] and objects[4]: Mitsuba has no counterpart of the reflection model strauss\n";
    assert!(run.err.contains(expected) && run.err.lines().count() == 3, "{}", run.err);
    // An invalid scene is refused earlier.
    fs::write(folder.path().join("bad.json"), "{ \"objects\": 7 }").expect("written");
    let run = export(folder.path(), &["bad.json", "--as", "mitsuba", "-o", "out", "--use-defaults"]);
    refused(&run, 1, "bad.json:1");
    assert_eq!(below(folder.path()), ["bad.json", "room.json"]);
}

/// Text formats report it; programs contain the whole scene.
#[test]
fn no_form_loses_light_with_extent() {
    let registry = Registry::builtin();
    for entry in registry.lights().iter().filter(|entry| entry.declaration.extent) {
        let id = entry.declaration.id;
        let mut scene = Scene { reflection_model: "lambert".to_owned(), ..Scene::default() };
        scene.lights[0].set_type(entry, &registry, scene.scene_size);
        scene.lights[0].name = Some("Key".to_owned());
        let made = |form: &Form, scene: &Scene| {
            let (stem, size) = ("room", (64, 48));
            let request = Request { scene, registry: &registry, stem, size, object: 0, point: None };
            (form.make)(&request, &Progress::NONE)
        };
        for form in FORMS.iter().filter(|form| form.id != "executable") {
            let export = made(form, &scene).unwrap_or_else(|error| panic!("{} {id}: {error}", form.id));
            let text: String = export.files.iter().map(|file| String::from_utf8_lossy(&file.bytes)).collect();
            let marks = match form.id {
                "mitsuba" => ["type=\"area\"", "type=\"envmap\""].map(str::to_owned),
                "bevy" | "wgsl" | "glsl" | "hlsl" | "msl" | "spirv" => {
                    [format!("sample_{id}"), format!("seen_{id}")]
                }
                _ => continue,
            };
            assert!(marks.iter().any(|mark| text.contains(mark)), "{} loses {id}", form.id);
        }
        // Mitsuba allows one light from all directions.
        scene.lights.push(Light { light_type: "ambient".to_owned(), ..Light::default() });
        let both = made(form("mitsuba").expect("listed"), &scene);
        assert_eq!(both.is_err(), id == "environment");
        if let Err(error) = both {
            let expected = "lights[1]: Mitsuba allows only one light from all around, and lights[0] (\"Key\") is one already";
            assert!(error.to_string().contains(expected), "{error}");
            check_wording(&error.to_string());
        }
    }
}

#[test]
#[cfg(target_os = "linux")]
fn where_nothing_can_be_written_nothing_is_left() {
    // Nobody can create files there, whoever runs the tests.
    for place in ["/proc/out", "/proc/deep/er/out"] {
        let run = lcm_in(Path::new("/"), &["export", "--as", "mitsuba", "-o", place], b"");
        refused(&run, 4, &format!("{place} could not be written: "));
        assert!(!run.err.contains("os error") && !run.err.contains(".lcm-"), "{}", run.err);
    }
    // The folders created for it are removed.
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("deep/er/out");
    let bad = Export { files: vec![File::new("a", "a"), File::new("../b", "b")], notes: Vec::new() };
    let said = write(&bad, &place, &Before::of(&place)).expect_err("it leads out").to_string();
    assert!(said.contains("../b leads out of the folder"), "{said}");
    assert_eq!(below(folder.path()), Vec::<String>::new());
}

#[test]
fn a_form_that_makes_one_file_replaces_one_file() {
    const ONE: Form = Form {
        id: "one",
        name: "One",
        summary: "a file",
        makes: Makes::File("txt"),
        of_object: false,
        of_view: true,
        make: |_, _| Ok(Export::file("new")),
    };
    let folder = tempfile::tempdir().expect("a folder");
    let place = folder.path().join("file.txt");
    for (text, overwrite) in [("text one", false), ("text two", true)] {
        may_write(&ONE, &place, overwrite, &[]).expect("free, or asked for");
        write(&Export::file(text), &place, &Before::of(&place)).expect("written");
        assert_eq!(fs::read_to_string(&place).expect("there"), text);
    }
    assert!(may_write(&ONE, &place, false, &[]).is_err());
    assert!(may_write(&ONE, &place, true, std::slice::from_ref(&place)).is_err(), "it is an input");
    assert_eq!(names(folder.path()), ["file.txt"]);
}

/// Whenever the program is interrupted, the export is complete or absent, and the next one tidies up.
#[test]
#[cfg(unix)]
fn an_interrupted_export_leaves_no_half_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    // Objects of many shapes take a while.
    let objects: Vec<_> = (0..400)
        .map(|i| {
            let mut object = Object { object_type: "torus".to_owned(), ..Object::default() };
            object.position = glam::Vec3::new(1.0 + (i % 20) as f32 * 0.4, 1.0 + (i / 20) as f32 * 0.4, 5.0);
            object
                .shape
                .set("tube_radius", lights_camera_models::parameter::Value::Number(0.1 + i as f32 * 1e-4));
            object
        })
        .collect();
    let count = objects.len();
    write_scene(&folder.path().join("many.json"), &Scene { objects, ..Scene::default() });
    let whole = || {
        let meshes = out.join("meshes");
        !out.exists() || out.join("scene.xml").exists() && names(&meshes).len() == count
    };
    let start = || {
        command_in(folder.path(), ["export", "many.json", "--as", "mitsuba", "-o", "out", "--quiet"])
            .spawn()
            .expect("it starts")
    };
    let mut interrupted = 0;
    for pause in (0..24).map(|i| Duration::from_millis(20 * i)) {
        let _ = fs::remove_dir_all(&out);
        let mut child = start();
        thread::sleep(pause);
        let ran = child.try_wait().expect("it runs").is_none();
        // As Ctrl+C does.
        let _ = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
        let status = child.wait().expect("it ends");
        interrupted += u32::from(ran && !status.success());
        assert!(whole(), "after {pause:?}: {:?}", below(folder.path()).len());
        if status.success() {
            break;
        }
    }
    assert!(interrupted > 0);
    let _ = fs::remove_dir_all(&out);
    assert!(start().wait().expect("it ends").success() && whole() && out.exists());
    assert_eq!(names(folder.path()), ["many.json", "out"], "the litter of the others is gone");
}

#[test]
fn nothing_of_somebody_else_is_replaced_even_when_asked() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    let run = |form: &str, place: &str| {
        lcm_in(folder.path(), &["export", "--as", form, "-o", place, "--overwrite"], &[])
    };
    assert_eq!(run("bevy", "project").status, Some(0));
    // An export of another scene, and files made by cargo, are replaced.
    fs::create_dir(at("project/target")).expect("writable");
    for file in ["target/x", "Cargo.lock", "assets/shaders/old_phong.wgsl"] {
        fs::write(at("project").join(file), "x").expect("writable");
    }
    assert_eq!(run("bevy", "project").status, Some(0));
    assert!(!at("project/assets/shaders/old_phong.wgsl").exists());
    for stranger in ["NOTES.txt", "src/lib.rs2", "assets/meshes/mine.txt"] {
        fs::write(at("project").join(stranger), "mine").expect("writable");
        let refused = run("bevy", "project");
        assert_eq!(refused.status, Some(4), "{stranger}");
        let said = format!(
            "project has {stranger}, which is not part of an export of this form; it was not overwritten"
        );
        assert!(refused.err.contains(&said), "{}", refused.err);
        fs::remove_file(at("project").join(stranger)).expect("it is still there");
    }
    fs::create_dir(at("project/.git")).expect("writable");
    assert!(run("bevy", "project").err.contains("project has .git, which"), "an empty folder is one too");
    // Files of another kind are kept; those of the same kind are replaced.
    fs::write(at("thesis.tex"), "\\documentclass{book}").expect("writable");
    let refused = run("html", "thesis.tex");
    assert_eq!(refused.status, Some(4));
    assert!(
        refused.err.contains("thesis.tex is a file of a different kind from the export"),
        "{}",
        refused.err
    );
    assert_eq!(fs::read_to_string(at("thesis.tex")).expect("there"), "\\documentclass{book}");
    assert_eq!((run("html", "page.html").status, run("html", "page.html").status), (Some(0), Some(0)));
}

#[test]
fn a_scene_whose_objects_are_hidden_is_refused_as_a_project() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scene = crate::helpers::support::full_scene();
    for object in scene["objects"].as_array_mut().expect("a list") {
        object["visible"] = false.into();
    }
    fs::write(folder.path().join("hidden.json"), scene.to_string()).expect("writable");
    let run = lcm_in(folder.path(), &["export", "hidden.json", "--as", "bevy", "-o", "out"], &[]);
    assert_eq!(run.status, Some(1));
    assert!(run.err.contains("every object is hidden; make one visible"), "{}", run.err);
    assert!(!folder.path().join("out").exists());
}

#[test]
fn a_large_picture_of_an_environment_is_reduced_where_a_uniform_holds_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut picture = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 128 +X 256\n".to_vec();
    picture.extend([128, 128, 128, 129].repeat(256 * 128));
    fs::write(folder.path().join("sky.hdr"), picture).expect("written");
    let mut scene: serde_json::Value =
        serde_json::from_str(&save::to_json(&Scene::default(), None, &Registry::builtin())).expect("JSON");
    scene["lights"] = serde_json::json!([
        { "type": "environment", "source": "file", "path": "sky.hdr" },
        { "type": "disc", "position": [5, 9, 9], "direction": [0, -1, -1] }
    ]);
    fs::write(folder.path().join("room.json"), scene.to_string()).expect("written");
    let reduced = "sky.hdr, is reduced from 256×128 to 90×45 pixels: reflections are less sharp";
    for form in ["bevy", "html", "wgsl", "glsl", "mitsuba"] {
        let run = export(folder.path(), &["room.json", "--as", form, "-o", form]);
        assert_eq!(
            (run.status, run.err.contains(reduced)),
            (Some(0), form != "mitsuba"),
            "{form}: {}",
            run.err
        );
    }
    let main = fs::read_to_string(folder.path().join("bevy/src/main.rs")).expect("readable");
    for said in [
        "// Disc light: L(p, l) = L, L in cd/m².",
        "// Environment light: L(p, l) = I L_s(l), I is a factor.",
    ] {
        assert!(main.contains(said), "{said}");
    }
}

#[test]
fn an_export_of_a_scene_with_views_says_which_one_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scene: serde_json::Value =
        serde_json::from_str(&save::to_json(&Scene::default(), None, &Registry::builtin())).expect("JSON");
    scene["name"] = "Room".into();
    scene["variants"] = serde_json::json!([{ "name": "Half", "exposure": 1.0, "shading_model": "flat" }]);
    fs::write(folder.path().join("room.json"), scene.to_string()).expect("written");
    let all = [("mitsuba", "scene.xml"), ("bevy", "src/main.rs"), ("wgsl", "manifest.json"), ("html", "")];
    // A page contains all views unless one is requested.
    let run = export(folder.path(), &["room.json", "--as", "html", "-o", "all.html"]);
    assert_eq!((run.status, run.err.contains("--view")), (Some(0), false), "{}", run.err);
    for (form, file) in all {
        for (view, one, other) in [
            ("A", "view A", "view B (Half)"),
            ("b", "view B (Half)", "view A"),
            ("Half", "view B (Half)", "view A"),
        ] {
            let mut arguments = vec!["room.json", "--as", form, "-o", "out", "--overwrite"];
            if view != "A" || form == "html" {
                arguments.extend(["--view", view]);
            }
            let run = export(folder.path(), &arguments);
            assert_eq!(run.status, Some(0), "{form} {view}: {}", run.err);
            let back = if view == "A" { "B" } else { "A" };
            let said =
                format!("This is {one} of a scene that compares it with {other}; lcm export --view {back}");
            assert!(run.err.contains(&said), "{form}: {}", run.err);
            let text = fs::read_to_string(folder.path().join("out").join(file).components().as_path())
                .expect("readable");
            let plain = text.split_whitespace().filter(|w| *w != "//!").collect::<Vec<_>>().join(" ");
            assert!(plain.contains(&format!("Room, {one}")), "{form} {view}");
            let how = if form == "mitsuba" { "- -view" } else { "--view" };
            assert!(plain.contains(&format!("{how} {back}")), "{form} {view}: how to get the other");
        }
        let _ = fs::remove_dir_all(folder.path().join("out"));
        let _ = fs::remove_file(folder.path().join("out"));
    }
    refused(
        &export(folder.path(), &["room.json", "--as", "html", "--view", "Hal"]),
        1,
        "there is no view \"Hal\"; it must be A or B (Half)",
    );
}

#[test]
fn a_name_that_is_too_long_is_refused_for_its_length() {
    let folder = tempfile::tempdir().expect("a folder");
    let name = format!("{}.html", "n".repeat(251));
    let run = export(folder.path(), &["--as", "html", "-o", &name]);
    refused(&run, 4, "its name has 256 bytes, but at most 255 are allowed");
    assert!(!run.err.contains("mesh"), "{}", run.err);
    let run = export(folder.path(), &["--as", "html", "-o", &name[1..]]);
    assert_eq!(run.status, Some(0), "{}", run.err);
}

#[test]
fn names_with_characters_that_xml_forbids_make_well_formed_xml() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scene = Scene::default();
    let hostile: String = (0..0x20u8).map(char::from).chain("\u{fffe}\u{ffff}--->".chars()).collect();
    scene.name = Some(format!("a{hostile}b"));
    write_scene(&folder.path().join("room.json"), &scene);
    let run = export(folder.path(), &["room.json", "--as", "mitsuba", "-o", "out"]);
    assert_eq!(run.status, Some(0), "{}", run.err);
    let text = fs::read_to_string(folder.path().join("out/scene.xml")).expect("readable");
    let bad = |c: char| c < ' ' && c != '\n' && c != '\t' || matches!(c, '\u{fffe}' | '\u{ffff}');
    assert!(!text.contains(bad), "{text}");
    assert!(text.contains("\\u{fffe}\\u{ffff}- - ->b"), "{text}");
}
