//! Light with extent on the CPU renderer: the first picture after a change, and the samples after it. For
//! comparison, the same scenes under point lights, which light with extent must not slow down.
#![allow(missing_docs)]

use std::{hint::black_box, sync::atomic::AtomicBool};

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::Vec3;
use lights_camera_models::{
    reference::{LightSamples, Settings, render_samples},
    registry::Registry,
    scene::{Light, Scene},
};

const SETTINGS: Settings = Settings {
    width: 1280,
    height: 720,
    samples: 1,
    terms: lights_camera_models::optics::TermSelection::All,
};

/// The default scene with Phong shading under one light.
fn lit_by(kind: &str, registry: &Registry) -> Scene {
    let mut scene = Scene { shading_model: "phong".to_owned(), ..Scene::default() };
    let mut light = Light { position: Some(Vec3::new(7.0, 8.0, 7.0)), ..scene.lights[0].clone() };
    light.set_type(registry.light(kind).expect("built in"), registry, scene.scene_size);
    light.direction = Some(Vec3::new(-2.0, -3.0, -2.0));
    scene.lights = vec![light];
    scene
}

/// Each light type, the first picture after a change.
fn first_picture(c: &mut Criterion) {
    let (registry, odd) = (Registry::builtin(), AtomicBool::default());
    let mut group = c.benchmark_group("first picture 1280x720");
    group.sample_size(20);
    for kind in ["point", "rectangle", "disc", "sphere", "cylinder", "sun", "environment"] {
        let scene = lit_by(kind, &registry);
        group.bench_function(BenchmarkId::from_parameter(kind), |b| {
            b.iter(|| render_samples(black_box(&scene), &registry, &SETTINGS, LightSamples::of(1), &odd));
        });
    }
    group.finish();
}

/// The models, under a softbox.
fn models(c: &mut Criterion) {
    let (registry, odd) = (Registry::builtin(), AtomicBool::default());
    let mut group = c.benchmark_group("16 samples of a rectangle 1280x720");
    group.sample_size(10);
    for model in ["lambert", "blinn_phong", "microfacet", "disney", "openpbr"] {
        let scene = Scene { reflection_model: model.to_owned(), ..lit_by("rectangle", &registry) };
        group.bench_function(BenchmarkId::from_parameter(model), |b| {
            b.iter(|| render_samples(black_box(&scene), &registry, &SETTINGS, LightSamples::of(16), &odd));
        });
    }
    group.finish();
}

criterion_group!(benches, first_picture, models);
criterion_main!(benches);
