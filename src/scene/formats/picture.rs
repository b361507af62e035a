//! The common code of pictures with an embedded scene, whatever their format.

use super::{Parsed, Source, json};
use crate::{
    files,
    registry::Registry,
    scene::{error::LoadError, load::MAX_FILE_BYTES},
    text::{listed, place::Lines, quoted},
};

/// The keyword of the text that contains the scene of a picture: JSON as in a scene file.
pub const SCENE_KEYWORD: &str = "lights-camera-models scene";
/// The way to make a picture with a scene, for messages.
pub(super) const WRITERS: &str = "pictures that this program writes have one, unless --no-scene is given";
/// Maximum number of keywords that a message lists.
const MOST_NAMED: usize = 3;
/// Maximum number of keywords that are remembered.
const MOST_KNOWN: usize = 1000;

/// The scene in a picture, whose text `find` returns; its second argument is the maximum size in bytes.
pub(super) fn parsed<'a>(
    source: &'a Source<'_>,
    registry: &'a Registry,
    find: fn(&[u8], u64) -> Result<String, String>,
) -> Result<Parsed<'a>, LoadError> {
    let failed = |what| LoadError::Picture { name: source.name.to_owned(), what };
    if source.bytes.is_empty() {
        return Err(failed(files::EMPTY.to_owned()));
    }
    let text = find(source.bytes, MAX_FILE_BYTES).map_err(failed)?;
    let text = source.derived(|| text);
    let empty = || failed("the scene in the picture is empty".to_owned());
    if text.trim().is_empty() {
        return Err(empty());
    }
    let parsed = json::parse(text, source, registry).map_err(|(at, what)| {
        let place = Lines::new(text).place(at);
        failed(format!(
            "the scene in the picture is not JSON: {what} (line {}, column {} of it)",
            place.line, place.column
        ))
    })?;
    Ok(parsed.ok_or_else(empty)?.without_places())
}

/// The text of a scene from its bytes, within the limit.
pub(super) fn text(bytes: &[u8], most: u64) -> Result<String, String> {
    if bytes.len() as u64 > most {
        return Err(format!("the scene in the picture {}", too_large(most)));
    }
    String::from_utf8(bytes.to_vec()).map_err(|_| format!("the scene in the picture {NOT_TEXT}"))
}

/// The end of a message about a scene that is not text.
pub(super) const NOT_TEXT: &str = "is damaged: it is not UTF-8 text";

/// The end of a message about a scene that is larger than allowed.
pub(super) fn too_large(most: u64) -> String {
    format!("is larger than {} MiB, the most allowed; it was not read", most >> 20)
}

/// The message for a file that ends before its scene.
pub(super) fn truncated() -> String {
    format!("the picture is truncated, and there is no scene in what is left; {WRITERS}")
}

/// The texts of a picture that are not its scene.
#[derive(Default)]
pub(super) struct Others(Vec<String>);

impl Others {
    /// Adds the keyword of a text. Of several with one keyword in a row, one counts.
    pub(super) fn add(&mut self, keyword: &[u8]) {
        let keyword = quoted(&String::from_utf8_lossy(keyword));
        if self.0.len() < MOST_KNOWN && self.0.last() != Some(&keyword) {
            self.0.push(keyword);
        }
    }

    /// The message for a complete picture without a scene, perhaps with other texts.
    pub(super) fn without_scene(mut self) -> String {
        let more = self.0.len().saturating_sub(MOST_NAMED);
        self.0.truncate(MOST_NAMED);
        if more > 0 {
            self.0.push(format!("{more} more"));
        }
        let only = if self.0.is_empty() {
            String::new()
        } else {
            format!(", only texts called {}", listed(&self.0, "and"))
        };
        format!("there is no scene in this picture{only}; {WRITERS}")
    }
}

/// The bytes before the first zero, and those after it.
pub(super) fn until_zero(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().position(|b| *b == 0)?;
    Some((&bytes[..end], &bytes[end + 1..]))
}
