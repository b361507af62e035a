//! The sizes of lights with extent.

/// A number of a light type that is one of its sizes, metres. Sizes have handles in the picture, and make the outline of a light
/// that is selected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// From side to side, along the first of its [sides](super::extent::sides).
    Width(&'static str),
    /// From bottom to top, along the second of them.
    Height(&'static str),
    /// From end to end, along its direction.
    Length(&'static str),
    /// Half its diameter: around its direction, or all around where it has none.
    Radius(&'static str),
}

impl Size {
    /// The name of the parameter.
    #[must_use]
    pub const fn parameter(self) -> &'static str {
        match self {
            Self::Width(name) | Self::Height(name) | Self::Length(name) | Self::Radius(name) => name,
        }
    }

    /// True if it is measured along or across a direction.
    #[must_use]
    pub const fn needs_direction(self) -> bool {
        !matches!(self, Self::Radius(_))
    }

    /// The part of it that lies on one side of the middle.
    #[must_use]
    pub const fn part(self) -> f32 {
        if self.needs_direction() { 0.5 } else { 1.0 }
    }
}
