//! Times of comparing two pictures of 1280×720 pixels: numbers, map, composition.
#![allow(missing_docs, clippy::unwrap_used)]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use lights_camera_models::{
    compare::{Pair, Shown, compose},
    reference::Settings,
    registry::Registry,
    scene::{Comparison, Scene, Variant, comparison::Layout},
};

/// Views A and B of the default scene, which differ in their reflection models.
fn views() -> [Shown; 2] {
    let phong = Variant { reflection_model: Some("phong".to_owned()), ..Variant::default() };
    let scene = Scene { variants: vec![phong], ..Scene::default() };
    let registry = Registry::builtin();
    [0, 1].map(|view| Shown::of_view(&scene, view, &registry, &Settings::default()).unwrap())
}

/// Pictures in which every pixel differs.
fn noise() -> [Shown; 2] {
    let mut state = 1u32;
    [0, 1].map(|_| {
        let codes = (0..1280 * 720 * 3).map(|_| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        });
        Shown::of_codes(1280, 720, codes.collect()).unwrap()
    })
}

fn compare(c: &mut Criterion) {
    let comparison = Comparison::default();
    for (name, [a, b]) in [("two models 1280x720", views()), ("noise 1280x720", noise())] {
        let pair = Pair::new(&a, &b).unwrap();
        let mut group = c.benchmark_group(name);
        group.sample_size(50);
        group.bench_function("numbers", |c| c.iter(|| black_box(pair).measure()));
        group.bench_function("map", |c| c.iter(|| black_box(pair).map(&comparison)));
        group.bench_function("numbers and map", |c| {
            c.iter(|| (black_box(pair).measure(), pair.map(&comparison)));
        });
        let both = [a.clone(), b.clone()];
        let wipe = Comparison { layout: Layout::Wipe, ..comparison };
        group.bench_function("wipe", |c| c.iter(|| compose(&wipe, [1280, 720], black_box(&both))));
        group.finish();
    }
}

criterion_group!(benches, compare);
criterion_main!(benches);
