//! The GPU and the CPU renderer draw the same picture, for every model, shading model, light type and object type.

use std::sync::atomic::AtomicBool;

use bevy::{
    core_pipeline::Core3d,
    ecs::schedule::ScheduleLabel as _,
    render::{RenderApp, camera::ExtractedCamera, render_resource::TextureFormat, view::ViewTarget},
};
use glam::Vec3;
use lights_camera_models::{
    optics::{
        TermSelection,
        colour::{BACKGROUND, Encoding},
        tone::ToneMapping,
    },
    parameter::{Value, Values},
    reference::{self, LightSamples},
    registry::Registry,
    render::{
        capture::gpu::{GpuRenderer, Output},
        straight::Straight,
    },
    scene::{Display, Light, Scene},
    shader::compose::Sources,
    testing,
};

use crate::helpers::{
    pictures::{Difference, close_up, compare, on_gpu, sampled},
    support::builtin,
};

const SIZE: u32 = 96;
/// The samples of lights with extent: both renderers take the same, so few compare as well as many.
const LIGHT_SAMPLES: u32 = 16;

fn background() -> Vec3 {
    Encoding::Srgb.decode(BACKGROUND)
}

fn cpu(scene: &Scene, terms: TermSelection) -> reference::Picture {
    let settings = reference::Settings { width: SIZE, height: SIZE, samples: 1, terms };
    let (samples, odd) = (LightSamples::of(LIGHT_SAMPLES), AtomicBool::default());
    reference::render_samples(scene, &builtin(), &settings, samples, &odd)
}

fn gpu(renderer: &mut GpuRenderer, scene: &Scene, terms: TermSelection) -> Vec<Vec3> {
    renderer.set_terms(terms);
    on_gpu(renderer, scene)
}

fn renderer_of(output: Output) -> GpuRenderer {
    let mut renderer = GpuRenderer::new(SIZE, SIZE, 1, output).expect("software Vulkan is installed");
    renderer.set_light_samples(LIGHT_SAMPLES);
    renderer
}

fn renderer() -> GpuRenderer {
    renderer_of(Output::Linear)
}

/// A renderer of pictures for display.
fn displaying() -> GpuRenderer {
    renderer_of(Output::Display)
}

fn displayed(renderer: &mut GpuRenderer, scene: &Scene) -> Vec<u8> {
    renderer.set_scene(scene.clone());
    renderer.settle().expect("the GPU draws");
    renderer.read_rgb8().expect("the picture can be read")
}

#[test]
fn every_model_mode_light_and_shape_gives_the_same_picture() {
    let registry = Registry::builtin();
    let mut renderer = renderer();
    let mut report = Vec::new();
    // Every model meets every shading model, every light and every shape, in changing combinations: all would be thousands of
    // pictures. Every light meets every shape with every shading model.
    let (lights, shapes) = (registry.lights(), registry.shapes());
    let mut cases = 0;
    for (i, model) in registry.models().iter().enumerate() {
        for (j, shading) in registry.shading_models().iter().enumerate() {
            for (k, light) in lights.iter().enumerate() {
                // Each model meets each light under two shading models. Light with extent takes long: there each model meets
                // one type with one shading model, and each type meets all shading models.
                let met = match light.declaration.extent {
                    true => (i + k) % 6 == 0 && (i / 6 + k) % 4 == j,
                    false => (i + j + k) % 2 == 0,
                };
                if !met {
                    continue;
                }
                let shape = &shapes[(i + j + k) % shapes.len()];
                let mut scene = close_up(shape.declaration.id, light.declaration.id);
                scene.reflection_model = model.declaration.id.to_owned();
                scene.shading_model = shading.declaration.id.to_owned();
                if light.declaration.extent {
                    scene.lights[0].parameters.set("visible", Value::flag(false));
                }
                let picture = cpu(&scene, TermSelection::All);
                let shown = gpu(&mut renderer, &scene, TermSelection::All);
                let d = compare(&shown, &picture, background(), 1e-3);
                let case = format!(
                    "{} × {} × {} × {}: {d:?}",
                    model.declaration.id, shading.declaration.id, light.declaration.id, shape.declaration.id
                );
                assert!(d.covered > 500, "hardly anything to compare: {case}");
                cases += 1;
                // A triangle seen edge-on appears in a few pixels; the snapping of its corners determines its
                // slope to the view, and some models depend on that. The mean normals of a cube send light around in its
                // corners, where rounding decides about its way.
                let is_chaotic = model.passage(&Values::default()).solid && shape.declaration.id == "cube";
                let [wrong, edges] = if is_chaotic { [100, 20] } else { [1000, 50] };
                if d.wrong * wrong > d.covered || d.edges * edges > d.covered {
                    report.push(case);
                }
            }
        }
    }
    assert!(report.is_empty(), "{} of {cases} cases differ:\n{}", report.len(), report.join("\n"));
}

#[test]
fn every_parameter_of_a_shape_gives_the_same_picture_from_end_to_end() {
    let mut renderer = renderer();
    let mut pictures: Vec<Vec<Vec3>> = Vec::new();
    for shape in Registry::builtin().shapes() {
        for p in shape.parameters {
            for end in p.ends() {
                let mut scene = close_up(shape.declaration.id, "point");
                (scene.reflection_model, scene.shading_model) = ("phong".to_owned(), "phong".to_owned());
                scene.objects[0].shape.set(p.name, end.clone());
                let shown = gpu(&mut renderer, &scene, TermSelection::All);
                let d = compare(&shown, &cpu(&scene, TermSelection::All), background(), 1e-3);
                let case = format!("{}.{} = {end}: {d:?}", shape.declaration.id, p.name);
                assert!(
                    d.covered > 150 && d.wrong * 1000 <= d.covered && d.edges * 50 <= d.covered,
                    "{case}"
                );
                // The defaults of several parameters are one picture.
                assert!(end == p.default_value() || !pictures.contains(&shown), "{case}: nothing changed");
                pictures.push(shown);
            }
        }
    }
    assert!(pictures.len() >= 9);
}

#[test]
fn the_comparison_notices_a_wrong_twin() {
    let mut renderer = renderer();
    let mut scene = close_up("sphere", "point");
    scene.reflection_model = "phong".to_owned();
    scene.shading_model = "phong".to_owned();
    let picture = gpu(&mut renderer, &scene, TermSelection::All);
    let fails = |wrong: &Scene| {
        let d: Difference = compare(&picture, &cpu(wrong, TermSelection::All), background(), 1e-3);
        d.wrong > 0 || d.edges * 50 > d.covered
    };
    assert!(!fails(&scene), "the right twin agrees");

    let mut wrong = scene.clone();
    wrong.objects[0].material.set("alpha", Value::Integer(33));
    assert!(fails(&wrong), "an exponent of 33 for 32 goes unnoticed");
    let mut wrong = scene.clone();
    wrong.reflection_model = "blinn_phong".to_owned();
    assert!(fails(&wrong), "the half vector for the mirror direction goes unnoticed");
    let mut wrong = scene.clone();
    wrong.lights[0].intensity *= 1.003;
    assert!(fails(&wrong), "0.3 % more light goes unnoticed");
    let mut wrong = scene.clone();
    wrong.observer.position.x += 0.01;
    assert!(fails(&wrong), "an observer 1 cm beside goes unnoticed");
}

/// A ball with a light of a type in front of it, or behind it and to the side.
fn beside_a_ball(light_type: &str, before: bool) -> Scene {
    let mut scene = close_up("sphere", light_type);
    let registry = Registry::builtin();
    let declaration = registry.light(light_type).expect("built in").declaration;
    scene.shading_model = "phong".to_owned();
    let light = &mut scene.lights[0];
    light.intensity = 2.0;
    if declaration.has_position {
        light.position = Some(if before { Vec3::new(4.4, 5.5, 6.9) } else { Vec3::new(6.9, 6.0, 2.0) });
    }
    if declaration.has_direction {
        // The sun is behind the ball, next to its edge; the others shine towards the observer.
        light.direction = Some(match (light_type, before) {
            ("sun", true) => Vec3::new(-0.3, -0.2, 1.0),
            ("sun", false) => Vec3::new(0.32, 0.0, 1.0),
            // The ends are dark.
            ("cylinder", _) => Vec3::new(1.0, 0.3, 0.0),
            _ => Vec3::new(0.3, -0.2, 1.0),
        });
    }
    light.parameters.set("radius", Value::Number(0.3));
    light.parameters.set("width", Value::Number(0.7));
    light.parameters.set("height", Value::Number(0.4));
    light.parameters.set("length", Value::Number(0.9));
    light.parameters.set("diameter", Value::Number(9.0));
    scene
}

#[test]
fn lights_with_extent_are_seen_alike_before_objects_and_behind_them() {
    let registry = Registry::builtin();
    let mut renderer = renderer();
    let mut shown = 0;
    for light in registry.lights().iter().filter(|light| light.declaration.extent) {
        let id = light.declaration.id;
        for before in [true, false] {
            let scene = beside_a_ball(id, before);
            let mut hidden = scene.clone();
            hidden.lights[0].parameters.set("visible", Value::Choice("false".into()));
            let [picture, dark] = [&scene, &hidden].map(|scene| cpu(scene, TermSelection::All));
            let seen = picture.pixels.iter().zip(&dark.pixels).filter(|(a, b)| a != b).count();
            assert!(seen > 20, "{id} is hardly to be seen: {seen} pixels");
            let on_gpu = gpu(&mut renderer, &scene, TermSelection::All);
            let agrees = |scene: &Scene| {
                let d = compare(&on_gpu, &cpu(scene, TermSelection::All), background(), 2e-3);
                (d.wrong * 500 <= d.covered && d.edges * 40 <= d.covered, d)
            };
            assert!(agrees(&scene).0, "{id}, before: {before}: {:?}", agrees(&scene).1);
            // Wrong twins: the light is invisible, or elsewhere.
            let mut elsewhere = scene.clone();
            let light = &mut elsewhere.lights[0];
            light.position = light.position.map(|p| p + Vec3::X * 0.4);
            light.direction = light.direction.map(|d| d + Vec3::X * 0.1);
            light.parameters.set("rotation", Value::Number(30.0));
            for wrong in [&hidden, &elsewhere] {
                assert!(!agrees(wrong).0, "{id}, before: {before}, unnoticed: {:?}", agrees(wrong).1);
            }
            shown += 1;
        }
    }
    assert_eq!(shown, 12);
}

#[test]
fn edges_of_lights_are_smooth_where_those_of_objects_are() {
    let mut renderer =
        GpuRenderer::new(SIZE, SIZE, 4, Output::Display).expect("software Vulkan is installed");
    renderer.set_light_samples(LIGHT_SAMPLES);
    let registry = Registry::builtin();
    for id in ["disc", "cylinder", "sphere"] {
        let mut scene = beside_a_ball(id, true);
        scene.display.exposure = -2.0;
        let g = displayed(&mut renderer, &scene);
        let off = |samples| {
            let settings = reference::Settings { width: SIZE, height: SIZE, samples, ..Default::default() };
            let c = sampled(&scene, &registry, &settings, LIGHT_SAMPLES);
            g.iter().zip(&c).filter(|(g, c)| g.abs_diff(**c) > 2).count()
        };
        assert!(off(4) * 10 < off(1), "{id}: {} values differ, with one sample {}", off(4), off(1));
    }
}

#[test]
fn lights_are_seen_in_pictures_for_people_and_go_when_they_are_switched_off() {
    let mut renderer = displaying();
    let mut scene = beside_a_ball("rectangle", true);
    for (tone_mapping, encoding, exposure) in [
        (ToneMapping::None, Encoding::Srgb, -2.0),
        (ToneMapping::None, Encoding::Off, -2.0),
        (ToneMapping::Reinhard, Encoding::Srgb, 0.0),
    ] {
        scene.display = Display { tone_mapping, exposure, encoding, ..Display::default() };
        for on in [true, false, true] {
            scene.lights[0].parameters.set("visible", Value::Choice(on.to_string().into()));
            let g = displayed(&mut renderer, &scene);
            let off = |scene: &Scene| {
                let c = cpu(scene, TermSelection::All).to_rgb8(&scene.display);
                g.iter().zip(&c).filter(|(g, c)| g.abs_diff(**c) > 1).count() as f32 / g.len() as f32
            };
            assert!(off(&scene) < 0.01, "{:?}, {on}: {}", scene.display, off(&scene));
            let mut wrong = scene.clone();
            wrong.lights[0].parameters.set("visible", Value::Choice((!on).to_string().into()));
            assert!(off(&wrong) > 0.01, "{:?}, {on}: {}", scene.display, off(&wrong));
        }
    }
}

#[test]
fn terms_alone_and_many_lights_give_the_same_picture() {
    let mut renderer = renderer();
    let mut scene = close_up("torus", "point");
    for i in 0..40 {
        let mut light = scene.lights[0].clone();
        let a = i as f32 * 0.5;
        light.position = Some(Vec3::new(5.0 + 3.0 * a.cos(), 5.0 + 3.0 * a.sin(), 6.0 + 0.05 * i as f32));
        light.intensity = 0.4;
        light.colour = [(i * 6) as u8, 255 - (i * 6) as u8, 128];
        scene.lights.push(light);
    }
    scene.lights.push(close_up("torus", "ambient").lights[0].clone());
    scene.reflection_model = "blinn_phong".to_owned();
    scene.shading_model = "phong".to_owned();
    for terms in TermSelection::ALL {
        let d = compare(&gpu(&mut renderer, &scene, terms), &cpu(&scene, terms), background(), 1e-3);
        assert!(d.wrong == 0 && d.edges * 50 <= d.covered, "{terms:?}: {d:?}");
    }
}

#[test]
fn the_terms_of_models_that_light_passes_through_give_the_same_picture() {
    let mut renderer = renderer();
    let rough = ("roughness", Value::Number(0.4));
    let sheet = [
        ("transmission_weight", Value::Number(1.0)),
        ("geometry_thin_walled", Value::flag(true)),
        rough.clone(),
    ];
    let mut seen = 0;
    for (id, values) in [
        ("glass", vec![]),
        ("thin_glass", vec![rough]),
        ("diffuse_transmission", vec![]),
        ("rough_dielectric", vec![]),
        ("openpbr", sheet.to_vec()),
    ] {
        let mut scene = close_up("sphere", "rectangle");
        let mut behind = scene.lights[0].clone();
        // One lamp before the ball, one behind it, and light from everywhere.
        behind.position = behind.position.map(|p| Vec3::new(p.x, p.y, 10.0 - p.z));
        behind.direction = behind.direction.map(|d| Vec3::new(d.x, d.y, -d.z));
        scene.lights.push(behind);
        scene.lights.push(close_up("sphere", "ambient").lights[0].clone());
        scene.reflection_model = id.to_owned();
        scene.shading_model = "phong".to_owned();
        values.into_iter().for_each(|(name, value)| scene.objects[0].material.set(name, value));
        for terms in TermSelection::ALL {
            let picture = cpu(&scene, terms);
            let d = compare(&gpu(&mut renderer, &scene, terms), &picture, background(), 2e-3);
            assert!(d.wrong * 100 <= d.covered && d.edges * 20 <= d.covered, "{id}, {terms:?}: {d:?}");
            if terms == TermSelection::Transmitted {
                // The wrong twin: the sum of all terms is another picture.
                let all = gpu(&mut renderer, &scene, TermSelection::All);
                let twin = compare(&all, &picture, background(), 2e-3);
                seen += usize::from(twin.wrong * 20 > twin.covered);
            }
        }
    }
    assert!(seen >= 4, "{seen}");
}

#[test]
fn exposure_tone_mapping_and_gamma_naive_display_agree_to_the_last_bit_but_one() {
    let mut renderer = displaying();
    for (exposure, encoding) in [(0.0, Encoding::Srgb), (2.5, Encoding::Srgb), (-1.0, Encoding::Off)] {
        let mut scene = close_up("sphere", "point");
        scene.shading_model = "phong".to_owned();
        let picture = {
            scene.display.encoding = encoding;
            cpu(&scene, TermSelection::All)
        };
        for tone_mapping in ToneMapping::ALL {
            scene.display = Display { tone_mapping, exposure, encoding, ..Display::default() };
            let g = displayed(&mut renderer, &scene);
            // Values off by more than 1, and their fraction of all; the silhouette is about 0.3 %.
            let off = |twin: Display| {
                let c = picture.to_rgb8(&twin);
                let off = g.iter().zip(&c).filter(|(g, c)| g.abs_diff(**c) > 1).count();
                off as f32 / g.len() as f32
            };
            let right = off(scene.display);
            assert!(right < 0.01, "{:?}: {right} of the values differ", scene.display);
            // Wrong twins: a tenth of an EV more, and every other curve.
            let wrong = off(Display { exposure: exposure + 0.1, ..scene.display });
            assert!(wrong > 0.02, "{:?}: 0.1 EV more goes unnoticed, {wrong}", scene.display);
            for other in ToneMapping::ALL.into_iter().filter(|t| *t != tone_mapping) {
                let wrong = off(Display { tone_mapping: other, ..scene.display });
                assert!(wrong > 0.02, "{:?}: {other:?} goes unnoticed, {wrong}", scene.display);
            }
        }
    }
}

#[test]
fn light_too_bright_for_half_floats_is_white_and_not_black() {
    let mut renderer = displaying();
    let mut scene = close_up("sphere", "directional");
    scene.lights[0].intensity = 1e30;
    scene.lights[0].colour = [255; 3];
    scene.objects[0].material.set("base_colour", Value::Colour([255; 3]));
    for tone_mapping in ToneMapping::ALL {
        scene.display = Display { tone_mapping, exposure: 16.0, ..Display::default() };
        let g = displayed(&mut renderer, &scene);
        let c = cpu(&scene, TermSelection::All).to_rgb8(&scene.display);
        let middle = 3 * (SIZE * SIZE / 2 + SIZE / 2) as usize;
        assert!(g[middle..][..3].iter().all(|v| *v > 245), "{tone_mapping:?}: {:?}", &g[middle..][..3]);
        let off = g.iter().zip(&c).filter(|(g, c)| g.abs_diff(**c) > 1).count();
        assert!(off * 100 < g.len(), "{tone_mapping:?}: {off} values differ");
    }
}

#[test]
fn pictures_for_people_are_drawn_into_half_floats_where_anything_follows_and_straight_into_the_texture_else()
{
    let formats = |renderer: &mut GpuRenderer| {
        let world = renderer.app().sub_app_mut(RenderApp).world_mut();
        let targets: Vec<_> = world.query::<(&ViewTarget, &ExtractedCamera)>().iter(world).collect();
        targets.into_iter().map(|(t, c)| (t.main_texture_format(), c.schedule)).collect::<Vec<_>>()
    };
    let half_floats = [(TextureFormat::Rgba16Float, Core3d.intern())];
    let straight = [(TextureFormat::Rgba8UnormSrgb, Straight.intern())];
    let mut renderer = displaying();
    let mut scene = Scene::default();
    for (tone_mapping, expected) in [
        (ToneMapping::None, straight),
        (ToneMapping::Reinhard, half_floats),
        (ToneMapping::KhronosPbrNeutral, half_floats),
        (ToneMapping::None, straight),
    ] {
        scene.display.tone_mapping = tone_mapping;
        displayed(&mut renderer, &scene);
        assert_eq!(formats(&mut renderer), expected, "{tone_mapping:?}");
    }
    // The mean of four samples is taken over light, not over what the display can show of it.
    let mut renderer =
        GpuRenderer::new(SIZE, SIZE, 4, Output::Display).expect("software Vulkan is installed");
    displayed(&mut renderer, &Scene::default());
    assert_eq!(formats(&mut renderer), half_floats);
}

/// The opacity of pixels drawn directly into the texture marks clipping.
#[test]
fn straight_pictures_mark_what_is_cut_off() {
    for encoding in [Encoding::Srgb, Encoding::Off] {
        let mut scene = close_up("sphere", "point");
        scene.shading_model = "phong".to_owned();
        scene.display = Display { exposure: 2.0, encoding, ..Display::default() };
        let mut renderer = displaying();
        displayed(&mut renderer, &scene);
        let straight = renderer.read().expect("the picture can be read");
        let picture = cpu(&scene, TermSelection::All);
        let (mut marked, mut wrong) = (0, 0);
        for (pixel, light) in straight.chunks_exact(4).zip(&picture.pixels) {
            let cut_off = (light.truncate() * 4.0).max_element() > 1.0005;
            marked += usize::from(cut_off);
            wrong += usize::from(cut_off != (pixel[3] == 254));
            assert!(pixel[3] == 255 || pixel[3] == 254 && pixel[..3].contains(&255), "{pixel:?}");
        }
        // At the silhouette and at the threshold.
        assert!(marked > 100 && wrong * 50 < marked, "{encoding:?}: {wrong} of {marked}");
    }
}

#[test]
fn lights_in_lumen_and_kelvin_give_the_same_picture() {
    let mut renderer = renderer();
    for kind in ["point", "spot"] {
        let mut scene = close_up("sphere", kind);
        scene.shading_model = "phong".to_owned();
        scene.lights[0].luminous_flux = Some(100.0);
        scene.lights[0].colour_temperature = Some(2700.0);
        let picture = gpu(&mut renderer, &scene, TermSelection::All);
        let right = compare(&picture, &cpu(&scene, TermSelection::All), background(), 1e-3);
        assert!(right.wrong == 0 && right.covered > 500, "{kind}: {right:?}");
        for change in [
            |light: &mut Light| light.luminous_flux = Some(101.0),
            |light: &mut Light| light.colour_temperature = Some(2710.0),
            |light: &mut Light| light.colour_temperature = None,
        ] {
            let mut wrong = scene.clone();
            change(&mut wrong.lights[0]);
            let wrong = compare(&picture, &cpu(&wrong, TermSelection::All), background(), 1e-3);
            assert!(wrong.wrong > 0, "{kind}: a wrong twin goes unnoticed");
        }
    }
}

#[test]
fn the_wgsl_of_every_model_agrees_with_its_rust_function() {
    for model in Registry::builtin().models() {
        assert_eq!(testing::gpu::on_gpu(model, &Sources::default()), Ok(()), "{}", model.declaration.id);
    }
}

#[test]
fn at_the_ends_of_all_ranges_both_languages_are_finite_and_agree() {
    let mut seed = testing::gpu::SEED_OF_ENDS;
    // As many numbers as six directions need.
    for _ in 0..6 {
        testing::direction(&mut seed);
    }
    for model in Registry::builtin().models() {
        let outcome = testing::gpu::at_the_ends(model, &Sources::default(), &mut seed);
        assert_eq!(outcome, Ok(()), "{}", model.declaration.id);
    }
}
