//! The scene: a value, usually read from JSON.
//!
//! [`Scene`] is the basis of everything else: [`load`] reads it, and knows what may be missing; a document changes it;
//! both renderers draw it. Each part is a struct of declared [fields](Field) in a file of its own. Angles are degrees,
//! lengths metres, colours sRGB-encoded integers: the values as written by users.

use std::collections::BTreeSet;

use crate::{
    parameter::{NamedFile, Value, Values},
    reflection::{ModelEntry, Passage},
    registry::{LightSet, Registry},
};

pub mod at;
mod beyond_room;
pub mod check;
mod clause;
pub mod comparison;
mod declaration;
mod display;
pub(crate) mod encoding;
pub mod error;
pub mod examples;
pub mod field;
pub mod formats;
pub mod held;
mod ids;
mod kept;
pub(crate) mod layout;
mod light;
pub mod limits;
pub mod link;
pub mod load;
mod object;
pub mod observer;
mod other_model;
pub mod part;
mod problem;
mod range;
mod read;
mod reading;
pub mod repeat;
pub mod rotation;
pub mod rows;
pub mod save;
pub mod schema;
mod serialise;
mod size;
pub(crate) mod syntax;
mod unreadable;
mod used;
pub mod variant;
mod views;
mod write;

pub use comparison::Comparison;
pub use declaration::Declared;
pub use display::{Background, Display};
pub use field::Field;
pub use light::{Light, emitter, has_extent, record, shines_from_everywhere};
pub use object::{Object, Repetition};
pub use observer::Observer;
pub use part::{Key, Part};
pub use repeat::{Repeat, Varied};
pub use serialise::{SceneIn, SceneOf};
pub use size::{MAX_DIMENSION, SceneSize};
pub use variant::Variant;

use field::{Ids, Kind};
use part::part;

/// Maximum number of objects in a scene.
pub const MAX_OBJECTS: usize = 10_000;

part! {
    /// A scene of *Lights, Camera, Models!*: a room with lights, objects and one observer.
    pub struct Scene("a scene") {
        /// Name of the scene.
        name: Option<String> = Field::of("the name", Kind::Text(None)).always(), Some("Default scene".to_owned());
        /// Description of the scene, one line.
        description: Option<String> = Field::of("the description", Kind::Text(None)).always(),
            Some("One white point light, one matte sphere: the scene to start from.".to_owned());
        /// Extent of the room in metres. One corner is the origin; x points right, y up, z to the front.
        scene_size: SceneSize = Field::of("", Kind::Part).asked(), SceneSize::default();
        /// Reflection model: the equation for how light leaves a surface. For every object without an override.
        reflection_model: String = Field::of("the reflection model", Kind::Id(Ids::ReflectionModel)).asked(), "lambert".to_owned();
        /// Shading model: where on the surface the reflection model is evaluated. For every object without an override.
        shading_model: String = Field::of("the shading model", Kind::Id(Ids::ShadingModel)).asked(), "gouraud".to_owned();
        /// The lights, 1 to 256.
        lights: Vec<Light> = Field::of("", Kind::Parts).required(""), vec![Light::default()];
        /// Observer: the camera of the scene.
        observer: Observer = Field::of("", Kind::Part).required("a scene needs one observer"), Observer::default();
        /// The objects, 1 to 10 000.
        objects: Vec<Object> = Field::of("", Kind::Parts).required(""), vec![Object::default()];
        /// Conversion of light to the picture on the display, and the background of the picture.
        display: Display = Field::of("", Kind::Part), Display::default();
        /// Variants: the scene with some things changed, to be compared with it. The scene is view A; these are B, C and D.
        variants: Vec<Variant> = Field::of("", Kind::Parts), Vec::new();
        /// Comparison: the way in which the views are shown.
        comparison: Comparison = Field::of("", Kind::Part), Comparison::default();
    }
}

impl Scene {
    /// The ids of the reflection models named by the scene and its variants, each once.
    #[must_use]
    pub fn models(&self) -> BTreeSet<&str> {
        let own = self.objects.iter().filter_map(|o| o.reflection_model.as_deref());
        let of_variants = self.variants.iter().filter_map(|v| v.reflection_model.as_deref());
        own.chain(of_variants).chain([self.reflection_model.as_str()]).collect()
    }

    /// The active lights.
    pub fn shining(&self) -> impl Iterator<Item = &Light> {
        self.lights.iter().filter(|light| light.enabled)
    }

    /// The path of an object in messages: `objects[2] ("Gold")`.
    #[must_use]
    pub fn object_path(&self, index: usize) -> String {
        named("objects", index, self.objects.get(index).and_then(|object| object.name.as_deref()))
    }

    /// The path of a light in messages: `lights[0] ("Key")`.
    #[must_use]
    pub fn light_path(&self, index: usize) -> String {
        named("lights", index, self.lights.get(index).and_then(|light| light.name.as_deref()))
    }

    /// True if a picture of the scene is a mean of samples: of lights with extent, or of ways through rough bodies.
    #[must_use]
    pub fn rests_on_samples(&self, registry: &Registry) -> bool {
        let by_chance = |object: &Object| {
            let model = registry.model(self.model_of(object));
            model.is_some_and(|model| model.leads_by_chance(&object.material))
        };
        has_extent(self.shining(), registry) || self.shown().any(by_chance)
    }

    /// True if no number of samples changes a picture of the scene: all of its objects show light with extent
    /// [as it is](ModelEntry::is_by_chance).
    #[must_use]
    pub fn is_exact(&self, registry: &Registry) -> bool {
        let by_chance = |object: &Object| {
            let model = registry.model(self.model_of(object));
            model.is_some_and(|model| model.is_by_chance(&object.material))
        };
        !self.shown().any(by_chance)
    }

    /// The light types of all lights, including those switched off: the light types in the scene's shader.
    #[must_use]
    pub fn light_types(&self, registry: &Registry) -> LightSet {
        registry.light_set(self.lights.iter().map(|light| light.light_type.as_str()))
    }

    /// The passage of light through the surfaces of all the scene's objects with a model.
    #[must_use]
    pub fn passage_of(&self, model: &ModelEntry) -> Passage {
        let own = self.objects.iter().filter(|object| self.model_of(object) == model.declaration.id);
        let passages = own.map(|object| model.passage(&object.material));
        passages.reduce(|all, one| all | one).unwrap_or_else(|| model.passage(&Values::default()))
    }

    /// The files named by lights, objects and materials, with repetitions.
    pub fn files(&self) -> impl Iterator<Item = &NamedFile> {
        let of_lights = self.lights.iter().map(|light| &light.parameters);
        let of_objects = self.objects.iter().flat_map(|object| [&object.shape, &object.material]);
        let of_variants = self.variants.iter().map(|variant| &variant.material);
        let values = of_lights.chain(of_objects).chain(of_variants);
        values.flat_map(|values| values.0.values()).filter_map(|value| match value {
            Value::File(file) => Some(file),
            _ => None,
        })
    }

    /// The visible objects.
    pub fn shown(&self) -> impl Iterator<Item = &Object> {
        self.objects.iter().filter(|object| object.visible)
    }

    /// The reflection model of an object: its override, or the scene's.
    #[must_use]
    pub fn model_of<'a>(&'a self, object: &'a Object) -> &'a str {
        object.reflection_model.as_deref().unwrap_or(&self.reflection_model)
    }

    /// The shading model of an object: its override, or the scene's.
    #[must_use]
    pub fn shading_model_of<'a>(&'a self, object: &'a Object) -> &'a str {
        object.shading_model.as_deref().unwrap_or(&self.shading_model)
    }
}

fn named(list: &str, index: usize, name: Option<&str>) -> String {
    let path = error::Path::root().key(list.to_owned()).index(index);
    name.map_or_else(|| path.to_string(), |name| format!("{path} ({})", crate::text::quoted(name)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::optics::colour::Encoding;

    #[test]
    fn unknown_light_types_give_no_light_and_no_panic() {
        let light = Light { light_type: "laser".to_owned(), ..Light::default() };
        assert_eq!(record(&light, &Registry::builtin(), Encoding::Srgb).light_type, u32::MAX);
    }

    #[test]
    fn changing_the_type_of_an_object_keeps_the_scene_valid() {
        let registry = Registry::builtin();
        let mut s = Scene::default();
        for from in registry.shapes() {
            for to in registry.shapes() {
                let object = &mut s.objects[0];
                object.set_type(from);
                object.tessellation = Some(*from.declaration.tessellation.end());
                for p in from.parameters {
                    object.shape.set(p.name, p.default_value());
                }
                let before = object.shape.clone();
                object.set_type(to);
                let same = from.declaration.id == to.declaration.id;
                assert!(!same || s.objects[0].shape == before);
                assert_eq!(check::scene(&s, &registry), []);
            }
        }
    }

    #[test]
    fn changing_the_type_of_a_light_keeps_the_scene_valid() {
        let registry = Registry::builtin();
        let mut s = Scene::default();
        for from in registry.lights() {
            for to in registry.lights() {
                s.lights[0].set_type(from, &registry, s.scene_size);
                for p in from.parameters {
                    s.lights[0].parameters.set(p.name, p.default_value());
                }
                s.lights[0].set_type(to, &registry, s.scene_size);
                assert_eq!(check::scene(&s, &registry), []);
            }
        }
    }
}
