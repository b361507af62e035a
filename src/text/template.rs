//! Texts with places that are filled in, and with parts that are left out.

use std::fmt::{Display, Write as _};

/// The text without the parts that are not wanted: `[[a b]]` on a line of its own begins one that is used if `a` or `b`
/// is wanted, and `[[]]` ends it.
pub(crate) fn chosen(text: &str, wanted: impl Fn(&str) -> bool) -> String {
    let mut used = true;
    let mut chosen = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        match line.strip_prefix("[[").and_then(|line| line.trim_end().strip_suffix("]]")) {
            Some(names) => used = names.is_empty() || names.split(' ').any(&wanted),
            None if used => chosen.push_str(line),
            None => {}
        }
    }
    chosen
}

/// A text with its `{{places}}` filled. The inserted text is not searched for places.
pub(crate) fn filled(text: &str, places: &[(&str, &dyn Display)]) -> String {
    let mut filled = String::new();
    let mut parts = text.split("{{");
    filled.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let found = part.split_once("}}").and_then(|(name, after)| {
            let (_, value) = places.iter().find(|(known, _)| *known == name)?;
            Some((value, after))
        });
        let _ = match found {
            Some((value, after)) => write!(filled, "{value}{after}"),
            None => write!(filled, "{{{{{part}"),
        };
    }
    filled
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_filled_once() {
        assert_eq!(filled("a {{x}} {{y}} {{z", &[("x", &"{{y}}"), ("y", &2)]), "a {{y}} 2 {{z");
    }

    #[test]
    fn parts_are_used_if_they_are_wanted() {
        let text = "1\n[[a]]\n2\n[[b c]]\n3\n[[]]\n4\n";
        assert_eq!(chosen(text, |name| name == "a"), "1\n2\n4\n");
        assert_eq!(chosen(text, |name| name == "c"), "1\n3\n4\n");
        assert_eq!(chosen(text, |_| false), "1\n4\n");
    }
}
