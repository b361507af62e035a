//! Objects from files: models named in scenes, from disk to both renderers.

use std::{
    fs,
    path::Path,
    thread,
    time::{Duration, Instant},
};

use glam::Vec3;
use lights_camera_models::{
    document::{Document, Edit, Selection},
    optics::{
        TermSelection,
        colour::{BACKGROUND, Encoding},
    },
    panel::state::{Action, Effect, Session},
    parameter::{FileFormat, NamedFile, Parameter, Value},
    reference,
    registry::Registry,
    render::capture::gpu::{GpuRenderer, Output},
    scene::{
        Part, Scene, check,
        load::{self, Defaults},
        save,
    },
    shape::{PolygonMesh, mesh_file},
    window::authoring::write,
};

use crate::{
    helpers::pictures::{close_up, compare, on_gpu},
    helpers::support::{check_wording, lcm_in, root},
    window::panels::Bench,
};

/// A roof: two slopes over a square of 2 m, and a ridge of this height.
fn roof(height: f32) -> String {
    format!(
        "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv -1 {height} 0\nv 1 {height} 0\n\
         f 4 3 6 5\nf 2 1 5 6\nf 1 4 5\nf 3 2 6\nf 1 2 3 4\n"
    )
}

/// The roof as a PLY file.
fn roof_ply(height: f32) -> String {
    format!(
        "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n\
         element face 5\nproperty list uchar int vertex_indices\nend_header\n\
         -1 0 -1\n1 0 -1\n1 0 1\n-1 0 1\n-1 {height} 0\n1 {height} 0\n\
         4 3 2 5 4\n4 1 0 4 5\n3 0 3 4\n3 2 1 5\n4 0 1 2 3\n"
    )
}

/// The roof as a glTF binary file, in which all polygons are triangles with three separate vertices.
fn roof_glb(height: f32) -> Vec<u8> {
    let v = [
        [-1.0, 0.0, -1.0],
        [1.0, 0.0, -1.0],
        [1.0, 0.0, 1.0],
        [-1.0, 0.0, 1.0],
        [-1.0, height, 0.0],
        [1.0, height, 0.0],
    ];
    let faces: [&[usize]; 5] = [&[3, 2, 5, 4], &[1, 0, 4, 5], &[0, 3, 4], &[2, 1, 5], &[0, 1, 2, 3]];
    let triangles = faces.iter().flat_map(|f| (2..f.len()).map(|i| [f[0], f[i - 1], f[i]]));
    let corners: Vec<[f32; 3]> = triangles.flatten().map(|i| v[i]).collect();
    let data: Vec<u8> = corners.iter().flatten().flat_map(|c| c.to_le_bytes()).collect();
    let mut json = serde_json::json!({
        "asset": { "version": "2.0" },
        "scenes": [{ "nodes": [0] }],
        "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
        "accessors": [{ "bufferView": 0, "componentType": 5126, "count": corners.len(), "type": "VEC3",
                        "min": [-1, 0, -1], "max": [1, height, 1] }],
        "bufferViews": [{ "buffer": 0, "byteLength": data.len() }],
        "buffers": [{ "byteLength": data.len() }],
    })
    .to_string();
    json.push_str(&" ".repeat(json.len().next_multiple_of(4) - json.len()));
    let word = |n: usize| (n as u32).to_le_bytes();
    let length = 28 + json.len() + data.len();
    [
        b"glTF",
        &word(2)[..],
        &word(length),
        &word(json.len()),
        b"JSON",
        json.as_bytes(),
        &word(data.len()),
        b"BIN\0",
        &data,
    ]
    .concat()
}

/// A scene with an object from a file, as the text of a scene file.
fn scene(file: &str, more: &str) -> String {
    let mut scene = close_up("mesh", "point");
    scene.shading_model = "phong".to_owned();
    let text = save::to_json(&scene, None, &Registry::builtin());
    let path = serde_json::Value::from(file);
    text.replace("\"type\": \"mesh\",", &format!("\"type\": \"mesh\", \"path\": {path},{more}"))
}

/// Writes a scene next to a model, and reads it.
fn read(folder: &Path, file: &str) -> Result<Scene, String> {
    let path = folder.join("room.json");
    fs::write(&path, scene(file, "")).expect("written");
    let loaded = load::file(&path, &Registry::builtin(), Defaults::Refuse);
    loaded.map(|loaded| loaded.scene).map_err(|error| error.to_string())
}

fn file_of(scene: &Scene) -> &NamedFile {
    match scene.objects[0].shape.0.get("path") {
        Some(Value::File(file)) => file,
        other => panic!("{other:?}"),
    }
}

/// The mesh of the first object, and its number of polygons.
fn mesh_of(scene: &Scene) -> PolygonMesh {
    Registry::builtin().shape("mesh").expect("built in").mesh(&scene.objects[0].shape, 1)
}

fn parameter() -> (&'static Parameter, &'static FileFormat) {
    let parameter = Registry::builtin().shape("mesh").and_then(|s| s.parameter("path")).expect("a file");
    (parameter, parameter.kind.format().expect("a file"))
}

#[test]
fn every_format_gives_the_mesh_of_the_same_coordinates() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("roof.obj"), roof(1.0)).expect("written");
    fs::write(at("roof.ply"), roof_ply(1.0)).expect("written");
    fs::write(at("roof.glb"), roof_glb(1.0)).expect("written");
    // Case and other extensions do not matter: the content decides.
    fs::write(at("roof.stl"), roof_glb(1.0)).expect("written");
    let s = 0.5f32;
    let expected =
        [[-s, -0.25, -s], [s, -0.25, -s], [s, -0.25, s], [-s, -0.25, s], [-s, 0.25, 0.0], [s, 0.25, 0.0]];
    let slope = Vec3::new(0.0, 1.0, 1.0).normalize();
    for (name, polygons) in [("roof.obj", 5), ("roof.ply", 5), ("roof.glb", 8), ("roof.stl", 8)] {
        let mesh = mesh_of(&read(folder.path(), name).expect("legal"));
        assert_eq!((mesh.positions.len(), mesh.polygons.len()), (6, polygons), "{name}");
        let vertex =
            |p: &[f32; 3]| mesh.positions.iter().position(|q| (*q - Vec3::from_array(*p)).length() < 1e-6);
        let places: Vec<_> =
            expected.iter().map(|p| vertex(p).unwrap_or_else(|| panic!("{name}: {p:?}"))).collect();
        // The end of the ridge has the mean of both slopes and of a gable, each polygon counted once (CA
        // DD9): two triangles of the rear slope meet there.
        let back = Vec3::new(0.0, 1.0, -1.0).normalize();
        let behind = if polygons == 5 { 1.0 } else { 2.0 };
        let mean = (slope + behind * back + Vec3::NEG_X).normalize();
        let got = mesh.vertex_normals()[places[4]];
        assert!((got - mean).length() < 1e-5, "{name}: {got} {mean}");
        // The wrong twin: separate vertices have the normals of their polygons.
        assert!((got - slope).length() > 0.1);
        assert!(lights_camera_models::registry::check::mesh::check(&mesh).is_ok(), "{name}");
    }
}

#[test]
fn both_renderers_show_the_file_with_every_shading_model_and_follow_it() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("roof.obj");
    fs::write(&path, roof(2.0)).expect("written");
    let mut scene = read(folder.path(), "roof.obj").expect("legal");
    let mut renderer = GpuRenderer::new(96, 96, 1, Output::Linear).expect("software Vulkan is installed");
    let mut gpu = |scene: &Scene| on_gpu(&mut renderer, scene);
    let cpu = |scene: &Scene| {
        let settings = reference::Settings { width: 96, height: 96, samples: 1, terms: TermSelection::All };
        reference::render(scene, &Registry::builtin(), &settings)
    };
    let alike = |gpu: &[Vec3], scene: &Scene| {
        let d = compare(gpu, &cpu(scene), Encoding::Srgb.decode(BACKGROUND), 2e-3);
        d.covered > 500 && d.wrong * 500 <= d.covered && d.edges * 20 <= d.covered
    };
    let mut pictures = Vec::new();
    for shading in ["flat", "gouraud", "phong", "derivative"] {
        scene.shading_model = shading.to_owned();
        for normals in ["computed", "file"] {
            scene.objects[0].shape.set("normals", Value::Choice(normals.into()));
            // The shipped model has explicit normals; that of the roof has none.
            for model in ["roof.obj", "knot.glb"] {
                let file = NamedFile::named(model, folder.path(), parameter().1);
                scene.objects[0].shape.set("path", Value::File(file));
                assert_eq!(check::scene(&scene, &Registry::builtin()), []);
                let picture = gpu(&scene);
                assert!(alike(&picture, &scene), "{shading}, {normals} normals, {model}");
                pictures.push(((shading, normals, model), picture));
            }
        }
    }
    let of = |wanted| &pictures.iter().find(|(what, _)| *what == wanted).expect("drawn").1;
    for (shading, matters) in [("flat", false), ("gouraud", true), ("phong", true), ("derivative", false)] {
        let [computed, own] = ["computed", "file"].map(|normals| of((shading, normals, "knot.glb")));
        assert_eq!(computed != own, matters, "{shading}: normals of vertices");
        assert_eq!(of((shading, "computed", "roof.obj")), of((shading, "file", "roof.obj")), "{shading}");
    }
    // The file changes: reading it again detects the change, and so do all that name it.
    scene = read(folder.path(), "roof.obj").expect("legal");
    let before = gpu(&scene);
    fs::write(&path, roof(0.5)).expect("written");
    assert!(file_of(&scene).read_again());
    assert!(!alike(&before, &scene), "the new file goes unnoticed");
    assert!(alike(&gpu(&scene), &scene));
    // When broken, it is shown as before.
    fs::write(&path, "v 0 0\n").expect("written");
    assert!(file_of(&scene).read_again() && file_of(&scene).problem().is_some());
    assert!(alike(&gpu(&scene), &scene));
}

#[test]
fn files_that_cannot_be_used_are_told_with_place_and_mistake() {
    let folder = tempfile::tempdir().expect("a folder");
    let model = folder.path().join("model.obj").display().to_string();
    let about = "objects[0].path is \"model.obj\", but the model file must be the name of a glTF binary, OBJ or PLY file that can be used: ";
    for (content, expected) in [
        ("", ": the file is empty"),
        (
            "v 0 0 0\nv 1 0 0\nv 0 1 0\n\nf 1/1 2/1 3/1\n",
            ":5: this face (f) names the texture coordinate 1, but the file has no",
        ),
        ("v 0 0 0\nv 1 0 0\nf 1 2 3\n", ":3: this face (f) names the vertex 3, but there are 2 vertices (v)"),
        ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", ": it has no polygons with an area"),
        ("glTF\u{2}", ": the file ends before the glTF does"),
        ("ply\nformat ascii 1.0\nend_header\n", ": its header has no element vertex"),
        (
            "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
            ":4: a corner of polygon 1 is at (NaN, 0, 0), but positions must be finite",
        ),
    ] {
        fs::write(folder.path().join("model.obj"), content).expect("written");
        let error = read(folder.path(), "model.obj").expect_err("it cannot be used");
        let expected = format!("{about}{model}{expected}");
        assert!(error.contains(&expected), "{error}\n{expected}");
        let place = error.split(": objects").next().expect("the beginning");
        let numbers: Vec<_> = place.rsplit(':').take(2).map(str::parse::<u32>).collect();
        assert!(numbers.iter().all(Result::is_ok), "{error}");
        check_wording(&error);
    }
    fs::write(folder.path().join("model.obj"), "v 0 0 0\nv one\n").expect("written");
    let error = read(folder.path(), "model.obj").expect_err("it cannot be used");
    assert!(error.contains(&format!("{model}:2: a vertex (v) must be three numbers")), "{error}");
    fs::create_dir(folder.path().join("folder.obj")).expect("made");
    fs::write(folder.path().join("nothing.glb"), "").expect("written");
    fs::File::create(folder.path().join("huge.obj")).and_then(|f| f.set_len(33 << 20)).expect("made");
    for (name, expected) in [
        ("missing.obj", "missing.obj: there is no such file"),
        ("folder.obj", "folder.obj: it is a folder, but it must be a file"),
        ("huge.obj", "huge.obj: it is larger than 32 MiB: it has 34603008 bytes"),
        ("nothing.glb", "nothing.glb: the file is empty"),
        ("", "the name is empty"),
        ("a\0b", "a\u{fffd}b"),
    ] {
        let error = read(folder.path(), name).expect_err("it cannot be used");
        assert!(error.contains(expected) || name.contains('\0'), "{error}");
    }
    // In the program, as for all other problems.
    fs::write(folder.path().join("room.json"), scene("missing.obj", "")).expect("written");
    let run = lcm_in(folder.path(), &["check", "room.json"], b"");
    assert_eq!(run.status, Some(1));
    assert!(
        run.err.starts_with("room.json:") && run.err.contains("missing.obj: there is no such file"),
        "{}",
        run.err
    );
    let run = lcm_in(folder.path(), &["check", "room.json", "--json"], b"");
    assert!(run.out.contains("\"path\": \"objects[0].path\""), "{}", run.out);
    let run = lcm_in(folder.path(), &["check", "room.json"], b"");
    assert_eq!(run.status, Some(1), "{}", run.err);
    fs::write(folder.path().join("room.json"), scene("knot.glb", " \"normals\": \"own\",")).expect("written");
    let run = lcm_in(folder.path(), &["check", "room.json"], b"");
    assert!(run.err.contains("the vertex normals must be one of \"computed\", \"file\""), "{}", run.err);
}

#[cfg(unix)]
#[test]
fn a_scene_reads_nothing_outside_its_folder_unless_that_is_allowed() {
    use std::os::unix::fs::symlink;
    let outer = tempfile::tempdir().expect("a folder");
    let folder = outer.path().join("scene");
    fs::create_dir_all(folder.join("below")).expect("made");
    let secret = outer.path().join("secret.obj");
    fs::write(&secret, roof(1.0)).expect("written");
    fs::write(folder.join("below/roof.obj"), roof(1.0)).expect("written");
    symlink("../secret.obj", folder.join("link.obj")).expect("made");
    symlink("..", folder.join("up")).expect("made");
    symlink("below/roof.obj", folder.join("here.obj")).expect("made");
    let run = |name: &str, more: &[&str]| {
        fs::write(folder.join("room.json"), scene(name, "")).expect("written");
        lcm_in(&folder, &[&["check", "room.json"], more].concat(), b"")
    };
    for name in ["below/roof.obj", "./below/../below/roof.obj", "here.obj", "../scene/below/roof.obj"] {
        let run = run(name, &[]);
        assert_eq!(run.status, Some(0), "{name}: {}", run.err);
    }
    let absolute = secret.display().to_string();
    let said = "it is outside the folder";
    for name in [
        "../secret.obj",
        "below/../../secret.obj",
        &absolute,
        "link.obj",
        "up/secret.obj",
        "/etc/passwd",
        "../none.obj",
    ] {
        let refused = run(name, &[]);
        assert_eq!(refused.status, Some(1), "{name}");
        assert!(refused.err.contains(said) && refused.err.contains("--allow-outside"), "{}", refused.err);
        assert!(
            refused.err.starts_with("room.json:") && refused.err.contains("objects[0].path is"),
            "{}",
            refused.err
        );
        // The name itself may have two dots.
        check_wording(&refused.err.replace("..", "up"));
    }
    for name in ["../secret.obj", &absolute, "link.obj", "up/secret.obj"] {
        assert_eq!(run(name, &["--allow-outside"]).status, Some(0), "{name}");
    }
    assert!(!run("/etc/passwd", &["--allow-outside"]).err.contains("root"));
    // Lamps and tables too, and scenes from a pipe, whose folder is the working folder.
    let lamp = scene("knot.glb", "")
        .replace("\"type\": \"point\"", "\"type\": \"photometric\", \"file\": \"../a.ies\"");
    fs::write(
        folder.join("room.json"),
        lamp.replace("\"intensity\"", "\"direction\": [0, -1, 0], \"intensity\""),
    )
    .expect("written");
    let run = lcm_in(&folder, &["check", "room.json"], b"");
    assert!(run.err.contains("lights[0].file is \"../a.ies\"") && run.err.contains(said), "{}", run.err);
    let run = lcm_in(&folder, &["check", "-"], scene("../secret.obj", "").as_bytes());
    assert!(run.status == Some(1) && run.err.contains(said), "{}", run.err);
    let table = "part,type,position,direction,path,reflection_model,shading_model,scene_size.height,scene_size.width,scene_size.depth\n\
                 scene,,,,,lambert,phong,10,10,10\nlight,point,7.5 8 9,,,,,,,\nobserver,,5 5 9.5,0 0 -1,,,,,,\n\
                 object,mesh,5 5 5,,FILE,,,,,\n";
    for (name, status) in [("below/roof.obj", 0), ("../secret.obj", 1)] {
        fs::write(folder.join("room.csv"), table.replace("FILE", name)).expect("written");
        let run = lcm_in(&folder, &["check", "room.csv"], b"");
        assert_eq!(run.status, Some(status), "{name}: {}", run.err);
        assert!(status == 0 || run.err.contains("room.csv:5:") && run.err.contains(said), "{}", run.err);
    }
    // A link that changes while it is followed leads nowhere.
    let scene = read(&folder, "here.obj").expect("legal");
    fs::remove_file(folder.join("here.obj")).expect("there");
    symlink("../secret.obj", folder.join("here.obj")).expect("made");
    assert!(file_of(&scene).read_again());
    assert!(
        file_of(&scene).problem().is_some_and(|problem| problem.contains(said)),
        "{:?}",
        file_of(&scene).problem()
    );
}

#[test]
fn hostile_files_are_refused_at_once_and_pipes_do_not_block() {
    let folder = tempfile::tempdir().expect("a folder");
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let begin = Instant::now();
    for (name, content, expected) in [
        ("many.obj", format!("{square}{}", "f 1 2 3\n".repeat(500_001)), Some("it has 500001 polygons")),
        ("round.obj", format!("{square}f {}\n", "1 2 3 4 ".repeat(33)), Some("polygon 1 has 132 corners")),
        ("wide.obj", format!("{square}f {}\n", "9".repeat(1 << 20)), Some("a file has at most 2000000 vertices")),
        ("same.obj", format!("{square}{}f 1 2 3\n", "f 1 1 1\n".repeat(100_000)), None),
        ("far.obj", "v -3e38 0 0\nv 3e38 0 0\nv 0 3e38 0\nf 1 2 3\n".to_owned(), None),
        ("near.obj", "v -1e-44 0 0\nv 1e-44 0 0\nv 0 1e-44 0\nf 1 2 3\n".to_owned(), None),
        ("thin.obj", "v 0 0 0\nv 1 0 0\nv 1 1e-30 0\nf 1 2 3\n".to_owned(), Some("no polygons with an area")),
        ("deep.glb", format!("glTF{}", "[".repeat(1 << 20)), Some("glTF")),
        ("claim.ply", "ply\nformat binary_little_endian 1.0\nelement vertex 18446744073709551615\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n".to_owned(), Some("vertices; at most 2000000")),
    ] {
        fs::write(folder.path().join(name), content).expect("written");
        match (read(folder.path(), name), expected) {
            (Ok(scene), None) => {
                let mesh = mesh_of(&scene);
                assert!(mesh.vertex_normals().iter().chain(&mesh.positions).all(|v| v.is_finite()), "{name}");
            }
            (Err(said), Some(expected)) => {
                assert!(said.contains(expected) && said.len() < 1000, "{name}: {said:.2000}");
            }
            (got, _) => panic!("{name}: {:?}", got.map(|_| "read")),
        }
    }
    #[cfg(target_os = "linux")]
    {
        let pipe = folder.path().join("pipe.obj");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo").success());
        let said = read(folder.path(), "pipe.obj").expect_err("no file");
        assert!(said.contains("it is a named pipe, but it must be a file"), "{said}");
    }
    assert!(begin.elapsed() < Duration::from_secs(120), "{:?}", begin.elapsed());
}

#[test]
fn thousands_of_triangles_in_one_place_take_no_longer_than_one() {
    let folder = tempfile::tempdir().expect("a folder");
    let drawn = |count: usize| {
        let text = format!("v -1 -1 0\nv 1 -1 0\nv 0 1 0\n{}", "f 1 2 3\n".repeat(count));
        fs::write(folder.path().join("flat.obj"), text).expect("written");
        let scene = read(folder.path(), "flat.obj").expect("legal");
        let settings = reference::Settings { width: 64, height: 48, ..Default::default() };
        let begin = Instant::now();
        (reference::render(&scene, &Registry::builtin(), &settings), begin.elapsed())
    };
    let (once, _) = drawn(1);
    let (often, time) = drawn(400_000);
    assert!(once.pixels.iter().any(|pixel| pixel.w > 0.0), "it is in sight");
    let differs = once.pixels.iter().zip(&often.pixels).map(|(a, b)| (*a - *b).abs().max_element());
    // The mean of many equal normals is rounded.
    assert!(differs.fold(0.0, f32::max) < 1e-5);
    assert!(time < Duration::from_secs(5), "{time:?}");
}

#[test]
fn files_that_are_large_together_are_refused_before_any_is_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut room: serde_json::Value = serde_json::from_str(&scene("large.obj", "")).expect("JSON");
    let object = room["objects"][0].clone();
    let objects = (0..25).map(|i| {
        let name = format!("large{i}.obj");
        let file = fs::File::create(folder.path().join(&name)).expect("created");
        file.set_len(32 << 20).expect("a hole takes no space");
        let mut object = object.clone();
        object["path"] = name.into();
        object
    });
    room["objects"] = objects.collect();
    let path = folder.path().join("room.json");
    fs::write(&path, room.to_string()).expect("written");
    let start = Instant::now();
    let said = load::file(&path, &Registry::builtin(), Defaults::Refuse).expect_err("too much").to_string();
    let name = path.display();
    assert_eq!(said, format!("{name}: the scene names files of 800 MiB in total; at most 768 MiB are read"));
    assert!(start.elapsed() < Duration::from_secs(5), "{:?}", start.elapsed());
}

#[test]
fn many_objects_read_their_file_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let n = 60;
    let mut text = String::new();
    for i in 0..n * n {
        text += &format!("v {} {} {}\n", i % n, i / n, (i * 7 % 5) as f32 * 0.1);
    }
    for i in 0..(n - 1) * (n - 1) {
        let a = i / (n - 1) * n + i % (n - 1) + 1;
        text += &format!("f {a} {} {} {}\n", a + 1, a + n + 1, a + n);
    }
    fs::write(folder.path().join("hills.obj"), text).expect("written");
    // A file that has just changed might change again without another modification time.
    thread::sleep(Duration::from_millis(200));
    let mut scene = read(folder.path(), "hills.obj").expect("legal");
    let once = Instant::now();
    let format = parameter().1;
    assert!(NamedFile::named("hills.obj", folder.path(), format).numbers().is_some());
    let once = once.elapsed();
    scene.objects = vec![scene.objects[0].clone(); 5000];
    fs::write(folder.path().join("room.json"), save::to_json(&scene, None, &Registry::builtin()))
        .expect("written");
    let all = Instant::now();
    let loaded =
        load::file(&folder.path().join("room.json"), &Registry::builtin(), Defaults::Refuse).expect("legal");
    assert_eq!(loaded.scene.objects.len(), 5000);
    assert!(all.elapsed() < Duration::from_secs(20), "{:?}, and once takes {once:?}", all.elapsed());
}

#[test]
fn the_name_of_a_file_is_kept_as_written_and_saving_elsewhere_keeps_the_file() {
    let registry = Registry::builtin();
    let (folder, other) = (tempfile::tempdir().expect("a folder"), tempfile::tempdir().expect("a folder"));
    fs::write(folder.path().join("roof.obj"), roof(1.0)).expect("written");
    let mut scene = read(folder.path(), "./roof.obj").expect("legal");
    scene.objects[0].shape.set("normals", Value::Choice("file".into()));
    let text = save::to_json(&scene, None, &registry);
    assert!(text.contains("\"path\": \"./roof.obj\"") && text.contains("\"normals\": \"file\""), "{text}");
    let csv = folder.path().join("room.csv");
    save::write(&csv, &scene, &registry, save::Expected::Anything).expect("written");
    let back = load::file(&csv, &registry, Defaults::Refuse).expect("legal");
    assert_eq!(back.scene, scene);
    let mut session = Session::new(scene);
    session.path = Some(folder.path().join("room.json"));
    let to = other.path().join("room.json");
    session.apply(Action::SaveAs(to.clone()), &registry);
    fs::write(&to, save::to_json(&session.document, None, &registry)).expect("written");
    session.saved(to.clone(), &registry);
    let said = session.messages.iter().map(|m| m.text.clone()).collect::<Vec<_>>().join("\n");
    assert!(said.contains("roof.obj, outside its folder") && said.contains("--allow-outside"), "{said}");
    // The window that wrote it still reads it; nobody else does unasked.
    let far = load::file(&to, &registry, Defaults::Refuse.allowing(&session.outside)).expect("legal").scene;
    assert_eq!(file_of(&far).path(), Some(&*folder.path().join("roof.obj")));
    let refused = load::file(&to, &registry, Defaults::Refuse).expect_err("nobody allowed it").to_string();
    assert!(refused.contains("it is outside the folder"), "{refused}");
    let run = lcm_in(other.path(), &["check", "room.json"], b"");
    assert!(run.status == Some(1) && run.err.contains("it is outside the folder"), "{}", run.err);
    assert_eq!(lcm_in(other.path(), &["check", "room.json", "--allow-outside"], b"").status, Some(0));
}

#[test]
fn an_edit_with_a_file_that_cannot_be_used_is_refused_and_a_good_one_is_taken() {
    let registry = Registry::builtin();
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("good.obj"), roof(1.0)).expect("written");
    fs::write(folder.path().join("bad.obj"), "v 1 2\n").expect("written");
    let mut document = Document::new(read(folder.path(), "knot.glb").expect("shipped"));
    let mut set = |name: &str| {
        let file = Value::File(NamedFile::named(name, folder.path(), parameter().1));
        document.edit(Edit::parameter(Part::Object(0), "path", file), Selection::Object(0), &registry)
    };
    let refused = set("bad.obj").expect_err("it is no model");
    assert!(refused.contains("bad.obj:1: a vertex (v) must be three numbers"), "{refused}");
    let refused = set("../elsewhere.obj").expect_err("nobody chose it");
    assert!(refused.contains("it is outside the folder"), "{refused}");
    set("good.obj").expect("it is one");
    assert_eq!(file_of(&document).name(), "good.obj");
}

#[test]
fn the_inspector_names_the_file_and_bounds_follow_it() {
    let registry = Registry::builtin();
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("roof.obj"), roof(2.0)).expect("written");
    let scene = read(folder.path(), "roof.obj").expect("legal");
    let shape = registry.shape("mesh").expect("built in");
    let bounds = || shape.bounds(&scene.objects[0].shape).half;
    assert!((bounds() - Vec3::splat(0.5)).length() < 1e-6);
    let key = shape.key(&scene.objects[0].shape, None);
    assert_eq!(key, shape.key(&read(folder.path(), "roof.obj").expect("legal").objects[0].shape, None));
    fs::write(folder.path().join("roof.obj"), roof(1.0)).expect("written");
    assert!(file_of(&scene).read_again());
    assert!((bounds() - Vec3::new(0.5, 0.25, 0.5)).length() < 1e-6, "{}", bounds());
    assert_ne!(key, shape.key(&scene.objects[0].shape, None));
    let mut session = Session::new(scene);
    session.selection = Selection::Object(0);
    let mut bench = Bench::new(session);
    bench.settle();
    assert!(bench.tree.iter().any(|s| s.label.contains("model file: roof.obj")), "the knob is there");
}

#[test]
fn the_shipped_models_are_small_free_and_credited() {
    let credits = fs::read_to_string(root().join("CREDITS.md")).expect("readable");
    let shipped: Vec<_> = mesh_file::FORMAT.shipped.iter().map(|(name, _)| *name).collect();
    assert_eq!(shipped, ["knot.glb", "gem.obj", "steps.obj", "lampshade.obj", "slab.obj"]);
    for name in shipped {
        let path = root().join("scenes").join(name);
        assert!(fs::metadata(path).expect("shipped").len() <= 100_000, "{name}");
        assert!(credits.contains(&format!("`scenes/{name}`")), "{name}");
    }
    assert!(credits.contains("scripts/knot") && credits.contains("scripts/solids"));
}

#[cfg(target_os = "linux")]
#[test]
fn an_open_window_follows_the_file_and_keeps_the_last_good_one() {
    use crate::helpers::screen::{Picture, Screen};
    let folder = tempfile::tempdir().expect("a folder");
    let (file, model) = (folder.path().join("room.json"), folder.path().join("roof.obj"));
    fs::write(&model, roof(2.0)).expect("written");
    let text =
        scene("roof.obj", "").replace("\"base_colour\": [220, 120, 60]", "\"base_colour\": [255, 0, 0]");
    fs::write(&file, text).expect("written");
    let screen = Screen::new(1280, 720);
    let mut window = screen.start(&["view", &file.to_string_lossy(), "--size", "1280x720"]);
    let red = |picture: &Picture| picture.count(220..920, 80..560, |p| p[0] > 40 && p[1] < 30 && p[2] < 30);
    // The first picture with red in it may be half drawn; `high` is that of a settled window.
    window.until("a high roof", |p| red(p) > 5000);
    let high = red(&window.rest());
    fs::write(&model, roof(0.2)).expect("written");
    window.until("a flat roof", |p| (500..high * 3 / 4).contains(&red(p)));
    let flat = red(&window.rest());
    fs::write(&model, "v 0 0 0\nv one\n").expect("written");
    let begin = Instant::now();
    while !window.said().contains("roof.obj:2: a vertex (v) must be three numbers") {
        assert!(begin.elapsed() < Duration::from_secs(60), "{}", window.said());
        thread::sleep(Duration::from_millis(20));
    }
    thread::sleep(Duration::from_millis(500));
    let picture = window.rest();
    assert!(red(&picture).abs_diff(flat) < flat / 10, "the last good version stays");
    fs::write(&model, roof(2.0)).expect("written");
    window.until("a high roof again", |p| red(p).abs_diff(high) < high / 10);
}

#[test]
fn what_is_dropped_is_added_to_the_scene_or_opened() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    fs::write(at("roof.obj"), roof(0.5)).expect("written");
    fs::write(at("broken.obj"), "f 1 2 3\n").expect("written");
    let ies = "TILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 10\n0 180\n0\n50 50\n";
    fs::write(at("lamp.IES"), ies).expect("written");
    fs::write(at("velvet.wgsl"), "// a model").expect("written");
    fs::write(at("light.md"), "# A lesson").expect("written");
    let registry = Registry::builtin();
    let mut session = Session::default();
    let drop = |session: &mut Session, names: &[&str]| {
        session.apply(Action::Drop(names.iter().map(|name| at(name)).collect()), &registry)
    };
    // Objects are added, each as one step, and named after their files.
    assert_eq!(drop(&mut session, &["roof.obj", "roof.obj"]), []);
    let names: Vec<_> = session.document.objects.iter().map(|object| object.name.as_deref()).collect();
    assert_eq!(names, [None, Some("roof"), Some("roof 2")]);
    assert_eq!(session.document.objects[1].object_type, "mesh");
    assert!(session.document.objects[1].shape.0.values().any(|v| v.to_string().contains("roof.obj")));
    assert_eq!((session.document.done(), session.selection), (2, Selection::Object(2)));
    // A broken one is not added.
    drop(&mut session, &["broken.obj"]);
    assert_eq!(session.document.done(), 2);
    assert!(session.messages.last().is_some_and(|m| m.text.contains("broken.obj")));
    // A lamp is added; a selected one gets the file.
    drop(&mut session, &["lamp.IES"]);
    assert_eq!(session.document.lights.len(), 2);
    assert_eq!((session.document.lights[1].light_type.as_str(), session.document.done()), ("photometric", 3));
    assert_eq!(session.selection, Selection::Light(1));
    drop(&mut session, &["lamp.IES"]);
    assert_eq!(session.document.lights.len(), 2);
    // A lesson opens, and a scene among other files.
    assert_eq!(drop(&mut session, &["light.md"]), [Effect::OpenLesson(at("light.md"))]);
    let mut fresh = Session::default();
    assert_eq!(drop(&mut fresh, &["roof.obj", "room.json"]), [Effect::OpenFile(at("room.json"))]);
    // A model from elsewhere is copied only with the user's consent.
    assert_eq!(drop(&mut fresh, &["velvet.wgsl"]), []);
    let (label, action) = fresh.messages.last().and_then(|m| m.offer.clone()).expect("an offer");
    assert_eq!(label, "Copy it there");
    assert_eq!(fresh.apply(*action, &registry), [Effect::AdoptModel(at("velvet.wgsl"))]);
    // Then it is written next to the others, and an existing one is left alone.
    let models = tempfile::tempdir().expect("a folder");
    let mut registry = Registry::builtin();
    lights_camera_models::custom::folder::declare_folder(models.path(), &mut registry);
    write(&Effect::AdoptModel(at("velvet.wgsl")), &mut fresh, &registry);
    let copy = models.path().join("velvet.wgsl");
    assert_eq!(fs::read_to_string(&copy).expect("copied"), "// a model");
    assert_eq!(fresh.authoring.wanted_model.as_deref(), Some("velvet"));
    fs::write(&copy, "// mine").expect("written");
    write(&Effect::AdoptModel(at("velvet.wgsl")), &mut fresh, &registry);
    assert_eq!(fs::read_to_string(&copy).expect("left alone"), "// mine");
    assert!(fresh.messages.last().is_some_and(|m| m.text.contains("already exists")));
}

#[test]
fn the_file_of_a_mesh_is_the_first_field_of_it() {
    let mut bench = Bench::new(Session::default());
    bench.size = bevy_egui::egui::vec2(1280.0, 900.0);
    bench.apply(Action::AddObject("mesh".to_owned()));
    let file = bench.tree.iter().find(|seen| seen.label.starts_with("model file: ")).expect("a knob").rect;
    let section = bench.tree.iter().find(|seen| seen.label == "Reflection" && seen.rect.left() > 900.0);
    let below = section.expect("a section").rect;
    let name = bench.find("Delete Mesh 1").expect("the header").rect;
    assert!(name.bottom() <= file.top() && file.bottom() <= below.top(), "{name:?} {file:?} {below:?}");
    assert_eq!(bench.tree.iter().filter(|seen| seen.label.starts_with("model file: ")).count(), 1);
}
