//! Detects models that run too long, perhaps endlessly: a GPU cannot be stopped, but the interpreter stops
//! itself, so the CPU tries a model first.

use glam::Vec3;
use thiserror::Error;

use super::{ModelEntry, Surface, laws::Random};
use crate::{
    optics::{Frame, colour::Encoding},
    parameter::Values,
    shader::interpret::StepLimit,
};

/// A function of this model runs too long.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
#[error("{0} was not run on the GPU: on the CPU, which interprets it, {limit}", limit = StepLimit)]
pub struct Endless(pub &'static str);

/// Number of pairs of a batch that the CPU tries first.
const SAMPLE: usize = 32;

/// Fails if a model with these values runs too long for any of a few directions: a GPU cannot be stopped, but
/// the interpreter stops itself. Built-in models always pass.
///
/// # Errors
/// Returns [`Endless`] if a function runs too long.
pub fn check_that_it_ends(model: &ModelEntry, values: &Values, encoding: Encoding) -> Result<(), Endless> {
    if !model.is_interpreted() {
        return Ok(());
    }
    let mut random = Random(0xe4d);
    let axes = [Vec3::Z, Vec3::NEG_Z, Vec3::X, Vec3::Y];
    let mut pairs: Vec<_> = axes.iter().flat_map(|l| axes.map(|v| (*l, v))).collect();
    pairs.extend((0..SAMPLE).map(|_| (random.direction(), random.direction())));
    ends(model, model.instantiate(values, encoding).as_ref(), &pairs)
}

/// Like [`check_that_it_ends`], for one surface and some of these pairs of directions.
///
/// # Errors
/// Returns [`Endless`] if a function runs too long.
pub fn ends(model: &ModelEntry, surface: &dyn Surface, pairs: &[(Vec3, Vec3)]) -> Result<(), Endless> {
    for (l, v) in pairs.iter().step_by(pairs.len().div_ceil(2 * SAMPLE).max(1)) {
        surface.response(*l, *v, &Frame::LOCAL);
        if model.runs_too_long() {
            return Err(Endless(model.declaration.id));
        }
    }
    Ok(())
}
