//! A view that shows the scene differently has a [`Stage`]: a render layer with a copy of every object, which
//! has the material of the view, and separate lights. Views without [`Overrides`] share the objects
//! themselves.

use bevy::{
    camera::visibility::RenderLayers,
    ecs::{entity::EntityHashMap, lifecycle::HookContext, world::DeferredWorld},
    prelude::*,
    render::storage::ShaderBuffer,
};

use super::{
    entities::SceneEntities,
    illumination::{IlluminationBuffer, LightBuffers},
    material::forget,
    overrides::Overrides,
    tables::ParameterTables,
};
use crate::scene::MAX_OBJECTS;

/// Render layer of objects as in the scene.
pub const SCENE_LAYER: usize = 0;
/// Render layer of gizmos, which every view shows.
pub const GIZMO_LAYER: usize = 1;

/// The layer, the lights and the copies of the objects in a view with overrides. Added and removed with its
/// [`Overrides`].
#[derive(Component, Debug)]
#[component(on_remove = strike)]
pub struct Stage {
    /// The render layer.
    pub(super) layer: usize,
    pub(super) illumination: LightBuffers,
    /// Copies by object.
    pub(super) copies: EntityHashMap<Entity>,
    /// The [list](SceneEntities::lists()) of the copied objects.
    list: Option<u64>,
}

/// A copy of an object, and its child, for one view.
#[derive(Clone, Component, Copy, Debug, PartialEq, Eq)]
pub struct ViewCopy {
    /// The view that shows it.
    pub view: Entity,
}

/// Adds stages to views with overrides, and removes them from views without.
pub(super) fn set_stages(
    new: Query<Entity, (With<Overrides>, Without<Stage>)>,
    done: Query<Entity, (With<Stage>, Without<Overrides>)>,
    stages: Query<&Stage>,
    shared: Res<IlluminationBuffer>,
    mut buffers: ResMut<Assets<ShaderBuffer>>,
    mut commands: Commands,
) {
    for view in &done {
        commands
            .entity(view)
            .remove::<Stage>()
            .insert(RenderLayers::from_layers(&[SCENE_LAYER, GIZMO_LAYER]));
    }
    let mut layers: Vec<_> = stages.iter().map(|stage| stage.layer).collect();
    for view in &new {
        let mut free = (GIZMO_LAYER + 1)..;
        let Some(layer) = free.find(|layer| !layers.contains(layer)) else { continue };
        layers.push(layer);
        let stage = Stage {
            layer,
            illumination: shared.another(&mut buffers),
            copies: EntityHashMap::default(),
            list: None,
        };
        commands.entity(view).insert((stage, RenderLayers::from_layers(&[layer, GIZMO_LAYER])));
    }
}

/// Removes everything that only this view needed.
fn strike(mut world: DeferredWorld, context: HookContext) {
    let view = context.entity;
    let Some(stage) = world.get::<Stage>(view) else { return };
    let illumination = stage.illumination.lights.id();
    let copies: Vec<_> = stage.copies.values().copied().collect();
    world.commands().queue(move |world: &mut World| {
        for copy in copies {
            // Copies of despawned objects were despawned with them.
            let _ = world.try_despawn(copy);
        }
        world.resource_mut::<ParameterTables>().forget(view);
        forget(world, illumination);
    });
}

/// Creates missing copies of the objects in a view.
pub(super) fn copies(world: &mut World, view: Entity) {
    let list = Some(world.resource::<SceneEntities>().lists);
    let Some(mut stage) = world.get_mut::<Stage>(view).filter(|stage| stage.list != list) else { return };
    let (layer, mut known) = (stage.layer, std::mem::take(&mut stage.bypass_change_detection().copies));
    world.resource_scope(|world, mut entities: Mut<SceneEntities>| {
        let entities = entities.bypass_change_detection();
        let objects = &entities.objects[..entities.objects.len().min(MAX_OBJECTS)];
        entities.visits += objects.len() as u64;
        if known.len() > objects.len() {
            known.retain(|_, copy| world.get_entity(*copy).is_ok());
        }
        for &object in objects {
            if known.contains_key(&object) || world.get_entity(object).is_err() {
                continue;
            }
            let parts = (
                ViewCopy { view },
                ChildOf(object),
                Transform::IDENTITY,
                Visibility::Inherited,
                RenderLayers::layer(layer),
            );
            known.insert(object, world.spawn(parts).id());
        }
    });
    if let Some(mut stage) = world.get_mut::<Stage>(view) {
        let stage = stage.bypass_change_detection();
        (stage.copies, stage.list) = (known, list);
    }
}
