//! The point that a pin holds: it stays on its object.

use crate::{
    document::PartId,
    explain::{Anchor, Seen},
    panel::state::Session,
    scene::observer::rotation,
};

/// So many points are remembered: those of the user's own document and of a lesson's.
const MOST: usize = 4;
/// A camera that is this near to the observer, metres, and has the direction within this cosine, stands there.
const THERE: (f32, f32) = (0.1, 0.999);

/// The point of an object that a pin met.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Held {
    /// The number of the pin.
    pin: u64,
    pub(super) object: PartId,
    pub(super) anchor: Anchor,
}

/// What pins hold, the latest at the end.
#[derive(Debug, Default)]
pub(super) struct Holding(Vec<Held>);

impl Holding {
    /// The point that the present pin holds.
    pub(super) fn now(&self, session: &Session) -> Option<Held> {
        let pin = session.view.pinned.map(|_| session.view.pin_number)?;
        self.0.iter().find(|held| held.pin == pin).copied()
    }

    /// Holds the point that the present pin has met.
    pub(super) fn hold(&mut self, session: &Session, seen: &Seen) -> Option<()> {
        if session.view.pinned.is_none() || !has_arrived(session) {
            return None;
        }
        let object = session.document.objects.get(seen.object.index)?;
        let held = Held {
            pin: session.view.pin_number,
            object: session.document.object_id(seen.object.index)?,
            anchor: Anchor::of(object, seen.position, seen.face_normal),
        };
        if self.0.len() == MOST {
            self.0.remove(0);
        }
        self.0.push(held);
        Some(())
    }
}

/// False while the camera is on its way to the observer of a scene that was just opened: what it sees there is not what
/// a pin means.
fn has_arrived(session: &Session) -> bool {
    let (facts, observer) = (&session.facts, &session.document.observer);
    let along = (facts.camera * glam::Vec3::Z).dot(rotation(observer.direction) * glam::Vec3::Z);
    facts.camera_left || facts.eye.distance(observer.position) < THERE.0 && along > THERE.1
}
