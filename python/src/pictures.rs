//! Pictures compared, and pictures in files.

use glam::Vec4;
use lights_camera_models::{
    compare::{Pair, Shown},
    picture::png::{About, encode},
    reference::{Picture, Until},
    scene::{
        comparison::{Channel, Compared, Comparison, Sign},
        held::Word,
    },
};
use numpy::{PyArray1, PyReadonlyArray3, PyUntypedArrayMethods as _};
use pyo3::{exceptions::PyValueError, prelude::*};

use crate::{
    scene::{Scene, Wanted, one_of},
    work,
};

/// Metrics as JSON, the differences, and their map as codes.
type Compared3<'py> = (String, Bound<'py, PyArray1<f32>>, Bound<'py, PyArray1<u8>>);

/// The subject of a comparison: the channel, the sign, and the amplification of the map.
type How = (String, String, Option<f32>);

/// Compares two pictures of display codes, of the same size.
#[pyfunction]
pub fn compare_codes<'py>(
    py: Python<'py>,
    a: PyReadonlyArray3<'py, u8>,
    b: PyReadonlyArray3<'py, u8>,
    how: How,
) -> PyResult<Compared3<'py>> {
    let shown = |of: &PyReadonlyArray3<'py, u8>| {
        let [width, height] = size(of.shape());
        let codes = of.as_slice()?.to_vec();
        Shown::of_codes(width, height, codes).map_err(|e| PyValueError::new_err(e.to_string()))
    };
    compared(py, &shown(&a)?, &shown(&b)?, &how, Compared::Codes)
}

/// Compares two pictures of linear light, of the same size.
#[pyfunction]
pub fn compare_light<'py>(
    py: Python<'py>,
    a: PyReadonlyArray3<'py, f32>,
    b: PyReadonlyArray3<'py, f32>,
    how: How,
) -> PyResult<Compared3<'py>> {
    let shown = |of: &PyReadonlyArray3<'py, f32>| -> PyResult<Shown> {
        let [width, height] = size(of.shape());
        let pixels =
            of.as_slice()?.as_chunks::<3>().0.iter().map(|&[r, g, b]| Vec4::new(r, g, b, 1.0)).collect();
        Ok(Shown::linear(Picture { width, height, pixels }, false))
    };
    compared(py, &shown(&a)?, &shown(&b)?, &how, Compared::Light)
}

/// Draws and compares a view of two scenes each.
#[pyfunction]
pub fn compare_views<'py>(
    py: Python<'py>,
    a: (PyRef<'py, Scene>, String),
    b: (PyRef<'py, Scene>, String),
    size: [u32; 2],
    light_samples: u32,
    how: How,
) -> PyResult<Compared3<'py>> {
    let draw = |scene: &Scene, view: &str| {
        let until = Until { samples: light_samples, noise: None };
        scene.draw(py, &Wanted { size, samples: 4, view, terms: "all", channel: None, until }, true)
    };
    compared(py, &draw(&a.0, &a.1)?, &draw(&b.0, &b.1)?, &how, Compared::Codes)
}

/// The bytes of a PNG file.
#[pyfunction]
pub fn png(py: Python<'_>, codes: PyReadonlyArray3<'_, u8>) -> PyResult<Vec<u8>> {
    let ([width, height], codes) = (size(codes.shape()), codes.as_slice()?);
    let encoded = work::short(py, || {
        let mut bytes = Vec::new();
        encode(&mut bytes, width, height, codes, &About::program()).map(|()| bytes)
    })?;
    Ok(encoded?)
}

/// Width and height, from the shape of an array whose rows come first.
fn size(shape: &[usize]) -> [u32; 2] {
    [shape[1], shape[0]].map(|side| u32::try_from(side).unwrap_or(u32::MAX))
}

fn compared<'py>(
    py: Python<'py>,
    a: &Shown,
    b: &Shown,
    (channel, sign, amplification): &How,
    values: Compared,
) -> PyResult<Compared3<'py>> {
    let channel = chosen::<Channel>("channel", channel)?;
    let sign = chosen::<Sign>("sign", sign)?;
    if let Some(factor) = amplification {
        Comparison::amplification
            .check_number(*factor)
            .map_err(|rule| PyValueError::new_err(format!("amplification is {factor}, but {rule}")))?;
    }
    let amplification = *amplification;
    let [width, height] = a.size();
    work::room(60 * width as usize * height as usize)?;
    let comparison = Comparison { values, channel, sign, amplification, ..Comparison::default() };
    let pair = Pair::new(a, b).map_err(|e| PyValueError::new_err(e.to_string()))?;
    let (measured, differences, map) =
        work::long(py, |_| (pair.measure(), pair.differences(&comparison), pair.bare_map(&comparison)))?;
    let wrong = |e: &dyn std::fmt::Display| PyValueError::new_err(e.to_string());
    let (differences, map) = (differences.map_err(|e| wrong(&e))?, map.map_err(|e| wrong(&e))?);
    let measured =
        measured.ok_or_else(|| PyValueError::new_err("pictures without pixels cannot be compared"))?;
    let numbers = |metrics: &lights_camera_models::compare::Metrics| {
        let known =
            metrics.numbers.iter().filter_map(|(id, number)| Some(((*id).to_owned(), finite((*number)?))));
        let mut all: serde_json::Map<_, _> = known.collect();
        all.insert("pixels".to_owned(), metrics.pixels.into());
        serde_json::Value::Object(all)
    };
    let said = serde_json::json!({
        "all": numbers(&measured.all),
        "covered": measured.covered.as_ref().map(numbers),
        "largest": differences.largest,
    });
    Ok((said.to_string(), PyArray1::from_vec(py, differences.pixels), PyArray1::from_vec(py, map)))
}

/// The choice with a word.
fn chosen<T: Word>(name: &str, word: &str) -> PyResult<T> {
    T::of_word(word).ok_or_else(|| {
        let known: Vec<_> = T::CHOICES.iter().map(|choice| choice.about()[0]).collect();
        one_of(name, word, &known)
    })
}

/// A number, or null if it is infinite, which JSON cannot express.
fn finite(number: f64) -> serde_json::Value {
    if number.is_finite() { number.into() } else { serde_json::Value::Null }
}
