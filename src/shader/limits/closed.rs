//! Errors of one file that swallow the next one: an unclosed comment or bracket, an unfinished declaration.
//! In the combined text, the compiler would report them at the first line that no longer makes sense, which
//! is in somebody else's file.

use super::{
    LIMITS,
    token::{Finding, Kind, Token, tokens},
};

/// Finds anything open at the end of a file: its start, and what is missing. Errors within the file are left
/// to the compiler.
#[must_use]
pub fn unfinished(text: &str) -> Option<Finding> {
    let scan = tokens(text, LIMITS.tokens).ok().filter(|scan| scan.list.len() <= LIMITS.tokens)?;
    if let Some(at) = scan.open_comment {
        let nested = text[at + 2..].contains("/*");
        let hint = if nested { "; comments nest, so each /* needs its own" } else { "" };
        return Some((at, format!("the comment is not closed; its */ is missing{hint}")));
    }
    open_import(text).or_else(|| open_bracket(text, &scan.list)).or_else(|| open_end(&scan.list))
}

/// True for a text of only white space and comments.
#[must_use]
pub fn is_empty(text: &str) -> bool {
    tokens(text, 0).is_ok_and(|scan| scan.list.is_empty())
}

/// Finds an `#import` in unclosed braces, which continues over any number of lines.
fn open_import(text: &str) -> Option<Finding> {
    let mut begins = None;
    let mut depth = 0_usize;
    let mut at = 0;
    for line in text.split_inclusive('\n') {
        if depth > 0 || line.trim_start().starts_with("#import") {
            for (i, c) in line.char_indices() {
                match c {
                    '{' => {
                        begins = begins.filter(|_| depth > 0).or(Some(at + i));
                        depth += 1;
                    }
                    '}' => depth = depth.saturating_sub(1),
                    _ => {}
                }
            }
        }
        at += line.len();
    }
    begins.filter(|_| depth > 0).map(|at| (at, missing("{")))
}

/// Finds a bracket that is not closed.
fn open_bracket(text: &str, tokens: &[Token]) -> Option<Finding> {
    // The start and the indentation of each line, once: a line may be as long as the text.
    let mut lines = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        lines.push((start, line.len() - line.trim_start().len()));
        start += line.len();
    }
    let indentation = |at: usize| {
        lines[..lines.partition_point(|(start, _)| *start <= at)].last().copied().unwrap_or_default()
    };
    let mut open: Vec<Token> = Vec::new();
    // Blocks closed further to the left than they begin: probably by the bracket of the enclosing block.
    let mut suspects: Vec<Token> = Vec::new();
    for token in tokens {
        match (token.kind, token.text) {
            (Kind::Open, _) => open.push(*token),
            (Kind::Close, closing) => match (open.pop(), closing) {
                (Some(opening), _) if closing_of(opening.text) == closing => {
                    let (line, left) = indentation(opening.at);
                    let (end, right) = indentation(token.at);
                    if line != end && right < left {
                        suspects.push(opening);
                    }
                }
                (Some(opening), "}") => return Some((opening.at, missing(opening.text))),
                // A surplus bracket, which the compiler reports in place.
                _ => return None,
            },
            _ => {}
        }
    }
    let outermost = *open.first()?;
    let innermost = *open.last()?;
    let found = suspects.into_iter().find(|s| s.at > outermost.at).unwrap_or(innermost);
    Some((found.at, missing(found.text)))
}

/// Finds a declaration without an end: every one ends with a bracket or a semicolon.
fn open_end(tokens: &[Token]) -> Option<Finding> {
    let mut back = tokens.iter().rev().filter(|token| token.kind != Kind::Directive);
    let last = back.next()?;
    if matches!(last.text, "}" | ";") {
        return None;
    }
    let attribute = last.kind == Kind::Attribute || back.next().is_some_and(|t| t.kind == Kind::Attribute);
    let lacks = if attribute { "what the attribute belongs to" } else { "a ;" };
    let what =
        format!("the file ends in the middle of a declaration, after `{}`; {lacks} is missing", last.text);
    Some((last.at, what))
}

fn closing_of(opening: &str) -> &'static str {
    match opening {
        "(" => ")",
        "[" => "]",
        _ => "}",
    }
}

fn missing(opening: &str) -> String {
    format!("this {opening} is not closed; its {} is missing", closing_of(opening))
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;

    #[test]
    fn a_long_line_takes_time_proportional_to_its_length() {
        // As many tokens as are allowed.
        let text = format!("fn f() {{ {} }}", "if a { }  ".repeat(35_000));
        let padded = text.replacen(' ', &" ".repeat(900_000), 1);
        let begin = Instant::now();
        assert_eq!(unfinished(&padded), None);
        assert!(begin.elapsed() < Duration::from_secs(2), "{:?}", begin.elapsed());
    }

    /// Line, column and message of the unfinished part of a text.
    fn said(text: &str) -> Option<(usize, usize, String)> {
        let (at, what) = unfinished(text)?;
        let start = text[..at].rfind('\n').map_or(0, |i| i + 1);
        Some((text[..at].matches('\n').count() + 1, at - start + 1, what))
    }

    #[test]
    fn what_is_not_closed_is_found_where_it_begins() {
        for (text, line, column, what) in [
            ("fn f() {}\n  /* never\nfn g() {}\n", 2, 3, "the comment is not closed; its */ is missing"),
            ("/* a /* b */\nfn g() {}\n", 1, 1, "comments nest"),
            ("fn f() {\n    let x = 1;\n\nfn g() {\n}\n", 1, 8, "this { is not closed; its } is missing"),
            ("fn f() {\n    if a {\n        b();\n}\nfn g() {\n}\n", 2, 10, "this { is not closed"),
            ("fn f() {\n    let x = g(1, (2);\n}\n", 2, 14, "this ( is not closed; its ) is missing"),
            ("fn f(a: f32 {\n}\n", 1, 5, "this ( is not closed"),
            ("const a = array(1, 2;\nfn f() { let b = a[1; }\n", 2, 19, "this [ is not closed"),
            ("const a = 1", 1, 11, "after `1`"),
            (
                "fn f() {}\n@fragment\n// end\n",
                2,
                2,
                "after `fragment`; what the attribute belongs to is missing",
            ),
            ("#import a::{\n  b,\nfn f() {}\n", 1, 12, "this { is not closed"),
            ("fn f() {\n#ifdef A\n    g(\n#endif\n}\n", 3, 6, "this ( is not closed"),
        ] {
            let (l, c, said) = said(text).unwrap_or_else(|| panic!("{text}: nothing was found"));
            assert_eq!((l, c), (line, column), "{text}: {said}");
            assert!(said.contains(what), "{text}: {said}");
        }
    }

    #[test]
    fn what_is_finished_or_wrong_within_passes() {
        for text in [
            "",
            "// only a comment",
            "/* a /* b */ c */",
            "fn f() { if (a[1] > 2) { } }\nconst a = 1; // end",
            "struct S {\n    a: f32,\n}\n#ifdef A\nfn f() {}\n#else\nfn f() {}\n#endif\n",
            "#import a::{\n  b,\n}\nfn f() {}\n",
            "fn f() { g(1)); }",
            "fn f() { }\n}\n",
            "fn f() { \"",
        ] {
            assert_eq!(said(text), None, "{text}");
        }
        assert!(is_empty(" \n/* x */ // y") && !is_empty("x") && !is_empty("#if"));
    }

    #[test]
    fn all_that_is_shipped_is_finished() {
        for source in crate::library::assets::built_in_sources(&crate::registry::Registry::builtin()) {
            assert_eq!(said(source.text), None, "{}", source.path);
        }
        for (name, text) in crate::library::assets::EXAMPLES {
            assert_eq!(said(text), None, "{name}");
        }
    }
}
