//! Photometric lamps: files named in scenes, from disk to both renderers.

use std::{fs, path::Path};

use glam::Vec3;
use lights_camera_models::{
    document::{Document, Edit, Selection},
    optics::{
        TermSelection,
        colour::{BACKGROUND, Encoding},
    },
    panel::state::{Action, Session},
    parameter::{FileFormat, NamedFile, Value},
    reference,
    registry::Registry,
    render::capture::gpu::{GpuRenderer, Output},
    scene::{
        Part, Scene, check,
        load::{self, Defaults},
        save,
    },
};

use crate::{
    helpers::pictures::{close_up, compare, on_gpu},
    helpers::support::lcm_in,
};

/// A file with these candelas downwards, sideways and upwards.
fn ies(candelas: &str) -> String {
    format!("IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 3 1 1 2 0 0 0\n1 1 10\n0 90 180\n0\n{candelas}\n")
}

/// A scene with a photometric lamp, as the text of a scene file.
fn scene(file: &str) -> String {
    let mut scene = close_up("sphere", "photometric");
    scene.shading_model = "phong".to_owned();
    let text = save::to_json(&scene, None, &Registry::builtin());
    text.replace("\"type\": \"photometric\",", &format!("\"type\": \"photometric\", \"file\": \"{file}\","))
}

/// Writes a scene and its lamp into a folder, and reads the scene.
fn read(folder: &Path, file: &str, content: &str) -> Result<Scene, String> {
    let path = folder.join("room.json");
    fs::write(folder.join("lamp.ies"), content).expect("written");
    fs::write(&path, scene(file)).expect("written");
    let loaded = load::file(&path, &Registry::builtin(), Defaults::Refuse);
    loaded.map(|loaded| loaded.scene).map_err(|error| error.to_string())
}

fn file_of(scene: &Scene) -> &NamedFile {
    match scene.lights[0].parameters.0.get("file") {
        Some(Value::File(file)) => file,
        other => panic!("{other:?}"),
    }
}

fn cpu(scene: &Scene) -> reference::Picture {
    let settings = reference::Settings { width: 96, height: 96, samples: 1, terms: TermSelection::All };
    reference::render(scene, &Registry::builtin(), &settings)
}

#[test]
fn both_renderers_shine_as_the_file_says_and_follow_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut scene = read(folder.path(), "lamp.ies", &ies("900 100 300")).expect("legal");
    scene.lights[0].intensity = 0.5;
    let mut renderer = GpuRenderer::new(96, 96, 1, Output::Linear).expect("software Vulkan is installed");
    let alike = |gpu: &[Vec3], scene: &Scene| {
        let d = compare(gpu, &cpu(scene), Encoding::Srgb.decode(BACKGROUND), 1e-3);
        d.covered > 500 && d.wrong * 1000 <= d.covered && d.edges * 50 <= d.covered
    };
    let before = on_gpu(&mut renderer, &scene);
    assert!(alike(&before, &scene));
    // Several lamps share the numbers of one file, and others use another, which does not fit into the first
    // buffer.
    let mut many = scene.clone();
    let fine: Vec<_> =
        (0..=180).map(|i| (300.0 + 200.0 * f64::from(i).to_radians().cos()).to_string()).collect();
    let angles: Vec<_> = (0..=180).map(|i| i.to_string()).collect();
    let planes: Vec<_> = (0..=18).map(|i| (20 * i).to_string()).collect();
    let text = format!(
        "TILT=NONE\n1 -1 1 181 19 1 2 0 0 0 1 1 10\n{}\n{}\n{}",
        angles.join(" "),
        planes.join(" "),
        vec![fine.join(" "); 19].join("\n")
    );
    fs::write(folder.path().join("fine.ies"), text).expect("written");
    for i in 0..4_u8 {
        let mut lamp = many.lights[0].clone();
        lamp.position = Some(Vec3::new(4.0 + f32::from(i), 7.0, 8.0));
        lamp.colour = [255, 60 * i, 0];
        if i % 2 == 0 {
            let format = registry_file().expect("a file");
            lamp.parameters.set("file", Value::File(NamedFile::named("fine.ies", folder.path(), format)));
        }
        many.lights.push(lamp);
    }
    assert_eq!(check::scene(&many, &Registry::builtin()), []);
    assert!(alike(&on_gpu(&mut renderer, &many), &many));
    // The file changes: reading it again detects the change, and so do all that name it.
    fs::write(folder.path().join("lamp.ies"), ies("100 900 300")).expect("written");
    assert!(file_of(&scene).read_again() && !file_of(&many).read_again());
    // The wrong twin is the picture of the old file.
    assert!(!alike(&before, &scene), "the new file goes unnoticed");
    assert!(alike(&on_gpu(&mut renderer, &scene), &scene));
}

/// The format of the lamp's file parameter.
fn registry_file() -> Option<&'static FileFormat> {
    Registry::builtin().light("photometric")?.parameter("file")?.kind.format()
}

#[test]
fn an_empty_name_and_a_number_for_a_numbered_choice_are_told() {
    let registry = Registry::builtin();
    for (source, field, value, expected) in [
        ("file", "path", serde_json::json!(""), "picture: the name is empty"),
        ("sky", "sky_type", serde_json::json!(5), "must be one of \"1\" to \"15\", in quotes"),
        ("sky", "sky_type", serde_json::json!(16), "must be one of \"1\" to \"15\""),
    ] {
        let mut scene: serde_json::Value =
            serde_json::from_str(include_str!("../../../scenes/default.json")).expect("JSON");
        scene["lights"] = serde_json::json!([{ "type": "environment", "source": source, field: value }]);
        let error = load::from_text(&scene.to_string(), "a.json", &registry, Defaults::Refuse)
            .map(|_| ())
            .expect_err("it cannot be used");
        let error = error.to_string();
        assert!(error.contains(expected), "{error}");
        assert_eq!(error.contains("in quotes"), expected.contains("in quotes"), "{error}");
    }
}

#[test]
fn files_that_cannot_be_used_are_told_with_line_and_mistake() {
    let folder = tempfile::tempdir().expect("a folder");
    let lamp = folder.path().join("lamp.ies").display().to_string();
    for (content, expected) in [
        ("a letter", format!("{lamp}: this is not an IES LM-63 file: no line begins with TILT=")),
        (&*ies("900 100"), format!("{lamp}:7: the file ends before candela value 3 of 3")),
        (&*ies("900 100 3 4"), format!("{lamp}:7: the 3 candela values are followed by")),
        (&*ies("900 bright 3"), format!("{lamp}:7: candela value 2 of 3")),
    ] {
        let error = read(folder.path(), "lamp.ies", content).expect_err("it cannot be used");
        let about = "lights[0].file is \"lamp.ies\", but the photometric file must be the name of an IES photometric file that can be used: ";
        assert!(error.contains(about) && error.contains(&expected), "{error}\n{expected}");
    }
    let error = read(folder.path(), "lamb.ies", &ies("1 1 1")).expect_err("there is none");
    assert!(error.contains("lamb.ies: ") && error.contains("room.json:"), "{error}");
    let huge = ies("1 1 1") + &" ".repeat(5 << 20);
    let error = read(folder.path(), "lamp.ies", &huge).expect_err("too large");
    assert!(error.contains("lamp.ies: "), "{error}");
    let run = lcm_in(folder.path(), &["check", "room.json"], b"");
    assert!(run.status != Some(0) && run.err.contains("room.json:"), "{}", run.err);
}

#[test]
fn the_name_of_a_file_is_kept_as_written_and_a_shipped_one_is_found_everywhere() {
    let registry = Registry::builtin();
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("lamps")).expect("made");
    fs::write(folder.path().join("lamps/a.ies"), ies("5 5 5")).expect("written");
    let scene = read(folder.path(), "./lamps/../lamps/a.ies", &ies("1 1 1")).expect("legal");
    let text = save::to_json(&scene, None, &registry);
    assert!(text.contains("\"file\": \"./lamps/../lamps/a.ies\""), "{text}");
    assert_eq!(file_of(&scene).numbers().as_deref().and_then(|n| n.last().copied()), Some(5.0));
    // Without a file of that name, it is the shipped one; a file of that name takes precedence.
    let shipped = read(folder.path(), "wall_washer.ies", &ies("1 1 1")).expect("legal");
    assert_eq!(file_of(&shipped).path(), None);
    fs::write(folder.path().join("wall_washer.ies"), ies("7 7 7")).expect("written");
    let own = read(folder.path(), "wall_washer.ies", &ies("1 1 1")).expect("legal");
    assert_eq!(file_of(&own).numbers().as_deref().and_then(|n| n.last().copied()), Some(7.0));
}

#[test]
fn a_scene_that_is_saved_elsewhere_still_finds_its_file() {
    let registry = Registry::builtin();
    let (folder, other) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    let scene = read(folder.path(), "lamp.ies", &ies("5 5 5")).expect("legal");
    let mut session = Session::new(scene);
    session.path = Some(folder.path().join("room.json"));
    let save = |session: &mut Session, to: &Path| {
        session.apply(Action::SaveAs(to.to_owned()), &registry);
        fs::write(to, save::to_json(&session.document, None, &registry)).expect("written");
        load::file(to, &registry, Defaults::Refuse.allowing(&session.outside))
            .map(|loaded| file_of(&loaded.scene).clone())
            .expect("legal")
    };
    let beside = save(&mut session, &folder.path().join("again.json"));
    assert_eq!(beside.name(), "lamp.ies", "its name is kept as written");
    let far = save(&mut session, &other.path().join("room.json"));
    assert_eq!((far.path(), far.numbers()), (beside.path(), beside.numbers()));
}

#[test]
fn an_edit_with_a_file_that_cannot_be_used_is_refused_and_a_good_one_is_taken() {
    let registry = Registry::builtin();
    let folder = tempfile::tempdir().expect("a folder");
    let scene = read(folder.path(), "lamp.ies", &ies("1 1 1")).expect("legal");
    let mut document = Document::new(scene);
    let format = registry_file().expect("a file");
    let mut set = |name: &str| {
        let file = Value::File(NamedFile::named(name, folder.path(), format));
        document.edit(Edit::parameter(Part::Light(0), "file", file), Selection::Light(0), &registry)
    };
    fs::write(folder.path().join("bad.ies"), "TILT=NONE\n1 1").expect("written");
    let refused = set("bad.ies").expect_err("it is no lamp");
    assert!(refused.contains("bad.ies:2: the file ends before the multiplier"), "{refused}");
    fs::write(folder.path().join("good.ies"), ies("2 2 2")).expect("written");
    set("good.ies").expect("it is a lamp");
    assert_eq!(file_of(&document).name(), "good.ies");
}
