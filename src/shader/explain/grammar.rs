//! The compiler's plain messages, and unexpected words and symbols: habits from GLSL, HLSL and C.

use super::{Explained, between, scan::Scan, words::wgsl_type};
use crate::{shader::token::Kind, text::shortened};

/// Patterns of messages, each with an explanation and the remedy below it. `{0}` and `{1}` are the texts matched by `{}`,
/// `{}` is the text at the first label. The position is that of the first label too, or of the `second`.
const PLAIN: &str = include_str!("plain.txt");

/// Types of WGSL, GLSL, HLSL and C.
const TYPES: &[&str] = &[
    "f32", "i32", "u32", "float", "double", "half", "int", "uint", "bool", "vec2", "vec3", "vec4", "float2",
    "float3", "float4", "ivec2", "ivec3", "mat2", "mat3", "mat4", "void",
];

/// The expected word, the word before and the one found, and the message below them. `*` matches anything, `TYPE` a type,
/// `WORD` a name; `|` separates alternatives. In the message, `{before}` and `{found}` are these words, `{earlier}` is the
/// one before both, `{next}` the one after, `{type}` the type as written here.
const UNEXPECTED: &str = include_str!("unexpected.txt");

/// The lines of a table: what is looked up, and what is indented below it.
fn rows(table: &'static str) -> impl Iterator<Item = (&'static str, &'static str)> {
    let mut lines = table.lines().map(str::trim_start);
    std::iter::from_fn(move || lines.next().zip(lines.next()))
}

/// The explanation of a plain message: the label, and the text.
pub(super) fn plain(message: &str, source: &str) -> Option<(usize, String)> {
    rows(PLAIN).find_map(|(pattern, says)| {
        let second = says.strip_prefix("second: ");
        let parts = match pattern.matches("{}").count() {
            0 => (message == pattern).then_some(["", ""])?,
            1 => between(message, pattern).map(|[one]| [one, ""])?,
            _ => between(message, pattern)?,
        };
        let says = second.unwrap_or(says).replace("{0}", parts[0]).replace("{1}", parts[1]);
        Some((usize::from(second.is_some()), says.replace("{}", source)))
    })
}

/// The explanation of an unexpected token at a byte.
pub(super) fn unexpected(scan: &Scan, start: usize, expected: &str, found: &str) -> Option<Explained> {
    let i = scan.at(start);
    let directive = scan.tokens.get(i).filter(|token| token.kind == Kind::Directive);
    let found =
        directive.map_or_else(|| found.trim_matches('"').to_owned(), |token| format!("#{}", token.text));
    let (before, earlier) = (scan.before(i, 1), scan.before(i, 2));
    let is_word = |i: usize| scan.tokens.get(i).is_some_and(|token| token.kind == Kind::Word);
    let fits = |pattern: &str, word: &str, i: Option<usize>| match pattern {
        "*" => true,
        "#" => word.starts_with('#'),
        "TYPE" => TYPES.contains(&word),
        "WORD" => i.is_some_and(is_word),
        words => words.split('|').any(|other| other == word),
    };
    let row = rows(UNEXPECTED).find_map(|(words, says)| {
        let (wanted, words) = words.split_once(" · ")?;
        let (behind, other) = words.split_once(" · ")?;
        let fits = wanted.split('|').any(|wanted| wanted == "*" || expected.starts_with(wanted))
            && fits(behind, before, i.checked_sub(1))
            && fits(other, &found, Some(i));
        fits.then_some((behind, says))
    });
    let Some((behind, says)) = row else {
        return (expected == "`;`").then(|| no_semicolon(scan, start));
    };
    let of = if TYPES.contains(&&*found) { &found } else { before };
    let message = says
        .replace("{before}", &shortened(before))
        .replace("{earlier}", earlier)
        .replace("{next}", scan.word(i + 1))
        .replace("{type}", &wgsl_type(of))
        .replace("{found}", &shortened(&found));
    let wrong = if behind == "TYPE" { i.saturating_sub(1) } else { i };
    Some((Some(scan.tokens.get(wrong).map_or(start, |token| token.at)), message))
}

/// A statement that does not end before a byte.
fn no_semicolon(scan: &Scan, start: usize) -> Explained {
    let Some(last) = scan.at(start).checked_sub(1).and_then(|i| scan.tokens.get(i)) else {
        return (Some(start), "a ; is missing".to_owned());
    };
    let before = scan.text.get(last.at..start).unwrap_or_default();
    let word = before.trim_end();
    // On another line, or before a word that begins a statement or ends a block.
    let ends = before.contains('\n')
        || matches!(scan.word(scan.at(start)), "return" | "let" | "var" | "if" | "for" | "}");
    let missing = if ends { "a ;" } else { "an operator or a ;" };
    (
        Some(last.at),
        format!("{missing} is missing after `{}`", shortened(word.lines().next().unwrap_or_default())),
    )
}
