//! A sweep of a hundred default pictures beside a hundred bare renders, and the same with files; the encoding of a film; and a row
//! of 25 spheres beside 25 single ones, each read from JSON and drawn.
#![allow(missing_docs)]

use criterion::{Criterion, criterion_group, criterion_main};
use lights_camera_models::{
    picture::png::{self, About},
    progress::Progress,
    reference::{Settings as Bare, render_rgb8},
    registry::Registry,
    scene::{
        Object, Repeat, Repetition, Scene, SceneIn, Varied,
        load::{self, Defaults},
        repeat::Along,
    },
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
                files(&sweep, &settings, (folder.path(), false), &|_| Ok(()), &Progress::NONE)
                    .expect("written");
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

/// A row of 25 spheres beside 25 single ones: read from JSON, and drawn.
fn row(c: &mut Criterion) {
    let (registry, settings) = (Registry::builtin(), Bare::default());
    let varied = Varied {
        parameter: "size".to_owned(),
        from: Some(0.2),
        to: Some(0.4),
        along: Along::All,
        ..Varied::default()
    };
    let repeat = Repeat {
        columns: 5,
        rows: 5,
        spacing: [0.8, 0.0, 0.0].into(),
        row_spacing: [0.0, -0.8, 0.0].into(),
        vary: vec![varied],
        ..Repeat::default()
    };
    let position = [3.4, 6.6, 5.0].into();
    let entry = Object { repeat: Repetition::Entry(Box::new(repeat)), position, ..Object::default() };
    let of_row = Scene { objects: vec![entry], ..Scene::default() };
    let mut singles = of_row.clone().expanded(&registry).expect("a grid");
    singles.objects.iter_mut().for_each(|object| object.repeat = Repetition::None);
    let of_row = of_row.expanded(&registry).expect("a grid");
    let mut group = c.benchmark_group("25 spheres 1280x720");
    group.sample_size(20);
    for (name, scene) in [("a row", of_row), ("single objects", singles)] {
        let json = serde_json::to_string(&SceneIn(&scene, &registry)).expect("JSON");
        group.bench_function(name, |b| {
            b.iter(|| {
                let read =
                    load::from_text(&json, "row.json", &registry, Defaults::Refuse).expect("valid").scene;
                assert_eq!(read.objects.len(), 25);
                render_rgb8(&read, &registry, &settings).len()
            });
        });
    }
    group.finish();
}

criterion_group!(benches, hundred, film, row);
criterion_main!(benches);
