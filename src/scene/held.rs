//! The types that fields of a scene have.

use glam::Vec3;

pub use super::part::Held;
use super::views::LETTERS;
use crate::{
    declared::from,
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    parameter::{Value, Values},
};

/// Types of fields, and the values that they hold.
macro_rules! held {
    ($($type:ty: |$held:ident| $get:expr, $value:pat => $put:expr;)+) => {
        $(impl Held for $type {
            fn value(&self) -> Option<Value> {
                let $held = self;
                Some($get)
            }

            fn put(&mut self, value: Option<Value>) -> bool {
                let new = if let Some($value) = value { $put } else { None };
                new.map(|new| *self = new).is_some()
            }
        })+
    };
}

held! {
    f32: |v| (*v).into(), Value::Number(v) => Some(v);
    u32: |n| (*n).into(), Value::Integer(n) => u32::try_from(n).ok();
    bool: |on| (*on).into(), value => value.truth();
    Vec3: |v| (*v).into(), Value::Triple(v) => Some(v.into());
    [u8; 3]: |rgb| (*rgb).into(), Value::Colour(rgb) => Some(rgb);
    String: |text| text.as_str().into(), Value::Choice(text) => Some(text.into_owned());
    // A view by its letter.
    usize: |view| LETTERS.get(*view).copied().unwrap_or("?").into(),
        Value::Choice(letter) => LETTERS.iter().position(|known| *known == letter).filter(|view| *view > 0);
}

impl<T: Word> Held for T {
    fn value(&self) -> Option<Value> {
        Some((*self).into())
    }

    fn put(&mut self, value: Option<Value>) -> bool {
        let Some(Value::Choice(word)) = value else { return false };
        T::of_word(&word).map(|new| *self = new).is_some()
    }
}

impl<T: Held + Default> Held for Option<T> {
    fn value(&self) -> Option<Value> {
        self.as_ref()?.value()
    }

    fn put(&mut self, value: Option<Value>) -> bool {
        let mut new = value.is_some().then(T::default);
        let good = new.as_mut().is_none_or(|new| new.put(value));
        if good {
            *self = new;
        }
        good
    }
}

impl Held for Values {
    fn values(&self) -> Option<&Values> {
        Some(self)
    }

    fn values_mut(&mut self) -> Option<&mut Values> {
        Some(self)
    }
}

impl Held for Vec<Value> {
    fn list(&self) -> &[Value] {
        self
    }
}

/// A choice that has a word in scene files.
pub trait Word: Copy + 'static {
    /// Every choice.
    const CHOICES: &'static [Self];

    /// Word, name and summary.
    fn about(self) -> [&'static str; 3];

    /// The choice with a word.
    #[must_use]
    fn of_word(word: &str) -> Option<Self> {
        Self::CHOICES.iter().copied().find(|choice| choice.about()[0] == word)
    }

    /// Word, name and summary of each choice.
    #[must_use]
    fn words() -> Vec<[&'static str; 3]> {
        Self::CHOICES.iter().map(|choice| choice.about()).collect()
    }
}

/// Choices with their names and summaries.
macro_rules! word {
    ($($type:ty: |$choice:ident| $name:expr, $summary:expr;)+) => {
        $(impl Word for $type {
            const CHOICES: &'static [Self] = &<$type>::ALL;

            fn about(self) -> [&'static str; 3] {
                let $choice = self;
                [$choice.id(), $name, $summary]
            }
        })+
    };
}
pub(super) use word;

word! {
    ToneMapping: |tone| tone.name(), tone.summary();
    Encoding: |encoding| encoding.id(), "";
    TermSelection: |terms| terms.id(), "";
}

// Values for edits.
from! {
    Value;
    f32: |v| Self::Number(v);
    u32: |n| Self::Integer(n.into());
    bool: |on| Self::flag(on);
    Vec3: |v| Self::Triple(v.into());
    [u8; 3]: |rgb| Self::Colour(rgb);
    &str: |text| Self::Choice(text.to_owned().into());
    String: |text| Self::Choice(text.into());
}

impl<T: Word> From<T> for Value {
    fn from(choice: T) -> Self {
        Self::Choice(choice.about()[0].into())
    }
}
