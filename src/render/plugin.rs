//! The plugins and the order of the systems.

use bevy::{
    app::{App, MainScheduleOrder, Plugin, Update},
    asset::Assets,
    ecs::{
        prelude::*,
        schedule::{LogLevel, ScheduleBuildSettings, ScheduleLabel},
    },
    render::storage::ShaderBuffer,
};

use super::{
    camera::follow_scene,
    entities::{CurrentScene, SceneEntities, absorb, reconcile},
    illumination::{IlluminationBuffer, illumination_bytes},
    live::LiveShadersPlugin,
    material::MaterialApp as _,
    meshes::ShapeMeshes,
    overrides::{Overrides, Stage, set_stages},
    swap::swap,
    tables::TablesPlugin,
    view::ViewPlugin,
};
use crate::{
    optics::TermSelection,
    registry::{Registry, register_builtin},
    scene::record,
};

/// The schedule of everything that the lab does in a frame; runs after Bevy's `Update`. A schedule of
/// its own, so that two of our systems whose order is left open are an error at start, whatever
/// Bevy's own systems do.
#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
pub struct LabFrame;

/// The order of everything that the lab does in a frame. Systems are ordered through these sets only.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LabSystems {
    /// Files are read; the scene is replaced.
    Load,
    /// The scene becomes entities.
    Spawn,
    /// Changes to entities go back into the scene.
    Edit,
    /// Objects get the meshes and materials of their models and shading models.
    Swap,
    /// Lights and display settings go to the renderer.
    Upload,
    /// Pictures are taken.
    Capture,
}

/// The terms of the equation that are shown.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Resource)]
pub struct ShownTerms(pub TermSelection);

/// A scene as entities, lit and shaded: everything but windows, panels and cameras. Needs Bevy's
/// renderer and PBR plugins.
#[derive(Clone, Copy, Debug, Default)]
pub struct ScenePlugin;

impl Plugin for ScenePlugin {
    fn build(&self, app: &mut App) {
        register_builtin(app);
        app.add_custom_material();
        app.world_mut().resource_mut::<MainScheduleOrder>().insert_after(Update, LabFrame);
        app.init_resource::<CurrentScene>()
            .init_resource::<SceneEntities>()
            .init_resource::<ShapeMeshes>()
            .init_resource::<ShownTerms>()
            .init_resource::<IlluminationBuffer>()
            // Two of our systems that touch the same data must say who comes first.
            .init_schedule(LabFrame)
            .edit_schedule(LabFrame, |schedule| {
                schedule.set_build_settings(ScheduleBuildSettings {
                    ambiguity_detection: LogLevel::Error,
                    ..ScheduleBuildSettings::default()
                });
            })
            .configure_sets(
                LabFrame,
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
                LabFrame,
                (
                    reconcile.in_set(LabSystems::Spawn).run_if(resource_changed::<CurrentScene>),
                    set_stages.in_set(LabSystems::Spawn),
                    absorb.in_set(LabSystems::Edit),
                    swap.in_set(LabSystems::Swap),
                    (upload_lights, follow_scene).in_set(LabSystems::Upload),
                ),
            )
            .add_plugins((LiveShadersPlugin, ViewPlugin, TablesPlugin));
    }
}

/// Writes lights and display settings into the buffers of the views when any of them changed.
fn upload_lights(
    scene: Res<CurrentScene>,
    terms: Res<ShownTerms>,
    registry: Res<Registry>,
    shared: Res<IlluminationBuffer>,
    stages: Query<(Ref<Stage>, Ref<Overrides>)>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
) {
    let changed = scene.is_changed() || terms.is_changed();
    let none = Overrides::default();
    let changed_stages = stages
        .iter()
        .filter(|(stage, overrides)| changed || stage.is_added() || overrides.is_changed())
        .map(|(stage, overrides)| (&stage.into_inner().illumination, overrides.into_inner()));
    for (handle, overrides) in changed.then_some((&shared.0, &none)).into_iter().chain(changed_stages) {
        let display = overrides.display_of(&scene.0);
        let records: Vec<_> = scene.0.shining().map(|l| record(l, &registry, display.encoding)).collect();
        let bytes = illumination_bytes(&records, overrides.terms.unwrap_or(terms.0), &display);
        if buffers.get(handle).is_some_and(|known| known.data.as_ref() != Some(&bytes))
            && let Some(mut buffer) = buffers.get_mut(handle)
        {
            buffer.data = Some(bytes);
        }
    }
}
