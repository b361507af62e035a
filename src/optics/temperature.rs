//! Colour temperature: the colour of a glowing black body.

use glam::{DMat3, DVec3, Vec3};

use super::colour::{luminance, srgb_encode, srgb_encode8};

/// The lowest colour temperature of a light, kelvin: a dull red glow.
pub const MIN_TEMPERATURE: f32 = 1000.0;
/// The highest colour temperature of a light, kelvin: bluer than any sky.
pub const MAX_TEMPERATURE: f32 = 40_000.0;
/// The temperature that looks white on an sRGB display, kelvin (CIE illuminant D65 is near it).
pub const WHITE_TEMPERATURE: f32 = 6500.0;

/// The second radiation constant `hc / k` in nm K (CODATA 2018).
const C2: f64 = 1.438_776_877e7;

/// The CIE 1931 colour matching functions at a wavelength in nanometres: the fit of several Gaussian
/// lobes by C. Wyman, P.-P. Sloan and P. Shirley (2013), *Simple Analytic Approximations to the CIE XYZ
/// Color Matching Functions*, JCGT 2(2), equation 4.
#[must_use]
pub fn colour_matching(nm: f64) -> DVec3 {
    // A Gaussian whose width differs on either side of its peak.
    let lobe = |height: f64, peak: f64, below: f64, above: f64| {
        let t = (nm - peak) * if nm < peak { below } else { above };
        height * (-0.5 * t * t).exp()
    };
    DVec3::new(
        lobe(0.362, 442.0, 0.0624, 0.0374)
            + lobe(1.056, 599.8, 0.0264, 0.0323)
            + lobe(-0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    )
}

/// CIE 1931 XYZ of a black body of a temperature in kelvin, of no particular brightness: M. Planck's law
/// (1901), `B(λ) ∝ λ⁻⁵ / (exp(hc / λkT) − 1)`, weighted by [`colour_matching`] and added up from 380 to
/// 780 nm in steps of 5 nm. The fit of the weights leaves an error of chromaticity of 0.0002 at 6500 K
/// and above, and of 0.003 at 2000 K.
#[must_use]
pub fn black_body_xyz(kelvin: f64) -> DVec3 {
    // Relative to 560 nm, so that no temperature overflows or vanishes.
    let planck =
        |nm: f64| (560.0 / nm).powi(5) * ((C2 / (560.0 * kelvin)).exp_m1() / (C2 / (nm * kelvin)).exp_m1());
    (0..=80).map(|i| 380.0 + 5.0 * f64::from(i)).map(|nm| planck(nm) * colour_matching(nm)).sum()
}

/// The linear Rec. 709 colour of a black body of a temperature in kelvin, clamped to the legal range.
///
/// Colours outside the gamut are clamped (blue, below about 1900 K), and the largest channel is 1: the colour
/// as a display shows it. [`light_of`] gives light of this colour.
#[must_use]
pub fn black_body(kelvin: f32) -> Vec3 {
    let kelvin = if kelvin.is_nan() { WHITE_TEMPERATURE } else { kelvin };
    let xyz = black_body_xyz(f64::from(kelvin.clamp(MIN_TEMPERATURE, MAX_TEMPERATURE)));
    // IEC 61966-2-1; rows as published.
    let to_rgb =
        DMat3::from_cols_array(&[3.2406, -1.5372, -0.4986, -0.9689, 1.8758, 0.0415, 0.0557, -0.2040, 1.0570])
            .transpose();
    let rgb = (to_rgb * xyz).max(DVec3::ZERO);
    (rgb / rgb.max_element()).as_vec3()
}

/// Light of the hue of a colour, with the luminance of white: candela, lumen and lux are photometric, so equal numbers
/// are equally bright at every temperature. Channels may exceed 1. Black stays black.
#[must_use]
pub fn light_of(colour: Vec3) -> Vec3 {
    let luminance = luminance(colour);
    if luminance > 0.0 { colour / luminance } else { Vec3::ZERO }
}

/// The colour of [`black_body`], sRGB-encoded in eight bits.
#[must_use]
pub fn black_body_rgb8(kelvin: f32) -> [u8; 3] {
    black_body(kelvin).to_array().map(srgb_encode8)
}

/// The temperature in kelvin, rounded to hundreds, whose colour is nearest to an sRGB colour.
#[must_use]
pub fn nearest_temperature([r, g, b]: [u8; 3]) -> f32 {
    let wanted = Vec3::new(f32::from(r), f32::from(g), f32::from(b));
    let wanted = wanted / wanted.max_element().max(1.0);
    let distance = |kelvin: f32| (black_body(kelvin).map(srgb_encode) - wanted).length_squared();
    // Equal steps of 1/T look about equally large.
    let reciprocal = |i: u16| 1e6 / (25.0 + 5.0 * f32::from(i));
    let nearest = (0..=195).map(reciprocal).min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
    (nearest.unwrap_or(WHITE_TEMPERATURE) / 100.0).round() * 100.0
}

#[cfg(test)]
mod tests {
    use super::*;

    fn chromaticity(xyz: DVec3) -> [f64; 2] {
        let sum = xyz.element_sum();
        [xyz.x / sum, xyz.y / sum]
    }

    /// Chromaticities of black bodies from tables: CIE illuminant A at 2856 K, and G. Wyszecki and W. S.
    /// Stiles (1982), *Color Science*.
    const PUBLISHED: [(f64, [f64; 2]); 4] = [
        (2000.0, [0.5267, 0.4133]),
        (2856.0, [0.4476, 0.4074]),
        (6500.0, [0.3135, 0.3237]),
        (10_000.0, [0.2807, 0.2884]),
    ];

    fn worst(of: impl Fn(f64) -> DVec3) -> f64 {
        let error = |(kelvin, [x, y]): (f64, [f64; 2])| {
            let [our_x, our_y] = chromaticity(of(kelvin));
            (our_x - x).abs().max((our_y - y).abs())
        };
        PUBLISHED.into_iter().map(error).fold(0.0, f64::max)
    }

    #[test]
    fn chromaticities_are_those_of_the_tables() {
        let error = worst(black_body_xyz);
        assert!(error < 0.003, "{error}");
        // Wrong twins: 3 % too hot, and the law of W. Wien (1896), which lacks the −1.
        assert!(worst(|kelvin| black_body_xyz(1.03 * kelvin)) > 0.003);
        let wien = |kelvin: f64| {
            let law = |nm: f64| (560.0 / nm).powi(5) * (-C2 / (nm * kelvin)).exp();
            (0..=80).map(|i| 380.0 + 5.0 * f64::from(i)).map(|nm| law(nm) * colour_matching(nm)).sum()
        };
        assert!(worst(wien) > 0.003);
    }

    #[test]
    fn colours_go_from_red_over_white_to_blue() {
        let white = black_body(6500.0);
        assert!(white.min_element() > 0.9, "6500 K is nearly white: {white}");
        let candle = black_body(1900.0);
        assert!(candle.x == 1.0 && candle.y < 0.35 && candle.z < 0.05, "a candle is orange: {candle}");
        let ratios: Vec<_> = (10..=400).map(|h| black_body(100.0 * h as f32)).map(|c| c.z / c.x).collect();
        assert!(ratios.windows(2).all(|r| r[1] >= r[0]), "blue over red rises with the temperature");
        assert!(ratios[0] == 0.0 && *ratios.last().expect("not empty") > 1.5);
    }

    #[test]
    fn every_temperature_has_a_colour_whose_largest_channel_is_1() {
        for kelvin in [f32::NEG_INFINITY, 0.0, 1000.0, 1900.0, 6500.0, 40_000.0, f32::INFINITY, f32::NAN] {
            let c = black_body(kelvin);
            assert!(c.max_element() == 1.0 && c.min_element() >= 0.0, "{kelvin} K: {c}");
        }
    }

    #[test]
    fn the_temperature_of_a_colour_is_found_again() {
        for kelvin in [2000.0, 2700.0, 4000.0, 5600.0, 9000.0] {
            let found = nearest_temperature(black_body_rgb8(kelvin));
            assert!((found / kelvin - 1.0).abs() < 0.03, "{kelvin} K was found as {found} K");
        }
        assert!((nearest_temperature([255; 3]) - WHITE_TEMPERATURE).abs() <= 300.0);
        assert!(nearest_temperature([0; 3]).is_finite());
    }
}
