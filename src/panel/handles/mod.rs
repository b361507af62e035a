//! The handles of the selection: arrows that move it, rings that turn it, and one for its size; for a light, handles
//! for its direction, its cone, and the sizes and the roll that its type declares.
//!
//! Bevy's `TransformGizmo` does not serve here. It takes the cursor of the window for one in the target of its camera,
//! but the cameras of the window draw into textures that are shown beside panels and beside each other; and it draws
//! into the picture, where tone mapping and exposure would change it and a capture would show it. These are painted over
//! the picture, as the [`marks`](super::marks) are, and what they change is an edit as that of any knob.

use std::{
    fmt,
    hash::{Hash, Hasher},
};

use bevy_egui::egui::{Pos2, Ui};
use glam::Vec3;

use crate::{light::LightEntry, panel::marks::Lens, parameter::Parameter, scene::SceneSize};
use grasp::{Dragged, Grasp, Pull};
use paint::Brush;
use shape::{Around, Placed, Target};

pub(super) use show::handles;

mod grasp;
mod paint;
mod shape;
mod show;

mod axis;
mod cone;
mod direction;
mod extent;
mod plane;
mod ring;
mod roll;
mod size;

/// Every sort of handle, each declared in a file of its own; in the order in which they are painted.
static SORTS: [&Sort; 8] = [
    &axis::SORT,
    &plane::SORT,
    &ring::SORT,
    &size::SORT,
    &direction::SORT,
    &cone::SORT,
    &extent::SORT,
    &roll::SORT,
];

/// A sort of handle. There may be several at once: functions are told which.
struct Sort {
    /// Tells it from the others.
    id: &'static str,
    /// The action of the handle in words, from the name of the selected part.
    name: fn(&Target, usize, &str) -> String,
    /// The handles that a target has.
    placed: fn(&Around) -> Vec<Placed>,
    /// The parameter of a light that it changes.
    parameter: fn(&LightEntry, usize) -> Option<&'static Parameter>,
    /// The value that the target has now.
    value: fn(&Target, Handle) -> Option<Dragged>,
    /// Takes further note of the target when it is grasped.
    hold: fn(&mut Grasp, &Target, &Lens),
    /// The value that a pull means; none where it means nothing.
    drag: fn(&Grasp, &Pull) -> Option<Dragged>,
    /// True if it is on a sphere: pulled off it and back, it is on the other side.
    is_on_sphere: bool,
    /// The value in words; the last function says a length in metres.
    words: fn(&Grasp, Dragged, &dyn Fn(f32) -> String) -> String,
    /// True if it is about the axis of the room that has the number.
    has_axis: bool,
    /// Paints its end.
    end: fn(&mut Brush, &Placed),
    /// Paints what helps while it is dragged: the middle of the handles, and where the pointer was and is.
    guide: fn(&Ui, Lens, usize, Vec3, [Pos2; 2], SceneSize),
}

impl Sort {
    /// The values that most handles share: a disc.
    const PLAIN: Self = Self {
        id: "",
        name: |_, _, part| part.to_owned(),
        placed: |_| Vec::new(),
        parameter: |_, _| None,
        value: |_, _| None,
        hold: |_, _, _| (),
        drag: |_, _| None,
        is_on_sphere: false,
        words: grasp::words,
        has_axis: false,
        end: paint::disc,
        guide: |_, _, _, _, _, _| (),
    };

    /// The values that handles for parameters of lights share.
    const OF_PARAMETER: Self = Self {
        value: |target, handle| {
            Some(Dragged::Parameter(target.light()?.parameters.number(target.parameter(handle)?)))
        },
        ..Self::PLAIN
    };

    /// A handle of this sort.
    const fn handle(&'static self, which: usize) -> Handle {
        Handle { sort: self, which }
    }
}

impl fmt::Debug for Sort {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.id)
    }
}

impl PartialEq for Sort {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl Eq for Sort {}

impl Hash for Sort {
    fn hash<H: Hasher>(&self, to: &mut H) {
        self.id.hash(to);
    }
}

/// A handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct Handle {
    sort: &'static Sort,
    /// Which of its sort.
    which: usize,
}
