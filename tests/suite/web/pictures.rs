//! Pictures of the laboratory in a browser are those of the command line.

use std::{fs, path::Path};

use super::laboratory::Laboratory;
use crate::helpers::{
    browser::rgb,
    skipped::skip,
    support::{command_in, root, run},
};

/// The size of the page. Its picture is wider than 16:9: in narrower ones, the window shows everything smaller.
const SIZE: [u32; 2] = [1280, 460];
/// The height of the bars above and below the picture.
const BARS: u32 = 66;
/// Scenes under lamps without extent: others take minutes here.
const SCENES: [&str; 10] = [
    "default",
    "five_spheres",
    "half_lambert",
    "fresnel_effect",
    "gold_three_lights",
    "gouraud_misses_highlight",
    "lobe_shape",
    "photometric_lamps",
    "shapes_and_lights",
    "white_furnace",
];
/// Where Chromium has its driver, which draws on the CPU. That of Mesa takes its samples of edges elsewhere.
const DRIVERS: [&str; 4] =
    ["/usr/lib/chromium", "/usr/lib/chromium-browser", "/usr/lib64/chromium-browser", "/opt/google/chrome"];
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
    let drivers = DRIVERS.map(|folder| Path::new(folder).join("vk_swiftshader_icd.json"));
    let Some(driver) = drivers.into_iter().find(|driver| driver.is_file()) else {
        return skip(
            "Chromium has its Vulkan driver in none of the usual folders (apt-get install chromium)",
        );
    };
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("picture.png");
    let height = SIZE[1] - BARS;
    let rendered = |scene: &str, width: usize, options: &[&str]| {
        let scene = root().join("scenes").join(format!("{scene}.json"));
        let (scene, out) = (scene.to_str().expect("Unicode"), file.to_str().expect("Unicode"));
        let size = format!("{width}x{height}");
        let arguments = ["render", scene, "-o", out, "--size", &size, "--renderer", "gpu", "-q"];
        let mut command = command_in(root(), [&arguments[..], options].concat());
        // The newer and the older name of the variable.
        command.env("VK_DRIVER_FILES", &driver).env("VK_ICD_FILENAMES", &driver);
        let run = run(command, b"");
        assert_eq!(run.status, Some(0), "{}", run.err);
        rgb(&fs::read(&file).expect("a picture")).0
    };
    let mut wrong = Vec::new();
    for scene in SCENES {
        lab.visit(&format!("?scene={scene}"));
        // It is part of the window's pictures alone.
        lab.find("outline of the room");
        let (mut shown, width) = rgb(&lab.picture());
        // The caption is below.
        shown.truncate(3 * width * height as usize);
        let off = beyond(&shown, &rendered(scene, width, &[]));
        println!("{scene}: {:.3} %", 100.0 * off);
        if off > BEYOND {
            wrong.push(format!("{scene}: {:.3} %", 100.0 * off));
        }
        // A wrong twin would be detected.
        assert!(beyond(&shown, &rendered(scene, width, &["--exposure=-1"])) > BEYOND, "{scene}");
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
