//! Refractive index by wavelength, and the colour of wavelengths.
//!
//! Twin: `assets/shaders/optics/dispersion.wgsl`. Wavelengths are in nanometres, in vacuum.

use glam::Vec3;

/// The wavelengths of Fraunhofer's lines F, d and C, at which glass is measured.
pub const LINES: [f32; 3] = [486.13, 587.56, 656.28];

/// The range of visible wavelengths, and the number of equal parts of it in which [`spectrum`] is linear.
pub const VISIBLE: [f32; 2] = [400.0, 720.0];
/// See [`VISIBLE`].
pub const PARTS: u32 = 16;

/// Largest dispersion 1/V_d: twice that of the heaviest flint.
pub const STRONGEST: f32 = 0.1;

/// `1/λ²` in µm⁻².
fn inverse_square(nm: f32) -> f32 {
    let micrometres = 1e-3 * nm;
    1.0 / (micrometres * micrometres)
}

/// The refractive index at a wavelength, from that at the d line and the coefficient `b` in µm²: `n(λ) = A + B/λ²` with A
/// such that `n(λ_d) = n_d`. At least 0.01.
///
/// A. L. Cauchy (1836), *Mémoire sur la dispersion de la lumière*.
#[must_use]
pub fn cauchy(n_d: f32, b: f32, nm: f32) -> f32 {
    (n_d + b * (inverse_square(nm) - inverse_square(LINES[1]))).max(0.01)
}

/// The coefficient B of [Cauchy's equation](cauchy) for an Abbe number `V_d = (n_d − 1)/(n_F − n_C)`: 64 for crown glass,
/// 55 for diamond, 36 for flint; smaller numbers disperse more. 0, no dispersion, for numbers that are not positive.
///
/// E. Abbe (1886); catalogues of glasses give it.
#[must_use]
pub fn cauchy_of_abbe(n_d: f32, abbe: f32) -> f32 {
    let wide = inverse_square(LINES[0]) - inverse_square(LINES[2]);
    if abbe > 0.0 { (n_d - 1.0) / (abbe * wide) } else { 0.0 }
}

/// The Abbe number of a medium with this coefficient of [Cauchy's equation](cauchy); infinite without dispersion.
#[must_use]
pub fn abbe_of_cauchy(n_d: f32, b: f32) -> f32 {
    let spread = b * (inverse_square(LINES[0]) - inverse_square(LINES[2]));
    if spread == 0.0 { f32::INFINITY } else { (n_d - 1.0) / spread }
}

/// A wavelength, and the light that stands for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wavelength {
    /// The wavelength.
    pub nm: f32,
    /// The red, green and blue by which light of this wavelength is multiplied.
    pub weight: Vec3,
}

/// Red, green and blue at the bounds between the [parts](PARTS) of the visible range, in thousandths; zero at its ends.
/// They are the [matching functions](super::temperature::colour_matching) of CIE 1931 in the primaries of sRGB (IEC
/// 61966-2-1), without their negative parts, which a display cannot show. Each column adds up to 16 000, so that a flat
/// spectrum is white.
const COLOURS: [[u16; 3]; PARTS as usize - 1] = [
    [222, 0, 2081],
    [487, 0, 5508],
    [0, 0, 5276],
    [0, 546, 2481],
    [0, 1726, 654],
    [0, 3488, 0],
    [0, 4192, 0],
    [777, 3524, 0],
    [2978, 2057, 0],
    [4438, 460, 0],
    [3975, 0, 0],
    [2182, 0, 0],
    [756, 0, 0],
    [164, 0, 0],
    [21, 7, 0],
];

/// The wavelength at a fraction `u` of the visible range, 0 to 1, with its colour.
///
/// The mean of the weights over all of the range is white, (1, 1, 1). As they are linear in each of [`PARTS`] equal parts,
/// so is the mean over any `n` equally spaced wavelengths, `u = (i + ξ)/n`, if n is a multiple of 16: exactly, whatever ξ. A
/// picture of so many samples of one wavelength each shows uniform light without colour, and with another ξ for each pixel
/// or round no bands.
#[must_use]
pub fn spectrum(u: f32) -> Wavelength {
    let at = u.clamp(0.0, 1.0) * PARTS as f32;
    let part = (at as usize).min(PARTS as usize - 1);
    let bound = |i: usize| {
        let [r, g, b] = i.checked_sub(1).and_then(|i| COLOURS.get(i)).copied().unwrap_or_default();
        Vec3::new(f32::from(r), f32::from(g), f32::from(b)) / 1000.0
    };
    Wavelength {
        nm: VISIBLE[0] + (VISIBLE[1] - VISIBLE[0]) * at / PARTS as f32,
        weight: bound(part).lerp(bound(part + 1), at - part as f32),
    }
}

#[cfg(test)]
mod tests {
    use glam::{DMat3, DVec3};

    use super::*;
    use crate::optics::temperature::colour_matching;

    #[test]
    fn glass_has_the_indices_of_its_catalogue() {
        // Schott N-BK7 and N-SF11: n_d and V_d, and n_F and n_C from their data sheets.
        for (n_d, abbe, n_f, n_c) in
            [(1.5168, 64.17, 1.522_38, 1.514_32), (1.784_72, 25.68, 1.806_45, 1.775_99)]
        {
            let b = cauchy_of_abbe(n_d, abbe);
            let [f, d, c] = LINES.map(|nm| cauchy(n_d, b, nm));
            assert!((d - n_d).abs() < 1e-6, "{d}");
            assert!(((n_d - 1.0) / (f - c) / abbe - 1.0).abs() < 1e-3, "{f} {c}");
            // Two coefficients do not fit all of the curve, but nearly.
            assert!((f - n_f).abs() < 2e-3 && (c - n_c).abs() < 2e-3, "{f} {c}");
            assert!((abbe_of_cauchy(n_d, b) / abbe - 1.0).abs() < 1e-5);
            // Blue is refracted more than red.
            assert!(cauchy(n_d, b, 400.0) > f && f > c && c > cauchy(n_d, b, 700.0));
        }
        // B of N-BK7, as tables have it.
        assert!((cauchy_of_abbe(1.5168, 64.17) - 0.0042).abs() < 1e-4);
    }

    #[test]
    fn no_dispersion_and_hostile_numbers_are_finite() {
        for abbe in [0.0, -3.0, f32::NAN, f32::INFINITY] {
            assert_eq!(cauchy_of_abbe(1.5, abbe), 0.0);
        }
        assert_eq!(abbe_of_cauchy(1.5, 0.0), f32::INFINITY);
        assert_eq!(cauchy(1.5, 0.0, 450.0), 1.5);
        for b in [-10.0, 10.0, 1e30] {
            assert!(VISIBLE.iter().all(|nm| cauchy(1.5, b, *nm) >= 0.01));
        }
        for u in [-1.0, 0.0, 1.0, 2.0, f32::NAN] {
            assert_eq!(spectrum(u).weight.is_nan(), u.is_nan());
        }
    }

    #[test]
    fn equally_spaced_wavelengths_are_white_together() {
        for n in [16u32, 32, 64, 256] {
            for offset in [0.0, 0.1, 0.5, 0.73, 0.999] {
                let weight = |i| spectrum((i as f32 + offset) / n as f32).weight.as_dvec3();
                let mean = (0..n).map(weight).sum::<DVec3>() / f64::from(n);
                assert!((mean - 1.0).abs().max_element() < 1e-5, "{n} {offset}: {mean}");
            }
        }
        // Other numbers are coloured.
        let mean = (0..13).map(|i| spectrum((i as f32 + 0.1) / 13.0).weight).sum::<Vec3>() / 13.0;
        assert!((mean - 1.0).abs().max_element() > 1e-3, "{mean}");
    }

    #[test]
    fn wavelengths_have_the_colours_of_the_standard_observer() {
        let to_rgb = DMat3::from_cols_array(&[
            3.2406, -1.5372, -0.4986, -0.9689, 1.8758, 0.0415, 0.0557, -0.2040, 1.0570,
        ])
        .transpose();
        let colour = |nm: f64| (to_rgb * colour_matching(nm)).max(DVec3::ZERO);
        let bounds = || (1..PARTS).map(|i| f64::from(spectrum(i as f32 / PARTS as f32).nm));
        let sum: DVec3 = bounds().map(colour).sum();
        for (nm, row) in bounds().zip(COLOURS) {
            let expected = colour(nm) / sum * 16_000.0;
            let found = DVec3::from_array(row.map(f64::from));
            assert!((found - expected).abs().max_element() < 1.0, "{nm}: {found} {expected}");
        }
        assert_eq!(COLOURS.iter().map(|row| u32::from(row[0])).sum::<u32>(), 16_000);
        // The ends are red and violet, the middle green.
        let [violet, green, red] = [0.12f32, 0.44, 0.75].map(|u| spectrum(u).weight);
        assert!(
            violet.z > violet.x && violet.x > violet.y && green.y > 5.0 * green.x.max(green.z),
            "{violet} {green}"
        );
        assert!(red.x > 1.0 && red.y == 0.0 && red.z == 0.0, "{red}");
    }
}
