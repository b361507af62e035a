//! A file of numbers.

use std::path::Path;

use serde_json::json;

use super::{
    super::file::{FileFormat, NamedFile, Table},
    Cursor, Encoding, Json, Kind, Member, Parameter, ParameterKind, Payload, Place, Reader, Type, Value,
};
use crate::text::quoted;

/// The content of a value.
pub type Given = NamedFile;
/// The field of a struct of parameters.
pub type Field = Table;

/// A file of numbers, given by its name relative to the folder of the scene file. Light types and object types may have
/// such parameters, and a reflection model one.
#[derive(Clone, Debug, PartialEq)]
pub struct File {
    /// The files that are legal.
    pub format: &'static FileFormat,
    /// The name of the shipped file that is the value if the scene gives none.
    pub default: &'static str,
}

impl ParameterKind {
    /// The files that are legal, if it is a file.
    #[must_use]
    pub const fn format(&self) -> Option<&'static FileFormat> {
        match self {
            Self::File(file) => Some(file.format),
            _ => None,
        }
    }
}

impl Parameter {
    /// A file of numbers, for light types, object types and reflection models; the default is the name of a file that is shipped with the format.
    #[must_use]
    pub const fn file(name: &'static str, format: &'static FileFormat, default: &'static str) -> Self {
        Self::new(name, ParameterKind::File(File { format, default }))
    }
}

impl Kind for File {
    fn name(&self) -> &'static str {
        "file"
    }

    fn default_value(&self) -> Value {
        Value::File(NamedFile::shipped(self.default, self.format))
    }

    fn rule(&self) -> String {
        format!("the name of {}", self.format.name)
    }

    fn parse(&self, text: &str) -> Option<Value> {
        Some(Value::File(NamedFile::named(text, Path::new(""), self.format)))
    }

    fn read(&self, reader: &mut dyn Reader, value: Cursor, rule: &str, place: Place) -> Option<Value> {
        let (folder, outside) = place;
        let name = reader.string(value, rule)?;
        Some(Value::File(NamedFile::allowed(name, folder, self.format, outside)))
    }

    fn schema(&self) -> Json {
        json!({ "type": "string" })
    }

    fn check(&self) -> Result<(), String> {
        let Self { format, default } = self;
        if format.shipped.iter().any(|(name, _)| name == default) {
            return Ok(());
        }
        Err(format!("its default is the file \"{default}\", but must be one that its format ships"))
    }

    fn allows(&self, value: &Value) -> bool {
        matches!(value, Value::File(file) if file.is_in(self.format) && file.numbers().is_some())
    }

    fn hint(&self, value: &Value) -> String {
        let Value::File(file) = value else { return String::new() };
        if file.name().is_empty() {
            return ": the name is empty".to_owned();
        }
        file.problem().map_or_else(String::new, |problem| format!(" that can be used: {problem}"))
    }

    /// The name of the file says what it is, whatever its folder.
    fn caption(&self, _: &str, value: &Value) -> Option<String> {
        let Value::File(file) = value else { return None };
        Some(file.short_name().into_owned())
    }

    fn wgsl(&self) -> &'static str {
        "u32"
    }
}

/// Custom models have no files.
pub(super) const TYPES: &[Type] = &[];

impl Payload for NamedFile {
    fn text(&self) -> String {
        self.name().to_owned()
    }

    fn json(&self) -> Json {
        self.name().into()
    }

    fn written(&self) -> String {
        quoted(self.name())
    }
}

impl Member for Table {
    fn of(_: &ParameterKind, value: &Value, _: Encoding) -> Self {
        let Value::File(file) = value else { return Self::default() };
        file.numbers().map_or_else(Self::default, |numbers| Self { file: Some(file.clone()), numbers })
    }

    fn numbers(&self) -> [f32; 3] {
        [0.0; 3]
    }

    fn value(&self, _: &ParameterKind, _: Encoding) -> Option<Value> {
        self.file.clone().map(Value::File)
    }
}
