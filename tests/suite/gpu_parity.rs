//! The GPU's picture is the CPU renderer's picture, for every model, mode, light type and shape.

use glam::Vec3;
use lights_camera_models::{
    capture::{
        evaluate::evaluate,
        gpu::{GpuRenderer, Output},
    },
    optics::{Frame, TermSelection, colour::BACKGROUND, colour::Encoding},
    reference,
    reflection::parameter::{ParameterKind, Value, Values},
    registry::Registry,
    scene::Scene,
};

use crate::pictures::{Difference, close_up, compare};

const SIZE: u32 = 96;

fn background() -> Vec3 {
    Encoding::Srgb.decode(BACKGROUND)
}

fn cpu(scene: &Scene, terms: TermSelection) -> reference::Picture {
    let settings = reference::Settings { width: SIZE, height: SIZE, samples: 1, terms };
    reference::render(scene, &Registry::builtin(), &settings)
}

fn gpu(renderer: &mut GpuRenderer, scene: &Scene, terms: TermSelection) -> Vec<Vec3> {
    renderer.set_scene(scene.clone());
    renderer.set_terms(terms);
    renderer.settle().expect("the GPU draws");
    renderer.read_linear().expect("the picture can be read")
}

fn renderer() -> GpuRenderer {
    GpuRenderer::new(SIZE, SIZE, 1, Output::Linear).expect("software Vulkan is installed")
}

#[test]
fn every_model_mode_light_and_shape_gives_the_same_picture() {
    let registry = Registry::builtin();
    let mut renderer = renderer();
    let mut report = Vec::new();
    // Every model in every mode meets every light and every shape, in changing company: all triples would
    // be a thousand pictures. Every light meets every shape with every mode.
    let (lights, shapes) = (registry.lights(), registry.shapes());
    let mut cases = 0;
    for (i, model) in registry.models().iter().enumerate() {
        for (j, mode) in registry.modes().iter().enumerate() {
            for (k, light) in lights.iter().enumerate() {
                let shape = &shapes[(i + j + k) % shapes.len()];
                let mut scene = close_up(shape.declaration.id, light.declaration.id);
                scene.reflection_model = model.declaration.id.to_owned();
                scene.shading_model = mode.declaration.id.to_owned();
                let picture = cpu(&scene, TermSelection::All);
                let shown = gpu(&mut renderer, &scene, TermSelection::All);
                let d = compare(&shown, &picture, background(), 1e-3);
                let case = format!(
                    "{} × {} × {} × {}: {d:?}",
                    model.declaration.id, mode.declaration.id, light.declaration.id, shape.declaration.id
                );
                assert!(d.covered > 500, "hardly anything to compare: {case}");
                cases += 1;
                if d.wrong > 0 || d.edges * 50 > d.covered {
                    report.push(case);
                }
            }
        }
    }
    assert!(report.is_empty(), "{} of {cases} cases differ:\n{}", report.len(), report.join("\n"));
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
fn exposure_tone_mapping_and_gamma_naive_display_agree_to_the_last_bit_but_one() {
    use lights_camera_models::optics::tone::ToneMapping;
    let mut renderer =
        GpuRenderer::new(SIZE, SIZE, 1, Output::Display).expect("software Vulkan is installed");
    for tone in ToneMapping::ALL {
        for (exposure, encoding) in [(0.0, Encoding::Srgb), (1.5, Encoding::Srgb), (-1.0, Encoding::Off)] {
            let mut scene = close_up("sphere", "point");
            scene.shading_model = "phong".to_owned();
            scene.display.tone_mapping = tone;
            scene.display.exposure = exposure;
            scene.display.encoding = encoding;
            renderer.set_scene(scene.clone());
            renderer.settle().expect("the GPU draws");
            let g = renderer.read_rgb8().expect("the picture can be read");
            let settings =
                reference::Settings { width: SIZE, height: SIZE, samples: 1, terms: TermSelection::All };
            let c = reference::render_rgb8(&scene, &Registry::builtin(), &settings);
            let off = g.iter().zip(&c).filter(|(g, c)| g.abs_diff(**c) > 2).count();
            assert!(
                off * 100 < g.len(),
                "{tone:?} {exposure} EV {encoding:?}: {off} of {} values differ by more than 2",
                g.len()
            );
        }
    }
}

/// Values of a small deterministic generator, uniform in [0, 1).
fn random(seed: &mut u64) -> f32 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 40) as f32 / (1u64 << 24) as f32
}

fn direction(seed: &mut u64) -> Vec3 {
    let z = random(seed);
    let phi = std::f32::consts::TAU * random(seed);
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(r * phi.cos(), r * phi.sin(), z)
}

#[test]
fn the_wgsl_of_every_model_agrees_with_its_rust_function() {
    let registry = Registry::builtin();
    let mut seed = 7;
    for model in registry.models() {
        for _ in 0..8 {
            let mut values = Values::default();
            for p in model.parameters {
                let r = random(&mut seed);
                values.set(
                    p.name,
                    match p.kind {
                        ParameterKind::Number { min, max, .. } => Value::Number(min + r * (max - min)),
                        ParameterKind::Integer { min, max, slider_max, .. } => {
                            Value::Integer(min + (r * (max.unwrap_or(slider_max) - min) as f32) as i64)
                        }
                        ParameterKind::Colour { .. } => Value::Colour([
                            (255.0 * r) as u8,
                            (255.0 * random(&mut seed)) as u8,
                            (255.0 * random(&mut seed)) as u8,
                        ]),
                        ParameterKind::Triple { min, max, .. } => {
                            Value::Triple([0; 3].map(|_| min + random(&mut seed) * (max - min)))
                        }
                        ParameterKind::Choice { options, .. } => {
                            Value::Choice(options[(r * options.len() as f32) as usize].0.into())
                        }
                    },
                );
            }
            let pairs: Vec<_> = (0..2000).map(|_| (direction(&mut seed), direction(&mut seed))).collect();
            let answers = evaluate(model, &values, Encoding::Srgb, &pairs).expect("the GPU evaluates");
            let surface = model.instantiate(&values, Encoding::Srgb);
            let frame = Frame { n: Vec3::Z, t: Vec3::X, b: Vec3::Y };
            let mut wrong_twin_noticed = false;
            for ((l, v), gpu) in pairs.iter().zip(answers) {
                let cpu = surface.response(*l, *v, &frame);
                for (g, c) in
                    [(gpu.ambient, cpu.ambient), (gpu.diffuse, cpu.diffuse), (gpu.specular, cpu.specular)]
                {
                    // A response below 1e-5 is darker than any display shows.
                    let error = ((g - c).abs() / c.abs().max(Vec3::splat(1e-2))).max_element();
                    assert!(
                        error <= 1e-4,
                        "{} {values:?} l {l} v {v}: GPU {g}, CPU {c}",
                        model.declaration.id
                    );
                    let twin = ((g - c * 1.0005).abs() / c.abs().max(Vec3::splat(1e-2))).max_element();
                    wrong_twin_noticed |= twin > 1e-4;
                }
            }
            assert!(wrong_twin_noticed, "{}: 0.05 % more goes unnoticed", model.declaration.id);
        }
    }
}
