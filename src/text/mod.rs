//! Words for messages, and JSON values with their positions.

use std::borrow::Cow;

pub mod expression;
pub mod identifier;
pub mod json;
mod list;
pub mod mathematics;
pub mod path;
pub mod place;
pub(crate) mod template;
mod words;
pub mod xml;

pub use list::{items, numbers};
pub use words::{
    behind, capitalised, detailed, did_you_mean, facts, listed, nearest, number, one_of, per_cent, plural,
    quoted, sentence, shortened, superscript, trimmed, with_article, wrapped,
};
pub(crate) use words::{is_hard_to_see, is_invisible, named_character};

/// The bytes of a UTF-8 text without the byte order mark that some programs write first.
pub(crate) fn after_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)
}

/// A text with the line ends of old Macintosh programs replaced by line feeds, at the same bytes.
pub(crate) fn with_line_feeds(text: &str) -> Cow<'_, str> {
    if text.contains('\r') && !text.contains('\n') { text.replace('\r', "\n").into() } else { text.into() }
}
