//! Texts with places for parts of a scene.

/// A text with its `{{places}}` filled. What is filled in is not looked at again.
pub(super) fn filled(text: &str, places: &[(&str, &str)]) -> String {
    let mut filled = String::new();
    let mut parts = text.split("{{");
    filled.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let found = part.split_once("}}").and_then(|(name, after)| {
            let (_, value) = places.iter().find(|(known, _)| *known == name)?;
            Some((value, after))
        });
        match found {
            Some((value, after)) => {
                filled.push_str(value);
                filled.push_str(after);
            }
            None => {
                filled.push_str("{{");
                filled.push_str(part);
            }
        }
    }
    filled
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_filled_once() {
        assert_eq!(filled("a {{x}} {{y}} {{z", &[("x", "{{y}}"), ("y", "2")]), "a {{y}} 2 {{z");
    }
}
