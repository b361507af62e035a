//! The sizes of lights with extent.

/// A numeric parameter of a light type that is one of its sizes, in metres. Sizes have handles in the
/// picture, and determine the outline of a selected light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// Width, along the first of the [sides](super::extent::sides).
    Width(&'static str),
    /// Height, along the second of them.
    Height(&'static str),
    /// Length along the direction.
    Length(&'static str),
    /// Radius: around the direction, or of a ball for types without one.
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

    /// True if the size is measured along or across a direction.
    #[must_use]
    pub const fn needs_direction(self) -> bool {
        !matches!(self, Self::Radius(_))
    }

    /// The fraction of the size on one side of the centre.
    #[must_use]
    pub const fn part(self) -> f32 {
        if self.needs_direction() { 0.5 } else { 1.0 }
    }
}
