//! Backgrounds that a scene gives: both renderers show them alike and as they are picked, and nothing else changes.

use std::sync::atomic::AtomicBool;

use bevy::{camera::RenderTarget, ecs::prelude::With};
use glam::Vec3;
use lights_camera_models::{
    channel::{DebugChannel, Setting},
    optics::{colour::Encoding, tone::ToneMapping},
    parameter::Value,
    reference::{self, LightSamples, Settings, render_channel, render_rgb8},
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        view::{View, texture_of},
    },
    scene::{Background, Display, Light, Scene},
};

use crate::helpers::{
    pictures::{close_up, sampled},
    support::{builtin, changed, full_scene, read, written},
};

const SIZE: u32 = 96;
const TOP: [u8; 3] = [250, 244, 226];
const BOTTOM: [u8; 3] = [60, 90, 140];

fn settings(samples: u32) -> Settings {
    Settings { width: SIZE, height: SIZE, samples, ..Settings::default() }
}

fn renderer(samples: u8, output: Output) -> GpuRenderer {
    GpuRenderer::new(SIZE, SIZE, samples, output).expect("software Vulkan is installed")
}

fn on_gpu(renderer: &mut GpuRenderer, scene: &Scene) -> Vec<u8> {
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");
    renderer.read_rgb8().expect("the picture can be read")
}

fn on_cpu(scene: &Scene, samples: u32) -> Vec<u8> {
    reference::render(scene, &builtin(), &settings(samples)).to_rgb8(&scene.display)
}

/// A ball in front of a background.
fn ball(background: Background) -> Scene {
    let mut scene = close_up("sphere", "point");
    scene.shading_model = "phong".to_owned();
    scene.display =
        Display { background, background_colour: TOP, background_bottom: BOTTOM, ..Display::default() };
    scene
}

/// The fraction of values that differ by more than some codes.
fn off(a: &[u8], b: &[u8], codes: u8) -> f32 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).filter(|(a, b)| a.abs_diff(**b) > codes).count() as f32 / a.len() as f32
}

#[test]
fn both_renderers_show_a_background_alike_under_every_curve() {
    for samples in [1, 4] {
        let mut renderer = renderer(samples, Output::Display);
        for background in [Background::Colour, Background::Gradient] {
            for tone_mapping in ToneMapping::ALL {
                let encoding = Encoding::ALL[usize::from(tone_mapping == ToneMapping::Reinhard)];
                let mut scene = ball(background);
                scene.display = Display { tone_mapping, encoding, exposure: 1.0, ..scene.display };
                let case = format!("{samples}, {background:?}, {tone_mapping:?}");
                let gpu = on_gpu(&mut renderer, &scene);
                let right = off(&gpu, &on_cpu(&scene, samples.into()), 1 + u8::from(samples > 1));
                // At edges the renderers weight the samples of a pixel differently.
                assert!(right < 0.015, "{case}: {right}");
                // As it is picked, at the corners of the picture.
                let down = (SIZE as f32 - 0.5) / SIZE as f32;
                let ends = [scene.display.behind(0.5 / SIZE as f32), scene.display.behind(down)];
                let ends = ends.map(|light| Encoding::Srgb.encode(light.expect("it is given")));
                for (corner, expected) in [&gpu[..3], &gpu[gpu.len() - 3..]].into_iter().zip(ends) {
                    let is_near = corner.iter().zip(expected).all(|(a, b)| a.abs_diff(b) <= 1);
                    let exact = background == Background::Gradient || corner == expected;
                    assert!(is_near && exact, "{case}: {corner:?}, not {expected:?}");
                }
                // Wrong twins: another background, and a little exposure, which the background does not follow.
                for wrong in [
                    Display { background: Background::Environment, ..scene.display },
                    Display { background_colour: [240, 244, 226], ..scene.display },
                    Display { exposure: 1.3, ..scene.display },
                ] {
                    let wrong = on_cpu(&Scene { display: wrong, ..scene.clone() }, samples.into());
                    assert!(off(&gpu, &wrong, 2) > 0.02, "{case}: a wrong twin goes unnoticed");
                }
            }
        }
    }
}

#[test]
fn the_light_of_a_picture_is_drawn_over_the_background_in_linear_light() {
    let mut renderer = renderer(1, Output::Linear);
    let scene = ball(Background::Gradient);
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");
    let gpu = renderer.read_linear().expect("the picture can be read");
    let cpu = reference::render(&scene, &Registry::builtin(), &settings(1));
    let (mut covered, mut wrong) = (0, 0);
    for (i, (gpu, cpu)) in gpu.iter().zip(&cpu.pixels).enumerate() {
        let down = ((i as u32 / SIZE) as f32 + 0.5) / SIZE as f32;
        let behind = scene.display.behind(down).expect("it is given");
        let expected = if cpu.w > 0.0 { cpu.truncate() } else { behind };
        covered += usize::from(cpu.w > 0.0);
        wrong += usize::from((*gpu - expected).abs().max_element() > 1e-3 * expected.max_element().max(0.1));
    }
    assert!((1000..8000).contains(&covered) && wrong * 100 < covered, "{wrong} of {covered}");
}

/// A disc near the observer, a studio all around, and the sun behind the ball, all to be seen.
fn among_lights(background: Background) -> Scene {
    let registry = Registry::builtin();
    let mut scene = ball(background);
    let light = |id: &str| {
        let mut light = scene.lights[0].clone();
        light.set_type(registry.light(id).expect("built in"), &registry, scene.scene_size);
        light
    };
    let disc = Light {
        position: Some(Vec3::new(4.4, 5.5, 6.9)),
        direction: Some(Vec3::new(0.3, -0.2, 1.0)),
        intensity: 1.0,
        ..light("disc")
    };
    let sun = Light { direction: Some(Vec3::new(0.32, 0.0, 1.0)), intensity: 1.0, ..light("sun") };
    let studio = Light { intensity: 0.02, ..light("environment") };
    scene.lights = vec![disc, sun, studio];
    scene.lights[0].parameters.set("radius", Value::Number(0.3));
    scene.lights[1].parameters.set("diameter", Value::Number(9.0));
    scene
}

#[test]
fn it_stands_in_place_of_light_at_infinity_and_behind_lamps_that_are_near() {
    let registry = Registry::builtin();
    let mut renderer = renderer(1, Output::Display);
    renderer.set_light_samples(8);
    // What is covered does not depend on samples of light.
    let seen = |scene: &Scene| {
        let (samples, odd) = (LightSamples::of(1), AtomicBool::default());
        let picture = reference::render_samples(scene, &registry, &settings(1), samples, &odd);
        picture.pixels.iter().filter(|pixel| pixel.w > 0.0).count()
    };
    let all = among_lights(Background::Environment);
    assert_eq!(seen(&all), (SIZE * SIZE) as usize, "the studio is everywhere");
    for background in [Background::Colour, Background::Gradient] {
        for tone_mapping in [ToneMapping::None, ToneMapping::Reinhard] {
            let mut scene = among_lights(background);
            scene.display.tone_mapping = tone_mapping;
            let mut alone = scene.clone();
            alone.lights.truncate(1);
            let mut dark = alone.clone();
            dark.lights[0].parameters.set("visible", Value::flag(false));
            assert!(seen(&scene) == seen(&alone) && seen(&alone) > seen(&dark) + 100, "{background:?}");
            let gpu = on_gpu(&mut renderer, &scene);
            let cpu = sampled(&scene, &registry, &settings(1), 8);
            assert!(off(&gpu, &cpu, 2) < 0.01, "{background:?} {tone_mapping:?}: {}", off(&gpu, &cpu, 2));
            // The wrong twin: the environment is seen.
            let display = Display { background: Background::Environment, ..scene.display };
            let wrong = sampled(&Scene { display, ..scene }, &registry, &settings(1), 8);
            assert!(off(&gpu, &wrong, 2) > 0.2, "{background:?} {tone_mapping:?}");
        }
    }
}

#[test]
fn it_is_no_light_and_no_part_of_channels() {
    let registry = Registry::builtin();
    let light = |background| reference::render(&ball(background), &registry, &settings(4));
    assert_eq!(light(Background::Gradient), light(Background::Environment));
    let mut renderer = renderer(1, Output::Display);
    for channel in [DebugChannel::Normals, DebugChannel::Depth, DebugChannel::Wireframe] {
        let [with, without] = [Background::Gradient, Background::Environment].map(|background| {
            let scene = ball(background);
            let setting = Setting::new(channel, &scene, &registry, scene.observer.position, None);
            renderer.set_channel(Some(setting));
            let cpu = render_channel(&scene, &registry, &settings(1), &setting);
            (on_gpu(&mut renderer, &scene), cpu)
        });
        assert!(with == without, "{channel:?}");
    }
    // The picture comes back with it.
    renderer.set_channel(None);
    assert_eq!(on_gpu(&mut renderer, &ball(Background::Colour))[..3], TOP);
}

#[test]
fn a_gradient_reaches_from_edge_to_edge_at_every_size() {
    let registry = Registry::builtin();
    let mut scene = ball(Background::Gradient);
    scene.objects[0].visible = false;
    // The height is no multiple of the size of a tile.
    let rows = |height: u32| {
        let settings = Settings { width: 37, height, ..settings(4) };
        let codes = render_rgb8(&scene, &registry, &settings);
        let picture = reference::render(&scene, &registry, &settings);
        assert!(codes == picture.to_rgb8(&scene.display), "{height}");
        let rows: Vec<_> = codes.chunks_exact(3 * 37).map(|row| [row[0], row[1], row[2]]).collect();
        assert!(codes.chunks_exact(3 * 37).all(|row| row.chunks_exact(3).all(|p| p == &row[..3])));
        rows
    };
    let (low, high) = (rows(61), rows(2 * 61));
    for (row, pair) in low.iter().zip(high.chunks_exact(2)) {
        for channel in 0..3 {
            let [above, below] = [pair[0][channel], pair[1][channel]];
            let ends = above.min(below).saturating_sub(1)..=above.max(below).saturating_add(1);
            assert!(ends.contains(&row[channel]), "{row:?} {pair:?}");
        }
    }
    let near = |a: [u8; 3], b: [u8; 3]| (0..3).all(|channel| a[channel].abs_diff(b[channel]) <= 2);
    assert!(near(high[0], TOP) && near(high[121], BOTTOM), "{:?} {:?}", high[0], high[121]);
    // A ball in front of it, in both ways of making the codes.
    scene.objects[0].visible = true;
    let settings = Settings { width: 97, height: 61, ..settings(4) };
    let picture = reference::render(&scene, &registry, &settings);
    assert!(render_rgb8(&scene, &registry, &settings) == picture.to_rgb8(&scene.display));
}

#[test]
fn a_view_follows_the_background_and_so_do_pictures_that_converge() {
    let mut renderer = renderer(1, Output::Display);
    renderer.draw_on_demand();
    renderer.set_light_samples(8);
    let mut scene = close_up("sphere", "rectangle");
    scene.lights[0].parameters.set("visible", Value::flag(false));
    for tone_mapping in [ToneMapping::None, ToneMapping::Reinhard] {
        for (background, colour, expected) in [
            (Background::Environment, TOP, None),
            (Background::Colour, TOP, Some(TOP)),
            (Background::Colour, BOTTOM, Some(BOTTOM)),
        ] {
            scene.display =
                Display { tone_mapping, background, background_colour: colour, ..Display::default() };
            renderer.set_scene(scene.clone());
            (0..40).for_each(|_| renderer.step());
            let world = renderer.app().world_mut();
            let mut targets = world.query_filtered::<&RenderTarget, With<View>>();
            let texture = targets.iter(world).find_map(|target| texture_of(target).cloned());
            let gpu = renderer.read_view(&texture.expect("it has a texture")).expect("it can be read");
            let cpu = sampled(&scene, &Registry::builtin(), &settings(1), 8);
            let gpu: Vec<u8> = gpu.chunks_exact(4).flat_map(|pixel| &pixel[..3]).copied().collect();
            let case = format!("{tone_mapping:?} {background:?}: {:?}", &gpu[..3]);
            assert!(off(&gpu, &cpu, 2) < 0.02, "{case}: {}", off(&gpu, &cpu, 2));
            assert!(expected.is_none_or(|expected| gpu[..3] == expected), "{case}");
        }
    }
}

#[test]
fn a_scene_without_a_background_is_read_and_written_as_before() {
    let text = changed(|scene| {
        let display = scene["display"].as_object_mut().expect("an object");
        display.retain(|key, _| !key.starts_with("background"));
    });
    let scene = read(&text);
    assert_eq!(scene.display.backdrop(), None);
    assert!(!written(&scene).contains("background"));
    // What is given is written.
    let given = read(&full_scene().to_string());
    assert_eq!(given.display.backdrop(), Some([[240, 244, 250], [90, 100, 120]]));
    let again = written(&given);
    assert!(
        again.contains("\"background\": \"gradient\"")
            && again.contains("\"background_bottom\": [90, 100, 120]")
    );
    // The colours of another choice are kept.
    let mut other = given.clone();
    other.display.background = Background::Environment;
    assert_eq!(read(&written(&other)), other);
}
