//! From linear light to eight bits.

use std::sync::LazyLock;

use glam::{Vec3, Vec4};

use crate::{
    optics::{
        colour::{BACKGROUND, Encoding, srgb_decode, srgb_encode, srgb_encode8},
        tone::exposure_factor,
    },
    scene::Display,
};

/// Encodes to eight bits without calculating powers, and with exactly the result of `round(255 ·
/// srgb_encode(x))`.
struct Encoder {
    /// The smallest number with each code.
    threshold: [f32; 256],
    /// The code of the smallest number that begins with these bits, from [`FIRST`](Self::FIRST) on.
    start: Vec<u8>,
}

static ENCODER: LazyLock<Encoder> = LazyLock::new(Encoder::new);

impl Encoder {
    /// Dropped bits: sign, exponent and seven bits of mantissa remain, so that hardly any slot contains more than one
    /// threshold.
    const SHIFT: u32 = 16;
    /// The slot of 2⁻¹². Smaller numbers take the slow path of at most one step.
    const FIRST: u32 = ((127 - 12) << 23) >> Self::SHIFT;

    fn new() -> Self {
        let mut threshold = [0.0; 256];
        for code in 1..=255u8 {
            // The inverse function is off by at most a few of the last bits.
            let mut x = srgb_decode((f32::from(code) - 0.5) / 255.0);
            while srgb_encode8(x) >= code {
                x = x.next_down();
            }
            while srgb_encode8(x) < code {
                x = x.next_up();
            }
            threshold[usize::from(code)] = x;
        }
        let last = 1.0f32.to_bits() >> Self::SHIFT;
        let start =
            (Self::FIRST..=last).map(|slot| srgb_encode8(f32::from_bits(slot << Self::SHIFT))).collect();
        Self { threshold, start }
    }

    #[inline]
    fn encode(&self, x: f32) -> u8 {
        if x.is_nan() || x <= 0.0 {
            return 0;
        }
        if x >= 1.0 {
            return 255;
        }
        let slot = x.to_bits() >> Self::SHIFT;
        let mut code = match slot.checked_sub(Self::FIRST) {
            Some(i) => self.start[i as usize],
            None => 0,
        };
        while code < 255 && x >= self.threshold[usize::from(code) + 1] {
            code += 1;
        }
        code
    }
}

/// The sRGB code of a linear number: `round(255 · srgb_encode(clamp(x, 0, 1)))`, exactly, for every
/// number; 0 for NaN.
#[must_use]
pub fn encode8(x: f32) -> u8 {
    ENCODER.encode(x)
}

/// The steps of a pixel from light to the display.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DisplaySteps {
    /// The light of the objects: linear Rec. 709, before exposure.
    pub light: Vec3,
    /// The fraction of the pixel covered by objects; the rest is background.
    pub coverage: f32,
    /// The factor of the exposure, `2^EV`.
    pub exposure: f32,
    /// Light times exposure, plus the neutral background, to which exposure does not apply. A background that the scene
    /// gives is in it only where nothing else is.
    pub exposed: Vec3,
    /// The input of the tone curve: without encoding, the decoded numbers, so that encoding restores them;
    /// otherwise unchanged.
    pub input: Vec3,
    /// The result of the tone curve. A background that the scene gives is joined to it: the curve does not apply to that.
    pub mapped: Vec3,
    /// Clipped to the range of the display and sRGB-encoded, 0 to 1.
    pub encoded: Vec3,
    /// The encoded values in eight bits, rounded; 0 for NaN.
    pub codes: [u8; 3],
}

/// The conversion from a pixel of light to a pixel on the display, with common parts calculated once.
pub(super) struct DisplayTransform {
    display: Display,
    exposure: f32,
    /// The neutral background.
    grey: Vec3,
    encoder: &'static Encoder,
}

impl DisplayTransform {
    pub(super) fn new(display: &Display) -> Self {
        Self {
            display: *display,
            exposure: exposure_factor(display.exposure),
            grey: display.encoding.decode(BACKGROUND),
            encoder: &ENCODER,
        }
    }

    /// The background that the scene gives, at the middle of a row of a picture of this height.
    pub(super) fn behind(&self, row: usize, height: usize) -> Option<Vec3> {
        self.display.behind((row as f32 + 0.5) / height.max(1) as f32)
    }

    /// Converts the light of objects, and the fraction of the pixel that they cover, to sRGB. `behind` is the background
    /// that the scene gives, if any.
    pub(super) fn apply(&self, pixel: Vec4, behind: Option<Vec3>) -> [u8; 3] {
        let [.., c] = self.curve(pixel, behind);
        self.codes(c)
    }

    /// The light after exposure, the input of the tone curve, and its result. Where only the result is asked for, the rest
    /// is not calculated.
    #[inline]
    fn curve(&self, pixel: Vec4, behind: Option<Vec3>) -> [Vec3; 3] {
        let (light, covered) = (pixel.truncate() * self.exposure, pixel.w);
        let exposed = match behind {
            None => light + (1.0 - covered) * self.grey,
            Some(background) if covered <= 0.0 => return [background; 3],
            // The light of the covered part alone: the background is beyond the curve.
            Some(_) => light / covered,
        };
        let input = match self.display.encoding {
            Encoding::Srgb => exposed,
            // The encoding that follows must return the number itself.
            Encoding::Off => exposed.clamp(Vec3::ZERO, Vec3::ONE).map(srgb_decode),
        };
        let mapped = self.display.tone_mapping.map(input);
        let joined = behind.map_or(mapped, |background| covered * mapped + (1.0 - covered) * background);
        [exposed, input, joined]
    }

    #[inline]
    fn codes(&self, c: Vec3) -> [u8; 3] {
        [self.encoder.encode(c.x), self.encoder.encode(c.y), self.encoder.encode(c.z)]
    }

    /// [`apply`](Self::apply), step by step.
    pub(super) fn steps(&self, pixel: Vec4, behind: Option<Vec3>) -> DisplaySteps {
        let [exposed, input, mapped] = self.curve(pixel, behind);
        DisplaySteps {
            light: pixel.truncate(),
            coverage: pixel.w,
            exposure: self.exposure,
            exposed,
            input,
            mapped,
            encoded: mapped.clamp(Vec3::ZERO, Vec3::ONE).map(srgb_encode),
            codes: self.codes(mapped),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{optics::tone::ToneMapping, scene::Background};

    #[test]
    fn thresholds_lie_where_the_formula_goes_from_one_code_to_the_next() {
        for code in 1..=255 {
            let mut x = ENCODER.threshold[code];
            for _ in 0..64 {
                x = x.next_down();
            }
            for _ in 0..128 {
                assert_eq!(encode8(x), srgb_encode8(x), "{x}");
                x = x.next_up();
            }
        }
        // A wrong twin, with thresholds in the middle of the codes' linear values, is rejected.
        let between =
            |code: u8| 0.5 * (Encoding::Srgb.decode([code; 3]).x + Encoding::Srgb.decode([code - 1; 3]).x);
        assert!((1..=255).any(|code| (between(code) - ENCODER.threshold[usize::from(code)]).abs() > 1e-6));
    }

    #[test]
    fn the_table_gives_the_code_of_the_formula_for_every_number_from_0_to_1() {
        use rayon::prelude::*;
        // Below this, the formula is a product and a rounding, and the table comparisons with thresholds: neither ever goes
        // down, so that between two numbers with one code all have it.
        let straight = 2.0f32.powi(-13);
        for x in [0.0, straight] {
            assert_eq!([encode8(x), srgb_encode8(x)], [0, 0], "{x}");
        }
        (straight.to_bits()..=1.0f32.to_bits()).into_par_iter().for_each(|bits| {
            let x = f32::from_bits(bits);
            assert_eq!(encode8(x), srgb_encode8(x), "{x}");
        });
    }

    #[test]
    fn what_is_no_light_is_clipped() {
        for (x, code) in [(-1.0, 0), (f32::NAN, 0), (f32::INFINITY, 255), (2.0, 255), (-0.0, 0), (1e-40, 0)] {
            assert_eq!(encode8(x), code, "{x}");
        }
    }

    #[test]
    fn the_steps_end_at_the_code_of_the_picture() {
        let mut largest: f32 = 0.0;
        for tone_mapping in ToneMapping::ALL {
            for encoding in Encoding::ALL {
                for exposure in [-1.5, 0.0, 2.0] {
                    let display = Display { tone_mapping, exposure, encoding, ..Display::default() };
                    let transform = DisplayTransform::new(&display);
                    for i in 0..200 {
                        let i = i as f32;
                        let pixel =
                            Vec4::new(0.01 * i, 0.003 * i, 2.0 / (i + 1.0), [0.0, 1.0, 0.5][i as usize % 3]);
                        let behind = (i as u32).is_multiple_of(2).then_some(Vec3::new(0.2, 0.5, 0.9));
                        let steps = transform.steps(pixel, behind);
                        assert_eq!(steps.codes, transform.apply(pixel, behind), "{tone_mapping:?} {pixel}");
                        // Rounding is the last step: the code differs by at most a half.
                        for (code, encoded) in steps.codes.into_iter().zip(steps.encoded.to_array()) {
                            let rest = (f32::from(code) - 255.0 * encoded).abs();
                            assert!(rest < 0.501, "{tone_mapping:?} {pixel}: {code} {encoded}");
                            largest = largest.max(rest);
                        }
                    }
                }
            }
        }
        assert!(largest > 0.4, "rounded to nearest, not cut off: {largest}");
    }

    #[test]
    fn exposure_changes_light_but_not_the_background() {
        for encoding in Encoding::ALL {
            for exposure in [-3.0, 0.0, 3.0] {
                let display = Display { exposure, encoding, ..Display::default() };
                assert_eq!(DisplayTransform::new(&display).apply(Vec4::ZERO, None), BACKGROUND);
            }
        }
        let bright = Display { exposure: 1.0, ..Display::default() };
        let pixel = Vec4::new(0.1, 0.2, 0.3, 1.0);
        assert_eq!(DisplayTransform::new(&bright).apply(pixel, None), [0.2, 0.4, 0.6].map(encode8));
    }

    #[test]
    fn a_background_of_the_scene_is_shown_as_it_is_picked_and_joined_to_what_the_curve_gives() {
        for tone_mapping in ToneMapping::ALL {
            for encoding in Encoding::ALL {
                let plain = Display { tone_mapping, encoding, exposure: 2.0, ..Display::default() };
                let picked =
                    Display { background: Background::Colour, background_colour: [250, 120, 3], ..plain };
                let [before, transform] = [plain, picked].map(|display| DisplayTransform::new(&display));
                let behind = transform.behind(3, 7);
                let apply = |pixel| transform.apply(pixel, behind);
                assert_eq!(apply(Vec4::ZERO), [250, 120, 3], "{tone_mapping:?}");
                // Where objects cover the pixel, there is no background.
                let covered = Vec4::new(0.4, 0.1, 0.05, 1.0);
                assert_eq!(apply(covered), before.apply(covered, None), "{tone_mapping:?}");
                // Half of a pixel: the mean of both as light of the display.
                let light = |pixel| transform.steps(pixel, behind).mapped;
                let mean = 0.5 * (light(covered) + light(Vec4::ZERO));
                assert!((light(0.5 * covered) - mean).abs().max_element() < 1e-6, "{tone_mapping:?}");
            }
        }
    }

    #[test]
    fn without_encoding_numbers_go_to_the_display_as_they_are() {
        let display = Display { encoding: Encoding::Off, ..Display::default() };
        let pixel = Vec4::new(0.0, 0.5, 2.0, 1.0);
        assert_eq!(DisplayTransform::new(&display).apply(pixel, None), [0, 128, 255]);
    }
}
