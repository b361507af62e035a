//! Short lists as typed by people: on the command line and in the cells of a table.

use std::str::FromStr;

/// The items of a list, each with its byte: `255 128 0`, `255, 128, 0`, `255; 128; 0`, with or without
/// enclosing brackets. An item between two separators may be empty.
#[must_use]
pub fn items(text: &str) -> Vec<(usize, &str)> {
    let trimmed = text.trim();
    let inner = trimmed.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')).unwrap_or(trimmed);
    let separated = inner.contains([',', ';']);
    let raw: Vec<_> =
        if separated { inner.split([',', ';']).collect() } else { inner.split_whitespace().collect() };
    // Slices of one text: their distance is their position.
    let place = |item: &str| item.as_ptr() as usize - text.as_ptr() as usize;
    raw.into_iter().map(str::trim).map(|item| (place(item), item)).collect()
}

/// Every item of a list as a number; `None` if one of them is not a number.
#[must_use]
pub fn numbers<T: FromStr>(text: &str) -> Option<Vec<T>> {
    items(text).into_iter().map(|(_, item)| item.parse().ok()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_are_read_as_people_write_them() {
        for text in ["255 128 0", "255,128,0", " 255 ;128; 0", "[255, 128, 0]", "[ 255 128\t0 ]"] {
            let found = items(text);
            assert_eq!(
                found.iter().map(|(_, item)| *item).collect::<Vec<_>>(),
                ["255", "128", "0"],
                "{text}"
            );
            for (at, item) in found {
                assert!(text[at..].starts_with(item), "{text}");
            }
        }
        assert_eq!(items("0.5"), [(0, "0.5")]);
        // The wrong twins: something is missing or superfluous.
        for text in ["1,,2", "1, 2,", "[1, 2"] {
            assert!(items(text).iter().any(|(_, item)| item.parse::<f32>().is_err()), "{text}");
        }
        assert!(items("1, 2 3").iter().any(|(_, item)| item.parse::<f32>().is_err()));
        assert!(items("").is_empty());
    }
}
