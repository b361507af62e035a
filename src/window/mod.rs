//! The window: the picture in the middle, the panels around it, and the connection between the two.
//!
//! [`panel`](crate::panel) draws and decides; this module does what needs entities, a camera, files or the
//! operating system. Frames are drawn only when something changes.

use bevy::{
    app::{App, Last, Plugin, PostUpdate, PreUpdate, Startup},
    asset::AssetEventSystems,
    ecs::prelude::*,
    light::cluster::GlobalClusterSettings,
    render::extract_component::ExtractComponent,
};
use bevy_egui::{EguiGlobalSettings, EguiPostUpdateSet, EguiPreUpdateSet};
use bevy_panorbit_camera::PanOrbitCameraSystemSet;

use crate::{
    panel::state::Session,
    render::{
        absorb::absorb,
        schedule::{LabFrame, LabSystems},
        show::ShowPlugin,
        view::ViewSystems,
    },
};

pub mod authoring;
mod camera;
mod capture;
mod clipping;
mod document;
pub mod editor;
mod effects;
mod ending;
pub mod files;
mod frames;
mod gizmos;
mod input;
pub mod laws;
mod open;
mod options;
mod pick;
mod picture;
mod pointer;
mod recovery;
mod redraw;
mod shaders;
mod shell;
pub mod watching;

pub use open::view;
pub use options::ViewOptions;

/// The view that the window shows between its panels, and whose camera the pointer moves. Other views are their
/// owners' business.
#[derive(Component, ExtractComponent, Clone, Copy, Debug, Default)]
pub struct WindowView;

/// All systems of the window.
struct WindowSystemsPlugin;

impl Plugin for WindowSystemsPlugin {
    fn build(&self, app: &mut App) {
        let session_changed = resource_changed::<Session>;
        app.insert_resource(redraw::sleepy())
            .init_resource::<redraw::Settling>()
            .init_resource::<editor::Editors>()
            .init_resource::<laws::LawChecks>()
            .init_resource::<frames::FrameClock>()
            .add_plugins((
                gizmos::GizmosPlugin,
                camera::CameraPlugin,
                ShowPlugin,
                clipping::ClippingPlugin,
                pointer::PointerPlugin,
                watching::WatchingPlugin,
            ))
            .add_systems(Startup, (picture::spawn_cameras, frames::adapter_facts))
            .add_systems(
                PreUpdate,
                (
                    shell::close_requested,
                    recovery::interrupted,
                    input::mend_input
                        .after(EguiPreUpdateSet::ProcessInput)
                        .before(EguiPreUpdateSet::BeginPass),
                ),
            )
            .add_systems(
                LabFrame,
                (
                    (
                        watching::collect,
                        shaders::follow,
                        shaders::follow_parameters,
                        watching::watch_document.run_if(session_changed),
                        watching::follow_document,
                        effects::carry_out,
                        recovery::stayed,
                        recovery::offer,
                        pick::pick,
                        document::publish.run_if(session_changed),
                    )
                        .chain()
                        .in_set(LabSystems::Load),
                    document::take_over.in_set(LabSystems::Edit).after(absorb),
                    shaders::tell.in_set(LabSystems::Upload),
                ),
            )
            .configure_sets(
                PostUpdate,
                (
                    ViewSystems.after(PanOrbitCameraSystemSet),
                    // New letters are uploaded for the frame that shows them, not for the next.
                    EguiPostUpdateSet::PostProcessOutput.before(AssetEventSystems),
                ),
            )
            .add_systems(
                PostUpdate,
                (
                    picture::fit_picture.after(EguiPostUpdateSet::EndPass).before(ViewSystems),
                    picture::show_picture.after(ViewSystems),
                    (shell::window_title, shell::fullscreen).run_if(session_changed),
                    // The last changes by the panels are known by now, and are to be drawn.
                    redraw::redraw
                        .after(EguiPostUpdateSet::ProcessOutput)
                        .before(EguiPostUpdateSet::PostProcessOutput),
                ),
            )
            .add_systems(Last, (frames::measure, recovery::keep, input::rescale_pointer));
    }

    fn finish(&self, app: &mut App) {
        // egui gets a camera of its own, above the picture.
        if let Some(mut settings) = app.world_mut().get_resource_mut::<EguiGlobalSettings>() {
            settings.auto_create_primary_context = false;
        }
        if let Some(mut clusters) = app.world_mut().get_resource_mut::<GlobalClusterSettings>() {
            // Bevy's own lights are not used, so neither is their clustering.
            clusters.gpu_clustering = None;
        }
    }
}

#[cfg(test)]
mod tests {
    use bevy::{
        app::TaskPoolPlugin,
        asset::{AssetApp, AssetPlugin},
        ecs::schedule::NodeId,
        render::storage::ShaderBuffer,
        shader::Shader,
    };

    use super::*;

    #[test]
    fn new_letters_are_uploaded_for_the_frame_that_shows_them() {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default()))
            .init_asset::<Shader>()
            .init_asset::<ShaderBuffer>();
        app.add_plugins(WindowSystemsPlugin);
        let graph = app.get_schedule(PostUpdate).expect("filled").graph();
        let node = |set| NodeId::Set(graph.system_sets.get_key(set).expect("configured"));
        let (letters, upload) = (EguiPostUpdateSet::PostProcessOutput.intern(), AssetEventSystems.intern());
        assert!(graph.dependency().contains_edge(node(letters), node(upload)));
        assert!(!graph.dependency().contains_edge(node(upload), node(letters)));
    }
}
