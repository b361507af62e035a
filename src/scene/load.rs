//! Reading scene files: from bytes on disk to a checked [`Scene`], with an error for everything that
//! can be wrong (R2, R5, R6) and a question for what is missing (R3).

use std::{
    collections::BTreeSet,
    fmt,
    hash::{DefaultHasher, Hash as _, Hasher as _},
    io::Read,
    path::Path as FilePath,
};

use serde::{Deserialize as _, de::IgnoredAny};

use super::{
    Scene,
    error::{LoadError, Path, Place, Problem},
    read,
};
use crate::{files, registry::Registry, text::place::Lines};

/// Larger files are refused before they are read. The largest legal scene, with every parameter of
/// 10 000 objects given, is less than a tenth of this.
pub const MAX_FILE_BYTES: u64 = 64 << 20;
/// The name of standard input in messages.
pub const STDIN: &str = "standard input";
/// JSON may be nested this deep. Scenes need four levels.
const MAX_DEPTH: usize = 64;

/// What happens when scene size, reflection model or shading model are missing (R3).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Defaults {
    /// The caller asks: [`Loaded::missing`] says which, and the scene has the defaults already.
    #[default]
    Ask,
    /// They are used without asking. [`Loaded::missing`] still says which.
    Use,
    /// It is an error that names the ways to say yes.
    Refuse,
}

/// A part that is missing and for which there is a default.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Missing {
    /// Which one: `scene_size`, `scene_size.depth`, `reflection_model`, `shading_model`.
    pub path: Path,
    /// The default, as people read it: `lambert`, `10 × 10 × 10 m`.
    pub default: String,
    /// Where in the file it belongs: the beginning of the object that lacks it.
    pub place: Option<Place>,
}

impl fmt::Display for Missing {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} (default: {})", self.path, self.default)
    }
}

impl Missing {
    /// The same as a problem.
    #[must_use]
    pub fn problem(&self) -> Problem {
        let predicate = format!("is missing; --use-defaults takes the default, {}", self.default);
        Problem { place: self.place, ..Problem::about(self.path.clone(), predicate) }
    }
}

/// The state of a file, to notice that someone else changed it: its length and a hash of its content.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
pub struct Stamp {
    length: u64,
    hash: u64,
}

impl Stamp {
    /// The stamp of a content.
    #[must_use]
    pub fn of(bytes: &[u8]) -> Self {
        let mut hasher = DefaultHasher::new();
        bytes.hash(&mut hasher);
        Self { length: bytes.len() as u64, hash: hasher.finish() }
    }
}

/// A scene that was read: valid, but for the answer to what is [`missing`](Self::missing).
#[derive(Clone, Debug, PartialEq)]
pub struct Loaded {
    /// The scene, with defaults where parts are missing.
    pub scene: Scene,
    /// The parts that were missing, in the order of the scene file.
    pub missing: Vec<Missing>,
    /// The state of the file when it was read.
    pub stamp: Stamp,
}

/// Reads a scene from a regular file.
///
/// # Errors
/// [`LoadError`]; its text names the file as `path` does.
pub fn file(path: &FilePath, registry: &Registry, defaults: Defaults) -> Result<Loaded, LoadError> {
    from_bytes(&bytes(path)?, &path.display().to_string(), registry, defaults)
}

/// Reads the content of what a command line names: a file, or a stream such as `/dev/stdin`.
///
/// # Errors
/// [`LoadError`]; its text names it as `path` does.
pub fn input_bytes(path: &FilePath) -> Result<Vec<u8>, LoadError> {
    files::read_input(path, MAX_FILE_BYTES).map_err(|e| LoadError::from_file(path, e))
}

/// Reads the content of a scene file, whatever it is.
///
/// # Errors
/// [`LoadError`] when it is no regular file, too large, or cannot be read.
pub fn bytes(path: &FilePath) -> Result<Vec<u8>, LoadError> {
    files::read(path, MAX_FILE_BYTES).map_err(|e| LoadError::from_file(path, e))
}

/// Reads a scene from a stream, for example [standard input](STDIN).
///
/// # Errors
/// [`LoadError`] with `name` as the name of the file.
pub fn reader(
    from: impl Read,
    name: &str,
    registry: &Registry,
    defaults: Defaults,
) -> Result<Loaded, LoadError> {
    from_bytes(&all_of(from, name)?, name, registry, defaults)
}

/// The ids of the reflection models that a scene names, whether they are known or not and whatever else is wrong
/// with it; none of what is not JSON.
#[must_use]
pub fn models_named(bytes: &[u8], registry: &Registry) -> BTreeSet<String> {
    let text = decode(bytes, "").ok().filter(|text| check_syntax(text).is_ok());
    text.map_or_else(BTreeSet::new, |text| read::models_named(text, registry))
}

/// Reads the content of a stream, which can be read once.
///
/// # Errors
/// [`LoadError`] when it is too large for a scene, or cannot be read.
pub fn all_of(from: impl Read, name: &str) -> Result<Vec<u8>, LoadError> {
    let failed = |source| LoadError::Io { name: name.to_owned(), source };
    let mut bytes = Vec::new();
    // A stream does not say how long it is.
    from.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(LoadError::TooLarge { name: name.to_owned() });
    }
    Ok(bytes)
}

/// Reads a scene from the content of a file; `name` is what messages call it.
///
/// # Errors
/// [`LoadError`].
pub fn from_bytes(
    bytes: &[u8],
    name: &str,
    registry: &Registry,
    defaults: Defaults,
) -> Result<Loaded, LoadError> {
    let text = decode(bytes, name)?;
    if text.trim().is_empty() {
        return Err(LoadError::Empty { name: name.to_owned() });
    }
    check_syntax(text).map_err(|(at, what)| LoadError::Syntax {
        name: name.to_owned(),
        place: Lines::new(text).place(at),
        what,
    })?;
    let (scene, missing) = read::scene(text, name, registry, defaults)?;
    if defaults == Defaults::Refuse && !missing.is_empty() {
        return Err(LoadError::Missing { name: name.to_owned(), missing });
    }
    Ok(Loaded { scene, missing, stamp: Stamp::of(bytes) })
}

/// Reads a scene from text: [`from_bytes`].
///
/// # Errors
/// [`LoadError`].
pub fn from_text(
    text: &str,
    name: &str,
    registry: &Registry,
    defaults: Defaults,
) -> Result<Loaded, LoadError> {
    from_bytes(text.as_bytes(), name, registry, defaults)
}

/// The text of the bytes, or what they are instead.
fn decode<'a>(bytes: &'a [u8], name: &str) -> Result<&'a str, LoadError> {
    let not_text = |at: usize, what: String| {
        // Everything before the first wrong byte is text.
        let before = std::str::from_utf8(&bytes[..at]).unwrap_or_default();
        LoadError::NotUtf8 { name: name.to_owned(), place: Lines::new(before).place(at), what }
    };
    let first = |what: &str| Err(not_text(0, what.to_owned()));
    let magic: [(&[u8], &str); 9] = [
        (b"\xEF\xBB\xBF", "the file begins with a byte order mark (EF BB BF); save it as UTF-8 without one"),
        (b"\xFF\xFE\0\0", "the file is UTF-32; save it as UTF-8"),
        (b"\0\0\xFE\xFF", "the file is UTF-32; save it as UTF-8"),
        (b"\xFF\xFE", "the file is UTF-16 (little-endian); save it as UTF-8"),
        (b"\xFE\xFF", "the file is UTF-16 (big-endian); save it as UTF-8"),
        (b"\x89PNG", "the file is a PNG picture, not a scene"),
        (b"\xFF\xD8\xFF", "the file is a JPEG picture, not a scene"),
        (b"\x1F\x8B", "the file is compressed (gzip); unpack it first"),
        (b"PK\x03\x04", "the file is a ZIP archive; unpack it first"),
    ];
    if let Some((_, what)) = magic.iter().find(|(start, _)| bytes.starts_with(start)) {
        return first(what);
    }
    // JSON begins with an ASCII character; in UTF-16 a zero byte is beside it.
    if let [a, b, ..] = bytes
        && (*a == 0) != (*b == 0)
    {
        return first("the file seems to be UTF-16; save it as UTF-8");
    }
    if let Some(at) = bytes.iter().position(|b| *b == 0)
        && std::str::from_utf8(&bytes[..at]).is_ok()
    {
        return Err(not_text(at, "there is a zero byte; the file is binary, or damaged".to_owned()));
    }
    std::str::from_utf8(bytes).map_err(|e| {
        let at = e.valid_up_to();
        let byte = bytes.get(at).copied().unwrap_or_default();
        if e.error_len().is_none() {
            return not_text(at, "the file ends within a character; it seems to be cut off".to_owned());
        }
        let binary = bytes.iter().take(1000).filter(|b| **b < 9).count() > 0;
        let guess = if binary {
            "the file is binary, or damaged"
        } else {
            "the file may be Latin-1 or Windows-1252; save it as UTF-8"
        };
        not_text(at, format!("there is the byte {byte:#04X}; {guess}"))
    })
}

/// Strict JSON, or the byte where it is not and what was expected there.
fn check_syntax(text: &str) -> Result<(), (usize, String)> {
    let mut json = serde_json::Deserializer::from_str(text);
    let strict = IgnoredAny::deserialize(&mut json).and_then(|_| json.end());
    strict.map_err(|e| explain(text, &e))?;
    match too_deep(text) {
        Some(at) => Err((at, format!("nested more than {MAX_DEPTH} levels deep; a scene needs four"))),
        None => Ok(()),
    }
}

/// Where nesting exceeds [`MAX_DEPTH`], in text that is JSON.
fn too_deep(text: &str) -> Option<usize> {
    let (mut depth, mut in_text, mut escaped) = (0usize, false, false);
    for (at, byte) in text.bytes().enumerate() {
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_text => escaped = true,
            b'"' => in_text = !in_text,
            _ if in_text => {}
            b'{' | b'[' => {
                depth += 1;
                if depth > MAX_DEPTH {
                    return Some(at);
                }
            }
            b'}' | b']' => depth -= 1,
            _ => {}
        }
    }
    None
}

/// What was expected, and a hint where the mistake is a common one.
fn explain(text: &str, error: &serde_json::Error) -> (usize, String) {
    if error.is_eof() {
        let said = error.to_string();
        let within = [("a string", "a text"), ("a list", "a list"), ("an object", "an object")]
            .into_iter()
            .find(|(theirs, _)| said.contains(theirs))
            .map_or("where a value was expected".to_owned(), |(_, ours)| format!("within {ours}"));
        return (text.len(), format!("the file ends {within}; it seems to be cut off"));
    }
    let line_start: usize =
        text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
    let mut at = (line_start + error.column().saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    let rest = &text[at..];
    let found = rest.chars().next();
    // The word that the place is within: NaN, -Infinity, 0x1F, .5, 'text'.
    let part_of_word = |c: char| c.is_alphanumeric() || "+-._".contains(c);
    let start = text[..at].char_indices().rev().take_while(|(_, c)| part_of_word(*c)).last();
    let start = start.map_or(at, |(i, _)| i);
    let word = &text[start..];
    let word = &word[..word.find(|c| !part_of_word(c)).unwrap_or(word.len())];
    let before = text[..start].trim_end().chars().next_back();
    let said = error.to_string();
    let said = said.split(" at line ").next().unwrap_or_default();
    let lower = word.trim_start_matches(['+', '-']).to_lowercase();
    let is_value = said != "key must be a string";

    let what = if rest.starts_with("//") || rest.starts_with("/*") || found == Some('#') {
        "comments are not part of JSON; take them out, or write a \"description\"".to_owned()
    } else if found == Some('\'') {
        "text and keys stand in double quotes (\"), not in single ones (')".to_owned()
    } else if matches!(found, Some('“' | '”' | '„')) {
        "text and keys stand in straight double quotes (\"), not in typographic ones".to_owned()
    } else if matches!(found, Some('}' | ']')) && before == Some(',') {
        "there is a comma after the last entry; take it out".to_owned()
    } else if is_value && matches!(lower.as_str(), "nan" | "inf" | "infinity") {
        at = start;
        format!("{word} is not a number that JSON has; write a finite number")
    } else if is_value && matches!(lower.as_str(), "true" | "false" | "null" | "none" | "undefined") {
        at = start;
        format!("{word} is not JSON; true, false and null are written in lower case")
    } else if is_value && word.starts_with('+') {
        at = start;
        format!("{word}: numbers have no plus sign")
    } else if is_value && word.starts_with(['.', '-']) && word.contains('.') {
        at = start;
        format!("{word}: numbers begin with a digit: 0.5, not .5")
    } else if is_value && lower.starts_with("0x") {
        at = start;
        format!("{word}: numbers are decimal")
    } else {
        match said {
            "expected value" => format!(
                "expected a value (text in double quotes, a number, a list or an object), not {}",
                shown(found, word)
            ),
            "key must be a string" => format!("expected a key in double quotes, not {}", shown(found, word)),
            "trailing characters" => {
                format!("expected the end of the file after the scene, not {}", shown(found, word))
            }
            "invalid number" => format!("{} is not a number as JSON writes them", shown(found, word)),
            "expected ident" => {
                at = start;
                format!("{word} is not JSON; only true, false and null stand without quotes")
            }
            s if s.starts_with("control character") => {
                at += rest.find(char::is_control).unwrap_or_default();
                "a line break or control character within a text; end the text with \" or write \\n"
                    .to_owned()
            }
            s if s.starts_with("expected") => format!("{s}, not {}", shown(found, word)),
            s => s.to_owned(),
        }
    };
    (at, what)
}

/// What is at a place, for a message.
fn shown(found: Option<char>, word: &str) -> String {
    match found {
        _ if word.chars().count() > 1 => crate::text::shortened(word),
        Some('\n' | '\r') => "the end of the line".to_owned(),
        Some(c) if c.is_control() => format!("the character U+{:04X}", u32::from(c)),
        Some(c) => format!("`{c}`"),
        None => "the end of the file".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn syntax_errors_say_where_and_what_was_expected() {
        for (text, place, expected) in [
            ("{\"a\": 1", "1:8", "the file ends within an object; it seems to be cut off"),
            ("[1, 2", "1:6", "the file ends within a list"),
            ("{\"a\": \"x", "1:9", "the file ends within a text"),
            ("{\"a\":", "1:6", "the file ends where a value was expected"),
            ("{\"a\": 1,}", "1:9", "comma after the last entry"),
            ("[1,\n]", "2:1", "comma after the last entry"),
            ("{\"a\": NaN}", "1:7", "NaN is not a number that JSON has"),
            ("{\"a\": -Infinity}", "1:7", "-Infinity is not a number that JSON has"),
            ("{\"a\": Infinity}", "1:7", "Infinity is not a number that JSON has"),
            ("{\"a\": True}", "1:7", "lower case"),
            ("{\"a\": nul}", "1:7", "nul is not JSON"),
            ("{\"a\": .5}", "1:7", "numbers begin with a digit"),
            ("{\"a\": -.5}", "1:7", "numbers begin with a digit"),
            ("{\"a\": +5}", "1:7", "no plus sign"),
            ("{\"a\": 0x1F}", "1:7", "decimal"),
            ("{\"a\": 01}", "1:8", "not a number as JSON"),
            ("{\"a\": 1 \"b\": 2}", "1:9", "expected `,` or `}`"),
            ("{\"a\" 1}", "1:6", "expected `:`"),
            ("{a: 1}", "1:2", "expected a key in double quotes"),
            ("{'a': 1}", "1:2", "not in single ones"),
            ("{\"a\": 1} x", "1:10", "expected the end of the file"),
            ("{ // size\n}", "1:3", "comments"),
            ("{\"a\": \"x\ny\"}", "1:9", "line break"),
            ("{“a”: 1}", "1:2", "typographic"),
            ("}", "1:1", "expected a value"),
        ] {
            let error = from_text(text, "s.json", &Registry::builtin(), Defaults::Use).expect_err(text);
            let said = error.to_string();
            assert!(said.starts_with(&format!("s.json:{place}: not JSON: ")), "{text:?}: {said}");
            assert!(said.contains(expected), "{text:?}: {said}");
        }
    }

    #[test]
    fn deep_nesting_is_an_error_and_no_overflow_of_the_stack() {
        let text = "[".repeat(1_000_000) + &"]".repeat(1_000_000);
        let error = from_text(&text, "s.json", &Registry::builtin(), Defaults::Use).expect_err("deep");
        assert_eq!(
            error.to_string(),
            "s.json:1:65: not JSON: nested more than 64 levels deep; a scene needs four"
        );
    }
}
