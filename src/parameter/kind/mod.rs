//! The kinds of parameters, a file each: all operations on a value, except for its knob in the window, which is in the
//! file of the same name in `panel/knob`.

use std::{fmt, ops::Deref, path::Path};

use bevy_reflect::Reflect;
use glam::Vec3;
use serde::{Serialize, Serializer};
use serde_json::Value as Json;

use super::{
    Outside, Parameter,
    limits::{self, ABOVE_ZERO, Limits},
};
use crate::{
    optics::colour::Encoding,
    text::{
        self,
        json::{Cursor, Fields, Reader},
    },
};

pub mod choice;
pub mod colour;
pub mod file;
mod header;
pub mod integer;
pub mod number;
pub mod triple;

pub use choice::flag;
pub use header::{Declarations, Header, Type};

/// Hands all kinds to a macro, each with its file.
macro_rules! every_kind {
    ($then:ident) => {
        $then! {
            number::Number, integer::Integer, colour::Colour, triple::Triple, choice::Choice, file::File
        }
    };
}
pub(crate) use every_kind;

/// The names of the numbers of a colour.
pub const RGB: [&str; 3] = ["red", "green", "blue"];

/// The folder of a scene file, and the files outside it that the scene may name.
pub type Place<'a> = (&'a Path, &'a Outside);

/// The operations of a kind of parameter. Values passed to them are of the kind, but perhaps not legal.
pub trait Kind {
    /// Name of the kind in messages and in the declarations of custom models.
    fn name(&self) -> &'static str;

    /// The value if the scene gives none.
    fn default_value(&self) -> Value;

    /// The legal values, as the end of a sentence: "must be between 0.5 and 1".
    fn rule(&self) -> String;

    /// The value in a text as typed on the command line, which may be out of range; files are in the current folder.
    fn parse(&self, text: &str) -> Option<Value>;

    /// The end of the rule for a text that is no value because its number is too large.
    fn excess(&self, _: &str) -> String {
        String::new()
    }

    /// The value in a scene file, which may be out of range. A value of another type is reported.
    fn read(&self, reader: &mut dyn Reader, value: Cursor, rule: &str, place: Place) -> Option<Value>;

    /// The part of the schema of scene files for the parameter.
    fn schema(&self) -> Json;

    /// The keys in the declaration of a custom model, besides the default.
    fn keys(&self) -> Vec<(&'static str, Json)> {
        Vec::new()
    }

    /// The mistake in its declaration.
    ///
    /// # Errors
    /// Returns the mistake and the remedy: "its range is …, but …".
    fn check(&self) -> Result<(), String> {
        Ok(())
    }

    /// The range of each of its numbers; `None` if it has no numbers.
    fn limits(&self) -> Option<Limits> {
        None
    }

    /// The number of numbers in a value.
    fn components(&self) -> usize {
        lanes(self.wgsl())
    }

    /// The names of its numbers if it has several. Tables call columns by the first letters.
    fn entries(&self) -> &'static [&'static str] {
        match self.components() {
            1 => &[],
            count => RGB.get(..count).unwrap_or(&RGB),
        }
    }

    /// The unit of a parameter of a custom model that gives none.
    fn unit(&self) -> &'static str {
        ""
    }

    /// True if its numbers are quantities in the unit of the parameter and in a range of the declaration.
    fn is_measured(&self) -> bool {
        self.options().is_empty()
    }

    /// The value with some of these numbers, as [`Payload::numbers`] has them.
    fn of_numbers(&self, _: [f64; 3]) -> Value {
        self.default_value()
    }

    /// The value of a field of [`parameters!`](crate::parameters).
    fn of_field(&self, numbers: [f32; 3], _: Encoding) -> Value {
        self.of_numbers(numbers.map(f64::from))
    }

    /// The legal value nearest to what [`of_field`](Self::of_field) makes of a field that has none, and what the
    /// field is, with its rule.
    fn mended(&self, _: &Value) -> Option<(Value, String)> {
        None
    }

    /// True if a value is legal.
    fn allows(&self, value: &Value) -> bool {
        let within = |limits: Limits| {
            value.numbers().iter().all(|v| v.is_finite() && (limits.min..=limits.max).contains(v))
        };
        self.limits().is_some_and(within)
    }

    /// The end of the message about an illegal value.
    fn hint(&self, _: &Value) -> String {
        String::new()
    }

    /// The legal value nearest to an illegal one, or the default if there is no nearest one because the value must be
    /// greater than 0.
    fn nearest(&self, value: &Value) -> Option<Value> {
        let (limits, numbers) = (self.limits()?, value.numbers());
        if self.components() == 1 && limits.is_above_zero() && numbers[0] < limits.min {
            return Some(self.default_value());
        }
        Some(self.of_numbers(numbers.map(|v| v.max(limits.min).min(limits.max))))
    }

    /// The ends of the range; of a choice, all options.
    fn ends(&self) -> Vec<Value> {
        let of = |limits: Limits| [limits.min, limits.top()].map(|end| self.of_numbers([end; 3])).to_vec();
        self.limits().map_or_else(Vec::new, of)
    }

    /// Values that differ enough from another to matter, the best first; not all are legal.
    fn others(&self, value: &Value) -> Vec<Value> {
        let Some(limits) = self.limits() else { return self.ends() };
        let (numbers, middle) = (value.numbers(), 0.5 * (limits.min + limits.top()));
        let scaled = |factor: f64| numbers.map(|v| factor * v);
        let all = [scaled(1.25), scaled(0.75), [middle; 3], numbers.map(|v| v + 0.5)];
        all.into_iter().map(|numbers| self.of_numbers(numbers)).collect()
    }

    /// A legal value for tests, from numbers between 0 and 1: `pick` chooses an end of the range or a value `within`
    /// it; `more` gives further numbers.
    fn random(&self, pick: f32, within: f32, more: &mut dyn FnMut() -> f32) -> Value {
        let Some(limits) = self.limits() else { return self.default_value() };
        let (low, high) = (limits.min as f32, limits.top() as f32);
        let inside = |t: f32| {
            let above = t * (high - low);
            f64::from((low + if limits.whole { above.trunc() } else { above }).clamp(low, high))
        };
        self.of_numbers(match pick {
            p if p < 0.15 => [limits.min; 3],
            p if p < 0.3 => [limits.far(); 3],
            _ if self.components() == 1 => [inside(within); 3],
            _ => [0; 3].map(|_: u8| inside(more())),
        })
    }

    /// The name of each choice in files, and that in the window.
    fn options(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// The name in the window of the choice with this name in files; `None` if there is none.
    fn option(&self, id: &str) -> Option<&'static str> {
        self.options().iter().find(|(known, _)| *known == id).map(|(_, name)| *name)
    }

    /// True if the choices have numbers, one after the other, in place of names.
    fn is_numbered(&self) -> bool {
        false
    }

    /// True if the choices are those of a [flag](ParameterKind::flag).
    fn is_flag(&self) -> bool {
        false
    }

    /// True if scene files have a text.
    fn is_text(&self) -> bool {
        self.limits().is_none() && !self.is_flag()
    }

    /// The value in captions, for a parameter with this label; `None` if it has no words.
    fn caption(&self, _label: &str, value: &Value) -> Option<String> {
        self.limits()?;
        let all = value.numbers().map(limits::number);
        let all = &all[..self.components()];
        Some(if all.iter().all(|one| *one == all[0]) {
            all[0].clone()
        } else {
            format!("({})", all.join(", "))
        })
    }

    /// The type in WGSL: `f32`, `u32`, or a vector of `f32`.
    fn wgsl(&self) -> &'static str {
        "f32"
    }

    /// The three numbers for calculation, linear for colours, if it has three.
    fn linear(&self, _: &Value, _: Encoding) -> Option<Vec3> {
        None
    }

    /// Adds the words that shaders read.
    fn words(&self, value: &Value, encoding: Encoding, to: &mut Vec<u32>) {
        match self.linear(value, encoding) {
            Some(all) => to.extend(all.to_array().map(f32::to_bits)),
            None => to.extend(value.numbers().iter().take(lanes(self.wgsl())).map(|v| (*v as f32).to_bits())),
        }
    }
}

/// The content of a [`Value`].
pub trait Payload {
    /// As typed on the command line: `0.5`, `255,128,0`.
    fn text(&self) -> String;

    /// As in scene files.
    fn json(&self) -> Json;

    /// As in scene files, for messages.
    fn written(&self) -> String {
        let text = self.text();
        if text.contains(',') { format!("[{}]", text.replace(',', ", ")) } else { text }
    }

    /// The numbers of the value, the last of them repeated; zeros for a choice or a file.
    fn numbers(&self) -> [f64; 3] {
        [0.0; 3]
    }
}

/// The type of a field of [`parameters!`](crate::parameters).
pub trait Member: Sized {
    /// The field, from a legal value.
    fn of(kind: &ParameterKind, value: &Value, encoding: Encoding) -> Self;

    /// The numbers of the field, one of them three times.
    fn numbers(&self) -> [f32; 3];

    /// The value of the field, legal or not; `None` for none.
    fn value(&self, kind: &ParameterKind, encoding: Encoding) -> Option<Value> {
        Some(kind.of_field(self.numbers(), encoding))
    }
}

macro_rules! define {
    ($($file:ident::$Kind:ident),+) => {
        /// Type, range and default of a parameter. The methods of [`Kind`] give everything that depends on the kind.
        #[derive(Clone, Debug, PartialEq)]
        pub enum ParameterKind {
            $(#[doc = concat!("See [`", stringify!($Kind), "`](", stringify!($file), "::", stringify!($Kind), ").")]
            $Kind($file::$Kind),)+
        }

        /// The value of a parameter, as in a scene file.
        #[derive(Clone, Debug, PartialEq, Reflect)]
        pub enum Value {
            $(#[doc = concat!("That of a [`", stringify!($Kind), "`](", stringify!($file), "::", stringify!($Kind), ").")]
            $Kind($file::Given),)+
        }

        impl Deref for ParameterKind {
            type Target = dyn Kind;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$Kind(kind) => kind,)+
                }
            }
        }

        impl ParameterKind {
            /// The types in the declarations of custom models.
            pub(crate) const TYPES: &[&[Type]] = &[$($file::TYPES),+];

            /// True if a value is of this kind, legal or not.
            #[must_use]
            pub fn owns(&self, value: &Value) -> bool {
                matches!((self, value), $((Self::$Kind(_), Value::$Kind(_)))|+)
            }
        }

        impl Deref for Value {
            type Target = dyn Payload;

            fn deref(&self) -> &Self::Target {
                match self {
                    $(Self::$Kind(held) => held,)+
                }
            }
        }

        impl Serialize for Value {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                match (self.truth(), self) {
                    (Some(flag), _) => serializer.serialize_bool(flag),
                    $((None, Self::$Kind(held)) => held.serialize(serializer),)+
                }
            }
        }
    };
}
every_kind!(define);

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text())
    }
}

impl ParameterKind {
    /// The number of a value, if the kind has a single one.
    #[must_use]
    pub fn number_of(&self, value: &Value) -> Option<f64> {
        (self.is_number() && self.owns(value)).then(|| value.numbers()[0])
    }

    /// True if it is a single number, perhaps a whole one.
    #[must_use]
    pub fn is_number(&self) -> bool {
        self.components() == 1 && self.limits().is_some()
    }
}

/// A value as scene files write it.
#[must_use]
pub fn json(value: &Value) -> Json {
    value.json()
}

/// The number of words of a WGSL type: `vec3<f32>` has three.
#[must_use]
pub fn lanes(wgsl: &str) -> usize {
    match wgsl.as_bytes() {
        [b'v', b'e', b'c', n @ b'2'..=b'4', ..] => usize::from(n - b'0'),
        _ => 1,
    }
}

/// Three numbers as text.
fn joined<T: ToString>(all: &[T; 3]) -> String {
    all.each_ref().map(ToString::to_string).join(",")
}

/// Checks the ends of a range.
fn check_range(min: f32, max: f32) -> Result<(), String> {
    if min.is_finite() && max.is_finite() && min <= max {
        return Ok(());
    }
    Err(format!("its range is {min} to {max}, but must be two finite numbers, the smaller one first"))
}
