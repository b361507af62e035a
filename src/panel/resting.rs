//! Choices by what the camera sees, which are kept while it moves and made anew once it rests.

use glam::Quat;

use super::{notice, prelude::*};

/// Time after its latest movement at which the camera rests, in seconds.
const REST: f64 = 0.3;

/// Where the camera is, and how it is turned.
type Position = (Vec3, Quat);

/// The camera, as last seen.
#[derive(Clone, Copy, Debug)]
struct Seen {
    position: Position,
    /// Time of its latest movement, in seconds.
    moved: f64,
    /// Time at which the window is woken to see it rest, in seconds.
    wakes: f64,
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
    let (rests, seen) = (rests(ctx, position), (position, known));
    let before = ctx.data(|d| d.get_temp::<(K, (Position, S), T)>(id));
    let stays = |(of, by, _): &(K, (Position, S), T)| *of == key && (!rests || *by == seen);
    if let Some((.., made)) = before.filter(stays) {
        return made;
    }
    let made = make();
    ctx.data_mut(|d| d.insert_temp(id, (key, seen, made.clone())));
    made
}

/// True if the camera has not moved for a moment, and nothing is held that could move it on. Otherwise the window is woken
/// when the moment is over.
fn rests(ctx: &Context, position: Position) -> bool {
    let (now, held) = ctx.input(|i| (i.time, i.pointer.any_down()));
    let known: Option<Seen> = kept::get(ctx);
    // One that has never been seen to move rests.
    let mut seen = known.unwrap_or(Seen { position, moved: f64::NEG_INFINITY, wakes: 0.0 });
    if seen.position != position {
        seen = Seen { position, moved: now, ..seen };
    }
    let left = seen.moved + REST - now;
    if left > 0.0 && seen.wakes <= now {
        notice::wake(ctx, left + 0.05);
        seen.wakes = now + left + 0.05;
    }
    kept::set(ctx, Some(seen));
    left <= 0.0 && !held
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
