//! Pictures of light with extent converge in views to those of the CPU renderer, and then rest.

use std::sync::atomic::AtomicBool;

use bevy::{ecs::entity::Entity, prelude::Transform};
use lights_camera_models::{
    optics::colour::Encoding,
    progress::Progress,
    reference::{self, Settings, Until},
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        converge::{Converged, Convergence},
        noise::Noise,
        view::{Drawing, View},
    },
    scene::Scene,
};

use crate::helpers::pictures::close_up;

const SIZE: u32 = 64;

fn scene(light: &str, shading: &str) -> Scene {
    Scene { shading_model: shading.to_owned(), ..close_up("sphere", light) }
}

/// A renderer with one view that is drawn when something changes.
fn renderer(scene: &Scene) -> GpuRenderer {
    let mut renderer =
        GpuRenderer::new(SIZE, SIZE, 1, Output::Display).expect("software Vulkan is installed");
    renderer.draw_on_demand();
    renderer.set_scene(scene.clone());
    renderer
}

fn drawing(renderer: &mut GpuRenderer) -> Drawing {
    let world = renderer.app().world_mut();
    world.query::<&Drawing>().iter(world).next().expect("there is a view").clone()
}

/// The picture of a view.
fn picture(renderer: &mut GpuRenderer) -> Vec<u8> {
    let world = renderer.app().world_mut();
    let target = world
        .query_filtered::<&bevy::camera::RenderTarget, bevy::ecs::prelude::With<View>>()
        .iter(world)
        .next()
        .expect("there is a view")
        .clone();
    let texture = lights_camera_models::render::view::texture_of(&target).expect("it has a texture").clone();
    renderer.read_view(&texture).expect("the picture can be read")
}

/// Draws frames until the view rests, and returns their number.
fn converge(renderer: &mut GpuRenderer) -> u32 {
    for frames in 1..400 {
        renderer.step();
        if drawing(renderer).rests() {
            return frames;
        }
    }
    panic!("it never rests: {:?}", drawing(renderer));
}

/// The number of pixels with a channel that differs by more than 2 of 255.
fn differing(a: &[u8], b: &[u8]) -> usize {
    let pairs = a.chunks_exact(4).zip(b.chunks_exact(3));
    pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 2)).count()
}

#[test]
fn a_converged_picture_is_that_of_the_cpu_renderer() {
    let registry = Registry::builtin();
    let settings = Settings { width: SIZE, height: SIZE, samples: 1, ..Settings::default() };
    for (light, shading, encoding) in [
        ("rectangle", "phong", Encoding::Srgb),
        ("sphere", "gouraud", Encoding::Srgb),
        ("rectangle", "gouraud", Encoding::Off),
        ("sphere", "phong", Encoding::Off),
    ] {
        let mut scene = scene(light, shading);
        scene.display.encoding = encoding;
        let what = format!("{light}, {shading}, {encoding:?}");
        let expected = reference::render_rgb8(&scene, &registry, &settings);
        let mut renderer = renderer(&scene);
        // The first is without meshes, the second without anything that the renderer could not prepare: both
        // start again.
        for _ in 0..3 {
            renderer.step();
        }
        let first = picture(&mut renderer);
        assert_eq!(drawing(&mut renderer).converged(), Converged { done: 1, total: 256 }, "{what}");
        assert!(first.chunks_exact(4).any(|pixel| pixel[..3] != first[..3]), "{what}: it shows a picture");
        converge(&mut renderer);
        assert!(drawing(&mut renderer).converged().is_done());
        let converged = picture(&mut renderer);
        let differ = differing(&converged, &expected);
        assert!(1000 * differ <= (SIZE * SIZE) as usize, "{what}: {differ} pixels differ");
        // The first differs where there is noise, or else this would prove nothing. A globe has hardly any.
        if (light, shading) == ("rectangle", "phong") {
            assert!(differing(&first, &expected) > 40, "{what}");
        }
    }
}

#[test]
fn a_converged_view_rests_until_something_changes_and_begins_again_then() {
    let mut renderer = renderer(&scene("rectangle", "phong"));
    converge(&mut renderer);
    let (picture_before, drawn) = (picture(&mut renderer), drawing(&mut renderer).drawn());
    for _ in 0..5 {
        renderer.step();
    }
    assert_eq!(drawing(&mut renderer).drawn(), drawn, "a view that rests draws nothing");
    assert_eq!(picture(&mut renderer), picture_before);
    let world = renderer.app().world_mut();
    let mut cameras = world.query_filtered::<
        (&mut lights_camera_models::render::camera::PictureCamera, &mut Transform),
        bevy::ecs::prelude::With<View>,
    >();
    for (mut camera, mut place) in cameras.iter_mut(world) {
        camera.follows_observer = false;
        place.translation.x += 0.25;
    }
    for _ in 0..2 {
        renderer.step();
        assert_eq!(drawing(&mut renderer).converged(), Converged { done: 1, total: 256 });
    }
    converge(&mut renderer);
    assert_ne!(picture(&mut renderer), picture_before);
    // Without such light there is nothing to converge.
    renderer.set_scene(scene("point", "phong"));
    renderer.step();
    assert_eq!(drawing(&mut renderer).converged(), Converged::default());
    assert!(converge(&mut renderer) < 8);
}

#[test]
fn the_noise_of_a_picture_is_measured_as_it_converges() {
    let scene = scene("rectangle", "phong");
    let mut renderer = renderer(&scene);
    // By default the number of samples in a frame depends on the machine.
    renderer.app().world_mut().resource_mut::<Convergence>().pace = Some(8);
    let mut told = Vec::new();
    let now = |renderer: &mut GpuRenderer| {
        let world = renderer.app().world_mut();
        let (view, drawing) =
            world.query::<(Entity, &Drawing)>().iter(world).next().expect("there is a view");
        let noise = world.resource::<Noise>();
        (drawing.converged().done, noise.of(view, drawing), noise.is_awaited(view, drawing))
    };
    for _ in 0..400 {
        renderer.step();
        renderer.wait();
        if let (done, Some(noise), _) = now(&mut renderer)
            && told.last().is_none_or(|(_, last)| *last != noise)
        {
            told.push((done, noise));
        }
        if drawing(&mut renderer).rests() && !now(&mut renderer).2 {
            break;
        }
    }
    let (first, last) = (told[0], *told.last().expect("it is told"));
    assert!(first.0 <= Until::FEWEST_FOR_NOISE + 8 && last.0 == 256, "{told:?}");
    assert!(last.1 < 0.5 * first.1, "{told:?}");
    // The CPU renderer estimates it from the same blocks of 16 samples. Frames of 1 to 8, which are distributed less
    // evenly, would have several times the noise.
    let settings = Settings { width: SIZE, height: SIZE, samples: 1, ..Settings::default() };
    let (registry, odd) = (Registry::builtin(), AtomicBool::default());
    let until = Until::default();
    let (_, reached) = reference::render_until(&scene, &registry, &settings, until, &odd, &Progress::NONE)
        .expect("nobody cancels");
    let ratio = last.1 / reached.noise.expect("enough blocks");
    assert!((0.8..1.25).contains(&ratio), "{ratio} {reached:?}");
    // A change starts again, without traces of the previous state.
    let world = renderer.app().world_mut();
    world.query::<&mut Drawing>().iter_mut(world).for_each(|mut drawing| drawing.redraw());
    renderer.step();
    assert_eq!(now(&mut renderer).1, None);
}
