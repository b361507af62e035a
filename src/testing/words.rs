//! Numbers as functions in WGSL take and give them: words of 32 bits.

use glam::Vec3;

use crate::shader::interpret::Program;

/// Bytes as words.
pub(super) fn words(bytes: &[u8]) -> Vec<u32> {
    bytes.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect()
}

/// The words of vectors.
pub(super) fn bits(vectors: &[Vec3]) -> impl Iterator<Item = u32> {
    vectors.iter().flat_map(|v| v.to_array()).map(f32::to_bits)
}

/// The vectors with which some words begin.
pub(super) fn vectors<const N: usize>(words: &[u32]) -> [Vec3; N] {
    std::array::from_fn(|i| Vec3::from_array([0, 1, 2].map(|k| f32::from_bits(words[3 * i + k]))))
}

/// The words that a function gives for others, with the table that it reads.
pub(super) fn run<const N: usize>(
    program: &Program,
    table: &[u32],
    words: &[u32],
) -> Result<[u32; N], String> {
    let mut results = [0; N];
    program.run_with(table, words, &mut results).map_err(|e| e.to_string())?;
    Ok(results)
}
