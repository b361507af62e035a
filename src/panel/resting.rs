//! Choices by what the camera sees, which are kept while it moves and made anew once it rests.

use glam::Quat;

use super::{notice::Wait, prelude::*};

/// Time after its latest movement at which the camera rests, in seconds.
const REST: f64 = 0.3;

/// Where the camera is, and how it is turned.
type Position = (Vec3, Quat);

/// The camera, as last seen.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    position: Option<Position>,
    /// The time until it rests.
    moves: Wait,
}

/// The choice under an id, made again if its key changes and, once the camera rests, if the camera or what is known by it
/// has changed.
pub(super) fn choice<K, S, T>(
    ctx: &Context,
    id: Id,
    session: &Session,
    (key, known): (K, S),
    make: impl FnOnce() -> T,
) -> T
where
    K: Clone + PartialEq + Send + Sync + 'static,
    S: Clone + PartialEq + Send + Sync + 'static,
    T: Clone + Send + Sync + 'static,
{
    let position = (session.facts.eye, session.facts.camera);
    kept::of_keys(ctx, id, (key, (position, known)), rests(ctx, position), make)
}

/// True if the camera has not moved for a moment, and nothing is held that could move it on. Otherwise the window is woken
/// when the moment is over.
fn rests(ctx: &Context, position: Position) -> bool {
    let (now, held) = ctx.input(|i| (i.time, i.pointer.any_down()));
    let mut seen: Seen = kept::get(ctx);
    // One that has never been seen to move rests.
    if seen.position.replace(position).is_some_and(|before| before != position) {
        seen.moves.begin(now, REST);
    }
    let moves = seen.moves.lasts(now);
    if moves {
        seen.moves.wake(ctx, now);
    }
    kept::set(ctx, seen);
    !moves && !held
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::{Event, Modifiers, PointerButton, RawInput};

    use super::*;

    /// A window that makes a choice by a key in each frame.
    #[derive(Default)]
    struct Window {
        ctx: Context,
        session: Session,
        time: f64,
        /// The number of choices.
        made: u32,
    }

    impl Window {
        /// The number of choices after a frame at a time, where the camera is so many metres to the right.
        fn frame(&mut self, time: f64, right: f32, key: &'static str, events: Vec<Event>) -> u32 {
            self.time += time;
            self.session.facts.eye.x = right;
            let input = RawInput { time: Some(self.time), events, ..RawInput::default() };
            let Self { ctx, session, made, .. } = self;
            let _ = ctx.run_ui(input, |ui| {
                let _: u32 = choice(ui.ctx(), Id::new("choice"), session, (key, ()), || {
                    *made += 1;
                    *made
                });
            });
            self.made
        }
    }

    #[test]
    fn a_choice_is_kept_while_the_camera_moves_and_made_once_it_rests() {
        let mut window = Window::default();
        assert_eq!(window.frame(1.0, 0.0, "a", Vec::new()), 1, "the first");
        assert_eq!(window.frame(1.0, 0.0, "a", Vec::new()), 1, "nothing changes");
        for i in 1..40u8 {
            assert_eq!(window.frame(0.1, f32::from(i), "a", Vec::new()), 1, "it moves: {i}");
        }
        assert_eq!(window.frame(0.1, 39.0, "a", Vec::new()), 1, "not at once");
        assert_eq!(window.frame(0.3, 39.0, "a", Vec::new()), 2, "it rests");
        assert_eq!(window.frame(0.3, 39.0, "a", Vec::new()), 2);
        // Another key counts at once.
        assert_eq!(window.frame(0.1, 40.0, "b", Vec::new()), 3);
        assert_eq!(window.frame(0.1, 41.0, "b", Vec::new()), 3);
        assert_eq!(window.frame(0.5, 41.0, "b", Vec::new()), 4);
    }

    #[test]
    fn a_camera_that_is_held_does_not_rest() {
        let mut window = Window::default();
        let button = |pressed| {
            let (pos, button) = (pos2(5.0, 5.0), PointerButton::Primary);
            vec![
                Event::PointerMoved(pos),
                Event::PointerButton { pos, button, pressed, modifiers: Modifiers::NONE },
            ]
        };
        assert_eq!(window.frame(1.0, 0.0, "a", button(true)), 1);
        assert_eq!(window.frame(0.1, 1.0, "a", Vec::new()), 1);
        assert_eq!(window.frame(2.0, 1.0, "a", Vec::new()), 1, "the button is down");
        assert_eq!(window.frame(0.1, 1.0, "a", button(false)), 2);
    }
}
