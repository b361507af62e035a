use glam::Vec3;

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{Frame, Terms, half_difference::Grid, lobes::Lobes},
    parameter::Parameter,
    parameters,
};

mod example;
mod read;
#[cfg(test)]
mod tests;

pub use read::{COUNTS, FORMAT, SCALES};

const FILE: Parameter = Parameter::file("merl_file", &FORMAT, example::NAME)
    .label("measurement")
    .help(
        "A file of the MERL BRDF database, by its name from the folder of the scene. The measurements are not part of the program: \
         until you choose one, a surface is shown whose table was calculated.",
    );

parameters! {
    /// **Measured (MERL)** — the reflectance of a real surface from a table, without an equation of its own.
    ///
    /// ```text
    /// f_r = Σ w t over the eight entries t around (x_h, x_d, x_φ)
    /// x_h = n_h √(θ_h/90°) − ½,  x_d = n_d θ_d/90° − ½,  x_φ = n_φ φ_d/180° − ½
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `merl_file` | t | sr⁻¹ | a `.binary` file | `calculated.binary` |
    ///
    /// Source: W. Matusik, H. Pfister, M. Brand, L. McMillan (2003), *A Data-Driven Reflectance Model*, ACM Transactions on
    /// Graphics 22(3); the angles: S. Rusinkiewicz (1998), *A New Change of Variables for Efficient BRDF Representation*.
    /// `θ_h` is the angle between half vector and normal, `θ_d` that between light and half vector, `φ_d` the azimuth of
    /// the light about the half vector, from the plane of half vector and normal. A file has 90 × 90 × 180 entries; those of
    /// `θ_h` are closer together near 0. Reciprocity makes `φ_d` and `φ_d + 180°` one entry. An entry is taken as the value
    /// in the middle of its bin, and values between are interpolated linearly in x_h, x_d and x_φ. In front of the first
    /// middle and behind the last, the outermost value holds.
    ///
    /// Negative entries are marks of directions that were not measured. There the table is continued from the nearest smaller
    /// `θ_d`, and *Explain* says so (m = 0). Reciprocal and non-negative by its construction, isotropic; whether it conserves energy
    /// depends on the file.
    pub struct MeasuredMerl {
        /// The table.
        merl_file: file = FILE,
    }
}

impl MeasuredMerl {
    /// The table; `None` without numbers.
    fn grid(&self) -> Option<Grid<'_>> {
        Grid::new(&self.merl_file.numbers)
    }
}

impl ReflectionModel for MeasuredMerl {
    const DECLARATION: Declaration =
        built_in!("measured_merl", "Measured (MERL)", Measured).ambient_by_albedo().measured();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        self.grid().map_or_else(Terms::default, |grid| grid.response(l, v, frame))
    }

    fn lobes(&self) -> Lobes {
        self.grid().map_or_else(Lobes::default, |grid| grid.lobes())
    }

    fn quantity(&self, symbol: &str, arguments: &[f32]) -> Option<Vec3> {
        self.grid()?.quantity(symbol, arguments)
    }

    fn measured_near(&self, l: Vec3, v: Vec3) -> Option<(Vec3, Vec3)> {
        self.grid()?.nearest(l, v)
    }
}
