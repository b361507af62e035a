//! The conversion of light to the picture on the display, and what the picture shows behind everything.

use glam::Vec3;

use super::{
    Field,
    field::Kind,
    held::{Word, word},
    part::part,
};
use crate::{
    declared::choice,
    optics::{
        colour::{Encoding, srgb_decode},
        tone::ToneMapping,
    },
};

choice! {
    /// The background of the picture, behind everything.
    Background {
        #[default]
        Environment "environment" "environment" "What visible light at infinity shows: environments and suns. Where there is none, a neutral grey, which tone mapping changes.",
        Colour "colour" "colour" "One colour, shown as it is picked, in place of light at infinity.",
        Gradient "gradient" "gradient" "From one colour at the upper edge of the picture to another at the lower, shown as they are picked, in place of light at infinity.",
    }
}

word! {
    Background: |background| background.name(), background.summary();
}

/// The declaration of exposures, those of variants too.
pub(super) const EXPOSURE: Field = Field::number("the exposure", -16.0..=16.0).unit("EV").slider(-8.0, 8.0);

part! {
    /// Conversion of light to the picture on the display, and the background of the picture.
    #[derive(Copy)]
    pub struct Display("display") {
        /// Tone mapping: the curve from light to display.
        tone_mapping: ToneMapping = Field::of("the tone mapping", Kind::Choice(ToneMapping::words)).always(), ToneMapping::None;
        /// Exposure in EV: each step up doubles the light.
        exposure: f32 = EXPOSURE.always(), 0.0;
        /// `srgb`: colours are decoded before and encoded after the calculation. `off`: neither; deliberately wrong, for
        /// comparison.
        encoding: Encoding =
            Field::of("the encoding", Kind::Choice(Encoding::words)).called("display").always(), Encoding::Srgb;
        /// Background: what the picture shows behind everything.
        background: Background = Field::of("the background", Kind::Choice(Background::words)), Background::Environment;
        /// Colour of the background: [red, green, blue], whole numbers from 0 to 255, sRGB. Of a gradient it is the one at
        /// the upper edge of the picture. Neither exposure nor tone mapping changes it.
        background_colour: [u8; 3] =
            Field::of("the colour of the background", Kind::Colour).called("background colour").unit("sRGB"), [255; 3];
        /// Colour of a gradient at the lower edge of the picture: [red, green, blue], whole numbers from 0 to 255, sRGB.
        background_bottom: [u8; 3] = Field::of("the colour of the background at the bottom", Kind::Colour)
            .called("background colour at the bottom").unit("sRGB"), [184; 3];
    }
}

impl Display {
    /// The colours of the background at the upper and at the lower edge of the picture, sRGB-encoded; `None` where
    /// light at infinity and the neutral grey are shown.
    #[must_use]
    pub const fn backdrop(&self) -> Option<[[u8; 3]; 2]> {
        match self.background {
            Background::Environment => None,
            Background::Colour => Some([self.background_colour; 2]),
            Background::Gradient => Some([self.background_colour, self.background_bottom]),
        }
    }

    /// The background at a height of the picture, 0 at its upper edge and 1 at its lower, as the display shows it: linear
    /// Rec. 709. The sRGB codes c of a gradient change evenly, as in drawing programs and in CSS:
    /// `c = c_top + (c_bottom − c_top) · down`, a fraction between two codes where it falls.
    #[must_use]
    pub fn behind(&self, down: f32) -> Option<Vec3> {
        let [top, bottom] = self.backdrop()?.map(|codes| Vec3::from(codes.map(f32::from)));
        Some((top.lerp(bottom, down) / 255.0).map(srgb_decode))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_codes_of_a_gradient_change_evenly_from_edge_to_edge() {
        let mut display = Display { background_colour: [200, 0, 30], ..Display::default() };
        let codes = |display: &Display, down| display.behind(down).map(|light| Encoding::Srgb.encode(light));
        assert_eq!(codes(&display, 0.5), None);
        display.background = Background::Colour;
        assert_eq!([0.0, 0.3, 1.0].map(|down| codes(&display, down)), [Some([200, 0, 30]); 3]);
        (display.background, display.background_bottom) = (Background::Gradient, [100, 200, 30]);
        let expected = [[200, 0, 30], [175, 50, 30], [150, 100, 30], [100, 200, 30]].map(Some);
        assert_eq!([0.0, 0.25, 0.5, 1.0].map(|down| codes(&display, down)), expected);
    }
}
