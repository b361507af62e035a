//! Pictures drawn straight into their textures: without a tone curve, and with one sample per pixel, the display asks
//! for nothing that the material cannot do itself, and a picture is one pass. Otherwise Bevy draws it into half floats,
//! maps it in a second pass and copies it to the texture in a third.

use bevy::{
    app::{App, Plugin},
    camera::{ClearColor, ClearColorConfig, Hdr},
    core_pipeline::{
        Core3d,
        core_3d::{Opaque3d, Transparent3d},
        tonemapping::Tonemapping,
    },
    ecs::{
        prelude::*,
        schedule::{ScheduleBuildSettings, ScheduleLabel, SingleThreadedExecutor},
    },
    log::error_once,
    pbr::{
        clear_indirect_parameters_metadata, early_gpu_preprocess, main_build_indirect_parameters, unpack_bins,
    },
    render::{
        RenderApp,
        batching::gpu_preprocessing::GpuPreprocessingSupport,
        camera::{CameraRenderGraph, ExtractedCamera},
        render_phase::{ViewBinnedRenderPhases, ViewSortedRenderPhases},
        render_resource::{RenderPassDescriptor, StoreOp},
        renderer::{RenderContext, ViewQuery},
        view::{ExtractedView, Msaa, ViewDepthTexture, ViewTarget},
    },
};

use super::{
    camera::{ForDisplay, PictureCamera, follow_scene},
    schedule::{LabFrame, LabSystems},
};

/// The schedule of cameras that draw straight into their textures, in place of Bevy's [`Core3d`].
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub struct Straight;

/// Draws pictures [`ForDisplay`] in as few passes as they need.
pub(super) struct StraightPlugin;

impl Plugin for StraightPlugin {
    fn build(&self, app: &mut App) {
        app.add_systems(LabFrame, choose.in_set(LabSystems::Upload).after(follow_scene));
        if let Some(render) = app.get_sub_app_mut(RenderApp) {
            let mut schedule = Schedule::new(Straight);
            schedule.set_executor(SingleThreadedExecutor::new()).set_build_settings(ScheduleBuildSettings {
                auto_insert_apply_deferred: false,
                ..ScheduleBuildSettings::default()
            });
            schedule.add_systems(draw);
            render.add_schedule(schedule);
        }
    }

    fn finish(&self, app: &mut App) {
        let Some(render) = app.get_sub_app_mut(RenderApp) else { return };
        // Where the GPU prepares the instances, it does so first, as in `Core3d`.
        if render.world().get_resource::<GpuPreprocessingSupport>().is_some_and(|gpu| gpu.is_available()) {
            render.add_systems(
                Straight,
                (
                    clear_indirect_parameters_metadata,
                    unpack_bins,
                    early_gpu_preprocess,
                    main_build_indirect_parameters,
                )
                    .chain()
                    .before(draw),
            );
        }
    }
}

/// Chooses the way in which each picture is drawn.
fn choose(
    cameras: Query<
        (Entity, Option<&ForDisplay>, &Tonemapping, &Msaa, Has<Hdr>),
        (With<PictureCamera>, Or<(With<ForDisplay>, With<Hdr>)>),
    >,
    mut commands: Commands,
) {
    for (camera, known, tone, samples, hdr) in &cameras {
        let straight = *tone == Tonemapping::None && *samples == Msaa::Off;
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

/// Draws a picture: objects, and gizmos over them.
pub fn draw(
    world: &World,
    view: ViewQuery<(&ExtractedCamera, &ExtractedView, &ViewTarget, &ViewDepthTexture)>,
    opaque: Res<ViewBinnedRenderPhases<Opaque3d>>,
    transparent: Res<ViewSortedRenderPhases<Transparent3d>>,
    clear_colour: Res<ClearColor>,
    mut context: RenderContext,
) {
    let entity = view.entity();
    let (camera, view, target, depth) = view.into_inner();
    let background = match camera.clear_color {
        ClearColorConfig::Default => Some(clear_colour.0),
        ClearColorConfig::Custom(colour) => Some(colour),
        ClearColorConfig::None => None,
    };
    let Some(colour) = target.out_texture_color_attachment(background.map(Into::into)) else { return };
    let mut pass = context.begin_tracked_render_pass(RenderPassDescriptor {
        label: Some("picture"),
        color_attachments: &[Some(colour)],
        depth_stencil_attachment: Some(depth.get_attachment(StoreOp::Discard)),
        timestamp_writes: None,
        occlusion_query_set: None,
        multiview_mask: None,
    });
    if let Some(viewport) = &camera.viewport {
        pass.set_camera_viewport(viewport);
    }
    let drawn = opaque.get(&view.retained_view_entity).map(|phase| phase.render(&mut pass, world, entity));
    let over =
        transparent.get(&view.retained_view_entity).map(|phase| phase.render(&mut pass, world, entity));
    for problem in [drawn, over].into_iter().flatten().filter_map(Result::err) {
        error_once!("The picture could not be drawn: {problem:?}");
    }
}
