//! The text of a model's file: its declaration, its definitions, and the names that are allowed.

/// The longest id or name of a parameter, characters.
pub(super) const LONGEST_ID: usize = 40;
/// The word after `/*` that marks the declaration.
pub const MARKER: &str = "lcm";

/// An error: its byte in the file, and the message.
pub(super) type Mistake = (usize, String);

/// The comment with the declaration, within a file.
pub(super) struct Comment<'a> {
    /// The text between the marker and the end.
    pub json: &'a str,
    /// Its first byte.
    pub start: usize,
    /// The byte after the comment.
    pub end: usize,
}

/// The byte after a comment that starts at a byte with `/*`. Comments nest, as in WGSL.
fn block_comment(text: &str, start: usize) -> Option<usize> {
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

/// Finds the declaration: the first thing in the file except for space and other comments.
pub(super) fn comment(text: &str) -> Result<Comment<'_>, Mistake> {
    let mut at = 0;
    loop {
        at = text.len() - text[at..].trim_start().len();
        let rest = &text[at..];
        if rest.starts_with("//") {
            at += rest.find('\n').unwrap_or(rest.len());
            continue;
        }
        if !rest.starts_with("/*") {
            let what = format!(
                "the declaration is missing; a model begins with a comment /* {MARKER} {{ \"name\": …, \"parameters\": […] }} */"
            );
            return Err((at.min(text.len()), what));
        }
        let Some(end) = block_comment(text, at) else {
            return Err((at, "the comment is not closed; its */ is missing".to_owned()));
        };
        let inside = &text[at + 2..end - 2];
        let word = inside.trim_start();
        if let Some(json) =
            word.strip_prefix(MARKER).filter(|j| !j.starts_with(|c: char| c.is_alphanumeric() || c == '_'))
        {
            return Ok(Comment { json, start: end - 2 - json.len(), end });
        }
        at = end;
    }
}

/// The text with spaces instead of comments.
pub(super) fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    let mut at = 0;
    while let Some(slash) = text[at..].find('/').map(|i| at + i) {
        out.push_str(&text[at..slash]);
        let rest = &text[slash..];
        let end = if rest.starts_with("//") {
            slash + rest.find('\n').unwrap_or(rest.len())
        } else if rest.starts_with("/*") {
            block_comment(text, slash).unwrap_or(text.len())
        } else {
            out.push('/');
            at = slash + 1;
            continue;
        };
        at = slash;
        out.extend(text[at..end].bytes().map(|b| if b == b'\n' { '\n' } else { ' ' }));
        at = end;
    }
    out.push_str(&text[at..]);
    out
}

/// The functions that a WGSL text defines: the byte of each name, and the name.
pub(super) fn functions(text: &str) -> Vec<(usize, &str)> {
    let plain = without_comments(text);
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let named = plain.match_indices("fn").filter_map(|(at, _)| {
        let behind = &plain[at + 2..];
        let found = behind.trim_start();
        let length = found.find(|c| !word(c)).unwrap_or(found.len());
        let defines = !plain[..at].ends_with(word) && found.len() < behind.len() && length > 0;
        // Without its comments the text is as long.
        let at = plain.len() - found.len();
        defines.then(|| Some((at, text.get(at..at + length)?)))?
    });
    named.collect()
}

/// The byte of the name of a function in a WGSL text, if the text defines it.
pub(super) fn definition(text: &str, name: &str) -> Option<usize> {
    functions(text).into_iter().find(|(_, defined)| *defined == name).map(|(at, _)| at)
}

/// The problem with an id or the name of a parameter, if it cannot be used.
pub(super) fn identifier(id: &str) -> Result<(), String> {
    let legal = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_';
    let starts = id.starts_with(|c: char| c.is_ascii_lowercase());
    if !starts || !id.chars().all(legal) || id.len() > LONGEST_ID {
        return Err(identifier_rule());
    }
    Ok(())
}

/// The rule of [`identifier`].
pub(super) fn identifier_rule() -> String {
    format!(
        "must be lower-case letters, digits and underscores, begin with a letter and have at most {LONGEST_ID} characters"
    )
}

/// True if WGSL allows a name: it has many reserved words.
pub(super) fn allowed_in_wgsl(name: &str) -> bool {
    !naga::keywords::wgsl::RESERVED.contains(&name)
}

/// An id as a name: `charlie_sheen` becomes Charlie sheen.
pub(super) fn humanised(id: &str) -> String {
    let spaced = id.replace('_', " ");
    let mut letters = spaced.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

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
