//! What others changed in the entities of parts. [`reconcile`](super::reconcile::reconcile) and
//! [`absorb`](super::absorb::absorb), which write to these entities, first [take] it and then [give it back](give_back)
//! as far as it is not absorbed, so that neither sees what it or the other wrote.

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
}

impl Watches {
    /// Watches the components that all types share.
    pub(super) fn of_parts() -> Self {
        Self {
            transforms: vec![watch::<(Changed<Transform>, IsPart, Without<Animated>)>()],
            others: vec![watch::<OfPart>()],
            known: Tick::default(),
        }
    }

    /// Also watches the component of a type.
    pub(super) fn add(&mut self, component: Watch) {
        self.others.push(component);
    }
}

/// Takes what others changed. What changes from now on is known, until it is given back.
pub(super) fn take(world: &mut World) -> Touched {
    let watches = world.get_resource_mut::<Watches>().map(|mut watches| std::mem::take(&mut *watches));
    let Some(mut watches) = watches else { return Touched::default() };
    let mut touched = std::mem::take(&mut *world.resource_mut::<Touched>());
    world.last_change_tick_scope(watches.known, |world| {
        watches.transforms.iter_mut().for_each(|watch| watch(world, &mut touched.moved));
        watches.others.iter_mut().for_each(|watch| watch(world, &mut touched.entities));
    });
    *world.resource_mut::<Watches>() = watches;
    touched
}

/// Gives back what is not absorbed yet, with the entities that are gone meanwhile.
pub(super) fn give_back(world: &mut World, mut touched: Touched) {
    let now = world.change_tick();
    let Some(mut watches) = world.get_resource_mut::<Watches>() else { return };
    watches.known = now;
    let meanwhile = std::mem::take(&mut *world.resource_mut::<Touched>());
    let gone = meanwhile.entities.into_iter().filter(|entity| world.get_entity(*entity).is_err());
    touched.entities.extend(gone);
    *world.resource_mut::<Touched>() = touched;
}
