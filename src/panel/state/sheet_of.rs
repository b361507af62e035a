//! The pictures of saved sheets and films.

use crate::declared::choice;

/// The pictures of a sheet or a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SheetOf {
    /// The views.
    Views,
    /// The copies of the row to which an object belongs.
    Row(usize),
    /// A full turn about the vertical through the middle of the objects.
    Turn(Turning),
}

choice! {
    /// The things that turn.
    Turning {
        #[default]
        Observer "observer" "The camera around the objects" "The lights stay: highlights move over the objects.",
        Objects "objects" "The objects, as on a turntable" "Camera and lights stay.",
        Lights "lights" "The lights around the objects" "Camera and objects stay.",
    }
}
