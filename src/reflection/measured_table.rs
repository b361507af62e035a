use glam::Vec3;

use super::{Declaration, Readout, ReadoutValue, ReflectionModel, built_in};
use crate::{
    optics::{
        Frame, Terms,
        half_difference::{Grid, angles},
        lobes::Lobes,
    },
    parameter::Parameter,
    parameters,
};

mod read;
mod scattered;
#[cfg(test)]
mod tests;

pub use read::{FORMAT, MAX_SAMPLES};
pub use scattered::{COUNTS, NEAR};

const FILE: Parameter = Parameter::file("table_file", &FORMAT, read::NAME)
    .label("measurements")
    .help(
        "A CSV file with the angles of light and viewer in degrees and the BRDF in sr⁻¹, perhaps with its uncertainty, by its name from \
         the folder of the scene. Until you choose one, a surface is shown whose values were calculated.",
    );

parameters! {
    /// **Measured (table)** — the reflectance of a surface from samples at any angles, without an equation of its own.
    ///
    /// ```text
    /// T = Σ w_s f_s / Σ w_s over the eight nearest samples s,  w_s = ((R − d_s)/(R d_s))²
    /// f_r = Σ w T over the eight entries around (x_h, x_d, x_φ) of a table of 32 × 16 × 16
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `table_file` | f_s | sr⁻¹ | a `.csv` file | `calculated.csv` |
    ///
    /// Source: the angles: S. Rusinkiewicz (1998), *A New Change of Variables for Efficient BRDF Representation*; the
    /// interpolation of scattered data: R. Franke, G. Nielson (1980), *Smooth Interpolation of Large Sets of Scattered Data*,
    /// a local form of D. Shepard's method. `d_s` is the distance to a sample in (√(θ_h/90°), θ_d/90°, c cos 2φ_d, c sin 2φ_d) with
    /// `c = sin θ_h sin θ_d/4`: where an azimuth means nothing, it does not count. `R` is the distance of the ninth sample.
    ///
    /// The surface is taken as isotropic and reciprocal, whatever the samples say. Where no sample is within 0.1 of an entry,
    /// *Explain* says so (m = 0): there the value is a guess. Whether it conserves energy depends on the file.
    pub struct MeasuredTable {
        /// The samples, interpolated into a table.
        table_file: file = FILE,
    }
}

impl MeasuredTable {
    /// The table; `None` without numbers.
    fn grid(&self) -> Option<Grid<'_>> {
        Grid::new(&self.table_file.numbers)
    }
}

impl ReflectionModel for MeasuredTable {
    const DECLARATION: Declaration =
        built_in!("measured_table", "Measured (table)", Measured).ambient_by_albedo().measured();

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

    fn uncertainty(&self, l: Vec3, v: Vec3, frame: &Frame) -> Option<f32> {
        self.grid()?.uncertainty(angles(l, v, frame.n))
    }

    fn readouts(&self) -> Vec<Readout> {
        let sigma = self.grid().map_or(0.0, |grid| grid.note());
        let uncertainty = Readout {
            symbol: "σ_f",
            label: "relative uncertainty",
            help: "The mean of the column sigma divided by that of the values.",
            value: ReadoutValue::Number(sigma),
        };
        Some(uncertainty).filter(|_| sigma > 0.0).into_iter().collect()
    }
}
