//! Colour tables: a function of three numbers, sampled on a grid.

use std::io::Read;

use glam::Vec3;

/// A function from [0, 1]³ to colours, given at the points of a grid and interpolated between them.
pub struct Table {
    /// Points along each axis, at least 2.
    size: usize,
    /// The colours; the first coordinate runs fastest.
    colours: Vec<Vec3>,
}

/// Half floats (`VK_FORMAT_R16G16B16A16_SFLOAT`).
const HALF: u32 = 97;
/// Nine bits per channel and a shared exponent (`VK_FORMAT_E5B9G9R9_UFLOAT_PACK32`).
const SHARED_EXPONENT: u32 = 123;

impl Table {
    /// Reads a table from a KTX 2 file with one level of half floats or of numbers with a shared
    /// exponent, compressed with Zstandard. `None` if it is anything else.
    #[must_use]
    pub fn from_ktx2(file: &[u8]) -> Option<Self> {
        let reader = ktx2::Reader::new(file).ok()?;
        let header = reader.header();
        let mut bytes = Vec::new();
        let level = reader.levels().next()?.data;
        ruzstd::decoding::StreamingDecoder::new(level).ok()?.read_to_end(&mut bytes).ok()?;
        let colours: Vec<Vec3> = match header.format?.value() {
            HALF => bytes.as_chunks().0.iter().map(|b: &[u8; 8]| half(b)).collect(),
            SHARED_EXPONENT => bytes.as_chunks().0.iter().map(|b| shared_exponent(*b)).collect(),
            _ => return None,
        };
        let size = header.pixel_width as usize;
        let cube = header.pixel_height == header.pixel_width && header.pixel_depth == header.pixel_width;
        (cube && size >= 2 && colours.len() == size.pow(3)).then_some(Self { size, colours })
    }

    /// The colour at a point; coordinates are clamped to 0 to 1. Trilinear, as graphics hardware filters a texture with
    /// texels at the points of the grid.
    #[must_use]
    pub fn at(&self, p: Vec3) -> Vec3 {
        let last = self.size - 1;
        let t = p.clamp(Vec3::ZERO, Vec3::ONE) * last as f32;
        let corner = t.to_array().map(|t| (t as usize).min(last - 1));
        let f = t - Vec3::from_array(corner.map(|i| i as f32));
        let [x, y, z] = corner;
        let along_x = |y: usize, z: usize| {
            let i = (z * self.size + y) * self.size + x;
            self.colours[i].lerp(self.colours[i + 1], f.x)
        };
        let in_plane = |z: usize| along_x(y, z).lerp(along_x(y + 1, z), f.y);
        in_plane(z).lerp(in_plane(z + 1), f.z)
    }
}

/// Red, green and blue of four half floats that are neither negative nor infinite.
fn half(bytes: &[u8; 8]) -> Vec3 {
    // Moving exponent and mantissa to their places in 32 bits leaves the exponent 112 too small; the
    // multiplication is exact, for subnormal numbers too.
    let number = |i: usize| {
        let bits = u32::from(u16::from_le_bytes([bytes[i], bytes[i + 1]]));
        f32::from_bits(bits << 13) * 2f32.powi(112)
    };
    Vec3::new(number(0), number(2), number(4))
}

/// Three numbers of nine bits with a common exponent of five (`2^(e − 15 − 9)`).
fn shared_exponent(bytes: [u8; 4]) -> Vec3 {
    let bits = u32::from_le_bytes(bytes);
    let scale = 2f32.powi((bits >> 27) as i32 - 24);
    let number = |shift: u32| (bits >> shift & 0x1ff) as f32 * scale;
    Vec3::new(number(0), number(9), number(18))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_both_formats_are_read() {
        // 1.0, 0.5, 2⁻²⁴ (the smallest subnormal), alpha.
        assert_eq!(half(&[0x00, 0x3c, 0x00, 0x38, 0x01, 0x00, 0, 0]), Vec3::new(1.0, 0.5, 2f32.powi(-24)));
        let packed = (16u32 << 27) | (128 << 18) | (256 << 9) | 511;
        assert_eq!(shared_exponent(packed.to_le_bytes()), Vec3::new(511.0, 256.0, 128.0) / 256.0);
    }

    #[test]
    fn a_table_is_exact_at_its_points_and_linear_between_them() {
        let f = |p: Vec3| Vec3::new(p.x + 2.0 * p.y, p.y * p.z, 1.0 - p.x);
        let size = 5;
        let points = (0..size * size * size)
            .map(|i| Vec3::new((i % size) as f32, (i / size % size) as f32, (i / size / size) as f32) / 4.0);
        let table = Table { size, colours: points.clone().map(f).collect() };
        for p in points {
            assert!((table.at(p) - f(p)).abs().max_element() < 1e-6, "{p}");
            // A function that is linear in each coordinate is its own interpolation.
            let between = (p + Vec3::new(0.03, 0.11, 0.2)).min(Vec3::ONE);
            assert!((table.at(between) - f(between)).abs().max_element() < 1e-6, "{between}");
        }
        assert_eq!(table.at(Vec3::splat(-3.0)), table.at(Vec3::ZERO));
        assert_eq!(table.at(Vec3::splat(3.0)), table.at(Vec3::ONE));
    }

    #[test]
    fn what_is_no_table_is_refused() {
        assert!(Table::from_ktx2(b"not a KTX 2 file").is_none());
    }
}
