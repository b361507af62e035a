//! All registered types, looked up by id: reflection models, shading models, light types and object types;
//! also scene formats from other crates, shader texts, and the folders from which they are read.
//!
//! The registry is a value. The command line and the CPU renderer use it directly; in the Bevy app it is a
//! resource, and `App` offers the same methods, so that a plugin in another crate registers types exactly as
//! the built-in list does:
//!
//! ```no_run
//! # use bevy::prelude::App;
//! # use lights_camera_models::{reflection::Lambert, registry::Register};
//! # let mut app = App::new();
//! app.add_reflection_model::<Lambert>();
//! ```

pub mod check;
pub mod compose;
mod error;
mod files;
mod folders;
mod formats;
mod light_set;

use std::{collections::HashSet, path::PathBuf, sync::Arc};

use bevy_ecs::resource::Resource;

use error::Mistake;
pub use error::RegistrationError;
use files::Files;
pub use files::{CustomModel, Extent};
pub use folders::Folders;
pub(crate) use folders::MODELS;
pub use formats::FormatEntry;
pub use light_set::{LightSet, MAX_LIGHT_TYPES};

use crate::{
    declared::keys,
    light::{self, LightEntry, LightType},
    parameter::{Parameter, Value},
    reflection::{self, Family, Measured, ModelEntry, ReflectionModel},
    shader::{Source, compose::Sources},
    shading::{self, ShadingEntry, ShadingModel},
    shape::{self, ObjectType, ShapeEntry},
};

/// The keys that lights of all types may have in scene files; the parameters of a type have an empty one.
pub const LIGHT_KEYS: &[&str] = light::fields!(keys);
/// The keys that objects of all types may have in scene files; the parameters of a type have an empty one.
pub const OBJECT_KEYS: &[&str] = shape::fields!(keys);
/// Letters used by the window for anything but choosing a shading model.
pub const WINDOW_KEYS: &[char] = &['C', 'E', 'H', 'R', 'T', 'V', 'X'];

/// The origin of a registered type, which determines how it is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Admission {
    /// The type ships with this crate, whose tests cover its meshes and its WGSL.
    BuiltIn,
    /// The type is new; its WGSL is checked when it is first drawn.
    New,
    /// The type is new, and its WGSL is checked at once.
    Checked,
    /// The type replaces the one with its id, and its WGSL is checked at once.
    Replacing,
}

/// The calls that register one sort of part.
macro_rules! calls {
    ($what:literal $Trait:ident $add:ident $try_add:ident $replace:ident $admit:ident) => {
        #[doc = concat!("Makes ", $what, " known. Should its WGSL be wrong, a stand-in is drawn, and the mistake is")]
        /// reported with file and line wherever it is used.
        ///
        /// # Panics
        #[doc = concat!("With the message of [`", stringify!($try_add), "`](Self::", stringify!($try_add), ") if anything else is wrong:")]
        /// a mistake of its author, found at the first start.
        #[track_caller]
        fn $add<T: $Trait>(&mut self) -> &mut Self {
            match self.$admit::<T>(Admission::New) {
                Ok(()) => self,
                Err(error) => panic!("{error}"),
            }
        }

        #[doc = concat!("Makes ", $what, " known, if everything about it is right, its WGSL included.")]
        ///
        /// # Errors
        /// The first mistake. Nothing is registered then.
        fn $try_add<T: $Trait>(&mut self) -> Result<&mut Self, RegistrationError> {
            self.$admit::<T>(Admission::Checked).map(|()| self)
        }

        #[doc = concat!("Puts ", $what, " in the place of the one of its id.")]
        ///
        /// # Errors
        /// The first mistake, or that there is none of that id. Nothing changes then.
        fn $replace<T: $Trait>(&mut self) -> Result<&mut Self, RegistrationError> {
            self.$admit::<T>(Admission::Replacing).map(|()| self)
        }
    };
}

/// Registration of reflection models, shading models, light types and object types.
pub trait Register {
    calls!("a reflection model" ReflectionModel add_reflection_model try_add_reflection_model replace_reflection_model admit_reflection_model);
    calls!("a shading model" ShadingModel add_shading_model try_add_shading_model replace_shading_model admit_shading_model);
    calls!("a light type" LightType add_light_type try_add_light_type replace_light_type admit_light_type);
    calls!("an object type" ObjectType add_object_type try_add_object_type replace_object_type admit_object_type);

    /// Adds a folder with the shaders of another crate: `concat!(env!("CARGO_MANIFEST_DIR"), "/shaders")`.
    /// Files in it are identified by their paths below it. The window reloads them while they are edited; if
    /// the folder does not exist, the compiled-in texts are used.
    fn add_shader_folder(&mut self, folder: impl Into<PathBuf>) -> &mut Self;

    /// Registers a reflection model.
    ///
    /// # Errors
    /// Returns the first error.
    #[doc(hidden)]
    fn admit_reflection_model<M: ReflectionModel>(
        &mut self,
        admission: Admission,
    ) -> Result<(), RegistrationError>;
    /// Registers a shading model.
    ///
    /// # Errors
    /// Returns the first error.
    #[doc(hidden)]
    fn admit_shading_model<S: ShadingModel>(&mut self, admission: Admission)
    -> Result<(), RegistrationError>;
    /// Registers a light type.
    ///
    /// # Errors
    /// Returns the first error.
    #[doc(hidden)]
    fn admit_light_type<L: LightType>(&mut self, admission: Admission) -> Result<(), RegistrationError>;
    /// Registers an object type.
    ///
    /// # Errors
    /// Returns the first error.
    #[doc(hidden)]
    fn admit_object_type<T: ObjectType>(&mut self, admission: Admission) -> Result<(), RegistrationError>;
}

/// Registers all built-in types, for both the app and the registry.
///
/// # Panics
/// Panics if a built-in type is declared incorrectly.
pub fn register_builtin(to: &mut impl Register) {
    let to = &mut Adding(to);
    reflection::register_builtin(to);
    shading::register_builtin(to);
    light::register_builtin(to);
    shape::register_builtin(to);
}

/// Registers everything that it takes.
struct Adding<'a, R>(&'a mut R);

/// Shipped types are valid: tests ensure it.
fn admitted(result: Result<(), RegistrationError>) {
    result.unwrap_or_else(|error| panic!("{error}"));
}

impl<R: Register> reflection::Take for Adding<'_, R> {
    fn take<T: ReflectionModel>(&mut self) {
        admitted(self.0.admit_reflection_model::<T>(Admission::BuiltIn));
    }
}

impl<R: Register> shading::Take for Adding<'_, R> {
    fn take<T: ShadingModel>(&mut self) {
        admitted(self.0.admit_shading_model::<T>(Admission::BuiltIn));
    }
}

impl<R: Register> light::Take for Adding<'_, R> {
    fn take<T: LightType>(&mut self) {
        admitted(self.0.admit_light_type::<T>(Admission::BuiltIn));
    }
}

impl<R: Register> shape::Take for Adding<'_, R> {
    fn take<T: ObjectType>(&mut self) {
        admitted(self.0.admit_object_type::<T>(Admission::BuiltIn));
    }
}

/// Everything that is known, in the order of registration. Cloning is cheap: clones share what they hold until one of them
/// changes, since the window makes a clone for every calculation in the background.
#[derive(Clone, Debug, Default, Resource)]
pub struct Registry {
    models: Arc<Vec<ModelEntry>>,
    shadings: Arc<Vec<ShadingEntry>>,
    lights: Arc<Vec<LightEntry>>,
    shapes: Arc<Vec<ShapeEntry>>,
    formats: Arc<Vec<FormatEntry>>,
    sources: Sources,
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

    /// All light types, in the order of their indices.
    #[must_use]
    pub fn lights(&self) -> &[LightEntry] {
        &self.lights
    }

    /// All object types.
    #[must_use]
    pub fn shapes(&self) -> &[ShapeEntry] {
        &self.shapes
    }

    /// The model with this id.
    #[must_use]
    pub fn model(&self, id: &str) -> Option<&ModelEntry> {
        self.models.iter().find(|m| m.declaration.id == id)
    }

    /// The shading model with this id.
    #[must_use]
    pub fn shading_model(&self, id: &str) -> Option<&ShadingEntry> {
        self.shadings.iter().find(|m| m.declaration.id == id)
    }

    /// The light type with this id.
    #[must_use]
    pub fn light(&self, id: &str) -> Option<&LightEntry> {
        self.lights.iter().find(|l| l.declaration.id == id)
    }

    /// The index of a light type in shaders.
    #[must_use]
    pub fn light_index(&self, id: &str) -> Option<u32> {
        self.light(id).map(|light| light.index)
    }

    /// The object type with this id.
    #[must_use]
    pub fn shape(&self, id: &str) -> Option<&ShapeEntry> {
        self.shapes.iter().find(|s| s.declaration.id == id)
    }

    /// The current texts of shader files, where they differ from the built-in ones, and of custom models.
    #[must_use]
    pub fn sources(&self) -> &Sources {
        &self.sources
    }

    /// The current texts of shader files, for changes.
    pub fn sources_mut(&mut self) -> &mut Sources {
        &mut self.sources
    }

    /// Adds the types of another registry that are missing here, and its shader folders.
    pub fn add_missing(&mut self, other: &Self) {
        fn extend<T: Clone>(list: &mut Vec<T>, other: &[T], id: impl Fn(&T) -> &'static str) {
            for entry in other {
                if list.iter().all(|known| id(known) != id(entry)) {
                    list.push(entry.clone());
                }
            }
        }
        extend(Arc::make_mut(&mut self.models), &other.models, |m| m.declaration.id);
        extend(Arc::make_mut(&mut self.shadings), &other.shadings, |s| s.declaration.id);
        extend(Arc::make_mut(&mut self.lights), &other.lights, |l| l.declaration.id);
        Arc::make_mut(&mut self.lights).iter_mut().zip(0..).for_each(|(light, index)| light.index = index);
        extend(Arc::make_mut(&mut self.shapes), &other.shapes, |s| s.declaration.id);
        let files = self.files_mut();
        files.foreign.extend(&other.files.foreign);
        for folder in &other.files.folders.extensions {
            if !files.folders.extensions.contains(folder) {
                files.folders.extensions.push(folder.clone());
            }
        }
        extend(Arc::make_mut(&mut self.formats), &other.formats, |f| f.name);
    }

    /// Every parameter declared by a reflection or shading model, each name once, in the order of the first
    /// declaration.
    pub fn material_parameters(&self) -> impl Iterator<Item = &'static Parameter> + '_ {
        let mut known = HashSet::new();
        self.material_users().flat_map(|(_, all)| all).filter(move |p| known.insert(p.name))
    }

    /// The ids of reflection and shading models, with their parameters in materials.
    pub fn material_users(&self) -> impl Iterator<Item = (&'static str, &'static [Parameter])> + Clone + '_ {
        let models = self.models.iter().map(|m| (m.declaration.id, m.parameters));
        models.chain(self.shadings.iter().map(|s| (s.declaration.id, s.parameters)))
    }

    /// The declaration of a material parameter by name.
    #[must_use]
    pub fn material_parameter(&self, name: &str) -> Option<&'static Parameter> {
        self.material_users().find_map(|(_, all)| all.iter().find(|p| p.name == name))
    }
}

/// The values set by choosing a measured material for one model: the parameters of that model, and those of
/// the microfacet and standard models that do not contradict them, so that gold stays gold when the model
/// changes.
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

/// Checks that an id is new, or known if it is to be replaced.
fn place(known: bool, id: &str, admission: Admission, part: &str) -> Result<(), Mistake> {
    let call = part.replace(' ', "_");
    match (admission == Admission::Replacing, known) {
        (false, true) => Err(Mistake::Declared(format!(
            "that id is already used by another {part}; choose another id, or call replace_{call}"
        ))),
        (true, false) => {
            Err(Mistake::Declared(format!("there is no {part} `{id}` to replace; add_{call} adds a new one")))
        }
        _ => Ok(()),
    }
}

impl Registry {
    /// True if the WGSL of a new part must be checked at once.
    fn wants_wgsl(admission: Admission) -> bool {
        matches!(admission, Admission::Checked | Admission::Replacing)
    }

    /// Records the origin of a part's WGSL.
    fn note_origin(&mut self, path: &'static str, admission: Admission) {
        if admission == Admission::BuiltIn {
            self.files_mut().foreign.remove(path)
        } else {
            self.files_mut().foreign.insert(path)
        };
    }

    /// The ids of all parts with WGSL, and their sources.
    fn parts(&self) -> impl Iterator<Item = (&'static str, Source)> + '_ {
        let models = self.models.iter().map(|m| (m.declaration.id, m.declaration.wgsl));
        let shadings = self.shadings.iter().map(|s| (s.declaration.id, s.declaration.wgsl));
        models.chain(shadings).chain(self.lights.iter().map(|l| (l.declaration.id, l.declaration.wgsl)))
    }
}

impl Register for Registry {
    fn add_shader_folder(&mut self, folder: impl Into<PathBuf>) -> &mut Self {
        self.files_mut().folders.extensions.push(folder.into());
        self
    }

    fn admit_reflection_model<M: ReflectionModel>(
        &mut self,
        admission: Admission,
    ) -> Result<(), RegistrationError> {
        const PART: &str = "reflection model";
        let entry = ModelEntry::of::<M>();
        let d = entry.declaration;
        let check = || -> Result<(), Mistake> {
            check::reflection_model(self, &entry)?;
            place(self.model(d.id).is_some(), d.id, admission, PART)?;
            if admission != Admission::BuiltIn {
                check::shipped_files(entry.parameters)?;
            }
            if Self::wants_wgsl(admission) {
                check::wgsl::model(&Sources::default(), &entry)?;
            }
            Ok(())
        };
        check().map_err(|mistake| RegistrationError::of::<M>(PART, d.id, mistake))?;
        self.note_origin(d.wgsl.path, admission);
        put(Arc::make_mut(&mut self.models), entry, |m| m.declaration.id);
        Ok(())
    }

    fn admit_shading_model<S: ShadingModel>(
        &mut self,
        admission: Admission,
    ) -> Result<(), RegistrationError> {
        const PART: &str = "shading model";
        let entry = ShadingEntry::of::<S>();
        let d = entry.declaration;
        let check = || -> Result<(), Mistake> {
            check::shading_model(self, &entry)?;
            place(self.shading_model(d.id).is_some(), d.id, admission, PART)?;
            if let Some(model) = self.models.first().filter(|_| Self::wants_wgsl(admission)) {
                check::wgsl::shading(&Sources::default(), &entry, model)?;
            }
            Ok(())
        };
        check().map_err(|mistake| RegistrationError::of::<S>(PART, d.id, mistake))?;
        self.note_origin(d.wgsl.path, admission);
        put(Arc::make_mut(&mut self.shadings), entry, |s| s.declaration.id);
        Ok(())
    }

    fn admit_light_type<L: LightType>(&mut self, admission: Admission) -> Result<(), RegistrationError> {
        const PART: &str = "light type";
        let mut entry = LightEntry::of::<L>();
        let d = entry.declaration;
        let check = || -> Result<(), Mistake> {
            check::light_type(self, &entry)?;
            place(self.light(d.id).is_some(), d.id, admission, PART)?;
            if admission != Admission::BuiltIn {
                check::shipped_files(entry.parameters)?;
            }
            if Self::wants_wgsl(admission) {
                check::wgsl::light(&Sources::default(), &entry)?;
            }
            Ok(())
        };
        check().map_err(|mistake| RegistrationError::of::<L>(PART, d.id, mistake))?;
        self.note_origin(d.wgsl.path, admission);
        entry.index = self.light_index(d.id).unwrap_or(self.lights.len() as u32);
        put(Arc::make_mut(&mut self.lights), entry, |l| l.declaration.id);
        Ok(())
    }

    fn admit_object_type<T: ObjectType>(&mut self, admission: Admission) -> Result<(), RegistrationError> {
        const PART: &str = "object type";
        let entry = ShapeEntry::of::<T>();
        let d = entry.declaration;
        let check = || -> Result<(), Mistake> {
            check::object_type(self, &entry)?;
            place(self.shape(d.id).is_some(), d.id, admission, PART)?;
            if admission != Admission::BuiltIn {
                check::shipped_files(entry.parameters)?;
                check::meshes(&entry)?;
            }
            Ok(())
        };
        check().map_err(|mistake| RegistrationError::of::<T>(PART, d.id, mistake))?;
        put(Arc::make_mut(&mut self.shapes), entry, |s| s.declaration.id);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reflection::preset;

    #[test]
    fn a_start_makes_no_meshes_and_parses_no_wgsl_of_what_ships() {
        const RUNS: u32 = 20;
        let once = || {
            let start = std::time::Instant::now();
            assert!(!Registry::builtin().has_foreign());
            start.elapsed()
        };
        // The fastest, since other tests run beside it.
        let each = (0..RUNS).map(|_| once()).min().expect("some");
        // Without optimisation; the finest teapot alone takes longer, and so does naga for any model.
        assert!(each < std::time::Duration::from_millis(10), "{each:?}");
    }

    #[test]
    fn the_files_that_ship_can_be_read() {
        let registry = Registry::builtin();
        let lights = registry.lights().iter().map(|light| light.parameters);
        let shapes = registry.shapes().iter().map(|shape| shape.parameters);
        let models = registry.models().iter().map(|model| model.parameters);
        for parameters in lights.chain(shapes).chain(models) {
            assert_eq!(check::shipped_files(parameters), Ok(()));
        }
    }

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
        // A base that is black on purpose must not blacken other metals.
        let lacquer = along(registry.model("ashikhmin_shirley").expect("built in"), gold, &registry);
        assert!(!lacquer.iter().any(|(name, _)| *name == crate::parameter::METALLIC.name), "{lacquer:?}");
    }
}
