//! The parts of a scene: structs of declared [fields](Field).

use super::{
    Scene,
    error::Path,
    field::{Field, Ids, Kind},
    views::LETTERS,
};
use crate::{
    parameter::{Parameter, Value, Values},
    registry::Registry,
};

/// A part of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Part {
    /// Name, description and models.
    Scene,
    /// The extent of the room.
    Size,
    /// The observer.
    Observer,
    /// The conversion of light to the picture.
    Display,
    /// A light, by its index.
    Light(usize),
    /// An object, by its index.
    Object(usize),
    /// A variant, by its index: 0 is view B.
    Variant(usize),
    /// The comparison of the views.
    Comparison,
}

impl Part {
    /// The path in scene files.
    #[must_use]
    pub fn path(self) -> Path {
        let list = |key: &'static str, i| Path::root().key(key).index(i);
        match self {
            Self::Scene => Path::root(),
            Self::Size => Path::root().key("scene_size"),
            Self::Observer => Path::root().key("observer"),
            Self::Display => Path::root().key("display"),
            Self::Light(i) => list("lights", i),
            Self::Object(i) => list("objects", i),
            Self::Variant(i) => list("variants", i),
            Self::Comparison => Path::root().key("comparison"),
        }
    }

    /// The name of a step that changes a field, where the part decides on it alone. `label` is the name of the field;
    /// `name` is that of a light or an object.
    #[must_use]
    pub fn step(self, label: &str, name: &str) -> String {
        match self {
            Self::Scene => format!("{label} of the scene"),
            Self::Size => "Size of the room".to_owned(),
            Self::Observer => "Observer".to_owned(),
            Self::Comparison => "Comparison".to_owned(),
            Self::Display => label.to_owned(),
            Self::Light(_) | Self::Object(_) => format!("{label} of {name}"),
            Self::Variant(i) => format!("{label} of view {}", LETTERS.get(i + 1).unwrap_or(&"?")),
        }
    }
}

/// The name of a value within a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Key {
    /// A field, or a parameter of the part's type: their names differ.
    Own(&'static str),
    /// A parameter of the material.
    Material(&'static str),
}

impl Key {
    /// The name in scene files.
    #[must_use]
    pub fn name(self) -> &'static str {
        let (Self::Own(name) | Self::Material(name)) = self;
        name
    }

    /// The path of the value.
    #[must_use]
    pub fn within(self, part: Part) -> Path {
        match self {
            Self::Own(name) => part.path().key(name),
            Self::Material(name) => part.path().key("material").key(name),
        }
    }

    /// True if a field holds the value; a name of no field is that of a parameter.
    fn is_in(self, field: &Field, is_field: bool) -> bool {
        match (self, field.kind) {
            (Self::Material(_), kind) => matches!(kind, Kind::Material),
            (Self::Own(_), Kind::Parameters) => !is_field,
            (Self::Own(name), _) => field.key == name,
        }
    }
}

impl From<Field> for Key {
    fn from(field: Field) -> Self {
        Self::Own(field.key)
    }
}

/// The type of a field.
pub trait Held {
    /// The value; `None` if there is none. Texts and ids are choices.
    fn value(&self) -> Option<Value> {
        None
    }

    /// Sets the value; `None` removes it. False if it has another type.
    fn put(&mut self, _: Option<Value>) -> bool {
        false
    }

    /// The values of parameters, if the field holds those.
    fn values(&self) -> Option<&Values> {
        None
    }

    /// The values of parameters, to be changed.
    fn values_mut(&mut self) -> Option<&mut Values> {
        None
    }

    /// The parts, if the field holds those.
    fn parts(&self) -> Vec<&dyn Fields> {
        Vec::new()
    }

    /// The values, if the field holds a list of them.
    fn list(&self) -> &[Value] {
        &[]
    }
}

/// Visits a field, with what a part and the default part hold.
pub type Visit<'v, 'a> = &'v mut dyn FnMut(&'static Field, &'a dyn Held, &'static dyn Held);

/// The fields of one part.
pub trait Fields {
    /// Visits each field.
    fn each<'a>(&'a self, visit: Visit<'_, 'a>);

    /// Visits each field to change it.
    fn each_mut(&mut self, visit: &mut dyn FnMut(&'static Field, &mut dyn Held));

    /// The declaration of the field with a key.
    fn field(&self, key: &str) -> Option<&'static Field> {
        let mut found = None;
        self.each(&mut |field, _, _| found = found.or((field.key == key).then_some(field)));
        found
    }

    /// A value within the part; `None` if it has none.
    fn value(&self, key: Key) -> Option<Value> {
        let (mut found, is_field) = (None, self.field(key.name()).is_some());
        self.each(&mut |field, held, _| {
            if key.is_in(field, is_field) {
                found =
                    held.values().map_or_else(|| held.value(), |values| values.0.get(key.name()).cloned());
            }
        });
        found
    }

    /// Sets a value within the part; `None` removes it. False if there is no such field, or it has another type.
    fn put(&mut self, key: Key, value: Option<Value>) -> bool {
        let (mut good, field) = (false, self.field(key.name()));
        let value = match value {
            // A blank name is none.
            Some(Value::Choice(text)) if field.is_some_and(|field| matches!(field.kind, Kind::Text(_))) => {
                Some(text.trim()).filter(|text| !text.is_empty()).map(Value::from)
            }
            value => value,
        };
        self.each_mut(&mut |declared, held| {
            if key.is_in(declared, field.is_some()) {
                good = match (held.values_mut(), value.clone()) {
                    (Some(values), value) => {
                        values.0.remove(key.name());
                        values.0.extend(value.map(|value| (key.name().into(), value)));
                        true
                    }
                    (None, value) => held.put(value),
                };
            }
        });
        good
    }

    /// The parameters declared by the type of the part.
    fn parameters(&self, registry: &Registry) -> &'static [Parameter] {
        let mut declared: &[Parameter] = &[];
        self.each(&mut |field, held, _| {
            if let (Kind::Id(ids @ (Ids::LightType | Ids::ObjectType)), Some(Value::Choice(id))) =
                (field.kind, held.value())
            {
                declared = ids.find(registry, &id).map_or(declared, |listed| listed.parameters);
            }
        });
        declared
    }
}

/// A declared part.
pub trait Structure: Fields + Default {
    /// Name of the part in messages: "the observer".
    const WHAT: &'static str;
    /// Documentation of the part.
    const ABOUT: &'static str;
    /// The fields, in the order of writing.
    const FIELDS: &'static [&'static Field];

    /// The keys in scene files, without those of parameters.
    #[must_use]
    fn keys() -> Vec<&'static str> {
        Self::FIELDS.iter().map(|field| field.key).filter(|key| !key.is_empty()).collect()
    }
}

/// Declares a part of a scene: a struct, and for each field its documentation, perhaps another key, its type, its
/// declaration and its default. `Part::field` is the declaration.
macro_rules! part {
    (
        $(#[doc = $about:literal])+
        $(#[derive($($derive:ident),+)])?
        pub struct $Part:ident($what:literal) {
            $($(#[doc = $help:literal])+ $field:ident $([$key:literal])?: $type:ty = $declared:expr, $default:expr;)+
        }
    ) => {
        $crate::declared::with_defaults! {
            $(#[doc = $about])+
            #[derive(Clone, Debug, PartialEq $(, $($derive),+)?)]
            #[allow(rustdoc::broken_intra_doc_links)]
            pub struct $Part {
                $($(#[doc = $help])+ pub $field: $type = $default,)+
            }
        }

        #[allow(non_upper_case_globals)]
        impl $Part {
            $(
                #[doc = concat!("The declaration of `", stringify!($field), "`.")]
                pub const $field: $crate::scene::Field = $crate::scene::Field {
                    key: $crate::declared::key!($field $($key)?),
                    help: concat!($($help),+),
                    ..$declared
                };
            )+
        }

        impl $crate::scene::part::Fields for $Part {
            fn each<'a>(&'a self, visit: $crate::scene::part::Visit<'_, 'a>) {
                static DEFAULT: std::sync::LazyLock<$Part> = std::sync::LazyLock::new($Part::default);
                let default: &'static $Part = &DEFAULT;
                $(visit(&Self::$field, &self.$field, &default.$field);)+
            }

            fn each_mut(
                &mut self,
                visit: &mut dyn FnMut(&'static $crate::scene::Field, &mut dyn $crate::scene::part::Held),
            ) {
                $(visit(&Self::$field, &mut self.$field);)+
            }
        }

        impl $crate::scene::part::Held for $Part {
            fn parts(&self) -> Vec<&dyn $crate::scene::part::Fields> {
                vec![self]
            }
        }

        impl $crate::scene::part::Held for Vec<$Part> {
            fn parts(&self) -> Vec<&dyn $crate::scene::part::Fields> {
                self.iter().map(|part| part as &dyn $crate::scene::part::Fields).collect()
            }
        }

        impl $crate::scene::part::Structure for $Part {
            const WHAT: &'static str = $what;
            const ABOUT: &'static str = concat!($($about),+);
            const FIELDS: &'static [&'static $crate::scene::Field] = &[$(&Self::$field),+];
        }
    };
}
pub(super) use part;

/// Parts of a scene by reference, with the way to get an entry of a list.
macro_rules! part_of {
    ($scene:ident, $part:ident, $get:ident $(, $mut:tt)?) => {
        match $part {
            Part::Scene => Some($scene),
            Part::Size => Some(&$($mut)? $scene.scene_size),
            Part::Observer => Some(&$($mut)? $scene.observer),
            Part::Display => Some(&$($mut)? $scene.display),
            Part::Light(i) => Some($scene.lights.$get(i)?),
            Part::Object(i) => Some($scene.objects.$get(i)?),
            Part::Variant(i) => Some($scene.variants.$get(i)?),
            Part::Comparison => Some(&$($mut)? $scene.comparison),
        }
    };
}

impl Scene {
    /// A part of the scene.
    #[must_use]
    pub fn part(&self, part: Part) -> Option<&dyn Fields> {
        part_of!(self, part, get)
    }

    /// A part of the scene, to be changed.
    pub(crate) fn part_mut(&mut self, part: Part) -> Option<&mut dyn Fields> {
        part_of!(self, part, get_mut, mut)
    }
}
