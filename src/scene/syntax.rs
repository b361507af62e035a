//! Syntax errors of JSON: their position, the expectation there, and the most common slips by name.

use serde::{Deserialize as _, de::IgnoredAny};

use crate::text::{
    is_hard_to_see,
    json::{slip, word_at},
    named_character, shortened,
};

/// Maximum nesting of JSON. Scenes need four levels.
pub const MAX_DEPTH: usize = 64;
/// Maximum number of values of a scene in JSON: lists, objects, numbers, texts, `true`, `false` and `null`.
/// Each takes up to 300 bytes in memory, but may take only two in the text. 10 000 objects with every
/// parameter of all models have half.
pub const MAX_VALUES: usize = 4_000_000;

/// Strict JSON, or the first wrong byte and the expectation there.
pub(crate) fn check_syntax(text: &str) -> Result<(), (usize, String)> {
    let mut json = serde_json::Deserializer::from_str(text);
    let strict = IgnoredAny::deserialize(&mut json).and_then(|_| json.end());
    strict.map_err(|e| explain(text, &e))?;
    match too_much(text, MAX_VALUES) {
        Some(problem) => Err(problem),
        None => Ok(()),
    }
}

/// The position where JSON exceeds [`MAX_DEPTH`] or has more than `most` values, and which of them. Called
/// before a tree is built.
fn too_much(text: &str, most: usize) -> Option<(usize, String)> {
    let (mut depth, mut values) = (0usize, 0usize);
    let (mut in_text, mut escaped, mut in_word) = (false, false, false);
    for (at, byte) in text.bytes().enumerate() {
        let mut begins = false;
        match byte {
            _ if escaped => escaped = false,
            b'\\' if in_text => escaped = true,
            b'"' => {
                in_text = !in_text;
                begins = in_text;
            }
            _ if in_text => {}
            b'{' | b'[' => {
                depth += 1;
                if depth > MAX_DEPTH {
                    let what = format!("nested more than {MAX_DEPTH} levels deep; four are enough");
                    return Some((at, what));
                }
                begins = true;
            }
            b'}' | b']' => (depth, in_word) = (depth - 1, false),
            // What was counted last is a key.
            b':' => values -= 1,
            b',' | b' ' | b'\t' | b'\n' | b'\r' => in_word = false,
            // A number, true, false or null.
            _ => begins = !std::mem::replace(&mut in_word, true),
        }
        if begins {
            values += 1;
            if values > most {
                let what = format!(
                    "more than {most} values (lists, objects, numbers and texts); the largest scene has fewer"
                );
                return Some((at, what));
            }
        }
    }
    None
}

/// How errors within a text begin whose surroundings are no JSON.
const IN_TEXT: [&str; 3] = ["invalid escape", "lone leading surrogate", "unexpected end of hex escape"];

/// The expectation, and a hint for common mistakes.
fn explain(text: &str, error: &serde_json::Error) -> (usize, String) {
    if error.is_eof() {
        let said = error.to_string();
        let within = [("a string", "a text"), ("a list", "a list"), ("an object", "an object")]
            .into_iter()
            .find(|(theirs, _)| said.contains(theirs))
            .map_or("where a value was expected".to_owned(), |(_, ours)| format!("within {ours}"));
        return (text.len(), format!("the file ends {within}; it seems to be truncated"));
    }
    let line_start: usize =
        text.split_inclusive('\n').take(error.line().saturating_sub(1)).map(str::len).sum();
    let mut at = (line_start + error.column().saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    let rest = &text[at..];
    let found = rest.chars().next();
    let (start, word) = word_at(text, at);
    let before = text[..start].trim_end().chars().next_back();
    let said = error.to_string();
    let said = said.split(" at line ").next().unwrap_or_default();
    let is_value = said != "key must be a string";
    let in_text = IN_TEXT.iter().any(|kind| said.starts_with(kind));

    let what = if in_text {
        said.to_owned()
    } else if rest.starts_with("//") || rest.starts_with("/*") || found == Some('#') {
        "comments are not part of JSON; remove them, or write a \"description\"".to_owned()
    } else if found == Some('\'') {
        "text and keys need double quotes (\"), not single ones (')".to_owned()
    } else if matches!(found, Some('“' | '”' | '„')) {
        "text and keys need straight double quotes (\"), not typographic ones".to_owned()
    } else if matches!(found, Some('}' | ']')) && before == Some(',') {
        "there is a comma after the last entry; remove it".to_owned()
    } else if let Some(slip) = slip(word).filter(|_| is_value) {
        at = start;
        slip
    } else {
        match said {
            "expected value" => format!(
                "expected a value (text in double quotes, a number, a list or an object), not {}",
                shown(found, word)
            ),
            "key must be a string" => format!("expected a key in double quotes, not {}", shown(found, word)),
            "trailing characters" => {
                format!("expected the end of the file after the scene, not {}", shown(found, word))
            }
            "invalid number" => format!("{} is not a number in JSON", shown(found, word)),
            "expected ident" => {
                at = start;
                format!("{word} is not JSON; only true, false and null have no quotes")
            }
            s if s.starts_with("control character") => {
                at += rest.find(char::is_control).unwrap_or_default();
                "a line break or control character in a text; end the text with \" or write \\n".to_owned()
            }
            s if s.starts_with("expected") => {
                // A word that ends before is not to blame.
                let word = if at < start + word.len() { word } else { "" };
                format!("{s}, not {}", shown(found, word))
            }
            s => s.to_owned(),
        }
    };
    (at, what)
}

/// The text at a place, for a message.
fn shown(found: Option<char>, word: &str) -> String {
    match found {
        // Part of no word: one before it is not to blame.
        Some(c) if is_hard_to_see(c) && !c.is_ascii_whitespace() => {
            format!("the character {}", named_character(c))
        }
        _ if word.chars().count() > 1 => shortened(word),
        Some('\n' | '\r') => "the end of the line".to_owned(),
        Some(c) if is_hard_to_see(c) => format!("the character {}", named_character(c)),
        Some(c) => format!("`{c}`"),
        None => "the end of the file".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        registry::Registry,
        scene::load::{Defaults, from_text},
    };

    use super::{MAX_VALUES, check_syntax, too_much};

    #[test]
    fn syntax_errors_say_where_and_what_was_expected() {
        for (text, place, expected) in [
            ("{\"a\": 1", "1:8", "the file ends within an object; it seems to be truncated"),
            ("[1, 2", "1:6", "the file ends within a list"),
            ("{\"a\": \"x", "1:9", "the file ends within a text"),
            ("{\"a\":", "1:6", "the file ends where a value was expected"),
            ("{\"a\": 1,}", "1:9", "comma after the last entry"),
            ("[1,\n]", "2:1", "comma after the last entry"),
            ("{\"a\": NaN}", "1:7", "NaN is not a number in JSON"),
            ("{\"a\": -Infinity}", "1:7", "-Infinity is not a number in JSON"),
            ("{\"a\": Infinity}", "1:7", "Infinity is not a number in JSON"),
            ("{\"a\": True}", "1:7", "lower case"),
            ("{\"a\": nul}", "1:7", "nul is not JSON"),
            ("{\"a\": .5}", "1:7", "numbers begin with a digit"),
            ("{\"a\": -.5}", "1:7", "numbers begin with a digit"),
            ("{\"a\": +5}", "1:7", "no plus sign"),
            ("{\"a\": 0x1F}", "1:7", "decimal"),
            ("[-1.5}", "1:6", "expected `,` or `]`, not `}`"),
            ("{\"a\": 01}", "1:8", "is not a number in JSON"),
            ("{\"a\": 1 \"b\": 2}", "1:9", "expected `,` or `}`"),
            ("{\"a\" 1}", "1:6", "expected `:`"),
            ("{a: 1}", "1:2", "expected a key in double quotes"),
            ("{'a': 1}", "1:2", "not single ones"),
            ("{\"a\": 1} x", "1:10", "expected the end of the file"),
            ("{ // size\n}", "1:3", "comments"),
            ("{\"a\": \"x\ny\"}", "1:9", "line break"),
            (r#"{"a": ".5\.1"}"#, "1:11", "invalid escape"),
            (r#"{"a": "x = 2\inf"}"#, "1:14", "invalid escape"),
            (r#"{"a": "it\'s"}"#, "1:11", "invalid escape"),
            ("{“a”: 1}", "1:2", "typographic"),
            ("}", "1:1", "expected a value"),
            ("\u{feff}\u{feff}{}", "1:1", "not the character U+FEFF (byte order mark)"),
            ("{\u{200b}\"a\": 1}", "1:2", "not the character U+200B (zero-width space)"),
            ("{\"a\":\u{a0}1}", "1:6", "not the character U+00A0 (no-break space)"),
            ("{\"a\": 12\u{a0}}", "1:9", "not the character U+00A0 (no-break space)"),
        ] {
            let error = from_text(text, "s.json", &Registry::builtin(), Defaults::Use).expect_err(text);
            let said = error.to_string();
            assert!(said.starts_with(&format!("s.json:{place}: not JSON: ")), "{text:?}: {said}");
            assert!(said.contains(expected), "{text:?}: {said}");
        }
    }

    #[test]
    fn deep_nesting_is_an_error_and_no_overflow_of_the_stack() {
        let text = "[".repeat(1_000_000) + &"]".repeat(1_000_000);
        let error = from_text(&text, "s.json", &Registry::builtin(), Defaults::Use).expect_err("deep");
        assert_eq!(
            error.to_string(),
            "s.json:1:65: not JSON: nested more than 64 levels deep; four are enough"
        );
    }

    #[test]
    fn more_values_than_a_scene_has_are_an_error_before_they_take_memory() {
        let said = |most| {
            format!(
                "more than {most} values (lists, objects, numbers and texts); the largest scene has fewer"
            )
        };
        for (unit, values) in [
            ("[], ", 1),
            ("-1.5e3 ,\n", 1),
            ("\"a\\\",[\",", 1),
            ("{\"a\":[true]},", 3),
            ("[{}],", 2),
            ("{\"a\" : \"b\" ,\"c\":null},", 3),
        ] {
            // The object, the lists, and the last number of each are five values.
            let text = format!("{{\"a\": [{0}0], \"q\": [{0}0]}}", unit.repeat(10));
            let most = 5 + 20 * values;
            assert_eq!(too_much(&text, most), None, "{unit}");
            assert_eq!(too_much(&text, most - 1), Some((text.len() - 3, said(most - 1))), "{unit}");
        }
        let zeros = |count| format!("[{}0]", "0,".repeat(count - 1));
        assert_eq!(check_syntax(&zeros(MAX_VALUES - 1)), Ok(()));
        let text = zeros(MAX_VALUES);
        assert_eq!(check_syntax(&text), Err((text.len() - 2, said(MAX_VALUES))));
    }
}
