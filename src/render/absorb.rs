//! Transfers changes of entities to the scene, if the rules of scenes allow them; refused changes are undone.

use std::mem::discriminant;

use bevy::{
    camera::visibility::Visibility,
    ecs::{
        change_detection::Tick,
        entity::{EntityHashMap, EntityHashSet},
        prelude::*,
    },
    log::warn,
    transform::components::Transform,
};
use glam::Vec3;

use super::{
    entities::{Absorbed, CurrentScene, SceneEntities},
    mirror::{Part, read_light, read_object, read_observer, read_place},
    noticed,
    parts::{Animated, SceneLight, SceneObject, SceneObserver, Touched},
    shown::show_objects,
    typed::PartTypes,
};
use crate::{
    document::Extent,
    registry::Registry,
    scene::{
        self, Light, Object, Observer, Repetition, Scene,
        check::{self, light_count, object_count},
        error::{Path, Problem},
    },
    text::sentence,
};

/// Refusals that were reported.
#[derive(Default)]
pub struct Reported {
    /// Reported refusals by entity. Each is reported again only after an accepted change.
    changes: EntityHashMap<Vec<String>>,
    /// Last parts that cannot be removed and were reported: each time they get another entity.
    last: Vec<Extent>,
    /// New entities that could not become parts. Another scene may have room for them.
    waiting: EntityHashSet,
    /// Tick of the last change of the scene for which these were tried.
    tried: Option<Tick>,
}

/// Adopts the changes of other systems to the entities of parts, spawned and despawned. Exclusive, since each
/// type has a different component.
pub fn absorb(world: &mut World, mut reported: Local<Reported>) {
    let touched = noticed::take(world);
    let left = absorb_touched(world, touched, &mut reported);
    noticed::give_back(world, left);
}

/// Adopts what was touched. Returns what has to wait.
fn absorb_touched(world: &mut World, all: Touched, reported: &mut Reported) -> Touched {
    let Touched { entities: mut touched, moved, rested } = all;
    touched.extend(&rested);
    let entities = world.resource::<SceneEntities>();
    // Nothing else reports changes of these, which all kinds of entities have.
    let bare = world.removed::<Transform>().chain(world.removed::<Visibility>());
    touched.extend(bare.filter(|entity| entities.part_of(*entity).is_some()));
    let mut places = Vec::new();
    // Some may be animated meanwhile.
    for entity in moved.into_iter().filter(|entity| world.get::<Animated>(*entity).is_none()) {
        match entities.place_of(entity) {
            Some(i) => places.push((entity, i)),
            // Lights and the observer are few; others are new.
            None => touched.push(entity),
        }
    }
    touched.sort_unstable();
    touched.dedup();
    if !entities.stands_for(&world.resource::<CurrentScene>().0) {
        // Another scene was set meanwhile: the entities follow it first.
        touched.extend(places.into_iter().map(|(entity, _)| entity));
        return Touched { entities: touched, rested, ..Touched::default() };
    }
    let before = Some(world.resource_ref::<CurrentScene>().last_changed());
    if std::mem::replace(&mut reported.tried, before) != before && !reported.waiting.is_empty() {
        touched.extend(&reported.waiting);
        touched.sort_unstable();
        touched.dedup();
    }
    // Without a window, nothing else reads it.
    world.resource_mut::<SceneEntities>().bypass_change_detection().absorbed = Absorbed::default();
    if touched.is_empty() && places.is_empty() {
        return Touched::default();
    }
    places.retain(|(entity, _)| touched.binary_search(entity).is_err());
    // Not with `resource_scope`, after which Bevy marks the resource as changed.
    let (types, registry) = (world.resource::<PartTypes>().clone(), world.resource::<Registry>().clone());
    let mut entities = std::mem::take(world.resource_mut::<SceneEntities>().bypass_change_detection());
    let mut current = world.resource_mut::<CurrentScene>();
    let mut scene = std::mem::take(&mut current.bypass_change_detection().0);
    let mut change = Change {
        world,
        scene: &mut scene,
        entities: &mut entities,
        types: &types,
        registry: &registry,
        reported,
        tried: Vec::new(),
        lost: Vec::new(),
        new: Vec::new(),
        back: Vec::new(),
    };
    change.settle(&rested);
    places.into_iter().for_each(|(entity, i)| change.try_place(entity, i));
    touched.iter().for_each(|entity| change.try_part(*entity));
    change.judge();
    change.adopt();
    // Removed parts make room for others, but the last one may be removed only if another was added.
    change.remove();
    change.add();
    change.remove();
    change.keep();
    let back = change.back;
    let Absorbed { parts, relisted, refused, .. } = &entities.absorbed;
    if entities.shown.is_none() {
        refused.iter().for_each(|text| warn!("{text}"));
    }
    let changed = !parts.is_empty() || *relisted;
    let mut current = world.resource_mut::<CurrentScene>();
    current.bypass_change_detection().0 = scene;
    if changed {
        current.set_changed();
        for known in [&mut entities.seen, &mut entities.agreed] {
            if *known == before {
                *known = Some(current.last_changed());
            }
        }
    }
    *world.resource_mut::<SceneEntities>().bypass_change_detection() = entities;
    touched.extend(back);
    show_objects(world, &touched);
    Touched::default()
}

/// The value of a part before a tentative change.
enum Before {
    Place(Vec3, Vec3, f32),
    Object(Box<Object>),
    Light(Box<Light>),
    Observer(Observer),
}

/// The changes of one frame.
struct Change<'a> {
    world: &'a mut World,
    scene: &'a mut Scene,
    entities: &'a mut SceneEntities,
    types: &'a PartTypes,
    registry: &'a Registry,
    reported: &'a mut Reported,
    /// Changes in the scene that may still be refused.
    tried: Vec<(Entity, Extent, Before)>,
    /// Parts with despawned entities.
    lost: Vec<(Entity, Extent)>,
    /// Entities that should become parts.
    new: Vec<Entity>,
    /// Entities of parts that cannot be removed.
    back: Vec<Entity>,
}

impl Change<'_> {
    /// Resets parts that are no longer animated to the values of the scene.
    fn settle(&mut self, rested: &[Entity]) {
        for entity in rested {
            if let Ok(now) = self.world.get_entity(*entity)
                && !now.contains::<Animated>()
                && let Some(part) = self.entities.part_of(*entity)
            {
                self.write_back(*entity, part);
            }
        }
    }

    /// Tries a change of an object's transform alone.
    fn try_place(&mut self, entity: Entity, i: usize) {
        // A copy leaves its row, too.
        if self.scene.objects.get(i).is_some_and(|object| object.repeat != Repetition::None) {
            return self.try_part(entity);
        }
        self.entities.visits += 1;
        let Some((transform, object)) =
            self.world.get::<Transform>(entity).copied().zip(self.scene.objects.get_mut(i))
        else {
            return;
        };
        let before = (object.position, object.rotation, object.size);
        match read_place(&transform, true, object) {
            Ok(()) if before == (object.position, object.rotation, object.size) => {}
            Ok(()) => {
                let (position, rotation, size) = before;
                self.tried.push((entity, Extent::Object(i), Before::Place(position, rotation, size)));
            }
            Err(why) => self.refuse_reading(entity, Extent::Object(i), &why),
        }
    }

    /// Tries any change of a part.
    fn try_part(&mut self, entity: Entity) {
        let part = self.entities.part_of(entity);
        let Ok(now) = self.world.get_entity(entity) else {
            match part {
                Some(part) => self.lost.push((entity, part)),
                None => {
                    self.reported.changes.remove(&entity);
                    self.reported.waiting.remove(&entity);
                }
            }
            return;
        };
        let marked = match part {
            Some(Extent::Light(_)) => now.contains::<SceneLight>(),
            Some(Extent::Object(_)) => now.contains::<SceneObject>(),
            Some(_) => now.contains::<SceneObserver>(),
            None => false,
        };
        if marked && now.contains::<Animated>() {
            return;
        }
        let (types, registry, room) = (self.types, self.registry, self.scene.scene_size);
        let refused = match part {
            Some(part @ Extent::Object(i)) => {
                self.entities.visits += 1;
                let Some(known) = self.scene.objects.get_mut(i) else { return };
                match read_object(now, Some(&*known), types, registry) {
                    Ok(object) if object == *known => None,
                    Ok(object) => {
                        let before = Before::Object(Box::new(std::mem::replace(known, object)));
                        self.tried.push((entity, part, before));
                        None
                    }
                    Err(why) => Some((part, why)),
                }
            }
            Some(part @ Extent::Light(i)) => {
                let Some(known) = self.scene.lights.get_mut(i) else { return };
                match read_light(now, Some(&*known), types, registry, room) {
                    Ok(light) if light == *known => None,
                    Ok(light) => {
                        let before = Before::Light(Box::new(std::mem::replace(known, light)));
                        self.tried.push((entity, part, before));
                        None
                    }
                    Err(why) => Some((part, why)),
                }
            }
            Some(part) => {
                let known = &mut self.scene.observer;
                match read_observer(now, known) {
                    Ok(observer) if observer == *known => None,
                    Ok(observer) => {
                        let before = Before::Observer(std::mem::replace(known, observer));
                        self.tried.push((entity, part, before));
                        None
                    }
                    Err(why) => Some((part, why)),
                }
            }
            None => {
                self.new.push(entity);
                None
            }
        };
        if let Some((part, why)) = refused {
            self.refuse_reading(entity, part, &why);
        }
    }

    /// Undoes changes that break a rule, including several changes that conflict with each other.
    fn judge(&mut self) {
        loop {
            let mut check = check::Parts::of(self.scene, self.registry);
            let problem = |part: Extent| match part {
                Extent::Light(i) => check.problems(scene::Part::Light(i)),
                Extent::Object(i) => check.problems(scene::Part::Object(i)),
                Extent::Rest | Extent::All => check.problems(scene::Part::Observer),
            };
            let problems: Vec<_> = self.tried.iter().map(|(_, part, _)| *part).map(problem).collect();
            if problems.iter().all(Vec::is_empty) {
                return;
            }
            let mut refused = Vec::new();
            let mut problems = problems.into_iter();
            for (entity, part, before) in std::mem::take(&mut self.tried) {
                match problems.next().into_iter().flatten().next() {
                    None => self.tried.push((entity, part, before)),
                    Some(problem) => refused.push((entity, part, before, problem)),
                }
            }
            for (entity, part, before, problem) in refused {
                self.restore(part, before);
                self.refuse(entity, part, &format!("A change to a component was refused: {problem}"));
            }
        }
    }

    fn restore(&mut self, part: Extent, before: Before) {
        match (part, before) {
            (Extent::Object(i), Before::Place(position, rotation, size)) => {
                let object = &mut self.scene.objects[i];
                (object.position, object.rotation, object.size) = (position, rotation, size);
            }
            (Extent::Object(i), Before::Object(object)) => self.scene.objects[i] = *object,
            (Extent::Light(i), Before::Light(light)) => self.scene.lights[i] = *light,
            (_, Before::Observer(observer)) => self.scene.observer = observer,
            _ => {}
        }
    }

    /// Writes the values of the scene into the components of a part.
    fn write_back(&mut self, entity: Entity, part: Extent) {
        let Ok(mut entity) = self.world.get_entity_mut(entity) else { return };
        match part {
            Extent::Light(i) => self.scene.lights[i].write(&mut entity, None, self.types),
            Extent::Object(i) => self.scene.objects[i].write(&mut entity, None, self.types),
            Extent::Rest | Extent::All => self.scene.observer.write(&mut entity, None, self.types),
        }
    }

    /// Refuses a change of a part, and undoes it.
    fn refuse(&mut self, entity: Entity, part: Extent, text: &str) {
        self.write_back(entity, part);
        self.report(entity, text);
    }

    /// Refuses components that do not form a valid part, and undoes the change.
    fn refuse_reading(&mut self, entity: Entity, part: Extent, why: &str) {
        let part_name = match part {
            Extent::Light(i) => format!("lights[{i}]"),
            Extent::Object(i) => format!("objects[{i}]"),
            Extent::Rest | Extent::All => "the observer".to_owned(),
        };
        self.refuse(entity, part, &format!("A change to the components of {part_name} was refused: {why}"));
    }

    /// Reports a message once, whatever numbers it contains.
    fn report(&mut self, entity: Entity, text: &str) {
        let words: String = text.chars().filter(|c| c.is_alphabetic()).collect();
        let known = self.reported.changes.entry(entity).or_default();
        if !known.contains(&words) {
            known.push(words);
            self.entities.absorbed.refused.push(sentence(text));
        }
    }

    /// Adopts the remaining changes into the scene.
    fn adopt(&mut self) {
        let mut retyped = Vec::new();
        for (entity, part, before) in std::mem::take(&mut self.tried) {
            self.reported.changes.remove(&entity);
            let mirrored = self.entities.mirrored.as_mut();
            match (part, before) {
                (Extent::Object(i), Before::Place(..)) => {
                    let Object { position, rotation, size, .. } = self.scene.objects[i];
                    if let Some(object) = mirrored.and_then(|mirrored| mirrored.objects.get_mut(i)) {
                        (object.position, object.rotation, object.size) = (position, rotation, size);
                    }
                }
                (part, before) => {
                    mirrored.into_iter().for_each(|mirrored| part.copy(self.scene, mirrored));
                    let other_type = match (part, &before) {
                        (Extent::Object(i), Before::Object(old)) => {
                            self.scene.objects[i].object_type != old.object_type
                        }
                        (Extent::Light(i), Before::Light(old)) => {
                            self.scene.lights[i].light_type != old.light_type
                        }
                        _ => false,
                    };
                    if other_type {
                        retyped.push((entity, part));
                    }
                }
            }
            self.entities.absorbed.parts.push(part);
        }
        // A new type brings its own values.
        for (entity, part) in retyped {
            self.write_back(entity, part);
            self.entities.absorbed.relisted = true;
        }
    }

    /// Turns entities into parts.
    fn add(&mut self) {
        // In the order of spawning; an `Entity` with a larger index compares as less.
        self.new.sort_unstable_by_key(|entity| entity.index_u32());
        for entity in std::mem::take(&mut self.new) {
            self.reported.waiting.remove(&entity);
            match self.admit(entity) {
                Ok(part) => part.into_iter().for_each(|part| self.come(entity, part)),
                Err(why) => {
                    self.reported.waiting.insert(entity);
                    let name = self.world.get::<Name>(entity).map(|name| format!("“{name}”"));
                    let name = name.unwrap_or_else(|| entity.to_string());
                    self.report(entity, &format!("The entity {name} was not added to the scene: {why}"));
                }
            }
        }
    }

    /// Makes an entity the last part of its list, if it is meant to be a part.
    fn admit(&mut self, entity: Entity) -> Result<Option<Extent>, String> {
        let Ok(now) = self.world.get_entity(entity) else { return Ok(None) };
        let (types, registry, room) = (self.types, self.registry, self.scene.scene_size);
        let legal = |problems: Vec<Problem>| problems.first().map_or(Ok(()), |problem| Err(clause(problem)));
        if now.contains::<SceneObserver>() {
            return Err("a scene has only one observer".to_owned());
        }
        if now.contains::<SceneLight>() {
            let i = self.scene.lights.len();
            let light = read_light(now, None, types, registry, room)?;
            light_count(i + 1)?;
            self.scene.lights.push(light);
            legal(check::Parts::of(self.scene, registry).problems(scene::Part::Light(i)))
                .inspect_err(|_| drop(self.scene.lights.pop()))?;
            self.entities.lights.push(entity);
            return Ok(Some(Extent::Light(i)));
        }
        if !now.contains::<SceneObject>() {
            return Ok(None);
        }
        let i = self.scene.objects.len();
        let object = read_object(now, None, types, registry)?;
        object_count(i + 1)?;
        self.scene.objects.push(object);
        legal(check::Parts::of(self.scene, registry).problems(scene::Part::Object(i)))
            .inspect_err(|_| drop(self.scene.objects.pop()))?;
        self.entities.objects.push(entity);
        self.entities.place(i);
        Ok(Some(Extent::Object(i)))
    }

    /// Records that an entity is now the last part of its list.
    fn come(&mut self, entity: Entity, part: Extent) {
        self.reported.changes.remove(&entity);
        if let Some(mirrored) = &mut self.entities.mirrored {
            match part {
                Extent::Light(i) => mirrored.lights.push(self.scene.lights[i].clone()),
                Extent::Object(i) => mirrored.objects.push(self.scene.objects[i].clone()),
                Extent::Rest | Extent::All => {}
            }
        }
        self.entities.absorbed.relisted = true;
        self.entities.ids = None;
        // From now on, names and the like follow the part.
        self.write_back(entity, part);
    }

    /// Removes parts with their entities, except the last ones, which remain in `lost`.
    fn remove(&mut self) {
        let mut lost = std::mem::take(&mut self.lost);
        // From the end, so that indices stay valid; if one of the removed parts must stay, it is the first.
        lost.sort_unstable_by_key(|(_, part)| match part {
            Extent::Light(i) | Extent::Object(i) => std::cmp::Reverse(*i),
            Extent::Rest | Extent::All => std::cmp::Reverse(0),
        });
        let mut first = None;
        for (entity, part) in lost {
            match part {
                Extent::Light(i) if self.scene.lights.len() > 1 => {
                    self.scene.lights.remove(i);
                    self.entities.lights.remove(i);
                    self.entities.mirrored.iter_mut().for_each(|mirrored| drop(mirrored.lights.remove(i)));
                }
                Extent::Object(i) if self.scene.objects.len() > 1 => {
                    self.scene.objects.remove(i);
                    self.entities.objects.remove(i);
                    self.entities.forget(entity);
                    self.entities.mirrored.iter_mut().for_each(|mirrored| drop(mirrored.objects.remove(i)));
                    first = Some(i);
                }
                part => {
                    self.lost.push((entity, part));
                    continue;
                }
            }
            self.reported.changes.remove(&entity);
            self.reported.last.retain(|last| discriminant(last) != discriminant(&part));
            let absorbed = &mut self.entities.absorbed;
            // A part that changed before its removal is gone.
            absorbed.parts.retain(|changed| *changed != part);
            absorbed.removed.push(part);
            absorbed.relisted = true;
            self.entities.ids = None;
        }
        if let Some(first) = first {
            self.entities.place(first);
        }
    }

    /// Keeps parts that cannot be removed.
    fn keep(&mut self) {
        for (entity, part) in std::mem::take(&mut self.lost) {
            self.reported.changes.remove(&entity);
            self.come_back(entity, part);
        }
    }

    /// Gives another entity to a part that cannot be removed.
    fn come_back(&mut self, lost: Entity, part: Extent) {
        let (world, types) = (&mut *self.world, self.types);
        let (entity, what) = match part {
            Extent::Light(i) => {
                let entity = self.scene.lights[i].spawn(world, types);
                self.entities.lights[i] = entity;
                (entity, "the last light: a scene needs at least one")
            }
            Extent::Object(i) => {
                let entity = self.scene.objects[i].spawn(world, types);
                self.entities.forget(lost);
                self.entities.objects[i] = entity;
                self.entities.place(i);
                (entity, "the last object: a scene needs at least one")
            }
            Extent::Rest | Extent::All => {
                let entity = self.scene.observer.spawn(world, types);
                self.entities.observer = Some(entity);
                (entity, "the observer: a scene needs one")
            }
        };
        let id = self.entities.ids.as_ref().and_then(|ids| match part {
            Extent::Light(i) => ids.lights.get(i).copied(),
            Extent::Object(i) => ids.objects.get(i).copied(),
            Extent::Rest | Extent::All => None,
        });
        if let Some(id) = id {
            self.world.entity_mut(entity).insert(id);
        }
        self.back.push(entity);
        if !self.reported.last.contains(&part) {
            self.reported.last.push(part);
            self.entities.absorbed.refused.push(sentence(&format!("Can’t delete {what}")));
        }
    }
}

/// The message of a problem with a part that is not in the scene, without its position there.
fn clause(problem: &Problem) -> String {
    match problem.path.segments() {
        [_, _, field @ ..] if !field.is_empty() => {
            let field = field.iter().fold(Path::root(), |path, step| path.then(step.clone()));
            format!("its {field} {}", problem.message())
        }
        _ => problem.to_string(),
    }
}
