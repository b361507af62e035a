//! The buffer of lights: one, of fixed capacity, shared by all materials and visible to the vertex
//! and fragment stages. Changing a light rewrites the buffer and touches no material. A view with
//! overrides has a buffer of its own. At its end are the parameters of the lights, one after the other; when they
//! outgrow it, there is another buffer, and objects get other materials.

use bevy::{
    asset::{Assets, Handle, RenderAssetUsages},
    ecs::{
        resource::Resource,
        world::{FromWorld, World},
    },
    render::storage::ShaderBuffer,
};
use glam::Vec3;

use crate::{
    light::{LightRecord, MAX_LIGHTS},
    optics::{TermSelection, colour::Encoding, tone::exposure_factor},
    registry::Registry,
    scene::{Display, Light, record},
};

/// Bytes before the lights: count, terms, exposure, gamma-naive.
pub const HEADER_BYTES: usize = 16;
/// Bytes of one light.
pub const LIGHT_BYTES: usize = 48;
/// Words for the parameters of all lights that a buffer has room for at first: four for each.
const WORDS: usize = 4 * MAX_LIGHTS;

/// Byte offsets of the fields of `Light` in `lights.wgsl`; a test compares them with the shader's.
pub const LIGHT_LAYOUT: [(&str, usize); 6] = [
    ("position", 0),
    ("light_type", 12),
    ("direction", 16),
    ("intensity", 28),
    ("colour", 32),
    ("first_word", 44),
];
/// Byte offsets of the fields of `Illumination` in `lights.wgsl`.
pub const ILLUMINATION_LAYOUT: [(&str, usize); 6] = [
    ("count", 0),
    ("terms", 4),
    ("exposure", 8),
    ("gamma_naive", 12),
    ("lights", HEADER_BYTES),
    ("words", HEADER_BYTES + MAX_LIGHTS * LIGHT_BYTES),
];

/// The terms of the equation that are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Resource)]
pub struct ShownTerms(pub TermSelection);

/// The buffer of all lights of the scene, as views without overrides show them.
#[derive(Clone, Debug, Resource)]
pub struct IlluminationBuffer {
    /// The buffer; another one when the parameters of the lights outgrow it.
    pub handle: Handle<ShaderBuffer>,
    /// The words for parameters of lights that it has room for, and those of all views.
    room: usize,
}

impl IlluminationBuffer {
    /// A buffer that has no lights yet, for another view.
    pub(super) fn another(&self, buffers: &mut Assets<ShaderBuffer>) -> Handle<ShaderBuffer> {
        without_lights(self.room, buffers)
    }

    /// Makes room for so many words. True if the buffer is another one than before, as are those of all views then.
    pub(super) fn hold(&mut self, words: usize, buffers: &mut Assets<ShaderBuffer>) -> bool {
        if words <= self.room {
            return false;
        }
        self.room = words.next_power_of_two();
        self.handle = self.another(buffers);
        true
    }
}

impl FromWorld for IlluminationBuffer {
    fn from_world(world: &mut World) -> Self {
        let handle = without_lights(WORDS, &mut world.resource_mut::<Assets<ShaderBuffer>>());
        Self { handle, room: WORDS }
    }
}

fn without_lights(room: usize, buffers: &mut Assets<ShaderBuffer>) -> Handle<ShaderBuffer> {
    let mut bytes = illumination_bytes(&[], TermSelection::All, &Display::default());
    bytes.resize(bytes.len() + 4 * room, 0);
    buffers.add(ShaderBuffer::new(&bytes, RenderAssetUsages::default()))
}

/// A light of the scene and the words of its own parameters. A light of an unknown type gives no light.
#[must_use]
pub fn lit(light: &Light, registry: &Registry, encoding: Encoding) -> (LightRecord, Vec<u32>) {
    let words = registry.light(&light.light_type).map(|entry| entry.words(&light.parameters, encoding));
    (record(light, registry, encoding), words.unwrap_or_default())
}

/// The bytes of `Illumination` in `lights.wgsl`, up to the last word in use. Lights beyond [`MAX_LIGHTS`] are left out;
/// the checker refuses such scenes.
#[must_use]
pub fn illumination_bytes(
    lights: &[(LightRecord, Vec<u32>)],
    terms: TermSelection,
    display: &Display,
) -> Vec<u8> {
    let lights = &lights[..lights.len().min(MAX_LIGHTS)];
    let mut bytes = vec![0u8; HEADER_BYTES + MAX_LIGHTS * LIGHT_BYTES];
    let mut put = |at: usize, value: [u8; 4]| bytes[at..at + 4].copy_from_slice(&value);
    put(0, (lights.len() as u32).to_le_bytes());
    put(4, terms.code().to_le_bytes());
    put(8, exposure_factor(display.exposure).to_le_bytes());
    put(12, u32::from(display.encoding == Encoding::Off).to_le_bytes());
    let mut first_word = 0;
    for (i, (light, words)) in lights.iter().enumerate() {
        let base = HEADER_BYTES + i * LIGHT_BYTES;
        let mut put3 = |at: usize, v: Vec3| {
            for (k, c) in v.to_array().into_iter().enumerate() {
                put(base + at + 4 * k, c.to_le_bytes());
            }
        };
        put3(0, light.position);
        put3(16, light.direction);
        put3(32, light.colour);
        put(base + 12, light.light_type.to_le_bytes());
        put(base + 28, light.intensity.to_le_bytes());
        put(base + 44, (first_word as u32).to_le_bytes());
        first_word += words.len();
    }
    bytes.extend(lights.iter().flat_map(|(_, words)| words).flat_map(|word| word.to_le_bytes()));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_lights_than_fit_are_left_out() {
        let lights = vec![(LightRecord::default(), vec![7]); MAX_LIGHTS + 5];
        let bytes = illumination_bytes(&lights, TermSelection::All, &Display::default());
        assert_eq!(bytes[..4], (MAX_LIGHTS as u32).to_le_bytes());
        assert_eq!(bytes.len(), HEADER_BYTES + MAX_LIGHTS * LIGHT_BYTES + 4 * MAX_LIGHTS);
    }
}
