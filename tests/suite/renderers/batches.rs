//! Pictures drawn in batches, because their shapes or their triangles do not fit into memory at once.

use glam::Vec3;
use lights_camera_models::{
    channel::{DebugChannel, Setting},
    optics::tone::ToneMapping,
    parameter::Value,
    progress::Progress,
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        meshes::ShapeMeshes,
    },
    scene::{Background, Light, Object, Observer, Scene},
};

use crate::helpers::pictures::close_up;

/// Different shapes that intersect, so that each batch has parts in front of and behind those of others.
fn crossing(count: usize, tone: ToneMapping, shading: &str) -> Scene {
    let object = |i: usize| {
        let turn = i as f32 * 2.4;
        let mut object = Object {
            object_type: "superellipsoid".to_owned(),
            position: Vec3::new(5.0 + turn.cos(), 5.0 + turn.sin(), 4.0 + 0.2 * (i % 5) as f32),
            size: 2.5,
            tessellation: Some(8),
            ..Object::default()
        };
        object.shape.set("vertical_exponent", Value::Number(0.4 + 0.1 * i as f32));
        object
    };
    let light = Light { position: Some(Vec3::new(3.0, 8.0, 9.0)), intensity: 60.0, ..Light::default() };
    let mut scene = Scene {
        objects: (0..count).map(object).collect(),
        lights: vec![light],
        shading_model: shading.to_owned(),
        ..Scene::default()
    };
    scene.display.tone_mapping = tone;
    scene
}

fn renderer(samples: u8, output: Output, most: Option<u64>) -> GpuRenderer {
    let mut renderer = GpuRenderer::new(96, 64, samples, output).expect("a Vulkan driver, software will do");
    if let Some(most) = most {
        meshes(&mut renderer, |meshes| meshes.limit(most, u64::MAX));
    }
    renderer
}

fn meshes<T>(renderer: &mut GpuRenderer, with: impl FnOnce(&mut ShapeMeshes) -> T) -> T {
    with(&mut renderer.app().world_mut().resource_mut::<ShapeMeshes>())
}

fn picture(renderer: &mut GpuRenderer, scene: &Scene) -> Vec<u8> {
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");
    renderer.read().expect("there is a picture")
}

#[test]
fn a_picture_in_batches_is_the_same_bit_for_bit() {
    let cases = [
        (1, Output::Display, ToneMapping::None, "phong", Background::Gradient),
        (1, Output::Display, ToneMapping::Aces, "flat", Background::Environment),
        (4, Output::Display, ToneMapping::None, "flat", Background::Environment),
        (4, Output::Display, ToneMapping::Reinhard, "phong", Background::Gradient),
        (1, Output::Linear, ToneMapping::None, "gouraud", Background::Environment),
    ];
    for (samples, output, tone, shading, background) in cases {
        let crossing = |count| {
            let mut scene = crossing(count, tone, shading);
            scene.display.background = background;
            scene
        };
        let scene = crossing(11);
        let mut whole = renderer(samples, output, None);
        let expected = picture(&mut whole, &scene);
        let all = meshes(&mut whole, |meshes| meshes.bytes());
        let mut batched = renderer(samples, output, Some(all / 4));
        let case = format!("{samples} samples, {output:?}, {tone:?}, {shading}, {background:?}");
        assert!(picture(&mut batched, &scene) == expected, "{case}");
        let left = meshes(&mut batched, |meshes| meshes.bytes());
        assert!(all > 0 && left == 0, "{case}: batches leave nothing behind");
        batched.step();
        assert!(batched.read().expect("a picture") == expected, "{case}: a frame later");

        // More pictures by the same renderer: in batches again, whole, and in batches once more.
        let again = crossing(7);
        let expected_again = picture(&mut whole, &again);
        assert!(picture(&mut batched, &again) == expected_again, "{case}: fewer");
        let few = crossing(2);
        assert!(picture(&mut batched, &few) == picture(&mut whole, &few), "{case}: without batches");
        assert!(picture(&mut batched, &scene) == expected, "{case}: again");
    }
}

/// Without a GPU, the driver keeps the triangles that it has not drawn yet, also those of a shape that all objects share.
#[test]
fn a_picture_with_few_triangles_at_once_is_the_same_bit_for_bit() {
    for (samples, output, tone, shading) in [
        (1, Output::Display, ToneMapping::None, "phong"),
        (4, Output::Display, ToneMapping::Reinhard, "gouraud"),
        (1, Output::Linear, ToneMapping::None, "flat"),
    ] {
        let mut scene = crossing(11, tone, shading);
        for object in &mut scene.objects[4..] {
            object.shape.set("vertical_exponent", Value::Number(0.7));
        }
        scene.display.background = Background::Gradient;
        let expected = picture(&mut renderer(samples, output, None), &scene);
        for (triangles, most) in [(1, None), (700, None), (700, Some(20_000))] {
            let case =
                format!("{samples} samples, {output:?}, {shading}, {triangles} triangles, {most:?} bytes");
            let mut batched = renderer(samples, output, most);
            batched.limit_triangles(triangles);
            assert!(picture(&mut batched, &scene) == expected, "{case}");
            assert_eq!(meshes(&mut batched, |meshes| meshes.bytes()), 0, "{case}: in batches");
            batched.step();
            assert!(batched.read().expect("a picture") == expected, "{case}: a frame later");
            assert!(picture(&mut batched, &scene) == expected, "{case}: again");
        }
    }
}

/// Forty spheres behind a cube, and one before it.
#[test]
fn objects_behind_a_large_one_are_not_drawn_in_batches() {
    let mut scene = crossing(0, ToneMapping::Aces, "phong");
    let sphere = |i: usize| {
        let position = Vec3::new(4.0 + 0.2 * (i % 10) as f32, 4.2 + 0.4 * (i / 10) as f32, 2.0);
        Object { position, size: 0.2, tessellation: Some(8), ..Object::default() }
    };
    let at = |z: f32, size: f32| Object { position: Vec3::new(5.0, 5.0, z), size, ..sphere(0) };
    scene.objects = (0..40).map(sphere).collect();
    scene.objects.push(Object { object_type: "cube".to_owned(), tessellation: Some(16), ..at(6.0, 4.0) });
    scene.objects.push(at(8.5, 0.3));
    scene.observer = Observer::at(Vec3::new(5.0, 5.0, 9.5), Vec3::NEG_Z);
    let mut whole = renderer(4, Output::Display, None);
    let expected = picture(&mut whole, &scene);
    let mut batched = renderer(4, Output::Display, None);
    // Enough for the cube and a sphere.
    batched.limit_triangles(4000);
    assert!(picture(&mut batched, &scene) == expected);
    assert!(meshes(&mut batched, |meshes| meshes.bytes()) > 0, "the rest is drawn in one frame");
    // They come back if the camera sees them.
    scene.observer = Observer::at(Vec3::new(5.0, 5.0, 0.5), Vec3::Z);
    let expected = picture(&mut whole, &scene);
    assert!(picture(&mut batched, &scene) == expected, "from behind");
    // What is invisible hides nothing.
    scene.observer = Observer::at(Vec3::new(5.0, 5.0, 9.5), Vec3::NEG_Z);
    scene.objects[40].visible = false;
    let expected = picture(&mut whole, &scene);
    assert!(picture(&mut batched, &scene) == expected, "without the cube");
}

/// The mean of many samples is that of frames with all objects.
#[test]
fn a_picture_whose_noise_is_measured_is_not_drawn_in_batches() {
    let mut scene = close_up("sphere", "rectangle");
    scene.objects.push(Object { size: 0.5, ..scene.objects[0].clone() });
    let mut renderer = renderer(1, Output::Display, None);
    renderer.limit_triangles(1);
    renderer.set_scene(scene);
    let reached = renderer.settle_until(Some(0.1), &Progress::NONE).expect("the GPU draws");
    assert!(reached.noise.is_some_and(|noise| noise <= 0.1), "{reached:?}");
}

#[test]
fn a_channel_in_batches_is_the_same() {
    let scene = crossing(9, ToneMapping::None, "phong");
    let setting =
        Setting::new(DebugChannel::Normals, &scene, &Registry::builtin(), scene.observer.position, None);
    let pictures = [(None, u64::MAX), (Some(20_000), u64::MAX), (None, 700)].map(|(most, triangles)| {
        let mut renderer = renderer(1, Output::Display, most);
        renderer.limit_triangles(triangles);
        let plain = picture(&mut renderer, &scene);
        renderer.set_channel(Some(setting));
        let normals = picture(&mut renderer, &scene);
        assert!(plain != normals);
        normals
    });
    assert!(pictures.iter().all(|picture| *picture == pictures[0]));
}

/// A single shape that is too large is named, and the next picture can be drawn.
#[test]
fn a_shape_that_is_too_large_alone_is_refused() {
    let mut renderer = renderer(1, Output::Display, None);
    let fine = |tessellation| {
        let mut scene = crossing(3, ToneMapping::None, "phong");
        scene.objects[1].tessellation = Some(tessellation);
        scene
    };
    let expected = picture(&mut renderer, &fine(6));
    meshes(&mut renderer, |meshes| meshes.limit(20_000, 100_000));
    renderer.set_scene(fine(128));
    let error = renderer.settle().expect_err("there is no room").to_string();
    assert!(error.contains("1 shape is not drawn") && error.contains("--renderer cpu"), "{error}");
    assert!(picture(&mut renderer, &fine(6)) == expected);
}
