//! Random directions and parameters, identical in every run.

use glam::Vec3;

use crate::{
    parameter::{Parameter, ParameterKind, Value, Values},
    reflection::ModelEntry,
};

/// Values of a small deterministic generator, uniform in [0, 1).
pub fn random(seed: &mut u64) -> f32 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 40) as f32 / (1u64 << 24) as f32
}

/// A direction above the surface.
pub fn direction(seed: &mut u64) -> Vec3 {
    let z = random(seed);
    let phi = std::f32::consts::TAU * random(seed);
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(r * phi.cos(), r * phi.sin(), z)
}

/// A direction on the whole sphere.
pub(super) fn any_direction(seed: &mut u64) -> Vec3 {
    let d = direction(seed);
    if random(seed) < 0.5 { -d } else { d }
}

/// A legal value.
pub(super) fn random_value(p: &Parameter, seed: &mut u64) -> Value {
    let r = random(seed);
    match p.kind {
        ParameterKind::Number { min, max, .. } => Value::Number(min + r * (max - min)),
        ParameterKind::Integer { min, max, slider_max, .. } => {
            Value::Integer(min + (r * (max.unwrap_or(slider_max) - min) as f32) as i64)
        }
        ParameterKind::Colour { .. } => {
            Value::Colour([(255.0 * r) as u8, (255.0 * random(seed)) as u8, (255.0 * random(seed)) as u8])
        }
        ParameterKind::Triple { min, max, .. } => {
            Value::Triple([0; 3].map(|_| min + random(seed) * (max - min)))
        }
        ParameterKind::Choice { options, .. } => {
            Value::Choice(options[(r * options.len() as f32) as usize].0.into())
        }
        ParameterKind::File { .. } => p.default_value(),
    }
}

/// Legal values of all parameters of a model.
pub fn random_values(model: &ModelEntry, seed: &mut u64) -> Values {
    let mut values = Values::default();
    for p in model.parameters {
        values.set(p.name, random_value(p, seed));
    }
    values
}
