//! From scene-referred light to what a display can show: exposure and tone mapping.

use super::colour::luminance;
use glam::{Mat3, Vec3};

/// A curve that maps light from 0 to ∞ into the display's 0 to 1. The formulas are those of the
/// renderer's pass of the same name, so that both renderers agree.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum ToneMapping {
    /// No curve: what exceeds 1 is clipped. Values stay comparable, so this is the default.
    #[default]
    None,
    /// `c / (1 + c)` per channel (E. Reinhard et al. 2002, *Photographic Tone Reproduction*).
    Reinhard,
    /// Reinhard's curve on luminance alone, which keeps hue.
    ReinhardLuminance,
    /// The fit of the ACES RRT and ODT by S. Hill (2017).
    Aces,
}

impl ToneMapping {
    /// Every choice, in the order in which they are offered.
    pub const ALL: [Self; 4] = [Self::None, Self::Reinhard, Self::ReinhardLuminance, Self::Aces];

    /// The name in scene files and on the command line.
    #[must_use]
    pub fn id(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::Reinhard => "reinhard",
            Self::ReinhardLuminance => "reinhard_luminance",
            Self::Aces => "aces",
        }
    }

    /// The choice of that name.
    #[must_use]
    pub fn from_id(id: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|t| t.id() == id)
    }

    /// The name that people read.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "None (clip)",
            Self::Reinhard => "Reinhard",
            Self::ReinhardLuminance => "Reinhard, luminance",
            Self::Aces => "ACES (fitted)",
        }
    }

    /// Maps one linear colour; the result is within [0, 1] up to clipping by the display.
    #[must_use]
    pub fn map(self, c: Vec3) -> Vec3 {
        match self {
            Self::None => c,
            Self::Reinhard => c / (1.0 + c),
            Self::ReinhardLuminance => {
                let old = luminance(c);
                if old <= 0.0 {
                    return Vec3::ZERO;
                }
                c * (1.0 / (1.0 + old))
            }
            Self::Aces => aces(c),
        }
    }
}

/// S. Hill's fit (2017, in M. Pettineo's *BakingLab*): sRGB → AP1 with the reference rendering
/// transform's saturation, a rational curve, and back.
fn aces(c: Vec3) -> Vec3 {
    // The curve is flat long before; beyond, its squares would overflow to ∞/∞.
    let c = c.min(Vec3::splat(1e8));
    // Rows as published; glam wants columns, hence the transposes.
    let input = Mat3::from_cols_array(&[
        0.59719, 0.35458, 0.04823, 0.07600, 0.90834, 0.01566, 0.02840, 0.13383, 0.83777,
    ])
    .transpose();
    let output = Mat3::from_cols_array(&[
        1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327, -0.07276, 1.07602,
    ])
    .transpose();
    let v = input * c;
    let a = v * (v + 0.024_578_6) - 0.000_090_537;
    let b = v * (0.983_729 * v + 0.432_951) + 0.238_081;
    (output * (a / b)).clamp(Vec3::ZERO, Vec3::ONE)
}

/// The factor of an exposure given in EV: `2^EV`.
#[must_use]
pub fn exposure_factor(ev: f32) -> f32 {
    ev.exp2()
}

#[cfg(test)]
mod tests {
    use super::{super::colour::LUMINANCE, *};

    #[test]
    fn one_ev_is_a_factor_of_two() {
        assert_eq!(exposure_factor(0.0), 1.0);
        assert_eq!(exposure_factor(1.0), 2.0);
        assert_eq!(exposure_factor(-2.0), 0.25);
    }

    #[test]
    fn curves_keep_black_black_and_never_leave_the_display() {
        for tone in ToneMapping::ALL {
            assert!(tone.map(Vec3::ZERO).abs().max_element() < 1e-3, "{tone:?}");
            if tone != ToneMapping::None {
                for light in [1000.0, 1e30] {
                    let bright = tone.map(Vec3::splat(light));
                    assert!(
                        bright.min_element() > 0.9 && bright.max_element() < 1.000_001,
                        "{tone:?} gives {bright}"
                    );
                }
            }
            assert_eq!(ToneMapping::from_id(tone.id()), Some(tone));
        }
    }

    #[test]
    fn reinhard_maps_one_to_one_half_and_its_luminance_form_keeps_hue() {
        assert_eq!(ToneMapping::Reinhard.map(Vec3::ONE), Vec3::splat(0.5));
        let c = Vec3::new(4.0, 1.0, 0.5);
        let mapped = ToneMapping::ReinhardLuminance.map(c);
        assert!((mapped / c - (mapped / c).x).abs().max_element() < 1e-6);
        assert!((mapped.dot(LUMINANCE) - luminance(c) / (1.0 + luminance(c))).abs() < 1e-6);
    }
}
