//! WGSL compiled into other crates: errors in it do not affect other pictures, are reported with file and
//! line, and can be fixed while the program runs.

use std::{fs, thread, time::Duration};

use bevy::{app::App, prelude::Mut};
use glam::Vec3;
use lights_camera_models::{
    library::{problem::GRACE, status::ShaderStatus},
    light::{self, Incident, LightRecord, LightType},
    optics::{Frame, Terms},
    parameters, reflection,
    reflection::ReflectionModel,
    registry::{Register, Registry},
    render::{
        capture::gpu::{GpuRenderer, Output},
        live::LiveShaders,
    },
    scene::{Light, Scene},
    shader::Source,
};

use crate::helpers::pictures::close_up;

const SIZE: u32 = 48;

parameters! {
    /// A lamp whose WGSL lacks a semicolon in line 2.
    struct Lamp {}
}

impl LightType for Lamp {
    const DECLARATION: light::Declaration = light::Declaration::new(
        "lamp",
        "Lamp",
        Source::new(
            "mine/lamp.wgsl",
            "fn incident_lamp(light: Light, p: vec3<f32>) -> Incident {\n    let up = vec3(0.0, 1.0, 0.0)\n    return Incident(up, vec3(light.intensity), 0u);\n}\n",
        ),
    );

    fn incident(&self, light: &LightRecord, _: Vec3) -> Incident {
        Incident::From { l: Vec3::Y, intensity: Vec3::splat(light.intensity) }
    }
}

/// The text without the error.
const MENDED: &str = "fn incident_lamp(light: Light, p: vec3<f32>) -> Incident {\n    return Incident(vec3(0.0, 1.0, 0.0), vec3(light.intensity), 0u);\n}\n";

/// A model whose WGSL has another name for its function.
macro_rules! model {
    ($name:ident, $id:literal, $text:expr) => {
        parameters! {
            /// Red paper.
            struct $name {}
        }
        impl ReflectionModel for $name {
            const DECLARATION: reflection::Declaration =
                reflection::Declaration::new($id, "Red", Source::new(concat!($id, ".wgsl"), $text));
            fn response(&self, l: Vec3, _: Vec3, frame: &Frame) -> Terms {
                Terms { diffuse: frame.n.dot(l).max(0.0) * Vec3::X, ..Terms::default() }
            }
            fn ambient_response(&self, _: Vec3, _: &Frame) -> Vec3 {
                Vec3::X
            }
        }
    };
}

const RED: &str = "fn response(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {
    return Terms(vec3(0.0), max(dot(frame.n, l), 0.0) * vec3(1.0, 0.0, 0.0), vec3(0.0));
}
fn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> { return vec3(1.0, 0.0, 0.0); }
";
model!(Red, "red", RED);
model!(
    Misnamed,
    "misnamed",
    "// red\nfn respond(l: vec3<f32>, v: vec3<f32>, frame: Frame, m: Parameters) -> Terms {\n    return Terms(vec3(0.0), vec3(1.0), vec3(0.0));\n}\nfn ambient_response(v: vec3<f32>, frame: Frame, m: Parameters) -> vec3<f32> { return vec3(1.0); }\n"
);

fn renderer(register: impl FnOnce(&mut App)) -> GpuRenderer {
    GpuRenderer::extended(SIZE, SIZE, 1, Output::Display, register).expect("software Vulkan is installed")
}

fn picture(renderer: &mut GpuRenderer, scene: &Scene) -> Vec<u8> {
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");
    renderer.read_rgb8().expect("the picture can be read")
}

/// The status once problems are old enough to be reported.
fn status(renderer: &mut GpuRenderer) -> ShaderStatus {
    thread::sleep(GRACE);
    for _ in 0..12_000 {
        renderer.step();
        if !renderer.app().world().resource::<LiveShaders>().is_busy() {
            break;
        }
        thread::sleep(Duration::from_millis(5));
    }
    renderer.app().world().resource::<LiveShaders>().status().clone()
}

fn reread(renderer: &mut GpuRenderer, file: &std::path::Path) {
    let world = renderer.app().world_mut();
    world.resource_scope(|world, mut live: Mut<LiveShaders>| {
        live.reread(file, &mut world.resource_mut::<Registry>());
    });
}

fn lit_by_lamp() -> Scene {
    let mut scene = close_up("sphere", "point");
    scene.lights.push(Light {
        light_type: "lamp".to_owned(),
        position: None,
        intensity: 0.5,
        ..Light::default()
    });
    scene
}

#[test]
fn a_broken_light_type_takes_no_picture_away_that_has_no_such_light() {
    let scene = close_up("sphere", "point");
    let expected = picture(&mut renderer(|_| {}), &scene);
    let mut with = renderer(|app| {
        app.add_light_type::<Lamp>();
    });
    assert!(picture(&mut with, &scene) == expected);
    assert_eq!(with.shader_problem(), None);
    assert_eq!(status(&mut with).troubles, []);
}

#[test]
fn a_broken_light_that_shines_is_reported_and_dark_and_the_others_shine_on() {
    let expected = picture(&mut renderer(|_| {}), &close_up("sphere", "point"));
    let mut with = renderer(|app| {
        app.add_light_type::<Lamp>();
    });
    assert!(picture(&mut with, &lit_by_lamp()) == expected, "the other light shines on");
    let problem = with.shader_problem().expect("it is wrong");
    assert_eq!((problem.file.as_str(), problem.line), ("mine/lamp.wgsl", 2), "{problem}");
    let troubles = status(&mut with).troubles;
    assert_eq!(troubles.len(), 1, "{troubles:?}");
    assert_eq!(troubles[0].stale, ["Lambert (without mine/lamp.wgsl)"]);
}

#[test]
fn a_broken_model_is_drawn_as_a_grey_stand_in_and_reported() {
    let mut scene = close_up("sphere", "point");
    scene.lights[0].colour = [255; 3];
    let mut with = renderer(|app| {
        app.add_reflection_model::<Misnamed>().add_reflection_model::<Red>();
    });
    scene.reflection_model = "misnamed".to_owned();
    let grey = picture(&mut with, &scene);
    let problem = with.shader_problem().expect("it is wrong");
    assert_eq!((problem.file.as_str(), problem.line), ("misnamed.wgsl", 2), "{problem}");
    assert!(
        problem.message.contains("the function response is missing") && problem.message.contains("respond?"),
        "{problem}"
    );
    let troubles = status(&mut with).troubles;
    assert_eq!(troubles[0].stale, ["Red (a grey stand-in)"]);
    let middle = |picture: &[u8]| {
        let at = 3 * (SIZE * SIZE / 2 + SIZE / 2) as usize;
        [picture[at], picture[at + 1], picture[at + 2]]
    };
    let [r, g, b] = middle(&grey);
    assert!(r == g && g == b && r > 20, "{:?}", middle(&grey));
    // A valid one is drawn as it is.
    scene.reflection_model = "red".to_owned();
    let [r, g, b] = middle(&picture(&mut with, &scene));
    assert!(r > 100 && (g, b) == (0, 0), "{r} {g} {b}");
}

#[test]
fn files_in_the_folder_of_another_crate_are_followed() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("mine")).expect("writable");
    let file = folder.path().join("mine/lamp.wgsl");
    fs::write(&file, Lamp::DECLARATION.wgsl.text).expect("writable");
    let mut with = renderer(|app| {
        app.add_light_type::<Lamp>().add_shader_folder(folder.path());
    });
    let dark = picture(&mut with, &lit_by_lamp());
    assert_eq!(status(&mut with).troubles[0].path.as_deref(), Some(file.as_path()), "the file to open");
    fs::write(&file, MENDED).expect("writable");
    reread(&mut with, &file);
    assert_eq!(status(&mut with).troubles, []);
    let lit = picture(&mut with, &lit_by_lamp());
    assert!(lit != dark, "it shines");
    // Another error leaves the last valid version.
    fs::write(&file, MENDED.replace("0u", "0.5")).expect("writable");
    reread(&mut with, &file);
    let troubles = status(&mut with).troubles;
    assert_eq!(troubles[0].stale, ["Lambert"], "{troubles:?}");
    assert!(picture(&mut with, &lit_by_lamp()) == lit);
    // A file with the name of one of ours belongs only to that crate.
    let ours = folder.path().join("loop.wgsl");
    fs::write(&ours, "fn illuminate( {").expect("writable");
    reread(&mut with, &ours);
    assert_eq!(status(&mut with).troubles.len(), 1);
}
