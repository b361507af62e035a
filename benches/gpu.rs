//! Frames of the GPU renderer at 1280×720, one sample per pixel: against a frame of the same app with
//! nothing in the room, and over objects and lights.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use glam::Vec3;
use lights_camera_models::{
    capture::gpu::{GpuRenderer, Output},
    scene::{Light, Object, Observer, Scene},
};

fn renderer(scene: Scene) -> GpuRenderer {
    let mut renderer =
        GpuRenderer::new(1280, 720, 1, Output::Display).expect("a Vulkan driver, software will do");
    renderer.set_scene(scene);
    renderer.settle().expect("the GPU draws");
    renderer
}

/// A frame, waited for: submitting alone would measure the queue.
fn frame(renderer: &mut GpuRenderer) {
    renderer.step();
    renderer.wait();
}

/// Objects on a grid that fills the picture, so that the covered area stays nearly the same.
fn grid(count: usize) -> Scene {
    let side = (count as f32).sqrt().ceil();
    let objects = (0..count)
        .map(|i| {
            let (x, y) = (i as f32 % side, (i as f32 / side).floor());
            Object {
                position: Vec3::new((x + 0.5) * 10.0 / side, (y + 0.5) * 10.0 / side, 1.0),
                size: 8.0 / side,
                tessellation: Some(8),
                ..Object::default()
            }
        })
        .collect();
    let observer =
        Observer { position: Vec3::new(5.0, 5.0, 9.9), field_of_view: 60.0, ..Observer::default() };
    Scene { objects, observer, ..Scene::default() }
}

fn lit(count: usize) -> Scene {
    let lights = (0..count)
        .map(|i| Light {
            position: Some(Vec3::new(1.0 + i as f32 * 0.03, 8.0, 8.0)),
            intensity: 1.0,
            ..Light::default()
        })
        .collect();
    Scene { lights, shading_model: "phong".to_owned(), ..Scene::default() }
}

fn frames(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("frame");
    group.sample_size(20);
    let mut empty = renderer(Scene { objects: Vec::new(), lights: Vec::new(), ..Scene::default() });
    group.bench_function("empty room", |b| b.iter(|| frame(&mut empty)));
    drop(empty);
    let mut default = renderer(Scene::default());
    group.bench_function("default scene", |b| b.iter(|| frame(&mut default)));
    drop(default);
    for count in [1, 100, 1000, 10_000] {
        let mut renderer = renderer(grid(count));
        group.bench_function(BenchmarkId::new("objects", count), |b| b.iter(|| frame(&mut renderer)));
    }
    for count in [1, 16, 256] {
        let mut renderer = renderer(lit(count));
        group.bench_function(BenchmarkId::new("lights, Phong shading", count), |b| {
            b.iter(|| frame(&mut renderer))
        });
    }
    group.finish();
}

criterion_group!(benches, frames);
criterion_main!(benches);
