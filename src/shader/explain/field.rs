//! Unknown fields of structs, such as parameters that a model does not declare.

use super::scan::Scan;
use crate::text::{listed, nearest};

/// Other names of fields of shared structs.
const MEANT: &[(&str, &str)] = &[("normal", "n"), ("tangent", "t"), ("bitangent", "b"), ("binormal", "b")];

/// The message about an unknown field, the token `i`: `m.base_color`, `frame.normal`.
pub(super) fn unknown(scan: &Scan, i: usize, field: &str) -> String {
    let value = scan.before(i, 2);
    let of =
        (0..i).rev().find(|j| scan.word(*j) == value && scan.word(j + 1) == ":").map(|j| scan.word(j + 2));
    let Some((of, fields)) = of.and_then(|of| Some((of, scan.declared(of)?.fields))) else {
        return format!(
            "there is no `.{field}` here: a vec3 has the components x, y and z, or r, g and b, a number has none"
        );
    };
    let names: Vec<_> = fields.into_iter().map(|(name, _)| name).collect();
    let spelling = field.replace("color", "colour");
    let meant = MEANT.iter().filter(|(_, name)| names.contains(name)).copied();
    let near = nearest(&spelling, names.iter().map(|name| (*name, *name)).chain(meant));
    let declares = match of.strip_suffix("Parameters") {
        Some("") => Some("the model declares"),
        Some(_) => Some("the light type declares"),
        None => None,
    };
    match (declares, near) {
        (Some(_), Some(name)) => format!("no parameter {field}; did you mean {name}?"),
        (Some(who), None) if names == ["unused"] => format!("no parameter {field}; {who} none"),
        (Some(who), None) => format!("no parameter {field}; {who} {}", listed(&names, "and")),
        (None, Some(name)) => format!("{of} has no field {field}; did you mean {name}?"),
        (None, None) if field.contains("dot") => {
            format!("{of} has no field {field}; a cosine is a dot product such as `dot(frame.n, l)`")
        }
        (None, None) => format!("{of} has no field {field}; it has {}", listed(&names, "and")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_unknown_field_is_reported_with_the_one_that_was_meant() {
        let said = |text: &str| {
            let scan = Scan::new(text).expect("short");
            unknown(&scan, scan.tokens.len() - 1, scan.word(scan.tokens.len() - 1))
        };
        let head =
            "struct Parameters { base_colour: vec3<f32>, gloss: f32, }\nfn f(m: Parameters, l: Light) {";
        for (line, expected) in [
            ("let c = m.base_color", "no parameter base_color; did you mean base_colour?"),
            ("m.glos", "no parameter glos; did you mean gloss?"),
            ("m . velvet", "no parameter velvet; the model declares base_colour and gloss"),
            ("l.base_color", "there is no `.base_color` here: a vec3 has the components"),
        ] {
            assert!(said(&format!("{head}\n{line}")).starts_with(expected), "{line}");
        }
        let head = "struct SpotParameters { cone_angle: f32, penumbra: f32, }\nfn f(m: SpotParameters) {\n";
        assert_eq!(said(&format!("{head}m.cone_angel")), "no parameter cone_angel; did you mean cone_angle?");
        let expected = "no parameter velvet; the light type declares cone_angle and penumbra";
        assert_eq!(said(&format!("{head}m.velvet")), expected);
        let head = "struct Frame { n: vec3<f32>, // up: out\n t: vec3<f32>, b: vec3<f32> }\nfn f(frame: vec3<f32>) {}\nfn g(frame: Frame) {\n";
        for (line, expected) in [
            ("frame.normal", "Frame has no field normal; did you mean n?"),
            ("frame.glow", "Frame has no field glow; it has n, t and b"),
            (
                "frame.n_dot_h",
                "Frame has no field n_dot_h; a cosine is a dot product such as `dot(frame.n, l)`",
            ),
        ] {
            assert_eq!(said(&format!("{head}{line}")), expected, "{line}");
        }
    }
}
