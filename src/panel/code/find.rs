//! Finding and replacing in a text.

use std::ops::Range;

/// Most places that are found and marked.
pub const MOST_FOUND: usize = 10_000;

/// The places of a text within another, from left to right and apart from each other. Without `exact`, A–Z count as
/// a–z.
#[must_use]
pub fn find(text: &str, wanted: &str, exact: bool) -> Vec<Range<usize>> {
    if wanted.is_empty() {
        return Vec::new();
    }
    let places = |text: &str, wanted: &str| {
        let all = text.match_indices(wanted).take(MOST_FOUND);
        all.map(|(at, found)| at..at + found.len()).collect()
    };
    match exact {
        true => places(text, wanted),
        // Bytes stay where they are.
        false => places(&text.to_ascii_lowercase(), &wanted.to_ascii_lowercase()),
    }
}

/// A text with these places replaced, which are in order.
#[must_use]
pub fn replace(text: &str, places: &[Range<usize>], by: &str) -> String {
    let (mut all, mut at) = (String::with_capacity(text.len()), 0);
    for place in places {
        all += &text[at..place.start];
        all += by;
        at = place.end;
    }
    all + &text[at..]
}

/// The index of the place after a byte, or of the one before it; from the end it goes on at the start.
#[must_use]
pub fn next(places: &[Range<usize>], at: usize, backwards: bool) -> Option<usize> {
    match backwards {
        false => places.iter().position(|place| place.start >= at).or(places.first().map(|_| 0)),
        true => places.iter().rposition(|place| place.end < at).or(places.len().checked_sub(1)),
    }
}

/// The bytes of a line, from 1, without its end; the last one if there are fewer.
pub(super) fn line(text: &str, number: usize) -> Range<usize> {
    let mut start = 0;
    for _ in 1..number {
        match text[start..].find('\n') {
            Some(at) => start += at + 1,
            None => break,
        }
    }
    let end = text[start..].find('\n').map_or(text.len(), |at| start + at);
    start..end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_apart_and_in_order() {
        assert_eq!(find("aaaa", "aa", true), [0..2, 2..4]);
        assert_eq!(find("Roughness roughness ROUGHNESS", "roughness", false), [0..9, 10..19, 20..29]);
        assert_eq!(find("Roughness roughness roughness", "roughness", true), [10..19, 20..29]);
        assert_eq!(find("é É é", "é", false), [0..2, 6..8], "only A to Z have two forms");
        assert!(find("abc", "", true).is_empty() && find("", "a", true).is_empty());
        assert_eq!(find(&"a".repeat(1 << 18), "a", true).len(), MOST_FOUND);
    }

    #[test]
    fn what_is_replaced_is_no_more_than_what_was_found() {
        let text = "let α = alpha; // Alpha";
        assert_eq!(replace(text, &find(text, "alpha", false), "β"), "let α = β; // β");
        assert_eq!(replace(text, &find(text, "alpha", true), ""), "let α = ; // Alpha");
        assert_eq!(replace(text, &[], "x"), text);
    }

    #[test]
    fn the_next_place_goes_round() {
        let places = find("a.a.a", "a", true);
        assert_eq!([0, 1, 3, 5].map(|at| next(&places, at, false)), [Some(0), Some(1), Some(2), Some(0)]);
        assert_eq!([0, 2, 5].map(|at| next(&places, at, true)), [Some(2), Some(0), Some(1)]);
        assert_eq!(next(&[], 0, false), None);
    }
}
