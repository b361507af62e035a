//! Everything that is known, looked up by id: reflection models, shading models, light types and object types; with the
//! texts of shaders and the folders that they are read from.
//!
//! The registry is a value. The command line and the CPU renderer use it as it is; in the Bevy app it
//! is a resource, and `App` offers the same calls, so that a plugin outside this crate registers
//! exactly as the built-in list does:
//!
//! ```no_run
//! # use bevy::prelude::App;
//! # use lights_camera_models::{reflection::Lambert, registry::Register};
//! # let mut app = App::new();
//! app.add_reflection_model::<Lambert>();
//! ```

pub mod compose;
mod files;
mod folders;

use std::{collections::HashSet, sync::Arc};

use bevy::ecs::resource::Resource;

use files::Files;
pub use files::{CustomModel, Extent};
pub use folders::Folders;
pub(crate) use folders::MODELS;

use crate::{
    light::{self, LightEntry, LightType},
    parameter::{BLOCK_BYTES, Parameter, ParameterKind, Value, layout},
    reflection::{self, Family, Measured, ModelEntry, ReflectionModel, usage},
    shader::compose::Sources,
    shading::{self, ShadingEntry, ShadingModel},
    shape::{self, ObjectType, ShapeEntry},
};

/// Registration of reflection models, shading models, light types and object types.
pub trait Register {
    /// Makes a reflection model known. A second one with the same id replaces the first.
    fn add_reflection_model<M: ReflectionModel>(&mut self) -> &mut Self;
    /// Makes a shading model known.
    fn add_shading_model<S: ShadingModel>(&mut self) -> &mut Self;
    /// Makes a light type known.
    fn add_light_type<L: LightType>(&mut self) -> &mut Self;
    /// Makes an object type known.
    fn add_object_type<T: ObjectType>(&mut self) -> &mut Self;
}

/// Registers everything built in. The app and the registry both go through here.
pub fn register_builtin(to: &mut impl Register) {
    let to = &mut Adding(to);
    reflection::register_builtin(to);
    shading::register_builtin(to);
    light::register_builtin(to);
    shape::register_builtin(to);
}

/// Registers everything that it takes.
struct Adding<'a, R>(&'a mut R);

impl<R: Register> reflection::Take for Adding<'_, R> {
    fn take<T: ReflectionModel>(&mut self) {
        self.0.add_reflection_model::<T>();
    }
}

impl<R: Register> shading::Take for Adding<'_, R> {
    fn take<T: ShadingModel>(&mut self) {
        self.0.add_shading_model::<T>();
    }
}

impl<R: Register> light::Take for Adding<'_, R> {
    fn take<T: LightType>(&mut self) {
        self.0.add_light_type::<T>();
    }
}

impl<R: Register> shape::Take for Adding<'_, R> {
    fn take<T: ObjectType>(&mut self) {
        self.0.add_object_type::<T>();
    }
}

/// Everything that is known, in the order of registration.
#[derive(Clone, Debug, Default, Resource)]
pub struct Registry {
    models: Vec<ModelEntry>,
    shadings: Vec<ShadingEntry>,
    lights: Vec<LightEntry>,
    shapes: Vec<ShapeEntry>,
    sources: Sources,
    /// Shared by copies of the registry, of which the window makes many.
    files: Arc<Files>,
}

impl Registry {
    /// The built-in models, shading models, lights and shapes.
    #[must_use]
    pub fn builtin() -> Self {
        let mut registry = Self::default();
        register_builtin(&mut registry);
        registry
    }

    /// All reflection models.
    #[must_use]
    pub fn models(&self) -> &[ModelEntry] {
        &self.models
    }

    /// All shading models.
    #[must_use]
    pub fn shading_models(&self) -> &[ShadingEntry] {
        &self.shadings
    }

    /// All light types. The index is the number that shaders know the type by.
    #[must_use]
    pub fn lights(&self) -> &[LightEntry] {
        &self.lights
    }

    /// All object types.
    #[must_use]
    pub fn shapes(&self) -> &[ShapeEntry] {
        &self.shapes
    }

    /// The model of that id.
    #[must_use]
    pub fn model(&self, id: &str) -> Option<&ModelEntry> {
        self.models.iter().find(|m| m.declaration.id == id)
    }

    /// The shading model of that id.
    #[must_use]
    pub fn shading_model(&self, id: &str) -> Option<&ShadingEntry> {
        self.shadings.iter().find(|m| m.declaration.id == id)
    }

    /// The light type of that id.
    #[must_use]
    pub fn light(&self, id: &str) -> Option<&LightEntry> {
        self.lights.iter().find(|l| l.declaration.id == id)
    }

    /// The number that shaders know a light type by.
    #[must_use]
    pub fn light_index(&self, id: &str) -> Option<u32> {
        self.lights.iter().position(|l| l.declaration.id == id).map(|i| i as u32)
    }

    /// The object type of that id.
    #[must_use]
    pub fn shape(&self, id: &str) -> Option<&ShapeEntry> {
        self.shapes.iter().find(|s| s.declaration.id == id)
    }

    /// The current texts of shader files, where they differ from the built-in ones, and those of custom models.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// The current texts of shader files, to change them.
    pub fn sources_mut(&mut self) -> &mut Sources {
        &mut self.sources
    }

    /// Adds the types of another registry that are not known here.
    pub fn add_missing(&mut self, other: &Self) {
        fn extend<T: Clone>(list: &mut Vec<T>, other: &[T], id: impl Fn(&T) -> &'static str) {
            for entry in other {
                if list.iter().all(|known| id(known) != id(entry)) {
                    list.push(entry.clone());
                }
            }
        }
        extend(&mut self.models, &other.models, |m| m.declaration.id);
        extend(&mut self.shadings, &other.shadings, |s| s.declaration.id);
        extend(&mut self.lights, &other.lights, |l| l.declaration.id);
        extend(&mut self.shapes, &other.shapes, |s| s.declaration.id);
    }

    /// Every parameter that some model declares, each name once, in order of first declaration.
    pub fn material_parameters(&self) -> impl Iterator<Item = &'static Parameter> + '_ {
        let mut known = HashSet::new();
        self.models.iter().flat_map(|m| m.parameters).filter(move |p| known.insert(p.name))
    }

    /// The declaration of a material parameter by name.
    #[must_use]
    pub fn material_parameter(&self, name: &str) -> Option<&'static Parameter> {
        self.models.iter().find_map(|m| m.parameter(name))
    }
}

/// The values that choosing a measured material for one model sets: the parameters of that model, and those of the
/// microfacet and standard models that do not contradict them, so that gold stays gold when the model is
/// exchanged.
#[must_use]
pub fn along(model: &ModelEntry, material: &Measured, registry: &Registry) -> Vec<(&'static str, Value)> {
    let mut values = (model.preset)(material);
    let takes_along = |m: &&ModelEntry| matches!(m.declaration.family, Family::Microfacet | Family::Standard);
    for other in registry.models().iter().filter(takes_along) {
        let theirs = (other.preset)(material);
        let clashes = |(name, value): &(&str, Value)| values.iter().any(|(n, v)| n == name && v != value);
        if !theirs.iter().any(clashes) {
            for (name, value) in theirs {
                if !values.iter().any(|(n, _)| *n == name) {
                    values.push((name, value));
                }
            }
        }
    }
    values
}

/// Adds or replaces by id.
fn put<T>(list: &mut Vec<T>, entry: T, id: impl Fn(&T) -> &'static str) {
    match list.iter().position(|e| id(e) == id(&entry)) {
        Some(i) => list[i] = entry,
        None => list.push(entry),
    }
}

/// Parameters that fit: few enough, used under choices that exist, and of the same type as those of that name `before`.
///
/// # Panics
/// If they do not.
fn fit(what: &str, parameters: &[Parameter], before: impl Fn(&str) -> Option<&'static Parameter>) {
    let end = layout(parameters).last().map_or(0, |f| f.2 + 12);
    assert!(end <= BLOCK_BYTES, "{what}: its parameters take {end} bytes, at most {BLOCK_BYTES} fit");
    for p in parameters {
        if let Some(problem) = usage::problem(parameters, p) {
            panic!("{what}: used_when of parameter `{}`: {problem}", p.name);
        }
        if let Some(other) = before(p.name) {
            assert!(
                std::mem::discriminant(&other.kind) == std::mem::discriminant(&p.kind),
                "{what}: parameter `{}` has another type than in those before it; parameters are shared by name",
                p.name
            );
        }
    }
}

impl Register for Registry {
    /// # Panics
    /// If the parameters take more bytes than a model may have, one shares its name, but not its type, with a
    /// parameter of another model, or is used under choices that the model does not have: mistakes of the author
    /// of the model, found at the first start.
    fn add_reflection_model<M: ReflectionModel>(&mut self) -> &mut Self {
        let entry = ModelEntry::of::<M>();
        let id = entry.declaration.id;
        let what = format!("reflection model `{id}`");
        fit(&what, entry.parameters, |name| self.material_parameter(name));
        put(&mut self.models, entry, |m| m.declaration.id);
        self
    }

    fn add_shading_model<S: ShadingModel>(&mut self) -> &mut Self {
        put(&mut self.shadings, ShadingEntry::of::<S>(), |m| m.declaration.id);
        self
    }

    /// # Panics
    /// If the parameters take more bytes than a type may have, one shares its name, but not its type, with a parameter
    /// of another light type, or is used under choices that the type does not have, or the cone is no number.
    fn add_light_type<L: LightType>(&mut self) -> &mut Self {
        let entry = LightEntry::of::<L>();
        let id = entry.declaration.id;
        let others = || self.lights.iter().filter(|other| other.declaration.id != id);
        fit(&format!("light type `{id}`"), entry.parameters, |name| others().find_map(|l| l.parameter(name)));
        if let Some(cone) = entry.declaration.cone_parameter {
            let number = |p: &Parameter| matches!(p.kind, ParameterKind::Number { .. });
            assert!(
                entry.parameter(cone).is_some_and(number),
                "light type `{id}`: the parameter of its cone, `{cone}`, must be one of its numbers"
            );
        }
        put(&mut self.lights, entry, |l| l.declaration.id);
        self
    }

    fn add_object_type<T: ObjectType>(&mut self) -> &mut Self {
        put(&mut self.shapes, ShapeEntry::of::<T>(), |s| s.declaration.id);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reflection::preset;

    #[test]
    fn gold_stays_gold_when_the_model_is_exchanged() {
        let registry = Registry::builtin();
        let gold = preset::by_id("gold").expect("measured");
        for from in ["metallic_roughness", "microfacet", "cook_torrance", "disney"] {
            let values = along(registry.model(from).expect("built in"), gold, &registry);
            for to in ["metallic_roughness", "microfacet", "torrance_sparrow", "cook_torrance", "disney"] {
                for wanted in (registry.model(to).expect("built in").preset)(gold) {
                    assert!(values.contains(&wanted), "{from} → {to}: {wanted:?} is not among {values:?}");
                }
            }
        }
        // A base that is black on purpose makes no black metal of others.
        let lacquer = along(registry.model("ashikhmin_shirley").expect("built in"), gold, &registry);
        assert!(!lacquer.iter().any(|(name, _)| *name == crate::parameter::METALLIC.name), "{lacquer:?}");
    }
}
