//! Colour: sRGB integers at the edges, linear light inside.

use glam::Vec3;

use crate::declared::ids;

/// Weights of linear Rec. 709 red, green and blue in luminance (ITU-R BT.709-6).
pub const LUMINANCE: Vec3 = Vec3::new(0.2126, 0.7152, 0.0722);

/// The background colour, sRGB-encoded: a neutral grey, since colour is judged against it. It is not light of the
/// scene, so exposure does not change it; tone mapping does. Scenes may give another one.
pub const BACKGROUND: [u8; 3] = [46, 46, 46];

ids! {
    /// Decoding of colours on the way in and encoding on the way out.
    #[derive(Default)]
    Encoding {
        /// Input colours are sRGB-encoded and decoded to linear light; the picture is encoded (IEC 61966-2-1). Every
        /// calculation with light assumes this.
        #[default]
        Srgb = "srgb",
        /// Neither: the numbers are used unchanged ("gamma-naive"). Deliberately wrong, for comparison.
        Off = "off",
    }
}

impl Encoding {
    /// The colour for calculation from an 8-bit colour as written by users.
    #[must_use]
    pub fn decode(self, rgb: [u8; 3]) -> Vec3 {
        let v = Vec3::new(f32::from(rgb[0]), f32::from(rgb[1]), f32::from(rgb[2])) / 255.0;
        match self {
            Self::Srgb => v.map(srgb_decode),
            Self::Off => v,
        }
    }

    /// The nearest 8-bit colour; the inverse of [`decode`](Self::decode).
    #[must_use]
    pub fn encode(self, linear: Vec3) -> [u8; 3] {
        linear.to_array().map(|v| match self {
            Self::Srgb => srgb_encode8(v),
            Self::Off => (255.0 * v.clamp(0.0, 1.0)).round() as u8,
        })
    }
}

/// sRGB-encoded [0, 1] to linear light (IEC 61966-2-1).
#[must_use]
pub fn srgb_decode(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Linear light [0, 1] to sRGB-encoded (IEC 61966-2-1).
#[must_use]
pub fn srgb_encode(linear: f32) -> f32 {
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Linear light to sRGB-encoded eight bits; values beyond the display's range are clipped.
#[must_use]
pub fn srgb_encode8(linear: f32) -> u8 {
    (255.0 * srgb_encode(linear.clamp(0.0, 1.0))).round() as u8
}

/// Luminance of a linear Rec. 709 colour.
#[must_use]
pub fn luminance(linear: Vec3) -> f32 {
    LUMINANCE.dot(linear)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decoding_and_encoding_are_inverse_for_every_code() {
        for code in 0..=255u8 {
            let linear = Encoding::Srgb.decode([code; 3]).x;
            assert_eq!((srgb_encode(linear) * 255.0).round() as u8, code);
        }
    }

    #[test]
    fn mid_grey_is_what_the_standard_says() {
        // IEC 61966-2-1: code 188 is about half the light, code 128 about 21.6 %.
        assert!((Encoding::Srgb.decode([188; 3]).x - 0.502_886).abs() < 1e-5);
        assert!((Encoding::Srgb.decode([128; 3]).x - 0.215_861).abs() < 1e-5);
    }

    #[test]
    fn gamma_naive_takes_the_numbers_as_they_are() {
        assert!((Encoding::Off.decode([128; 3]).x - 128.0 / 255.0).abs() < 1e-7);
    }
}
