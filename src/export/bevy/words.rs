//! Names and values of a scene, written as Rust.

use glam::Vec3;

use crate::{
    optics::colour::Encoding,
    parameter::{Parameter, Value, Values, lanes},
    text::capitalised,
};

/// The name of a package: lower-case letters, digits and underscores, beginning with a letter.
pub(super) fn package(stem: &str) -> String {
    let name = snake(stem);
    if name.is_empty() {
        "scene".to_owned()
    } else if is_reserved(&name) {
        format!("{name}_scene")
    } else {
        name
    }
}

/// Names that a package cannot have: Rust keywords, standard crates, cargo's folders, and names used here.
const RESERVED: &str = include_str!("reserved.txt");

/// True if a name is one of them.
fn is_reserved(name: &str) -> bool {
    RESERVED.lines().any(|word| word == name)
}

/// A text as a lower-case Rust name; empty if nothing remains.
pub(super) fn snake(text: &str) -> String {
    let mut name = String::new();
    for c in deunicode::deunicode(text).chars() {
        if c.is_ascii_alphanumeric() {
            name.push(c.to_ascii_lowercase());
        } else if !name.is_empty() && !name.ends_with('_') {
            name.push('_');
        }
    }
    let name = name.trim_end_matches('_');
    /// Maximum length of a name: longer ones are sentences.
    const LONGEST: usize = 32;
    let name = name.get(..LONGEST).unwrap_or(name).trim_end_matches('_');
    if name.starts_with(|c: char| c.is_ascii_digit()) { format!("_{name}") } else { name.to_owned() }
}

/// Converts a lower-case name to a type name.
pub(super) fn camel(snake: &str) -> String {
    // Two underscores in a row distinguish names that would look alike.
    let capital = |word: &str| if word.is_empty() { "_".to_owned() } else { capitalised(word) };
    snake.split('_').map(capital).collect()
}

/// A number.
pub(super) fn number(x: f32) -> String {
    format!("{x:?}")
}

/// A vector.
pub(super) fn vector(v: Vec3) -> String {
    if v == Vec3::ZERO {
        return "Vec3::ZERO".to_owned();
    }
    if v == Vec3::ONE {
        return "Vec3::ONE".to_owned();
    }
    format!("Vec3::new({:?}, {:?}, {:?})", v.x, v.y, v.z)
}

/// The type of a parameter.
pub(super) fn kind(wgsl: &str) -> String {
    match lanes(wgsl) {
        1 => wgsl.to_owned(),
        n => format!("Vec{n}"),
    }
}

/// The value of a parameter, with a comment if the number is not self-explanatory.
pub(super) fn value(p: &Parameter, values: &Values, encoding: Encoding) -> (String, Option<String>) {
    let (given, mut words) = (values.get(p), Vec::new());
    if let (Value::Colour([r, g, b]), Encoding::Srgb) = (&given, encoding) {
        return (format!("srgb({r}, {g}, {b})"), None);
    }
    p.kind.words(&given, encoding, &mut words);
    let all: Vec<_> = words.iter().map(|word| f32::from_bits(*word)).collect();
    match (p.kind.wgsl(), &all[..]) {
        ("u32", _) => {
            let name = p.kind.options().get(words[0] as usize).map(|(_, name)| (*name).to_owned());
            (words[0].to_string(), name)
        }
        (_, [one]) => (number(*one), None),
        (_, [x, y, z]) => (vector(Vec3::new(*x, *y, *z)), None),
        (wgsl, all) => {
            let all: Vec<_> = all.iter().map(|one| number(*one)).collect();
            (format!("{}::new({})", kind(wgsl), all.join(", ")), None)
        }
    }
}

/// The name of a struct field: the parameter's name, unless it is a Rust keyword.
pub(super) fn field(name: &str) -> String {
    if is_reserved(name) { format!("{name}_") } else { name.to_owned() }
}

/// True for characters that change the text direction.
fn turns(c: char) -> bool {
    matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// A text for comments: one line, without control characters of terminals or editors.
pub(super) fn comment(text: &str) -> String {
    text.replace(|c: char| c.is_control() || turns(c), " ")
}

/// A text as a Rust string.
pub(super) fn string(text: &str) -> String {
    // Debug escapes control characters.
    format!("{:?}", text.replace(turns, ""))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_fields_are_harmless() {
        assert_eq!(comment("a\u{202e}b\n\u{1b}[0m é"), "a b  [0m é");
        assert_eq!((field("in"), field("alpha")), ("in_".to_owned(), "alpha".to_owned()));
    }

    #[test]
    fn names_are_legal() {
        for (text, expected) in [
            ("Gold, three lights", "gold_three_lights"),
            ("3 spheres", "_3_spheres"),
            ("Größe", "grosse"),
            ("---", ""),
            ("an object whose name is a whole sentence of its own", "an_object_whose_name_is_a_whole"),
        ] {
            assert_eq!(snake(text), expected);
        }
        assert_eq!(package("---"), "scene");
        assert_eq!(
            (package("Bevy"), package("test"), package("lamp")),
            ("bevy_scene".into(), "test_scene".into(), "lamp".into())
        );
        assert_eq!(camel("blinn_phong"), "BlinnPhong");
    }
}
