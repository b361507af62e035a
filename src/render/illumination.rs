//! The light buffers, shared by all materials and visible to the vertex and fragment stages: a buffer
//! of fixed capacity, which shaders read for each light and pixel, and a buffer with the parameters
//! of the lights, one after the other. Changing a light rewrites the buffers and touches no material. A view
//! with overrides has separate buffers. When the parameters outgrow their buffer, it is replaced, and so are
//! the materials of objects.

use std::sync::Arc;

use bevy::{
    asset::RenderAssetUsages,
    prelude::*,
    render::{render_resource::BufferUsages, storage::ShaderBuffer},
};

use super::converge::Part;
use crate::{
    channel::Setting,
    debug,
    light::{LightRecord, MAX_LIGHTS},
    optics::{TermSelection, colour::Encoding, tone::exposure_factor},
    parameter::Table,
    reference::LightSamples,
    registry::Registry,
    scene::{Display, Light, record},
};

/// Number of bytes before the lights: count, terms, exposure, gamma-naive; debug channel, its light, the ends
/// of its scale; the first sample of light with extent, the number of samples, the look of pixels, and whether
/// the scene gives a background.
pub const HEADER_BYTES: usize = 48;
/// Offset of the samples among them.
pub(super) const SAMPLES_AT: usize = 32;
/// Number of bytes for the samples: the first, their number, and the look, which is that of the display or none.
const SAMPLE_BYTES: usize = 12;
/// The look of pictures whose target takes numbers: `LOOK_NUMBERS` in the shaders.
const LOOK_NUMBERS: u32 = 2;
/// Size of one light, in bytes.
pub const LIGHT_BYTES: usize = 48;
/// Initial capacity of the parameter buffer, in words: four for each light.
const WORDS: usize = 4 * MAX_LIGHTS;

/// Maximum number of ways through a rough body for the channel of the light that remains, whose colours are not a mean
/// of others, so that one frame takes them all.
pub const REMAINING_SAMPLES: u32 = 32;

/// The displayed terms of the equation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Resource)]
pub struct ShownTerms(pub TermSelection);

/// The buffers of the lights of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LightBuffers {
    /// `illumination` in the shaders.
    pub lights: Handle<ShaderBuffer>,
    /// `light_words` in the shaders.
    pub words: Handle<ShaderBuffer>,
}

impl LightBuffers {
    /// Buffers without lights.
    fn new(room: usize, buffers: &mut Assets<ShaderBuffer>) -> Self {
        let (lights, _) =
            illumination_bytes(&[], TermSelection::All, &Display::default(), None, LightSamples::DEFAULT);
        let mut lights = ShaderBuffer::new(&lights, RenderAssetUsages::default());
        lights.buffer_description.usage |= BufferUsages::UNIFORM;
        let words = ShaderBuffer::new(&vec![0; 4 * room], RenderAssetUsages::default());
        Self { lights: buffers.add(lights), words: buffers.add(words) }
    }

    /// True if a buffer is one of these.
    pub(super) fn has(&self, buffer: AssetId<ShaderBuffer>) -> bool {
        [self.lights.id(), self.words.id()].contains(&buffer)
    }
}

/// The light buffers of the scene, for views without overrides.
#[derive(Clone, Debug, Resource)]
pub struct IlluminationBuffer {
    /// The buffers; replaced when the parameters of the lights outgrow them.
    pub buffers: LightBuffers,
    /// Capacity for the parameters of lights, in words, for all views.
    room: usize,
}

impl IlluminationBuffer {
    /// Empty buffers for another view.
    pub(super) fn another(&self, buffers: &mut Assets<ShaderBuffer>) -> LightBuffers {
        LightBuffers::new(self.room, buffers)
    }

    /// Ensures capacity for this many words. True if the buffers were replaced, as then are those of all
    /// views.
    pub(super) fn hold(&mut self, words: usize, buffers: &mut Assets<ShaderBuffer>) -> bool {
        if words <= self.room {
            return false;
        }
        self.room = words.next_power_of_two();
        self.buffers = self.another(buffers);
        true
    }
}

impl FromWorld for IlluminationBuffer {
    fn from_world(world: &mut World) -> Self {
        let buffers = LightBuffers::new(WORDS, &mut world.resource_mut::<Assets<ShaderBuffer>>());
        Self { buffers, room: WORDS }
    }
}

/// A light of the scene, in the shader's layout.
#[derive(Clone, Debug, Default)]
pub struct Lit {
    record: LightRecord,
    /// The parameters of the light. A file parameter is the index of the file's first number.
    words: Vec<u32>,
    /// Files, each with the position of its parameter in `words`.
    tables: Vec<(usize, Table)>,
}

impl Lit {
    /// A light of the scene. A light of an unknown type is dark.
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

/// The positions of the words after the lights: the parameters of all lights, and the numbers of each file
/// once.
struct Places<'a> {
    /// The first word of each light.
    lights: Vec<usize>,
    /// The first number of each file.
    files: Vec<(&'a Arc<[f32]>, usize)>,
    /// The total number of words.
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

/// The number of words after these lights.
#[must_use]
pub fn word_count(lights: &[Lit]) -> usize {
    Places::of(&lights[..lights.len().min(MAX_LIGHTS)]).count
}

/// The bytes of the samples at [`SAMPLES_AT`]: for a frame that is part of a mean, or for all samples at
/// once.
pub(super) fn sample_bytes(part: Result<Part, u32>) -> [u8; SAMPLE_BYTES] {
    let Part { first, count } = part.unwrap_or_else(|all| Part { first: 0, count: all });
    let words = [first, count, u32::from(part.is_ok())];
    std::array::from_fn(|i| words[i / 4].to_le_bytes()[i % 4])
}

/// The bytes of `Illumination` in `lights.wgsl`, and those of `light_words` up to the last word in use.
/// Lights beyond [`MAX_LIGHTS`] are omitted; the checker refuses such scenes. `samples` is the number of
/// samples of light with extent in a frame.
#[must_use]
pub fn illumination_bytes(
    lights: &[Lit],
    terms: TermSelection,
    display: &Display,
    channel: Option<&Setting>,
    samples: u32,
) -> (Vec<u8>, Vec<u8>) {
    let lights = &lights[..lights.len().min(MAX_LIGHTS)];
    let places = Places::of(lights);
    let mut bytes = vec![0u8; HEADER_BYTES + MAX_LIGHTS * LIGHT_BYTES];
    let of_remaining = channel.is_some_and(|setting| setting.channel.is_of_remaining());
    let samples = if of_remaining { samples.min(REMAINING_SAMPLES) } else { samples };
    bytes[SAMPLES_AT..][..SAMPLE_BYTES].copy_from_slice(&sample_bytes(Err(samples)));
    let mut put = |at: usize, value: [u8; 4]| bytes[at..at + 4].copy_from_slice(&value);
    put(0, (lights.len() as u32).to_le_bytes());
    put(4, (terms as u32).to_le_bytes());
    put(8, exposure_factor(display.exposure).to_le_bytes());
    put(12, u32::from(display.encoding == Encoding::Off).to_le_bytes());
    put(SAMPLES_AT + SAMPLE_BYTES, u32::from(display.backdrop().is_some()).to_le_bytes());
    if let Some(Setting { channel, light, range: [low, high], from_position, numbers }) = channel {
        if *numbers {
            put(SAMPLES_AT + 8, LOOK_NUMBERS.to_le_bytes());
        }
        put(16, channel.code().to_le_bytes());
        if channel.is_of_remaining() {
            put(4, debug::REMAINING.to_le_bytes());
        }
        put(20, light.map_or(u32::MAX, |light| light as u32).to_le_bytes());
        let directed = channel.has_light() && !channel.is_picture();
        let low = if directed { f32::from(u8::from(*from_position)) } else { *low };
        put(24, low.to_le_bytes());
        put(28, high.to_le_bytes());
    }
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
    (bytes, places.words(lights).into_iter().flat_map(u32::to_le_bytes).collect())
}

/// The layout that shaders must match.
#[cfg(test)]
pub(crate) mod layout {
    use super::{HEADER_BYTES, SAMPLE_BYTES, SAMPLES_AT};

    /// Byte offsets of the fields of `Light` in `lights.wgsl`.
    pub(crate) const LIGHT: [(&str, usize); 6] = [
        ("position", 0),
        ("light_type", 12),
        ("direction", 16),
        ("intensity", 28),
        ("colour", 32),
        ("first_word", 44),
    ];
    /// Byte offsets of the fields of `Illumination` in `lights.wgsl`.
    pub(crate) const ILLUMINATION: [(&str, usize); 13] = [
        ("count", 0),
        ("terms", 4),
        ("exposure", 8),
        ("gamma_naive", 12),
        ("channel", 16),
        ("channel_light", 20),
        ("channel_low", 24),
        ("channel_high", 28),
        ("first_sample", SAMPLES_AT),
        ("sample_count", SAMPLES_AT + 4),
        ("look", SAMPLES_AT + 8),
        ("has_backdrop", SAMPLES_AT + SAMPLE_BYTES),
        ("lights", HEADER_BYTES),
    ];
}

#[cfg(test)]
mod tests {
    use naga::front::wgsl;

    use super::*;
    use crate::shader::{
        check::struct_layout,
        compose::{LIGHTS, OPTICS},
    };

    #[test]
    fn more_lights_than_fit_are_left_out() {
        let lights = vec![Lit { words: vec![7], ..Lit::default() }; MAX_LIGHTS + 5];
        let (bytes, words) =
            illumination_bytes(&lights, TermSelection::All, &Display::default(), None, LightSamples::DEFAULT);
        assert_eq!(bytes[..4], (MAX_LIGHTS as u32).to_le_bytes());
        assert_eq!(bytes.len(), HEADER_BYTES + MAX_LIGHTS * LIGHT_BYTES);
        assert_eq!(words.len(), 4 * MAX_LIGHTS);
    }

    #[test]
    fn the_lights_fit_the_smallest_uniform_buffer_that_there_is() {
        let limits = [wgpu::Limits::downlevel_webgl2_defaults(), wgpu::Limits::default()];
        let smallest = limits.into_iter().map(|l| l.max_uniform_buffer_binding_size).min();
        let (bytes, _) =
            illumination_bytes(&[], TermSelection::All, &Display::default(), None, LightSamples::DEFAULT);
        assert!(smallest.is_some_and(|most| bytes.len() as u64 <= most), "{} of {smallest:?}", bytes.len());
    }

    #[test]
    fn lights_lie_where_rust_puts_them() {
        let module = wgsl::parse_str(&format!("{}{}", OPTICS[0].text, LIGHTS.text)).expect("valid WGSL");
        let members = |module, name| struct_layout(module, name).map(|(members, _)| members);
        let owned = |layout: &[(&str, usize)]| {
            layout.iter().map(|(n, at)| ((*n).to_owned(), *at)).collect::<Vec<_>>()
        };
        assert_eq!(members(&module, "Light"), Some(owned(&layout::LIGHT)));
        assert_eq!(members(&module, "Illumination"), Some(owned(&layout::ILLUMINATION)));
        // The wrong twin: without the padding required by vec3, the layouts differ.
        let packed = wgsl::parse_str("struct Light { position: vec3<f32>, light_type: u32, intensity: f32, direction: vec3<f32>, colour: vec3<f32>, first_word: u32 }")
            .expect("valid WGSL");
        assert_ne!(members(&packed, "Light"), Some(owned(&layout::LIGHT)));
    }
}
