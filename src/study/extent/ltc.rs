//! Linearly transformed cosines: E. Heitz, J. Dupuy, S. Hill, D. Neubelt (2016), *Real-Time Polygonal-Light Shading with
//! Linearly Transformed Cosines*.
//!
//! A cosine lobe about z, transformed by a matrix M, is a lobe of another width, slant and skew; its integral
//! over a polygon equals that of the cosine over the polygon transformed by M⁻¹, for which J. Lambert (1760)
//! has a formula. Here M is fitted to a lobe for several angles of view: as in the paper its axis is the mean
//! direction of the lobe, and three numbers are free. The fit minimises the sum of squares of the difference,
//! the authors that of cubes; the results are close.

use std::f64::consts::{FRAC_1_PI, FRAC_PI_2, TAU};

use glam::{DMat3, DVec3, Vec3};

use crate::{
    matching::least_squares::{Limits, Residuals, Stop, descend},
    optics::{Frame, geometry::direction, sequence::Sequence},
    reflection::Surface,
};

/// Step between the angles of view of the fits, starting at 0°.
const STEP: f64 = 5.8;
const NODES: usize = 16;
/// Number of directions in which a lobe is evaluated.
const DIRECTIONS: u32 = 1024;
/// Ranges of the logarithms of both widths, and of the slant.
const RANGES: [(f64, f64); 3] = [(-9.0, 3.0), (-9.0, 3.0), (-20.0, 20.0)];
const LIMITS: Limits = Limits { steps: 40, least_gain: 1e-6, least_move: 1e-6, first_step: 1.0 };
/// Step of a coordinate in finite differences.
const CHANGE: f64 = 1e-5;

/// The fraction of a cosine lobe about z covered by a polygon, clipped at the horizon: its irradiance
/// relative to that of uniform surroundings.
pub(super) fn cosine_share(corners: &[DVec3; 4]) -> f64 {
    let mut above = Vec::with_capacity(5);
    for (i, a) in corners.iter().enumerate() {
        let b = &corners[(i + 1) % corners.len()];
        if a.z > 0.0 {
            above.push(a.normalize());
        }
        if (a.z > 0.0) != (b.z > 0.0) {
            above.push(a.lerp(*b, a.z / (a.z - b.z)).normalize_or_zero());
        }
    }
    let edges = above.iter().zip(above.iter().cycle().skip(1));
    let sum: f64 = edges
        .map(|(a, b)| {
            let across = a.cross(*b);
            // The angle subtended by the edge, times the z of the normal of its plane.
            across.length().atan2(a.dot(*b)) * across.normalize_or_zero().z
        })
        .sum();
    sum.abs() / TAU
}

/// The matrix of a lobe about a direction in the plane of x and z, with the logarithms of the widths in and
/// across that plane, and a slant.
fn matrix(about: DVec3, [along, across, slant]: [f64; 3]) -> DMat3 {
    let x = DVec3::new(about.z, 0.0, -about.x);
    let local =
        DMat3::from_cols(DVec3::X * along.exp(), DVec3::Y * across.exp(), DVec3::new(slant, 0.0, 1.0));
    DMat3::from_cols(x, DVec3::Y, about) * local
}

/// The density of the cosine lobe transformed by a matrix, given the inverse.
pub(super) fn density(inverse: &DMat3, l: DVec3) -> f64 {
    let back = *inverse * l;
    let squared = back.length_squared();
    FRAC_1_PI * back.z.max(0.0) * inverse.determinant().abs() / (squared * squared)
}

/// A direction of a lobe, the density of the lobe there, and the density of sampling.
struct Known {
    l: DVec3,
    lobe: f64,
    pdf: f64,
}

/// A lobe for one view.
struct Lobe {
    known: Vec<Known>,
    /// Mean direction.
    about: DVec3,
}

impl Lobe {
    /// The specular lobe of a surface for a view at an angle, as a density: its integral is 1.
    fn new(surface: &dyn Surface, degrees: f64) -> Self {
        let v = direction(degrees, 0.0);
        let (lobes, sequence) = (surface.lobes(), Sequence::new(1, 0));
        let mut known: Vec<_> = (0..DIRECTIONS)
            .map(|i| lobes.sample(sequence.point(i), v))
            .filter(|l| l.z > 0.0)
            .map(|l| {
                let lobe = f64::from(surface.response(l, v, &Frame::LOCAL).specular.y);
                Known { l: l.as_dvec3(), lobe, pdf: f64::from(lobes.pdf(l, v)) }
            })
            .collect();
        let sum: f64 = known.iter().map(|k| k.lobe / k.pdf).sum();
        known.iter_mut().for_each(|k| k.lobe *= f64::from(DIRECTIONS) / sum);
        let mean: DVec3 = known.iter().map(|k| k.l * (k.lobe / k.pdf)).sum();
        Self { known, about: DVec3::new(mean.x, 0.0, mean.z).normalize() }
    }

    /// The fraction of the lobe that a matrix misplaces: half the integral of the absolute difference.
    fn misplaced(&self, matrix: &DMat3) -> f64 {
        let inverse = matrix.inverse();
        let off = |k: &Known| (density(&inverse, k.l) - k.lobe).abs() / k.pdf;
        0.5 * self.known.iter().map(off).sum::<f64>() / f64::from(DIRECTIONS)
    }
}

impl Residuals for Lobe {
    fn count(&self) -> usize {
        self.known.len()
    }

    fn at(&mut self, point: &[f64], residuals: &mut [f64]) -> Result<(), Stop> {
        let inverse = matrix(self.about, [point[0], point[1], point[2]]).inverse();
        for (to, k) in residuals.iter_mut().zip(&self.known) {
            *to = (density(&inverse, k.l) - k.lobe) / k.pdf.sqrt();
        }
        Ok(())
    }

    fn derivatives(
        &mut self,
        point: &[f64],
        residuals: &mut [f64],
        columns: &mut [Vec<f64>],
    ) -> Result<(), Stop> {
        self.at(point, residuals)?;
        for (i, column) in columns.iter_mut().enumerate() {
            let mut beside = point.to_vec();
            beside[i] += CHANGE;
            self.at(&beside, column)?;
            column.iter_mut().zip(&*residuals).for_each(|(c, r)| *c = (*c - r) / CHANGE);
        }
        Ok(())
    }
}

/// The matrices of a lobe by the angle of view.
pub(super) struct Fitted {
    /// For each angle: the matrix, and the fraction of the lobe that it misplaces.
    nodes: Vec<(DMat3, f64)>,
}

impl Fitted {
    /// Fits the specular lobe of an isotropic surface. `width` is approximately its roughness α.
    pub(super) fn new(surface: &dyn Surface, width: f64) -> Self {
        // Each fit starts from the one before.
        let mut at = [width.ln(), width.ln(), 0.0];
        let nodes = (0..NODES).map(|i| {
            let mut lobe = Lobe::new(surface, STEP * i as f64);
            let about = lobe.about;
            // Nothing ends it early.
            let _ = descend(&mut lobe, &mut at, &RANGES, LIMITS);
            let fitted = matrix(about, at);
            (fitted, lobe.misplaced(&fitted))
        });
        Self { nodes: nodes.collect() }
    }

    /// A table with the same matrix for all views.
    #[cfg(test)]
    pub(super) fn of(matrix: DMat3) -> Self {
        Self { nodes: vec![(matrix, 0.0); NODES] }
    }

    /// The angle of view in degrees, the matrix, and the fraction of the lobe that it misplaces, for each
    /// fit.
    pub(super) fn all(&self) -> impl Iterator<Item = (f64, &DMat3, f64)> {
        self.nodes.iter().enumerate().map(|(i, (matrix, off))| (STEP * i as f64, matrix, *off))
    }

    /// The matrix for a view with this cosine, interpolated between the neighbouring fits.
    fn at(&self, cosine: f64) -> DMat3 {
        let angle = if cosine > 0.0 { cosine.min(1.0).acos() } else { FRAC_PI_2 };
        let x = (angle.to_degrees() / STEP).min((NODES - 1) as f64);
        let i = (x as usize).min(NODES - 2);
        let part = x - i as f64;
        self.nodes[i].0 * (1.0 - part) + self.nodes[i + 1].0 * part
    }

    /// The fraction of the lobe covered by a polygon with these corners relative to the point, with the
    /// normal n, for a viewer in the direction v.
    pub(super) fn share(&self, corners: &[Vec3; 4], n: Vec3, v: Vec3) -> f64 {
        // x in the plane of normal and view.
        let frame = Frame::new(n, v);
        let inverse = self.at(f64::from(n.dot(v))).inverse();
        cosine_share(&corners.map(|c| inverse * frame.to_local(c).as_dvec3()))
    }
}

/// The fraction of a cosine lobe about n covered by a polygon, for surfaces that obey Lambert's law.
pub(super) fn diffuse_share(corners: &[Vec3; 4], n: Vec3) -> f64 {
    let frame = Frame::from_normal(n);
    cosine_share(&corners.map(|c| frame.to_local(c).as_dvec3()))
}
