//! The point held by a pin, which stays on its object.

use crate::{
    document::PartId,
    explain::{Anchor, Seen},
    panel::prelude::*,
    scene::observer::rotation,
};

/// Maximum number of remembered points: those of the user's document and of a lesson's.
const MOST: usize = 4;
/// Tolerances for a camera at the observer: distance in metres, and cosine of the angle between the directions.
const THERE: (f32, f32) = (0.1, 0.999);

/// The point of an object at which a pin was placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Held {
    /// Number of the pin.
    pin: u64,
    pub(super) object: PartId,
    pub(super) anchor: Anchor,
}

/// Points held by pins, the latest at the end.
#[derive(Debug, Default)]
pub(super) struct Holding(Vec<Held>);

impl Holding {
    /// The point held by the current pin.
    pub(super) fn now(&self, session: &Session) -> Option<Held> {
        let pin = session.view.pinned.map(|_| session.view.pin_number)?;
        self.0.iter().find(|held| held.pin == pin).copied()
    }

    /// Stores the point at which the current pin was placed.
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

/// False while the camera moves to the observer of a newly opened scene: on the way, the pin points at something else.
fn has_arrived(session: &Session) -> bool {
    let (facts, observer) = (&session.facts, &session.document.observer);
    let along = (facts.camera * glam::Vec3::Z).dot(rotation(observer.direction) * glam::Vec3::Z);
    facts.camera_is_free || facts.eye.distance(observer.position) < THERE.0 && along > THERE.1
}
