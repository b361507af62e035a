//! Exchanges models, shading models, parameters and shapes at run time: the frame after the choice shows the
//! new one, and no frame lacks the object. In a window, a frame that says that a shader is compiled comes before the
//! one that waits for it.

use std::iter;

use bevy::{mesh::MeshTag, prelude::*, render::storage::ShaderBuffer};
use rayon::prelude::*;

use super::{
    camera::PictureCamera,
    drawn::{ByChance, Drawn},
    entities::{CurrentScene, SceneEntities},
    file_buffers::FileBuffers,
    hidden::Shade,
    illumination::{IlluminationBuffer, Lit, word_count},
    live::{LiveShaders, Parts},
    material::{MaterialInputs, Vertices, attach, forget},
    meshes::{Need, ShapeMeshes, forget_unused_meshes, take_off},
    nearest::{self, Eye},
    overrides::Overrides,
    shown::{Shown, ShownObject},
    solids::Solids,
    stage::{Stage, ViewCopy, copies},
    tables::{ParameterTables, Row, row},
};
use crate::{
    light::MAX_LIGHTS,
    optics::colour::Encoding,
    parameter::{Value, file_changes},
    reflection::{ModelEntry, Passage},
    registry::Registry,
    scene::{MAX_OBJECTS, Object, Scene, shines_from_everywhere},
    shading,
    shape::MeshKey,
};

/// The number of objects behind which others may be hidden.
const SHADES: usize = 8;

/// An object whose new shader is still being tried, or about to be made: until then it stays unchanged.
#[derive(Clone, Component, Copy, Debug, Default)]
pub struct AwaitsShader;

/// An object to be drawn with other settings.
struct Pending {
    /// The view with overrides that shows it; `None` for all others.
    view: Option<Entity>,
    object: Entity,
    /// The object itself, or its copy in the view.
    drawable: Entity,
    /// The object as the view shows it.
    shown: Object,
    now: Drawn,
}

impl Pending {
    /// The identity and the form of its mesh.
    fn mesh(&self, registry: &Registry) -> Option<(MeshKey, Vertices)> {
        let Self { shown, now, .. } = self;
        let shape = registry.shape(&shown.object_type)?;
        Some((shape.key(&shown.shape, shown.tessellation), vertices(&now.shading, registry)))
    }
}

/// Drawables that have never been drawn, or that wait for their shader.
type Unfinished = (Or<(With<ShownObject>, With<ViewCopy>)>, Or<(Without<Drawn>, With<AwaitsShader>)>);

/// The objects visited in a frame.
enum Suspects {
    /// All: a table or a view was replaced.
    All,
    /// All, but only those whose drawing differs are updated.
    Different,
    /// Those that changed, by entity.
    Some(Vec<Entity>),
}

/// Updates the mesh and the material of every object whose shape, model, shading model or parameters changed.
/// Exclusive, so that mesh and material change in one step.
pub fn swap(
    world: &mut World,
    mut last: Local<Option<Drawn>>,
    mut files: Local<u64>,
    changed: &mut QueryState<Entity, Changed<ShownObject>>,
    unfinished: &mut QueryState<(Entity, Option<(&'static ViewCopy, &'static ChildOf)>), Unfinished>,
    views: &mut QueryState<Entity, (With<Stage>, With<Overrides>)>,
) {
    let changes = file_changes();
    if std::mem::replace(&mut *files, changes) != changes {
        touch_those_from_files(world);
    }
    let objects = world.resource::<SceneEntities>().objects.len().min(MAX_OBJECTS);
    let mut all = world.resource_mut::<ParameterTables>().bypass_change_detection().hold(objects);
    let views: Vec<_> = views.iter(world).collect();
    let models_changed = world.is_resource_changed::<Registry>();
    let mut different = models_changed;
    let scene_changed = world.is_resource_changed::<CurrentScene>() || world.is_resource_changed::<Shown>();
    if models_changed || scene_changed || last.is_none() {
        let (scene, shown) = (&world.resource::<CurrentScene>().0, world.resource::<Shown>());
        let now = common(scene, shown, world.resource::<Registry>());
        different |= last.as_ref() != Some(&now);
        *last = Some(now);
        all |= hold_lights(world, &views);
    }
    for object in world.resource_mut::<ShapeMeshes>().try_again(scene_changed) {
        if let Some(mut object) = world.get_mut::<ShownObject>(object) {
            object.set_changed();
        }
    }
    let Some(common) = &*last else { return };
    let changed: Vec<_> = changed.iter(world).collect();
    let mut pending = Vec::new();
    for view in iter::once(None).chain(views.into_iter().map(Some)) {
        let anew = view.is_some_and(|view| {
            copies(world, view);
            world.entity(view).get_ref::<Overrides>().is_some_and(|o| o.is_changed())
        });
        let suspects = if all || anew {
            Suspects::All
        } else if different {
            Suspects::Different
        } else {
            let waiting = unfinished.iter(world).filter_map(|(entity, stands)| match stands {
                Some((stands, object)) => (Some(stands.view) == view).then(|| object.parent()),
                None => view.is_none().then_some(entity),
            });
            Suspects::Some(changed.iter().copied().chain(waiting).collect())
        };
        find(world, view, common, suspects, &mut pending);
    }
    if pending.is_empty() {
        return;
    }
    let registry = world.resource::<Registry>().clone();
    // Curves take about a millisecond each; equal parameters share one.
    let rows: Vec<_> = pending
        .par_iter()
        .map(|Pending { shown, now, .. }| {
            let (model, shading) = (registry.model(&now.model)?, registry.shading_model(&now.shading)?);
            let extent = registry.has_extent(now.lights);
            Some(row((model, now.passage), shading, &shown.material, now.encoding, now.everywhere, extent))
        })
        .collect();
    let eyes = nearest::eyes(world);
    world.resource_scope(|world, mut meshes: Mut<ShapeMeshes>| {
        world.resource_scope(|world, mut assets: Mut<Assets<Mesh>>| {
            let objects = pending.iter().map(|p| (&p.shown, vertices(&p.now.shading, &registry)));
            let need = |i: usize| {
                let Pending { object, shown, .. } = &pending[i];
                nearest::need(&eyes, world, &registry, *object, shown)
            };
            meshes.make(objects, need, &registry, &mut assets);
        });
    });
    let mut pending: Vec<_> =
        pending.into_iter().zip(rows).map(|(pending, bytes)| (Need::default(), pending, bytes)).collect();
    let keys = pending.iter().filter_map(|(_, pending, _)| pending.mesh(&registry));
    if world.resource::<ShapeMeshes>().are_too_many(keys) {
        let eyes = nearest::all_eyes(world);
        for (need, Pending { object, shown, .. }, _) in &mut pending {
            *need = nearest::need(&eyes, world, &registry, *object, shown);
        }
        pending.sort_by(|(a, ..), (b, ..)| a.order(b));
        if world.resource::<ShapeMeshes>().are_in_batches() {
            pending = without_hidden(world, &registry, &eyes, pending);
        }
    }
    let shows_objects = shows_objects(world);
    for (_, pending, bytes) in pending {
        if let Some(bytes) = bytes {
            let is_seen = shows_objects || pending.view.is_some();
            draw(world, &registry, pending, &bytes, is_seen);
        }
    }
    // An object that waits for its shader will use a mesh that is not drawn yet.
    let mut waiting = world.query_filtered::<(), With<AwaitsShader>>();
    if waiting.iter(world).next().is_none() {
        forget_unused_meshes(world);
    }
    world.resource_scope(|world, mut tables: Mut<ParameterTables>| {
        tables.bypass_change_detection().upload(world.resource::<Assets<ShaderBuffer>>());
    });
}

/// Updates objects that use a file whose numbers have changed, although they are equal in the scene.
fn touch_those_from_files(world: &mut World) {
    let mut objects = world.query::<&mut ShownObject>();
    for mut object in objects.iter_mut(world) {
        let mut values = object.0.shape.0.values().chain(object.0.material.0.values());
        if values.any(|value| matches!(value, Value::File(_))) {
            object.set_changed();
        }
    }
}

/// Ensures capacity for the parameters of all lights. True if the buffers were replaced.
fn hold_lights(world: &mut World, views: &[Entity]) -> bool {
    let registry = world.resource::<Registry>();
    let shining = world.resource::<Shown>().shining().take(MAX_LIGHTS);
    let lights: Vec<_> = shining.map(|light| Lit::new(light, registry, Encoding::default())).collect();
    let words = word_count(&lights);
    world.resource_scope(|world, mut shared: Mut<IlluminationBuffer>| {
        let shared = shared.bypass_change_detection();
        let mut old = vec![shared.buffers.lights.id()];
        if !shared.hold(words, &mut world.resource_mut::<Assets<ShaderBuffer>>()) {
            return false;
        }
        for view in views {
            let another = shared.another(&mut world.resource_mut::<Assets<ShaderBuffer>>());
            if let Some(mut stage) = world.get_mut::<Stage>(*view) {
                old.push(std::mem::replace(&mut stage.illumination, another).lights.id());
            }
        }
        old.into_iter().for_each(|buffer| forget(world, buffer));
        true
    })
}

/// The settings shared by all objects.
fn common(scene: &Scene, shown: &Shown, registry: &Registry) -> Drawn {
    Drawn {
        model: scene.reflection_model.clone(),
        shading: scene.shading_model.clone(),
        passage: Passage::NONE,
        encoding: scene.display.encoding,
        everywhere: shines_from_everywhere(shown.shining(), scene.display.encoding, registry),
        lights: shown.types,
        version: 0,
    }
}

/// Finds the objects to update, in all views without overrides or in one view with overrides.
fn find(
    world: &mut World,
    view: Option<Entity>,
    common: &Drawn,
    suspects: Suspects,
    pending: &mut Vec<Pending>,
) {
    let scene = &world.resource::<CurrentScene>().0;
    let registry = world.resource::<Registry>();
    let entities = world.resource::<SceneEntities>();
    let stage = view.and_then(|view| world.get::<Stage>(view));
    let overrides = view.and_then(|view| world.get::<Overrides>(view));
    let encoding = overrides.and_then(|o| o.display).map_or(common.encoding, |display| display.encoding);
    let only_different = matches!(suspects, Suspects::Different);
    // A scene with more objects than a table has rows is illegal; the rest is not drawn.
    let objects = match suspects {
        Suspects::All | Suspects::Different => entities.objects.iter().take(MAX_OBJECTS).copied().collect(),
        Suspects::Some(objects) => {
            let place = |object: &Entity| entities.place_of(*object).filter(|i| *i < MAX_OBJECTS);
            let mut places: Vec<_> = objects.iter().filter_map(place).collect();
            places.sort_unstable();
            places.dedup();
            places.into_iter().map(|i| entities.objects[i]).collect::<Vec<_>>()
        }
    };
    let visits = objects.len() as u64;
    for entity in objects {
        let drawable = stage.map_or(Some(entity), |stage| stage.copies.get(&entity).copied());
        let Some(drawable) = drawable.and_then(|d| world.get_entity(d).ok()) else { continue };
        let (drawn, waits) = (drawable.get::<Drawn>(), drawable.contains::<AwaitsShader>());
        let Some(object) = world.get_entity(entity).ok().and_then(|e| e.get_ref::<ShownObject>()) else {
            continue;
        };
        let [model, shading] = Overrides::models_of(overrides, scene, &object.0);
        let mut shown = None;
        if let Some(overrides) = overrides {
            overrides.dress(shown.get_or_insert_with(|| object.0.clone()), registry);
        }
        let entry = registry.model(model);
        let material = &shown.as_ref().unwrap_or(&object.0).material;
        let now = Drawn {
            model: model.to_owned(),
            shading: shading.to_owned(),
            passage: entry.map(|entry| entry.passage(material)).unwrap_or_default(),
            encoding,
            everywhere: common.everywhere,
            lights: common.lights,
            version: entry.map_or(0, ModelEntry::version),
        };
        if only_different && !waits && !object.is_changed() && drawn == Some(&now) {
            continue;
        }
        let shown = shown.unwrap_or_else(|| object.0.clone());
        pending.push(Pending { view, object: entity, drawable: drawable.id(), shown, now });
    }
    world.resource_mut::<SceneEntities>().bypass_change_detection().visits += visits;
}

/// The vertices needed by a shading model.
fn vertices(shading: &str, registry: &Registry) -> Vertices {
    match registry.shading_model(shading) {
        Some(model) if model.declaration.stage == shading::Stage::Polygon => Vertices::Apart,
        _ => Vertices::Shared,
    }
}

/// Takes objects that others hide from all cameras out of the picture, and returns the rest.
fn without_hidden<T>(
    world: &mut World,
    registry: &Registry,
    eyes: &[Eye],
    pending: Vec<(Need, Pending, Option<T>)>,
) -> Vec<(Need, Pending, Option<T>)> {
    let meshes = world.resource::<ShapeMeshes>();
    let sphere = |pending: &Pending| {
        let place = *world.get::<Transform>(pending.object)?;
        Some((place, meshes.radius(&pending.mesh(registry)?)? * place.scale.abs().max_element()))
    };
    let spheres: Vec<_> = pending.iter().map(|(_, pending, _)| sphere(pending)).collect();
    let shades_of = |eye: &Eye| {
        let could = |(_, pending, bytes): &(Need, Pending, Option<T>)| {
            bytes.is_some() && pending.now.passage == Passage::NONE && pending.shown.visible
        };
        let mut large: Vec<_> = iter::zip(&pending, &spheres)
            .filter_map(|(of, sphere)| {
                let (place, radius) = sphere.filter(|_| could(of))?;
                Some((radius / place.translation.distance(eye.place.translation), place, &of.1.shown))
            })
            .collect();
        large.sort_by(|(a, ..), (b, ..)| b.total_cmp(a));
        let shade = |(_, place, object): (f32, Transform, &Object)| {
            let shape = registry.shape(&object.object_type)?;
            let mesh = shape.mesh(&object.shape, shape.tessellation(object.tessellation));
            Shade::new(&mesh, &place, &eye.place)
        };
        large.into_iter().take(SHADES).filter_map(shade).collect::<Vec<_>>()
    };
    let shades: Vec<_> = eyes.iter().map(shades_of).collect();
    let is_hidden = |(place, radius): (Transform, f32)| {
        let covered = |shades: &Vec<Shade>| shades.iter().any(|s| s.covers(place.translation, radius));
        !shades.is_empty() && shades.iter().all(covered)
    };
    let hidden: Vec<_> = spheres.into_iter().map(|sphere| sphere.is_some_and(is_hidden)).collect();
    let mut rest = Vec::with_capacity(pending.len());
    for (of, is_hidden) in pending.into_iter().zip(hidden) {
        if !is_hidden {
            rest.push(of);
            continue;
        }
        let Pending { drawable, now, .. } = of.1;
        leave_out(world, drawable, now);
        world.resource_mut::<ShapeMeshes>().note_hidden();
    }
    rest
}

/// Takes an object out of the picture. It keeps the settings that it was drawn with; one that never was gets these, and counts
/// as finished.
fn leave_out(world: &mut World, drawable: Entity, now: Drawn) {
    take_off(world, drawable);
    if let Ok(mut drawable) = world.get_entity_mut(drawable) {
        drawable.insert_if_new(now);
    }
}

/// False if all views show copies, not the objects themselves. Views of windows may show these at any time.
fn shows_objects(world: &mut World) -> bool {
    let mut cameras = world.query::<(&PictureCamera, Has<Overrides>)>();
    let shows = |(camera, overrides): (&PictureCamera, bool)| camera.fits_width || !overrides;
    let shows: Vec<_> = cameras.iter(world).map(shows).collect();
    shows.is_empty() || shows.contains(&true)
}

/// Sets the mesh and the material of an object.
fn draw(world: &mut World, registry: &Registry, pending: Pending, bytes: &[u8], is_seen: bool) {
    let mesh = pending.mesh(registry);
    let Pending { view, object, drawable, shown, now } = pending;
    // The checker refuses scenes with unknown ids; should one come from elsewhere, the object stays
    // unchanged.
    let (Some(model), Some(shading), Some(shape), Some((key, vertices))) = (
        registry.model(&now.model),
        registry.shading_model(&now.shading),
        registry.shape(&shown.object_type),
        mesh,
    ) else {
        return;
    };
    let mesh = match ShapeMeshes::put_on(world, drawable, key, vertices, is_seen) {
        Ok(mesh) => mesh,
        Err(triangles) => {
            leave_out(world, drawable, now);
            world.resource_mut::<ShapeMeshes>().leave_out(object, triangles);
            return;
        }
    };
    let parts = (model, now.passage, shading, now.lights);
    let shader = if is_first_asked(world, drawable, parts) {
        None
    } else {
        world.resource_scope(|world, mut shaders: Mut<LiveShaders>| shaders.get(world, parts, registry))
    };
    let Some(shader) = shader else {
        world.entity_mut(drawable).insert(AwaitsShader);
        return;
    };
    let Some(row) = row_of(world, object) else { return };
    let faces = vertices == Vertices::Apart;
    let parameters = world.resource_scope(|world, mut tables: Mut<ParameterTables>| {
        tables.set(view, (model, now.passage), row, bytes, &mut world.resource_mut::<Assets<ShaderBuffer>>())
    });
    let illumination = view.and_then(|view| world.get::<Stage>(view)).map_or_else(
        || world.resource::<IlluminationBuffer>().buffers.clone(),
        |stage| stage.illumination.clone(),
    );
    let gamma_naive = now.encoding == Encoding::Off;
    let solid = if let Some(table) = model.table(&shown.material) {
        world.resource_scope(|world, mut files: Mut<FileBuffers>| {
            files.get(&table, &mut world.resource_mut::<Assets<ShaderBuffer>>())
        })
    } else if now.passage.solid {
        world.resource_scope(|world, mut solids: Mut<Solids>| {
            solids.get(shape, &shown, &mut world.resource_mut::<Assets<ShaderBuffer>>())
        })
    } else {
        // Not read.
        illumination.words.clone()
    };
    let inputs = MaterialInputs { parameters, solid, illumination, shader, faces, gamma_naive };
    let Ok(mut entity) = world.get_entity_mut(drawable) else { return };
    attach(&mut entity, inputs);
    if entity.get::<Mesh3d>().map(|m| &m.0) != Some(&mesh) {
        entity.insert(Mesh3d(mesh));
    }
    if model.leads_by_chance(&shown.material) {
        entity.insert(ByChance);
    } else {
        entity.remove::<ByChance>();
    }
    entity.insert((now, MeshTag(row.0))).remove::<AwaitsShader>();
}

/// True if an object asks for the first time for a shader that is announced before it is made. One that was never drawn
/// does not wait for the announcement, nor do those whose lights change, too.
fn is_first_asked(world: &World, drawable: Entity, parts: Parts) -> bool {
    let Ok(entity) = world.get_entity(drawable) else { return false };
    !entity.contains::<AwaitsShader>()
        && entity.get::<Drawn>().is_some_and(|drawn| drawn.lights == parts.3)
        && world.resource::<LiveShaders>().is_announced(parts)
}

/// The row of an object, assigned if it has none.
fn row_of(world: &mut World, object: Entity) -> Option<Row> {
    if let Some(row) = world.get::<Row>(object) {
        return Some(*row);
    }
    let row = world.resource_mut::<ParameterTables>().bypass_change_detection().take()?;
    world.entity_mut(object).insert(row);
    Some(row)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_that_is_left_out_has_no_mesh_and_keeps_the_settings_it_was_drawn_with() {
        let mut world = World::new();
        let with = |model: &str| Drawn { model: model.to_owned(), ..Drawn::default() };
        let fresh = world.spawn(Mesh3d::default()).id();
        let drawn = world.spawn((Mesh3d::default(), with("phong"))).id();
        for (drawable, expected) in [(fresh, "ward"), (drawn, "phong")] {
            leave_out(&mut world, drawable, with("ward"));
            assert!(!world.entity(drawable).contains::<Mesh3d>());
            assert_eq!(world.get::<Drawn>(drawable).map(Drawn::model), Some(expected));
        }
        world.despawn(fresh);
        leave_out(&mut world, fresh, with("ward"));
    }
}
