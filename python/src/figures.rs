//! Curves of models as figures.

use lights_camera_models::{
    curves::{
        Channel, Detail, Form, Format, Setup, Sheet, Subject, curve,
        data::{PAINTS, paint as measured},
        slice,
    },
    optics::colour::Encoding,
    progress::Progress,
};
use numpy::PyArray1;
use pyo3::{exceptions::PyValueError, prelude::*};

use crate::{
    model::{Model, kind_of},
    scene::one_of,
    work,
};

/// A figure of models and measured data, as the bytes of a file of this format.
#[pyfunction]
#[pyo3(signature = (models, kind, theta_i, phi_i, channel, log, data, format))]
pub fn plot(
    py: Python<'_>,
    models: Vec<PyRef<'_, Model>>,
    kind: &str,
    theta_i: f64,
    phi_i: f64,
    channel: Option<&str>,
    log: bool,
    data: Vec<String>,
    format: &str,
) -> PyResult<Vec<u8>> {
    let refused = |e: &dyn std::fmt::Display| PyValueError::new_err(e.to_string());
    let setup = Setup::new(kind_of(kind)?, theta_i, phi_i).map_err(|e| refused(&e))?;
    let channel = channel
        .map(|id| Channel::from_id(id).ok_or_else(|| one_of("channel", id, &Channel::ALL.map(Channel::id))));
    let channel = channel.transpose()?;
    let format =
        Format::from_id(format).ok_or_else(|| one_of("format", format, &Format::ALL.map(Format::id)))?;
    let of_model = |model: &PyRef<Model>| Subject::model(&model.entry, &model.values, Encoding::Srgb);
    let mut subjects: Vec<_> = models.iter().map(of_model).collect();
    for name in &data {
        subjects
            .push(Subject::measured(name).map_err(|rule| refused(&format!("data is {name:?}, but {rule}")))?);
    }
    let draw = |progress: &Progress| {
        subjects.iter().try_for_each(|subject| subject.has(setup.kind))?;
        let mut sheet = Sheet { channel, log, ..Sheet::new(setup) };
        for subject in &subjects {
            if setup.kind.declaration().form == Form::Slices {
                sheet.slices.push(slice(subject, &setup, Detail::Fine, progress)?);
            } else {
                sheet.curves.push(curve(subject, &setup, Detail::Fine, progress)?);
            }
        }
        Ok::<_, lights_camera_models::curves::CurveError>(sheet)
    };
    let sheet = work::long(py, draw)?.map_err(|e| refused(&e))?;
    Ok(format.bytes(&sheet)?)
}

/// A measured paint: for each value the angles of light and viewer in degrees, and the BRDF in red, green and blue.
#[pyfunction]
pub fn paint<'py>(py: Python<'py>, id: &str) -> PyResult<Bound<'py, PyArray1<f64>>> {
    let rows = measured(id);
    if rows.is_empty() {
        return Err(one_of("name", id, &PAINTS.map(|(id, _)| id)));
    }
    let row = |m: &lights_camera_models::curves::data::Measurement| {
        let angles = [m.theta_i, m.phi_i, m.theta_o, m.phi_i + m.delta_phi].map(f64::from);
        angles.into_iter().chain(m.f)
    };
    Ok(PyArray1::from_vec(py, rows.iter().flat_map(row).collect()))
}
