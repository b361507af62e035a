//! The buffer of lights: one, of fixed capacity, shared by all materials and visible to the vertex
//! and fragment stages. Changing a light rewrites the buffer and touches no material. A view with
//! overrides has a buffer of its own. At its end are the parameters of the lights, one after the other; when they
//! outgrow it, there is another buffer, and objects get other materials.

use std::sync::Arc;

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
    parameter::Table,
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

/// A light of the scene, as the shader has it.
#[derive(Clone, Debug, Default)]
pub struct Lit {
    record: LightRecord,
    /// Its own parameters. A parameter that is a file has the index of the first number of the file.
    words: Vec<u32>,
    /// Its files, each with the place of its parameter in `words`.
    tables: Vec<(usize, Table)>,
}

impl Lit {
    /// A light of the scene. A light of an unknown type gives no light.
    #[must_use]
    pub fn new(light: &Light, registry: &Registry, encoding: Encoding) -> Self {
        let record = record(light, registry, encoding);
        let Some(entry) = registry.light(&light.light_type) else {
            return Self { record, ..Self::default() };
        };
        let (words, tables) = (entry.words(&light.parameters, encoding), entry.tables(&light.parameters));
        Self { record, words, tables }
    }
}

/// The places of the words behind the lights: the parameters of all, and the numbers of each file once.
struct Places<'a> {
    /// The first word of each light.
    lights: Vec<usize>,
    /// The first number of each file.
    files: Vec<(&'a Arc<[f32]>, usize)>,
    /// The number of all words.
    count: usize,
}

impl<'a> Places<'a> {
    fn of(lights: &'a [Lit]) -> Self {
        let mut places = Self { lights: Vec::with_capacity(lights.len()), files: Vec::new(), count: 0 };
        for light in lights {
            places.lights.push(places.count);
            places.count += light.words.len();
        }
        for (_, Table { numbers, .. }) in lights.iter().flat_map(|light| &light.tables) {
            if places.of_file(numbers).is_none() {
                places.files.push((numbers, places.count));
                places.count += numbers.len();
            }
        }
        places
    }

    fn of_file(&self, numbers: &Arc<[f32]>) -> Option<usize> {
        self.files.iter().find(|(known, _)| Arc::ptr_eq(known, numbers)).map(|(_, at)| *at)
    }

    fn words(&self, lights: &[Lit]) -> Vec<u32> {
        let mut words = Vec::with_capacity(self.count);
        words.extend(lights.iter().flat_map(|light| &light.words));
        words
            .extend(self.files.iter().flat_map(|(numbers, _)| numbers.iter().map(|number| number.to_bits())));
        for (light, first) in lights.iter().zip(&self.lights) {
            for (place, Table { numbers, .. }) in &light.tables {
                words[first + place] = self.of_file(numbers).unwrap_or_default() as u32;
            }
        }
        words
    }
}

/// The number of words behind so many lights.
#[must_use]
pub fn word_count(lights: &[Lit]) -> usize {
    Places::of(&lights[..lights.len().min(MAX_LIGHTS)]).count
}

/// The bytes of `Illumination` in `lights.wgsl`, up to the last word in use. Lights beyond [`MAX_LIGHTS`] are left out;
/// the checker refuses such scenes.
#[must_use]
pub fn illumination_bytes(lights: &[Lit], terms: TermSelection, display: &Display) -> Vec<u8> {
    let lights = &lights[..lights.len().min(MAX_LIGHTS)];
    let places = Places::of(lights);
    let mut bytes = vec![0u8; HEADER_BYTES + MAX_LIGHTS * LIGHT_BYTES];
    let mut put = |at: usize, value: [u8; 4]| bytes[at..at + 4].copy_from_slice(&value);
    put(0, (lights.len() as u32).to_le_bytes());
    put(4, terms.code().to_le_bytes());
    put(8, exposure_factor(display.exposure).to_le_bytes());
    put(12, u32::from(display.encoding == Encoding::Off).to_le_bytes());
    for (i, (Lit { record, .. }, first)) in lights.iter().zip(&places.lights).enumerate() {
        let base = HEADER_BYTES + i * LIGHT_BYTES;
        let mut put3 = |at: usize, v: Vec3| {
            for (k, c) in v.to_array().into_iter().enumerate() {
                put(base + at + 4 * k, c.to_le_bytes());
            }
        };
        put3(0, record.position);
        put3(16, record.direction);
        put3(32, record.colour);
        put(base + 12, record.light_type.to_le_bytes());
        put(base + 28, record.intensity.to_le_bytes());
        put(base + 44, (*first as u32).to_le_bytes());
    }
    bytes.extend(places.words(lights).into_iter().flat_map(u32::to_le_bytes));
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_lights_than_fit_are_left_out() {
        let lights = vec![Lit { words: vec![7], ..Lit::default() }; MAX_LIGHTS + 5];
        let bytes = illumination_bytes(&lights, TermSelection::All, &Display::default());
        assert_eq!(bytes[..4], (MAX_LIGHTS as u32).to_le_bytes());
        assert_eq!(bytes.len(), HEADER_BYTES + MAX_LIGHTS * LIGHT_BYTES + 4 * MAX_LIGHTS);
    }
}
