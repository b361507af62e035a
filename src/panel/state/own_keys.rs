//! The keys that the user gave to commands in the settings.

use std::{collections::BTreeMap, fmt, sync::Arc};

use serde::{
    Deserialize, Deserializer, Serialize, Serializer,
    de::{MapAccess, Visitor},
};
use serde_json::Value as Json;

use super::Shortcut;

/// The keys of commands as they stand in the settings, right or wrong, so that nothing is lost when they are written
/// again.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum GivenKeys {
    /// The ids of commands with what was written for each, in the order of the file.
    List(Pairs),
    /// Something else.
    Other(Json),
}

/// The members of an object, those given twice included.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Pairs(pub Vec<(String, Json)>);

impl Default for GivenKeys {
    fn default() -> Self {
        Self::List(Pairs::default())
    }
}

impl GivenKeys {
    /// True if nothing is given.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        *self == Self::default()
    }
}

impl<'de> Deserialize<'de> for Pairs {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Members;
        impl<'de> Visitor<'de> for Members {
            type Value = Pairs;

            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("an object")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Pairs, A::Error> {
                let mut pairs = Vec::new();
                while let Some(pair) = map.next_entry()? {
                    pairs.push(pair);
                }
                Ok(Pairs(pairs))
            }
        }
        deserializer.deserialize_map(Members)
    }
}

impl Serialize for GivenKeys {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::List(Pairs(pairs)) => serializer.collect_map(pairs.iter().map(|(id, json)| (id, json))),
            Self::Other(json) => json.serialize(serializer),
        }
    }
}

/// The keys that replace the usual ones, by the ids of commands.
pub type Replaced = BTreeMap<String, Vec<Shortcut>>;

/// The keys of the user's own that are in force.
#[derive(Clone, Debug, Default)]
pub struct OwnKeys {
    /// Those among the [given](GivenKeys) ones; `None` until they have been checked.
    pub checked: Option<Arc<Replaced>>,
}

impl OwnKeys {
    /// True if a command whose id begins so has keys of its own.
    #[must_use]
    pub fn begin_with(&self, beginnings: &[&str]) -> bool {
        let begins = |id: &String| beginnings.iter().any(|beginning| id.starts_with(beginning));
        self.checked.as_ref().is_some_and(|own| own.keys().any(begins))
    }

    /// The keys of a command, if they replace the usual ones.
    #[must_use]
    pub fn of(&self, id: &str) -> Option<&[Shortcut]> {
        self.checked.as_ref()?.get(id).map(Vec::as_slice)
    }
}
