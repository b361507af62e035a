//! The window: the picture in the middle, the panels around it, and the connection between the two.
//!
//! [`panel`](crate::panel) draws and decides; this module does everything that needs entities, a camera, files or the
//! operating system. Frames are drawn only when something changes.

use bevy::{
    ecs::{prelude::*, system::SystemParam},
    render::extract_component::ExtractComponent,
};

use crate::{
    panel::state::{Action, Effect, Session},
    registry::Registry,
};

pub mod authoring;
mod background;
mod camera;
mod capture;
mod clipping;
mod difference;
mod document;
pub mod editor;
mod effects;
mod ending;
mod exports;
pub mod files;
mod finite;
mod frames;
mod gizmos;
mod input;
pub mod laws;
mod lessons;
pub mod manual;
mod matching;
mod offscreen;
mod open;
mod options;
mod order;
mod pick;
mod picture;
mod pictures;
mod place;
mod plots;
mod plugins;
mod pointer;
mod readback;
mod recovery;
mod redraw;
mod requirements;
mod shaders;
mod sheets;
mod shell;
mod solids;
mod touch;
mod views;
pub mod watching;

pub use camera::CameraPlugin;
pub use capture::CapturePlugin;
pub use clipping::ClippingPlugin;
pub use difference::DifferencePlugin;
pub use document::DocumentPlugin;
pub use gizmos::GizmosPlugin;
pub use open::view;
pub use options::ViewOptions;
pub use pick::PickingPlugin;
pub use picture::PicturePlugin;
pub use pictures::PicturesPlugin;
pub use plugins::LabPlugins;
pub use recovery::RecoveryPlugin;
pub use requirements::RequirementsPlugin;
pub use shaders::ShaderFilesPlugin;
pub use shell::ShellPlugin;
pub use watching::WatchingPlugin;

/// The view that the window shows between its panels, and whose camera the pointer moves. Other views are controlled by
/// their owners.
#[derive(Component, ExtractComponent, Clone, Copy, Debug, Default)]
pub struct WindowView;

/// Applies actions of the user, whose effects are messages.
#[derive(SystemParam)]
struct Acting<'w> {
    session: ResMut<'w, Session>,
    registry: Res<'w, Registry>,
    effects: MessageWriter<'w, Effect>,
}

impl Acting<'_> {
    fn apply(&mut self, action: Action) {
        self.effects.write_batch(self.session.apply(action, &self.registry));
    }
}

#[cfg(test)]
mod tests {
    use bevy::{
        app::{App, PostUpdate, TaskPoolPlugin},
        asset::{AssetApp, AssetEventSystems, AssetPlugin},
        ecs::schedule::NodeId,
        render::storage::ShaderBuffer,
        shader::Shader,
    };

    use bevy_egui::EguiPostUpdateSet;

    use super::*;

    #[test]
    fn new_letters_are_uploaded_for_the_frame_that_shows_them() {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default()))
            .init_asset::<Shader>()
            .init_asset::<ShaderBuffer>();
        app.add_plugins((PicturePlugin::default(), ShellPlugin::default()));
        let graph = app.get_schedule(PostUpdate).expect("filled").graph();
        let node = |set| NodeId::Set(graph.system_sets.get_key(set).expect("configured"));
        let (letters, upload) = (EguiPostUpdateSet::PostProcessOutput.intern(), AssetEventSystems.intern());
        assert!(graph.dependency().contains_edge(node(letters), node(upload)));
        assert!(!graph.dependency().contains_edge(node(upload), node(letters)));
    }
}
