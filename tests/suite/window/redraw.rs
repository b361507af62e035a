//! The picture is drawn when something that it shows has changed, and at no other time.

#![cfg(target_os = "linux")]

use std::{
    thread,
    time::{Duration, Instant},
};

use crate::{helpers::keyboard::Keyboard, helpers::screen::Screen};

/// The frames drawn by a window in which the pointer was moved: those with only panels, those with the
/// picture too, and those in which its state changed.
fn frames(moves: impl Fn(&mut Keyboard, &Screen)) -> [u64; 3] {
    let screen = Screen::new(1280, 720);
    let mut window = screen.start(&["view", "--verbose"]);
    window.until("a sphere", |p| p.at(610, 310)[0] > 180);
    window.rest();
    moves(&mut Keyboard::new(screen.display()), &screen);
    window.rest();
    let said = window.ended();
    let line = said.lines().find(|line| line.starts_with("Frames: ")).expect("it says how many there were");
    ["panels alone ", "panels and picture ", "session changed in "].map(|kind| {
        let (_, number) = line.split_once(kind).expect("it names both kinds");
        let digits = number.find(|c: char| !c.is_ascii_digit()).unwrap_or(number.len());
        number[..digits].parse().expect("a number")
    })
}

#[test]
fn a_pointer_over_the_panels_draws_no_picture_and_a_drag_in_the_picture_does() {
    let pause = || thread::sleep(Duration::from_millis(40));
    let [_, still, calm] = frames(|_, _| {});
    let [panels, hovered, changes] = frames(|pointer, screen| {
        // Over the scene list, the controls on the right, and the strip below.
        for k in 0..15 {
            for (x, y) in [(60, 80 + 30 * k), (1100, 80 + 30 * k), (300 + 40 * k, 700)] {
                let before = screen.look().pixels;
                pointer.point_at(x, y);
                pause();
                // A busy machine draws several moves at once, unless there is a moment between them.
                let begin = Instant::now();
                while screen.look().pixels == before && begin.elapsed() < Duration::from_millis(250) {
                    thread::sleep(Duration::from_millis(20));
                }
            }
        }
    });
    assert!(panels >= 20, "the panels follow the pointer: {panels}");
    // The number of pictures at the start depends on when its shaders are ready.
    assert!(changes <= calm + 2, "hovering changed the state in {changes} frames, and nothing in {calm}");
    assert!(hovered <= still + 4, "{hovered} pictures, and {still} without a pointer");
    let [_, dragged, turned] = frames(|pointer, screen| {
        pointer.point_at(560, 300);
        pause();
        pointer.button(true);
        pause();
        for k in 1..=15 {
            let before = screen.look().pixels;
            pointer.point_at(560 + 8 * k, 300);
            // A busy machine shows several steps at once, unless each is waited for.
            let begin = Instant::now();
            while screen.look().pixels == before && begin.elapsed() < Duration::from_secs(2) {
                thread::sleep(Duration::from_millis(20));
            }
        }
        pointer.button(false);
    });
    assert!(turned <= calm + 2, "turning the camera changed the state in {turned} frames");
    assert!(dragged >= still + 8, "{dragged} pictures, and {still} without a drag");
}
