//! The library of materials: those of the program, and the user's own in a folder.
//!
//! A material is a reflection model with values of its parameters and a name. The program has [measured](Origin::Measured)
//! ones, from [optical constants](crate::reflection::preset), and [presets](Origin::Preset), from
//! [example scenes](crate::scene::examples::looks). A user's own are small JSON files in a folder that can be shared:
//!
//! ```json
//! {
//!   "name": "Brushed gold",
//!   "description": "Gold with fine scratches along one direction.",
//!   "source": "matched by eye",
//!   "reflection_model": "ward",
//!   "material": { "alpha_x": 0.05, "alpha_y": 0.3 }
//! }
//! ```
//!
//! Parameters that a file leaves out have their defaults. A file with a mistake is [`Broken`], and hides no other.

use std::{
    path::{Path, PathBuf},
    sync::LazyLock,
};

use web_time::Instant;

use crate::{
    parameter::Values,
    reference::{self, LightSamples, Settings},
    reflection::preset,
    registry::Registry,
    scene::{
        Scene,
        examples::looks,
        load::{self, Defaults},
    },
};

mod folder;
mod read;
mod write;

pub use folder::{Broken, beside};
pub use read::from_bytes;
pub use write::{NotSaved, replace, save, to_json};

/// The extension of files.
pub const EXTENSION: &str = "json";
/// Maximum size of a file, bytes.
pub const MAX_BYTES: u64 = 64 << 10;
/// Maximum number of files that are read from a folder.
pub const MAX_FILES: usize = 1000;
/// Maximum number of problems named for a file.
pub const MAX_PROBLEMS: usize = 100;

/// Said where a material cannot be saved for lack of a folder.
pub(crate) const NO_FOLDER: &str =
    "There is no folder for materials: name one for models with `lcm --models FOLDER`.";

/// The model that shows a measured metal: it calculates with n and k.
const METAL: &str = "microfacet";
/// The model that shows a measured dielectric: a clear body of it.
const DIELECTRIC: &str = "glass";
/// Samples of light in a small picture.
const LIGHT_SAMPLES: LightSamples = LightSamples::of(64);

/// Where a material comes from, in the order of lists.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// A file of the user.
    File(PathBuf),
    /// Ready-made in an example scene.
    Preset,
    /// Calculated from measured optical constants.
    Measured,
}

impl Origin {
    /// The heading of such materials in lists.
    #[must_use]
    pub fn heading(&self) -> &'static str {
        match self {
            Self::File(_) => "Your materials",
            Self::Preset => "Presets",
            Self::Measured => "Measured materials",
        }
    }
}

/// A reflection model with values of its parameters, and a name.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name: "Gold".
    pub name: String,
    /// A description of one line, if there is one.
    pub description: Option<String>,
    /// Where the values come from, if that is known.
    pub source: Option<String>,
    /// The id of the reflection model.
    pub reflection_model: String,
    /// The given values of its parameters.
    pub material: Values,
    /// Where the material comes from.
    pub origin: Origin,
}

impl Material {
    /// A value for every parameter of the model; those not given have their defaults. None for an unknown model.
    #[must_use]
    pub fn values(&self, registry: &Registry) -> Values {
        let parameters = registry.model(&self.reflection_model).map_or(&[][..], |model| model.parameters);
        Values::each(parameters, |p| self.material.get(p))
    }

    /// True if its texts contain each of these words, in any case.
    #[must_use]
    pub fn matches(&self, words: &str) -> bool {
        let texts =
            [Some(&self.name), self.description.as_ref(), self.source.as_ref(), Some(&self.reflection_model)];
        let text = texts.into_iter().flatten().map(|text| text.to_lowercase()).collect::<Vec<_>>().join("\n");
        words.to_lowercase().split_whitespace().all(|word| text.contains(word))
    }

    /// The scene of its picture: a sphere of it under the one light of all such pictures, a studio of three softboxes.
    #[must_use]
    pub fn scene(&self, registry: &Registry) -> Scene {
        /// Read once; a test ensures that it is valid.
        static SPHERE: LazyLock<Scene> = LazyLock::new(|| {
            let text = include_str!("sphere.json");
            load::from_text(text, "sphere.json", &Registry::builtin(), Defaults::Refuse)
                .map_or_else(|_| Scene::default(), |loaded| loaded.scene)
        });
        let mut scene = SPHERE.clone();
        scene.reflection_model.clone_from(&self.reflection_model);
        for object in &mut scene.objects {
            object.material = self.values(registry);
        }
        scene
    }

    /// Draws [its scene](Self::scene) by the CPU renderer: a square picture of this many pixels across, red, green and
    /// blue, row by row from the top. `None` if it is not finished by `end`.
    #[must_use]
    pub fn picture(&self, side: u32, registry: &Registry, end: Instant) -> Option<Vec<u8>> {
        let settings = Settings { width: side, height: side, ..Settings::default() };
        reference::render_rgb8_until(&self.scene(registry), registry, &settings, LIGHT_SAMPLES, end)
    }
}

/// All materials, and the files that are none.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Library {
    /// The user's own by name, then presets, then measured ones.
    pub materials: Vec<Material>,
    /// Files with mistakes, by path.
    pub broken: Vec<Broken>,
}

impl Library {
    /// The materials of the program, and those in a folder. It need not exist.
    #[must_use]
    pub fn read(folder: Option<&Path>, registry: &Registry) -> Self {
        let mut library = folder.map_or_else(Self::default, |folder| folder::read(folder, registry));
        library.materials.sort_by_cached_key(|material| material.name.to_lowercase());
        library.materials.extend(built_in(registry));
        library
    }
}

/// The materials of the program whose models the registry has.
#[must_use]
pub fn built_in(registry: &Registry) -> Vec<Material> {
    let presets = looks().iter().map(|look| Material {
        name: look.name.clone(),
        description: Some(look.description.clone()),
        source: None,
        reflection_model: look.model.clone(),
        material: look.material.clone(),
        origin: Origin::Preset,
    });
    let measured = preset::all().iter().filter_map(|measured| {
        let model = registry.model(if measured.metal { METAL } else { DIELECTRIC })?;
        let mut material = Values::default();
        for (name, value) in (model.preset)(measured) {
            material.set(name, value);
        }
        Some(Material {
            name: measured.name.to_owned(),
            description: None,
            source: Some(measured.source.to_owned()),
            reflection_model: model.declaration.id.to_owned(),
            material,
            origin: Origin::Measured,
        })
    });
    presets.chain(measured).filter(|m| registry.model(&m.reflection_model).is_some()).collect()
}

#[cfg(test)]
mod tests;
