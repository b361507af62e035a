//! A sweep of a hundred default pictures beside a hundred bare renders, and the same with files.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use lights_camera_models::{
    picture::png::{self, About},
    progress::Progress,
    reference::{Settings as Bare, render_rgb8},
    registry::Registry,
    scene::Scene,
    sweep::{Axis, Settings, Sweep, files, gif, pictures},
};

const COUNT: usize = 100;

fn hundred(c: &mut Criterion) {
    let (registry, scene) = (Registry::builtin(), Scene::default());
    let axis = Axis::vary(&format!("lights[0].intensity=1..40:{COUNT}"), &scene, &registry).expect("numbers");
    let sweep = Sweep::new(&scene, 0, vec![axis], &registry).expect("valid");
    let scenes: Vec<_> = (0..COUNT).map(|i| sweep.seen(i).expect("valid").0).collect();
    let (bare, settings) = (Bare::default(), Settings::default());
    let folder = tempfile::tempdir().expect("a folder");
    let mut group = c.benchmark_group("100 default pictures 1280x720");
    group.sample_size(10);
    group.bench_function("bare renders", |b| {
        b.iter(|| scenes.iter().map(|scene| render_rgb8(scene, &registry, &bare).len()).sum::<usize>());
    });
    group.bench_function("a sweep", |b| {
        b.iter(|| {
            pictures(&sweep, &settings, None, &|_| Ok(()), &Progress::NONE).expect("drawn").pictures.len()
        });
    });
    group.bench_function("bare renders, each to a file", |b| {
        b.iter(|| {
            for (i, scene) in scenes.iter().enumerate() {
                let (rgb8, about) = (render_rgb8(scene, &registry, &bare), About::scene(scene, &registry));
                let file = folder.path().join(format!("{i}.png"));
                png::write(&file, bare.width, bare.height, &rgb8, &about).expect("written");
            }
        });
    });
    group.bench_function("a sweep into a folder", |b| {
        b.iter_with_setup(
            || tempfile::tempdir().expect("a folder"),
            |folder| {
                files(&sweep, &settings, folder.path(), &|_| Ok(()), &Progress::NONE).expect("written");
                folder
            },
        );
    });
    group.finish();
}

fn film(c: &mut Criterion) {
    let (registry, scene) = (Registry::builtin(), Scene::default());
    let axis = Axis::turn("360:24", &scene, &registry).expect("a turn");
    let sweep = Sweep::new(&scene, 0, vec![axis], &registry).expect("valid");
    let settings = Settings { size: [640, 360], ..Settings::default() };
    let drawn = pictures(&sweep, &settings, None, &|_| Ok(()), &Progress::NONE).expect("drawn").pictures;
    let mut group = c.benchmark_group("film of 24 pictures 640x360");
    group.sample_size(10);
    group.bench_function("gif", |b| b.iter(|| gif(&drawn, settings.size, 12).expect("encoded").len()));
    group.finish();
}

criterion_group!(benches, hundred, film);
criterion_main!(benches);
