//! One evaluation of each registered model on the CPU, parameters at their defaults, over random pairs of
//! directions above the surface; the time per element is that of one evaluation.
#![allow(missing_docs)]

use std::{f32::consts::TAU, hint::black_box};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use lights_camera_models::{
    optics::{Frame, colour::Encoding},
    reflection::parameter::Values,
    registry::Registry,
};

/// Directions, uniform over the hemisphere, that neither repeat soon nor fall into order: prediction of
/// branches would make a single pair too cheap. By the golden ratio and its cubic relative.
fn pairs(frame: &Frame) -> Vec<(Vec3, Vec3)> {
    let direction = |i: usize, steps: [f64; 2]| {
        let [z, turn] = steps.map(|s| (0.5 + s * i as f64).fract() as f32);
        let (sin, cos) = (TAU * turn).sin_cos();
        let r = (1.0 - z * z).sqrt();
        r * cos * frame.t + r * sin * frame.b + z * frame.n
    };
    let pair = |i| (direction(i, [0.618_034, 0.754_878]), direction(i, [0.569_840, 0.819_173]));
    (1..=1024).map(pair).collect()
}

fn models(c: &mut Criterion) {
    let frame = Frame::from_normal(Vec3::new(0.1, 0.2, 0.9).normalize());
    let pairs = pairs(&frame);
    let mut group = c.benchmark_group("evaluations");
    group.sample_size(20).throughput(Throughput::Elements(pairs.len() as u64));
    for model in Registry::builtin().models() {
        let surface = model.instantiate(&Values::default(), Encoding::Srgb);
        group.bench_function(model.declaration.id, |b| {
            b.iter(|| {
                for (l, v) in &pairs {
                    black_box(surface.response(black_box(*l), black_box(*v), &frame));
                }
            });
        });
    }
    group.finish();
}

criterion_group!(benches, models);
criterion_main!(benches);
