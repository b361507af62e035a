//! Shaders are swapped while they are in use, and whatever happens to their files, the picture stays.

use std::{
    fs,
    path::{Path, PathBuf},
    thread,
    time::Duration,
};

use bevy::prelude::{Camera, Last, Mut, Query, ResMut, Resource, With};

use lights_camera_models::{
    library::{
        assets::built_in_sources,
        problem::GRACE,
        status::{ShaderStatus, Trouble},
    },
    optics::colour::BACKGROUND,
    parameter::Value,
    registry::Registry,
    render::{
        camera::PictureCamera,
        capture::gpu::{GpuRenderer, Output},
        live::LiveShaders,
    },
    scene::Scene,
    watch::Watcher,
};
use tempfile::TempDir;

use crate::helpers::pictures::close_up;

const SIZE: u32 = 48;

/// A renderer whose shaders are files in a folder.
pub struct Lab {
    pub renderer: GpuRenderer,
    folder: TempDir,
}

/// A scene with the Phong model and a shading model.
pub fn phong_scene(shading: &str) -> Scene {
    let mut scene = close_up("sphere", "point");
    scene.reflection_model = "phong".to_owned();
    scene.shading_model = shading.to_owned();
    scene.objects[0].tessellation = Some(16);
    scene.objects[0].material.set("base_colour", Value::Colour([200, 120, 60]));
    scene
}

/// The built-in text of a shader file.
pub fn original(path: &str) -> &'static str {
    built_in_sources(&Registry::builtin()).into_iter().find(|s| s.path == path).expect("built in").text
}

impl Lab {
    pub fn new(scene: Scene) -> Self {
        Self::with_files(scene, &[])
    }

    /// Starts with these files already having these texts.
    pub fn with_files(scene: Scene, files: &[(&str, &str)]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        for source in built_in_sources(&Registry::builtin()) {
            let file = folder.path().join(source.path);
            fs::create_dir_all(file.parent().expect("below the folder")).expect("writable");
            fs::write(file, source.text).expect("writable");
        }
        let mut renderer =
            GpuRenderer::new(SIZE, SIZE, 1, Output::Display).expect("software Vulkan is installed");
        let world = renderer.app().world_mut();
        let mut registry = world.resource_mut::<Registry>();
        for (path, text) in files {
            fs::write(folder.path().join(path), text).expect("writable");
            registry.sources_mut().edit(*path, *text);
        }
        fs::create_dir(folder.path().join("own")).expect("writable");
        registry.set_shader_folder(folder.path());
        registry.set_custom_folder(&folder.path().join("own"));
        world.resource_mut::<LiveShaders>().start();
        renderer.set_scene(scene);
        renderer.settle().expect("the GPU draws");
        Self { renderer, folder }
    }

    pub fn file(&self, path: &str) -> PathBuf {
        self.folder.path().join(path)
    }

    pub fn live(&mut self) -> Mut<'_, LiveShaders> {
        self.renderer.app().world_mut().resource_mut::<LiveShaders>()
    }

    /// A file changed on disk.
    pub fn reread(&mut self, path: &str) {
        let file = self.file(path);
        self.reread_file(&file);
    }

    pub fn reread_file(&mut self, file: &Path) {
        let world = self.renderer.app().world_mut();
        world.resource_scope(|world, mut live: Mut<LiveShaders>| {
            live.reread(file, &mut world.resource_mut::<Registry>());
        });
    }

    pub fn save(&mut self, path: &str, text: impl AsRef<[u8]>) {
        fs::write(self.file(path), text).expect("writable");
        self.reread(path);
    }

    /// The next frame.
    pub fn frame(&mut self) -> Vec<u8> {
        self.renderer.step();
        self.renderer.read_rgb8().expect("the picture can be read")
    }

    /// The frame after everything was tried and problems were reported.
    pub fn settled(&mut self) -> Vec<u8> {
        thread::sleep(GRACE);
        for _ in 0..12_000 {
            self.renderer.step();
            if !self.live().is_busy() {
                break;
            }
            thread::sleep(Duration::from_millis(5));
        }
        assert!(!self.live().is_busy(), "it goes on trying");
        self.frame()
    }

    pub fn status(&mut self) -> ShaderStatus {
        self.live().status().clone()
    }

    pub fn troubles(&mut self) -> Vec<Trouble> {
        self.status().troubles
    }
}

fn covered(picture: &[u8]) -> usize {
    picture.chunks_exact(3).filter(|p| *p != BACKGROUND).count()
}

/// A way to break a file: its name, the file, the change, and the message.
pub struct Breakage {
    pub name: &'static str,
    pub file: &'static str,
    pub change: fn(&str) -> Vec<u8>,
    pub said: &'static str,
    /// Part of the line in the message; empty for the first line.
    pub line: &'static str,
}

fn replaced(text: &str, from: &str, to: &str) -> Vec<u8> {
    assert!(text.contains(from), "{from} is not in {text}");
    text.replacen(from, to, 1).into_bytes()
}

pub const BREAKAGES: &[Breakage] = &[
    Breakage {
        name: "syntax",
        file: "reflection/phong.wgsl",
        change: |t| replaced(t, "var specular = vec3(0.0);", "var specular = = vec3(0.0);"),
        said: "a value is missing before `=`",
        line: "= =",
    },
    Breakage {
        name: "types",
        file: "reflection/phong.wgsl",
        change: |t| replaced(t, "var specular = vec3(0.0);", "var specular = 1u;"),
        said: "`specular` is a whole number (u32), but `m.k_s * power(max(dot(mirror(l, frame.n), v), 0.0), m.alpha)…` is a vec3<f32>",
        line: "specular = m.k_s",
    },
    Breakage {
        name: "unknown name",
        file: "reflection/phong.wgsl",
        change: |t| replaced(t, "m.k_a * m.base_colour,", "m.k_ambient * m.base_colour,"),
        said: "k_ambient",
        line: "k_ambient",
    },
    Breakage {
        name: "unknown import",
        file: "wrapper.wgsl",
        change: |t| replaced(t, "bevy_pbr::mesh_functions\n", "bevy_pbr::no_such_module\n"),
        said: "there is no module `bevy_pbr::no_such_module`",
        line: "no_such_module",
    },
    Breakage {
        name: "missing import",
        file: "wrapper.wgsl",
        change: |t| replaced(t, "#import bevy_pbr::mesh_functions\n", "\n"),
        said: "`mesh_functions` is used, but no `#import` provides it",
        line: "mesh_functions::",
    },
    Breakage {
        name: "unknown file to import",
        file: "reflection/phong.wgsl",
        change: |t| format!("#import \"missing.wgsl\"\n{t}").into_bytes(),
        said: "there is no file `reflection/missing.wgsl`",
        line: "missing.wgsl",
    },
    Breakage {
        name: "import cycle",
        file: "terms.wgsl",
        change: |t| format!("{t}\n#import \"reflection/../terms.wgsl\"\n").into_bytes(),
        said: "circular import: terms.wgsl → terms.wgsl",
        line: "../terms.wgsl",
    },
    Breakage {
        name: "import cycle of the composer",
        file: "terms.wgsl",
        change: |t| format!("#define_import_path a\n#import a\n{t}").into_bytes(),
        said: "no import path",
        line: "#define_import_path",
    },
    Breakage {
        name: "empty file",
        file: "reflection/phong.wgsl",
        change: |_| Vec::new(),
        said: "the file is empty",
        line: "",
    },
    Breakage { name: "empty wrapper", file: "wrapper.wgsl", change: |_| Vec::new(), said: "", line: "" },
    Breakage {
        name: "missing entry function",
        file: "wrapper.wgsl",
        change: |t| replaced(t, "fn fragment(", "fn fragmentation("),
        said: "the function `fragment` with @fragment is missing",
        line: "@fragment",
    },
    Breakage {
        name: "wrong signature",
        file: "reflection/phong.wgsl",
        change: |t| replaced(t, "fn response(l: vec3<f32>, v", "fn response(l: vec2<f32>, v"),
        said: "the arguments of dot(a, b) must have the same type, but `frame.n` is a vec3<f32> and `l` is a vec2<f32>",
        line: "dot(frame.n, l)",
    },
    Breakage {
        name: "mismatch between the stages",
        file: "wrapper.wgsl",
        change: |t| {
            let t = String::from_utf8(replaced(t, "fn fragment(in: Stages)", "struct Other {\n    @builtin(position) clip_position: vec4<f32>,\n    @location(9) more: vec3<f32>,\n    @location(0) position: vec3<f32>,\n    @location(1) normal: vec3<f32>,\n    @location(2) tangent: vec3<f32>,\n    @location(3) colour: vec3<f32>,\n    @location(4) offset: vec3<f32>,\n    @location(5) @interpolate(flat) row: u32,\n    @location(6) @interpolate(flat) instance: u32,\n}\n@fragment\nfn fragment(in: Other)"))
                .expect("UTF-8");
            replaced(&t, "@fragment\nstruct", "struct")
        },
        said: "@location(9) differs between the vertex and the fragment stage",
        line: "@location(9)",
    },
    Breakage {
        name: "binding not in the layout",
        file: "wrapper.wgsl",
        change: |t| {
            let t = format!(
                "{t}\n@group(#{{MATERIAL_BIND_GROUP}}) @binding(7) var<storage, read> more: array<f32>;\n"
            );
            replaced(&t, "* illumination.exposure;", "* illumination.exposure * more[0];")
        },
        said: "@binding(7) does not exist",
        line: "@binding(7)",
    },
    Breakage {
        name: "constant division by zero",
        file: "reflection/phong.wgsl",
        change: |t| replaced(t, "var specular = vec3(0.0);", "var specular = vec3(f32(3 / 0));"),
        said: "zero",
        line: "3 / 0",
    },
    Breakage {
        name: "division by a constant zero",
        file: "reflection/phong.wgsl",
        change: |t| replaced(t, "m.k_a * m.base_colour,", "m.k_a / 0.0 * m.base_colour,"),
        said: "divides by zero",
        line: "/ 0.0",
    },
    Breakage {
        name: "endless loop",
        file: "loop.wgsl",
        change: |t| replaced(t, "i++) {", ") {"),
        said: "first iteration or never",
        line: "for (",
    },
    Breakage {
        name: "loop without exit",
        file: "reflection/phong.wgsl",
        change: |t| {
            replaced(
                t,
                "var specular = vec3(0.0);",
                "var specular = vec3(0.0);\n    while true { specular += 1.0; }",
            )
        },
        said: "no end",
        line: "while true",
    },
    Breakage {
        name: "invalid UTF-8",
        file: "reflection/phong.wgsl",
        change: |t| [t.as_bytes(), b"\n// caf\xe9\n"].concat(),
        said: "the byte 0xe9 is not UTF-8",
        line: "// caf",
    },
    Breakage {
        name: "an unfinished comment",
        file: "terms.wgsl",
        change: |t| format!("/* {t}").into_bytes(),
        said: "the comment is not closed",
        line: "/* ",
    },
    Breakage {
        name: "an unfinished comment at the end",
        file: "reflection/phong.wgsl",
        change: |t| format!("{t}\n  /* and so on\n").into_bytes(),
        said: "the comment is not closed",
        line: "/* and so on",
    },
    Breakage {
        name: "a bracket that is not closed",
        file: "shading/phong.wgsl",
        change: |t| {
            format!("{}\n", t.trim_end().strip_suffix('}').expect("ends with a bracket")).into_bytes()
        },
        said: "this { is not closed",
        line: "fn ",
    },
    Breakage {
        name: "an unfinished declaration",
        file: "light/point.wgsl",
        change: |t| format!("{t}\nconst half = 0.5\n").into_bytes(),
        said: "a ; is missing",
        line: "const half",
    },
    Breakage {
        name: "a parameter as it is spelt elsewhere",
        file: "reflection/phong.wgsl",
        change: |t| replaced(t, "m.k_a * m.base_colour,", "m.k_a * m.base_color,"),
        said: "no parameter base_color; did you mean base_colour?",
        line: "m.base_color,",
    },
    Breakage {
        name: "a broken shading model",
        file: "shading/phong.wgsl",
        change: |t| replaced(t, "fn shade_pixel", "fn shade_pixels"),
        said: "`shade_pixel` is not defined; introduced by the change in shading/phong.wgsl; did you mean `shade_pixels`?",
        line: "",
    },
    Breakage {
        name: "a broken light type",
        file: "light/point.wgsl",
        change: |t| replaced(t, "return", "retrun"),
        said: "",
        line: "retrun",
    },
    Breakage {
        name: "an unfinished #ifdef",
        file: "wrapper.wgsl",
        change: |t| replaced(t, "#endif", ""),
        said: "endif",
        line: "",
    },
];

#[test]
fn whatever_breaks_a_file_the_last_good_picture_stays_and_the_place_is_told() {
    let mut lab = Lab::new(phong_scene("phong"));
    let before = lab.frame();
    assert!(covered(&before) > 300);
    for Breakage { name, file, change, said, line } in BREAKAGES {
        let text = original(file);
        let broken = change(text);
        lab.save(file, &broken);
        for _ in 0..3 {
            assert!(lab.frame() == before, "{name}: the picture changed");
        }
        assert!(lab.settled() == before, "{name}: the picture changed after a while");
        let troubles = lab.troubles();
        let [trouble] = &troubles[..] else { panic!("{name}: {troubles:?}") };
        let problem = &trouble.problem;
        println!("{name}: {problem}");
        assert!(problem.message.contains(said), "{name}: {problem}");
        assert_eq!(trouble.stale, ["Phong"], "{name}");
        if !line.is_empty() {
            assert_eq!(problem.file, *file, "{name}: {problem}");
            let broken = String::from_utf8_lossy(&broken);
            let at = broken.lines().nth(problem.line - 1).unwrap_or_default();
            assert!(at.contains(line), "{name}: line {} is {at}", problem.line);
            assert_eq!(problem.source.trim_end(), at.trim_end(), "{name}");
            assert_eq!(trouble.path, Some(lab.file(file)), "{name}");
        }
        // The next valid save brings it up to date, and no problem remains.
        lab.save(file, text);
        assert!(lab.settled() == before, "{name}: the old text gives another picture");
        assert_eq!(lab.troubles(), [], "{name}");
        let more = format!("{text}\n// {name}\n");
        lab.save(file, &more);
        assert!(lab.settled() == before);
        assert_eq!(lab.troubles(), [], "{name}: a comment is no trouble");
        lab.save(file, text);
        lab.settled();
    }
}

/// The twin of the test above: a valid change has an effect.
#[test]
fn a_good_save_is_on_the_next_picture() {
    for (file, from, to) in [
        ("reflection/phong.wgsl", "m.k_a * m.base_colour", "m.k_a * m.base_colour.bgr"),
        (
            "terms.wgsl",
            "fn power(",
            "fn power(base: f32, exponent: f32) -> f32 { return 0.2; }\nfn old_power(",
        ),
        ("loop.wgsl", "* light.colour;", "* light.colour * 0.5;"),
        ("light/point.wgsl", "return ", "let unused = 1.0;\n    return "),
        ("shading/phong.wgsl", "return illuminate(", "return 0.5 * illuminate("),
        ("wrapper.wgsl", "* illumination.exposure;", "* illumination.exposure * 0.5;"),
    ] {
        let mut lab = Lab::new(phong_scene("phong"));
        let before = lab.frame();
        let text = original(file);
        assert!(text.contains(from), "{file} has no {from}");
        lab.save(file, text.replacen(from, to, 1));
        let after = lab.frame();
        if file == "light/point.wgsl" {
            assert!(after == before, "{file}: the light is the same");
        } else {
            assert!(after != before, "{file}: the change does not show in the next frame");
        }
        assert!(covered(&after) == covered(&before), "{file}");
        assert_eq!(lab.status().last.map(|l| l.file), Some(file.to_owned()));
        lab.save(file, text);
        assert!(lab.frame() == before, "{file}: the old text gives the old picture");
    }
}

#[test]
fn a_deleted_or_renamed_file_leaves_the_picture_and_is_missed() {
    let mut lab = Lab::new(phong_scene("gouraud"));
    let before = lab.frame();
    let file = lab.file("reflection/phong.wgsl");
    let aside = lab.file("reflection/other.wgsl");
    for rename in [false, true] {
        if rename { fs::rename(&file, &aside) } else { fs::remove_file(&file) }.expect("possible");
        lab.reread("reflection/phong.wgsl");
        lab.reread("reflection/other.wgsl");
        assert!(lab.settled() == before);
        let troubles = lab.troubles();
        assert_eq!(troubles.len(), 1, "{troubles:?}");
        assert!(troubles[0].problem.message.contains("missing"), "{troubles:?}");
        assert_eq!(troubles[0].stale, ["Phong"]);
        lab.save("reflection/phong.wgsl", original("reflection/phong.wgsl"));
        assert!(lab.settled() == before);
        assert_eq!(lab.troubles(), []);
    }
    lab.save("reflection/phong.wgsl", original("reflection/phong.wgsl").replace("m.k_d", "0.5 * m.k_d"));
    assert!(lab.settled() != before, "it is watched as before");
}

#[test]
fn what_breaks_one_model_does_not_disturb_the_others() {
    let mut scene = phong_scene("phong");
    scene.objects[0].position.x -= 0.5;
    let mut other = scene.objects[0].clone();
    other.position.x += 1.0;
    other.reflection_model = Some("lambert".to_owned());
    scene.objects.push(other);
    let mut lab = Lab::new(scene);
    let before = lab.frame();
    // Phong needs `power`, Lambert does not; both see the new colours of the light loop.
    lab.save("terms.wgsl", original("terms.wgsl").replace("fn power(", "fn other_power("));
    assert!(lab.settled() == before);
    assert_eq!(
        lab.troubles().iter().map(|t| t.stale.clone()).collect::<Vec<_>>(),
        [vec!["Phong".to_owned()]]
    );
    let mut lambert = lab.frame();
    lab.save("reflection/lambert.wgsl", "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {\n    return Terms(vec3(0.0), vec3(0.0, 0.2, 0.0), vec3(0.0));\n}\nfn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {\n    return vec3(0.0);\n}\n");
    let after = lab.settled();
    assert!(after != lambert, "Lambert is exchanged while Phong is broken");
    let changed = |a: &[u8], b: &[u8], columns: std::ops::Range<u32>| {
        (0..SIZE).any(|y| {
            columns.clone().any(|x| {
                let i = ((y * SIZE + x) * 3) as usize;
                a[i..i + 3] != b[i..i + 3]
            })
        })
    };
    assert!(!changed(&after, &lambert, 0..10), "Phong stays as it was");
    lambert = after;
    lab.save("terms.wgsl", original("terms.wgsl"));
    assert!(lab.settled() == lambert);
    assert_eq!(lab.troubles(), []);
}

#[test]
fn a_model_that_is_not_on_the_picture_is_tried_all_the_same() {
    let mut lab = Lab::new(phong_scene("phong"));
    let before = lab.frame();
    lab.save("reflection/hapke.wgsl", "fn response(");
    assert!(lab.settled() == before);
    let troubles = lab.troubles();
    assert_eq!(troubles.len(), 1, "{troubles:?}");
    assert_eq!(troubles[0].problem.file, "reflection/hapke.wgsl");
    assert_eq!(troubles[0].stale, Vec::<String>::new(), "nothing on the picture is old");
    // If shown now, it is the built-in text, with a message.
    let mut scene = phong_scene("phong");
    scene.reflection_model = "hapke".to_owned();
    lab.renderer.set_scene(scene.clone());
    let shown = lab.settled();
    assert!(shown == Lab::new(scene).frame(), "the built-in Hapke is shown");
    assert_eq!(
        lab.troubles().iter().map(|t| t.stale.clone()).collect::<Vec<_>>(),
        [vec!["Hapke".to_owned()]]
    );
    lab.save("reflection/hapke.wgsl", original("reflection/hapke.wgsl"));
    assert!(lab.settled() == shown);
    assert_eq!(lab.troubles(), []);
}

#[test]
fn a_file_that_is_broken_at_the_start_is_replaced_by_the_built_in_copy() {
    let scene = phong_scene("gouraud");
    let expected = Lab::new(scene.clone()).frame();
    for (file, text) in [
        ("reflection/phong.wgsl", "nonsense"),
        ("wrapper.wgsl", ""),
        ("terms.wgsl", "#import \"terms.wgsl\""),
        ("shading/gouraud.wgsl", "fn shade_vertex() {}"),
    ] {
        let mut lab = Lab::with_files(scene.clone(), &[(file, text)]);
        assert!(lab.settled() == expected, "{file}");
        assert_eq!(lab.status().stale(), ["Phong"], "{file}");
        lab.save(file, original(file));
        assert!(lab.settled() == expected, "{file}");
        assert_eq!(lab.troubles(), [], "{file}");
    }
    // The twin: a valid file with another text is used from the start.
    let text = original("reflection/phong.wgsl").replace("m.k_d", "0.3 * m.k_d");
    let mut lab = Lab::with_files(scene, &[("reflection/phong.wgsl", &text)]);
    assert!(lab.settled() != expected);
    assert_eq!(lab.troubles(), []);
}

#[test]
fn a_picture_with_edited_shaders_is_drawn_once() {
    /// The number of whole frames.
    #[derive(Default, Resource)]
    struct Whole(usize);
    fn count(cameras: Query<&Camera, With<PictureCamera>>, mut whole: ResMut<Whole>) {
        whole.0 += cameras.iter().filter(|camera| camera.is_active && camera.viewport.is_none()).count();
    }
    let text = original("reflection/phong.wgsl").replace("m.k_d", "0.3 * m.k_d");
    let mut renderer =
        GpuRenderer::new(SIZE, SIZE, 1, Output::Display).expect("software Vulkan is installed");
    renderer.app().init_resource::<Whole>().add_systems(Last, count);
    let world = renderer.app().world_mut();
    world.resource_mut::<Registry>().sources_mut().edit("reflection/phong.wgsl", text.as_str());
    world.resource_mut::<LiveShaders>().start();
    renderer.set_scene(phong_scene("phong"));
    renderer.settle().expect("the GPU draws");
    assert_eq!(renderer.app().world().resource::<Whole>().0, 1);
    let picture = renderer.read_rgb8().expect("the picture can be read");
    let mut lab = Lab::with_files(phong_scene("phong"), &[("reflection/phong.wgsl", &text)]);
    assert!(lab.settled() == picture, "it is that with the edited shader, and whole");
    assert!(Lab::new(phong_scene("phong")).frame() != picture);
}

#[test]
fn a_picture_without_the_broken_model_is_not_called_stale() {
    let mut lab = Lab::new(phong_scene("phong"));
    lab.save("reflection/phong.wgsl", original("reflection/phong.wgsl").replacen("return ", "return (", 1));
    lab.settled();
    assert_eq!(lab.status().stale(), ["Phong"]);
    // Another scene, as with File › New; the error of the file is still reported.
    for (model, stale) in [("lambert", false), ("phong", true), ("lambert", false)] {
        lab.renderer.set_scene(Scene { reflection_model: model.to_owned(), ..phong_scene("phong") });
        lab.settled();
        lab.settled();
        assert_eq!((lab.status().stale().len(), lab.troubles().len()), (usize::from(stale), 1), "{model}");
    }
}

#[test]
fn switching_modes_and_models_while_a_file_is_broken_shows_their_last_good_versions() {
    let mut lab = Lab::new(phong_scene("phong"));
    let bluish = original("reflection/phong.wgsl").replace("m.k_d *", "0.2 * m.k_d *");
    lab.save("reflection/phong.wgsl", &bluish);
    let phong = lab.settled();
    lab.save("reflection/phong.wgsl", "fn broken(");
    assert!(lab.settled() == phong);
    // Not composed before: the last valid text is used.
    lab.renderer.set_scene(phong_scene("flat"));
    let flat = lab.settled();
    let expected = Lab::with_files(phong_scene("flat"), &[("reflection/phong.wgsl", &bluish)]).settled();
    assert!(flat == expected, "flat shading with the last good text");
    assert_eq!(lab.status().stale(), ["Phong"]);
    lab.renderer.set_scene(phong_scene("phong"));
    assert!(lab.settled() == phong);
}

#[test]
fn unchanged_text_recompiles_nothing_and_a_change_recompiles_only_what_depends_on_it() {
    let mut lab = Lab::new(phong_scene("phong"));
    lab.settled();
    assert!(!lab.live().is_busy());
    lab.reread("reflection/phong.wgsl");
    lab.reread("terms.wgsl");
    lab.save("loop.wgsl", original("loop.wgsl"));
    assert!(!lab.live().is_busy(), "nothing is due after unchanged saves");
    assert_eq!(lab.status().last, None);
    lab.save("reflection/phong.wgsl", format!("{}\n", original("reflection/phong.wgsl")));
    assert!(lab.live().is_busy(), "the twin: another text is due");
    lab.settled();
    assert_eq!(lab.status().last.map(|l| l.file), Some("reflection/phong.wgsl".to_owned()));
    // A shading model that is not in use is not part of the visible shader.
    lab.save("shading/flat.wgsl", format!("{}\n", original("shading/flat.wgsl")));
    lab.settled();
    assert_eq!(lab.status().last.map(|l| l.file), Some("reflection/phong.wgsl".to_owned()));
}

/// Passes the watcher's reports to the shaders, until it has been quiet for a while.
fn follow(lab: &mut Lab, watcher: &Watcher, expect_change: bool) -> Vec<Vec<u8>> {
    let mut frames = Vec::new();
    let mut quiet = 0;
    for _ in 0..6000 {
        let changed = watcher.changed();
        quiet = if changed.is_empty() && watcher.pending().is_none() { quiet + 1 } else { 0 };
        changed.iter().for_each(|file| lab.reread_file(file));
        let frame = lab.frame();
        if frames.last() != Some(&frame) {
            frames.push(frame);
        }
        if quiet > 20 && (!expect_change || frames.len() > 1) {
            break;
        }
        thread::sleep(Duration::from_millis(5));
    }
    frames
}

#[test]
fn saving_as_editors_do_goes_from_one_picture_to_the_next_and_shows_nothing_between() {
    let mut lab = Lab::new(phong_scene("phong"));
    let mut watcher = Watcher::new(|| {});
    let folder = lab.file("").canonicalize().expect("there");
    lab.renderer.app().world_mut().resource_mut::<Registry>().set_shader_folder(&folder);
    watcher.watch_folder(&folder);
    let file = folder.join("reflection/phong.wgsl");
    let text =
        |factor: f32| original("reflection/phong.wgsl").replace("m.k_d *", &format!("{factor:?} * m.k_d *"));
    let expected = |factor: f32| {
        Lab::with_files(phong_scene("phong"), &[("reflection/phong.wgsl", &text(factor))]).settled()
    };
    let ways: [(&str, fn(&std::path::Path, &str)); 6] = [
        ("rewriting", |file, text| fs::write(file, text).expect("writable")),
        ("vim", |file, text| {
            fs::rename(file, file.with_extension("wgsl~")).expect("possible");
            fs::write(file, text).expect("writable");
            fs::remove_file(file.with_extension("wgsl~")).expect("possible");
        }),
        ("VS Code", |file, text| {
            fs::write(file, "").expect("writable");
            thread::sleep(Duration::from_millis(5));
            fs::write(file, text).expect("writable");
        }),
        ("JetBrains", |file, text| {
            let new = file.with_file_name("phong.wgsl___jb_tmp___");
            fs::write(&new, text).expect("writable");
            fs::rename(new, file).expect("possible");
        }),
        ("half, then the rest", |file, text| {
            fs::write(file, &text[..text.len() / 2]).expect("writable");
            thread::sleep(Duration::from_millis(40));
            fs::write(file, text).expect("writable");
        }),
        ("two saves 5 ms apart", |file, text| {
            fs::write(file, text.replace("m.k_s", "m.no_such_thing")).expect("writable");
            thread::sleep(Duration::from_millis(5));
            fs::write(file, text).expect("writable");
        }),
    ];
    let mut before = lab.frame();
    for (i, (name, save)) in ways.into_iter().enumerate() {
        let factor = 0.2 + 0.1 * i as f32;
        let after = expected(factor);
        assert!(after != before, "{name}: the twin would look the same");
        save(&file, &text(factor));
        let frames = follow(&mut lab, &watcher, true);
        let known = frames.iter().all(|f| *f == before || *f == after);
        assert!(known, "{name}: {} pictures, some neither the old nor the new", frames.len());
        assert!(frames.last() == Some(&after), "{name}: the new picture did not come");
        lab.settled();
        assert_eq!(lab.troubles(), [], "{name}");
        before = after;
    }
}

/// Changes a text at random, like typing errors.
fn mutated(text: &str, random: &mut random::Random) -> String {
    let tokens: Vec<&str> = split_tokens(text);
    let mut tokens: Vec<String> = tokens.into_iter().map(str::to_owned).collect();
    for _ in 0..=random.below(2) {
        let words: Vec<usize> = (0..tokens.len()).filter(|i| !tokens[*i].trim().is_empty()).collect();
        if words.is_empty() {
            break;
        }
        let at = words[random.below(words.len())];
        let other = words[random.below(words.len())];
        match random.below(6) {
            0 => {
                tokens.remove(at);
            }
            1 => tokens[at] = tokens[other].clone(),
            2 => tokens.swap(at, other),
            3 => tokens.truncate(at),
            4 => {
                let token = tokens[at].clone();
                tokens.insert(at, token);
            }
            _ => {
                // A character missing from our keyboards, or another digit.
                let digit = char::from(b'0' + random.below(10) as u8);
                let put = if random.below(2) == 0 {
                    digit
                } else {
                    ['é', '\u{0}', '{', '@', ';'][random.below(5)]
                };
                tokens[at] = tokens[at].chars().skip(1).chain([put]).collect();
            }
        }
    }
    tokens.concat()
}

/// Words, numbers, and single other characters.
fn split_tokens(text: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let is_word = |c: char| c.is_alphanumeric() || c == '_' || c == '.';
        let end =
            if is_word(first) { rest.find(|c| !is_word(c)).unwrap_or(rest.len()) } else { first.len_utf8() };
        tokens.push(&rest[..end]);
        rest = &rest[end..];
    }
    tokens
}

/// Random numbers that are the same in every run (PCG of M. O'Neill 2014).
pub mod random {
    pub struct Random(pub u64);

    impl Random {
        pub fn below(&mut self, end: usize) -> usize {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let shifted = (((self.0 >> 18) ^ self.0) >> 27) as u32;
            let number = shifted.rotate_right((self.0 >> 59) as u32);
            number as usize % end.max(1)
        }
    }
}

#[test]
fn random_edits_never_lose_the_picture_or_the_program() {
    /// The number of rounds; `LCM_FUZZ_ROUNDS` overrides it.
    const ROUNDS: usize = 120;
    let rounds = std::env::var("LCM_FUZZ_ROUNDS").ok().and_then(|n| n.parse().ok()).unwrap_or(ROUNDS);
    let files = [
        "reflection/phong.wgsl",
        "terms.wgsl",
        "lights.wgsl",
        "loop.wgsl",
        "light/point.wgsl",
        "shading.wgsl",
        "shading/gouraud.wgsl",
        "wrapper.wgsl",
        "optics/fresnel.wgsl",
    ];
    let mut lab = Lab::new(phong_scene("gouraud"));
    let good = lab.frame();
    let mut random = random::Random(20_261_121);
    let (mut refused, mut accepted) = (0, 0);
    for round in 0..rounds {
        let file = files[random.below(files.len())];
        let text = mutated(original(file), &mut random);
        let context = || format!("round {round}, {file}:\n{text}");
        lab.save(file, &text);
        let shown = lab.frame();
        if lab.live().is_up_to_date() {
            accepted += 1;
            assert_eq!(shown.len(), good.len(), "{}", context());
        } else {
            refused += 1;
            assert!(shown == good, "a refused change shows\n{}", context());
        }
        // A lost frame is black everywhere, background included; failed pipelines are reported here.
        assert!(shown.chunks_exact(3).any(|p| p == BACKGROUND), "the frame is gone\n{}", context());
        lab.renderer.settle().unwrap_or_else(|e| panic!("{e}\n{}", context()));
        lab.save(file, original(file));
        assert!(lab.frame() == good, "the good text does not bring the picture back\n{}", context());
    }
    println!("{refused} changes refused, {accepted} accepted");
    assert!(refused > rounds / 3 && accepted > 0, "{refused} refused, {accepted} accepted");
}

/// A custom model; `tint` is its colour, and `knobs` its declarations besides the base colour.
fn custom_model(tint: &str, knobs: &str) -> String {
    format!(
        "/* lcm
{{ \"name\": \"Tinted\", \"parameters\": [\"base_colour\"{knobs}] }}
*/
#import \"help.wgsl\"
fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {{
    return Terms(vec3(0.0), helped({tint}) * max(dot(frame.n, l), 0.0), vec3(0.0));
}}
fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> {{
    return helped({tint});
}}
"
    )
}

const HELP: &str = "fn helped(c: vec3<f32>) -> vec3<f32> {\n    return c;\n}\n";
const GREEN: &str = "vec3(0.0, 1.0, 0.0)";
const RED: &str = "vec3(1.0, 0.0, 0.0)";

/// A lab whose scene uses a custom model.
fn own_lab() -> Lab {
    let mut lab = Lab::new(phong_scene("phong"));
    lab.save("own/help.wgsl", HELP);
    lab.save("own/tinted.wgsl", custom_model(GREEN, ""));
    lab.settled();
    assert_eq!(lab.troubles(), []);
    let mut scene = phong_scene("phong");
    scene.reflection_model = "tinted".to_owned();
    lab.renderer.set_scene(scene);
    lab
}

/// True if the brightest pixel has only one channel.
fn is_all(picture: &[u8], channel: usize) -> bool {
    let lit = picture.chunks_exact(3).filter(|p| *p != BACKGROUND);
    lit.max_by_key(|p| p[channel])
        .is_some_and(|p| p[channel] > 60 && (0..3).all(|c| c == channel || p[c] == 0))
}

#[test]
fn a_custom_model_is_exchanged_with_its_declaration_or_not_at_all() {
    let mut lab = own_lab();
    let green = lab.settled();
    assert!(is_all(&green, 1));
    // The text alone takes effect in the next picture.
    lab.save("own/tinted.wgsl", custom_model(RED, ""));
    let red = lab.frame();
    assert!(is_all(&red, 0));
    // So does another layout of the parameters, before and after the existing ones.
    let knob = r#", { "name": "tint2", "type": "colour", "default": [0, 255, 0] }"#;
    lab.save("own/tinted.wgsl", custom_model("m.tint2", knob));
    assert!(lab.frame() == green);
    let before = custom_model("m.tint3", knob).replace(
        "[\"base_colour\"",
        r#"["k_d", { "name": "tint3", "type": "colour", "default": [255, 0, 0] }, "base_colour""#,
    );
    // A shader refused by the driver leaves text, parameters and picture unchanged.
    let binding = "@group(2) @binding(7) var<uniform> more: vec4<f32>;\n";
    let refused = before
        .replace("fn response", &format!("{binding}fn response"))
        .replace("(m.tint3)", "(m.tint3 * more.xyz)");
    lab.save("own/tinted.wgsl", &refused);
    for _ in 0..3 {
        assert!(lab.frame() == green, "a refused declaration shows");
    }
    assert!(lab.settled() == green);
    let troubles = lab.troubles();
    assert_eq!(troubles.len(), 1, "{troubles:?}");
    assert!(troubles[0].problem.message.contains("@binding(7) is not available to a model"), "{troubles:?}");
    assert_eq!(
        (troubles[0].problem.file.as_str(), &troubles[0].stale[..]),
        ("models/tinted.wgsl", &["Tinted".to_owned()][..])
    );
    // The valid version, under another name too.
    lab.save("own/tinted.wgsl", before.replace("Tinted", "Tainted"));
    assert!(lab.frame() == red);
    lab.settled();
    assert_eq!(lab.troubles(), []);
}

#[test]
fn a_custom_model_follows_the_files_that_it_shares() {
    let mut lab = own_lab();
    let green = lab.settled();
    // A broken helper leaves the picture; the model that changes meanwhile appears as soon as it is fixed.
    lab.save("own/help.wgsl", "fn helped(");
    assert!(lab.settled() == green);
    assert!(!lab.troubles().is_empty());
    lab.save("own/tinted.wgsl", custom_model(RED, ""));
    assert!(lab.settled() == green);
    lab.save("own/help.wgsl", HELP);
    let red = lab.settled();
    assert!(is_all(&red, 0), "the newest text of the model is shown");
    assert_eq!(lab.troubles(), []);
    // The same if the broken file is one that all models share.
    lab.save("terms.wgsl", format!("{}fn bad(", original("terms.wgsl")));
    assert!(lab.settled() == red);
    lab.save("own/tinted.wgsl", custom_model(GREEN, ""));
    lab.settled();
    assert!(lab.troubles().iter().all(|t| t.problem.file == "terms.wgsl"), "{:?}", lab.troubles());
    lab.save("terms.wgsl", original("terms.wgsl"));
    assert!(lab.settled() == green);
    assert_eq!(lab.troubles(), []);
    // A helper that arrives later than the model that imports it.
    lab.save("own/tinted.wgsl", custom_model(RED, "").replace("help.wgsl", "late.wgsl"));
    assert!(lab.settled() == green);
    assert!(lab.troubles()[0].problem.message.contains("there is no file `late.wgsl`"));
    lab.save("own/late.wgsl", HELP);
    assert!(lab.settled() == red);
    assert_eq!(lab.troubles(), []);
}

#[test]
fn files_that_are_gone_and_were_nothing_are_not_missed() {
    let mut lab = own_lab();
    let green = lab.settled();
    for name in ["phong.wgsl", "Bad-Name.wgsl", "unused.wgsl"] {
        lab.save(&format!("own/{name}"), custom_model(RED, "").replace("Tinted", "Other"));
        lab.settled();
        assert_eq!(lab.troubles().len(), usize::from(name != "unused.wgsl"), "{name}: {:?}", lab.troubles());
        fs::remove_file(lab.file(&format!("own/{name}"))).expect("removed");
        lab.reread(&format!("own/{name}"));
        lab.settled();
        assert_eq!(lab.troubles(), [], "{name}");
    }
    let registry = lab.renderer.app().world().resource::<Registry>().clone();
    assert!(registry.model("unused").is_none(), "a model whose file is gone cannot be chosen");
    // The twin: one in use is missed, and stays.
    fs::remove_file(lab.file("own/tinted.wgsl")).expect("removed");
    lab.reread("own/tinted.wgsl");
    assert!(lab.settled() == green);
    assert_eq!(lab.troubles().len(), 1);
    lab.save("own/tinted.wgsl", custom_model(RED, ""));
    assert!(is_all(&lab.settled(), 0));
    assert_eq!(lab.troubles(), []);
}
