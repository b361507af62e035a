//! Rasterises triangles by the rules of graphics hardware: corners snapped to 1/256 pixel, exact edge
//! functions in integers, the top-left rule, so that triangles sharing an edge leave no gap and hit no sample
//! twice.

use glam::{Mat3, Mat4, Vec3, Vec4};

use crate::shading::Varying;

mod tile;

pub(crate) use tile::sample_positions;
pub(super) use tile::{TILE, Tile, even};

/// Steps per pixel of the grid to which corners are snapped.
pub(super) const SUBPIXEL: i64 = 256;

/// Maximum distance of a corner from the centre of the picture before the triangle is clipped, in pixels.
/// Bounds the products of the edge functions well within 64 bits.
const GUARD: f32 = 32_768.0;

/// The size of the picture, as needed for projection.
#[derive(Clone, Copy, Debug)]
pub(super) struct Screen {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Spacing of the grid lines of sample positions, and the first line, in 1/256 pixel.
    grid: (i64, i64),
    /// The centre of the only pixel drawn, if there is only one, in 1/256 pixel.
    only: Option<[i64; 2]>,
    /// Planes with all visible points on their positive sides: near, and far beyond the four sides of the
    /// picture.
    planes: [Vec4; 5],
}

impl Screen {
    pub(super) fn new(width: usize, height: usize, samples: usize) -> Self {
        let x = 2.0 * GUARD / width as f32;
        let y = 2.0 * GUARD / height as f32;
        let planes = [
            Vec4::new(0.0, 0.0, -1.0, 1.0),
            Vec4::new(1.0, 0.0, 0.0, x),
            Vec4::new(-1.0, 0.0, 0.0, x),
            Vec4::new(0.0, 1.0, 0.0, y),
            Vec4::new(0.0, -1.0, 0.0, y),
        ];
        Self { width, height, grid: if samples == 4 { (64, 32) } else { (256, 128) }, only: None, planes }
    }

    /// The screen restricted to one pixel, with one sample.
    pub(super) fn of_pixel(width: usize, height: usize, pixel: [usize; 2]) -> Self {
        let centre = pixel.map(|c| c as i64 * SUBPIXEL + SUBPIXEL / 2);
        Self { only: Some(centre), ..Self::new(width, height, 1) }
    }

    pub(super) fn tiles_across(&self) -> usize {
        self.width.div_ceil(TILE)
    }

    pub(super) fn tiles(&self) -> usize {
        self.tiles_across() * self.height.div_ceil(TILE)
    }

    /// The position of a point in front of the eye, in 1/256 pixel, y down.
    fn snap(&self, clip: Vec4) -> [i64; 2] {
        let x = (0.5 + 0.5 * clip.x / clip.w) * self.width as f32;
        let y = (0.5 - 0.5 * clip.y / clip.w) * self.height as f32;
        [x, y].map(|c| (c * SUBPIXEL as f32).round_ties_even() as i64)
    }

    /// True if any column and any row of sample positions lies within a box.
    fn holds_samples(&self, low: [i64; 2], high: [i64; 2]) -> bool {
        if let Some(at) = self.only {
            return (0..2).all(|axis| (low[axis]..=high[axis]).contains(&at[axis]));
        }
        let (step, first) = self.grid;
        (0..2).all(|axis| {
            let line = (low[axis] - first + step - 1).div_euclid(step) * step + first;
            line <= high[axis]
        })
    }
}

/// The five side planes of the view frustum, in room coordinates, normalised: a point at a negative distance is
/// invisible.
pub(super) fn frustum(clip_from_room: &Mat4) -> [Vec4; 5] {
    let [x, y, z, w] = [0, 1, 2, 3].map(|row| clip_from_room.row(row));
    [w - z, w + x, w - x, w + y, w - y].map(|plane| plane / plane.truncate().length())
}

/// A corner in clip space and on the screen. If it cannot be projected directly (because it is behind the
/// near plane, or far outside), its triangles are clipped.
#[derive(Clone, Copy, Debug)]
pub(super) struct Placed {
    pub(super) clip: Vec4,
    screen: Option<[i64; 2]>,
    /// One bit for each side of the picture beyond which the corner lies.
    beyond: u8,
}

impl Placed {
    pub(super) fn new(clip: Vec4, screen: &Screen) -> Self {
        let inside = screen.planes.iter().all(|plane| plane.dot(clip) >= 0.0);
        let beyond = u8::from(clip.z > clip.w)
            | u8::from(clip.x < -clip.w) << 1
            | u8::from(clip.x > clip.w) << 2
            | u8::from(clip.y < -clip.w) << 3
            | u8::from(clip.y > clip.w) << 4;
        Self { clip, screen: (inside && clip.w > 0.0).then(|| screen.snap(clip)), beyond }
    }

    /// False if a triangle certainly covers no sample.
    pub(super) fn may_be_seen(corners: [&Self; 3], screen: &Screen) -> bool {
        let [a, b, c] = corners;
        if a.beyond & b.beyond & c.beyond != 0 {
            return false;
        }
        match (a.screen, b.screen, c.screen) {
            (Some(a), Some(b), Some(c)) => {
                let low = [a[0].min(b[0]).min(c[0]), a[1].min(b[1]).min(c[1])];
                let high = [a[0].max(b[0]).max(c[0]), a[1].max(b[1]).max(c[1])];
                doubled_area(a, b, c) < 0 && screen.holds_samples(low, high)
            }
            _ => true,
        }
    }
}

/// Boxes in the mesh of an object, as they lie on the screen.
pub(super) struct Boxes<'a> {
    screen: &'a Screen,
    /// Clip coordinates x, y and w of a point of the mesh: factors, sum, and the largest error of rounding.
    rows: [(Vec3, f32, f32); 3],
}

impl<'a> Boxes<'a> {
    /// Of an object in its place, all of whose points are nearer to its centre than `reach`.
    pub(super) fn new(
        clip_from_room: &Mat4,
        (turned, position): (Mat3, Vec3),
        reach: f32,
        screen: &'a Screen,
    ) -> Self {
        /// Several times the rounding of all steps from a point of the mesh to clip space, by any order of them.
        const ROUNDING: f32 = 4e-6;
        let rows = [0, 1, 3].map(|row| {
            let row = clip_from_room.row(row);
            let factors = row.truncate();
            let largest = factors.abs().dot(position.abs() + reach) + row.w.abs();
            (turned.transpose() * factors, factors.dot(position) + row.w, ROUNDING * largest)
        });
        Self { screen, rows }
    }

    /// False if no triangle within a box, given by its centre and half its sides, covers a sample.
    pub(super) fn may_cover(&self, centre: Vec3, half: Vec3) -> bool {
        /// Rounding of a place on the screen, in steps for each pixel.
        const ROUNDED: f32 = 4e-6 * SUBPIXEL as f32;
        /// Far outside of any picture, in steps.
        const FAR: f32 = 1e12;
        let ends = self.rows.map(|(factors, sum, error)| {
            let (at, reach) = (factors.dot(centre) + sum, factors.abs().dot(half) + error);
            [at - reach, at + reach]
        });
        let [x, y, [near, far]] = ends;
        // Behind the eye nothing has a place on the screen.
        if near <= 0.0 || !far.is_finite() {
            return true;
        }
        let of = |[low, high]: [f32; 2]| {
            [low / if low < 0.0 { near } else { far }, high / if high < 0.0 { far } else { near }]
        };
        let ([left, right], [bottom, top]) = (of(x), of(y));
        let Screen { width, height, .. } = *self.screen;
        // A step more than to what corners are snapped.
        let wide = |[low, high]: [f32; 2], side: usize| {
            let pad = 2.0 + ROUNDED * low.abs().max(high.abs());
            let [low, high] = [low * SUBPIXEL as f32 - pad, high * SUBPIXEL as f32 + pad];
            let is_outside = high < 0.0 || low > (side as i64 * SUBPIXEL) as f32;
            (!is_outside).then(|| [low, high].map(|at| at.clamp(-FAR, FAR) as i64))
        };
        let across = wide([left, right].map(|x| (0.5 + 0.5 * x) * width as f32), width);
        let down = wide([top, bottom].map(|y| (0.5 - 0.5 * y) * height as f32), height);
        let (Some([left, right]), Some([top, bottom])) = (across, down) else { return false };
        self.screen.holds_samples([left, top], [right, bottom])
    }
}

/// Twice the signed area; negative for corners that appear anticlockwise, with y pointing down.
fn doubled_area(a: [i64; 2], b: [i64; 2], c: [i64; 2]) -> i64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// A triangle on the screen, with corners that appear clockwise.
#[derive(Clone, Debug)]
pub(super) struct Triangle {
    corners: [[i64; 2]; 3],
    area: i64,
    /// `1 / w` at the corners: linear on the screen; larger is nearer.
    inverse_w: [f32; 3],
    varyings: [Varying; 3],
    face_normal: Vec3,
    /// True if the model needs tangents, which cost time.
    tangents: bool,
}

/// Calls `emit` for the visible parts of a triangle: itself, its clipped parts, or nothing.
pub(super) fn set_up(
    placed: [&Placed; 3],
    varyings: [Varying; 3],
    tangents: bool,
    screen: &Screen,
    emit: &mut impl FnMut(Triangle),
) {
    let [a, b, c] = varyings.map(|v| v.position);
    let face_normal = (b - a).cross(c - a).normalize_or_zero();
    let mut one = |corners: [[i64; 2]; 3], w: [f32; 3], varyings: [Varying; 3]| {
        let area = -doubled_area(corners[0], corners[1], corners[2]);
        if area > 0 {
            emit(Triangle {
                corners: [corners[0], corners[2], corners[1]],
                area,
                inverse_w: [1.0 / w[0], 1.0 / w[2], 1.0 / w[1]],
                varyings: [varyings[0], varyings[2], varyings[1]],
                face_normal,
                tangents,
            });
        }
    };
    if let [Some(p), Some(q), Some(r)] = placed.map(|p| p.screen) {
        one([p, q, r], placed.map(|p| p.clip.w), varyings);
        return;
    }
    let mut polygon: Vec<(Vec4, Varying)> = placed.iter().map(|p| p.clip).zip(varyings).collect();
    for plane in screen.planes {
        polygon = clip(&polygon, plane);
    }
    // A fan around the first corner.
    for i in 1..polygon.len().saturating_sub(1) {
        let fan = [&polygon[0], &polygon[i], &polygon[i + 1]];
        if fan.iter().all(|corner| corner.0.w > 0.0) {
            one(fan.map(|c| screen.snap(c.0)), fan.map(|c| c.0.w), fan.map(|c| c.1));
        }
    }
}

/// The part of a convex polygon on the positive side of a plane (I. Sutherland and G. Hodgman 1974,
/// *Reentrant Polygon Clipping*).
fn clip(polygon: &[(Vec4, Varying)], plane: Vec4) -> Vec<(Vec4, Varying)> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &to) in polygon.iter().enumerate() {
        let from = polygon[(i + polygon.len() - 1) % polygon.len()];
        let (d_from, d_to) = (plane.dot(from.0), plane.dot(to.0));
        if (d_from >= 0.0) != (d_to >= 0.0) {
            // Always from the inner to the outer corner, so that both polygons at an edge get the same point.
            let (inner, outer, d_inner, d_outer) =
                if d_from >= 0.0 { (from, to, d_from, d_to) } else { (to, from, d_to, d_from) };
            let t = d_inner / (d_inner - d_outer);
            kept.push((inner.0.lerp(outer.0, t), mix(&inner.1, &outer.1, t)));
        }
        if d_to >= 0.0 {
            kept.push(to);
        }
    }
    kept
}

fn mix(a: &Varying, b: &Varying, t: f32) -> Varying {
    Varying {
        position: a.position.lerp(b.position, t),
        normal: a.normal.lerp(b.normal, t),
        tangent: a.tangent.lerp(b.tangent, t),
        colour: a.colour.lerp(b.colour, t),
    }
}

impl Triangle {
    /// The pixels that the triangle may touch: first and last column, first and last row; `None` if it is
    /// outside the picture.
    pub(super) fn bounds(&self, screen: &Screen) -> Option<[usize; 4]> {
        let range = |axis: usize, size: usize| {
            let values = self.corners.map(|c| c[axis]);
            let low = values.iter().min()?.div_euclid(SUBPIXEL).max(0);
            let high = values.iter().max()?.div_euclid(SUBPIXEL).min(size as i64 - 1);
            (low <= high).then_some((low as usize, high as usize))
        };
        let (left, right) = range(0, screen.width)?;
        let (top, bottom) = range(1, screen.height)?;
        Some([left, right, top, bottom])
    }

    /// The values interpolated with perspective correction at the point with these weights of the corners on
    /// the screen.
    fn varying(&self, mut weights: [f32; 3]) -> Varying {
        let mut scaled: [f32; 3] = std::array::from_fn(|i| weights[i] * self.inverse_w[i]);
        let mut sum: f32 = scaled.iter().sum();
        if sum < 1e-3 * self.inverse_w.iter().copied().fold(f32::INFINITY, f32::min) {
            // The pixel's centre is outside the triangle and beyond its horizon: stay inside.
            weights = weights.map(|w| w.clamp(0.0, 1.0));
            scaled = std::array::from_fn(|i| weights[i] * self.inverse_w[i]);
            sum = scaled.iter().sum();
        }
        between(&self.varyings, [scaled[1] / sum, scaled[2] / sum], self.tangents)
    }
}

/// The values at a point of a triangle, by the weights of its second and third corners.
pub(super) fn between([p, q, r]: &[Varying; 3], [b, c]: [f32; 2], tangents: bool) -> Varying {
    // Relative to the first corner, so that a value equal at all three stays exact.
    let between = |p: Vec3, q: Vec3, r: Vec3| p + (q - p) * b + (r - p) * c;
    Varying {
        position: between(p.position, q.position, r.position),
        normal: between(p.normal, q.normal, r.normal),
        tangent: if tangents { between(p.tangent, q.tangent, r.tangent) } else { Vec3::ZERO },
        colour: between(p.colour, q.colour, r.colour),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clipping_keeps_what_is_in_front_and_interpolates_what_it_cuts() {
        let behind = Vec4::new(0.0, 0.0, 0.01, -1.0);
        let corner = |clip: Vec4, red: f32| {
            let colour = Vec3::X * red;
            (clip, Varying { colour, tangent: colour, ..Varying::default() })
        };
        let front = [Vec4::new(-1.0, 0.0, 0.01, 1.0), Vec4::new(1.0, 0.0, 0.01, 1.0)];
        let polygon = [corner(front[0], 0.0), corner(front[1], 0.0), corner(behind, 1.0)];
        let near = Vec4::new(0.0, 0.0, -1.0, 1.0);
        let kept = clip(&polygon, near);
        assert_eq!(kept.len(), 4);
        for (clip, varying) in &kept {
            assert!(near.dot(*clip) >= -1e-6);
            // Red grows with the distance towards the corner behind, and so with 1 − w.
            assert!((varying.colour.x - 0.5 * (1.0 - clip.w)).abs() < 1e-6);
            assert_eq!(varying.tangent, varying.colour);
        }
        assert!(clip(&[corner(behind, 0.0); 3], near).is_empty());
    }
}
