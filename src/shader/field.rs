//! Messages about parameters that a model does not have, with the name probably meant.

use crate::text::{listed, nearest};

/// A clearer message for the compiler's about a field of the parameters: `m.base_color`. `None` for other messages. The
/// place is a line of the text, and a byte in it from 1.
pub(super) fn explain(text: &str, line: &str, column: usize, message: &str) -> Option<String> {
    let field = message.strip_prefix("invalid field accessor `")?.strip_suffix('`')?;
    let word = |c: char| c.is_alphanumeric() || c == '_';
    let before = line.get(..column.checked_sub(1)?)?.trim_end().strip_suffix('.')?.trim_end();
    let value = &before[before.trim_end_matches(word).len()..];
    let is_parameters = |at: usize| {
        let behind = text[at + value.len()..].trim_start().strip_prefix(':').map(str::trim_start);
        !text[..at].ends_with(word)
            && behind
                .and_then(|behind| behind.strip_prefix("Parameters"))
                .is_some_and(|rest| !rest.starts_with(word))
    };
    if value.is_empty() || !text.match_indices(value).any(|(at, _)| is_parameters(at)) {
        return None;
    }
    let body = text.split_once("struct Parameters {")?.1.split_once('}')?.0;
    let names: Vec<_> = body.lines().filter_map(|l| Some(l.split_once(':')?.0.trim())).collect();
    let spelling = field.replace("color", "colour");
    Some(match nearest(&spelling, names.iter().map(|name| (*name, *name))) {
        Some(name) => format!("no parameter {field}; did you mean {name}?"),
        None if names == ["unused"] => format!("no parameter {field}; the model declares none"),
        None => format!("no parameter {field}; the model declares {}", listed(&names, "and")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_parameter_is_told_with_the_one_that_was_meant() {
        let text = "struct Parameters {\n    base_colour: vec3<f32>,\n    gloss: f32,\n}\nfn f(m: Parameters, l: Light) {";
        let said = |line: &str, field: &str| {
            let column = line.find(field)? + 1;
            explain(text, line, column, &format!("invalid field accessor `{field}`"))
        };
        assert_eq!(
            said("    let c = m.base_color;", "base_color").as_deref(),
            Some("no parameter base_color; did you mean base_colour?")
        );
        assert_eq!(said("m.glos", "glos").as_deref(), Some("no parameter glos; did you mean gloss?"));
        assert_eq!(
            said("m . velvet", "velvet").as_deref(),
            Some("no parameter velvet; the model declares base_colour and gloss")
        );
        assert_eq!(said("l.base_color", "base_color"), None, "not the parameters");
        assert_eq!(said("base_color", "base_color"), None);
        assert_eq!(explain(text, "m.x", 3, "something else"), None);
        assert_eq!(explain(text, "é", 2, "invalid field accessor `x`"), None, "within a character");
    }
}
