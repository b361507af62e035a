//! Scenes and their parts for [serde], in the structure of scene files in JSON and with the same reader and
//! writer: a program that stores a scene in another format, or sends it, has the same keys and the same
//! messages.
//!
//! `Serialize` and `Deserialize` know the built-in types. For other types, [`SceneIn`] and [`SceneOf`] take a
//! registry. A whole scene is checked when it is read; a single [part](Light) only for keys and types, since
//! a scene decides whether a position is in its room.

use std::{fmt::Display as Shown, sync::LazyLock};

use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{DeserializeSeed, Error as _},
};

use super::{
    Display, Light, Object, Observer, Scene, SceneSize,
    error::Problem,
    load::{self, Defaults},
    part::Fields,
    read,
    write::Written,
};
use crate::{
    parameter::{Parameter, Value},
    registry::Registry,
    text::{behind, listed},
};

/// The built-in types.
static BUILT_IN: LazyLock<Registry> = LazyLock::new(Registry::builtin);

/// A scene to be written with the types of a registry.
///
/// ```
/// use lights_camera_models::{registry::Registry, scene::{Scene, SceneIn, SceneOf}};
/// use serde::de::DeserializeSeed as _;
///
/// let registry = Registry::builtin();
/// let text = serde_json::to_string(&SceneIn(&Scene::default(), &registry))?;
/// let back = SceneOf(&registry).deserialize(&mut serde_json::Deserializer::from_str(&text))?;
/// assert_eq!(back, Scene::default());
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SceneIn<'a>(pub &'a Scene, pub &'a Registry);

/// Reads a scene with the types of a registry. Files that it names are looked for in the current folder.
#[derive(Clone, Copy, Debug)]
pub struct SceneOf<'a>(pub &'a Registry);

impl Serialize for SceneIn<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        written(&*self.0.gathered(self.1), self.1, serializer)
    }
}

impl<'de> DeserializeSeed<'de> for SceneOf<'_> {
    type Value = Scene;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Scene, D::Error> {
        let text = text(deserializer)?;
        match load::from_text(&text, "", self.0, Defaults::Use) {
            Ok(loaded) => Ok(loaded.scene),
            Err(error) => Err(of(error.problems())),
        }
    }
}

impl Serialize for Scene {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        SceneIn(self, &BUILT_IN).serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Scene {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        SceneOf(&BUILT_IN).deserialize(deserializer)
    }
}

fn written<S: Serializer>(part: &dyn Fields, registry: &Registry, serializer: S) -> Result<S::Ok, S::Error> {
    let materials: Vec<_> = registry.material_parameters().collect();
    Written { part, schema: None, materials: &materials, registry }.serialize(serializer)
}

/// Parts of a scene, with the methods that read them.
macro_rules! parts {
    ($($Part:ty: $read:ident;)+) => {
        $(impl Serialize for $Part {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                written(self, &BUILT_IN, serializer)
            }
        }

        impl<'de> Deserialize<'de> for $Part {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                let text = text(deserializer)?;
                read::alone(&text, &BUILT_IN, |reader, value| reader.$read(value)).map_err(of)
            }
        })+
    };
}

parts! { SceneSize: part; Light: light; Observer: part; Object: object; Display: part; }

/// Reads a value of this parameter: its declaration determines the meaning of a number or a list.
impl<'de> DeserializeSeed<'de> for &Parameter {
    type Value = Value;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        use serde_json::Value as Json;
        let json = Json::deserialize(deserializer)?;
        let (is_flag, is_text) = (self.kind.is_flag(), self.kind.is_text());
        let written = match &json {
            Json::String(text) if is_text => Some(text.clone()),
            Json::Bool(_) if is_flag => Some(json.to_string()),
            Json::Number(_) if !is_text => Some(json.to_string()),
            Json::Array(list) if !is_text && list.iter().all(Json::is_number) => Some(json.to_string()),
            _ => None,
        };
        let found = |rule: &dyn Shown| D::Error::custom(format!("{} {rule}", self.name));
        match written {
            Some(text) => self.parse(&text).map_err(|error| found(&error)),
            None => Err(found(&format!("is {json}, but {}", behind(self.name, &self.clause())))),
        }
    }
}

/// The content of a deserializer as JSON, for the reader.
fn text<'de, D: Deserializer<'de>>(deserializer: D) -> Result<String, D::Error> {
    Ok(serde_json::Value::deserialize(deserializer)?.to_string())
}

/// Problems as the error of a deserializer. Positions would refer to a text that nobody wrote.
fn of<E: serde::de::Error>(problems: Vec<Problem>) -> E {
    let each: Vec<_> = problems.into_iter().map(|p| Problem { place: None, ..p }.to_string()).collect();
    E::custom(listed(&each, "and"))
}
