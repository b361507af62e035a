//! One of several choices.

use std::borrow::Cow;

use serde_json::json;

use super::{
    Cursor, Encoding, Fields, Header, Json, Kind, Member, Parameter, ParameterKind, Payload, Place, Reader,
    Type, Value, header,
};
use crate::text::{did_you_mean, json::Ast, quoted};

/// The content of a value: the name in files.
pub type Given = Cow<'static, str>;
/// The field of a struct of parameters: the index.
pub type Field = u32;

/// Flags: choices between `false` and `true`.
pub mod flag {
    /// The field of a struct of parameters.
    pub type Field = bool;
}

/// One of several named choices. A [flag](ParameterKind::flag) is a choice between `false` and `true`.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    /// The choices: name in files, name in the window.
    pub options: &'static [(&'static str, &'static str)],
    /// Index of the default.
    pub default: usize,
}

impl ParameterKind {
    /// Yes or no: a JSON boolean in scene files, a checkbox in the window.
    #[must_use]
    pub const fn flag(default: bool) -> Self {
        Self::Choice(Choice { options: &[("false", "no"), ("true", "yes")], default: default as usize })
    }
}

impl Parameter {
    /// One of several choices, the name of each in files and that in the window; the default is an index.
    #[must_use]
    pub const fn choice(
        name: &'static str,
        options: &'static [(&'static str, &'static str)],
        default: usize,
    ) -> Self {
        Self::new(name, ParameterKind::Choice(Choice { options, default }))
    }

    /// Yes or no: `true` or `false` in scene files.
    ///
    /// ```
    /// use lights_camera_models::parameter::{Parameter, Value};
    /// const TWO_SIDED: Parameter = Parameter::flag("two_sided", true);
    /// assert_eq!(TWO_SIDED.parse("false"), Ok(Value::flag(false)));
    /// ```
    #[must_use]
    pub const fn flag(name: &'static str, default: bool) -> Self {
        Self::new(name, ParameterKind::flag(default))
    }
}

impl Choice {
    /// The choice with this name in files.
    fn named(&self, id: &str) -> Value {
        let known = self.options.iter().map(|(id, _)| *id).find(|known| *known == id);
        Value::Choice(known.map_or_else(|| Cow::Owned(id.to_owned()), Cow::Borrowed))
    }
}

impl Kind for Choice {
    fn name(&self) -> &'static str {
        if self.is_flag() { "flag" } else { "choice" }
    }

    fn default_value(&self) -> Value {
        Value::Choice(Cow::Borrowed(self.options[self.default].0))
    }

    fn rule(&self) -> String {
        if self.is_flag() {
            return "true or false".to_owned();
        }
        match self.options {
            [(first, _), .., (last, _)] if self.is_numbered() => format!("one of \"{first}\" to \"{last}\""),
            all => {
                let names: Vec<_> = all.iter().map(|(id, _)| format!("\"{id}\"")).collect();
                format!("one of {}", names.join(", "))
            }
        }
    }

    fn parse(&self, text: &str) -> Option<Value> {
        Some(self.named(text.trim()))
    }

    fn read(&self, reader: &mut dyn Reader, value: Cursor, rule: &str, _: Place) -> Option<Value> {
        if let Ast::NumberLit(number) = value.value
            && self.options.iter().any(|(id, _)| *id == number.value)
        {
            reader.wrong(value, &format!("{rule}, in quotes"));
            return None;
        }
        if !self.is_flag() {
            return reader.string(value, rule).map(|id| self.named(id));
        }
        if let Ast::BooleanLit(flag) = value.value {
            return Some(Value::flag(flag.value));
        }
        let is_quoted = value.text().is_some_and(|text| text.trim().parse::<bool>().is_ok());
        reader.wrong(value, &format!("{rule}{}", if is_quoted { ", without quotes" } else { "" }));
        None
    }

    fn schema(&self) -> Json {
        match self.is_flag() {
            true => json!({ "type": "boolean" }),
            false => one_of(self.options.iter().map(|(id, name)| [*id, *name, ""])),
        }
    }

    fn keys(&self) -> Vec<(&'static str, Json)> {
        let ids: Json = self.options.iter().map(|(id, _)| *id).collect();
        if self.is_flag() { Vec::new() } else { vec![("choices", ids)] }
    }

    fn check(&self) -> Result<(), String> {
        let Self { options, default } = self;
        if options.is_empty() {
            return Err("it has no choices, but needs at least one".to_owned());
        }
        for (i, (id, _)) in options.iter().enumerate() {
            if id.is_empty() || options[..i].iter().any(|(known, _)| known == id) {
                return Err(format!(
                    "the choice \"{id}\" is empty or given twice; each needs a name of its own"
                ));
            }
            // Files write these without quotes.
            if !self.is_flag() && id.parse::<bool>().is_ok() {
                return Err(format!(
                    "the choice \"{id}\" is a value of flags; use another name, or `Parameter::flag`"
                ));
            }
        }
        if *default >= options.len() {
            return Err(format!(
                "its default is choice {default}, but must be an index from 0 to {}",
                options.len() - 1
            ));
        }
        Ok(())
    }

    /// An index of no choice stays a number.
    fn of_field(&self, [first, ..]: [f32; 3], _: Encoding) -> Value {
        match self.options.get(first as usize) {
            Some((id, _)) => Value::Choice((*id).into()),
            None => Value::Integer(first as i64),
        }
    }

    fn mended(&self, value: &Value) -> Option<(Value, String)> {
        let Value::Integer(i) = value else { return None };
        let last = self.options.len().saturating_sub(1);
        Some((self.default_value(), format!("{i}, but the last choice is {last}")))
    }

    fn allows(&self, value: &Value) -> bool {
        matches!(value, Value::Choice(chosen) if self.options.iter().any(|(id, _)| id == chosen))
    }

    fn hint(&self, value: &Value) -> String {
        let Value::Choice(id) = value else { return String::new() };
        // Similar digits are not near numbers.
        if self.is_flag() || self.is_numbered() && id.trim().parse::<f64>().is_ok() {
            return String::new();
        }
        let names = self.options.iter().map(|(id, name)| (*name, *id));
        did_you_mean(id, names.chain(self.options.iter().map(|(id, _)| (*id, *id))))
    }

    fn ends(&self) -> Vec<Value> {
        self.options.iter().map(|(id, _)| Value::Choice(Cow::Borrowed(id))).collect()
    }

    fn random(&self, _: f32, within: f32, _: &mut dyn FnMut() -> f32) -> Value {
        let i = ((within * self.options.len() as f32) as usize).min(self.options.len() - 1);
        Value::Choice(self.options[i].0.into())
    }

    fn options(&self) -> &'static [(&'static str, &'static str)] {
        self.options
    }

    fn is_numbered(&self) -> bool {
        let number = |(id, _): &(&str, &str)| id.parse::<i64>().ok();
        let follows = |pair: &[(&str, &str)]| {
            number(&pair[0]).is_some_and(|one| number(&pair[1]) == one.checked_add(1))
        };
        self.options.len() > 2 && self.options.windows(2).all(follows)
    }

    fn is_flag(&self) -> bool {
        // The names in the window may differ.
        matches!(self.options, [("false", _), ("true", _)])
    }

    /// A distribution's name needs no label; “None” and “yes” alone mean nothing.
    fn caption(&self, label: &str, value: &Value) -> Option<String> {
        let Value::Choice(id) = value else { return None };
        let name = self.options.iter().find(|(known, _)| known == id).map_or(&**id, |(_, name)| *name);
        let name = name.split(" (").next().unwrap_or(name);
        Some(match name {
            _ if self.is_flag() => format!("{label}: {name}"),
            _ if name.eq_ignore_ascii_case("none") => format!("no {label}"),
            _ => name.to_owned(),
        })
    }

    fn wgsl(&self) -> &'static str {
        "u32"
    }

    fn words(&self, value: &Value, _: Encoding, to: &mut Vec<u32>) {
        to.push(index(self.options, value));
    }
}

/// The index of the chosen option; 0 if it is none of these.
fn index(options: &[(&str, &str)], value: &Value) -> u32 {
    let chosen = |(id, _): &(&str, &str)| matches!(value, Value::Choice(chosen) if id == chosen);
    options.iter().position(chosen).unwrap_or(0) as u32
}

/// The schema of one of several ids; editors show the names and summaries next to them.
pub(crate) fn one_of<'a>(choices: impl Iterator<Item = [&'a str; 3]>) -> Json {
    let (ids, descriptions): (Vec<_>, Vec<_>) = choices
        .map(|[id, name, summary]| match summary {
            "" => (id, name.to_owned()),
            summary => (id, format!("{name}: {summary}")),
        })
        .unzip();
    let mut schema = json!({ "type": "string", "enum": ids });
    if descriptions.iter().any(|words| !words.is_empty()) {
        schema["enumDescriptions"] = descriptions.into();
    }
    schema
}

/// The types in custom models.
pub(super) const TYPES: &[Type] = &[
    Type { name: "choice", keys: &["choices"], fits: header::has_choices, read: declared },
    Type { name: "flag", keys: &[], fits: has_flag, read: declared_flag },
];

fn has_flag(fields: &Fields) -> bool {
    let is_flag = |default: Cursor| matches!(default.value, Ast::BooleanLit(_));
    !header::has_choices(fields) && fields.get("default").is_some_and(is_flag)
}

fn declared(header: &mut Header) -> Option<ParameterKind> {
    let (mut options, usual) = match header.shared {
        Some(ParameterKind::Choice(known)) => (known.options, known.options[known.default].0),
        _ => (&[][..], ""),
    };
    if let Some(value) = header.fields.get("choices") {
        options = header.reader.choices(value)?;
    }
    if options.is_empty() {
        let why = "a choice needs some: [\"one\", \"other\"], or { \"one\": \"its name\" }";
        header.reader.lacking(header.fields, "choices", why);
        return None;
    }
    let ids: Vec<_> = options.iter().map(|(id, _)| *id).collect();
    let default = match header.fields.get("default") {
        Some(value) => header.reader.index(value, "the default", &ids)?,
        None => ids.iter().position(|id| *id == usual).unwrap_or(0),
    };
    Some(ParameterKind::Choice(Choice { options, default }))
}

fn declared_flag(header: &mut Header) -> Option<ParameterKind> {
    let usual = matches!(header.shared, Some(ParameterKind::Choice(Choice { default: 1, .. })));
    let rule = "it must be true or false";
    Some(ParameterKind::flag(header.reader.flag(header.fields, "default", usual, rule)))
}

impl Value {
    /// The value of a [flag](ParameterKind::flag).
    #[must_use]
    pub const fn flag(on: bool) -> Self {
        Self::Choice(Cow::Borrowed(if on { "true" } else { "false" }))
    }

    /// The value of a flag, or `None` if the value is not a flag's. No other choice has the names `true` and
    /// `false`.
    #[must_use]
    pub fn truth(&self) -> Option<bool> {
        match self {
            Self::Choice(id) => id.parse().ok(),
            _ => None,
        }
    }
}

/// The names of a flag, `true` and `false`, are written as booleans.
impl Payload for Cow<'static, str> {
    fn text(&self) -> String {
        self.to_string()
    }

    fn json(&self) -> Json {
        self.parse::<bool>().map_or_else(|_| self.as_ref().into(), Into::into)
    }

    fn written(&self) -> String {
        if self.parse::<bool>().is_ok() { self.to_string() } else { quoted(self) }
    }
}

impl Member for u32 {
    fn of(kind: &ParameterKind, value: &Value, _: Encoding) -> Self {
        index(kind.options(), value)
    }

    fn numbers(&self) -> [f32; 3] {
        [*self as f32; 3]
    }
}

impl Member for bool {
    fn of(kind: &ParameterKind, value: &Value, _: Encoding) -> Self {
        index(kind.options(), value) == 1
    }

    fn numbers(&self) -> [f32; 3] {
        [f32::from(*self); 3]
    }
}
