//! The OpenGL program draws the lab's picture: the race is between two programs for one picture.

use std::{fs::File, io::BufReader, process::Command};

use lights_camera_models::{
    reference::{Settings, render_rgb8},
    registry::Registry,
    render::capture::gpu::{GpuRenderer, Output},
    scene::Scene,
};

const SIZE: (u32, u32) = (640, 360);

/// The picture of the program, or the reason why there is none.
fn drawn() -> Result<Vec<u8>, String> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("opengl.png");
    let output = Command::new(env!("CARGO_BIN_EXE_default-scene-in-opengl"))
        .args(["--size", "640x360", "--frames", "3", "-o"])
        .arg(&file)
        .output()
        .expect("it starts");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    if said.contains("there is no EGL") {
        return Err(said);
    }
    assert!(output.status.success(), "{said}");
    assert_eq!(String::from_utf8_lossy(&output.stdout).lines().count(), 3, "one time per frame");
    let mut reader = png::Decoder::new(BufReader::new(File::open(file).expect("written")))
        .read_info()
        .expect("a PNG file");
    let mut rgb = vec![0; reader.output_buffer_size().expect("small")];
    let info = reader.next_frame(&mut rgb).expect("a picture");
    assert_eq!((info.width, info.height, info.color_type), (SIZE.0, SIZE.1, png::ColorType::Rgb));
    Ok(rgb)
}

/// The fraction of values that differ by more than two codes.
fn different(a: &[u8], b: &[u8]) -> f64 {
    assert_eq!(a.len(), b.len());
    let count = a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > 2).count();
    count as f64 / a.len() as f64
}

#[test]
fn it_is_the_picture_of_the_lab_within_two_codes() {
    let opengl = match drawn() {
        Ok(picture) => picture,
        Err(reason) => return println!("skipped: {reason}"),
    };
    let render = |scene: &Scene| {
        let settings = Settings { width: SIZE.0, height: SIZE.1, samples: 1, ..Settings::default() };
        render_rgb8(scene, &Registry::builtin(), &settings)
    };
    let cpu = render(&Scene::default());
    let mut renderer = GpuRenderer::new(SIZE.0, SIZE.1, 1, Output::Display).expect("software Vulkan");
    renderer.set_scene(Scene::default());
    renderer.settle().expect("the GPU draws");
    let gpu = renderer.read_rgb8().expect("the picture can be read");
    // A pixel of the silhouette here and there.
    for (name, lab) in [("the CPU renderer", &cpu), ("the GPU renderer", &gpu)] {
        let share = different(&opengl, lab);
        assert!(share < 0.0005, "{name}: {share} of the values differ");
    }
    // Wrong twins: a lamp of 5 % more, and one 20 cm higher.
    let mut brighter = Scene::default();
    brighter.lights[0].intensity *= 1.05;
    let mut higher = Scene::default();
    higher.lights[0].position = higher.lights[0].position.map(|p| p + glam::Vec3::Y * 0.2);
    for wrong in [brighter, higher] {
        assert!(different(&opengl, &render(&wrong)) > 0.01, "a wrong twin goes unnoticed");
    }
}
