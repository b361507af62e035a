//! Names in WGSL texts: the functions that a text defines, and the words that cannot be names.

/// The byte after a comment whose `/*` is at a byte. Comments nest, as in WGSL.
pub(crate) fn block_comment(text: &str, start: usize) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut at, mut depth) = (start, 0);
    while at + 1 < bytes.len() {
        match &bytes[at..at + 2] {
            b"/*" => depth += 1,
            b"*/" => depth -= 1,
            _ => {
                at += 1;
                continue;
            }
        }
        at += 2;
        if depth == 0 {
            return Some(at);
        }
    }
    None
}

/// The end of the comment that begins at a byte; the line break after `//` does not belong to it.
pub(crate) fn comment(text: &str, at: usize) -> Option<usize> {
    let rest = &text[at..];
    if rest.starts_with("//") {
        return Some(at + rest.find('\n').unwrap_or(rest.len()));
    }
    rest.starts_with("/*").then(|| block_comment(text, at).unwrap_or(text.len()))
}

/// The text with spaces instead of comments.
pub(super) fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    while let Some(slash) = text[at..].find('/').map(|i| at + i) {
        out.push_str(&text[at..slash]);
        let Some(end) = comment(text, slash) else {
            out.push('/');
            at = slash + 1;
            continue;
        };
        out.extend(text[slash..end].bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }));
        at = end;
    }
    out.push_str(&text[at..]);
    out
}

/// The functions defined by a WGSL text: the byte of each name, and the name.
pub(crate) fn functions(text: &str) -> Vec<(usize, &str)> {
    let plain = without_comments(text);
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let named = plain.match_indices("fn").filter_map(|(at, _)| {
        let behind = &plain[at + 2..];
        let found = behind.trim_start();
        if plain[..at].ends_with(word) || found.len() == behind.len() {
            return None;
        }
        let length = found.find(|c| !word(c)).unwrap_or(found.len());
        // Removing comments does not change the length.
        let at = plain.len() - found.len();
        (length > 0).then(|| Some((at, text.get(at..at + length)?)))?
    });
    named.collect()
}

/// The byte of the name of a function in a WGSL text, if the text defines it.
pub(crate) fn definition(text: &str, name: &str) -> Option<usize> {
    functions(text).into_iter().find(|(_, defined)| *defined == name).map(|(at, _)| at)
}

/// True if WGSL allows a name; it has many reserved words.
pub(crate) fn allowed_in_wgsl(name: &str) -> bool {
    !naga::keywords::wgsl::RESERVED.contains(&name)
}

#[cfg(test)]
mod tests {
    use std::time::{Duration, Instant};

    use super::*;
    use crate::text::identifier::identifier;

    #[test]
    fn functions_are_found_in_time_proportional_to_the_text() {
        let text = format!("fn f() {{ }} {} fn g() {{ }}", "fn".repeat(400_000));
        let begin = Instant::now();
        assert_eq!(functions(&text).into_iter().map(|(_, name)| name).collect::<Vec<_>>(), ["f", "g"]);
        assert!(begin.elapsed() < Duration::from_secs(5), "{:?}", begin.elapsed());
    }

    #[test]
    fn comments_become_spaces_and_the_rest_stays() {
        for (text, expected) in [
            ("a / b", "a / b"),
            ("é // x\nb", "é     \nb"),
            ("a /* x /* y\n */ */ b", "a          \n       b"),
            ("a /* never closed", "a                "),
            ("a /", "a /"),
            ("", ""),
        ] {
            assert_eq!(without_comments(text), expected, "{text:?}");
        }
    }

    #[test]
    fn names_are_refused_as_the_compiler_refuses_them() {
        let compiles =
            |name: &str| naga::front::wgsl::parse_str(&format!("struct S {{ {name}: f32 }}")).is_ok();
        let reserved = naga::keywords::wgsl::RESERVED.iter().copied();
        let known = naga::keywords::wgsl::BUILTIN_IDENTIFIERS.iter().copied();
        let usual = ["base_colour", "k_d", "final", "sampler", "x", "macro_1"];
        for name in reserved.chain(known).chain(usual).filter(|name| identifier(name).is_ok()) {
            assert_eq!(allowed_in_wgsl(name), compiles(name), "{name}");
        }
    }
}
