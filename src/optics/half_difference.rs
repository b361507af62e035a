//! Tables of a BRDF over half and difference angles (S. Rusinkiewicz 1998, *A New Change of Variables for Efficient BRDF
//! Representation*), the twin of `optics/half_difference.wgsl`.
//!
//! θ_h is the angle between half vector and normal, θ_d that between light and half vector, φ_d the azimuth of the light
//! about the half vector. The bins of θ_h are even in √θ_h, those of the others in the angles. In numbers, a table is
//!
//! 1. the numbers of entries along θ_h, θ_d and φ_d;
//! 2. for sampling, the width of the highlight and the albedos of what scatters evenly and of the highlight;
//! 3. the number of entries that were not measured, and a number for the model;
//! 4. two words for each entry, φ_d fastest, with the roots of red and green, of blue and of 1, or 0 if it was not measured,
//!    as 16-bit floats, the first in the low bits. Values in sr⁻¹ keep a relative error of 9.8e-4.
//! 5. perhaps a number for each entry, its standard uncertainty in sr⁻¹, which is not used for pictures.

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Quat, Vec3, Vec4};

use super::{
    Frame, Terms,
    colour::luminance,
    lobes::{Lobe, Lobes},
};

mod half;

use half::{packed, unpacked};

/// The numbers before the entries.
pub const HEADER: usize = 8;

/// A table.
#[derive(Clone, Copy, Debug)]
pub struct Grid<'a> {
    counts: [usize; 3],
    numbers: &'a [f32],
}

/// The half angle θ_h, the difference angle θ_d and its azimuth φ_d in radians, for unit vectors and the normal (S. Rusinkiewicz
/// 1998). φ_d is from 0 to π: by reciprocity, the other half turn has the same values. From sums and differences rather
/// than scalar products, which lose digits at small angles.
#[must_use]
#[inline]
pub fn angles(l: Vec3, v: Vec3, n: Vec3) -> [f32; 3] {
    let (sum, difference) = (l + v, l - v);
    let length = sum.length();
    let theta_h = n.cross(sum).length().atan2(n.dot(sum));
    let theta_d = difference.length().atan2(length);
    // The components of the light beside the half vector, both multiplied by the same number.
    let phi_d = (2.0 * n.dot(v.cross(l))).atan2(-n.dot(difference) * length);
    [theta_h, theta_d, if phi_d < 0.0 { phi_d + PI } else { phi_d }]
}

impl<'a> Grid<'a> {
    /// The table in the numbers of a file; `None` if they are none.
    #[must_use]
    #[inline]
    pub fn new(numbers: &'a [f32]) -> Option<Self> {
        let [h, d, phi, ..] = numbers else { return None };
        let counts = [*h, *d, *phi].map(|count| count as usize);
        let entries = counts[0] * counts[1] * counts[2];
        let is_whole = [2, 3].iter().any(|each| numbers.len() == HEADER + each * entries);
        (is_whole && counts[0] > 1 && counts[1] > 1 && counts[2] > 0).then_some(Self { counts, numbers })
    }

    /// The numbers of entries along θ_h, θ_d and φ_d.
    #[must_use]
    pub fn counts(&self) -> [usize; 3] {
        self.counts
    }

    /// The number of entries that were not measured.
    #[must_use]
    pub fn missing(&self) -> usize {
        self.numbers[6] as usize
    }

    /// The number for the model.
    #[must_use]
    pub fn note(&self) -> f32 {
        self.numbers[7]
    }

    /// The width α of a GGX lobe about as wide as the highlight, and the albedos of what scatters evenly and of the
    /// highlight, roughly: for sampling.
    #[must_use]
    pub fn lobe(&self) -> [f32; 3] {
        [self.numbers[3], self.numbers[4], self.numbers[5]]
    }

    /// The lobes for sampling.
    #[must_use]
    pub fn lobes(&self) -> Lobes {
        let [alpha, diffuse, specular] = self.lobe();
        Lobes::diffuse_and(Lobe::ggx(alpha), Vec3::splat(diffuse), Vec3::splat(specular))
    }

    /// A quantity of the equations of tables: the numbers of entries `n_h`, `n_d`, `n_φ`, and of the entry with three indices the
    /// measured value `t`, that in its place `e`, and `m`, 1 if it was measured.
    #[must_use]
    pub fn quantity(&self, symbol: &str, arguments: &[f32]) -> Option<Vec3> {
        let counts = self.counts();
        let entry = || Some(self.entry([*arguments.first()?, *arguments.get(1)?, *arguments.get(2)?]));
        Some(match symbol {
            "n_h" => Vec3::splat(counts[0] as f32),
            "n_d" => Vec3::splat(counts[1] as f32),
            "n_φ" => Vec3::splat(counts[2] as f32),
            "t" => entry()?.truncate() * entry()?.w,
            "e" => entry()?.truncate() * (1.0 - entry()?.w),
            "m" => Vec3::splat(entry()?.w),
            _ => return None,
        })
    }

    /// The value of an entry, and in w 1 if it was measured.
    #[inline]
    fn cell(&self, i: usize, j: usize, k: usize) -> Vec4 {
        let at = HEADER + 2 * ((i * self.counts[1] + j) * self.counts[2] + k);
        let ([r, g], [b, w]) = (unpacked(self.numbers[at]), unpacked(self.numbers[at + 1]));
        Vec4::new(r, g, b, w)
    }

    /// The value of the entry with these indices, in w 1 if it was measured; that of φ_d goes round.
    #[must_use]
    pub fn entry(&self, place: [f32; 3]) -> Vec4 {
        let [h, d, phi] = self.counts;
        let within = |x: f32, count: usize| (x.max(0.0) as usize).min(count - 1);
        let around = (place[2] as i64).rem_euclid(phi as i64) as usize;
        self.cell(within(place[0], h), within(place[1], d), around)
    }

    /// The value at three angles in radians, in sr⁻¹: linear between the middles of the bins.
    #[must_use]
    #[inline]
    pub fn value(&self, angles: [f32; 3]) -> Vec3 {
        self.between(angles, |i, j, k| self.cell(i, j, k).truncate())
    }

    /// The pair of directions in the local frame in the middle of the bin of another, where its entry is the value; `None` if that
    /// entry was not measured. The azimuth of the half vector stays.
    #[must_use]
    pub fn nearest(&self, l: Vec3, v: Vec3) -> Option<(Vec3, Vec3)> {
        let [theta_h, theta_d, phi_d] = angles(l, v, Vec3::Z);
        let [n_h, n_d, n_phi] = self.counts;
        let bin = |t: f32, count: usize| ((t * count as f32) as usize).min(count - 1);
        let place =
            [bin((theta_h / FRAC_PI_2).sqrt(), n_h), bin(theta_d / FRAC_PI_2, n_d), bin(phi_d / PI, n_phi)];
        if self.cell(place[0], place[1], place[2]).w == 0.0 {
            return None;
        }
        let middle = directions(middle(self.counts, place));
        let half = l + v;
        let around = Quat::from_rotation_z(half.y.atan2(half.x));
        let [a, b] = [around * middle.0, around * middle.1];
        // By reciprocity the entry is that of both; the light stays the light.
        Some(if l.dot(a) < l.dot(b) { (b, a) } else { (a, b) })
    }

    /// The standard uncertainty at three angles, interpolated like the value; `None` if the table has none.
    #[must_use]
    pub fn uncertainty(&self, angles: [f32; 3]) -> Option<f32> {
        let [n_h, n_d, n_phi] = self.counts;
        let all = self.numbers.get(HEADER + 2 * n_h * n_d * n_phi..).filter(|all| !all.is_empty())?;
        Some(self.between(angles, |i, j, k| Vec3::splat(all[(i * n_d + j) * n_phi + k])).x)
    }

    /// Linear between the middles of the bins around three angles.
    #[inline]
    fn between(
        &self,
        [theta_h, theta_d, phi_d]: [f32; 3],
        cell: impl Fn(usize, usize, usize) -> Vec3,
    ) -> Vec3 {
        let [n_h, n_d, n_phi] = self.counts;
        let h = (n_h as f32 * (theta_h / FRAC_PI_2).sqrt() - 0.5).clamp(0.0, (n_h - 1) as f32);
        let d = (n_d as f32 * (theta_d / FRAC_PI_2) - 0.5).clamp(0.0, (n_d - 1) as f32);
        let phi = n_phi as f32 * (phi_d / PI) - 0.5;
        let [i, j] = [(h as usize).min(n_h - 2), (d as usize).min(n_d - 2)];
        let low = phi.floor();
        let [a, b, c] = [h - i as f32, d - j as f32, phi - low];
        let k = if low < 0.0 { n_phi - 1 } else { (low as usize).min(n_phi - 1) };
        let next = if k + 1 == n_phi { 0 } else { k + 1 };
        let along = |i: usize, j: usize| cell(i, j, k).lerp(cell(i, j, next), c);
        let across = |i: usize| along(i, j).lerp(along(i, j + 1), b);
        across(i).lerp(across(i + 1), a)
    }

    /// The response of a surface with this table: π f_r (N·L), all of it as the specular term.
    #[must_use]
    pub fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        let Some((cos_l, _)) = frame.cosines(l, v) else { return Terms::default() };
        Terms::of(Vec3::ZERO, PI * cos_l * self.value(angles(l, v, frame.n)))
    }
}

/// Gives missing entries the value of the nearest before them along an axis, or else of the nearest behind them. `step` is
/// from one to the next along it.
fn continued(entries: &mut [Option<Vec3>], count: usize, step: usize) {
    for first in (0..entries.len()).filter(|i| (i / step).is_multiple_of(count)) {
        let line = (0..count).map(|i| first + i * step);
        let Some(found) = line.clone().find_map(|i| entries[i]) else { continue };
        let mut last = found;
        for i in line {
            last = *entries[i].get_or_insert(last);
        }
    }
}

/// The middles of the bins: θ_h, θ_d and φ_d in radians, φ_d fastest.
pub fn middles(counts: [usize; 3]) -> impl Iterator<Item = [f32; 3]> {
    let [n_h, n_d, n_phi] = counts;
    let place = move |i: usize| [i / (n_d * n_phi), i / n_phi % n_d, i % n_phi];
    (0..n_h * n_d * n_phi).map(move |i| middle(counts, place(i)))
}

/// The middle of a bin: θ_h, θ_d and φ_d in radians.
fn middle(counts: [usize; 3], place: [usize; 3]) -> [f32; 3] {
    let [h, d, phi] = [0, 1, 2].map(|axis| (place[axis] as f32 + 0.5) / counts[axis] as f32);
    [FRAC_PI_2 * h.powi(2), FRAC_PI_2 * d, PI * phi]
}

/// Directions to light and viewer in the local frame for three angles in radians.
#[must_use]
pub fn directions([theta_h, theta_d, phi_d]: [f32; 3]) -> (Vec3, Vec3) {
    let [(sine_h, cosine_h), (sine_d, cosine_d), (sine, cosine)] =
        [theta_h, theta_d, phi_d].map(f32::sin_cos);
    let h = Vec3::new(sine_h, 0.0, cosine_h);
    let down = Vec3::new(cosine_h, 0.0, -sine_h);
    let l = cosine_d * h + sine_d * (cosine * down + sine * Vec3::Y);
    (l, 2.0 * l.dot(h) * h - l)
}

/// The numbers of a table of entries, φ_d fastest: for each its colour in sr⁻¹, or `None` if it was not measured: there the
/// table is continued from the nearest smaller θ_d, or else from elsewhere.
#[must_use]
pub fn with_gaps(counts: [usize; 3], mut entries: Vec<Option<Vec3>>) -> Vec<f32> {
    let measured: Vec<bool> = entries.iter().map(Option::is_some).collect();
    let [n_h, n_d, n_phi] = counts;
    for (count, step) in [(n_d, n_phi), (n_h, n_d * n_phi), (n_phi, 1)] {
        if entries.iter().any(Option::is_none) {
            continued(&mut entries, count, step);
        }
    }
    let marked = entries.into_iter().map(Option::unwrap_or_default).zip(measured);
    numbers(counts, marked, 0.0)
}

/// The numbers of a table of entries, φ_d fastest: for each its colour in sr⁻¹, and true if it was measured. `note` is the number for
/// the model.
#[must_use]
pub fn numbers(counts: [usize; 3], entries: impl IntoIterator<Item = (Vec3, bool)>, note: f32) -> Vec<f32> {
    let mut numbers = Vec::with_capacity(HEADER + 2 * counts.iter().product::<usize>());
    numbers.extend(counts.map(|count| count as f32));
    numbers.resize(HEADER, 0.0);
    let mut missing = 0u32;
    for (colour, measured) in entries {
        missing += u32::from(!measured);
        let mark = if measured { 1.0 } else { 0.0 };
        numbers.extend([packed(colour.x, colour.y), packed(colour.z, mark)]);
    }
    numbers[6] = missing as f32;
    numbers[7] = note;
    if let Some(lobe) = Grid::new(&numbers).map(|grid| fitted(&grid)) {
        numbers[3..6].copy_from_slice(&lobe);
    }
    numbers
}

/// The lobe of a table, by its profile along θ_h where light and viewer are close together: what is left at wide angles
/// scatters evenly, and the rest is a highlight, whose width is read off at half its height.
fn fitted(grid: &Grid) -> [f32; 3] {
    /// tan θ/α where GGX's distribution has half its height, √(√2 − 1).
    const HALF: f32 = 0.643_594_3;
    let [n_h, n_d, n_phi] = grid.counts;
    let angle = |i: usize| FRAC_PI_2 * ((i as f32 + 0.5) / n_h as f32).powi(2);
    let row = |i: usize| {
        let rows = n_d.div_ceil(10);
        let all = (0..rows).flat_map(|j| (0..n_phi).map(move |k| grid.cell(i, j, k).truncate()));
        (i, luminance(all.sum::<Vec3>() / (rows * n_phi) as f32))
    };
    let profile: Vec<_> = (0..n_h).map(row).collect();
    let wide = profile.iter().filter(|(i, _)| (0.8..1.3).contains(&angle(*i)));
    let floor = wide.map(|(_, value)| *value).fold(f32::INFINITY, f32::min);
    let floor = if floor.is_finite() { floor } else { 0.0 };
    let (top, height) = profile
        .iter()
        .filter(|(i, _)| angle(*i) < 0.4)
        .map(|(i, value)| (*i, value - floor))
        .fold((0, 0.0), |best, one| if one.1 > best.1 { one } else { best });
    let below = profile.iter().find(|(i, value)| *i > top && value - floor < 0.5 * height);
    let alpha = below.map_or(1.0, |(i, _)| angle(*i).tan() / HALF);
    let mut specular = 0.0;
    for (i, value) in &profile {
        let theta = angle(*i);
        // ∫ f cos θ_l dω_l for a viewer along the normal, where θ_l = 2 θ_h.
        let step = 2.0 * FRAC_PI_2 * (*i as f32 + 0.5) / (n_h * n_h) as f32;
        if theta < 0.5 * FRAC_PI_2 {
            let (sine, cosine) = theta.sin_cos();
            specular += (value - floor).max(0.0) * 8.0 * PI * sine * cosine * (2.0 * theta).cos() * step;
        }
    }
    [alpha.clamp(1e-3, 1.0), (PI * floor).clamp(0.0, 1.0), specular.clamp(0.0, 1.0)]
}
