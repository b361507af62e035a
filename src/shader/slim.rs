//! Removes the parts of texts that cost the composer time: comments, indentation, and lines.

/// An equivalent text without comments and indentation, and with few lines, each of which costs the composer
/// time. Positions in it differ from those in the original.
#[must_use]
pub fn slim(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    // An import in braces may continue on the next lines.
    let mut importing = false;
    for line in without_comments(text).lines().map(str::trim_end).filter(|line| !line.is_empty()) {
        let directive = line.starts_with('#');
        if (directive || importing) && !out.is_empty() && !out.ends_with('\n') {
            out.push('\n');
        }
        out.push_str(line);
        importing = (importing || line.starts_with("#import")) && {
            let import = out.rfind("#import").map_or("", |start| &out[start..]);
            import.matches('{').count() > import.matches('}').count()
        };
        out.push(if directive || importing { '\n' } else { ' ' });
    }
    out
}

/// A text without comments and indentation; lines keep their positions.
fn without_comments(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    // The number of open `/*`: they nest.
    let mut depth = 0_usize;
    for line in text.lines() {
        let line = line.trim();
        let bytes = line.as_bytes();
        // The first byte not yet written, and the one being examined.
        let (mut from, mut at) = (0, 0);
        while at < bytes.len() {
            match (depth, bytes[at], bytes.get(at + 1)) {
                (0, b'/', Some(b'/')) => break,
                (_, b'/', Some(b'*')) => {
                    if depth == 0 {
                        out.push_str(&line[from..at]);
                        // The texts on both sides stay separate.
                        out.push(' ');
                    }
                    depth += 1;
                    at += 2;
                }
                (1.., b'*', Some(b'/')) => {
                    depth -= 1;
                    at += 2;
                    from = at;
                }
                _ => at += 1,
            }
        }
        if depth == 0 {
            out.push_str(&line[from..at]);
        }
        out.push('\n');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::{Registry, compose::compose_evaluation};
    use crate::shader::compose::Sources;

    #[test]
    fn comments_go_and_lines_stay() {
        for (text, expected) in [
            ("a // b\n  c", "a \nc\n"),
            ("a /* b\nc */ d", "a  \n d\n"),
            ("a/*/**/*/b", "a b\n"),
            ("a // /* b\nc", "a \nc\n"),
            ("a /* // */ b", "a   b\n"),
            ("/* never closed\nx", " \n\n"),
        ] {
            assert_eq!(without_comments(text), expected, "{text}");
        }
    }

    #[test]
    fn a_slim_text_means_the_same_and_has_few_lines() {
        for (text, expected) in [
            ("a\n  b // c\n\nd", "a b d "),
            ("a\n#ifdef X\nb\nc\n#endif\nd", "a \n#ifdef X\nb c \n#endif\nd "),
            ("#import a::{\n  b,\n  c,\n}\nd\ne", "#import a::{\nb,\nc,\n} d e "),
            ("@group(#{G}) x\ny", "@group(#{G}) x y "),
        ] {
            assert_eq!(slim(text), expected, "{text}");
        }
        for model in Registry::builtin().models() {
            let composed = compose_evaluation(&Sources::default(), model);
            let slim = slim(&composed.text);
            let functions = |text| naga::front::wgsl::parse_str(text).map(|m| m.functions.len()).ok();
            assert_eq!(functions(&slim), functions(&composed.text), "{}", model.declaration.id);
            assert!(slim.lines().count() < 20, "{slim}");
        }
    }
}
