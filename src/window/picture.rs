//! The picture between the panels: camera, size and position.

use bevy::{
    asset::AssetEventSystems,
    camera::{CameraMainTextureUsages, Hdr, RenderTarget, visibility::RenderLayers},
    core_pipeline::tonemapping::Tonemapping,
    light::cluster::GlobalClusterSettings,
    prelude::*,
    render::{render_resource::TextureUsages, renderer::RenderAdapterInfo},
    window::PrimaryWindow,
};
use bevy_egui::{EguiGlobalSettings, EguiPostUpdateSet, EguiPrimaryContextPass, PrimaryEguiContext};
use bevy_panorbit_camera::{ActiveCameraData, PanOrbitCameraSystemSet};

use super::{
    WindowView, camera,
    place::{PicturePlace, area_of},
    views::{set_views, show_views, tell_convergence},
};
use crate::{
    panel::{
        state::{PictureArea, Session},
        theme::Palette,
    },
    render::{
        camera::{PictureCamera, picture_camera},
        schedule::run_on_one_thread,
        show::{ShowPlugin, Shows},
        view::{Drawing, View, ViewSystems},
    },
};

/// The view of the scene: fitted into the window between the panels, or alone in a texture.
#[derive(Clone, Copy, Debug, Default)]
pub struct PicturePlugin {
    /// Size of the picture in pixels if there is no window.
    pub alone: Option<UVec2>,
}

impl Plugin for PicturePlugin {
    fn build(&self, app: &mut App) {
        let alone = self.alone;
        let spawn = move |commands: Commands, adapter: Option<Res<RenderAdapterInfo>>| {
            spawn_cameras(commands, adapter, alone);
        };
        // The camera of egui runs this schedule even if nothing shows panels.
        app.init_schedule(EguiPrimaryContextPass)
            .add_plugins(ShowPlugin)
            .add_systems(Startup, spawn)
            .configure_sets(
                PostUpdate,
                (
                    ViewSystems.after(PanOrbitCameraSystemSet),
                    // New glyphs are uploaded in time for the frame that shows them, not for the next.
                    EguiPostUpdateSet::PostProcessOutput.before(AssetEventSystems),
                ),
            )
            .add_systems(
                PostUpdate,
                (fit_picture.after(EguiPostUpdateSet::EndPass), set_views.after(PanOrbitCameraSystemSet))
                    .chain()
                    .before(ViewSystems)
                    .before(TransformSystems::Propagate),
            )
            .add_systems(PostUpdate, (show_views, tell_convergence).after(ViewSystems));
    }

    fn finish(&self, app: &mut App) {
        // egui gets a separate camera above the picture.
        if let Some(mut settings) = app.world_mut().get_resource_mut::<EguiGlobalSettings>() {
            settings.auto_create_primary_context = false;
        }
        if let Some(mut clusters) = app.world_mut().get_resource_mut::<GlobalClusterSettings>() {
            // Bevy's own lights are unused, and so is their clustering.
            clusters.gpu_clustering = None;
        }
        run_on_one_thread(app);
    }
}

fn spawn_cameras(mut commands: Commands, adapter: Option<Res<RenderAdapterInfo>>, alone: Option<UVec2>) {
    let software = adapter.is_some_and(|a| a.device_type == wgpu::DeviceType::Cpu);
    // With a software renderer, four samples would double the cost of a frame.
    let samples = if software { 1 } else { 4 };
    commands
        .spawn((picture_camera(samples), Hdr, RenderTarget::None { size: UVec2::ONE }, camera::orbit()))
        .insert((
            PictureCamera { follows_observer: true, fits_width: true },
            WindowView,
            // In a window, the panels determine the size.
            View::for_display(alone.unwrap_or(UVec2::ZERO)),
        ));
    if alone.is_some() {
        return;
    }
    commands.spawn((
        Camera2d,
        Camera { order: 1, ..Camera::default() },
        Shows::default(),
        CameraMainTextureUsages::default().with(TextureUsages::COPY_DST),
        Msaa::Off,
        Tonemapping::None,
        RenderLayers::none(),
        PrimaryEguiContext,
    ));
}

/// Fits the picture into the space between the panels.
fn fit_picture(
    session: Res<Session>,
    area: Option<Res<PictureArea>>,
    window: Single<&Window, With<PrimaryWindow>>,
    mut views: Query<(Entity, &mut View, &mut Drawing, &mut Camera), With<WindowView>>,
    mut controls: Option<ResMut<ActiveCameraData>>,
    mut room: Local<Option<bool>>,
) {
    let Ok((entity, mut view, mut drawing, mut camera)) = views.single_mut() else { return };
    let area = area_of(area.as_deref(), &window);
    let place = PicturePlace::of(&area, &window);
    if place.size.min_element() == 0 {
        return;
    }
    let frame = PicturePlace::of_rect(area.frame, area.zoom, &window);
    let at = frame.at.saturating_sub(place.at);
    let inset = (area.cells.is_empty() && frame != place).then(|| URect::from_corners(at, at + frame.size));
    view.set_if_neq(View { inset, ..View::for_display(place.size) });
    // The light theme has a light surround.
    let grey = Palette::of(&session.settings).surround;
    let surround = Color::srgb_u8(grey.r(), grey.g(), grey.b());
    if !matches!(camera.clear_color, ClearColorConfig::Custom(known) if known == surround) {
        camera.clear_color = ClearColorConfig::Custom(surround);
    }
    if room.replace(session.view.show_room) != Some(session.view.show_room) {
        drawing.redraw();
    }
    if let Some(controls) = &mut controls {
        controls.set_if_neq(ActiveCameraData {
            entity: Some(entity),
            viewport_size: Some(place.size.as_vec2() / window.scale_factor()),
            window_size: Some(window.size()),
            manual: true,
        });
    }
}
