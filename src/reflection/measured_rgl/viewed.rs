//! A table as one viewer sees it: what does not depend on the light is calculated once for all lights.

use std::f32::consts::{FRAC_1_PI, FRAC_2_PI, PI};

use arrayvec::ArrayVec;
use glam::{Vec3, Vec4};

use super::{
    slice::{Grid, LEAST, Slice, bilinear, value, warped},
    table::Data,
};
use crate::optics::{Frame, geometry::polar_angles, radiometry::Arriving};

/// Number of lights calculated at once: their steps do not depend on each other, and processors have instructions for four
/// numbers.
const LIGHTS: usize = 4;

/// A table seen from one direction.
struct Viewed<'a> {
    /// What makes an azimuth one of the file.
    azimuths: [f32; 2],
    /// The directions of the file around that of the viewer.
    near: ArrayVec<Slice, 4>,
    /// 4 σ(V); `None` if values are not relative to the density.
    area: Option<f32>,
    numbers: &'a [f32],
    /// The first number of the distribution of normals.
    normals: usize,
    /// The grids of the density, the values and the distribution.
    grids: [Grid; 3],
}

/// Distances from the normal below which a direction has no azimuth.
const AXIS: f32 = 1e-7;

/// An azimuth in the unit square; it is at most a turn away.
#[inline(always)]
fn turn(phi: Vec4) -> Vec4 {
    let turn = 0.5 * FRAC_1_PI * phi + 0.5;
    let more = Vec4::select(turn.cmplt(Vec4::ZERO), Vec4::ONE, Vec4::ZERO);
    let less = Vec4::select(turn.cmpge(Vec4::ONE), Vec4::ONE, Vec4::ZERO);
    turn + more - less
}

/// The angles of two directions from the normal and around it, calculated together.
#[inline(always)]
fn angles(a: Vec3, b: Vec3) -> [[f32; 2]; 2] {
    let (across_a, across_b) = (a.truncate().length(), b.truncate().length());
    let found = polar_angles(Vec4::new(a.z, a.x, b.z, b.x), Vec4::new(across_a, a.y, across_b, b.y));
    let around = |across: f32, phi: f32| if across < AXIS { 0.0 } else { phi };
    [[found.x, around(across_a, found.y)], [found.z, around(across_b, found.w)]]
}

/// The light that leaves a surface with this table towards a viewer above it, in the local frame: the sum of π f_r N·L over
/// the lights above it.
pub(super) fn lit_by(data: &Data<'_>, lights: &[Arriving], v: Vec3, frame: &Frame) -> Vec3 {
    if let [at] = lights {
        let l = frame.to_local(at.l);
        if l.z > 0.0 {
            // One light is calculated together with its viewer.
            let [seen, half] = angles(v, l + v);
            let [response, ..] = Viewed::new(data, seen).responses(half.map(Vec4::splat), 1);
            return PI * response * at.light;
        }
        return Vec3::ZERO;
    }
    let [seen, _] = angles(v, v);
    let viewed = Viewed::new(data, seen);
    let mut sum = Vec3::ZERO;
    for some in lights.chunks(LIGHTS) {
        let local = |k: usize| some.get(k).map_or(Vec3::ZERO, |at| frame.to_local(at.l));
        let l = [local(0), local(1), local(2), local(3)];
        let [a, b, c, d] = [l[0] + v, l[1] + v, l[2] + v, l[3] + v];
        let [x, y] = [Vec4::new(a.x, b.x, c.x, d.x), Vec4::new(a.y, b.y, c.y, d.y)];
        let across = Vec4::from((x * x + y * y).to_array().map(f32::sqrt));
        let theta = polar_angles(Vec4::new(a.z, b.z, c.z, d.z), across);
        let phi = Vec4::select(across.cmplt(Vec4::splat(AXIS)), Vec4::ZERO, polar_angles(x, y));
        let responses = viewed.responses([theta, phi], some.len());
        for ((at, l), response) in some.iter().zip(l).zip(responses) {
            if l.z > 0.0 {
                sum += PI * response * at.light;
            }
        }
    }
    sum
}

impl<'a> Viewed<'a> {
    /// The table for a viewer at these angles.
    #[inline(always)]
    fn new(data: &Data<'a>, [theta, seen]: [f32; 2]) -> Self {
        let [factor, shift] = data.azimuths(seen);
        let phi = factor * seen + shift;
        let place = [(FRAC_2_PI * theta).sqrt(), turn(Vec4::splat(phi)).x];
        Self {
            azimuths: [factor, shift],
            near: data.near(phi, theta),
            area: data.is_relative().then(|| 4.0 * data.projected(place)),
            numbers: data.numbers,
            normals: data.at[2],
            grids: [data.grid(0), data.grid(1), data.grid(2)],
        }
    }

    /// f_r N·L in sr⁻¹ for the first of four half vectors at these angles.
    #[inline(always)]
    fn responses(&self, half: [Vec4; 2], count: usize) -> [Vec3; LIGHTS] {
        // With a number of directions that the compiler knows, their arrays are read without a loop.
        match <&[_; 2]>::try_from(self.near.as_slice()) {
            Ok(two) => self.between(two, half, count),
            Err(_) => self.between(&self.near, half, count),
        }
    }

    #[inline(always)]
    fn between(&self, near: &[Slice], [theta, phi]: [Vec4; 2], count: usize) -> [Vec3; LIGHTS] {
        let [factor, shift] = self.azimuths;
        let normals = [Vec4::from((FRAC_2_PI * theta).to_array().map(f32::sqrt)), turn(factor * phi + shift)];
        let [density, values, distribution] = &self.grids;
        let cells = density.cells(normals);
        let place = |k: usize| if k < count { warped(self.numbers, near, &cells.cell(k)) } else { [0.0; 2] };
        let [a, b, c, d] = [place(0), place(1), place(2), place(3)];
        let places = values.cells([Vec4::new(a[0], b[0], c[0], d[0]), Vec4::new(a[1], b[1], c[1], d[1])]);
        let normals = distribution.cells(normals);
        let mut responses = [Vec3::ZERO; LIGHTS];
        for (k, response) in responses.iter_mut().enumerate().take(count) {
            let sum = value(self.numbers, near, &places.cell(k));
            *response = match self.area {
                Some(area) if area > 4.0 * LEAST => {
                    sum * (bilinear(self.numbers, self.normals, &normals.cell(k)) / area)
                }
                Some(_) => Vec3::ZERO,
                None => sum,
            };
        }
        responses
    }
}
