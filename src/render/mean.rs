//! Converging pictures: each frame has a few samples of light with extent, and the picture is the mean of the
//! frames. A pass between those of the objects and of the display adds a frame to the mean.
//!
//! While a view's picture converges, it has two pairs of textures of 32-bit floats, one to read and one to
//! write: 2 × 24 bytes for each pixel. A finished view has none. Cameras without a [`View`] draw all samples
//! in each frame, and should not share the frames of converging views.

use std::collections::{HashMap, HashSet};

use bevy::{
    core_pipeline::{Core3d, Core3dSystems, tonemapping::tonemapping},
    prelude::*,
    render::{
        Extract, Render, RenderApp, RenderSystems,
        render_asset::RenderAssets,
        render_resource::{
            binding_types::{storage_buffer_read_only_sized, texture_2d},
            *,
        },
        renderer::{RenderContext, RenderDevice, RenderQueue, ViewQuery},
        storage::{GpuShaderBuffer, ShaderBuffer},
        sync_world::RenderEntity,
        view::ViewTarget,
    },
};

use super::{
    converge::{Convergence, Part},
    illumination::{IlluminationBuffer, SAMPLES_AT, sample_bytes},
    noise::{AddedFrame, Blocks, Grown, Measuring, Noise},
    pass::Cover,
    stage::Stage,
    view::{Drawing, View},
};
use crate::shader::wgsl;

/// Texture format of means.
const MEAN: TextureFormat = TextureFormat::Rgba32Float;
/// Texture format of the sums of squares about the mean luminance, and of that before the last block of samples.
const SQUARES: TextureFormat = TextureFormat::Rg32Float;
/// Texture format of frames.
const FRAME: TextureFormat = TextureFormat::Rgba16Float;

/// Adds frames to means.
pub(super) fn plugin(app: &mut App) {
    let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
    render
        .init_resource::<Samples>()
        .add_systems(ExtractSchedule, extract)
        .add_systems(Render, (write, prepare).in_set(RenderSystems::PrepareResources))
        .add_systems(Core3d, join.in_set(MeanSystems).after(Core3dSystems::MainPass).before(tonemapping));
}

/// The pass that adds frames to means.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct MeanSystems;

/// The contribution of a view's frame to its mean.
#[derive(Component, Clone, Copy, Debug)]
struct Joins {
    frame: AddedFrame,
    illumination: AssetId<ShaderBuffer>,
}

/// The mean of the frames of a view.
#[derive(Component)]
struct Mean {
    size: Extent3d,
    blocks: Blocks,
    /// Textures to read, and to write: the mean, and the squares about it.
    textures: [[TextureView; 2]; 2],
}

impl Mean {
    fn new(size: Extent3d, blocks: Blocks, device: &RenderDevice) -> Self {
        let texture = |format| {
            let texture = device.create_texture(&TextureDescriptor {
                label: Some("mean"),
                size,
                mip_level_count: 1,
                sample_count: 1,
                dimension: TextureDimension::D2,
                format,
                usage: TextureUsages::TEXTURE_BINDING | TextureUsages::RENDER_ATTACHMENT,
                view_formats: &[],
            });
            texture.create_view(&TextureViewDescriptor::default())
        };
        Self { size, blocks, textures: [(); 2].map(|()| [MEAN, SQUARES].map(texture)) }
    }
}

/// The samples of this frame, for light buffers; `None` for all.
#[derive(Default, Resource)]
struct Samples {
    /// Number of samples of a picture.
    all: u32,
    wanted: HashMap<AssetId<ShaderBuffer>, Part>,
    /// Buffers that do not have all samples.
    written: HashSet<AssetId<ShaderBuffer>>,
}

type Views<'w, 's> =
    Query<'w, 's, (Entity, RenderEntity, &'static Drawing, Option<&'static Stage>), With<View>>;

fn extract(
    views: Extract<Views>,
    shared: Extract<Res<IlluminationBuffer>>,
    known: Query<Entity, With<Joins>>,
    mut samples: ResMut<Samples>,
    noise: Res<Noise>,
    convergence: Extract<Res<Convergence>>,
    mut commands: Commands,
) {
    samples.all = convergence.target;
    noise.keep(|view| views.contains(view));
    let mut joining = HashSet::new();
    for (view, entity, drawing, stage) in &views {
        let Some(part) = drawing.part else { continue };
        joining.insert(entity);
        let illumination = stage.map_or(&shared.buffers, |stage| &stage.illumination).lights.id();
        samples.wanted.insert(illumination, part);
        let (number, converged) = (drawing.drawn(), drawing.converged());
        let frame = AddedFrame { view, number, converged, part };
        commands.entity(entity).insert(Joins { frame, illumination });
    }
    // Views that have converged, and cameras that are views no more.
    for entity in known.iter().filter(|entity| !joining.contains(entity)) {
        commands.entity(entity).remove::<(Joins, Mean)>();
    }
}

/// Writes the samples of this frame into the light buffers, and all samples into those whose pictures have
/// converged.
fn write(mut samples: ResMut<Samples>, buffers: Res<RenderAssets<GpuShaderBuffer>>, queue: Res<RenderQueue>) {
    let Samples { all, wanted, written } = &mut *samples;
    written.retain(|buffer| {
        let done = !wanted.contains_key(buffer);
        if done && let Some(gpu) = buffers.get(*buffer) {
            queue.write_buffer(&gpu.buffer, SAMPLES_AT as u64, &sample_bytes(Err(*all)));
        }
        !done
    });
    for (buffer, part) in wanted.drain() {
        if let Some(gpu) = buffers.get(buffer) {
            queue.write_buffer(&gpu.buffer, SAMPLES_AT as u64, &sample_bytes(Ok(part)));
            written.insert(buffer);
        }
    }
}

/// Gives views textures for their means. The textures written in the previous frame are read in this one.
fn prepare(
    mut views: Query<(Entity, &ViewTarget, &Joins, Option<&mut Mean>)>,
    device: Res<RenderDevice>,
    mut commands: Commands,
) {
    for (view, target, joins, mean) in &mut views {
        let size = target.main_texture().size();
        match mean {
            Some(mut mean) if mean.size == size => {
                mean.textures.reverse();
                mean.blocks.add(&joins.frame);
            }
            _ => {
                let mut blocks = Blocks::default();
                blocks.add(&joins.frame);
                commands.entity(view).insert(Mean::new(size, blocks, &device));
            }
        }
    }
}

/// The pass that adds a frame to a mean.
fn adding(device: &RenderDevice) -> Cover {
    let float = texture_2d(TextureSampleType::Float { filterable: false });
    let buffer = storage_buffer_read_only_sized(false, None);
    let entries = (float, float, float, buffer, buffer);
    let entries = BindGroupLayoutEntries::sequential(ShaderStages::FRAGMENT, entries);
    let text = format!("{}{}", wgsl!("terms.wgsl").text, include_str!("mean.wgsl"));
    Cover::new(device, "mean", (text.into(), "fragment"), &entries, (&[FRAME, MEAN, SQUARES], 1))
}

/// Adds the frame of a view to its mean, and replaces the frame by the mean.
fn join(
    view: ViewQuery<(&ViewTarget, &Joins, &Mean)>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
    device: Res<RenderDevice>,
    mut measuring: ResMut<Measuring>,
    mut pass: Local<Option<Cover>>,
    mut context: RenderContext,
) {
    let (target, joins, Mean { blocks, textures: [known, next], .. }) = view.into_inner();
    let Some(illumination) = buffers.get(joins.illumination) else { return };
    if target.main_texture_format() != FRAME {
        error_once!(
            "The frames of a picture have the format {:?} instead of {FRAME:?}",
            target.main_texture_format()
        );
        return;
    }
    let Cover { bindings, pipeline } = pass.get_or_insert_with(|| adding(&device));
    let weights = device.create_buffer_with_data(&BufferInitDescriptor {
        label: Some("mean"),
        contents: &blocks.weights(&joins.frame).map(f32::to_le_bytes).concat(),
        usage: BufferUsages::STORAGE,
    });
    let frame = target.post_process_write();
    let group = device.create_bind_group(
        "mean",
        bindings,
        &BindGroupEntries::sequential((
            frame.source,
            &known[0],
            &known[1],
            illumination.buffer.as_entire_buffer_binding(),
            weights.as_entire_buffer_binding(),
        )),
    );
    let attachment = |view| {
        Some(RenderPassColorAttachment {
            view,
            depth_slice: None,
            resolve_target: None,
            ops: Operations { load: LoadOp::Clear(Default::default()), store: StoreOp::Store },
        })
    };
    let mut pass = context.command_encoder().begin_render_pass(&RenderPassDescriptor {
        label: Some("mean"),
        color_attachments: &[attachment(frame.destination), attachment(&next[0]), attachment(&next[1])],
        depth_stencil_attachment: None,
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    pass.set_pipeline(pipeline);
    pass.set_bind_group(0, &*group, &[]);
    pass.draw(0..3, 0..1);
    drop(pass);
    let grown = Grown { frame: joins.frame, blocks: *blocks };
    measuring.measure(grown, next.each_ref(), &device, context.command_encoder());
}
