//! The ids of registered models and types.

use super::clause::Rule;
use crate::files::Shown as _;
use crate::{
    custom,
    declared::texts,
    light::LightEntry,
    parameter::Parameter,
    platform::fs,
    reflection::ModelEntry,
    registry::Registry,
    shading::ShadingEntry,
    shape::ShapeEntry,
    text::{self, detailed},
};

texts! {
    /// The registered things to which an id may refer.
    Ids(
        /// The name of what the ids refer to.
        name
    ) {
        /// Reflection models.
        ReflectionModel = "reflection model",
        /// Shading models.
        ShadingModel = "shading model",
        /// Light types.
        LightType = "light type",
        /// Object types.
        ObjectType = "object type",
    }
}

/// Something registered.
#[derive(Clone, Copy, Debug)]
pub struct Listed {
    /// The id.
    pub id: &'static str,
    /// The name for people.
    pub name: &'static str,
    /// One sentence about it.
    pub summary: &'static str,
    /// The parameters that it declares.
    pub parameters: &'static [Parameter],
}

macro_rules! listed {
    ($($Entry:ty),+) => {
        $(impl From<&$Entry> for Listed {
            fn from(entry: &$Entry) -> Self {
                let declaration = entry.declaration;
                Self {
                    id: declaration.id,
                    name: declaration.name,
                    summary: declaration.summary,
                    parameters: entry.parameters,
                }
            }
        })+
    };
}

listed!(ModelEntry, ShadingEntry, LightEntry, ShapeEntry);

impl Ids {
    /// Everything registered.
    #[must_use]
    pub fn all(self, registry: &Registry) -> Box<dyn Iterator<Item = Listed> + '_> {
        match self {
            Self::ReflectionModel => Box::new(registry.models().iter().map(Listed::from)),
            Self::ShadingModel => Box::new(registry.shading_models().iter().map(Listed::from)),
            Self::LightType => Box::new(registry.lights().iter().map(Listed::from)),
            Self::ObjectType => Box::new(registry.shapes().iter().map(Listed::from)),
        }
    }

    /// The entry that an id refers to.
    #[must_use]
    pub fn find(self, registry: &Registry, id: &str) -> Option<Listed> {
        self.all(registry).find(|listed| listed.id == id)
    }

    /// The ids of those that declare a parameter with a name.
    pub(super) fn having(self, parameter: &str, registry: &Registry) -> Vec<&'static str> {
        let has = |listed: &Listed| listed.parameters.iter().any(|p| p.name == parameter);
        self.all(registry).filter(has).map(|listed| listed.id).collect()
    }

    /// Checks that an id is registered.
    ///
    /// # Errors
    /// Returns the rule, with the nearest id, or the reason why a custom model is missing.
    pub fn check(self, registry: &Registry, id: &str) -> Rule {
        if self.find(registry, id).is_some() {
            return Ok(());
        }
        let known = self.all(registry).map(|listed| (listed.id, listed.name));
        let rule = one_of(&format!("the {}", self.name()), id, known);
        match self {
            Self::ReflectionModel => rule.map_err(|rule| missing_model(registry, id, rule)),
            _ => rule,
        }
    }
}

/// One of several ids: the rule lists them and names the nearest.
pub(super) fn one_of<'a>(what: &str, id: &str, known: impl Iterator<Item = (&'a str, &'a str)>) -> Rule {
    let known: Vec<_> = known.collect();
    if known.iter().any(|(known, _)| *known == id) {
        return Ok(());
    }
    let names = known.iter().map(|(k, name)| (*name, *k));
    let candidates = known.iter().map(|(k, _)| (*k, *k)).chain(names);
    Err(text::one_of(what, known.iter().map(|(k, _)| *k)) + &text::did_you_mean(id, candidates))
}

/// The rule that an unknown reflection model breaks: the file of a custom model may have an error, or be missing.
fn missing_model(registry: &Registry, id: &str, rule: String) -> String {
    match registry.broken_model(id) {
        Some(why) => format!("the file of that custom model has an error: {why}"),
        None => match custom_model_missing(registry, id) {
            Some(detail) => detailed(&rule, &detail),
            None => rule,
        },
    }
}

/// Details about an id without a model in the folder of custom models: its file may be missing, or not be a
/// model.
fn custom_model_missing(registry: &Registry, id: &str) -> Option<String> {
    let folder = registry.custom_folder().filter(|folder| fs::is_dir(folder) && custom::is_id(id))?;
    let file = folder.join(id).with_extension(custom::EXTENSION);
    let file_shown = file.shown();
    Some(if fs::is_file(&file) {
        format!(
            "{file_shown} is not a model: it neither begins with a comment /* lcm … */ nor defines fn response"
        )
    } else {
        format!("the folder of custom models has no {file_shown}")
    })
}
