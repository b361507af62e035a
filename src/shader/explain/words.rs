//! Undefined names: those of other languages, of equations, and misspelt ones.

use super::scan::Scan;
use crate::text::{listed, nearest};

/// Names from GLSL, HLSL, C and the equations, with their equivalents here.
const MEANT: &str = include_str!("meant.txt");

/// The equivalent of a name.
fn meant(word: &str) -> Option<&'static str> {
    MEANT.lines().find_map(|line| line.strip_prefix(word)?.strip_prefix(' '))
}

/// The parameters of `response`.
const RECEIVED: &[(&str, &str)] =
    &[("l", "vec3<f32>"), ("v", "vec3<f32>"), ("frame", "Frame"), ("m", "Parameters")];

/// The name here of a type from another language.
pub(super) fn wgsl_type(word: &str) -> String {
    match word {
        "vec2" | "vec3" | "vec4" => format!("{word}<f32>"),
        word => meant(word).unwrap_or(word).to_owned(),
    }
}

/// True of the names of types of WGSL, also of short ones such as `vec3f`.
pub(super) fn is_type(word: &str) -> bool {
    let long = word.trim_end_matches(['f', 'h', 'i', 'u']);
    matches!(word, "bool" | "i32" | "u32" | "f32" | "f16" | "array" | "atomic" | "ptr" | "sampler")
        || matches!(long, "vec2" | "vec3" | "vec4")
        || long
            .strip_prefix("mat")
            .is_some_and(|size| matches!(size.as_bytes(), [b'2'..=b'4', b'x', b'2'..=b'4']))
}

/// The message about an undefined name, the token `i`.
pub(super) fn unknown(scan: &Scan, i: usize, name: &str) -> String {
    if name == "void" {
        return "WGSL has no void; a function without a result has no ->".to_owned();
    }
    if let Some((_, of)) = RECEIVED.iter().find(|(received, _)| *received == name) {
        let function = scan.function(i).unwrap_or_default();
        return format!("{function} has no parameter {name}; declare it: `fn {function}(…, {name}: {of})`");
    }
    // The parameters of a model are fields.
    let parameters = scan.declared("Parameters").map(|of| of.fields).unwrap_or_default();
    let fields: Vec<_> = parameters.iter().map(|(field, _)| (*field, format!("m.{field}"))).collect();
    let fields = fields.iter().map(|(field, code)| (*field, &**code));
    let spelling = name.replace("color", "colour");
    let exact =
        fields.clone().find(|(field, _)| *field == spelling).map(|(_, code)| code).or_else(|| meant(name));
    let near = || {
        let defines =
            |j: &usize| matches!(scan.before(*j, 1), "let" | "var" | "const" | "fn" | "struct" | "alias");
        let declared = (1..scan.tokens.len()).filter(defines);
        // Variables of this function, and everything outside functions.
        let begins = (0..i).rposition(|j| scan.word(j) == "fn").unwrap_or(0);
        let known = declared
            .filter(|j| (begins..i).contains(j) || matches!(scan.before(*j, 1), "fn" | "struct" | "const"));
        let known = known.map(|j| (scan.word(j), scan.word(j)));
        let own = RECEIVED.iter().map(|(word, _)| (*word, *word));
        let resource = |word: &&&str| ["texture", "sampler", "atomic"].iter().any(|r| word.starts_with(r));
        let built_in = naga::keywords::wgsl::BUILTIN_IDENTIFIERS.iter().filter(|word| !resource(word));
        let built_in = built_in.map(|word| (*word, *word));
        let elsewhere = MEANT.lines().filter_map(|line| line.split_once(' '));
        // A short word is near to many others.
        let elsewhere = elsewhere.filter(|(word, _)| word.len() > 5);
        let here = known.chain(fields).chain(built_in).chain(own).filter(|(word, _)| word.len() > 2);
        let near = nearest(&spelling, here.chain(elsewhere));
        near.filter(|_| name.len() > 2)
    };
    if let Some(code) = exact.or_else(near) {
        return format!("`{name}` is not defined; did you mean `{code}`?");
    }
    // Functions with a longer or a shorter name: fresnel_schlick is schlick here.
    let within = |a: &str, b: &str| a.len() > 4 && b.contains(a);
    let functions = (1..scan.tokens.len()).filter(|j| scan.before(*j, 1) == "fn").map(|j| scan.word(j));
    let mut similar: Vec<_> =
        functions.filter(|f| within(f, name) || within(name, f)).map(|f| format!("`{f}`")).collect();
    similar.truncate(4);
    match similar.is_empty() {
        true => format!("`{name}` is not defined"),
        false => format!("`{name}` is not defined; did you mean {}?", listed(&similar, "or")),
    }
}
