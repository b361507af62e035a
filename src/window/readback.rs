//! Reading back textures from the GPU.

use std::sync::{Arc, OnceLock};

use bevy::{
    asset::Handle,
    ecs::prelude::*,
    image::Image,
    render::gpu_readback::{Readback, ReadbackComplete},
};
use glam::UVec2;

/// Textures being read back: the entities that read them, and the results.
#[derive(Debug)]
pub(super) struct Reading(Vec<(Entity, Arc<OnceLock<Vec<u8>>>)>);

impl Reading {
    /// Starts to read back textures.
    pub(super) fn begin(textures: &[Handle<Image>], commands: &mut Commands) -> Self {
        let read = textures.iter().map(|texture| {
            let bytes = Arc::<OnceLock<Vec<u8>>>::default();
            let heard = bytes.clone();
            let hear = move |answer: On<ReadbackComplete>| _ = heard.get_or_init(|| answer.data.clone());
            (commands.spawn(Readback::texture(texture.clone())).observe(hear).id(), bytes)
        });
        Self(read.collect())
    }

    /// The bytes of the textures, once all are complete, which ends the reading: see [`codes`].
    pub(super) fn end(reading: &mut Option<Self>, commands: &mut Commands) -> Option<Vec<Vec<u8>>> {
        let all = |reading: &mut Self| reading.0.iter().all(|(_, bytes)| bytes.get().is_some());
        let done = reading.take_if(all)?;
        let bytes = done.0.iter().filter_map(|(_, bytes)| bytes.get().cloned()).collect();
        done.abandon(commands);
        Some(bytes)
    }

    /// Stops reading.
    pub(super) fn abandon(self, commands: &mut Commands) {
        self.0.into_iter().for_each(|(entity, _)| commands.entity(entity).despawn());
    }
}

/// Display codes of a texture that was read back, whose rows start at multiples of 256 bytes.
pub(super) fn codes(bytes: &[u8], size: UVec2) -> Option<Vec<u8>> {
    let row = 4 * size.x as usize;
    let stride = if size.y > 1 { row.next_multiple_of(256) } else { row };
    let mut out = Vec::with_capacity(3 * size.x as usize * size.y as usize);
    for y in 0..size.y as usize {
        let row = bytes.get(y * stride..y * stride + row)?;
        out.extend(row.as_chunks::<4>().0.iter().flat_map(|[r, g, b, _]| [*r, *g, *b]));
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_textures_are_read_without_what_fills_them_up() {
        let size = UVec2::new(3, 2);
        let mut bytes = vec![0; 256 + 12];
        bytes[..12].copy_from_slice(&[1, 2, 3, 255, 4, 5, 6, 255, 7, 8, 9, 255]);
        bytes[256..].copy_from_slice(&[10, 11, 12, 255, 13, 14, 15, 255, 16, 17, 18, 255]);
        assert_eq!(codes(&bytes, size), Some((1..=18).collect()));
        assert_eq!(codes(&bytes[..260], size), None);
    }
}
