//! The JSON of a glTF file, with errors in words.

use gltf::json::{Error, Root, deserialize};

use crate::text::shortened;

/// The key of data that authors may add anywhere, of any type: glTF 2.0 specification, 5.1 and
/// `extras.schema.json`.
const EXTRAS: &[u8] = b"\"extras\"";
/// A key of the same length without meaning.
const UNREAD: &[u8] = b"\"unread\"";

/// Reads the JSON of a file.
pub fn read(mut json: Vec<u8>) -> Result<Root, String> {
    // The library expects an object there.
    rename_extras(&mut json);
    deserialize::from_slice(&json).map_err(|error| in_words(&error))
}

/// Hides the extras of all objects. All positions stay the same.
fn rename_extras(json: &mut [u8]) {
    let mut at = 0;
    while let Some(start) = json[at..].iter().position(|byte| *byte == b'"').map(|i| at + i) {
        let mut end = start + 1;
        while end < json.len() && json[end] != b'"' {
            end += if json[end] == b'\\' { 2 } else { 1 };
        }
        at = (end + 1).min(json.len());
        // A text followed by a colon is a key.
        let is_key = json[at..].trim_ascii_start().starts_with(b":");
        if is_key && &json[start..at] == EXTRAS {
            json[start..at].copy_from_slice(UNREAD);
        }
    }
}

/// The error without type names of the library.
fn in_words(error: &Error) -> String {
    let whole = error.to_string();
    let what = whole.rsplit_once(" at line ").map_or(&*whole, |(what, _)| what);
    let what = match what.rsplit_once(", expected ") {
        Some((found, expected)) => {
            let found = ["invalid type: ", "invalid value: ", "invalid "]
                .into_iter()
                .find_map(|said| found.strip_prefix(said))
                .unwrap_or(found);
            let found = match found {
                "map" => "an object",
                "sequence" => "a list",
                other => other,
            };
            format!("{} instead of {}", shortened(found), kind(expected))
        }
        None => match what.strip_prefix("missing field `").and_then(|rest| rest.strip_suffix('`')) {
            Some(field) => format!("{} is missing", shortened(field)),
            None => shortened(what),
        },
    };
    format!("{what} (line {}, column {} of its JSON)", error.line(), error.column())
}

/// The expected value, in words.
fn kind(expected: &str) -> &str {
    match expected {
        "a map" => "an object",
        "a sequence" => "a list",
        "a string" => "a text",
        "f32" | "f64" => "a number",
        "index into child of root" | "u8" | "u16" | "u32" | "u64" | "usize" => "a whole number, 0 or more",
        "i8" | "i16" | "i32" | "i64" => "a whole number",
        other if other.starts_with("struct ") => "an object",
        other
            if ["tuple struct ", "newtype ", "unit", "enum "].iter().any(|name| other.starts_with(name)) =>
        {
            "something else"
        }
        other => other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn extras_of_every_type_are_passed_over() {
        for extras in
            ["\"made by hand\"", "1", "null", "true", "[1, 2]", "{\"extras\": [\"}\"]}", "\"a\\\"b\\\\\""]
        {
            for (before, after) in [("", ""), (" ", "\n  ")] {
                let text = format!(
                    "{{\"asset\": {{\"version\": \"2.0\", \"generator\": \"extras\", \
                     \"extras\"{before}:{after}{extras}}}, \"extras\": {extras}, \
                     \"nodes\": [{{\"extras\": {extras}, \"mesh\": 3}}]}}"
                );
                let root = read(text.as_bytes().to_vec()).unwrap_or_else(|said| panic!("{text}: {said}"));
                assert_eq!(root.asset.generator.as_deref(), Some("extras"));
                assert_eq!(root.nodes[0].mesh.map(|mesh| mesh.value()), Some(3));
            }
        }
        // A text that does not end, and one that ends within a character.
        for text in ["\"", "\"extras", "\"extras\"", "\"a\\", "\"extras\" :"] {
            assert!(read(text.as_bytes().to_vec()).is_err(), "{text}");
        }
    }

    #[test]
    fn mistakes_are_told_in_words() {
        let said = |text: &str| read(text.as_bytes().to_vec()).map(drop).expect_err(text);
        for (text, expected) in [
            ("{\"asset\": 7}", "integer `7` instead of an object (line 1, column "),
            ("{\"nodes\": {}}", "an object instead of a list (line 1, column "),
            ("{\"nodes\": [{\"mesh\": \"one\"}]}", "string \"one\" instead of a whole number, 0 or more"),
            ("{\"scene\": -1}", "integer `-1` instead of a whole number, 0 or more"),
            ("{\"nodes\": [{\"scale\": [\"x\"]}]}", "string \"x\" instead of a number"),
            ("{}", "asset is missing (line 1, column "),
            ("{", "EOF while parsing an object (line 1, column "),
        ] {
            let said = said(text);
            assert!(said.starts_with(expected), "{text}: {said}");
            assert!(!said.contains("struct"), "{said}");
        }
        let long = said(&format!("{{\"asset\": \"{}\"}}", "a".repeat(10_000)));
        assert!(long.len() < 200, "{long}");
    }
}
