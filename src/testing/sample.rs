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
fn random_value(p: &Parameter, seed: &mut u64) -> Value {
    let r = random(seed);
    match p.kind {
        ParameterKind::Colour(_) => {
            p.kind.of_numbers([r, random(seed), random(seed)].map(|v| (255.0 * v).into()))
        }
        _ => p.kind.random(1.0, r, &mut || random(seed)),
    }
}

/// Legal values of all parameters of a model.
pub fn random_values(model: &ModelEntry, seed: &mut u64) -> Values {
    values_of(model.parameters, seed)
}

/// Legal values of parameters.
pub(super) fn values_of(parameters: &[Parameter], seed: &mut u64) -> Values {
    Values::each(parameters, |p| random_value(p, seed))
}

/// A point in the default room.
pub(super) fn place(seed: &mut u64) -> Vec3 {
    Vec3::from_array([0; 3].map(|_| 10.0 * random(seed)))
}
