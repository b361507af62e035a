//! Makes texts safe to display.

use std::{
    borrow::Cow,
    fmt::{self, Write as _},
    path::Path,
};

use crate::text::{is_invisible, shortened};

/// A text without characters that a terminal would act on instead of displaying, or that nobody would see: all
/// invisible ones except line ends and tabs become escapes such as `\u{1b}`. File names may contain all of
/// these.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    escaped(text, is_unfit, |shown, c| write!(shown, "{}", c.escape_default()))
}

/// Like [`printable`], on one line: line ends and tabs become escapes, too.
#[must_use]
pub fn printable_line(text: &str) -> Cow<'_, str> {
    escaped(text, is_invisible, |shown, c| write!(shown, "{}", c.escape_default()))
}

/// Like [`printable`], for JSON, whose strings have escapes such as `\u001b` and keep their value.
#[must_use]
pub fn printable_json(text: &str) -> Cow<'_, str> {
    escaped(text, is_unfit, |shown, c| {
        c.encode_utf16(&mut [0; 2]).iter().try_for_each(|unit| write!(shown, "\\u{unit:04x}"))
    })
}

fn escaped(
    text: &str,
    is_unfit: fn(char) -> bool,
    escape: impl Fn(&mut String, char) -> fmt::Result,
) -> Cow<'_, str> {
    if !text.contains(is_unfit) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_unfit(c) {
            // Writing to a String cannot fail.
            let _ = escape(&mut shown, c);
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// Paths in messages.
pub trait Shown {
    /// The path on one line: line ends in a file name cannot forge lines of a message. Of a path that no file can have,
    /// since a name in it is too long, only the beginning.
    fn shown(&self) -> OnOneLine<'_>;
}

impl Shown for Path {
    fn shown(&self) -> OnOneLine<'_> {
        OnOneLine(self)
    }
}

/// A path, written on one line.
#[derive(Clone, Copy, Debug)]
pub struct OnOneLine<'a>(&'a Path);

impl fmt::Display for OnOneLine<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        /// The longest name that systems have.
        const LONGEST: usize = 255;
        let text = self.0.to_string_lossy();
        let is_endless = self.0.iter().any(|name| name.to_string_lossy().chars().nth(LONGEST).is_some());
        let text: Cow<str> = if is_endless { Cow::Owned(shortened(&text)) } else { text };
        f.write_str(&printable_line(&text))
    }
}

fn is_unfit(c: char) -> bool {
    is_invisible(c) && c != '\n' && c != '\t'
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_takes_one_line() {
        let path = Path::new("scenes/a\nerror: b\t\u{2028}c\u{1b}[31m größe.json");
        assert_eq!(path.shown().to_string(), r"scenes/a\nerror: b\t\u{2028}c\u{1b}[31m größe.json");
        let name = "ö".repeat(255);
        assert_eq!(Path::new(&name).shown().to_string(), name);
        let endless = format!("{name}ö.json");
        assert_eq!(Path::new(&endless).shown().to_string(), format!("{}…", "ö".repeat(60)));
    }

    #[test]
    fn what_a_terminal_obeys_is_written_as_an_escape() {
        assert_eq!(
            printable("a\u{1b}[31m\rb\u{7f}\u{9b}2J\u{202e}c\u{7}\u{2028}"),
            r"a\u{1b}[31m\rb\u{7f}\u{9b}2J\u{202e}c\u{7}\u{2028}"
        );
        assert_eq!(printable("a\u{feff}\u{200b}b.json"), r"a\u{feff}\u{200b}b.json");
        let (odd, json) = ("a\u{9b}2J\u{202e}\u{2028}b", r#""a\u009b2J\u202e\u2028b""#);
        assert_eq!(printable_json(&serde_json::to_string(odd).expect("written")), json);
        assert_eq!(serde_json::from_str::<String>(json).expect("read"), odd);
        let plain = "größe → „ö“\n\tα² 中文 🙂";
        assert!(matches!(printable(plain), Cow::Borrowed(text) if text == plain));
        let once = printable("\u{1b}").into_owned();
        assert_eq!(printable(&once), once, "escaping twice changes nothing more");
    }
}
