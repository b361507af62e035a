//! The scene as a plugin.

use bevy::{app::MainScheduleOrder, ecs::schedule::LogLevel, prelude::*, render::storage::ShaderBuffer};

use super::{
    absorb::absorb,
    backdrop,
    camera::{aim, follow_scene},
    converge::Convergence,
    entities::{CurrentScene, SceneEntities},
    file_buffers,
    illumination::{IlluminationBuffer, Lit, ShownTerms, illumination_bytes},
    live::{self, exchange},
    material, mean,
    meshes::ShapeMeshes,
    noise,
    overrides::Overrides,
    parts,
    reconcile::reconcile,
    schedule::{LabFrame, LabSystems, detect},
    seen,
    shown::{Shown, show_lights},
    solids::Solids,
    stage::{Stage, set_stages},
    straight::StraightPlugin,
    swap::swap,
    tables, tone,
    typed::know_types,
    view::{self, ViewSystems},
};
use crate::{
    document::PartId,
    registry::{Registry, register_builtin},
};

/// A scene as entities, lit and shaded: everything except windows, panels and cameras. Needs Bevy's renderer
/// and PBR plugins.
#[derive(Clone, Copy, Debug, Default)]
pub struct ScenePlugin;

impl Plugin for ScenePlugin {
    fn build(&self, app: &mut App) {
        use LabSystems::{Capture, Edit, Load, Spawn, Swap, Upload};
        let spawn = (
            know_types.run_if(resource_changed::<Registry>),
            reconcile.run_if(resource_changed::<CurrentScene>),
            set_stages,
        );
        register_builtin(app);
        app.world_mut().resource_mut::<MainScheduleOrder>().insert_after(Update, LabFrame);
        app.init_resource::<CurrentScene>()
            .init_resource::<SceneEntities>()
            .init_resource::<Shown>()
            .register_type::<PartId>()
            .register_type::<parts::SceneLight>()
            .register_type::<parts::SceneObject>()
            .register_type::<parts::Surface>()
            .register_type::<parts::Tessellation>()
            .register_type::<parts::SceneObserver>()
            .register_type::<parts::Animated>()
            .init_resource::<ShapeMeshes>()
            .init_resource::<Solids>()
            .init_resource::<ShownTerms>()
            .init_resource::<IlluminationBuffer>()
            .init_schedule(LabFrame)
            .configure_sets(LabFrame, (Load, Spawn, Edit, Swap, Upload, Capture).chain())
            .add_systems(LabFrame, spawn.chain().in_set(Spawn))
            .add_systems(LabFrame, absorb.in_set(Edit))
            .add_systems(LabFrame, (show_lights.before(exchange), swap.after(exchange)).in_set(Swap))
            .add_systems(LabFrame, (upload_lights, follow_scene).in_set(Upload))
            .add_systems(PostUpdate, aim.in_set(ViewSystems).before(view::fit))
            .add_plugins((live::plugin, view::plugin, tables::plugin, file_buffers::plugin, StraightPlugin))
            .add_plugins((
                material::plugin,
                seen::plugin,
                mean::plugin,
                noise::plugin,
                backdrop::plugin,
                tone::plugin,
            ));
        // Systems that access the same data must have a defined order.
        detect(app, LogLevel::Warn);
    }
}

/// Writes lights and display settings into the buffers of the views when any of these changed.
fn upload_lights(
    scene: Res<CurrentScene>,
    shown: Res<Shown>,
    terms: Res<ShownTerms>,
    registry: Res<Registry>,
    shared: Res<IlluminationBuffer>,
    convergence: Res<Convergence>,
    stages: Query<(Ref<Stage>, Ref<Overrides>)>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
) {
    let changed = scene.is_changed() || shown.is_changed() || terms.is_changed();
    let none = Overrides::default();
    let changed_stages = stages
        .iter()
        .filter(|(stage, overrides)| changed || stage.is_added() || overrides.is_changed())
        .map(|(stage, overrides)| (&stage.into_inner().illumination, overrides.into_inner()));
    for (known, overrides) in changed.then_some((&shared.buffers, &none)).into_iter().chain(changed_stages) {
        let display = overrides.display_of(&scene.0);
        let channel = overrides.channel.as_ref();
        let shines = |i: usize| channel.is_none_or(|channel| channel.shines(i));
        let lights = shown.shining().enumerate().filter(|(i, _)| shines(*i));
        let lights: Vec<_> = lights.map(|(_, l)| Lit::new(l, &registry, display.encoding)).collect();
        let terms = overrides.terms.unwrap_or(terms.0);
        let (illumination, words) = illumination_bytes(&lights, terms, &display, channel, convergence.target);
        for (handle, mut bytes) in [(&known.lights, illumination), (&known.words, words)] {
            let Some(old) = buffers.get(handle).and_then(|known| known.data.as_ref()) else { continue };
            // Materials would not notice a buffer of another size.
            bytes.resize(old.len(), 0);
            if *old != bytes
                && let Some(mut buffer) = buffers.get_mut(handle)
            {
                buffer.data = Some(bytes);
            }
        }
    }
}
