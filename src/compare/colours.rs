//! Colours for differences, distinguishable with any colour vision: from dark to bright for absolute values,
//! from blue over grey to orange for signed ones.

use std::sync::LazyLock;

use crate::{optics::viridis::VIRIDIS, scene::comparison::Sign};

/// From darker to brighter in the other view: blue and vermilion of M. Okabe, K. Ito (2008), *Color Universal
/// Design*, towards black at the ends, with a light grey for equality in the middle.
const BLUE_ORANGE: [[u8; 3]; 9] = [
    [0, 36, 60],
    [0, 76, 120],
    [0, 114, 178],
    [122, 174, 211],
    [236, 236, 236],
    [231, 163, 120],
    [213, 94, 0],
    [143, 60, 0],
    [75, 30, 0],
];

/// The number of steps from one end to the other; even, so that a step is exactly in the middle.
const STEPS: usize = 510;

/// A colour for each difference.
pub(super) struct Colours([[u8; 3]; STEPS + 1]);

static ABSOLUTE: LazyLock<Colours> = LazyLock::new(|| Colours::through(&VIRIDIS));
static SIGNED: LazyLock<Colours> = LazyLock::new(|| Colours::through(&BLUE_ORANGE));

impl Colours {
    /// The colours for differences with or without sign.
    pub(super) fn of(sign: Sign) -> &'static Self {
        match sign {
            Sign::Absolute => &ABSOLUTE,
            Sign::Signed => &SIGNED,
        }
    }

    /// Linear interpolation between colours.
    fn through(anchors: &[[u8; 3]]) -> Self {
        Self(std::array::from_fn(|step| {
            let at = step as f32 / STEPS as f32 * (anchors.len() - 1) as f32;
            let first = (at as usize).min(anchors.len() - 2);
            let part = at - first as f32;
            std::array::from_fn(|c| {
                let [from, to] = [first, first + 1].map(|i| f32::from(anchors[i][c]));
                (from + part * (to - from)).round() as u8
            })
        }))
    }

    /// The colour at a position from 0 to 1; positions beyond are clamped.
    pub(super) fn at(&self, place: f32) -> [u8; 3] {
        self.0[(place.clamp(0.0, 1.0) * STEPS as f32 + 0.5) as usize]
    }

    /// The colour of a difference, where 1 is the largest distinguishable one.
    pub(super) fn of_difference(&self, sign: Sign, difference: f32) -> [u8; 3] {
        self.at(match sign {
            Sign::Absolute => difference.abs(),
            Sign::Signed => 0.5 + 0.5 * difference,
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::{Mat3, Vec3};

    use super::*;
    use crate::optics::colour::{Encoding, luminance};

    fn linear(colour: [u8; 3]) -> Vec3 {
        Encoding::Srgb.decode(colour)
    }

    #[test]
    fn the_colours_between_the_anchors_are_those_of_viridis() {
        // Values from Matplotlib 3, `colormaps["viridis"](i)`.
        for (i, right) in [
            (8, [71, 13, 96]),
            (40, [69, 55, 129]),
            (100, [42, 118, 142]),
            (200, [112, 207, 87]),
            (250, [241, 229, 29]),
        ] {
            let found = Colours::of(Sign::Absolute).at(i as f32 / 255.0);
            for c in 0..3 {
                assert!(found[c].abs_diff(right[c]) <= 2, "{i}: {found:?}, {right:?}");
            }
        }
    }

    #[test]
    fn larger_differences_are_brighter_and_signed_ones_darker() {
        let brightness = |sign, at| luminance(linear(Colours::of(sign).at(at)));
        for i in 0..100 {
            let (at, next) = (i as f32 / 100.0, (i + 1) as f32 / 100.0);
            assert!(brightness(Sign::Absolute, at) < brightness(Sign::Absolute, next), "{at}");
            let rises = i < 50;
            assert_eq!(brightness(Sign::Signed, at) < brightness(Sign::Signed, next), rises, "{at}");
        }
        let [r, g, b] = Colours::of(Sign::Signed).of_difference(Sign::Signed, 0.0);
        assert_eq!((r, r), (g, b), "no difference has no hue");
    }

    /// The colour as seen without cones for green, or for red: F. Viénot, H. Brettel, J. D. Mollon (1999),
    /// *Digital Video Colourmaps for Checking the Legibility of Displays by Dichromats*, as matrices for
    /// linear light.
    #[test]
    fn people_who_confuse_red_and_green_tell_the_signs_apart() {
        let deuteranope =
            Mat3::from_cols_array(&[0.29275, 0.29275, -0.02234, 0.70725, 0.70725, 0.02234, 0.0, 0.0, 1.0]);
        let protanope =
            Mat3::from_cols_array(&[0.11238, 0.11238, 0.00401, 0.88762, 0.88762, -0.00401, 0.0, 0.0, 1.0]);
        let distance = |eye: Mat3, a: [u8; 3], b: [u8; 3]| {
            let [a, b] = [a, b].map(|c| Encoding::Srgb.encode(eye * linear(c)));
            (0..3).map(|c| a[c].abs_diff(b[c])).max()
        };
        for eye in [deuteranope, protanope] {
            for size in [0.25, 0.5, 0.75] {
                let [plus, minus] =
                    [size, -size].map(|d| Colours::of(Sign::Signed).of_difference(Sign::Signed, d));
                assert!(distance(eye, plus, minus) > Some(60), "{size}");
            }
            // A wrong twin, red and green of equal brightness, is rejected.
            assert!(distance(eye, [200, 80, 60], [110, 125, 60]) < Some(60));
        }
    }
}
