//! Counts clipped pixels on the GPU, in the picture of each view on screen, once it is idle.
//!
//! A compute pass reads the texture of the picture. After tone mapping, it contains the values sent to the display,
//! even beyond the displayable range; a picture drawn [straight](Straight) into its texture marks such pixels. A few
//! kilobytes come back, a frame or two later. Lights with extent in sight, which are meant to be brighter than surfaces, do
//! not count; they too are marked by the opacity.

use std::collections::HashMap;

use bevy::{
    asset::RenderAssetUsages,
    core_pipeline::{Core3d, Core3dSystems, tonemapping::tonemapping},
    ecs::schedule::ScheduleLabel as _,
    prelude::*,
    render::{
        RenderApp, RenderStartup,
        camera::ExtractedCamera,
        extract_component::{ExtractComponent, ExtractComponentPlugin},
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
    views::{OtherView, first},
};
use crate::{
    document::Revision,
    optics::{colour::Encoding, tone::ToneMapping},
    panel::state::{Clipping, PictureArea, Session},
    render::{
        backdrop::BackdropSystems,
        entities::CurrentScene,
        overrides::Overrides,
        straight::{self, Straight},
        view::{Drawing, ViewSystems},
    },
    scene::{Display, variant::MAX_VARIANTS},
};

/// Number of frames to wait for a result.
const PATIENCE: u32 = 30;
/// Size of a workgroup in each direction.
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
        world.init_resource::<Settling>();
        app.add_plugins(ExtractComponentPlugin::<Question>::default())
            .add_systems(PostUpdate, ask.after(ViewSystems).after(redraw));
        if let Some(render) = app.get_sub_app_mut(RenderApp) {
            render
                .insert_resource(Counter(shader))
                .add_systems(RenderStartup, prepare)
                // A background that the scene gives is no light, and may be white.
                .add_systems(
                    Core3d,
                    count.in_set(Core3dSystems::PostProcess).after(tonemapping).before(BackdropSystems),
                )
                .add_systems(Straight, count.after(straight::draw));
        }
    }
}

/// Interval of counts while the picture changes, in pictures.
const MOVING: u64 = 10;

/// The shader that counts.
#[derive(Resource)]
struct Counter(Handle<Shader>);

/// A request to the GPU about the picture of a view.
#[derive(Clone, Component, ExtractComponent)]
struct Question {
    /// The view: 0 is the scene itself, 1 view B.
    view: usize,
    /// Unique number of the request.
    number: u32,
    /// True while the result is pending.
    open: bool,
    /// Remaining number of frames to wait for the result.
    patience: u32,
    /// See [`limit`].
    limit: f32,
    buffer: Handle<ShaderBuffer>,
}

impl Question {
    fn about(view: usize, buffers: &mut Assets<ShaderBuffer>) -> Self {
        let bytes = 4 * (1 + Clipping::GRID[0] * Clipping::GRID[1]);
        let buffer = buffers.add(ShaderBuffer::with_size(bytes, RenderAssetUsages::default()));
        Self { view, number: 0, open: false, patience: 0, limit: 1.0, buffer }
    }
}

/// Value above which a channel of the picture is clipped. Values that were clipped before they reached the texture
/// equal the maximum, where tone mapping curves and gamma-naive encoding end.
fn limit(display: &Display) -> f32 {
    if display.tone_mapping == ToneMapping::None && display.encoding == Encoding::Srgb {
        // Pure white is not clipped; the margin is the precision of half floats.
        1.0005
    } else {
        0.999
    }
}

/// Filter for the views shown by the window.
type Seen = Or<(With<WindowView>, With<OtherView>)>;

/// Requests a count for the latest picture of each view after a change, and keeps frames coming until the results
/// arrive.
fn ask(
    scene: Res<CurrentScene>,
    area: Option<Res<PictureArea>>,
    mut views: Query<(Entity, &Drawing, Option<&Overrides>, Option<&OtherView>, Option<&mut Question>), Seen>,
    mut session: ResMut<Session>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
    mut of: Local<Option<Revision>>,
    mut last: Local<u32>,
    mut readbacks: Local<HashMap<Entity, Entity>>,
    mut requests: MessageWriter<RequestRedraw>,
    mut commands: Commands,
) {
    let own = area.as_deref().map_or(0, first);
    // The pictures of another document are drawn anew; an answer about the old ones would stay.
    let origin = session.document.origin();
    let is_other = scene.is_changed() && of.replace(origin).is_some_and(|of| of != origin);
    let known = &mut session.bypass_change_detection().facts.clipping;
    let mut waits = HashMap::new();
    let mut shown = [false; MAX_VARIANTS + 1];
    for (entity, drawing, overrides, other, question) in &mut views {
        let view = other.map_or(own, |other| other.0);
        if let Some(shown) = shown.get_mut(view) {
            *shown = true;
        }
        let Some(mut question) = question else {
            commands.entity(entity).insert(Question::about(view, &mut buffers));
            continue;
        };
        question.open &= !is_other;
        if question.view != view {
            // Another view with the same content is not redrawn.
            let same = known.get_mut(question.view).and_then(Option::take);
            question.view = view;
            if let Some(known) = known.get_mut(view) {
                *known = same;
            }
        }
        // A changing picture is never finished.
        let moves = !question.open && drawing.drawn().is_multiple_of(MOVING);
        if drawing.draws() && (drawing.is_done() || moves) {
            *last = last.wrapping_add(1);
            (question.number, question.open, question.patience) = (*last, true, PATIENCE);
            question.limit = limit(&overrides.map_or(scene.0.display, |o| o.seen_through(&scene.0)));
        }
        if question.open && question.patience > 0 {
            question.patience -= 1;
            requests.write(RequestRedraw);
            let readback = readbacks.remove(&entity).unwrap_or_else(|| {
                commands.spawn(Readback::buffer(question.buffer.clone())).observe(answered).id()
            });
            waits.insert(entity, readback);
        } else if question.open {
            question.open = false;
        }
    }
    for (known, _) in known.iter_mut().zip(shown).filter(|(_, shown)| is_other || !shown) {
        *known = None;
    }
    // The remaining requests are obsolete.
    for (_, readback) in std::mem::replace(&mut *readbacks, waits) {
        commands.entity(readback).despawn();
    }
}

fn answered(
    answer: On<ReadbackComplete>,
    mut questions: Query<&mut Question>,
    mut session: ResMut<Session>,
    mut settling: ResMut<Settling>,
) {
    let mut numbers = answer.data.chunks_exact(4).map(|b| u32::from_le_bytes([b[0], b[1], b[2], b[3]]));
    let Some(number) = numbers.next() else { return };
    let Some(mut question) = questions.iter_mut().find(|q| q.open && q.number == number) else { return };
    question.open = false;
    let clipping = Clipping::new(numbers.collect());
    let Some(known) = session.bypass_change_detection().facts.clipping.get_mut(question.view) else { return };
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

fn prepare(counter: Res<Counter>, cache: Res<PipelineCache>, mut commands: Commands) {
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
        shader: counter.0.clone(),
        entry_point: Some("count".into()),
        ..ComputePipelineDescriptor::default()
    });
    commands.insert_resource(Pass { layout, pipeline });
}

fn count(
    view: ViewQuery<(&ExtractedCamera, &ViewTarget, &Question)>,
    pass: Res<Pass>,
    cache: Res<PipelineCache>,
    buffers: Res<RenderAssets<GpuShaderBuffer>>,
    mut context: RenderContext,
) {
    let (camera, target, question) = view.into_inner();
    let (Some(size), true) = (camera.physical_target_size, question.open) else { return };
    let (Some(pipeline), Some(answer)) =
        (cache.get_compute_pipeline(pass.pipeline), buffers.get(&question.buffer))
    else {
        return;
    };
    // A picture drawn straight into its texture marks clipped pixels by its opacity.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::Document;

    #[test]
    fn nothing_is_known_of_the_pictures_of_another_document() {
        let mut app = App::new();
        app.add_plugins((MinimalPlugins, AssetPlugin::default()))
            .init_asset::<ShaderBuffer>()
            .add_message::<RequestRedraw>()
            .init_resource::<CurrentScene>()
            .init_resource::<Session>()
            .add_systems(Update, ask);
        let view = app.world_mut().spawn((WindowView, Drawing::default())).id();
        app.update();
        for is_other in [false, true] {
            let world = app.world_mut();
            let mut session = world.resource_mut::<Session>();
            session.facts.clipping[0] = Clipping::new(vec![1; Clipping::GRID[0] * Clipping::GRID[1]]);
            if is_other {
                session.document = Document::new(session.document.scene().clone());
            } else {
                session.document.amend(|scene| scene.shading_model = "flat".to_owned());
            }
            let mut question = world.get_mut::<Question>(view).expect("inserted");
            (question.open, question.patience) = (true, PATIENCE);
            world.resource_mut::<CurrentScene>().set_changed();
            app.update();
            let world = app.world();
            assert_eq!(world.resource::<Session>().facts.clipping[0].is_none(), is_other);
            // An answer about the old picture comes too late.
            assert_eq!(world.get::<Question>(view).is_some_and(|question| question.open), !is_other);
        }
    }
}
