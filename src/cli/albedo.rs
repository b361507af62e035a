//! `lcm albedo`: the directional albedo of a model at given cosines, for plots and comparisons.

use std::io::{self, BufWriter, Write as _};

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::{
    Outcome,
    angles::{self, Column},
    evaluate::{Arguments, Machine, find},
    workshop::{Workshop, valid},
};
use crate::{
    capture::evaluate::albedos,
    optics::{Frame, albedo::directional, colour::Encoding},
    reflection::parameter::ABOVE_ZERO,
};

/// The column that is read. At μ = 0 the viewer is in the surface, where a response is 0 by definition and
/// no limit of the albedo.
const COLUMNS: [Column; 1] = [Column { name: "mu", range: Some((ABOVE_ZERO as f64, 1.0)) }];

pub(super) fn run(arguments: &Arguments, workshop: &mut Workshop) -> Outcome {
    workshop.need(&arguments.model);
    let registry = &workshop.registry;
    let model = find(registry, &arguments.model)?;
    let values = arguments.set.values(model)?;
    valid(registry, model)?;
    arguments.on.can_run(model)?;
    let rows = angles::from_stdin(&COLUMNS)?;
    let views: Vec<Vec3> = rows
        .iter()
        .map(|row| {
            let [mu] = row.numbers;
            DVec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu).as_vec3()
        })
        .collect();
    let albedos: Vec<DVec3> = match arguments.on {
        Machine::Cpu => {
            let surface = model.instantiate(&values, Encoding::Srgb);
            let of = |v: &Vec3| directional(|l| surface.response(l, *v, &Frame::LOCAL), *v, &Frame::LOCAL);
            views.par_iter().map(of).collect()
        }
        Machine::Gpu => albedos(registry.sources(), model, &values, Encoding::Srgb, &views)?,
    };
    arguments.on.can_run(model)?;
    let mut out = BufWriter::new(io::stdout().lock());
    writeln!(out, "mu,e_r,e_g,e_b")?;
    for (row, e) in rows.iter().zip(albedos) {
        let e = e.as_vec3();
        writeln!(out, "{},{},{},{}", row.text[0], e.x, e.y, e.z)?;
    }
    Ok(out.flush()?)
}
