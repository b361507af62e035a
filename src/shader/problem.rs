//! A problem of a shader, in terms of its author's file.

use std::fmt;

/// A problem of a shader, located in the author's file.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct ShaderProblem {
    /// Path below the folder of shaders; for custom models, `models/` and the file name.
    pub file: String,
    /// Line in that file, from 1; 0 for a problem of the whole file, or of a folder.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// The line itself.
    pub source: String,
    /// The problem.
    pub message: String,
}

impl ShaderProblem {
    /// The file, as it is called in a message, with line and column if the problem has a place in it.
    #[must_use]
    pub fn place(&self, file: impl fmt::Display) -> String {
        match self.line {
            0 => file.to_string(),
            line => format!("{file}:{line}:{}", self.column),
        }
    }

    /// A problem at a byte of the text of a file.
    #[must_use]
    pub fn at(file: &str, text: &str, at: usize, message: String) -> Self {
        let mut at = at.min(text.len());
        while !text.is_char_boundary(at) {
            at -= 1;
        }
        let start = text[..at].rfind('\n').map_or(0, |i| i + 1);
        Self {
            file: file.to_owned(),
            line: text[..start].matches('\n').count() + 1,
            // Columns count characters.
            column: text[start..at].chars().count() + 1,
            source: text[start..].lines().next().unwrap_or_default().to_owned(),
            message,
        }
    }
}

impl fmt::Display for ShaderProblem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place(&self.file), self.message)
    }
}

impl std::error::Error for ShaderProblem {}
