//! From scene-referred light to the range of a display: exposure and tone mapping.

use std::sync::LazyLock;

use glam::{Mat3, Vec3};

use super::{colour::luminance, table::Table};
use crate::declared::ids;

/// The brightest input of tone mapping, the largest half float: the GPU renderer holds the picture in half floats
/// before its tone mapping pass. Brighter light is clamped to this.
pub const BRIGHTEST: f32 = 65_504.0;

ids! {
    /// A curve that maps light from 0 to ∞ into the display's 0 to 1. The formulas and tables are those of the GPU
    /// renderer's tone mapping, so that both renderers agree; input and output are linear Rec. 709.
    #[derive(Default)]
    ToneMapping {
        /// No curve: values above 1 are clipped. Values stay comparable, so this is the default.
        #[default]
        None = "none",
        /// `c / (1 + c)` per channel (E. Reinhard, M. Stark, P. Shirley, J. Ferwerda 2002, *Photographic Tone
        /// Reproduction for Digital Images*).
        Reinhard = "reinhard",
        /// `c / (1 + Y)` with the luminance `Y` of `c`: Reinhard's curve on luminance alone, which keeps hue
        /// and saturation.
        ReinhardLuminance = "reinhard_luminance",
        /// The fit of the ACES RRT and ODT by S. Hill (2017, in M. Pettineo's *BakingLab*):
        /// `M₂ · (v (v + 0.0245786) − 0.000090537) / (v (0.983729 v + 0.4329510) + 0.238081)` with `v = M₁ c`.
        Aces = "aces",
        /// AgX (T. Sobotka 2022), default contrast: `T(s(M c))`, where `M` moves the primaries inwards,
        /// `s(v) = (log₂(v / 0.18) + 10) / 16.5`, clamped to [0, 1], and `T` is a table of 32³ colours.
        AgX = "agx",
        /// Tony McMapface (T. Stachowiak 2023): `T(c / (1 + c))` with a table `T` of 48³ colours.
        TonyMcMapface = "tony_mc_mapface",
        /// Filmic as in Blender 2.79 to 3.6 (T. Sobotka 2017): `T(s(c))` with
        /// `s(v) = (log₂(v / 0.18) + 11) / 23`, clamped to [0, 1], and a table `T` of 64³ colours.
        BlenderFilmic = "blender_filmic",
        /// Khronos PBR Neutral (The Khronos Group 2024, *PBR Neutral Tone Mapping*, by E. Lalish and others).
        ///
        /// With the smallest channel `x` of `c`, `f = x − 6.25 x²` for `x < 0.08`, and `0.04` above, subtracts the Fresnel
        /// reflection of a dielectric: `c' = c − f`. Where the largest channel `p` of `c'` is below `k = 0.76`, that is the
        /// result. Above, `p' = 1 − (1 − k)² / (p + 1 − 2k)` compresses it, and `c' p' / p` approaches white `p'` by the
        /// fraction `1 − 1 / (0.15 (p − p') + 1)`.
        KhronosPbrNeutral = "khronos_pbr_neutral",
    }
}

impl ToneMapping {
    /// A line about the variant in `tone.txt`: name, author or summary.
    fn line(self, line: usize) -> &'static str {
        include_str!("tone.txt").lines().nth(4 * self as usize + line).unwrap_or_default()
    }

    /// Display name.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.line(0)
    }

    /// Author and year; empty without a curve.
    #[must_use]
    pub fn author(self) -> &'static str {
        self.line(1)
    }

    /// A description in one or two sentences.
    #[must_use]
    pub fn summary(self) -> &'static str {
        self.line(2)
    }

    /// True if the curve needs a table of colours; the others are formulas.
    #[must_use]
    pub fn is_table(self) -> bool {
        self.table().is_some()
    }

    /// The table of colours as a KTX2 file, of the curves that need one.
    #[must_use]
    pub(crate) fn table(self) -> Option<&'static [u8]> {
        match self {
            Self::AgX => Some(include_bytes!("../../assets/tone/agx.ktx2")),
            Self::TonyMcMapface => Some(include_bytes!("../../assets/tone/tony_mc_mapface.ktx2")),
            Self::BlenderFilmic => Some(include_bytes!("../../assets/tone/blender_filmic.ktx2")),
            _ => None,
        }
    }

    /// Maps one linear colour; the result is within [0, 1] up to clipping by the display.
    #[must_use]
    #[inline]
    pub fn map(self, c: Vec3) -> Vec3 {
        let c = c.clamp(Vec3::splat(-BRIGHTEST), Vec3::splat(BRIGHTEST));
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
            Self::AgX => agx(c),
            Self::TonyMcMapface => TONY_MC_MAPFACE.at(c / (c + 1.0)),
            Self::BlenderFilmic => BLENDER_FILMIC.at(log2_shaper(c, -11.0, 12.0)),
            Self::KhronosPbrNeutral => khronos_pbr_neutral(c),
        }
    }
}

// The tables (see assets/tone/README.md), read when a curve that needs one is first used.
static AGX: LazyLock<Table> = LazyLock::new(|| table(ToneMapping::AgX));
static TONY_MC_MAPFACE: LazyLock<Table> = LazyLock::new(|| table(ToneMapping::TonyMcMapface));
static BLENDER_FILMIC: LazyLock<Table> = LazyLock::new(|| table(ToneMapping::BlenderFilmic));

/// The table of a curve that has one.
#[allow(clippy::expect_used)]
fn table(curve: ToneMapping) -> Table {
    let table = Table::from_ktx2(curve.table().unwrap_or_default());
    table.expect("the tables in assets/tone are complete; a test reads them")
}

/// Numbers from 0 to ∞ on a logarithmic scale around middle grey, 0.18: 0 at `min` EV from it and 1 at
/// `max` EV. Below 2⁻¹⁵ a small number is added instead of falling to −∞.
fn log2_shaper(c: Vec3, min: f32, max: f32) -> Vec3 {
    c.max(Vec3::ZERO).map(|v| {
        let v = if v < 3.051_757e-5 { 1.525_878e-5 + v } else { v };
        ((v / 0.18).log2().clamp(min, max) - min) / (max - min)
    })
}

/// AgX: primaries moved inwards, so that bright pure colours desaturate, a logarithmic scale from 10 EV below middle
/// grey to 6.5 EV above, and the table.
fn agx(c: Vec3) -> Vec3 {
    let inwards = Mat3::from_cols_array(&[
        0.842_479_06,
        0.078_433_6,
        0.079_223_75,
        0.042_328_24,
        0.878_468_64,
        0.079_166_13,
        0.042_375_65,
        0.078_433_6,
        0.879_143,
    ])
    .transpose();
    AGX.at(log2_shaper(inwards * c.max(Vec3::ZERO), -10.0, 6.5))
}

/// Khronos PBR Neutral; the formula is at [`ToneMapping::KhronosPbrNeutral`].
fn khronos_pbr_neutral(c: Vec3) -> Vec3 {
    const START: f32 = 0.8 - 0.04;
    const DESATURATION: f32 = 0.15;
    let x = c.min_element();
    let c = c - if x < 0.08 { x - 6.25 * x * x } else { 0.04 };
    let peak = c.max_element();
    if peak < START {
        return c;
    }
    let d = 1.0 - START;
    let compressed = 1.0 - d * d / (peak + d - START);
    let pale = 1.0 - 1.0 / (DESATURATION * (peak - compressed) + 1.0);
    (c * (compressed / peak)).lerp(Vec3::splat(compressed), pale)
}

/// S. Hill's fit (2017, in M. Pettineo's *BakingLab*): sRGB → AP1 with the reference rendering
/// transform's saturation, a rational curve, and back.
fn aces(c: Vec3) -> Vec3 {
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
    fn curves_are_known_where_they_are_published() {
        let near = |tone: ToneMapping, c: Vec3, expected: Vec3, tolerance: f32| {
            let error = (tone.map(c) - expected).abs().max_element();
            assert!(error < tolerance, "{tone:?} maps {c} to {}", tone.map(c));
        };
        // Khronos: up to 0.8 only the 0.04 is subtracted; black stays, and white is never reached.
        near(ToneMapping::KhronosPbrNeutral, Vec3::splat(0.5), Vec3::splat(0.46), 1e-6);
        near(ToneMapping::KhronosPbrNeutral, Vec3::new(0.8, 0.5, 0.2), Vec3::new(0.76, 0.46, 0.16), 1e-6);
        // At 0.08 the two pieces meet.
        near(ToneMapping::KhronosPbrNeutral, Vec3::splat(0.08), Vec3::splat(0.04), 1e-6);
        // AgX shows middle grey as 0.5 encoded, 0.214 linear; Filmic as about 0.18.
        near(ToneMapping::AgX, Vec3::splat(0.18), Vec3::splat(0.2), 0.03);
        near(ToneMapping::BlenderFilmic, Vec3::splat(0.18), Vec3::splat(0.2), 0.04);
        // Tony McMapface resembles Reinhard's curve for greys.
        near(ToneMapping::TonyMcMapface, Vec3::splat(0.5), Vec3::splat(1.0 / 3.0), 0.06);
    }

    #[test]
    fn greys_stay_grey_and_brighter_stays_brighter() {
        for tone in ToneMapping::ALL {
            let greys: Vec<_> =
                (-80..80).map(|i| tone.map(Vec3::splat(0.1 * i as f32).map(f32::exp2))).collect();
            for (i, g) in greys.iter().enumerate() {
                let spread = g.max_element() - g.min_element();
                assert!(spread < 0.01, "{tone:?}: step {i} is {g}");
            }
            // The tables hold nine bits.
            assert!(greys.windows(2).all(|g| g[1].y >= g[0].y - 3e-3), "{tone:?} falls somewhere");
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
