//! Powers of many numbers at once: without branches and calls, so that the compiler calculates several per
//! instruction, with identical results on every machine.

/// Adding this number rounds to a whole number: 1.5 · 2²³.
const ROUND: f32 = 12_582_912.0;

/// The binary logarithm of a positive number, about −127 of 0; the error is below 3e-7 of the larger of 1 and the
/// result.
#[inline(always)]
fn log2(x: f32) -> f32 {
    // x = m · 2ᵉ with m from √½ to √2, and log₂ m = 2/ln 2 · artanh((m − 1)/(m + 1)).
    let bits = x.to_bits() as i32;
    let e = (bits - 0x3f35_04f3) >> 23;
    let m = f32::from_bits((bits - (e << 23)) as u32);
    let s = (m - 1.0) / (m + 1.0);
    let s2 = s * s;
    let series = 1.0 + s2 * (1.0 / 3.0 + s2 * (0.2 + s2 * (1.0 / 7.0 + s2 * (1.0 / 9.0))));
    e as f32 + 2.0 * std::f32::consts::LOG2_E * s * series
}

/// 2ˣ for x from −127 to 127; the relative error is below 3e-7.
#[inline(always)]
fn exp2(x: f32) -> f32 {
    let shifted = x + ROUND;
    let scale = f32::from_bits((shifted.to_bits() << 23).wrapping_add(0x3f80_0000));
    // The series of the exponential of the remainder, which is at most ½ ln 2.
    let t = (x - (shifted - ROUND)) * std::f32::consts::LN_2;
    let rest = 1.0 / 6.0 + t * (1.0 / 24.0 + t * (1.0 / 120.0 + t * (1.0 / 720.0 + t * (1.0 / 5040.0))));
    scale * (1.0 + t * (1.0 + t * (0.5 + t * rest)))
}

/// xᵖ for x from 0 to 2¹⁰ and p from 0 to 1.
#[inline(always)]
pub(super) fn power(x: f32, p: f32) -> f32 {
    exp2(p * log2(x))
}

/// ³√x for x from 0 to 2¹⁰.
#[inline(always)]
pub(super) fn cube_root(x: f32) -> f32 {
    power(x, 1.0 / 3.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_are_those_of_the_standard_library() {
        for p in [0.0, 0.1, 1.0 / 3.0, 0.5, 0.7, 0.99, 1.0f32] {
            for x in (0..=4000).map(|i| 1e-6 + (i as f32 / 400.0).powi(3)) {
                let (ours, right) = (power(x, p), x.powf(p));
                assert!((ours - right).abs() <= 3e-6 * right, "{x}^{p}: {ours}, {right}");
            }
        }
        assert_eq!(power(0.0, 0.0), 1.0);
        assert!(power(0.0, 0.7) < 1e-20 && power(0.0, 1.0) < 1e-20);
        assert!((cube_root(0.125) - 0.5).abs() < 1e-6);
    }
}
