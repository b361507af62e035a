//! `lcm albedo`: the directional albedo of a model at given cosines, for plots and comparisons.

use std::io;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::{
    Outcome,
    angles::{self, Column},
    evaluate::{Answers, Arguments, Started, find},
    workshop::{Workshop, valid},
};
use crate::{
    optics::{Frame, albedo::directional},
    parameter::ABOVE_ZERO,
};

/// The input column. At μ = 0 the viewer is in the surface, where a response is 0 by definition instead of
/// the limit of the albedo.
const COLUMNS: [Column; 1] = [Column { name: "mu", range: Some((ABOVE_ZERO as f64, 1.0)) }];

pub(super) fn run(arguments: &Arguments, workshop: &mut Workshop) -> Outcome {
    workshop.need(&arguments.model);
    let registry = &workshop.registry;
    let model = find(registry, &arguments.model)?;
    let values = arguments.set.values(model)?;
    valid(registry, model)?;
    arguments.on.can_run(model)?;
    let mut answers = Answers::new("mu,e_r,e_g,e_b");
    let mut machine = arguments.on.start(registry, model, &values);
    angles::stream(io::stdin().lock(), &COLUMNS, |rows| {
        let views: Vec<Vec3> = rows
            .iter()
            .map(|row| {
                let [mu] = row.numbers;
                DVec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu).as_vec3()
            })
            .collect();
        let albedos: Vec<DVec3> = match &mut machine {
            Started::Cpu(surface) => {
                let of =
                    |v: &Vec3| directional(|l| surface.response(l, *v, &Frame::LOCAL), *v, &Frame::LOCAL);
                views.par_iter().map(of).collect()
            }
            Started::Gpu(gpu) if !rows.is_empty() => gpu.evaluator()?.albedos(&views)?,
            Started::Gpu(_) => Vec::new(),
        };
        arguments.on.can_run(model)?;
        answers.write(rows.iter().map(|row| row.text[0].clone()).zip(albedos.iter().map(|e| e.as_vec3())))
    })?;
    answers.finish()
}
