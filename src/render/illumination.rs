//! The buffer of lights: one, of fixed capacity, shared by all materials and visible to the vertex
//! and fragment stages. Changing a light rewrites the buffer and touches no material. A view with
//! overrides has a buffer of its own.

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
    scene::Display,
};

/// Bytes before the lights: count, terms, exposure, gamma-naive.
pub const HEADER_BYTES: usize = 16;
/// Bytes of one light.
pub const LIGHT_BYTES: usize = 64;

/// Byte offsets of the fields of `Light` in `lights.wgsl`; a test compares them with the shader's.
pub const LIGHT_LAYOUT: [(&str, usize); 6] = [
    ("position", 0),
    ("light_type", 12),
    ("direction", 16),
    ("intensity", 28),
    ("colour", 32),
    ("parameters", 48),
];
/// Byte offsets of the fields of `Illumination` in `lights.wgsl`.
pub const ILLUMINATION_LAYOUT: [(&str, usize); 5] =
    [("count", 0), ("terms", 4), ("exposure", 8), ("gamma_naive", 12), ("lights", HEADER_BYTES)];

/// The terms of the equation that are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Resource)]
pub struct ShownTerms(pub TermSelection);

/// The buffer of all lights of the scene, as views without overrides show them.
#[derive(Clone, Debug, Resource)]
pub struct IlluminationBuffer(pub Handle<ShaderBuffer>);

impl IlluminationBuffer {
    /// A new buffer that has no lights yet.
    pub(super) fn without_lights(buffers: &mut Assets<ShaderBuffer>) -> Self {
        let bytes = illumination_bytes(&[], TermSelection::All, &Display::default());
        Self(buffers.add(ShaderBuffer::new(&bytes, RenderAssetUsages::default())))
    }
}

impl FromWorld for IlluminationBuffer {
    fn from_world(world: &mut World) -> Self {
        Self::without_lights(&mut world.resource_mut::<Assets<ShaderBuffer>>())
    }
}

/// The bytes of `Illumination` in `lights.wgsl`. Lights beyond [`MAX_LIGHTS`] are left out; the
/// checker refuses such scenes.
#[must_use]
pub fn illumination_bytes(lights: &[LightRecord], terms: TermSelection, display: &Display) -> Vec<u8> {
    let count = lights.len().min(MAX_LIGHTS);
    let mut bytes = vec![0u8; HEADER_BYTES + MAX_LIGHTS * LIGHT_BYTES];
    let mut put = |at: usize, value: [u8; 4]| bytes[at..at + 4].copy_from_slice(&value);
    put(0, (count as u32).to_le_bytes());
    put(4, terms.code().to_le_bytes());
    put(8, exposure_factor(display.exposure).to_le_bytes());
    put(12, u32::from(display.encoding == Encoding::Off).to_le_bytes());
    for (i, light) in lights.iter().take(count).enumerate() {
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
        for (k, p) in light.parameters.into_iter().enumerate() {
            put(base + 48 + 4 * k, p.to_le_bytes());
        }
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_lights_than_fit_are_left_out() {
        let lights = vec![LightRecord::default(); MAX_LIGHTS + 5];
        let bytes = illumination_bytes(&lights, TermSelection::All, &Display::default());
        assert_eq!(bytes[..4], (MAX_LIGHTS as u32).to_le_bytes());
        assert_eq!(bytes.len(), HEADER_BYTES + MAX_LIGHTS * LIGHT_BYTES);
    }
}
