//! The numbers of files that materials name, on the GPU. They are copied there in pieces: a scene with many files needs the
//! memory of one piece beside them.

use std::{collections::HashMap, sync::Arc};

use bevy::{
    asset::RenderAssetUsages,
    prelude::*,
    render::{
        MainWorld, Render, RenderApp, RenderSystems,
        render_asset::RenderAssets,
        render_resource::PollType,
        renderer::{RenderDevice, RenderQueue},
        storage::{GpuShaderBuffer, ShaderBuffer},
    },
};

use super::material::is_held_elsewhere;
use crate::parameter::Table;

/// The largest buffer that graphics cards guarantee, in bytes. A larger file counts as one without numbers.
const LARGEST: usize = 128 << 20;
/// The numbers of a piece.
const PIECE: usize = 1 << 20;

/// The buffers by the versions of files.
#[derive(Default, Resource)]
pub(super) struct FileBuffers {
    known: HashMap<u64, Handle<ShaderBuffer>>,
    /// Those to be filled in this frame.
    uploads: Vec<Upload>,
}

/// A buffer and its numbers.
type Upload = (Handle<ShaderBuffer>, Arc<[f32]>);

/// Fills the buffers of files.
pub(super) fn plugin(app: &mut App) {
    app.init_resource::<FileBuffers>();
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render
        .init_resource::<Uploads>()
        .add_systems(ExtractSchedule, extract)
        .add_systems(Render, write.in_set(RenderSystems::PrepareResources));
}

/// The uploads in the render world.
#[derive(Default, Resource)]
struct Uploads(Vec<Upload>);

fn extract(mut main: ResMut<MainWorld>, mut uploads: ResMut<Uploads>) {
    if let Some(mut files) = main.get_resource_mut::<FileBuffers>() {
        uploads.0.append(&mut files.bypass_change_detection().uploads);
    }
}

fn write(
    mut uploads: ResMut<Uploads>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
    device: Res<RenderDevice>,
    queue: Res<RenderQueue>,
) {
    uploads.0.retain(|(handle, numbers)| {
        let Some(gpu) = buffers.get(handle) else { return true };
        for (i, piece) in numbers.chunks(PIECE).enumerate() {
            let bytes: Vec<u8> = piece.iter().flat_map(|number| number.to_le_bytes()).collect();
            queue.write_buffer(&gpu.buffer, (i * PIECE * size_of::<f32>()) as u64, &bytes);
            // Until the device has them, the queue keeps the bytes of all pieces.
            queue.submit([]);
            let _ = device.poll(PollType::wait_indefinitely());
        }
        false
    });
}

impl FileBuffers {
    /// The numbers of a file, one buffer for all materials that name it.
    pub(super) fn get(&mut self, table: &Table, buffers: &mut Assets<ShaderBuffer>) -> Handle<ShaderBuffer> {
        let version = table.file.as_ref().map_or(0, |file| file.version());
        if let Some(known) = self.known.get(&version) {
            return known.clone();
        }
        // Those in use are held by their materials, too.
        self.known.retain(|_, buffer| is_held_elsewhere(buffer));
        let size = size_of_val(&*table.numbers);
        let holds = (1..=LARGEST).contains(&size);
        let size = if holds { size } else { 64 };
        let buffer = buffers.add(ShaderBuffer::with_size(size, RenderAssetUsages::RENDER_WORLD));
        if holds {
            self.uploads.push((buffer.clone(), table.numbers.clone()));
        }
        self.known.insert(version, buffer.clone());
        buffer
    }
}
