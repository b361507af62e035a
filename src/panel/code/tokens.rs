//! The words of WGSL and of JSON, for colours: a declaration in a model's comment is JSON within WGSL.
//!
//! One pass over the text, whatever is in it; what is no word of the language is plain. The rules are those of
//! the WGSL specification (W3C, *WebGPU Shading Language*, sections 3.3 to 3.10): comments in blocks nest, and an
//! identifier may have letters of any script.

use std::ops::Range;

use crate::custom::MARKER;

/// A language of the editor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Language {
    /// Shaders and custom models.
    Wgsl,
    /// Scenes.
    Json,
}

/// The sort of a word, which decides on its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Sort {
    /// Space, punctuation, names without a meaning of their own.
    Plain,
    /// A comment.
    Comment,
    /// A word of the language, an attribute or a directive.
    Keyword,
    /// A type.
    Type,
    /// A function where it is defined or called.
    Function,
    /// A number, or true and false.
    Number,
    /// A text in quotes.
    Text,
    /// The name of a value in JSON.
    Key,
}

/// Words of WGSL that are neither types nor functions.
pub(super) const KEYWORDS: &[&str] = &[
    "alias",
    "break",
    "case",
    "const",
    "const_assert",
    "continue",
    "continuing",
    "default",
    "diagnostic",
    "discard",
    "else",
    "enable",
    "fn",
    "for",
    "if",
    "let",
    "loop",
    "override",
    "requires",
    "return",
    "struct",
    "switch",
    "var",
    "while",
];

/// Types of WGSL, and those of the program's vocabulary.
pub(super) const TYPES: &[&str] = &[
    "array",
    "bool",
    "f16",
    "f32",
    "i32",
    "u32",
    "vec2",
    "vec3",
    "vec4",
    "vec2f",
    "vec3f",
    "vec4f",
    "vec2i",
    "vec3i",
    "vec4i",
    "vec2u",
    "vec3u",
    "vec4u",
    "mat2x2",
    "mat2x3",
    "mat2x4",
    "mat3x2",
    "mat3x3",
    "mat3x4",
    "mat4x2",
    "mat4x3",
    "mat4x4",
    "Frame",
    "Terms",
    "Parameters",
    "Sharp",
];

/// The words of a text in order, without the plain ones.
#[must_use]
pub fn tokens(text: &str, language: Language) -> Vec<(Range<usize>, Sort)> {
    let mut reader = Reader { text, at: 0, found: Vec::new() };
    match language {
        Language::Wgsl => reader.wgsl(),
        Language::Json => reader.json(text.len()),
    }
    reader.found
}

struct Reader<'a> {
    text: &'a str,
    at: usize,
    found: Vec<(Range<usize>, Sort)>,
}

impl<'a> Reader<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn take(&mut self, length: usize, sort: Sort) {
        if sort != Sort::Plain && length > 0 {
            self.found.push((self.at..self.at + length, sort));
        }
        self.at += length;
    }

    /// Length of what begins here and has only such characters.
    fn length(&self, is: impl Fn(char) -> bool) -> usize {
        self.rest().find(|c| !is(c)).unwrap_or(self.rest().len())
    }

    fn line(&self) -> usize {
        self.rest().find('\n').unwrap_or(self.rest().len())
    }

    fn wgsl(&mut self) {
        while let Some(first) = self.rest().chars().next() {
            let rest = self.rest();
            if rest.starts_with("//") {
                self.take(self.line(), Sort::Comment);
            } else if rest.starts_with("/*") {
                self.block();
            } else if first == '"' {
                self.string(Sort::Text);
            } else if first == '#' || first == '@' {
                let word = 1 + rest[1..].find(|c: char| !is_of_word(c)).unwrap_or(rest.len() - 1);
                self.take(word, Sort::Keyword);
            } else if is_number(rest) {
                self.number();
            } else if is_of_word(first) {
                let length = self.length(is_of_word);
                let (word, after) = rest.split_at(length);
                self.take(length, word_of_wgsl(word, after));
            } else {
                self.take(first.len_utf8(), Sort::Plain);
            }
        }
    }

    /// A comment in a block, or the declaration of a model in one.
    fn block(&mut self) {
        let end = self.at + block_length(self.rest());
        let inside = self.rest()[2..].trim_start();
        let declares =
            inside.strip_prefix(MARKER).is_some_and(|json| !json.starts_with(|c: char| is_of_word(c)));
        if !declares {
            return self.take(end - self.at, Sort::Comment);
        }
        let begin = self.text.len() - inside.len() + MARKER.len();
        self.take(begin - self.at, Sort::Comment);
        let closes = self.text[begin..end].ends_with("*/");
        self.json(if closes { end - 2 } else { end });
        self.take(end - self.at, Sort::Comment);
    }

    /// JSON, with comments, up to a byte.
    fn json(&mut self, end: usize) {
        while self.at < end {
            let rest = &self.text[self.at..end];
            let Some(first) = rest.chars().next() else { break };
            if rest.starts_with("//") {
                self.take(rest.find('\n').unwrap_or(rest.len()), Sort::Comment);
            } else if rest.starts_with("/*") {
                self.take(block_length(rest), Sort::Comment);
            } else if first == '"' {
                let length = string_length(rest);
                let is_key = rest[length..].trim_start().starts_with(':');
                self.take(length, if is_key { Sort::Key } else { Sort::Text });
            } else if is_number(rest) || (first == '-' && is_number(&rest[1..])) {
                let sign = usize::from(first == '-');
                self.take(sign + number_length(&rest[sign..]), Sort::Number);
            } else if is_of_word(first) {
                let length = rest.find(|c| !is_of_word(c)).unwrap_or(rest.len());
                let is_value = matches!(&rest[..length], "true" | "false" | "null");
                self.take(length, if is_value { Sort::Number } else { Sort::Plain });
            } else {
                self.take(first.len_utf8(), Sort::Plain);
            }
        }
    }

    fn string(&mut self, sort: Sort) {
        self.take(string_length(self.rest()), sort);
    }

    fn number(&mut self) {
        self.take(number_length(self.rest()), Sort::Number);
    }
}

/// True for the characters of names.
pub(super) fn is_of_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

fn is_number(rest: &str) -> bool {
    let mut chars = rest.chars();
    match chars.next() {
        Some('.') => chars.next().is_some_and(|c| c.is_ascii_digit()),
        Some(c) => c.is_ascii_digit(),
        None => false,
    }
}

/// Length of the number at the start of a text, with its suffix.
fn number_length(rest: &str) -> usize {
    let mut before = ' ';
    let hexadecimal = rest.starts_with("0x") || rest.starts_with("0X");
    let belongs = |c: char, before: char| {
        let signs = if hexadecimal { ['p', 'P'] } else { ['e', 'E'] };
        c.is_ascii_alphanumeric() || c == '.' || (matches!(c, '+' | '-') && signs.contains(&before))
    };
    let end = rest.find(|c| {
        let ends = !belongs(c, before);
        before = c;
        ends
    });
    end.unwrap_or(rest.len())
}

/// Length of the string at the start of a text, with its quotes. It ends with its line at the latest.
fn string_length(rest: &str) -> usize {
    let mut escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            '\n' => return at,
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// Length of the comment at the start of a text, with those inside it; all of the text if it is not closed.
fn block_length(rest: &str) -> usize {
    let bytes = rest.as_bytes();
    let (mut at, mut depth) = (2, 1);
    while at < bytes.len() {
        match &bytes[at..bytes.len().min(at + 2)] {
            b"/*" => (at, depth) = (at + 2, depth + 1),
            b"*/" => (at, depth) = (at + 2, depth - 1),
            _ => at += 1,
        }
        if depth == 0 {
            return at;
        }
    }
    rest.len()
}

fn word_of_wgsl(word: &str, after: &str) -> Sort {
    match word {
        "true" | "false" => Sort::Number,
        _ if KEYWORDS.contains(&word) => Sort::Keyword,
        _ if TYPES.contains(&word) => Sort::Type,
        _ if after.trim_start_matches([' ', '\t']).starts_with('(') => Sort::Function,
        _ => Sort::Plain,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(text: &str, language: Language) -> Vec<(&str, Sort)> {
        tokens(text, language).into_iter().map(|(range, sort)| (&text[range], sort)).collect()
    }

    #[test]
    fn words_of_wgsl_have_their_sorts() {
        use Sort::{Comment, Function, Keyword, Number, Type};
        let text = "#import \"a.wgsl\"\nfn f(x: f32) -> vec3<f32> { /* a /* b */ c */ let y = power(x, 1.5e-3f); // end\n}";
        let expected = [
            ("#import", Keyword),
            ("\"a.wgsl\"", Sort::Text),
            ("fn", Keyword),
            ("f", Function),
            ("f32", Type),
            ("vec3", Type),
            ("f32", Type),
            ("/* a /* b */ c */", Comment),
            ("let", Keyword),
            ("power", Function),
            ("1.5e-3f", Number),
            ("// end", Comment),
        ];
        assert_eq!(said(text, Language::Wgsl), expected);
    }

    #[test]
    fn a_declaration_is_json_within_its_comment_and_another_comment_is_not() {
        use Sort::{Comment, Key, Number, Text};
        let text = "/* lcm { \"min\": -1.5, // low\n \"name\": \"a\\\"b\", \"on\": true } */";
        let expected = [
            ("/* lcm", Comment),
            ("\"min\"", Key),
            ("-1.5", Number),
            ("// low", Comment),
            ("\"name\"", Key),
            ("\"a\\\"b\"", Text),
            ("\"on\"", Key),
            ("true", Number),
            ("*/", Comment),
        ];
        assert_eq!(said(text, Language::Wgsl), expected);
        let other = text.replace("lcm", "lcms");
        assert_eq!(said(&other, Language::Wgsl), [(other.as_str(), Comment)]);
    }

    #[test]
    fn whatever_is_in_a_text_the_words_are_in_order_and_within_it() {
        let hostile = [
            "\"never closed\nfn f() {}".to_owned(),
            "/* never /* closed */".to_owned(),
            "/* lcm { \"a".to_owned(),
            "/* lcm".to_owned(),
            "/*/".to_owned(),
            "@".to_owned(),
            "#é\u{0} 漢字(１２) 0x.p-".to_owned(),
            ".".to_owned(),
            "-".to_owned(),
            "\\\"\\".to_owned(),
            "/*".repeat(20_000),
            "\"".repeat(20_001),
            "a(".repeat(20_000),
        ];
        for text in &hostile {
            for language in [Language::Wgsl, Language::Json] {
                let mut last = 0;
                for (range, _) in tokens(text, language) {
                    assert!(
                        range.start >= last && range.start < range.end && text.get(range.clone()).is_some()
                    );
                    last = range.end;
                }
            }
        }
    }

    #[test]
    fn the_shipped_shaders_have_no_open_comment_or_string() {
        for (name, text) in crate::library::assets::EXAMPLES {
            let all = tokens(text, Language::Wgsl);
            assert!(all.iter().any(|(_, sort)| *sort == Sort::Key), "{name} declares nothing");
            let functions = all.iter().filter(|(range, _)| &text[range.clone()] == "response");
            assert!(functions.count() >= 1, "{name}");
        }
    }
}
