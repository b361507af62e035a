//! The text of a model's file: its declaration, its definitions, and the names that are allowed.

use crate::text::capitalised;
pub(super) use crate::{
    shader::definitions::{allowed_in_wgsl, block_comment, definition},
    text::identifier::{LONGEST_ID, identifier},
};

/// The word after `/*` that marks the declaration.
pub const MARKER: &str = "lcm";

/// Names of Greek letters, and the letters. Those before the empty line are in the symbols of parameters by default.
pub(super) const GREEK: &str = include_str!("greek.txt");

/// An error: its byte in the file, and the message.
pub(super) type Mistake = (usize, String);

/// The comment with the declaration, within a file.
pub(super) struct Comment<'a> {
    /// The text between the marker and the end.
    pub json: &'a str,
    /// The index of the first byte of that text.
    pub start: usize,
    /// The byte after the comment.
    pub end: usize,
}

/// Finds the declaration: the first thing in the file except for space and other comments.
pub(super) fn comment(text: &str) -> Result<Comment<'_>, Mistake> {
    let mut at = 0;
    loop {
        at = text.len() - text[at..].trim_start().len();
        let rest = &text[at..];
        if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
            continue;
        }
        if !rest.starts_with("/*") {
            let what = format!(
                "the declaration is missing; a model begins with a comment /* {MARKER} {{ \"name\": …, \"parameters\": […] }} */"
            );
            return Err((at.min(text.len()), what));
        }
        let Some(end) = block_comment(text, at) else {
            return Err((at, "the comment is not closed; its */ is missing".to_owned()));
        };
        let inside = &text[at + 2..end - 2];
        let word = inside.trim_start();
        if let Some(json) =
            word.strip_prefix(MARKER).filter(|j| !j.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
        {
            return Ok(Comment { json, start: end - 2 - json.len(), end });
        }
        at = end;
    }
}

/// An id as a name: `charlie_sheen` becomes Charlie sheen.
pub(super) fn humanised(id: &str) -> String {
    capitalised(&id.replace('_', " "))
}
