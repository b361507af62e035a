//! One evaluation of each registered model on the CPU, parameters at their defaults, over random pairs of
//! directions above the surface; the time per element is that of one evaluation.
#![allow(missing_docs)]

use std::{f32::consts::TAU, hint::black_box};

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::Vec3;
use lights_camera_models::{
    optics::{Frame, colour::Encoding},
    parameter::{Values, words},
    registry::{
        Registry,
        compose::{compose, compose_evaluation},
    },
    scene::examples::looks,
    shader::{
        check::validate,
        compose::{Composed, Sources},
        interpret::Program,
        limits::{check_module, check_text},
    },
};

/// Directions, uniform over the hemisphere, that neither repeat soon nor are ordered: branch prediction would
/// make a single pair too cheap. Based on the golden ratio and its cubic relative.
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
    let registry = Registry::builtin();
    let mut all: Vec<_> =
        registry.models().iter().map(|m| (m.declaration.id.to_owned(), m, Values::default())).collect();
    // Disabled layers cost nothing.
    for look in looks() {
        let model = registry.model(&look.model).expect("built in");
        all.push((format!("{}, {}", look.model, look.name), model, look.material.clone()));
    }
    for (name, model, values) in all {
        let surface = model.instantiate(&values, Encoding::Srgb);
        group.bench_function(name, |b| {
            b.iter(|| {
                for (l, v) in &pairs {
                    black_box(surface.response(black_box(*l), black_box(*v), &frame));
                }
            });
        });
    }
    group.finish();
}

/// The model's WGSL, interpreted, for the same pairs.
fn interpreted(c: &mut Criterion) {
    let frame = Frame::from_normal(Vec3::new(0.1, 0.2, 0.9).normalize());
    let pairs = pairs(&frame);
    let registry = Registry::builtin();
    let mut group = c.benchmark_group("evaluations, interpreted WGSL");
    group.sample_size(20).throughput(Throughput::Elements(pairs.len() as u64));
    for id in ["phong", "disney", "microfacet"] {
        let model = registry.model(id).expect("built in");
        let values = Values::default();
        let module = validate(&compose_evaluation(&Sources::default(), model)).expect("valid WGSL");
        let program = Program::with_table(&module, "response", "parameter_table").expect("supported");
        let row: Vec<_> = model
            .row(&values, Encoding::Srgb, false)
            .chunks_exact(4)
            .map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .collect();
        let mut arguments = vec![0; 6];
        arguments.extend([frame.n, frame.t, frame.b].iter().flat_map(|v| v.to_array().map(f32::to_bits)));
        arguments.extend(words(model.parameters, &values, Encoding::Srgb));
        let mut terms = [0; 9];
        group.bench_function(id, |b| {
            b.iter(|| {
                for (l, v) in &pairs {
                    arguments[..3].copy_from_slice(&l.to_array().map(f32::to_bits));
                    arguments[3..6].copy_from_slice(&v.to_array().map(f32::to_bits));
                    program.run_with(&row, black_box(&arguments), &mut terms).expect("it ends");
                    black_box(&terms);
                }
            });
        });
    }
    group.finish();
}

/// The cost of the limits in reading a model, separate from all other checks: for the text and the module of
/// a drawing shader, and for a file of maximum size.
fn limited(c: &mut Criterion) {
    let registry = Registry::builtin();
    let model = registry.model("disney").expect("built in");
    let composed = compose_evaluation(&Sources::default(), model);
    let module = validate(&composed).expect("valid WGSL");
    let shading = &registry.shading_models()[0];
    let of = (model, model.declaration.passage());
    let drawn = compose(&Sources::default(), of, shading, registry.lights());
    let mut group = c.benchmark_group("limits");
    group.bench_function("text of a shader that draws", |b| b.iter(|| check_text(black_box(&drawn))));
    group.bench_function("text of a model", |b| b.iter(|| check_text(black_box(&composed))));
    group.bench_function("module of a model", |b| b.iter(|| check_module(black_box(&module))));
    group.bench_function("all checks of a model", |b| b.iter(|| validate(black_box(&composed))));
    let long = Composed { text: "a = b + c;\n".repeat(90_000), ..Composed::default() };
    group.bench_function("text of a mebibyte", |b| b.iter(|| check_text(black_box(&long))));
    group.finish();
}

criterion_group!(benches, models, interpreted, limited);
criterion_main!(benches);
