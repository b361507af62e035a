//! Texts in XML 1.0, which forbids some characters even as references.

use std::fmt::Write as _;

/// A text in which characters forbidden by XML 1.0 are written like `\u{fffe}`.
#[must_use]
pub fn legal(text: &str) -> String {
    let mut legal = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\t' | '\n' | '\r' | ' '..='\u{fffd}' | '\u{10000}'.. => legal.push(c),
            // Writing to a String cannot fail.
            _ => drop(write!(legal, "{}", c.escape_unicode())),
        }
    }
    legal
}

/// A text with XML's special characters escaped, for texts and attributes.
#[must_use]
pub fn escaped(text: &str) -> String {
    marked(&legal(text))
}

/// A text with the special characters that XML and HTML share escaped.
#[must_use]
pub fn marked(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A text for a comment, which must neither contain `--` nor end with `-`.
#[must_use]
pub fn comment(text: &str) -> String {
    let mut apart = String::with_capacity(text.len());
    for c in legal(text).chars() {
        if c == '-' && apart.ends_with('-') {
            apart.push(' ');
        }
        apart.push(c);
    }
    if apart.ends_with('-') {
        apart.push(' ');
    }
    apart
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn forbidden_characters_are_written_out() {
        let forbidden = (0..0x20u8).map(char::from).filter(|c| !"\t\n\r".contains(*c));
        for c in forbidden.chain(['\u{fffe}', '\u{ffff}']) {
            for written in [legal, escaped, comment].map(|f| f(&format!("a{c}b"))) {
                assert_eq!(written, format!("a\\u{{{:x}}}b", u32::from(c)));
            }
        }
        let fine = "\t\n\r aä\u{d7ff}\u{e000}\u{fffd}\u{10000}\u{10ffff}";
        assert_eq!(legal(fine), fine);
        assert_eq!(escaped("<a & \"b\">"), "&lt;a &amp; &quot;b&quot;&gt;");
        assert_eq!(comment("a ---> b-"), "a - - -> b- ");
    }
}
