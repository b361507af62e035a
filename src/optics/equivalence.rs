//! The width of a highlight converted between the scales of different models, for comparison.
//!
//! No two of these lobes are equal: they agree in sharpness near their middle, and differ in their tails.

/// The width α of a GGX or Beckmann distribution as sharp as Blinn–Phong's `(N·H)^n`: `α = √(2/(n + 2))`. B. Walter, S.
/// Marschner, H. Li, K. Torrance (2007), *Microfacet Models for Refraction through Rough Surfaces*, section 5.2; B.
/// Karis (2013), *Specular BRDF Reference*. At most 1, reached at n = 0.
#[must_use]
pub fn alpha_of_exponent(n: f32) -> f32 {
    (2.0 / (n.max(0.0) + 2.0)).sqrt()
}

/// The inverse of [`alpha_of_exponent`]: the exponent `n = 2/α² − 2` of a Blinn–Phong lobe, at least 0.
#[must_use]
pub fn exponent_of_alpha(alpha: f32) -> f32 {
    (2.0 / (alpha * alpha) - 2.0).max(0.0)
}

/// The exponent of the Blinn–Phong lobe as sharp as Phong's `(R·V)^n`: 4n. Near the mirror direction, the angle of H
/// from N is half that of V from R, and `cos^{4n}(θ/2) ≈ cos^n θ`: F. Fisher, A. Woo (1994), *R·E versus N·H Specular
/// Highlights*, Graphics Gems IV, 388–400.
#[must_use]
pub fn blinn_of_phong(n: f32) -> f32 {
    4.0 * n
}

/// Perceptual roughness r of a width α: `α = r²` (B. Burley 2012, *Physically-Based Shading at Disney*).
#[must_use]
pub fn roughness_of_alpha(alpha: f32) -> f32 {
    alpha.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The brightness of the lobe at this angle between normal and half vector, relative to its middle.
    fn beckmann(alpha: f32, angle: f32) -> f32 {
        (-(angle.tan() / alpha).powi(2)).exp() / angle.cos().powi(4)
    }

    #[test]
    fn the_scales_agree_where_the_literature_gives_numbers() {
        assert_eq!(alpha_of_exponent(0.0), 1.0);
        assert!((alpha_of_exponent(32.0) - 0.242_536).abs() < 1e-6);
        assert!((roughness_of_alpha(alpha_of_exponent(30.0)) - 0.5).abs() < 1e-6);
        for n in [0.0, 1.0, 32.0, 5000.0] {
            let back = exponent_of_alpha(alpha_of_exponent(n));
            assert!((back - n).abs() < 1e-3 * n.max(1.0), "{n}: {back}");
        }
    }

    #[test]
    fn equivalent_lobes_have_the_same_width() {
        for n in [50.0f32, 200.0, 1000.0] {
            // The angle at which the Blinn–Phong lobe has fallen to a half.
            let angle = 0.5f32.powf(1.0 / n).acos();
            let there = beckmann(alpha_of_exponent(n), angle);
            assert!((there - 0.5).abs() < 0.02, "{n}: {there}");
            // Other rules fail.
            assert!((beckmann((1.0 / (n + 2.0)).sqrt(), angle) - 0.5).abs() > 0.1);
            // A Phong lobe has the same width if its exponent is a quarter.
            let phong = (2.0 * angle).cos().powf(n / 4.0);
            assert!((phong - 0.5).abs() < 0.02, "{n}: {phong}");
            assert_eq!(blinn_of_phong(n / 4.0), n);
        }
    }
}
