//! The camera turns alike under a mouse, which tells how far it was moved, and under a pointer that tells only where
//! it is, as those of virtual machines do.

#![cfg(target_os = "linux")]

use std::{thread, time::Duration};

use crate::{
    keyboard::Keyboard,
    screen::{Picture, Screen},
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
        step(&mut pointer, k);
        pause();
    }
    pointer.button(false);
    (before, window.rest())
}

#[test]
fn a_pointer_that_tells_only_where_it_is_turns_the_camera_as_a_mouse_does() {
    let (before, tablet) = after_drag(|pointer, k| pointer.point_at(560 + 20 * k, 300));
    let (_, mouse) = after_drag(|pointer, _| pointer.move_by(20, 0));
    let differ = |a: &Picture, b: &Picture| {
        // The picture between the panels, without the line that tells the frames per second.
        let places = (40..680).flat_map(|y| (215..930).map(move |x| (x, y)));
        places.filter(|(x, y)| (0..3).any(|c| a.at(*x, *y)[c].abs_diff(b.at(*x, *y)[c]) > 8)).count()
    };
    assert!(differ(&before, &mouse) > 20_000, "the mouse turns it");
    assert!(differ(&before, &tablet) > 20_000, "and so does the tablet");
    // At the same speed: twice the speed would change as much again.
    assert!(differ(&mouse, &tablet) < 200, "{} pixels differ", differ(&mouse, &tablet));
}
