//! Times of explaining a pixel, as the window does for the pointer.
#![allow(missing_docs, clippy::unwrap_used)]

use std::{cell::Cell, hint::black_box, path::Path};

use criterion::{Criterion, criterion_group, criterion_main};
use glam::Vec3;
use lights_camera_models::{
    explain::Explainer,
    reference::Settings,
    registry::Registry,
    scene::{
        Object, Scene,
        load::{self, Defaults},
    },
};

fn example(name: &str, registry: &Registry) -> Scene {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name);
    load::file(&file, registry, Defaults::Use).unwrap().scene
}

/// Ten thousand spheres side by side in a cube.
fn crowd() -> Scene {
    let spheres = (0..10_000usize).map(|i| {
        let cell = Vec3::new((i % 22) as f32, (i / 22 % 22) as f32, (i / 484) as f32);
        Object {
            position: Vec3::splat(3.5) + (cell + 0.5) * 3.0 / 22.0,
            size: 2.4 / 22.0,
            tessellation: Some(16),
            ..Object::default()
        }
    });
    Scene { objects: spheres.collect(), ..Scene::default() }
}

/// The pointer moves over the middle of a picture of 1280×720.
fn pixels(c: &mut Criterion) {
    let registry = Registry::builtin();
    // Under two directional lights and an ambient one.
    let lights = example("gouraud_misses_highlight.json", &registry).lights;
    let teapot = Scene { lights, ..example("portrait.json", &registry) };
    let gouraud = Scene { shading_model: "gouraud".to_owned(), ..teapot.clone() };
    let scenes = [
        ("default", Scene::default()),
        ("teapot, Phong shading", teapot),
        ("teapot, Gouraud shading", gouraud),
        ("240 lights", example("many_lights.json", &registry)),
        ("matrix of models", example("model_matrix.json", &registry)),
        ("10 000 spheres", crowd()),
    ];
    let settings = Settings { width: 1280, height: 720, samples: 1, ..Settings::default() };
    let mut group = c.benchmark_group("explain");
    for (name, scene) in scenes {
        let mut explainer = Explainer::default();
        let step = Cell::new(0u32);
        let at = || {
            step.set((step.get() + 7) % 400);
            [440 + step.get(), 300 + step.get() % 120]
        };
        // The meshes are made once.
        explainer.pixel(&scene, &registry, &settings, at()).unwrap();
        group.bench_function(name, |b| {
            b.iter(|| explainer.pixel(black_box(&scene), &registry, &settings, at()).unwrap());
        });
    }
    group.finish();
}

criterion_group!(benches, pixels);
criterion_main!(benches);
