//! Counts clipped pixels: on the GPU, in the picture that is on screen, once it has come to rest.
//!
//! A compute pass reads the texture of the picture. After tone mapping, that holds what the display is asked for, also
//! beyond what it can show; a picture drawn [straight](Straight) into its texture marks such pixels. A few kilobytes come back, a frame or two later.

use bevy::{
    app::{App, Plugin, PostUpdate},
    asset::{Assets, Handle, RenderAssetUsages},
    core_pipeline::{Core3d, Core3dSystems, tonemapping::tonemapping},
    ecs::{prelude::*, schedule::ScheduleLabel as _},
    prelude::Shader,
    render::{
        RenderApp, RenderStartup,
        camera::ExtractedCamera,
        extract_component::ExtractComponentPlugin,
        extract_resource::{ExtractResource, ExtractResourcePlugin},
        gpu_readback::{Readback, ReadbackComplete},
        render_asset::RenderAssets,
        render_resource::{
            BindGroupEntries, BindGroupLayoutDescriptor, BindGroupLayoutEntries, CachedComputePipelineId,
            ComputePassDescriptor, ComputePipelineDescriptor, PipelineCache, TextureSampleType,
            binding_types::{storage_buffer_sized, texture_2d, uniform_buffer_sized},
        },
        renderer::{RenderContext, ViewQuery},
        storage::{GpuShaderBuffer, ShaderBuffer},
        view::ViewTarget,
    },
    window::RequestRedraw,
};
use wgpu::{BufferUsages, ShaderStages, util::BufferInitDescriptor};

use super::{
    WindowView,
    redraw::{SETTLING_FRAMES, Settling, redraw},
};
use crate::{
    optics::{colour::Encoding, tone::ToneMapping},
    panel::state::{Clipping, Session},
    render::{
        entities::CurrentScene,
        overrides::Overrides,
        straight::{self, Straight},
        view::{Drawing, ViewSystems},
    },
    scene::Display,
};

/// Frames in which an answer is waited for.
const PATIENCE: u32 = 30;
/// Invocations of a workgroup in each direction.
const GROUP: u32 = 8;

/// Counts clipped pixels, for the badge in the picture.
#[derive(Clone, Copy, Debug, Default)]
pub struct ClippingPlugin;

impl Plugin for ClippingPlugin {
    fn build(&self, app: &mut App) {
        let [across, down] = Clipping::GRID.map(|n| n as u32);
        let text = include_str!("clipping.wgsl")
            .replace("ACROSS", &format!("{across}u"))
            .replace("DOWN", &format!("{down}u"));
        let world = app.world_mut();
        let shader = world.resource_mut::<Assets<Shader>>().add(Shader::from_wgsl(text, "clipping.wgsl"));
        let bytes = 4 * (1 + across as usize * down as usize);
        let buffer = ShaderBuffer::with_size(bytes, RenderAssetUsages::default());
        let buffer = world.resource_mut::<Assets<ShaderBuffer>>().add(buffer);
        let question = Question { number: 0, open: false, limit: 1.0, shader, buffer };
        world.insert_resource(question.clone());
        world.init_resource::<Settling>();
        app.add_plugins((
            ExtractResourcePlugin::<Question>::default(),
            ExtractComponentPlugin::<WindowView>::default(),
        ))
        .add_systems(PostUpdate, ask.after(ViewSystems).after(redraw));
        if let Some(render) = app.get_sub_app_mut(RenderApp) {
            // The pass is prepared before anything is handed over.
            render
                .insert_resource(question)
                .add_systems(RenderStartup, prepare)
                .add_systems(Core3d, count.in_set(Core3dSystems::PostProcess).after(tonemapping))
                .add_systems(Straight, count.after(straight::draw));
        }
    }
}

/// While the picture moves, one in so many is asked about.
const MOVING: u64 = 10;

/// The question to the GPU.
#[derive(Clone, Resource)]
struct Question {
    /// Counts the questions.
    number: u32,
    /// There is no answer yet.
    open: bool,
    /// See [`limit`].
    limit: f32,
    shader: Handle<Shader>,
    buffer: Handle<ShaderBuffer>,
}

impl ExtractResource for Question {
    type Source = Self;

    fn extract_resource(source: &Self) -> Self {
        source.clone()
    }
}

/// Above this, a channel of the picture is cut off. What was cut off before the texture shows as exactly the
/// brightest there is: curves of tone mapping end there, and so does gamma-naive encoding.
fn limit(display: &Display) -> f32 {
    if display.tone_mapping == ToneMapping::None && display.encoding == Encoding::Srgb {
        // Exactly white is not cut off; half floats are that coarse.
        1.0005
    } else {
        0.999
    }
}

/// Asks about the last picture after a change, and keeps frames coming until the answer is there.
fn ask(
    scene: Res<CurrentScene>,
    views: Query<(&Drawing, Option<&Overrides>), With<WindowView>>,
    mut question: ResMut<Question>,
    mut patience: Local<u32>,
    mut readback: Local<Option<Entity>>,
    mut requests: MessageWriter<RequestRedraw>,
    mut commands: Commands,
) {
    // A picture that moves is never done.
    let moves = |drawing: &Drawing| !question.open && drawing.drawn().is_multiple_of(MOVING);
    let asks = |drawing: &Drawing| drawing.draws() && (drawing.is_done() || moves(drawing));
    if let Some((_, overrides)) = views.iter().find(|(drawing, _)| asks(drawing)) {
        *patience = PATIENCE;
        question.number = question.number.wrapping_add(1);
        question.open = true;
        question.limit = limit(&overrides.map_or(scene.0.display, |o| o.seen_through(&scene.0)));
        if readback.is_none() {
            let asked = Readback::buffer(question.buffer.clone());
            *readback = Some(commands.spawn(asked).observe(answered).id());
        }
    }
    if question.open && *patience > 0 {
        *patience -= 1;
        requests.write(RequestRedraw);
    } else if let Some(entity) = readback.take() {
        question.open = false;
        commands.entity(entity).despawn();
    }
}

fn answered(
    answer: On<ReadbackComplete>,
    mut question: ResMut<Question>,
    mut session: ResMut<Session>,
    mut settling: ResMut<Settling>,
) {
    let mut numbers = answer.data.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    if !question.open || numbers.next() != Some(question.number) {
        return;
    }
    question.open = false;
    let clipping = Clipping::new(numbers.collect());
    let known = &mut session.bypass_change_detection().facts.clipping;
    if *known != clipping {
        *known = clipping;
        settling.draw(SETTLING_FRAMES);
    }
}

/// The pass, ready to run.
#[derive(Resource)]
struct Pass {
    layout: BindGroupLayoutDescriptor,
    pipeline: CachedComputePipelineId,
}

fn prepare(question: Res<Question>, cache: Res<PipelineCache>, mut commands: Commands) {
    let layout = BindGroupLayoutDescriptor::new(
        "clipping",
        &BindGroupLayoutEntries::sequential(
            ShaderStages::COMPUTE,
            (
                texture_2d(TextureSampleType::Float { filterable: false }),
                uniform_buffer_sized(false, None),
                storage_buffer_sized(false, None),
            ),
        ),
    );
    let pipeline = cache.queue_compute_pipeline(ComputePipelineDescriptor {
        label: Some("clipping".into()),
        layout: vec![layout.clone()],
        shader: question.shader.clone(),
        entry_point: Some("count".into()),
        ..ComputePipelineDescriptor::default()
    });
    commands.insert_resource(Pass { layout, pipeline });
}

fn count(
    view: ViewQuery<(&ExtractedCamera, &ViewTarget), With<WindowView>>,
    question: Res<Question>,
    pass: Res<Pass>,
    cache: Res<PipelineCache>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
    mut context: RenderContext,
) {
    let (camera, target) = view.into_inner();
    let (Some(size), true) = (camera.physical_target_size, question.open) else { return };
    let (Some(pipeline), Some(answer)) =
        (cache.get_compute_pipeline(pass.pipeline), buffers.get(&question.buffer))
    else {
        return;
    };
    // A picture that was drawn straight into its texture says with its opacity what was cut off.
    let straight = camera.schedule == Straight.intern();
    let picture = target.out_texture().filter(|_| straight).unwrap_or(target.main_texture_view());
    let limit = if straight { -1.0 } else { question.limit };
    let words = [size.x, size.y, limit.to_bits(), question.number];
    let bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
    let device = context.render_device();
    let asked = device.create_buffer_with_data(&BufferInitDescriptor {
        label: Some("clipping"),
        contents: &bytes,
        usage: BufferUsages::UNIFORM,
    });
    let group = device.create_bind_group(
        "clipping",
        &cache.get_bind_group_layout(&pass.layout),
        &BindGroupEntries::sequential((
            picture,
            asked.as_entire_binding(),
            answer.buffer.as_entire_binding(),
        )),
    );
    let mut compute = context
        .command_encoder()
        .begin_compute_pass(&ComputePassDescriptor { label: Some("clipping"), timestamp_writes: None });
    compute.set_pipeline(pipeline);
    compute.set_bind_group(0, &group, &[]);
    let [across, down] = Clipping::GRID.map(|n| (n as u32).div_ceil(GROUP));
    compute.dispatch_workgroups(across, down, 1);
}
