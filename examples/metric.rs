//! A metric from outside the crate, complete: the part of the pixels whose colour changes.
//!
//! `cargo run --release --example metric` prints it, beside those of the lab, for Phong and Blinn–Phong in the default scene.
//! A metric rests on a number of each pixel; the lab takes the picture in tiles, on all cores.
#![allow(clippy::print_stdout, missing_docs)]

use lights_camera_models::{
    compare::{
        Metric, Pair, Shown,
        metric::{ALL, Pixels, Way},
    },
    prelude::*,
    reference::Settings,
    scene::Variant,
};

/// The pixels of a tile that are not equal: 1 for each.
static UNEQUAL: Pixels = Pixels {
    where_equal: Some(0.0),
    measure: || {
        Box::new(|place, out| {
            for (out, y) in out.iter_mut().zip(place.rows()) {
                let [a, b] = place.codes(y);
                for ((out, a), b) in out.iter_mut().zip(a).zip(b) {
                    *out = f32::from(u8::from(a != b));
                }
            }
        })
    },
};

/// The fraction of pixels that differ.
pub static CHANGED: Metric = Metric::new("changed", Way::Pixels(&UNEQUAL, |sum, pixels| sum / pixels));

pub fn main() {
    let other = Variant { reflection_model: Some("blinn_phong".to_owned()), ..Variant::default() };
    let mut scene = Scene { variants: vec![other], ..Scene::default() };
    scene.reflection_model = "phong".to_owned();
    let (registry, settings) =
        (Registry::builtin(), Settings { width: 640, height: 360, ..Settings::default() });
    let view = |i| Shown::of_view(&scene, i, &registry, &settings).expect("the scene has two views");
    let (a, b) = (view(0), view(1));
    let pair = Pair::new(&a, &b).expect("both have the same size");
    let metrics = [&ALL[..], &[&CHANGED]].concat();
    for (id, number) in pair.measure_by(&metrics).expect("there are pixels").all.numbers {
        println!("{id}: {}", number.map_or_else(|| "unknown".to_owned(), |number| number.to_string()));
    }
}
