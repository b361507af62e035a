//! Pictures of the laboratory in a browser are those of the command line.

use std::fs;

use super::laboratory::Laboratory;
use crate::helpers::{
    browser::rgb,
    support::{lcm, root},
};

/// The size of the page. Its picture is wider than 16:9, as the window shows what a scene's observer sees in narrower ones smaller.
const SIZE: [u32; 2] = [1280, 460];
/// The height of the bars above and below the picture.
const BARS: u32 = 66;
/// Scenes under lamps without extent, in rooms whose outline is out of sight.
const SCENES: [&str; 10] = [
    "five_spheres",
    "half_lambert",
    "fresnel_effect",
    "gold_three_lights",
    "gouraud_misses_highlight",
    "lobe_shape",
    "many_lights",
    "shapes_and_lights",
    "superellipsoids",
    "white_furnace",
];
/// The share of pixels that may differ by more than 2 levels.
const BEYOND: f64 = 0.001;

/// The share of pixels of two pictures that differ by more than 2 levels.
fn beyond(one: &[u8], other: &[u8]) -> f64 {
    assert_eq!(one.len(), other.len());
    let pairs = one.chunks(3).zip(other.chunks(3));
    let off = pairs.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > 2)).count();
    off as f64 / (one.len() / 3) as f64
}

#[test]
fn a_page_shows_the_pictures_of_the_command_line() {
    let Some(lab) = Laboratory::start(SIZE) else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("picture.png");
    let height = SIZE[1] - BARS;
    let rendered = |scene: &str, width: usize, options: &[&str]| {
        let scene = root().join("scenes").join(format!("{scene}.json"));
        let (scene, out) = (scene.to_str().expect("Unicode"), file.to_str().expect("Unicode"));
        let size = format!("{width}x{height}");
        let arguments = ["render", scene, "-o", out, "--size", &size, "--renderer", "gpu", "-q"];
        let run = lcm(&[&arguments[..], options].concat(), "");
        assert_eq!(run.status, Some(0), "{}", run.err);
        rgb(&fs::read(&file).expect("a picture")).0
    };
    let mut wrong = Vec::new();
    for scene in SCENES {
        lab.visit(&format!("?scene={scene}"));
        let (mut shown, width) = rgb(&lab.picture());
        // The caption is below.
        shown.truncate(3 * width * height as usize);
        let off = beyond(&shown, &rendered(scene, width, &[]));
        println!("{scene}: {:.3} %", 100.0 * off);
        if off > BEYOND {
            wrong.push(format!("{scene}: {:.3} %", 100.0 * off));
        }
        // A wrong twin would be detected.
        assert!(beyond(&shown, &rendered(scene, width, &["--exposure", "0.2"])) > BEYOND, "{scene}");
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
