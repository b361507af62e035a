//! Changes that others made in the entities of parts. [`absorb`](super::absorb::absorb) [takes](take) them, and
//! [gives back](give_back) those that it does not absorb. [`reconcile`](super::reconcile::reconcile) writes to
//! few entities: it [keeps](keep) earlier changes by others to them, and [lists](wrote) them afterwards. So
//! neither sees its own changes or those of the other, and all parts are searched only once per frame.

use bevy::{
    camera::visibility::Visibility,
    ecs::{change_detection::Tick, prelude::*},
    transform::components::Transform,
};

use super::parts::{
    Animated, IsPart, SceneLight, SceneObject, SceneObserver, Surface, Tessellation, Touched,
};
use crate::parameter::{Watch, watch};

/// Components that belong to a part, besides its transform and the component of its type.
type OfPart = (
    IsPart,
    Or<(
        Changed<SceneLight>,
        Changed<SceneObject>,
        Changed<SceneObserver>,
        Changed<Surface>,
        Changed<Tessellation>,
        Changed<Visibility>,
        Changed<Name>,
    )>,
);

/// Detects changes of the components of parts.
#[derive(Default, Resource)]
pub(super) struct Watches {
    transforms: Vec<Watch>,
    others: Vec<Watch>,
    /// The tick of the last changes that are known.
    known: Tick,
    /// Entities that `reconcile` wrote later, sorted. Changes to them up to the tick `at` are known too.
    written: Vec<Entity>,
    at: Tick,
}

impl Watches {
    /// Watches the components that all types share.
    pub(super) fn of_parts() -> Self {
        Self {
            transforms: vec![watch::<(Changed<Transform>, IsPart, Without<Animated>)>()],
            others: vec![watch::<OfPart>()],
            ..Self::default()
        }
    }

    /// Watches the component of a type too.
    pub(super) fn add(&mut self, component: Watch) {
        self.others.push(component);
    }

    /// Finds the changes after a tick, in all entities or in some.
    fn find(&mut self, world: &mut World, after: Tick, among: Option<&[Entity]>, found: &mut Touched) {
        world.last_change_tick_scope(after, |world| {
            self.transforms.iter_mut().for_each(|watch| watch(world, among, &mut found.moved));
            self.others.iter_mut().for_each(|watch| watch(world, among, &mut found.entities));
        });
    }
}

/// Calls a function with the watches, if the world has any.
fn with_watches<T>(world: &mut World, act: impl FnOnce(&mut World, &mut Watches) -> T) -> Option<T> {
    let mut watches = std::mem::take(&mut *world.get_resource_mut::<Watches>()?);
    let answer = act(world, &mut watches);
    *world.resource_mut::<Watches>() = watches;
    Some(answer)
}

/// Takes the changes by others. It is known from now on.
pub(super) fn take(world: &mut World) -> Touched {
    let taken = with_watches(world, |world, watches| {
        let Touched { entities, moved, rested } = std::mem::take(&mut *world.resource_mut::<Touched>());
        let mut touched = Touched { rested, ..Touched::default() };
        watches.find(world, watches.known, None, &mut touched);
        let written = std::mem::take(&mut watches.written);
        for found in [&mut touched.entities, &mut touched.moved] {
            found.retain(|entity| written.binary_search(entity).is_err());
        }
        watches.find(world, watches.at, Some(&written), &mut touched);
        touched.entities.extend(entities);
        touched.moved.extend(moved);
        watches.known = world.increment_change_tick();
        touched
    });
    taken.unwrap_or_default()
}

/// Gives back what is not absorbed yet. All changes up to now are known.
pub(super) fn give_back(world: &mut World, touched: Touched) {
    with_watches(world, |world, watches| {
        watches.known = world.increment_change_tick();
        put_back(world, touched);
    });
}

/// Begins writing. Returns what is already noticed.
pub(super) fn begin(world: &mut World) -> Touched {
    match world.get_resource::<Watches>() {
        // Nobody looked since the last time: one tick would not do for both.
        Some(watches) if !watches.written.is_empty() => take(world),
        Some(_) => std::mem::take(&mut *world.resource_mut::<Touched>()),
        None => Touched::default(),
    }
}

/// Keeps the changes by others to entities before these are written.
pub(super) fn keep(world: &mut World, entities: &[Entity], touched: &mut Touched) {
    with_watches(world, |world, watches| watches.find(world, watches.known, Some(entities), touched));
}

/// Ends writing: gives back the noticed changes, and lists the written entities.
pub(super) fn wrote(world: &mut World, touched: Touched, mut written: Vec<Entity>) {
    with_watches(world, |world, watches| {
        written.sort_unstable();
        (watches.written, watches.at) = (written, world.increment_change_tick());
        put_back(world, touched);
    });
}

/// Puts back what is still to be absorbed, with the entities that are gone meanwhile.
fn put_back(world: &mut World, mut touched: Touched) {
    let meanwhile = std::mem::take(&mut *world.resource_mut::<Touched>());
    let gone = meanwhile.entities.into_iter().filter(|entity| world.get_entity(*entity).is_err());
    touched.entities.extend(gone);
    *world.resource_mut::<Touched>() = touched;
}

#[cfg(test)]
mod tests {
    use std::sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    };

    use super::*;
    use crate::{
        parameter::Value,
        registry::Registry,
        render::{
            entities::{CurrentScene, SceneEntities},
            reconcile::reconcile,
            typed::know_types,
        },
        scene::{Object, Scene},
    };

    /// A world whose entities follow its scene.
    fn world() -> World {
        let mut world = World::new();
        world.insert_resource(Registry::builtin());
        world
            .insert_resource(CurrentScene(Scene { objects: vec![Object::default(); 5], ..Scene::default() }));
        world.init_resource::<SceneEntities>();
        know_types(&mut world);
        reconcile(&mut world);
        assert!(noticed(&mut world).is_empty(), "the parts are spawned");
        world
    }

    fn noticed(world: &mut World) -> Vec<Entity> {
        let Touched { mut entities, moved, rested } = take(world);
        give_back(world, Touched::default());
        entities.extend(moved.into_iter().chain(rested));
        entities.sort_unstable();
        entities.dedup();
        entities
    }

    fn change(world: &mut World, change: impl FnOnce(&mut Scene)) {
        change(&mut world.resource_mut::<CurrentScene>().0);
        reconcile(world);
    }

    #[test]
    fn written_parts_are_not_noticed_whatever_is_written() {
        let mut world = world();
        let changes: [fn(&mut Scene); 8] = [
            |scene| scene.objects[1].size = 0.5,
            |scene| scene.objects[1].material.set("k_d", Value::Number(0.25)),
            |scene| scene.objects[1].object_type = "torus".to_owned(),
            |scene| scene.lights[0].intensity = 3.0,
            |scene| scene.lights[0].light_type = "directional".to_owned(),
            |scene| scene.observer.field_of_view = 60.0,
            |scene| scene.objects.extend_from_within(..2),
            |scene| drop(scene.objects.pop()),
        ];
        for (i, what) in changes.into_iter().enumerate() {
            let before = world.resource::<SceneEntities>().objects.clone();
            change(&mut world, what);
            let gone: Vec<_> = before.into_iter().filter(|e| world.get_entity(*e).is_err()).collect();
            assert_eq!(noticed(&mut world), gone, "change {i}");
        }
    }

    #[test]
    fn the_changes_of_others_are_noticed_before_and_after_writing() {
        let mut world = world();
        let objects = world.resource::<SceneEntities>().objects.clone();
        let moves = |world: &mut World, i: usize| {
            world.get_mut::<Transform>(objects[i]).expect("it has a place").translation.x += 0.25;
        };
        let hides = |world: &mut World, i: usize| {
            *world.get_mut::<Visibility>(objects[i]).expect("it has one") = Visibility::Hidden;
        };
        let mut size = 1.0;
        let mut grow = |world: &mut World| {
            size += 0.5;
            change(world, |scene| scene.objects[1].size = size);
        };
        // The written component, another of that entity, another entity.
        let acts: [(&dyn Fn(&mut World, usize), usize); 3] = [(&moves, 1), (&hides, 1), (&moves, 3)];
        for (act, i) in acts {
            act(&mut world, i);
            grow(&mut world);
            assert_eq!(noticed(&mut world), [objects[i]], "before");
            grow(&mut world);
            act(&mut world, i);
            assert_eq!(noticed(&mut world), [objects[i]], "after");
            assert!(noticed(&mut world).is_empty(), "once");
        }
        // Written twice before anybody looks.
        grow(&mut world);
        moves(&mut world, 1);
        change(&mut world, |scene| scene.objects[2].size = 3.0);
        moves(&mut world, 4);
        let mut both = [objects[1], objects[4]];
        both.sort_unstable();
        assert_eq!(noticed(&mut world), both);
    }

    #[test]
    fn an_edit_searches_all_parts_once() {
        let mut world = world();
        let searches = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&searches);
        world.resource_mut::<Watches>().add(Box::new(move |_, among, _| {
            counted.fetch_add(usize::from(among.is_none()), Ordering::Relaxed);
        }));
        change(&mut world, |scene| scene.objects[1].size = 0.5);
        noticed(&mut world);
        assert_eq!(searches.load(Ordering::Relaxed), 1);
    }

    #[test]
    fn parts_of_a_list_are_searched_together_before_they_are_written() {
        let mut world = world();
        let searches = Arc::new(AtomicUsize::new(0));
        let counted = Arc::clone(&searches);
        world.resource_mut::<Watches>().add(Box::new(move |_, among, _| {
            let several = among.is_some_and(|among| !among.is_empty());
            counted.fetch_add(usize::from(several), Ordering::Relaxed);
        }));
        change(&mut world, |scene| scene.objects.iter_mut().for_each(|object| object.size = 0.5));
        assert_eq!(searches.load(Ordering::Relaxed), 1);
        assert!(noticed(&mut world).is_empty());
    }
}
