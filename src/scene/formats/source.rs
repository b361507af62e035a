//! The content of a file to be read.

use std::{cell::OnceCell, path::Path as FilePath};

use crate::{
    parameter::Outside,
    scene::{encoding::decode, error::LoadError},
    text::{after_mark, place::Place},
};

/// The content of a file to be read.
#[derive(Debug)]
#[non_exhaustive]
pub struct Source<'a> {
    /// The content.
    pub bytes: &'a [u8],
    /// The name in messages: the path of the file, or the name of a stream.
    pub name: &'a str,
    /// The folder of the files that a scene may name.
    pub folder: &'a FilePath,
    /// The files outside that folder that it may name.
    pub outside: &'a Outside,
    derived: OnceCell<String>,
}

impl<'a> Source<'a> {
    pub(in crate::scene) fn new(
        bytes: &'a [u8],
        (name, folder): (&'a str, &'a FilePath),
        outside: &'a Outside,
    ) -> Self {
        Self { bytes, name, folder, outside, derived: OnceCell::new() }
    }

    /// The content as text, without the byte order mark that some programs write: positions do not count it.
    ///
    /// # Errors
    /// Returns a [`LoadError`] if the content is not UTF-8, with a guess at the encoding, or if it is only
    /// white space.
    pub fn text(&self) -> Result<&str, LoadError> {
        let text = decode(after_mark(self.bytes), self.name)?;
        if text.trim().is_empty() {
            return Err(LoadError::Empty { name: self.name.to_owned() });
        }
        Ok(text)
    }

    /// A text derived from the content, created once, that lives as long as the source.
    pub(super) fn derived(&self, make: impl FnOnce() -> String) -> &str {
        self.derived.get_or_init(make)
    }

    /// The error for content that does not follow the syntax of this format: the position where reading
    /// stopped, and what was expected there.
    #[must_use]
    pub fn syntax_error(&self, format: &'static str, place: Place, what: impl Into<String>) -> LoadError {
        LoadError::Syntax { format, name: self.name.to_owned(), place, what: what.into() }
    }
}
