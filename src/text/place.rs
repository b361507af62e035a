//! Lines and columns in a text.

use std::fmt;

use serde::Serialize;

/// A position in a text. Both numbers count from 1; columns count characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
pub struct Place {
    /// The line.
    pub line: usize,
    /// The character in the line.
    pub column: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// Finds lines and columns. Built once per text; lookups are fast even in a single huge line.
pub struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
    /// The number of characters before each block of [`BLOCK`] bytes.
    characters: Vec<usize>,
}

/// Number of bytes between two counts.
const BLOCK: usize = 4096;

impl<'a> Lines<'a> {
    /// The lines of a text.
    #[must_use]
    pub fn new(text: &'a str) -> Self {
        let ends = text.bytes().enumerate().filter(|(_, b)| *b == b'\n').map(|(i, _)| i + 1);
        let starts = std::iter::once(0).chain(ends).collect();
        let mut count = 0;
        let characters = text
            .as_bytes()
            .chunks(BLOCK)
            .map(|block| {
                let before = count;
                count += starting(block);
                before
            })
            .collect();
        Self { text, starts, characters }
    }

    /// The number of characters that begin before a byte.
    fn characters_before(&self, at: usize) -> usize {
        let block = (at / BLOCK).min(self.characters.len().saturating_sub(1));
        let counted = self.characters.get(block).copied().unwrap_or_default();
        counted + starting(&self.text.as_bytes()[block * BLOCK..at])
    }

    /// Line and column of a byte.
    #[must_use]
    pub fn place(&self, at: usize) -> Place {
        let at = at.min(self.text.len());
        let line = self.starts.partition_point(|s| *s <= at);
        let start = self.starts[line - 1];
        Place { line, column: self.characters_before(at) - self.characters_before(start) + 1 }
    }
}

/// The number of characters that begin in a piece of UTF-8.
fn starting(bytes: &[u8]) -> usize {
    bytes.iter().filter(|b| (**b & 0xC0) != 0x80).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_count_characters() {
        let text = "ab\n„ö“ x\n";
        let lines = Lines::new(text);
        assert_eq!(lines.place(text.find('x').unwrap_or(0)), Place { line: 2, column: 5 });
        assert_eq!(lines.place(0), Place { line: 1, column: 1 });
        assert_eq!(lines.place(text.len()), Place { line: 3, column: 1 });
        assert_eq!(lines.place(1000), Place { line: 3, column: 1 });
        let long = format!("{}x", "é".repeat(10_000));
        assert_eq!(Lines::new(&long).place(20_000), Place { line: 1, column: 10_001 });
        assert_eq!(Lines::new("").place(0), Place { line: 1, column: 1 });
    }
}
