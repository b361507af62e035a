//! The channels that plots show.

use glam::Vec3;

use crate::optics::colour::luminance;

/// The channel shown by a curve.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channel {
    /// Luminance by ITU-R BT.709.
    Luminance,
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
}

impl Channel {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Luminance, Self::Red, Self::Green, Self::Blue];

    /// The name on the command line.
    #[must_use]
    pub fn id(self) -> &'static str {
        ["luminance", "r", "g", "b"][self as usize]
    }

    /// The channel with this name.
    #[must_use]
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|channel| channel.id() == id)
    }

    /// The name in words.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["luminance", "red", "green", "blue"][self as usize]
    }

    /// The value of a colour; not finite if one of its channels is not.
    #[must_use]
    pub fn of(self, rgb: Vec3) -> f64 {
        let value = match self {
            Self::Luminance if rgb.x == rgb.y && rgb.y == rgb.z => rgb.x,
            Self::Luminance if !rgb.is_finite() => f32::NAN,
            Self::Luminance => luminance(rgb),
            Self::Red => rgb.x,
            Self::Green => rgb.y,
            Self::Blue => rgb.z,
        };
        value.into()
    }
}
