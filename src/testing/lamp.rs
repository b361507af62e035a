//! Lights at random.

use glam::Vec3;

use super::sample::{any_direction, place, random, values_of};
use crate::{
    light::{LightEntry, LightRecord},
    parameter::Values,
};

/// A light of a type somewhere in the default room, with parameters as a scene may have them.
pub(super) fn sample(light: &LightEntry, seed: &mut u64) -> (Values, LightRecord) {
    let values = values_of(light.parameters, seed);
    let position = place(seed);
    let direction = any_direction(seed);
    let d = light.declaration;
    let record = LightRecord {
        light_type: light.index,
        position: if d.has_position { position } else { Vec3::ZERO },
        direction: if d.has_direction { direction } else { Vec3::ZERO },
        colour: Vec3::ONE,
        intensity: 0.1 + 100.0 * random(seed),
    };
    (values, record)
}
