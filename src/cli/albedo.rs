//! `lcm albedo`: the directional albedo of a model at given cosines, for plots and comparisons.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::{angles::Column, evaluate::Quantity};
use crate::parameter::ABOVE_ZERO;

/// The albedo for viewers. At μ = 0 the viewer is in the surface, where a response is 0 by definition instead of the
/// limit of the albedo.
pub(super) const ALBEDO: Quantity<1, Vec3> = Quantity {
    columns: [Column { name: "mu", range: Some((ABOVE_ZERO as f64, 1.0)) }],
    header: "mu,e_r,e_g,e_b",
    input: |[mu]| DVec3::new((1.0 - mu * mu).max(0.0).sqrt(), 0.0, mu).as_vec3(),
    on_cpu: |surface, views| views.par_iter().map(|v| surface.directional_albedo(*v).as_vec3()).collect(),
    on_gpu: |gpu, views| Ok(gpu.albedos(views)?.iter().map(|e| e.as_vec3()).collect()),
    left_out: |_, _, _| Vec::new(),
};
