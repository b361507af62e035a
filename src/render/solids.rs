//! The hierarchies of closed meshes on the GPU, for rays inside solid bodies.

use std::collections::HashMap;

use bevy::{asset::RenderAssetUsages, prelude::*, render::storage::ShaderBuffer};

use super::material::is_held_elsewhere;
use crate::{
    scene::Object,
    shape::{Hierarchy, MeshKey, ShapeEntry, closed},
};

/// Maximum size of all hierarchies, in bytes: those of a million triangles. A mesh beyond that is drawn as if it were open.
const BUDGET: usize = 128 << 20;
/// The row that stands for the hierarchy of a mesh that is not closed.
const NONE: [u8; 16] = [0; 16];

/// The hierarchies by mesh.
#[derive(Default, Resource)]
pub(super) struct Solids {
    /// Each with its size in bytes.
    known: HashMap<MeshKey, (Handle<ShaderBuffer>, usize)>,
    /// The size of all, in bytes.
    bytes: usize,
}

impl Solids {
    /// The hierarchy of an object's mesh; a zero row if the mesh is not closed.
    pub(super) fn get(
        &mut self,
        shape: &ShapeEntry,
        object: &Object,
        buffers: &mut Assets<ShaderBuffer>,
    ) -> Handle<ShaderBuffer> {
        let key = shape.key(&object.shape, object.tessellation);
        if let Some((known, _)) = self.known.get(&key) {
            return known.clone();
        }
        let mesh = shape.mesh(&object.shape, shape.tessellation(object.tessellation));
        let hierarchy = Hierarchy::new(&mesh);
        let closed = closed::check(&mesh, &hierarchy).is_ok();
        let rows = || hierarchy.rows().iter().flatten().flat_map(|word| word.to_le_bytes());
        let mut bytes: Vec<u8> = if closed { rows().collect() } else { NONE.to_vec() };
        if bytes.len() > BUDGET {
            bytes = NONE.to_vec();
        }
        if self.bytes + bytes.len() > BUDGET {
            // Those in use are held by their materials, too, and would only be calculated again.
            let size = &mut self.bytes;
            self.known.retain(|_, (buffer, bytes)| {
                let stays = is_held_elsewhere(buffer);
                *size -= if stays { 0 } else { *bytes };
                stays
            });
        }
        let size = bytes.len();
        self.bytes += size;
        let buffer = buffers.add(ShaderBuffer::new(&bytes, RenderAssetUsages::RENDER_WORLD));
        self.known.insert(key, (buffer.clone(), size));
        buffer
    }
}
