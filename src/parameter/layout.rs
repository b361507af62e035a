//! The layout of parameters for shaders.

use super::{Parameter, kind::lanes, values::Values};
use crate::optics::colour::Encoding;

/// Maximum size of a model's parameters, in bytes.
pub const BLOCK_BYTES: usize = 256;

/// The fields of the WGSL struct `Parameters` of a model: name, type, byte offset, in the order of
/// the declarations. The layout is WGSL's (vec3 aligned to 16), the same for uniform and storage buffers.
#[must_use]
pub fn layout(parameters: &[Parameter]) -> Vec<(&'static str, &'static str, usize)> {
    let mut offset = 0usize;
    let mut fields = Vec::with_capacity(parameters.len());
    for p in parameters {
        let lanes = lanes(p.kind.wgsl());
        offset = offset.next_multiple_of(4 * lanes.next_power_of_two());
        fields.push((p.name, p.kind.wgsl(), offset));
        offset += 4 * lanes;
    }
    fields
}

/// Bytes from the parameters of one object to those of the next in the table that the shader reads:
/// the size of the WGSL struct `Parameters`.
#[must_use]
pub fn stride(parameters: &[Parameter]) -> usize {
    let fields = layout(parameters);
    let most = fields.iter().map(|(_, kind, _)| lanes(kind)).max().unwrap_or(1);
    let end = fields.last().map_or(4, |(_, kind, offset)| offset + 4 * lanes(kind));
    end.next_multiple_of(4 * most.next_power_of_two())
}

/// The bytes of the parameters of one object, [`stride`] long.
#[must_use]
pub fn pack(parameters: &[Parameter], values: &Values, encoding: Encoding) -> Vec<u8> {
    let mut block = vec![0u8; stride(parameters)];
    let mut words = Vec::new();
    for ((.., offset), p) in layout(parameters).into_iter().zip(parameters) {
        words.clear();
        p.kind.words(&values.get(p), encoding, &mut words);
        for (to, word) in block[offset..].chunks_exact_mut(4).zip(&words) {
            to.copy_from_slice(&word.to_le_bytes());
        }
    }
    block
}

/// Parameters as words without padding.
#[must_use]
pub fn words(parameters: &[Parameter], values: &Values, encoding: Encoding) -> Vec<u32> {
    let mut words = Vec::new();
    for p in parameters {
        p.kind.words(&values.get(p), encoding, &mut words);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter::{
        kind::Value,
        shared::{BASE_COLOUR, K_A, K_D, K_S, SPECULAR_COLOUR},
    };

    #[test]
    fn the_layout_follows_the_alignment_rules_of_wgsl() {
        let fields = layout(&[K_A, BASE_COLOUR, K_S, SPECULAR_COLOUR]);
        let offsets: Vec<_> = fields.iter().map(|f| f.2).collect();
        assert_eq!(offsets, [0, 16, 28, 32]);
    }

    #[test]
    fn packing_decodes_colours_and_lays_out_numbers() {
        let mut values = Values::default();
        values.set("base_colour", Value::Colour([255, 188, 0]));
        let block = pack(&[BASE_COLOUR, K_D], &values, Encoding::Srgb);
        let at = |i: usize| f32::from_le_bytes(block[i..i + 4].try_into().expect("four bytes"));
        assert_eq!(at(0), 1.0);
        assert!((at(4) - 0.502_886).abs() < 1e-5);
        assert_eq!(at(8), 0.0);
        assert_eq!(at(12), 0.8);
    }
}
