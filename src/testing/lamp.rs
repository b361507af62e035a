//! Lights at random, and how shaders get them.

use glam::Vec3;

use super::sample::{any_direction, place, random, values_of};
use crate::{
    light::{LightEntry, LightRecord},
    optics::colour::Encoding,
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

/// The parameters of a light as its function in WGSL takes them, and the numbers of its files.
pub(super) fn words(light: &LightEntry, values: &Values) -> (Vec<u32>, Vec<u32>) {
    let mut words = light.words(values, Encoding::Srgb);
    let mut files = Vec::new();
    for (at, table) in light.tables(values) {
        words[at] = files.len() as u32;
        files.extend(table.numbers.iter().map(|n| n.to_bits()));
    }
    (words, files)
}

/// The arguments of the function of a light type in WGSL: the light, its own parameters, the point.
pub(super) fn arguments(record: &LightRecord, own: &[u32], p: Vec3) -> Vec<u32> {
    let LightRecord { light_type, position, direction, colour, intensity } = *record;
    let mut arguments = Vec::new();
    let mut put = |numbers: &[f32]| arguments.extend(numbers.iter().map(|n| n.to_bits()));
    put(&position.to_array());
    put(&[f32::from_bits(light_type)]);
    put(&direction.to_array());
    put(&[intensity]);
    put(&colour.to_array());
    // Where its parameters begin: they are given to it here.
    put(&[0.0]);
    arguments.extend(own);
    arguments.extend(p.to_array().map(f32::to_bits));
    arguments
}
