//! Texts made safe to show.

use std::borrow::Cow;

/// A text without the characters that a terminal would act on instead of showing them: control characters other than
/// line ends and tabs, and those that change the direction of writing, are written as escapes such as `\u{1b}`. File
/// names may hold all of these.
#[must_use]
pub fn printable(text: &str) -> Cow<'_, str> {
    if !text.contains(is_unfit) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if is_unfit(c) {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

fn is_unfit(c: char) -> bool {
    c.is_control() && c != '\n' && c != '\t' || matches!(c, '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_terminal_obeys_is_written_as_an_escape() {
        assert_eq!(
            printable("a\u{1b}[31m\rb\u{7f}\u{9b}2J\u{202e}c\u{7}"),
            r"a\u{1b}[31m\rb\u{7f}\u{9b}2J\u{202e}c\u{7}"
        );
        let plain = "größe → „ö“\n\tα² 中文 🙂";
        assert!(matches!(printable(plain), Cow::Borrowed(text) if text == plain));
        let once = printable("\u{1b}").into_owned();
        assert_eq!(printable(&once), once, "escaping twice changes nothing more");
    }
}
