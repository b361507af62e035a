//! Removes the parts of texts that cost the composer time: comments, indentation, and lines.

use super::definitions::without_comments;

/// An equivalent text without comments and indentation, and with few lines, each of which costs the composer
/// time. Positions in it differ from those in the original.
#[must_use]
pub fn slim(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    // An import in braces may continue on the next lines.
    let mut importing = false;
    for line in without_comments(text).lines().map(str::trim).filter(|line| !line.is_empty()) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::{Registry, compose::compose_evaluation};
    use crate::shader::compose::Sources;

    #[test]
    fn a_slim_text_means_the_same_and_has_few_lines() {
        for (text, expected) in [
            ("a\n  b // c\n\nd", "a b d "),
            ("a /* b\nc */ d", "a d "),
            ("a // /* b\nc", "a c "),
            ("/* never closed\nx", ""),
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
