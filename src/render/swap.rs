//! Exchanging models, shading models, parameters and shapes at run time: the frame after the choice shows the
//! new one, and no frame is without the object.

use std::cell::LazyCell;

use bevy::{
    asset::Assets,
    ecs::prelude::*,
    mesh::{Mesh, Mesh3d, MeshTag},
    render::storage::ShaderBuffer,
};
use rayon::prelude::*;

use super::{
    entities::{CurrentScene, LitObject, SceneEntities},
    illumination::IlluminationBuffer,
    live::LiveShaders,
    material::{Attachments, MaterialInputs},
    meshes::{ShapeMeshes, forget_unused_meshes},
    overrides::{Overrides, Stage, stand_ins},
    tables::{ParameterTables, Row},
};
use crate::{
    optics::colour::Encoding,
    reflection::ModelEntry,
    registry::Registry,
    scene::{MAX_OBJECTS, Object, shines_from_everywhere},
    shading,
};

/// What an object is drawn with at present.
#[derive(Clone, Component, Debug, Default, PartialEq)]
pub struct Drawn {
    model: String,
    shading: String,
    encoding: Encoding,
    everywhere: bool,
    /// The version of the model: a file that is read again makes another.
    version: u64,
}

/// An object whose new shader is still being tried: it stays as it is for so long.
#[derive(Clone, Component, Copy, Debug, Default)]
pub struct AwaitsShader;

impl Drawn {
    /// Id of the reflection model.
    #[must_use]
    pub fn model(&self) -> &str {
        &self.model
    }

    /// Id of the shading model.
    #[must_use]
    pub fn shading(&self) -> &str {
        &self.shading
    }
}

/// An object that is drawn anew.
struct Pending {
    /// The view with overrides in which it is seen; none for all others.
    view: Option<Entity>,
    object: Entity,
    /// What is drawn: the object itself, or its stand-in in the view.
    drawable: Entity,
    /// The object as the view shows it.
    shown: Object,
    now: Drawn,
}

/// What changed since the last frame.
#[derive(Clone, Copy)]
struct Changed {
    /// Every row has to be written.
    all: bool,
    /// The scene or what is known of models.
    scene: bool,
}

/// Gives every object whose shape, model, shading model or parameters changed its mesh and its material. Exclusive, so that
/// mesh and material change in one step.
pub fn swap(world: &mut World) {
    let objects = world.resource::<SceneEntities>().objects.len().min(MAX_OBJECTS);
    let changed = Changed {
        all: world.resource_mut::<ParameterTables>().bypass_change_detection().hold(objects),
        scene: world.is_resource_changed::<CurrentScene>() || world.is_resource_changed::<Registry>(),
    };
    let mut pending = Vec::new();
    find(world, None, changed, &mut pending);
    let mut views = world.query_filtered::<Entity, (With<Stage>, With<Overrides>)>();
    let views: Vec<_> = views.iter(world).collect();
    for view in views {
        stand_ins(world, view);
        find(world, Some(view), changed, &mut pending);
    }
    if pending.is_empty() {
        return;
    }
    let registry = world.resource::<Registry>().clone();
    // Curves take about a millisecond each; equal parameters share one.
    let rows: Vec<_> = pending
        .par_iter()
        .map(|Pending { shown, now, .. }| {
            let model = registry.model(&now.model)?;
            Some(model.row(&shown.material, now.encoding, now.everywhere))
        })
        .collect();
    for (pending, bytes) in pending.into_iter().zip(rows) {
        if let Some(bytes) = bytes {
            draw(world, &registry, pending, &bytes);
        }
    }
    forget_unused_meshes(world, &registry);
    world.resource_scope(|world, mut tables: Mut<ParameterTables>| {
        tables.upload(&mut world.resource_mut::<Assets<ShaderBuffer>>());
    });
}

/// Finds what is drawn anew, in all views without overrides or in one with.
fn find(world: &mut World, view: Option<Entity>, changed: Changed, pending: &mut Vec<Pending>) {
    let mut objects = world.query::<Ref<LitObject>>();
    let mut drawables = world.query::<(Option<&Drawn>, Has<AwaitsShader>)>();
    let scene = &world.resource::<CurrentScene>().0;
    let registry = world.resource::<Registry>();
    let stage = view.and_then(|view| world.get::<Stage>(view));
    let overrides = view.and_then(|view| world.entity(view).get_ref::<Overrides>());
    let all = changed.all || overrides.as_ref().is_some_and(|o| o.is_changed());
    let overrides = overrides.as_deref();
    let encoding = overrides.map_or(scene.display, |o| o.display_of(scene)).encoding;
    // Asked only where something changed: most frames change nothing.
    let everywhere = LazyCell::new(|| shines_from_everywhere(scene, registry));
    // More objects than a table has rows are no legal scene; what is beyond is not drawn.
    for &entity in world.resource::<SceneEntities>().objects.iter().take(MAX_OBJECTS) {
        let drawable = stage.map_or(Some(entity), |stage| stage.stand_in(entity));
        let Some(Ok((drawn, waits))) = drawable.map(|d| drawables.get(world, d)) else { continue };
        let (Some(drawable), Ok(object)) = (drawable, objects.get(world, entity)) else { continue };
        let now = || {
            let (model, shading) = overrides.map_or_else(
                || (scene.model_of(&object.0), scene.shading_model_of(&object.0)),
                |o| (o.model_of(scene, &object.0), o.shading_model_of(scene, &object.0)),
            );
            Drawn {
                model: model.to_owned(),
                shading: shading.to_owned(),
                encoding,
                everywhere: *everywhere,
                version: registry.model(model).map_or(0, ModelEntry::version),
            }
        };
        if all || waits || object.is_changed() || drawn.is_none() || (changed.scene && drawn != Some(&now()))
        {
            let now = now();
            let mut shown = object.0.clone();
            if let Some(overrides) = overrides {
                overrides.dress(&mut shown);
            }
            pending.push(Pending { view, object: entity, drawable, shown, now });
        }
    }
}

/// Gives an object its mesh and its material.
fn draw(world: &mut World, registry: &Registry, pending: Pending, bytes: &[u8]) {
    let Pending { view, object, drawable, shown, now } = pending;
    // The checker refuses scenes with unknown ids; should one come from elsewhere, the object
    // keeps what it has.
    let (Some(model), Some(shading), Some(shape)) = (
        registry.model(&now.model),
        registry.shading_model(&now.shading),
        registry.shape(&shown.object_type),
    ) else {
        return;
    };
    let tessellation = shape.tessellation(shown.tessellation);
    let pair = world.resource_scope(|world, mut meshes: Mut<ShapeMeshes>| {
        meshes.get(shape, tessellation, &mut world.resource_mut::<Assets<Mesh>>())
    });
    let shader = world
        .resource_scope(|world, mut shaders: Mut<LiveShaders>| shaders.get(world, model, shading, registry));
    let Some(shader) = shader else {
        world.entity_mut(drawable).insert(AwaitsShader);
        return;
    };
    let Some(row) = row_of(world, object) else { return };
    let faces = shading.declaration.stage == shading::Stage::Polygon;
    let parameters = world.resource_scope(|world, mut tables: Mut<ParameterTables>| {
        tables.set(view, model, row, bytes, &mut world.resource_mut::<Assets<ShaderBuffer>>())
    });
    let illumination = view
        .and_then(|view| world.get::<Stage>(view))
        .map_or_else(|| world.resource::<IlluminationBuffer>().0.clone(), |stage| stage.illumination.clone());
    let ingredients = MaterialInputs { parameters, illumination, shader, faces };
    let attachments = world.resource::<Attachments>();
    let old = world
        .get::<Drawn>(drawable)
        .filter(|d| d.model != now.model)
        .and_then(|d| attachments.get(d.model.as_str()));
    let Some(new) = attachments.get(now.model.as_str()) else { return };
    let Ok(mut entity) = world.get_entity_mut(drawable) else { return };
    if let Some(old) = old {
        (old.detach)(&mut entity);
    }
    (new.attach)(&mut entity, ingredients);
    let mesh = if faces { pair.faces } else { pair.shared };
    if entity.get::<Mesh3d>().map(|m| &m.0) != Some(&mesh) {
        entity.insert(Mesh3d(mesh));
    }
    entity.insert((now, MeshTag(row.0))).remove::<AwaitsShader>();
}

/// The row of an object, a new one if it has none.
fn row_of(world: &mut World, object: Entity) -> Option<Row> {
    if let Some(row) = world.get::<Row>(object) {
        return Some(*row);
    }
    let row = world.resource_mut::<ParameterTables>().bypass_change_detection().take()?;
    world.entity_mut(object).insert(row);
    Some(row)
}
