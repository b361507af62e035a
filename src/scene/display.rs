//! The conversion of light to the picture on the display.

use super::{Field, field::Kind, held::Word as _, part::part};
use crate::optics::{colour::Encoding, tone::ToneMapping};

/// The declaration of exposures, those of variants too.
pub(super) const EXPOSURE: Field = Field::number("the exposure", -16.0..=16.0).unit("EV").slider(-8.0, 8.0);

part! {
    /// Conversion of light to the picture on the display.
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
    }
}
