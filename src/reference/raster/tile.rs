//! The samples of one tile of the picture, into which triangles are drawn.

use glam::{Vec3, Vec4};

use super::{SUBPIXEL, Screen, Triangle};
use crate::{
    reference::visible::Part,
    shading::{Lighting, Shading},
};

/// Edge length of a tile, in pixels.
pub(in crate::reference) const TILE: usize = 32;

/// Sample positions within a pixel, in 1/256: the centre, or the standard four (Vulkan 1.3,
/// *Standard Sample Locations*).
const fn positions<const S: usize>() -> [[i64; 2]; S] {
    const FOUR: [[i64; 2]; 4] = [[96, 32], [224, 96], [32, 160], [160, 224]];
    let mut out = [[128, 128]; S];
    if S == 4 {
        let mut i = 0;
        while i < S {
            out[i] = FOUR[i];
            i += 1;
        }
    }
    out
}

/// The samples of a pixel from its upper left corner, in pixels.
pub(crate) fn sample_positions(samples: u32) -> Vec<[f32; 2]> {
    let place = |at: &[i64; 2]| at.map(|c| c as f32 / SUBPIXEL as f32);
    match samples {
        0 | 1 => positions::<1>().iter().map(place).collect(),
        _ => positions::<4>().iter().map(place).collect(),
    }
}

/// The samples of one tile of the picture, `E` pixels wide and high.
pub(in crate::reference) struct Tile<const S: usize, const E: usize = TILE> {
    /// Nearest `1 / w` so far; 0 for background.
    nearness: Vec<[f32; S]>,
    colour: Vec<[Vec3; S]>,
}

impl<const S: usize, const E: usize> Tile<S, E> {
    pub(in crate::reference) fn new() -> Self {
        Self { nearness: vec![[0.0; S]; E * E], colour: vec![[Vec3::ZERO; S]; E * E] }
    }

    /// Draws the part of a triangle inside the tile whose first pixel is `origin`. The colour is calculated
    /// at the pixel's centre, once for all its samples.
    pub(in crate::reference) fn draw(
        &mut self,
        triangle: &Triangle,
        shading: &dyn Shading,
        lighting: &dyn Lighting,
        origin: [usize; 2],
        screen: &Screen,
    ) {
        let samples = const { positions::<S>() };
        let Some([left, right, top, bottom]) = triangle.bounds(screen) else { return };
        let (left, right) = (left.max(origin[0]), right.min(origin[0] + E - 1));
        let (top, bottom) = (top.max(origin[1]), bottom.min(origin[1] + E - 1));
        if left > right || top > bottom {
            return;
        }
        // The edge opposite to corner i; its function is twice the area spanned by the edge and the point, and so the
        // weight of that corner. A point on an edge belongs to the triangle if it is a left or a top edge.
        let edges: [([i64; 2], [i64; 2], i64); 3] = std::array::from_fn(|i| {
            let (a, b) = (triangle.corners[(i + 1) % 3], triangle.corners[(i + 2) % 3]);
            let d = [b[0] - a[0], b[1] - a[1]];
            let inclusive = d[1] < 0 || (d[1] == 0 && d[0] > 0);
            (a, d, if inclusive { 0 } else { -1 })
        });
        let offsets: [[i64; S]; 3] = std::array::from_fn(|e| {
            let d = edges[e].1;
            samples.map(|s| d[0] * (s[1] - 128) - d[1] * (s[0] - 128))
        });
        // The maxima of the edge functions over all samples of a pixel, relative to its centre.
        let most: [i64; 3] = std::array::from_fn(|e| offsets[e].iter().copied().max().unwrap_or(0));
        let step: [i64; 3] = std::array::from_fn(|e| -edges[e].1[1] * SUBPIXEL);
        let per_area = 1.0 / triangle.area as f64;
        // Nearness is linear on the screen: that of a sample is that of the pixel's centre and a difference.
        let slope = triangle.inverse_w.map(|w| per_area * f64::from(w));
        let nearer =
            |at: [i64; 3]| at[0] as f64 * slope[0] + at[1] as f64 * slope[1] + at[2] as f64 * slope[2];
        let differences: [f64; S] = std::array::from_fn(|s| nearer(offsets.map(|o| o[s])));
        // A sample is covered if none of these and the edge functions add up to less than 0.
        let limits: [[i64; S]; 3] = std::array::from_fn(|e| offsets[e].map(|o| o + edges[e].2));
        let wide = right - left >= 8;

        for y in top..=bottom {
            let start: [i64; 3] = std::array::from_fn(|e| {
                let (a, d, _) = edges[e];
                let (px, py) = (left as i64 * SUBPIXEL + 128, y as i64 * SUBPIXEL + 128);
                d[0] * (py - a[1]) - d[1] * (px - a[0])
            });
            // The pixels of this row that can have covered samples.
            let (mut first, mut last) = (0i64, (right - left) as i64);
            if wide {
                for e in 0..3 {
                    let reach = start[e] + most[e];
                    match step[e] {
                        0 if reach < 0 => last = -1,
                        0 => {}
                        s if s > 0 => first = first.max((-reach + s - 1).div_euclid(s)),
                        s => last = last.min(reach.div_euclid(-s)),
                    }
                }
            }
            let mut at: [i64; 3] = std::array::from_fn(|e| start[e] + first * step[e]);
            for x in first..=last {
                let here = at;
                at = std::array::from_fn(|e| at[e] + step[e]);
                // The sign of the least of three numbers is that of all their bits together.
                let mut covered: [bool; S] = std::array::from_fn(|s| {
                    (here[0] + limits[0][s]) | (here[1] + limits[1][s]) | (here[2] + limits[2][s]) >= 0
                });
                if covered == [false; S] {
                    continue;
                }
                let pixel = (y - origin[1]) * E + left + x as usize - origin[0];
                let nearness = &mut self.nearness[pixel];
                let centre = nearer(here);
                let mut visible = false;
                for s in 0..S {
                    let near = (centre + differences[s]) as f32;
                    covered[s] &= near > nearness[s];
                    if covered[s] {
                        nearness[s] = near;
                        visible = true;
                    }
                }
                if visible {
                    let varying = triangle.varying(here.map(|e| (e as f64 * per_area) as f32));
                    lighting.begin_pixel(left as u32 + x as u32, y as u32);
                    let colour = shading.pixel(lighting, &varying, triangle.face_normal);
                    for (sample, _) in self.colour[pixel].iter_mut().zip(covered).filter(|(_, c)| *c) {
                        *sample = colour;
                    }
                }
            }
        }
    }

    /// Draws lights at the samples where they are nearer than anything drawn before; infinitely distant ones
    /// where there is nothing.
    pub(in crate::reference) fn show(&mut self, lights: &Part) {
        let samples = const { positions::<S>() }.map(|at| at.map(|c| c as f32 / SUBPIXEL as f32));
        for (i, (nearness, colour)) in self.nearness.iter_mut().zip(&mut self.colour).enumerate() {
            let shown = lights.pixel([i % E, i / E], samples);
            for (s, seen) in shown.into_iter().enumerate() {
                if let Some(seen) = seen.filter(|seen| nearness[s] == 0.0 || seen.nearness > nearness[s]) {
                    nearness[s] = seen.nearness.max(f32::MIN_POSITIVE);
                    colour[s] = seen.light;
                }
            }
        }
    }

    /// The pixels: the mean of their samples, and the fraction covered by objects.
    pub(in crate::reference) fn resolve(&self) -> impl Iterator<Item = Vec4> {
        self.nearness.iter().zip(&self.colour).map(|(nearness, colour)| mean(nearness, colour))
    }
}

/// A pixel all of whose samples show the same light.
pub(in crate::reference) fn even<const S: usize>(light: Vec3) -> Vec4 {
    mean(&[f32::MAX; S], &[light; S])
}

fn mean<const S: usize>(nearness: &[f32; S], colour: &[Vec3; S]) -> Vec4 {
    let mut sum = Vec4::ZERO;
    for s in 0..S {
        if nearness[s] > 0.0 {
            sum += colour[s].extend(1.0);
        }
    }
    sum * (1.0 / S as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{reference::raster::doubled_area, shading::Varying};

    fn screen() -> Screen {
        Screen::new(64, 48, 1)
    }

    /// A triangle at given screen positions (pixels, y down, clockwise as seen), at distance 1.
    fn on_screen(corners: [[f64; 2]; 3]) -> Triangle {
        let corners = corners.map(|c| c.map(|v| (v * 256.0).round() as i64));
        let area = doubled_area(corners[0], corners[1], corners[2]);
        Triangle {
            corners,
            area,
            inverse_w: [1.0; 3],
            varyings: [Varying::default(); 3],
            face_normal: Vec3::Z,
            tangents: false,
        }
    }

    struct NoLight;

    impl Lighting for NoLight {
        fn colour(&self, _position: Vec3, _normal: Vec3, _tangent: Vec3) -> Vec3 {
            Vec3::ONE
        }
    }

    fn shading() -> crate::shading::Flat {
        crate::shading::Flat::default()
    }

    /// The number of hits of each sample of the first tiles.
    fn hits<const S: usize>(triangles: &[Triangle], screen: &Screen) -> Vec<u32> {
        let mut counts = vec![0; screen.tiles() * TILE * TILE * S];
        for triangle in triangles {
            for tile in 0..screen.tiles() {
                let origin = [(tile % screen.tiles_across()) * TILE, (tile / screen.tiles_across()) * TILE];
                let mut drawn = Tile::<S>::new();
                drawn.draw(triangle, &shading(), &NoLight, origin, screen);
                for (i, near) in drawn.nearness.iter().flatten().enumerate() {
                    counts[tile * TILE * TILE * S + i] += u32::from(*near > 0.0);
                }
            }
        }
        counts
    }

    #[test]
    fn a_fan_hits_every_sample_inside_exactly_once() {
        fn check<const S: usize>() {
            let screen = Screen::new(64, 64, S);
            // Some corners are on sample positions, where the top-left rule decides.
            let ring = [
                [0.0, 0.0],
                [20.5, 0.0],
                [64.0, 0.0],
                [64.0, 31.5],
                [64.0, 64.0],
                [11.25, 64.0],
                [0.0, 64.0],
                [0.0, 17.125],
            ];
            for centre in [[32.5, 32.5], [31.375, 20.125], [10.123, 50.9]] {
                let fan: Vec<_> = (0..ring.len())
                    .map(|i| on_screen([centre, ring[i], ring[(i + 1) % ring.len()]]))
                    .collect();
                let counts = hits::<S>(&fan, &screen);
                assert!(counts.iter().all(|&n| n == 1), "{centre:?}");
                // The wrong twin: slightly moving one corner of one triangle leaves gaps or hits samples
                // twice.
                let mut wrong = fan;
                wrong[0] = on_screen([[centre[0] + 2.0, centre[1] + 1.0], ring[0], ring[1]]);
                assert!(hits::<S>(&wrong, &screen).iter().any(|&n| n != 1));
            }
        }
        check::<1>();
        check::<4>();
    }

    #[test]
    fn edges_through_pixel_centres_belong_to_one_side() {
        // Two triangles of a square whose diagonal and sides run through pixel centres.
        let square = [[2.5, 2.5], [10.5, 2.5], [10.5, 10.5], [2.5, 10.5]];
        let two =
            [on_screen([square[0], square[1], square[2]]), on_screen([square[0], square[2], square[3]])];
        let counts = hits::<1>(&two, &screen());
        assert!(counts.iter().all(|&n| n <= 1));
        // Top and left sides belong, bottom and right ones do not: 8 × 8 of the 9 × 9 centres.
        assert_eq!(counts.iter().sum::<u32>(), 64);
    }

    #[test]
    fn a_huge_triangle_covers_what_a_small_one_in_its_place_covers() {
        let huge = on_screen([[-30_000.0, -30_000.0], [32_000.0, -30_000.0], [-30_000.0, 32_000.0]]);
        assert!(hits::<4>(&[huge], &Screen::new(64, 64, 4)).iter().all(|&n| n == 1));
    }

    #[test]
    fn the_samples_are_one_per_column_and_row_of_the_grid() {
        let four = positions::<4>();
        for axis in 0..2 {
            let mut values = four.map(|s| s[axis]);
            values.sort_unstable();
            assert_eq!(values, [32, 96, 160, 224]);
        }
        assert_eq!(positions::<1>(), [[128, 128]]);
    }
}
