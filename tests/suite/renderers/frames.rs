//! The number of frames that a picture takes.

use bevy::{
    app::{App, Last},
    camera::Camera,
    ecs::prelude::*,
};
use lights_camera_models::{
    parameter::Value,
    render::{
        camera::PictureCamera,
        capture::gpu::{GpuRenderer, Output},
    },
};

use crate::helpers::pictures::close_up;

/// The number of frames that draw a picture.
#[derive(Default, Resource)]
struct Drawn(usize);

fn count(cameras: Query<&Camera, With<PictureCamera>>, mut drawn: ResMut<Drawn>) {
    drawn.0 += cameras.iter().filter(|camera| camera.is_active).count();
}

fn counting(app: &mut App) {
    app.init_resource::<Drawn>().add_systems(Last, count);
}

#[test]
fn a_picture_takes_one_frame_and_later_ones_are_equal() {
    let ball = close_up("sphere", "point");
    let mut bright = ball.clone();
    bright.lights[0].intensity *= 2.0;
    let mut blue = bright.clone();
    blue.objects[0].material.set("base_colour", Value::Colour([60, 90, 220]));
    blue.objects[0].position.x += 0.2;
    let mut other = close_up("torus", "spot");
    other.reflection_model = "oren_nayar".to_owned();
    // A buffer and a material of a new model may take a frame each.
    let scenes = [(ball, 1), (bright, 1), (blue, 1), (other, 2)];
    for (output, samples) in [(Output::Display, 4), (Output::Display, 1), (Output::Linear, 1)] {
        let mut renderer =
            GpuRenderer::extended(96, 64, samples, output, counting).expect("software Vulkan is installed");
        let mut before = 0;
        for (i, (scene, most)) in scenes.iter().enumerate() {
            renderer.set_scene(scene.clone());
            renderer.settle().expect("the GPU draws");
            let drawn = renderer.app().world().resource::<Drawn>().0;
            let frames = drawn - before;
            assert!((1..=*most).contains(&frames), "{output:?} {samples}, scene {i}: {frames} frames");
            let picture = renderer.read().expect("the picture can be read");
            for _ in 0..3 {
                renderer.step();
            }
            let later = renderer.read().expect("the picture can be read");
            assert!(picture == later, "{output:?} {samples}, scene {i}: later frames differ");
            before = renderer.app().world().resource::<Drawn>().0;
        }
    }
}
