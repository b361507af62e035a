//! The numbers of files that materials name, on the GPU.

use std::collections::HashMap;

use bevy::{asset::RenderAssetUsages, prelude::*, render::storage::ShaderBuffer};

use super::material::is_held_elsewhere;
use crate::parameter::Table;

/// The largest buffer that graphics cards guarantee, in bytes. A larger file counts as one without numbers.
const LARGEST: usize = 128 << 20;

/// The buffers by the versions of files.
#[derive(Default, Resource)]
pub(super) struct FileBuffers(HashMap<u64, Handle<ShaderBuffer>>);

impl FileBuffers {
    /// The numbers of a file, one buffer for all materials that name it.
    pub(super) fn get(&mut self, table: &Table, buffers: &mut Assets<ShaderBuffer>) -> Handle<ShaderBuffer> {
        let version = table.file.as_ref().map_or(0, |file| file.version());
        if let Some(known) = self.0.get(&version) {
            return known.clone();
        }
        // Those in use are held by their materials, too.
        self.0.retain(|_, buffer| is_held_elsewhere(buffer));
        let mut bytes: Vec<u8> = table.numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        if bytes.is_empty() || bytes.len() > LARGEST {
            bytes = vec![0; 64];
        }
        let buffer = buffers.add(ShaderBuffer::new(&bytes, RenderAssetUsages::RENDER_WORLD));
        self.0.insert(version, buffer.clone());
        buffer
    }
}
