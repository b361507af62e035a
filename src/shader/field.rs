//! Messages about fields that a struct does not have, such as parameters that a model does not declare, with the name
//! probably meant.

use crate::text::{listed, nearest};

/// Other names of fields of shared structs.
const MEANT: &[(&str, &str)] = &[("normal", "n"), ("tangent", "t"), ("bitangent", "b"), ("binormal", "b")];

/// A clearer message for the compiler's about a field: `m.base_color`, `frame.normal`. `None` for other messages. The
/// place is a line of the text, and a byte in it from 1.
pub(super) fn explain(text: &str, line: &str, column: usize, message: &str) -> Option<String> {
    let field = message.strip_prefix("invalid field accessor `")?.strip_suffix('`')?;
    let before = line.get(..column.checked_sub(1)?)?.trim_end().strip_suffix('.')?.trim_end();
    let value = &before[before.trim_end_matches(word).len()..];
    let of = type_of(&text[..text.find(line).map_or(text.len(), |at| at + line.len())], value)?;
    let body = text.split_once(&format!("struct {of} {{"))?.1.split_once('}')?.0;
    let names: Vec<_> = body
        .split([',', '\n'])
        .filter_map(|member| Some(member.split_once(':')?.0.trim()))
        .filter(|name| name.chars().all(word))
        .collect();
    let spelling = field.replace("color", "colour");
    let meant = MEANT.iter().filter(|(_, name)| names.contains(name)).copied();
    let near = nearest(&spelling, names.iter().map(|name| (*name, *name)).chain(meant));
    Some(match (of == "Parameters", near) {
        (true, Some(name)) => format!("no parameter {field}; did you mean {name}?"),
        (true, None) if names == ["unused"] => format!("no parameter {field}; the model declares none"),
        (true, None) => format!("no parameter {field}; the model declares {}", listed(&names, "and")),
        (false, Some(name)) => format!("{of} has no field {field}; did you mean {name}?"),
        (false, None) => format!("{of} has no field {field}; it has {}", listed(&names, "and")),
    })
}

fn word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The type with which a value is declared last in a text.
fn type_of<'a>(text: &'a str, value: &str) -> Option<&'a str> {
    text.match_indices(value).filter(|(at, _)| !value.is_empty() && !text[..*at].ends_with(word)).fold(
        None,
        |last, (at, _)| {
            let behind = text[at + value.len()..].trim_start().strip_prefix(':').map(str::trim_start);
            let of = behind.map(|behind| &behind[..behind.find(|c| !word(c)).unwrap_or(behind.len())]);
            of.filter(|of| !of.is_empty()).or(last)
        },
    )
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
        assert_eq!(said("l.base_color", "base_color"), None, "of a struct that is not there");
        assert_eq!(said("base_color", "base_color"), None);
        let text = "struct Frame { n: vec3<f32>, // up: out\n t: vec3<f32>, b: vec3<f32> }\nfn f(frame: vec3<f32>) {}\nfn g(frame: Frame) {\nframe.";
        let said = |field: &str| explain(text, "frame.", 7, &format!("invalid field accessor `{field}`"));
        assert_eq!(said("normal").as_deref(), Some("Frame has no field normal; did you mean n?"));
        assert_eq!(said("glow").as_deref(), Some("Frame has no field glow; it has n, t and b"));
        assert_eq!(explain(text, "m.x", 3, "something else"), None);
        assert_eq!(explain(text, "é", 2, "invalid field accessor `x`"), None, "within a character");
    }
}
