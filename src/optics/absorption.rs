//! Light that is absorbed along its way.
//!
//! P. Bouguer (1729), *Essai d'optique sur la gradation de la lumière*; J. H. Lambert (1760), *Photometria*; A. Beer
//! (1852). Twin: `assets/shaders/optics/absorption.wgsl`.

use glam::Vec3;

/// The part of light left at the distance that a colour is given for, if that is black: a medium of finite absorption
/// lets some through.
pub const DARKEST: f32 = 1e-6;

/// The absorption coefficient σ per metre, in red, green and blue, of a medium in which white light has this linear colour
/// after this distance in metres: `σ = −ln(colour)/distance`. Colours count from [`DARKEST`] to 1; a distance of zero, or
/// none, stands for a medium that absorbs nothing.
#[must_use]
pub fn coefficient(colour: Vec3, distance: f32) -> Vec3 {
    if distance > 0.0 && distance.is_finite() {
        -colour.clamp(Vec3::splat(DARKEST), Vec3::ONE).map(f32::ln) / distance.max(f32::MIN_POSITIVE * 1e3)
    } else {
        Vec3::ZERO
    }
}

/// The part of the light left after a way in metres: `exp(−σ · length)`.
#[must_use]
pub fn left(sigma: Vec3, length: f32) -> Vec3 {
    (-sigma * length.max(0.0)).exp()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_colour_is_that_at_its_distance() {
        let colour = Vec3::new(0.9, 0.5, 0.02);
        for distance in [0.001, 0.5, 40.0] {
            let sigma = coefficient(colour, distance);
            assert!((left(sigma, distance) - colour).abs().max_element() < 1e-6, "{distance}");
            // Half the way twice, or twice the way: Bouguer's law.
            assert!((left(sigma, 2.0 * distance) - colour * colour).abs().max_element() < 1e-6);
            let half = left(sigma, 0.5 * distance);
            assert!((half * half - colour).abs().max_element() < 1e-6);
            assert_eq!(left(sigma, 0.0), Vec3::ONE);
        }
        assert!((coefficient(Vec3::splat(0.5), 2.0).x - 0.346_573_6).abs() < 1e-6);
    }

    #[test]
    fn black_white_and_no_distance_are_finite() {
        assert_eq!(coefficient(Vec3::ONE, 1.0), Vec3::ZERO);
        assert_eq!(coefficient(Vec3::splat(7.0), 1.0), Vec3::ZERO);
        for distance in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert_eq!(coefficient(Vec3::splat(0.5), distance), Vec3::ZERO);
        }
        let black = coefficient(Vec3::ZERO, 1.0);
        assert!(black.is_finite() && (left(black, 1.0).x / DARKEST - 1.0).abs() < 1e-4);
        for distance in [f32::MIN_POSITIVE, 1e-45, 1e30] {
            let sigma = coefficient(Vec3::ZERO, distance);
            assert!(sigma.is_finite(), "{distance}: {sigma}");
            for length in [0.0, -1.0, 1.0, f32::MAX] {
                let rest = left(sigma, length);
                assert!(
                    rest.min_element() >= 0.0 && rest.max_element() <= 1.0,
                    "{distance} {length}: {rest}"
                );
            }
        }
    }
}
