//! The ground of words in and around pictures, and their inks.

use crate::{optics::colour::luminance, scene::Display};

/// The ground of words: of labels in a picture, and of its surroundings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ground {
    /// The colour of the ground: neutral, since viewers judge the colours beside it.
    pub colour: [u8; 3],
    /// A line on it.
    pub line: [u8; 3],
    /// The ink of titles and labels.
    pub title: [u8; 3],
    /// The ink of text.
    pub text: [u8; 3],
    /// The ink of the least important text, with a contrast of 5.6:1 or more.
    pub weak: [u8; 3],
}

/// The luminance that has the same contrast to black and to white: √(1.05 · 0.05) − 0.05.
const EVEN: f32 = 0.179;

impl Ground {
    /// A dark ground with bright words.
    pub const DARK: Self =
        Self { colour: [24; 3], line: [72; 3], title: [244; 3], text: [208; 3], weak: [146; 3] };
    /// A light ground with dark words.
    pub const LIGHT: Self =
        Self { colour: [246; 3], line: [190; 3], title: [12; 3], text: [48; 3], weak: [98; 3] };

    /// The ground that suits the background of a scene. It is dark where light at infinity or the neutral grey is shown.
    #[must_use]
    pub fn of(display: &Display) -> Self {
        let behind = display.behind(0.5).map_or(0.0, luminance);
        if behind > EVEN { Self::LIGHT } else { Self::DARK }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{optics::colour::Encoding, scene::Background};

    fn contrast(a: [u8; 3], b: [u8; 3]) -> f32 {
        let [a, b] = [a, b].map(|codes| luminance(Encoding::Srgb.decode(codes)) + 0.05);
        a.max(b) / a.min(b)
    }

    #[test]
    fn words_can_be_read_on_every_ground() {
        for ground in [Ground::DARK, Ground::LIGHT] {
            for ink in [ground.title, ground.text, ground.weak] {
                assert!(contrast(ink, ground.colour) >= 4.5, "{ink:?} on {ground:?}");
            }
        }
    }

    #[test]
    fn it_is_light_where_the_background_is() {
        let of = |background, top: u8, bottom: u8| {
            let (background_colour, background_bottom) = ([top; 3], [bottom; 3]);
            Ground::of(&Display { background, background_colour, background_bottom, ..Display::default() })
        };
        assert_eq!(of(Background::Environment, 255, 255), Ground::DARK);
        assert_eq!(of(Background::Colour, 255, 0), Ground::LIGHT);
        assert_eq!(of(Background::Colour, 60, 255), Ground::DARK);
        assert_eq!(of(Background::Gradient, 250, 176), Ground::LIGHT);
        assert_eq!(of(Background::Gradient, 0, 200), Ground::DARK);
    }
}
