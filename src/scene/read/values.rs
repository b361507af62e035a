//! The values of a scene, by type.

use std::borrow::Cow;

use glam::Vec3;

use super::Reader;
use crate::{
    parameter::{NamedFile, Parameter, ParameterKind, Value},
    scene::check,
    text::json::{Ast, Cursor, Fields, Reader as _},
};

impl Reader<'_> {
    /// A declared parameter, if the value has its type. Its range is checked later.
    pub(super) fn parameter(&mut self, value: Cursor, parameter: &'static Parameter) -> Option<Value> {
        let rule = parameter.clause();
        match parameter.kind {
            ParameterKind::Number { .. } => self.number(value, &rule).map(Value::Number),
            ParameterKind::Integer { .. } => self.integer(value, &rule).map(Value::Integer),
            ParameterKind::Colour { .. } => self.colour(value, &rule).map(Value::Colour),
            ParameterKind::Triple { .. } => self.triple(value, &rule).map(Value::Triple),
            ParameterKind::Choice { .. } if parameter.is_flag() => self.truth(value, &rule).map(Value::flag),
            ParameterKind::Choice { options, .. } => {
                let id = self.string(value, &rule)?;
                let known = options.iter().map(|(id, _)| *id).find(|known| *known == id);
                Some(Value::Choice(known.map_or_else(|| Cow::Owned(id.to_owned()), Cow::Borrowed)))
            }
            ParameterKind::File { format, .. } => {
                let name = self.string(value, &rule)?;
                Some(Value::File(NamedFile::named(name, self.folder, format)))
            }
        }
    }

    /// The entries of a list of lights or objects. If the list is too long, only its length is reported,
    /// because it may be very long.
    pub(super) fn list<T>(
        &mut self,
        scene: &Fields,
        key: &'static str,
        count: fn(usize) -> check::Rule,
        mut read: impl FnMut(&mut Self, Cursor) -> T,
    ) -> Vec<T> {
        let why = format!("a scene must have a list of {key}");
        let Some(value) = scene.get(key) else {
            self.lacking(scene, key, &why);
            return Vec::new();
        };
        let rule = match value.list() {
            Some(list) => match count(list.len()) {
                Ok(()) => return list.map(|entry| read(self, entry)).collect(),
                Err(rule) => rule,
            },
            None => why,
        };
        self.wrong(value, &rule);
        Vec::new()
    }

    /// A number in 32 bits; a number that is too large becomes infinite, so that its rule rejects it.
    pub(super) fn number(&mut self, value: Cursor, rule: &str) -> Option<f32> {
        let number = value.number();
        if number.is_none() {
            self.wrong(value, &needs("a number", value, rule));
        }
        number
    }

    /// A whole number.
    pub(super) fn integer(&mut self, value: Cursor, rule: &str) -> Option<i64> {
        let integer = value.integer();
        if integer.is_none() {
            let rule = match value.value {
                Ast::NumberLit(_) => rule.to_owned(),
                _ => needs("a whole number", value, rule),
            };
            self.wrong(value, &rule);
        }
        integer
    }

    /// A boolean.
    fn truth(&mut self, value: Cursor, rule: &str) -> Option<bool> {
        if let Ast::BooleanLit(flag) = value.value {
            return Some(flag.value);
        }
        let quoted = value.text().is_some_and(|text| text.trim().parse::<bool>().is_ok());
        self.wrong(value, &format!("{rule}{}", if quoted { ", without quotes" } else { "" }));
        None
    }

    /// Three numbers; NaN if they could not be read.
    pub(super) fn vector(&mut self, value: Cursor, rule: impl Fn() -> String) -> Vec3 {
        let Some(list) = value.list().filter(|list| list.len() == 3) else {
            self.wrong(value, &rule());
            return Vec3::NAN;
        };
        let mut vector = Vec3::NAN;
        let mut good = true;
        for (i, element) in list.enumerate() {
            match element.number() {
                Some(number) => vector[i] = number,
                None => {
                    good = false;
                    self.wrong(element, &rule());
                }
            }
        }
        if !good {
            self.reported.insert(value.path());
            return Vec3::NAN;
        }
        vector
    }

    /// Three numbers, or one for all three.
    fn triple(&mut self, value: Cursor, rule: &str) -> Option<[f32; 3]> {
        match value.list() {
            None if value.number().is_some() => value.number().map(|v| [v; 3]),
            Some(list) if list.len() == 3 => {
                let mut triple = [Some(0.0); 3];
                for (to, element) in triple.iter_mut().zip(list) {
                    *to = self.number(value.holding(element.value), rule);
                }
                let [r, g, b] = triple;
                Some([r?, g?, b?])
            }
            _ => {
                self.wrong(value, rule);
                None
            }
        }
    }

    /// Three whole numbers from 0 to 255.
    pub(super) fn colour(&mut self, value: Cursor, rule: &str) -> Option<[u8; 3]> {
        let Some(list) = value.list().filter(|list| list.len() == 3) else {
            let hint = value.text().and_then(hexadecimal);
            let hint = hint.map_or_else(String::new, |[r, g, b]| format!("; write [{r}, {g}, {b}]"));
            self.wrong(value, &format!("{rule}{hint}"));
            return None;
        };
        let mut colour = [Some(0); 3];
        for (to, element) in colour.iter_mut().zip(list) {
            *to = element.integer().and_then(|v| u8::try_from(v).ok());
            if to.is_none() {
                self.wrong(element, rule);
            }
        }
        let [r, g, b] = colour;
        Some([r?, g?, b?])
    }
}

/// The message that a value of another type is needed.
fn needs(what: &str, value: Cursor, rule: &str) -> String {
    match value.text() {
        Some(text) if text.trim().parse::<f64>().is_ok() => {
            format!("it must be {what}, without quotes: {rule}")
        }
        _ => format!("it must be {what}: {rule}"),
    }
}

/// `#ff8000` as three numbers.
fn hexadecimal(text: &str) -> Option<[u8; 3]> {
    let digits = text.strip_prefix('#').filter(|d| d.len() == 6 && d.is_ascii())?;
    let channel = |i: usize| u8::from_str_radix(&digits[i..i + 2], 16).ok();
    Some([channel(0)?, channel(2)?, channel(4)?])
}
