//! The channels that plots show.

use glam::Vec3;

use crate::{declared::ids, optics::colour::luminance};

ids! {
    /// The channel shown by a curve.
    Channel(
        /// The name in words.
        name
    ) {
        /// Luminance by ITU-R BT.709.
        Luminance = "luminance" "luminance",
        /// Red.
        Red = "r" "red",
        /// Green.
        Green = "g" "green",
        /// Blue.
        Blue = "b" "blue",
    }
}

impl Channel {
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
