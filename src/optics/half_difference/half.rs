//! Two numbers in one: the roots of values as 16-bit floats. The root of a value has twice its range and half its relative
//! error, which is up to 4.9e-4, so a value keeps 9.8e-4 between 3.8e-9 and 4.3e9; what is smaller is 0. No number is
//! subnormal, which graphics cards may flush to 0.

/// The least and the largest root.
const LEAST: f32 = 6.103_515_6e-5;
const MOST: f32 = 65_504.0;
/// 2¹¹²: the difference between the biases of the exponents of 32 and 16 bits.
const BIAS: f32 = 5.192_297e33;

/// The 16 bits of a number from 0 on.
fn bits(number: f32) -> u32 {
    if number < LEAST {
        return 0;
    }
    let scaled = (number.min(MOST) / BIAS).to_bits();
    // To the nearest, ties to even.
    (scaled + 0x0fff + (scaled >> 13 & 1)) >> 13
}

/// The number of the low 16 bits.
fn number(bits: u32) -> f32 {
    f32::from_bits((bits & 0x7fff) << 13) * BIAS
}

/// The roots of two values from 0 on. Their bits are never those of a NaN.
pub(super) fn packed(low: f32, high: f32) -> f32 {
    f32::from_bits(bits(low.sqrt()) | bits(high.sqrt()) << 16)
}

/// The two values.
#[inline]
pub(super) fn unpacked(word: f32) -> [f32; 2] {
    let word = word.to_bits();
    [number(word), number(word >> 16)].map(|root| root * root)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_keep_their_size_within_a_thousandth() {
        let mut value = 4e-9f32;
        while value < 4e9 {
            for pair in [[value, 0.0], [0.25, value]] {
                let word = packed(pair[0], pair[1]);
                assert!(!word.is_nan());
                for (a, b) in unpacked(word).into_iter().zip(pair) {
                    assert!((a - b).abs() <= 9.8e-4 * b, "{a} {b}");
                }
            }
            value *= 1.37;
        }
        assert_eq!(unpacked(packed(1.0, 0.25)), [1.0, 0.25]);
        // Beyond both ends.
        assert_eq!(unpacked(packed(1e-10, 1e30)), [0.0, MOST * MOST]);
    }
}
