//! What is known: reflection models, shading models, light types and object types, looked up by id.
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
mod folders;

use std::{
    collections::{BTreeMap, HashSet},
    path::{Path, PathBuf},
    sync::Arc,
};

use bevy::ecs::resource::Resource;

pub use folders::Folders;
pub(crate) use folders::MODELS;

use crate::{
    light::{self, LightEntry, LightType, MAX_LIGHT_PARAMETERS},
    parameter::{BLOCK_BYTES, Parameter, Value, layout},
    reflection::{self, Family, Measured, ModelEntry, ReflectionModel, usage},
    shader::compose::Sources,
    shading::{self, ShadingEntry, ShadingModel},
    shape::{self, ObjectType, ShapeEntry},
    watch::Print,
};

/// Where new kinds of things are made known.
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

/// Registers what it takes.
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

/// A model from a file.
#[derive(Clone, Debug)]
pub struct CustomModel {
    /// What the rest of the program knows of it. Its [`Source`](crate::shader::Source) is `models/ID.wgsl`; the text built into that is
    /// a stand-in that is drawn as long as the file has no good version.
    pub entry: ModelEntry,
    /// The file.
    pub path: PathBuf,
    /// Its text, declaration included, so that lines count as in the file.
    pub text: Arc<str>,
}

/// How much of a custom model was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// The declaration. The rest is read when the model is used; until then a stand-in is drawn.
    Declaration,
    /// The declaration. The rest is no good: the last text that was is drawn with, or a stand-in.
    StandIn,
    /// All of it.
    Whole,
}

/// The file of a custom model.
#[derive(Clone, Debug)]
struct CustomFile {
    path: PathBuf,
    extent: Extent,
}

/// What is known of files: shaders and custom models.
#[derive(Clone, Debug, Default)]
struct Files {
    folders: Folders,
    /// The files of custom models, by id.
    custom: BTreeMap<&'static str, CustomFile>,
    /// The mistakes of files that give no model, by id.
    broken: BTreeMap<String, String>,
    /// The state of each file whose declaration was looked for, at that time.
    seen: BTreeMap<PathBuf, Print>,
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

    /// The folders that shaders and custom models are read from.
    #[must_use]
    pub fn folders(&self) -> &Folders {
        &self.files.folders
    }

    /// Notes the folder that shaders are read from.
    pub fn set_shader_folder(&mut self, folder: &Path) {
        self.files_mut().folders.shaders = Some(folder.to_owned());
    }

    /// The existing file behind a source path.
    #[must_use]
    pub fn path_on_disk(&self, source: &str) -> Option<PathBuf> {
        let custom = self
            .custom_models()
            .find(|(m, _)| m.declaration.wgsl.path == source)
            .map(|(_, path)| path.to_owned());
        let below_shaders = || Some(self.folders().shaders.as_ref()?.join(source));
        custom.or_else(|| {
            let files = [self.folders().file_of(source), below_shaders()];
            files.into_iter().flatten().find(|file| file.is_file())
        })
    }

    /// Makes a model from a file known, with its text. A second one with the same id replaces the first, in its
    /// place.
    pub fn put_custom_model(&mut self, model: CustomModel) {
        self.sources.edit(model.entry.declaration.wgsl.path, model.text.clone());
        self.put_custom(model, Extent::Whole);
    }

    /// Makes a model from a file known whose text is no good yet: the text that is known stays, and where there is
    /// none a stand-in is drawn.
    pub fn put_stand_in(&mut self, model: CustomModel) {
        self.put_custom(model, Extent::StandIn);
    }

    /// Makes a model from a file known of which only the declaration was read. A stand-in is drawn until the rest is
    /// read, which [`wants_reading`](Self::wants_reading) asks for.
    pub fn put_declared(&mut self, model: CustomModel) {
        self.sources.forget(model.entry.declaration.wgsl.path);
        self.put_custom(model, Extent::Declaration);
    }

    fn put_custom(&mut self, model: CustomModel, extent: Extent) {
        let id = model.entry.declaration.id;
        let files = self.files_mut();
        files.broken.remove(id);
        files.custom.insert(id, CustomFile { path: model.path, extent });
        put(&mut self.models, model.entry, |m| m.declaration.id);
    }

    /// Puts the custom models in the order of their ids, whichever was read first.
    pub(crate) fn sort_custom_models(&mut self) {
        let is_custom = |m: &ModelEntry| self.files.custom.contains_key(m.declaration.id);
        let places: Vec<_> = (0..self.models.len()).filter(|i| is_custom(&self.models[*i])).collect();
        let mut custom: Vec<_> = places.iter().map(|i| self.models[*i].clone()).collect();
        custom.sort_by_key(|m| m.declaration.id);
        for (place, model) in places.into_iter().zip(custom) {
            self.models[place] = model;
        }
    }

    fn files_mut(&mut self) -> &mut Files {
        Arc::make_mut(&mut self.files)
    }

    /// Forgets a model, and its text if it came from a file.
    pub fn remove_model(&mut self, id: &str) {
        let Some(at) = self.models.iter().position(|m| m.declaration.id == id) else { return };
        let model = self.models.remove(at);
        if self.files_mut().custom.remove(id).is_some() {
            self.sources.forget(model.declaration.wgsl.path);
        }
    }

    /// The file of a model that came from one.
    #[must_use]
    pub fn custom_file(&self, id: &str) -> Option<&Path> {
        self.files.custom.get(id).map(|custom| custom.path.as_path())
    }

    /// How much was read of the file of a model that came from one.
    #[must_use]
    pub fn extent(&self, id: &str) -> Option<Extent> {
        self.files.custom.get(id).map(|custom| custom.extent)
    }

    /// The file of a model of which only the declaration was read.
    #[must_use]
    pub fn unread_file(&self, id: &str) -> Option<&Path> {
        self.custom_file(id).filter(|_| self.extent(id) == Some(Extent::Declaration))
    }

    /// The files that are to be read now that these models are used: of some only the declaration is known. See
    /// [`custom::read`](crate::custom::read).
    pub fn wants_reading<'a>(
        &'a self,
        used: impl IntoIterator<Item = &'a str>,
    ) -> impl Iterator<Item = &'a Path> {
        used.into_iter().filter_map(|id| self.unread_file(id))
    }

    /// The state of each file whose declaration was looked for, at that time.
    pub(crate) fn files_seen(&self) -> &BTreeMap<PathBuf, Print> {
        &self.files.seen
    }

    /// Notes the state of a file whose declaration is looked for.
    pub(crate) fn note_seen(&mut self, file: &Path, print: Print) {
        self.files_mut().seen.insert(file.to_owned(), print);
    }

    /// The models that came from files, with these.
    pub fn custom_models(&self) -> impl Iterator<Item = (&ModelEntry, &Path)> {
        self.models.iter().filter_map(|m| Some((m, self.custom_file(m.declaration.id)?)))
    }

    /// Notes the folder that custom models are read from.
    pub fn set_custom_folder(&mut self, folder: &Path) {
        self.files_mut().folders.models = Some(folder.to_owned());
    }

    /// The folder that custom models are read from, if there is one.
    #[must_use]
    pub fn custom_folder(&self) -> Option<&Path> {
        self.folders().models.as_deref()
    }

    /// Notes why the file of that id gives no model, or none as it is.
    pub fn mark_broken(&mut self, id: &str, why: String) {
        self.files_mut().broken.insert(id.to_owned(), why);
    }

    /// Why the file of that id gives no model: where it is wrong and what is.
    #[must_use]
    pub fn broken_model(&self, id: &str) -> Option<&str> {
        self.files.broken.get(id).map(String::as_str)
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

/// What choosing a measured material for one model sets: the parameters of that model, and those of the
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

impl Register for Registry {
    /// # Panics
    /// If the parameters take more bytes than a model may have, one shares its name, but not its type, with a
    /// parameter of another model, or is used under choices that the model does not have: mistakes of the author
    /// of the model, found at the first start.
    fn add_reflection_model<M: ReflectionModel>(&mut self) -> &mut Self {
        let entry = ModelEntry::of::<M>();
        let id = entry.declaration.id;
        let end = layout(entry.parameters).last().map_or(0, |f| f.2 + 12);
        assert!(
            end <= BLOCK_BYTES,
            "reflection model `{id}`: its parameters take {end} bytes, at most {BLOCK_BYTES} fit"
        );
        for p in entry.parameters {
            if let Some(problem) = usage::problem(entry.parameters, p) {
                panic!("reflection model `{id}`: used_when of parameter `{}`: {problem}", p.name);
            }
            if let Some(other) = self.material_parameter(p.name) {
                assert!(
                    std::mem::discriminant(&other.kind) == std::mem::discriminant(&p.kind),
                    "reflection model `{id}`: parameter `{}` has another type than in the models before it; \
                     parameters are shared by name",
                    p.name
                );
            }
        }
        put(&mut self.models, entry, |m| m.declaration.id);
        self
    }

    fn add_shading_model<S: ShadingModel>(&mut self) -> &mut Self {
        put(&mut self.shadings, ShadingEntry::of::<S>(), |m| m.declaration.id);
        self
    }

    /// # Panics
    /// If the type declares more than [`MAX_LIGHT_PARAMETERS`] parameters.
    fn add_light_type<L: LightType>(&mut self) -> &mut Self {
        let entry = LightEntry::of::<L>();
        let count = entry.declaration.parameters.len();
        assert!(
            count <= MAX_LIGHT_PARAMETERS,
            "light type `{}`: declares {count} parameters, at most {MAX_LIGHT_PARAMETERS} fit",
            entry.declaration.id
        );
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
