//! The points at which light with extent is sampled: Sobol' points, Owen-scrambled by hashing, in integer
//! arithmetic only, so that all renderers use the same points.
//!
//! Sources: I. Sobol' (1967), *On the Distribution of Points in a Cube and the Approximate Evaluation of Integrals*;
//! A. Owen (1995), *Randomly Permuted (t,m,s)-Nets and (t,s)-Sequences*; B. Burley (2020), *Practical Hash-based Owen
//! Scrambling*, Journal of Computer Graphics Techniques 9(4); the hash is that of N. Vegdahl (2021), *Building a Better LK
//! Hash*.

use glam::Vec2;

/// Maximum number of points in a sequence, which then repeats.
pub const MAX_POINTS: u32 = 1 << 20;

/// A well-mixed hash: the output permutation of PCG (M. O'Neill 2014), as used by M. Jarzynski and M. Olano
/// (2020), *Hash Functions for GPU Rendering*.
#[must_use]
pub fn hash(x: u32) -> u32 {
    let state = x.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    (word >> 22) ^ word
}

/// The seed of a pixel of a picture.
#[must_use]
pub fn pixel_seed(x: u32, y: u32) -> u32 {
    x | y << 16
}

/// Flips each bit of a number depending on those below it.
fn permute(x: u32, seed: u32) -> u32 {
    let mut x = x ^ x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Flips each bit of a number depending on those above it: Owen's scrambling.
fn scramble(x: u32, seed: u32) -> u32 {
    permute(x.reverse_bits(), seed).reverse_bits()
}

/// The second dimension of Sobol's sequence: Pascal's triangle modulo 2, as five factors, times the index.
fn second(index: u32) -> u32 {
    let mut x = index;
    x ^= x >> 16;
    x ^= (x & 0xff00_ff00) >> 8;
    x ^= (x & 0xf0f0_f0f0) >> 4;
    x ^= (x & 0xcccc_cccc) >> 2;
    x ^= (x & 0xaaaa_aaaa) >> 1;
    x.reverse_bits()
}

/// A number in [0, 1) from the upper bits of an integer.
fn unit(x: u32) -> f32 {
    (x >> 8) as f32 / (1 << 24) as f32
}

/// Points of the unit square, one sequence for each seed. Any 2ᵏ points starting at a multiple of 2ᵏ are
/// evenly distributed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sequence {
    order: u32,
    across: u32,
    down: u32,
}

impl Sequence {
    /// The sequence with this number, for a pixel or vertex with a seed: sequence 0 chooses directions of
    /// lobes, those from 1 on belong to the lights.
    #[must_use]
    pub fn new(seed: u32, number: u32) -> Self {
        let order = hash(hash(seed) ^ number);
        let across = hash(order);
        Self { order, across, down: hash(across) }
    }

    /// The point with this index, modulo [`MAX_POINTS`].
    #[must_use]
    pub fn point(self, index: u32) -> Vec2 {
        let i = scramble(index % MAX_POINTS, self.order) % MAX_POINTS;
        Vec2::new(unit(scramble(i.reverse_bits(), self.across)), unit(scramble(second(i), self.down)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sobol's second dimension by its direction numbers, as in the literature.
    fn by_direction_numbers(index: u32) -> u32 {
        let (mut x, mut v) = (0, 1u32 << 31);
        for bit in 0..32 {
            if index >> bit & 1 == 1 {
                x ^= v;
            }
            v ^= v >> 1;
        }
        x
    }

    #[test]
    fn the_second_dimension_is_that_of_the_literature() {
        for i in (0..4096).chain([u32::MAX, 0x8000_0001, 0x1234_5678]) {
            assert_eq!(second(i), by_direction_numbers(i), "{i}");
        }
    }

    /// The number of boxes with an area of 2⁻ᵏ, of all shapes, that do not contain exactly one of 2ᵏ points.
    fn uneven(points: &[Vec2]) -> usize {
        let k = points.len().ilog2();
        let mut uneven = 0;
        for across in 0..=k {
            let (columns, rows) = (1usize << across, 1usize << (k - across));
            let mut count = vec![0; points.len()];
            for p in points {
                count[(p.y * rows as f32) as usize * columns + (p.x * columns as f32) as usize] += 1;
            }
            uneven += count.iter().filter(|count| **count != 1).count();
        }
        uneven
    }

    #[test]
    fn every_aligned_power_of_two_is_spread_over_all_boxes_of_its_area() {
        for seed in 0..20 {
            let sequence = Sequence::new(seed, seed % 3);
            for (first, count) in [(0, 16), (16, 16), (64, 64), (512, 256), (4096, 1024)] {
                let points: Vec<_> = (first..first + count).map(|i| sequence.point(i)).collect();
                assert_eq!(uneven(&points), 0, "seed {seed}, {count} points from {first} on");
            }
        }
        // The wrong twin: a start between two blocks.
        let off: Vec<_> = (8..8 + 64).map(|i| Sequence::new(1, 0).point(i)).collect();
        assert!(uneven(&off) > 0);
        // And plain random numbers.
        let random: Vec<_> = (0..64).map(|i| Vec2::new(unit(hash(2 * i)), unit(hash(2 * i + 1)))).collect();
        assert!(uneven(&random) > 100);
    }

    #[test]
    fn sequences_of_different_seeds_and_numbers_differ_and_are_uncorrelated() {
        let first = |seed, number| Sequence::new(seed, number).point(0);
        let correlation = |pairs: &[(f32, f32)]| {
            let n = pairs.len() as f32;
            let mean = |f: fn(&(f32, f32)) -> f32| pairs.iter().map(f).sum::<f32>() / n;
            let (a, b) = (mean(|p| p.0), mean(|p| p.1));
            pairs.iter().map(|p| (p.0 - a) * (p.1 - b)).sum::<f32>() / n * 12.0
        };
        let pixels: Vec<_> = (0..4096u32).map(|i| pixel_seed(i % 64, i / 64)).collect();
        let of =
            |f: &dyn Fn(u32) -> (f32, f32)| correlation(&pixels.iter().map(|s| f(*s)).collect::<Vec<_>>());
        assert!(of(&|s| (first(s, 0).x, first(s, 0).y)).abs() < 0.05);
        assert!(of(&|s| (first(s, 0).x, first(s, 1).x)).abs() < 0.05);
        assert!(of(&|s| (first(s, 0).x, first(s + 1, 0).x)).abs() < 0.05);
        assert!(of(&|s| (first(s, 0).x, first(s, 0).x)) > 0.95, "the wrong twin");
    }

    #[test]
    fn points_lie_within_the_square_and_begin_again_after_the_last() {
        let sequence = Sequence::new(7, 3);
        for i in [0, 1, MAX_POINTS - 1, MAX_POINTS, u32::MAX] {
            let p = sequence.point(i);
            assert!(p.cmpge(Vec2::ZERO).all() && p.cmplt(Vec2::ONE).all(), "{i}: {p}");
            assert_eq!(p, sequence.point(i % MAX_POINTS));
        }
    }
}
