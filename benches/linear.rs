//! Times of linear pictures: encoding and reading one with ten layers, and opening the scene in it.
#![allow(missing_docs, clippy::unwrap_used)]

use std::{hint::black_box, sync::atomic::AtomicBool};

use criterion::{Criterion, criterion_group, criterion_main};
use lights_camera_models::{
    channel::{LayerKind, layers},
    linear::Format,
    optics::TermSelection,
    picture::{linear, png::About},
    progress::Progress,
    reference::{Settings, Until, render_layers},
    registry::Registry,
    scene::{
        Light, Scene,
        load::{self, Defaults},
    },
};

fn linear_pictures(c: &mut Criterion) {
    let registry = Registry::builtin();
    let lamp = |x| Light { position: Some(glam::Vec3::new(x, 8.0, 9.0)), ..Light::default() };
    let scene = Scene { lights: [2.0, 5.0, 8.0].map(lamp).to_vec(), ..Scene::default() };
    let layers = layers(&scene, TermSelection::All, LayerKind::ALL, &registry);
    assert_eq!(layers.len(), 10);
    let (settings, odd) = (Settings::default(), AtomicBool::default());
    let draw = || {
        render_layers(&layers, &scene, &registry, &settings, Until::default(), &odd, &Progress::NONE).unwrap()
    };
    let (channels, _) = draw();
    let about = About::scene(&scene, &registry);
    let mut group = c.benchmark_group("ten layers 1280x720");
    group.sample_size(20);
    group.bench_function("render", |b| b.iter(draw));
    for format in [Format::Exr, Format::Hdr] {
        let name = format.extension();
        group.bench_function(format!("encode {name}"), |b| {
            b.iter(|| linear::encode(format, black_box(&channels), &about).unwrap());
        });
        let bytes = linear::encode(format, &channels, &about).unwrap();
        println!("{name}: {:.1} MiB", bytes.len() as f64 / f64::from(1 << 20));
        let file = format!("a.{name}");
        group.bench_function(format!("open the scene in {name}"), |b| {
            b.iter(|| load::from_bytes(black_box(&bytes), &file, &registry, Defaults::Refuse).unwrap());
        });
    }
    group.finish();
}

criterion_group!(benches, linear_pictures);
criterion_main!(benches);
