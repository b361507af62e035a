use glam::Vec3;

use super::{Declaration, ReflectionModel, built_in};
use crate::{
    optics::{Frame, TermSelection, Terms, lobes::Lobes, radiometry::Arriving},
    parameter::Parameter,
    parameters,
};

mod example;
mod read;
mod slice;
mod table;
#[cfg(test)]
mod tests;
mod viewed;

pub use read::{FORMAT, MAX_NUMBERS, is_spectral};

const FILE: Parameter = Parameter::file("rgl_file", &FORMAT, example::NAME)
    .label("measurement")
    .help(
        "A file of the RGL material database, by its name from the folder of the scene. The measurements are not part of the program: \
         until you choose one, a surface is shown whose table was calculated.",
    );

parameters! {
    /// **Measured (RGL)** — the reflectance of a real surface from a table over visible normals, without an equation of its own.
    ///
    /// ```text
    /// f_r N·L = ρ(x, y) D(u, v) / (4 σ(V)),  (x, y) = the warp of (u, v) by the density of normals that V sees
    /// u = √(θ_h/90°),  v = φ_h/360° + ½
    /// ```
    ///
    /// | parameter | symbol | unit | range | default |
    /// |---|---|---|---|---|
    /// | `rgl_file` | ρ | 1 | a `.bsdf` file | `calculated.bsdf` |
    ///
    /// Source: J. Dupuy, W. Jakob (2018), *An Adaptive Parameterization for Efficient Material Acquisition and Rendering*, ACM
    /// Transactions on Graphics 37(6). A file has for a number of directions of the viewer the density of visible normals on a
    /// grid over (u, v), and values on a grid over the unit square that this density makes even. Between the directions
    /// density and values are interpolated linearly, beyond them the outermost hold. `D` is the distribution of
    /// normals and `σ` its projected area, both from the file. In an isotropic file azimuths count from that of the viewer;
    /// one that covers half or a quarter of a turn is continued by its symmetry.
    ///
    /// Non-negative, since negative values are read as 0. Whether it is reciprocal or conserves energy depends on the file.
    pub struct MeasuredRgl {
        /// The table.
        rgl_file: file = FILE,
    }
}

impl MeasuredRgl {
    /// The table; `None` without numbers.
    fn data(&self) -> Option<table::Data<'_>> {
        table::Data::new(&self.rgl_file.numbers)
    }

    /// The light that leaves under these lights.
    fn leaving(&self, lights: &[Arriving], v: Vec3, frame: &Frame) -> Vec3 {
        let v = frame.to_local(v);
        match &self.data() {
            Some(data) if v.z > 0.0 => viewed::lit_by(data, lights, v, frame),
            _ => Vec3::ZERO,
        }
    }
}

impl ReflectionModel for MeasuredRgl {
    const DECLARATION: Declaration =
        built_in!("measured_rgl", "Measured (RGL)", Measured).ambient_by_albedo().anisotropic().measured();

    fn response(&self, l: Vec3, v: Vec3, frame: &Frame) -> Terms {
        Terms::of(Vec3::ZERO, self.leaving(&[Arriving { l, light: Vec3::ONE }], v, frame))
    }

    fn lit_together(
        &self,
        lights: &[Arriving],
        v: Vec3,
        frame: &Frame,
        terms: TermSelection,
    ) -> Option<Vec3> {
        let has_any = matches!(terms, TermSelection::All | TermSelection::Specular);
        Some(if has_any { self.leaving(lights, v, frame) } else { Vec3::ZERO })
    }

    fn lobes(&self) -> Lobes {
        self.data().map_or_else(Lobes::default, |data| data.lobes())
    }

    fn quantity(&self, symbol: &str, arguments: &[f32]) -> Option<Vec3> {
        self.data()?.quantity(symbol, arguments)
    }
}
