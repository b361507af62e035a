//! Times of the CPU renderer, for various scenes, and their scaling.
#![allow(missing_docs, clippy::unwrap_used)]

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use lights_camera_models::{
    picture::png,
    reference::{Settings, render_rgb8},
    registry::Registry,
    scene::{Light, Object, Scene},
};

fn default_scene(c: &mut Criterion) {
    let (registry, scene) = (Registry::builtin(), Scene::default());
    let mut group = c.benchmark_group("default scene 1280x720");
    for samples in [1, 4] {
        let settings = Settings { samples, ..Settings::default() };
        group.bench_function(BenchmarkId::new("samples", samples), |b| {
            b.iter(|| render_rgb8(black_box(&scene), &registry, &settings));
        });
    }
    let settings = Settings::default();
    let rgb = render_rgb8(&scene, &registry, &settings);
    group.bench_function("png", |b| {
        b.iter(|| {
            let mut file = Vec::new();
            png::encode(&mut file, settings.width, settings.height, black_box(&rgb), &png::About::default())
                .unwrap();
            file
        });
    });
    group.finish();
}

fn objects(c: &mut Criterion) {
    let registry = Registry::builtin();
    let mut group = c.benchmark_group("objects");
    group.sample_size(10);
    for count in [1usize, 10, 100, 1000, 10_000] {
        // Spheres side by side in a cube, which together fill about the same part of the picture.
        let side = (count as f32).cbrt().ceil() as usize;
        let spheres = (0..count).map(|i| {
            let cell = Vec3::new((i % side) as f32, (i / side % side) as f32, (i / side / side) as f32);
            Object {
                position: Vec3::splat(3.5) + (cell + 0.5) * 3.0 / side as f32,
                size: 2.4 / side as f32,
                tessellation: Some(16),
                ..Object::default()
            }
        });
        let scene = Scene { objects: spheres.collect(), ..Scene::default() };
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(BenchmarkId::from_parameter(count), |b| {
            b.iter(|| render_rgb8(black_box(&scene), &registry, &Settings::default()));
        });
    }
    group.finish();
}

fn lights(c: &mut Criterion) {
    let registry = Registry::builtin();
    let mut group = c.benchmark_group("lights, Phong shading");
    group.sample_size(10);
    for count in [1usize, 16, 256] {
        let mut scene = Scene { shading_model: "phong".to_owned(), ..Scene::default() };
        scene.lights = (0..count)
            .map(|i| Light {
                position: Some(Vec3::new(1.0 + 8.0 * i as f32 / count as f32, 8.0, 9.0)),
                ..Light::default()
            })
            .collect();
        group.throughput(Throughput::Elements(count as u64));
        group.bench_function(BenchmarkId::from_parameter(count), |b| {
            b.iter(|| render_rgb8(black_box(&scene), &registry, &Settings::default()));
        });
    }
    group.finish();
}

criterion_group!(benches, default_scene, objects, lights);
criterion_main!(benches);
