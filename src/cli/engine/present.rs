//! The window and the GPU.

use std::io;

pub use bevy::app::App;
use glam::{DVec3, Vec3};

use super::{Engine, Evaluator, pictures::Gpu, window};
use crate::{
    failure::Failure,
    optics::{Terms, colour::Encoding},
    parameter::Values,
    render::capture::{
        evaluate,
        gpu::{GpuError, find_adapter, may_have_hardware},
        trial::serve,
    },
    shader::report::annotated,
};

pub(in crate::cli) const ENGINE: Option<&Engine> = Some(&Engine {
    view: window::open,
    try_shaders: || Ok(serve(io::stdin().lock(), io::stdout().lock())?),
    may_have_gpu: may_have_hardware,
    find_adapter: || Ok(!find_adapter()?.software),
    pictures: |trial_program| Box::new(Gpu::new(trial_program)),
    evaluator: |sources, model| Ok(Box::new(evaluate::Evaluator::new(sources, model)?)),
});

impl Evaluator for evaluate::Evaluator {
    fn set(&mut self, values: &Values, encoding: Encoding) {
        self.set(values, encoding);
    }

    fn evaluate(&self, pairs: &[(Vec3, Vec3)]) -> Result<Vec<Terms>, Failure> {
        Ok(self.evaluate(pairs)?)
    }

    fn albedos(&self, views: &[Vec3]) -> Result<Vec<DVec3>, Failure> {
        Ok(self.albedos(views)?)
    }
}

impl From<GpuError> for Failure {
    fn from(error: GpuError) -> Self {
        match error {
            GpuError::Invalid(problem) => Self::Invalid(annotated(&problem, &problem.file)),
            GpuError::Endless(_) => Self::Invalid(error.to_string()),
            other => Self::NoRenderer(other.to_string()),
        }
    }
}
