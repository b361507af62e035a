//! The camera turns equally with a mouse, which reports its movement, and with a pointer that reports only
//! its position, as in virtual machines.

#![cfg(target_os = "linux")]

use std::{
    thread,
    time::{Duration, Instant},
};

use crate::{
    helpers::keyboard::Keyboard,
    helpers::screen::{Picture, Screen},
};

/// The window after a drag through the picture in steps.
fn after_drag(step: impl Fn(&mut Keyboard, i16)) -> (Picture, Picture) {
    let screen = Screen::new(1280, 720);
    let mut window = screen.start(&["view"]);
    window.until("a sphere", |p| p.at(610, 310)[0] > 180);
    let before = window.rest();
    let mut pointer = Keyboard::new(screen.display());
    let pause = || thread::sleep(Duration::from_millis(150));
    pointer.point_at(560, 300);
    pause();
    pointer.button(true);
    pause();
    for k in 1..=5 {
        let last = screen.look().pixels;
        step(&mut pointer, k);
        // A busy machine takes a while to show it.
        let begin = Instant::now();
        while screen.look().pixels == last && begin.elapsed() < Duration::from_secs(2) {
            thread::sleep(Duration::from_millis(20));
        }
        pause();
    }
    pointer.button(false);
    (before, window.rest())
}

/// The pixels of the picture between the panels that differ, without the line that shows the frames per
/// second.
fn differ(a: &Picture, b: &Picture) -> usize {
    let places = (40..680).flat_map(|y| (215..930).map(move |x| (x, y)));
    places.filter(|(x, y)| (0..3).any(|c| a.at(*x, *y)[c].abs_diff(b.at(*x, *y)[c]) > 8)).count()
}

#[test]
fn a_press_that_comes_with_its_move_is_of_the_panel_where_it_is_made() {
    let screen = Screen::new(1280, 720);
    // A scene, since the strip of examples would change as their pictures arrive.
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/default.json");
    let mut window = screen.start(&["view", scene]);
    window.until("a sphere", |p| p.at(610, 310)[0] > 180);
    let mut pointer = Keyboard::new(screen.display());
    pointer.point_at(560, 300);
    let before = window.rest();
    // All events during a frame arrive together in the next one: here a press on the observer's row.
    pointer.point_at(562, 300);
    thread::sleep(Duration::from_millis(15));
    pointer.point_at(60, 80);
    pointer.button(true);
    thread::sleep(Duration::from_millis(200));
    pointer.button(false);
    pointer.point_at(62, 82);
    let after = window.rest();
    assert!(before.pixels != after.pixels, "the row is selected");
    // The selected object had marks around it, and handles in its middle.
    let still = (500..548).flat_map(|x| (290..340).map(move |y| (x, y)));
    let moved = still.filter(|(x, y)| before.at(*x, *y) != after.at(*x, *y)).count();
    assert!(moved < 40, "{moved} pixels of the sphere differ");
    assert!(differ(&before, &after) < 4_000, "{} pixels differ", differ(&before, &after));
}

#[test]
fn a_pointer_that_tells_only_where_it_is_turns_the_camera_as_a_mouse_does() {
    let (before, tablet) = after_drag(|pointer, k| pointer.point_at(560 + 20 * k, 300));
    let (_, mouse) = after_drag(|pointer, _| pointer.move_by(20, 0));
    assert!(differ(&before, &mouse) > 20_000, "the mouse turns it");
    assert!(differ(&before, &tablet) > 20_000, "and so does the tablet");
    // At the same speed: twice the speed would change as much again.
    assert!(differ(&mouse, &tablet) < 200, "{} pixels differ", differ(&mouse, &tablet));
}
