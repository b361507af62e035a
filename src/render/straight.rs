//! Pictures drawn directly into their textures: without a tone curve, and with one sample per pixel, the
//! material can do everything that the display needs, and a picture takes one pass. Otherwise Bevy draws it
//! into half floats, maps it in a second pass and copies it to the texture in a third.

use bevy::{
    camera::Hdr,
    core_pipeline::{
        Core3d,
        core_3d::{Opaque3d, Transparent3d},
        tonemapping::Tonemapping,
    },
    ecs::{
        schedule::{ScheduleBuildSettings, ScheduleLabel, SingleThreadedExecutor},
        system::SystemParam,
    },
    pbr::{
        clear_indirect_parameters_metadata, early_gpu_preprocess, main_build_indirect_parameters, unpack_bins,
    },
    prelude::*,
    render::{
        RenderApp,
        batching::gpu_preprocessing::GpuPreprocessingSupport,
        camera::{CameraRenderGraph, ExtractedCamera},
        render_phase::{ViewBinnedRenderPhases, ViewSortedRenderPhases},
        render_resource::{RenderPassColorAttachment, RenderPassDescriptor, StoreOp},
        renderer::{RenderContext, ViewQuery},
        view::{ExtractedView, ViewDepthTexture, ViewTarget},
    },
};

use super::{
    camera::{ForDisplay, PictureCamera, follow_scene},
    drawn::ByChance,
    schedule::{LabFrame, LabSystems},
    shown::Shown,
    view::View,
};
use crate::registry::Registry;

/// The schedule of cameras that draw directly into their textures, instead of Bevy's [`Core3d`].
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub struct Straight;

/// The schedule of cameras that only add objects to the picture, and leave it as light: the display's passes
/// run later, for another camera.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub struct Layer;

/// Draws pictures [`ForDisplay`] in as few passes as necessary.
pub(super) struct StraightPlugin;

impl Plugin for StraightPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(LabFrame, choose.in_set(LabSystems::Upload).after(follow_scene));
        if let Some(render) = app.get_sub_app_mut(RenderApp) {
            for mut schedule in [Schedule::new(Straight), Schedule::new(Layer)] {
                let settings = ScheduleBuildSettings { auto_insert_apply_deferred: false, ..default() };
                schedule.set_executor(SingleThreadedExecutor::new()).set_build_settings(settings);
                render.add_schedule(schedule);
            }
            render.add_systems(Straight, draw).add_systems(Layer, draw_layer);
        }
    }

    fn finish(&self, app: &mut App) {
        let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
        // If the GPU prepares the instances, it does so first, as in `Core3d`.
        if render.world().get_resource::<GpuPreprocessingSupport>().is_some_and(|gpu| gpu.is_available()) {
            let prepare = || {
                (
                    clear_indirect_parameters_metadata,
                    unpack_bins,
                    early_gpu_preprocess,
                    main_build_indirect_parameters,
                )
                    .chain()
            };
            render.add_systems(Straight, prepare().before(draw));
            render.add_systems(Layer, prepare().before(draw_layer));
        }
    }
}

/// Chooses how each picture is drawn.
fn choose(
    cameras: Query<
        (Entity, Option<&ForDisplay>, &Tonemapping, &Msaa, Has<Hdr>, Has<View>),
        (With<PictureCamera>, Or<(With<ForDisplay>, With<Hdr>)>),
    >,
    shown: Res<Shown>,
    registry: Res<Registry>,
    by_chance: Query<(), With<ByChance>>,
    mut commands: Commands,
) {
    // With lights that are switched off: a switch would otherwise change the pipelines, too.
    let sampled = registry.has_extent(shown.types) || !by_chance.is_empty();
    for (camera, known, tone, samples, hdr, view) in &cameras {
        // Means are of half floats.
        let converges = view && sampled;
        let straight = *tone == Tonemapping::None && *samples == Msaa::Off && !converges;
        if known.is_some_and(|known| known.straight == straight) && hdr != straight {
            continue;
        }
        let mut camera = commands.entity(camera);
        camera.insert(ForDisplay { straight });
        if straight {
            camera.remove::<Hdr>().insert(CameraRenderGraph::new(Straight));
        } else {
            camera.insert((Hdr, CameraRenderGraph::new(Core3d)));
        }
    }
}

/// The components of a view used by a pass.
type Parts =
    (&'static ExtractedCamera, &'static ExtractedView, &'static ViewTarget, &'static ViewDepthTexture);

/// Draws a picture: objects, and gizmos over them.
pub fn draw(
    world: &World,
    view: ViewQuery<Parts>,
    phases: Phases,
    clear_colour: Res<ClearColor>,
    mut context: RenderContext,
) {
    let entity = view.entity();
    let (camera, view, target, depth) = view.into_inner();
    if let Some(colour) = target.out_texture_color_attachment(cleared(camera, &clear_colour)) {
        phases.draw(world, entity, (camera, view, depth), colour, &mut context);
    }
}

/// The colour with which a camera clears its picture; `None` if it draws over the existing one.
pub(super) fn cleared(camera: &ExtractedCamera, usual: &ClearColor) -> Option<LinearRgba> {
    match camera.clear_color {
        ClearColorConfig::Default => Some(usual.0.into()),
        ClearColorConfig::Custom(colour) => Some(colour.into()),
        ClearColorConfig::None => None,
    }
}

/// Draws objects into the light of a picture.
pub(super) fn draw_layer(world: &World, view: ViewQuery<Parts>, phases: Phases, mut context: RenderContext) {
    let entity = view.entity();
    let (camera, view, target, depth) = view.into_inner();
    phases.draw(world, entity, (camera, view, depth), target.get_color_attachment(), &mut context);
}

/// Everything that a picture shows.
#[derive(SystemParam)]
pub struct Phases<'w> {
    opaque: Res<'w, ViewBinnedRenderPhases<Opaque3d>>,
    transparent: Res<'w, ViewSortedRenderPhases<Transparent3d>>,
}

impl Phases<'_> {
    fn draw(
        &self,
        world: &World,
        entity: Entity,
        (camera, view, depth): (&ExtractedCamera, &ExtractedView, &ViewDepthTexture),
        colour: RenderPassColorAttachment,
        context: &mut RenderContext,
    ) {
        let mut pass = context.begin_tracked_render_pass(RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(colour)],
            // Stored, since another batch may be drawn over it.
            depth_stencil_attachment: Some(depth.get_attachment(StoreOp::Store)),
            timestamp_writes: None,
            occlusion_query_set: None,
            multiview_mask: None,
        });
        if let Some(viewport) = &camera.viewport {
            pass.set_camera_viewport(viewport);
        }
        let id = &view.retained_view_entity;
        let drawn = self.opaque.get(id).map(|phase| phase.render(&mut pass, world, entity));
        let over = self.transparent.get(id).map(|phase| phase.render(&mut pass, world, entity));
        for problem in [drawn, over].into_iter().flatten().filter_map(Result::err) {
            error_once!("The picture could not be drawn: {problem:?}");
        }
    }
}
