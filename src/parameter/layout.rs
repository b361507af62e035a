//! The layout of parameters for shaders.

use super::{declaration::Parameter, values::Values};
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
        let (size, align) = match p.wgsl_type() {
            "vec3<f32>" => (12, 16),
            _ => (4, 4),
        };
        offset = offset.next_multiple_of(align);
        fields.push((p.name, p.wgsl_type(), offset));
        offset += size;
    }
    fields
}

/// Bytes from the parameters of one object to those of the next in the table that the shader reads:
/// the size of the WGSL struct `Parameters`.
#[must_use]
pub fn stride(parameters: &[Parameter]) -> usize {
    let fields = layout(parameters);
    let align = if fields.iter().any(|f| f.1 == "vec3<f32>") { 16 } else { 4 };
    let end = fields.last().map_or(4, |(_, kind, offset)| offset + if *kind == "vec3<f32>" { 12 } else { 4 });
    end.next_multiple_of(align)
}

/// The bytes of the parameters of one object, [`stride`] long.
#[must_use]
pub fn pack(parameters: &[Parameter], values: &Values, encoding: Encoding) -> Vec<u8> {
    let mut block = vec![0u8; stride(parameters)];
    for ((_, kind, offset), parameter) in layout(parameters).into_iter().zip(parameters) {
        let mut put = |at: usize, bytes: [u8; 4]| block[at..at + 4].copy_from_slice(&bytes);
        match kind {
            "vec3<f32>" => {
                for (i, c) in values.colour(parameter, encoding).to_array().into_iter().enumerate() {
                    put(offset + 4 * i, c.to_le_bytes());
                }
            }
            "u32" => put(offset, values.choice(parameter).to_le_bytes()),
            _ => put(offset, values.number(parameter).to_le_bytes()),
        }
    }
    block
}

/// Parameters as words without padding.
#[must_use]
pub fn words(parameters: &[Parameter], values: &Values, encoding: Encoding) -> Vec<u32> {
    let mut words = Vec::new();
    for p in parameters {
        match p.wgsl_type() {
            "vec3<f32>" => words.extend(values.colour(p, encoding).to_array().map(f32::to_bits)),
            "u32" => words.push(values.choice(p)),
            _ => words.push(values.number(p).to_bits()),
        }
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameter::{
        shared::{BASE_COLOUR, K_A, K_D, K_S, SPECULAR_COLOUR},
        value::Value,
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
