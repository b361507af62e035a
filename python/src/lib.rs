//! The core of the Python package `lights_camera_models`: what needs Rust, as plain as possible. Arrays arrive contiguous,
//! as 32-bit floats, and parameters as JSON; the modules in Python beside it check shapes, convert, and document.

mod errors;
mod figures;
mod known;
mod model;
mod pictures;
mod scene;
mod work;

use pyo3::prelude::*;

/// The module `lights_camera_models._lcm`.
#[pymodule]
mod _lcm {
    use pyo3::prelude::*;

    #[pymodule_export]
    use super::{
        figures::{paint, plot},
        known::{add_model, describe, models},
        model::Model,
        pictures::{compare_codes, compare_light, compare_views, png},
        scene::Scene,
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}

/// The name under which panics are reported, which are errors of this package.
fn bug(what: &str) -> PyErr {
    pyo3::exceptions::PyRuntimeError::new_err(format!(
        "a mistake in lights_camera_models, not in its use: {what}"
    ))
}
