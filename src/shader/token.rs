//! The tokens of a WGSL text, as far as limits and messages need them: a flat list, in one pass, for any
//! text.
//!
//! Comments are skipped as naga and the preprocessor skip them, and characters on which the two disagree are
//! refused, so nothing visible to them is hidden here.

use std::fmt::Display;

use super::definitions;
use crate::text::named_character;

/// A token of the text.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'a> {
    pub kind: Kind,
    pub text: &'a str,
    /// First byte of the token.
    pub at: usize,
    /// For the start of a template list, the index of the token that ends it.
    pub end: usize,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Word,
    Number,
    /// `(`, `[` or `{`.
    Open,
    /// `)`, `]` or `}`.
    Close,
    /// `<` and `>` around a template list.
    TemplateOpen,
    TemplateClose,
    Comma,
    Semicolon,
    Colon,
    Dot,
    Attribute,
    /// All other operators.
    Operator,
    /// A preprocessor directive: `if…`, `else…`, `endif…`.
    Directive,
}

/// Maximum length of a name or a number, in bytes.
pub const LONGEST_WORD: usize = 256;

/// A problem at a byte.
pub(super) type Finding = (usize, String);

/// Refuses a place with more of something than allowed.
pub(super) fn at_most<N: PartialOrd + Display, P>(
    found: N,
    most: N,
    at: P,
    advice: &str,
    what: impl FnOnce() -> String,
) -> Result<(), (P, String)> {
    if found <= most {
        return Ok(());
    }
    Err((at, format!("{}; at most {most} are allowed{advice}", what())))
}

/// The tokens of a text.
pub(super) struct Tokens<'a> {
    pub list: Vec<Token<'a>>,
    /// The start of an unclosed comment.
    pub open_comment: Option<usize>,
}

#[derive(Default)]
struct Scanner<'a> {
    text: &'a str,
    at: usize,
    tokens: Vec<Token<'a>>,
    /// The tokens `<` that may begin a template list, with the brackets around them.
    pending: Vec<(usize, usize)>,
    brackets: usize,
    /// True while the line contains only white space so far.
    line_begins: bool,
    /// True if the rest of the line belongs to the preprocessor.
    directive: bool,
    open_comment: Option<usize>,
}

/// The tokens of a text, at most one more than a limit.
pub(super) fn tokens(text: &str, most: usize) -> Result<Tokens<'_>, Finding> {
    let mut scanner = Scanner {
        text,
        tokens: Vec::with_capacity((text.len() / 4).min(most + 1)),
        line_begins: true,
        ..Scanner::default()
    };
    while scanner.at < text.len() && scanner.tokens.len() <= most {
        scanner.step()?;
    }
    Ok(Tokens { list: scanner.tokens, open_comment: scanner.open_comment })
}

impl<'a> Scanner<'a> {
    fn byte(&self, ahead: usize) -> u8 {
        self.text.as_bytes().get(self.at + ahead).copied().unwrap_or(0)
    }

    /// Reads one token, comment or stretch of white space.
    fn step(&mut self) -> Result<(), Finding> {
        match (self.byte(0), self.byte(1)) {
            (b'\n', _) => {
                self.at += 1;
                self.begin_line();
            }
            (b' ' | b'\t' | b'\r' | 0x0b | 0x0c, _) => self.at += 1,
            (b'/', b'/') => self.line_comment()?,
            (b'/', b'*') => self.block_comment(),
            (b'"', _) => self.quotation()?,
            (b'#', _) if !self.directive => self.hash(),
            _ => self.token()?,
        }
        Ok(())
    }

    fn begin_line(&mut self) {
        (self.line_begins, self.directive) = (true, false);
    }

    fn token(&mut self) -> Result<(), Finding> {
        let start = self.at;
        self.line_begins = false;
        let kind = self.advance().ok_or_else(|| self.separator(start))?;
        let length = self.at - start;
        if !self.directive {
            if matches!(kind, Kind::Word | Kind::Number) {
                at_most(length, LONGEST_WORD, start, "", || format!("this word has {length} bytes"))?;
            }
            self.push(kind, start);
        }
        Ok(())
    }

    /// The finding about the character that separates what was read since `start`.
    fn separator(&self, start: usize) -> Finding {
        let found = self.text[start..self.at].char_indices().find(|(_, c)| divides(*c));
        let (at, which) =
            found.map_or((0, String::new()), |(at, c)| (at, format!(" {}", named_character(c))));
        let what = "separates lines or words; use a space or an ordinary line end";
        (start + at, format!("the invisible character{which} {what}"))
    }

    fn push(&mut self, kind: Kind, start: usize) {
        let here = self.tokens.len();
        let text = &self.text[start..self.at];
        let mut kind = kind;
        match (kind, text) {
            (Kind::Operator, "<") if self.tokens.last().is_some_and(|t| t.kind == Kind::Word) => {
                self.pending.push((here, self.brackets));
            }
            (Kind::TemplateClose, _) => match self.pending.pop() {
                Some((open, _)) => {
                    self.tokens[open].kind = Kind::TemplateOpen;
                    self.tokens[open].end = here;
                }
                None => kind = Kind::Operator,
            },
            (Kind::Open, "{") | (Kind::Semicolon | Kind::Colon, _) | (Kind::Operator, "=") => {
                self.pending.clear();
                self.brackets = 0;
            }
            (Kind::Open, _) => self.brackets += 1,
            (Kind::Close, ")" | "]") => {
                self.drop_pending();
                self.brackets = self.brackets.saturating_sub(1);
            }
            (Kind::Operator, "&&" | "||") => self.drop_pending(),
            _ => {}
        }
        self.tokens.push(Token { kind, text, at: start, end: 0 });
    }

    /// Drops pending `<` when the code in the innermost brackets can no longer begin a template list.
    fn drop_pending(&mut self) {
        while self.pending.last().is_some_and(|(_, brackets)| *brackets >= self.brackets) {
            self.pending.pop();
        }
    }

    /// Advances past the next token; `None` at an invalid character.
    fn advance(&mut self) -> Option<Kind> {
        let (first, second) = (self.byte(0), self.byte(1));
        let closes = self.pending.last().is_some_and(|(_, brackets)| *brackets == self.brackets);
        let (kind, length) = match (first, second) {
            (b'a'..=b'z' | b'A'..=b'Z' | b'_' | 0x80.., _) => return self.word(),
            (b'0'..=b'9', _) | (b'.', b'0'..=b'9') => {
                self.number();
                return Some(Kind::Number);
            }
            (b'(' | b'[' | b'{', _) => (Kind::Open, 1),
            (b')' | b']' | b'}', _) => (Kind::Close, 1),
            (b',', _) => (Kind::Comma, 1),
            (b';', _) => (Kind::Semicolon, 1),
            (b':', _) => (Kind::Colon, 1),
            (b'.', _) => (Kind::Dot, 1),
            (b'@', _) => (Kind::Attribute, 1),
            (b'>', _) if closes => (Kind::TemplateClose, 1),
            (b'<', b'<') | (b'>', b'>') => (Kind::Operator, if self.byte(2) == b'=' { 3 } else { 2 }),
            (b'&', b'&') | (b'|', b'|') | (b'+', b'+') | (b'-', b'-' | b'>') => (Kind::Operator, 2),
            (b'<' | b'>' | b'=' | b'!' | b'+' | b'-' | b'*' | b'/' | b'%' | b'&' | b'|' | b'^', b'=') => {
                (Kind::Operator, 2)
            }
            _ => (Kind::Operator, 1),
        };
        self.at += length;
        Some(kind)
    }

    fn word(&mut self) -> Option<Kind> {
        let bytes = self.text.as_bytes();
        let start = self.at;
        while let Some(b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'_' | 0x80..) = bytes.get(self.at) {
            self.at += 1;
        }
        // The text is UTF-8, and only whole characters were read.
        let word = &self.text[start..self.at];
        if !word.is_ascii() && word.contains(divides) {
            return None;
        }
        Some(Kind::Word)
    }

    fn number(&mut self) {
        let bytes = self.text.as_bytes();
        let hexadecimal = self.byte(0) == b'0' && matches!(self.byte(1), b'x' | b'X');
        self.at += 1;
        loop {
            match bytes.get(self.at) {
                Some(b'+' | b'-') => {
                    let before = bytes[self.at - 1];
                    let exponent = if hexadecimal {
                        matches!(before, b'p' | b'P')
                    } else {
                        matches!(before, b'e' | b'E')
                    };
                    if !exponent {
                        return;
                    }
                }
                Some(b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' | b'.') => {}
                _ => return,
            }
            self.at += 1;
        }
    }

    fn line_comment(&mut self) -> Result<(), Finding> {
        let rest = &self.text[self.at..];
        let line = &rest[..rest.find('\n').unwrap_or(rest.len())];
        let seen = line.trim_end_matches('\r');
        if let Some(at) = seen.find(|c| matches!(c, '\u{b}' | '\u{c}' | '\r') || separates(c) && !joins(c)) {
            let what = "this character ends the comment in WGSL although the line continues; use an ordinary line end";
            return Err((self.at + at, what.to_owned()));
        }
        self.at += line.len();
        Ok(())
    }

    /// Skips a comment. Comments nest; one that is not closed hides the rest.
    fn block_comment(&mut self) {
        let (text, start) = (self.text, self.at);
        self.at = definitions::block_comment(text, start).unwrap_or_else(|| {
            self.open_comment = Some(start);
            text.len()
        });
        if text[start..self.at].contains('\n') {
            self.begin_line();
        }
    }

    /// Reads a quotation, in which the preprocessor ignores comments.
    fn quotation(&mut self) -> Result<(), Finding> {
        let rest = &self.text[self.at + 1..];
        let line = &rest[..rest.find('\n').unwrap_or(rest.len())];
        let what = match line.find('"') {
            Some(end) if self.directive => {
                self.at += end + 2;
                return Ok(());
            }
            _ if self.directive => "this quotation mark is not closed in its line",
            _ => {
                "WGSL has no quotation marks; a choice is a number from 0, and a file is included by a line `#import \"file.wgsl\"`"
            }
        };
        Err((self.at, what.to_owned()))
    }

    /// Reads a preprocessor directive, or the name of a value that it inserts.
    fn hash(&mut self) {
        let start = self.at;
        self.at += 1;
        if self.line_begins && self.byte(0) != b'{' {
            self.directive = true;
            let rest = &self.text[self.at..];
            let rest = rest[..rest.find('\n').unwrap_or(rest.len())].trim_start();
            let word = rest.find(|c: char| !c.is_ascii_alphanumeric()).map_or(rest, |end| &rest[..end]);
            let token = Token { kind: Kind::Directive, text: word, at: start, end: 0 };
            self.tokens.push(token);
            return;
        }
        self.line_begins = false;
        if self.byte(0) == b'{' {
            let rest = &self.text[self.at..];
            let line = &rest[..rest.find('\n').unwrap_or(rest.len())];
            self.at += line.find('}').map_or(1, |end| end + 1);
        }
        self.push(Kind::Number, start);
    }
}

/// True for white space and line ends of WGSL beyond ASCII.
fn separates(c: char) -> bool {
    matches!(c, '\u{85}' | '\u{200e}' | '\u{200f}' | '\u{2028}' | '\u{2029}')
}

/// True for those of them that do not end a line.
fn joins(c: char) -> bool {
    matches!(c, '\u{200e}' | '\u{200f}')
}

/// True for characters beyond ASCII that end a word.
fn divides(c: char) -> bool {
    separates(c) || c.is_whitespace()
}
