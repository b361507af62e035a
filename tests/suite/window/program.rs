//! The window, on a virtual screen: it opens, shows the scene and the panels, and can be captured.

#![cfg(target_os = "linux")]

use std::path::Path;

use crate::helpers::screen::{Picture, Screen, lcm};

fn capture(size: Option<(u32, u32)>, scene: &str) -> Picture {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("window.png");
    let (width, height) = size.unwrap_or((1280, 720));
    let screen = Screen::new(width, height);
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(scene);
    let (scene, file_name) = (scene.to_string_lossy(), file.to_string_lossy());
    let mut arguments = vec!["view", &*scene, "--exit-after", "12", "--capture", &*file_name];
    let size = size.map(|(w, h)| format!("{w}x{h}"));
    if let Some(size) = &size {
        arguments.extend(["--size", size]);
    }
    let output = screen.lcm(&arguments, folder.path());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let capture = Picture::read(&file);
    assert_eq!((capture.width, capture.height), (width, height));
    capture
}

#[test]
fn the_window_shows_the_picture_between_the_panels() {
    let window = capture(None, "default.json");
    // The sphere is in the middle of the picture, lit from the upper right.
    let (lit, dark) = (window.at(610, 310), window.at(505, 430));
    assert!(lit[0] > 180 && lit[0] == lit[1] && lit[1] == lit[2], "the lit side is {lit:?}");
    assert!(dark[0] < 40, "the dark side is {dark:?}");
    assert_eq!(window.at(230, 60), [46, 46, 46], "the surround is neutral");
    // Both panels, the bar above and the line below contain text.
    for (what, x, y) in [
        ("tree", 0..200, 40..200),
        ("inspector", 950..1270, 40..600),
        ("bar", 0..1280, 0..36),
        ("status", 0..1280, 695..720),
    ] {
        assert!(window.colours(x, y) > 20, "the {what} is empty");
    }
}

#[test]
fn the_window_fills_a_large_screen() {
    let window = capture(Some((1920, 1080)), "shapes_and_lights.json");
    assert!(window.colours(300..1500, 100..1000) > 500, "the picture is empty");
    assert!(window.colours(1600..1900, 40..1000) > 20, "the inspector is empty");
}

#[test]
fn a_window_is_grey_until_its_first_frame_and_never_noise() {
    let screen = Screen::new(1280, 720);
    // This scene leaves memory behind that is not empty.
    let mut window = screen.start(&["view", "--lesson", "12_glass_paper_leaf"]);
    let (mut is_grey, mut is_noise) = (false, false);
    window.until("the panels", |screen| {
        let grey = screen.at(640, 360).iter().zip([43, 44, 47]).all(|(a, b)| a.abs_diff(b) <= 1);
        is_grey |= grey && screen.colours(0..1280, 100..110) == 1;
        let colours = screen.colours(0..300, 60..260);
        is_noise |= colours > 5000;
        (21..2000).contains(&colours)
    });
    assert!(!is_noise, "the window shows memory");
    assert!(is_grey, "the window is not cleared");
}

#[test]
fn without_a_display_the_message_says_what_to_do() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = lcm(&["view"], folder.path()).output().expect("lcm runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("no display") && said.contains("lcm render"), "{said}");
    assert_eq!(said.trim().lines().count(), 1, "one line: {said}");
}

#[test]
fn without_a_driver_the_message_says_what_to_install() {
    let folder = tempfile::tempdir().expect("a folder");
    let picture = folder.path().join("x.png");
    for arguments in [&["view"][..], &["render", "--renderer", "gpu", "-o", &picture.to_string_lossy()][..]] {
        let output = lcm(arguments, folder.path())
            .env("DISPLAY", ":0")
            .env("VK_DRIVER_FILES", "/nonexistent.json")
            .env("VK_ICD_FILENAMES", "/nonexistent.json")
            .output()
            .expect("lcm runs");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(3), "{said}");
        assert!(said.contains("mesa-vulkan-drivers"), "{said}");
    }
    assert!(!picture.exists());
}

#[test]
fn a_capture_that_cannot_be_written_is_exit_status_4() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("file"), "").expect("writable");
    let file = folder.path().join("file/window.png");
    let screen = Screen::new(640, 480);
    let output =
        screen.lcm(&["view", "--exit-after", "3", "--capture", &file.to_string_lossy()], folder.path());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(4), "{said}");
    assert!(said.contains("could not be written"), "{said}");
}

#[test]
fn a_scene_that_breaks_the_rules_does_not_open_a_window() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("bad.json");
    std::fs::write(&scene, r#"{ "lights": 5 }"#).expect("writable");
    let screen = Screen::new(640, 480);
    let output = screen.lcm(&["view", &scene.to_string_lossy(), "--exit-after", "3"], folder.path());
    assert_eq!(output.status.code(), Some(1), "{}", String::from_utf8_lossy(&output.stderr));
}
