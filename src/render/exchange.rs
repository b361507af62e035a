//! The scene that is shown follows a document, and the document what systems change in entities; both at the price of
//! what changed.

use bevy::ecs::prelude::*;

use super::entities::{CurrentScene, SceneEntities};
use crate::document::{Document, Extent};

impl SceneEntities {
    /// True if the scene that is shown is that of the document.
    #[must_use]
    pub fn shows(&self, document: &Document) -> bool {
        self.shown == Some(document.revision())
    }

    /// The document goes into the scene that is shown.
    pub fn show(&mut self, document: &Document, mut scene: ResMut<CurrentScene>) {
        if self.shows(document) {
            return;
        }
        let before = Some(scene.last_changed());
        let parts = self.shown.and_then(|shown| document.changes_since(shown));
        // Where others changed the scene, the document counts.
        match parts.filter(|_| self.agreed == before) {
            Some(parts) => {
                parts.iter().for_each(|part| part.copy(document, &mut scene.0));
                if self.seen == before {
                    self.seen = Some(scene.last_changed());
                    self.due.extend(parts);
                }
            }
            None if *document != scene.0 => scene.0.clone_from(document),
            None => {}
        }
        self.agree(document, &scene);
    }

    /// The parts of the scene that is shown that others changed in this frame.
    pub fn changed_by_others(&mut self, document: &Document, scene: &ResMut<CurrentScene>) -> Vec<Extent> {
        let absorbed = std::mem::take(&mut self.absorbed);
        if !scene.is_changed() {
            return Vec::new();
        }
        if self.shows(document) && self.agreed == Some(scene.last_changed()) {
            return absorbed;
        }
        if *document != scene.0 {
            return vec![Extent::All];
        }
        self.agree(document, scene);
        Vec::new()
    }

    /// The scene that is shown and the document were made equal.
    pub fn agree(&mut self, document: &Document, scene: &ResMut<CurrentScene>) {
        self.shown = Some(document.revision());
        self.agreed = Some(scene.last_changed());
    }
}

#[cfg(test)]
mod tests {
    use bevy::prelude::Transform;
    use glam::Vec3;

    use super::*;
    use crate::{
        document::{Edit, LightField, ObjectField, Selection},
        reflection::laws::Random,
        registry::Registry,
        render::entities::{LightSource, LitObject, absorb, reconcile},
        scene::{Light, Object, Scene},
    };

    #[derive(Resource)]
    struct Shown(Document);

    fn show(document: Res<Shown>, mut entities: ResMut<SceneEntities>, scene: ResMut<CurrentScene>) {
        entities.show(&document.0, scene);
    }

    fn submit(
        mut document: ResMut<Shown>,
        mut entities: ResMut<SceneEntities>,
        mut scene: ResMut<CurrentScene>,
        registry: Res<Registry>,
    ) {
        let document = &mut document.0;
        let parts = entities.changed_by_others(document, &scene);
        if parts.is_empty() {
            return;
        }
        if document.submit(&scene.0, &parts, Selection::Room, &registry).is_err() {
            scene.0.clone_from(document);
        }
        entities.agree(document, &scene);
    }

    /// A world with a document, and the systems of the window between the two.
    fn desk() -> (World, Schedule) {
        let mut world = World::new();
        let at = |i: usize| Object { position: Vec3::splat(1.0 + i as f32), size: 0.5, ..Object::default() };
        let scene = Scene { objects: (0..6).map(at).collect(), ..Scene::default() };
        world.insert_resource(Shown(Document::new(scene)));
        world.init_resource::<CurrentScene>();
        world.init_resource::<SceneEntities>();
        world.insert_resource(Registry::builtin());
        let mut schedule = Schedule::default();
        let follow = reconcile.run_if(resource_changed::<CurrentScene>);
        schedule.add_systems((show, follow, absorb, submit).chain());
        (world, schedule)
    }

    fn check(world: &mut World, what: &str) {
        let document = &world.resource::<Shown>().0;
        let scene = &world.resource::<CurrentScene>().0;
        assert!(*document == *scene, "{what}: the scene is the document");
        let entities = world.resource::<SceneEntities>();
        assert!(entities.shows(document), "{what}");
        let objects: Vec<_> =
            entities.objects.iter().map(|e| world.get::<LitObject>(*e).map(|o| o.0.clone())).collect();
        assert_eq!(objects, scene.objects.iter().cloned().map(Some).collect::<Vec<_>>(), "{what}");
        let lights: Vec<_> =
            entities.lights.iter().map(|e| world.get::<LightSource>(*e).map(|l| l.0.clone())).collect();
        assert_eq!(lights, scene.lights.iter().cloned().map(Some).collect::<Vec<_>>(), "{what}");
        for (i, entity) in entities.objects.iter().enumerate() {
            assert_eq!(entities.place_of(*entity), Some(i), "{what}");
            let place = world.get::<Transform>(*entity).map(|t| t.translation);
            assert_eq!(place, Some(scene.objects[i].position), "{what}");
        }
        let all = world.query::<&LitObject>().iter(world).count();
        assert_eq!(all, world.resource::<SceneEntities>().objects.len(), "{what}");
    }

    /// Something that the user, a system or somebody else changes; in words.
    fn change(world: &mut World, random: &mut Random) -> &'static str {
        let mut below = |n: usize| (random.unit() * n as f32) as usize;
        let (kind, amount) = (below(14), 0.5 + below(64) as f32 / 16.0);
        world.resource_scope(|world, mut shown: Mut<Shown>| {
            let document = &mut shown.0;
            let (i, j) = (below(document.objects.len()), below(document.lights.len()));
            let entity = world.resource::<SceneEntities>().objects.get(i).copied();
            let registry = world.resource::<Registry>().clone();
            document.end_gesture();
            let mut edit = |edit| drop(document.edit(edit, Selection::Room, &registry));
            match kind {
                0 => edit(Edit::Object(i, ObjectField::Size(amount))),
                1 => edit(Edit::Object(i, ObjectField::Position(Vec3::splat(amount)))),
                2 => edit(Edit::Light(j, LightField::Intensity(amount))),
                3 => edit(Edit::Light(j, LightField::Type("spot".to_owned()))),
                4 => edit(Edit::Model("phong".to_owned())),
                5 => document.insert_object(i, Object::default(), "Add", Selection::Room, &registry),
                6 => {
                    let light = Light { position: Some(Vec3::splat(9.0)), ..Light::default() };
                    document.insert_light(j, light, "Add", Selection::Room, &registry);
                }
                7 if document.objects.len() > 1 => document.remove(Selection::Object(i), &registry),
                8 => drop(document.undo()),
                9 => drop(document.redo()),
                10 => {
                    if let Some(mut object) = entity.and_then(|e| world.get_mut::<LitObject>(e)) {
                        // Now and then more than a rule allows.
                        object.0.size = amount * 4.0 - 3.0;
                    }
                }
                11 => {
                    if let Some(mut place) = entity.and_then(|e| world.get_mut::<Transform>(e)) {
                        place.translation.x = amount;
                    }
                }
                12 => world.resource_mut::<CurrentScene>().0.observer.position = Vec3::splat(amount),
                _ => {
                    if let Some(entity) = entity {
                        world.despawn(entity);
                    }
                }
            }
            [
                "size",
                "place",
                "intensity",
                "light type",
                "model",
                "object comes",
                "light comes",
                "object goes",
                "undo",
                "redo",
                "component",
                "transform",
                "the scene that is shown",
                "entity gone",
            ][kind]
        })
    }

    #[test]
    fn document_scene_and_entities_stay_equal_whoever_changes_what() {
        for seed in 1..=40 {
            let mut random = Random(seed);
            let (mut world, mut schedule) = desk();
            schedule.run(&mut world);
            check(&mut world, "the start");
            let mut said = Vec::new();
            for round in 0..60 {
                for _ in 0..1 + round % 2 {
                    said.push(change(&mut world, &mut random));
                }
                // A change that a rule refuses is undone in the entities in the next frame; a lost entity comes with the
                // next change.
                schedule.run(&mut world);
                world.resource_mut::<CurrentScene>().set_changed();
                schedule.run(&mut world);
                world.clear_trackers();
                check(&mut world, &format!("seed {seed}: {said:?}"));
            }
        }
    }
}
