//! The plugins and the order of the systems.

use bevy::{
    app::{App, Plugin, Update},
    asset::Assets,
    ecs::prelude::*,
    render::storage::ShaderBuffer,
};

use crate::{
    light::buffer::{IlluminationBuffer, illumination_bytes, record},
    observer::camera::follow_scene,
    optics::TermSelection,
    reflection::swap::{self, ComposedShaders, ShapeMeshes},
    registry::{Registry, register_builtin},
    scene::spawn::{CurrentScene, SceneEntities, absorb, reconcile},
};

/// The order of everything that the lab does in a frame. Systems are ordered through these sets only.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LabSystems {
    /// Files are read; the scene is replaced.
    Load,
    /// The scene becomes entities.
    Spawn,
    /// Changes to entities go back into the scene.
    Edit,
    /// Objects get the meshes and materials of their models and modes.
    Swap,
    /// Lights and display settings go to the renderer.
    Upload,
    /// Pictures are taken.
    Capture,
}

/// Which terms of the equation are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Resource)]
pub struct ShownTerms(pub TermSelection);

/// A scene as entities, lit and shaded: everything but windows, panels and cameras. Needs Bevy's
/// renderer and PBR plugins.
#[derive(Clone, Copy, Debug, Default)]
pub struct ScenePlugin;

impl Plugin for ScenePlugin {
    fn build(&self, app: &mut App) {
        register_builtin(app);
        app.init_resource::<CurrentScene>()
            .init_resource::<SceneEntities>()
            .init_resource::<ComposedShaders>()
            .init_resource::<ShapeMeshes>()
            .init_resource::<ShownTerms>()
            .init_resource::<IlluminationBuffer>()
            .configure_sets(
                Update,
                (
                    LabSystems::Load,
                    LabSystems::Spawn,
                    LabSystems::Edit,
                    LabSystems::Swap,
                    LabSystems::Upload,
                    LabSystems::Capture,
                )
                    .chain(),
            )
            .add_systems(
                Update,
                (
                    reconcile.in_set(LabSystems::Spawn).run_if(resource_changed::<CurrentScene>),
                    absorb.in_set(LabSystems::Edit),
                    swap::swap.in_set(LabSystems::Swap),
                    (upload_lights, follow_scene).in_set(LabSystems::Upload),
                ),
            );
    }
}

/// Writes the lights and how they are shown into the shared buffer when any of it changed.
fn upload_lights(
    scene: Res<CurrentScene>,
    terms: Res<ShownTerms>,
    registry: Res<Registry>,
    buffer: Res<IlluminationBuffer>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
    mut last: Local<Vec<u8>>,
) {
    if !scene.is_changed() && !terms.is_changed() && !last.is_empty() {
        return;
    }
    let display = &scene.0.display;
    let records: Vec<_> = scene.0.lights.iter().map(|l| record(l, &registry, display.encoding)).collect();
    let bytes = illumination_bytes(&records, terms.0, display);
    if *last != bytes {
        if let Some(mut buffer) = buffers.get_mut(&buffer.0) {
            buffer.data = Some(bytes.clone());
        }
        *last = bytes;
    }
}

/// Opens the window.
pub fn view(_options: crate::cli::ViewOptions) -> Result<(), crate::cli::Failure> {
    Ok(())
}
