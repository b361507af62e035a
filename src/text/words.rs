//! Words for messages: lists, numbers, quotations, the nearest spelling.

use std::{borrow::Cow, mem};

use serde_json::Value as Json;

/// "a", "a or b", "a, b or c".
#[must_use]
pub fn listed(items: &[impl AsRef<str>], conjunction: &str) -> String {
    match items {
        [] => String::new(),
        [one] => one.as_ref().to_owned(),
        [first @ .., last] => {
            let first: Vec<_> = first.iter().map(AsRef::as_ref).collect();
            format!("{} {conjunction} {}", first.join(", "), last.as_ref())
        }
    }
}

/// A text in lines of at most so many characters, broken at spaces; at least one line. Longer words stay whole.
#[must_use]
pub fn wrapped(text: &str, width: usize) -> Vec<String> {
    let (mut lines, mut line) = (Vec::new(), String::new());
    for word in text.split_whitespace() {
        if line.chars().count() + 1 + word.chars().count() > width && !line.is_empty() {
            lines.push(mem::take(&mut line));
        } else if !line.is_empty() {
            line.push(' ');
        }
        line.push_str(word);
    }
    lines.push(line);
    lines
}

/// The target with the spelling nearest to the given one, if it is near enough. Each candidate is a spelling
/// and its target.
#[must_use]
pub fn nearest<'a>(written: &str, candidates: impl Iterator<Item = (&'a str, &'a str)>) -> Option<&'a str> {
    // Names are short; comparing a book with each of them would take forever.
    if written.len() > 64 {
        return None;
    }
    // Differences in case and separators are the most common: sceneSize, scene-size.
    let plain = |s: &str| s.to_lowercase().replace(['_', '-', ' '], "");
    let wanted = plain(written);
    let distance = |spelling: &str, target: &str| {
        let candidate = plain(spelling);
        let edits = strsim::damerau_levenshtein(&wanted, &candidate);
        // A third of the letters may differ; beyond that it is another word.
        let letters = candidate.chars().count().max(wanted.chars().count());
        // A symbol of a letter or two that is nearly written means nothing.
        let most = if letters < 3 && spelling != target { 0 } else { (letters + 1) / 3 };
        (edits <= most).then_some(edits)
    };
    let near = candidates.filter(|(spelling, _)| !spelling.is_empty());
    near.filter_map(|(spelling, target)| Some((distance(spelling, target)?, target)))
        .min_by_key(|n| n.0)
        .map(|n| n.1)
}

/// "; did you mean "lambert"?", or nothing.
#[must_use]
pub fn did_you_mean<'a>(written: &str, candidates: impl Iterator<Item = (&'a str, &'a str)>) -> String {
    nearest(written, candidates).map_or_else(String::new, |n| format!("; did you mean {}?", quoted(n)))
}

/// A message with an additional detail, inserted before a question at its end.
#[must_use]
pub fn detailed(message: &str, detail: &str) -> String {
    let question = message.rfind("; did you mean").filter(|_| message.ends_with('?'));
    let (said, question) = message.split_at(question.unwrap_or(message.len()));
    format!("{said}; {detail}{question}")
}

/// A decimal fraction without trailing zeros.
#[must_use]
pub fn trimmed(text: String) -> String {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A fraction in per cent, with two digits: "12 %", "1.2 %", "0.12 %", "< 0.01 %".
#[must_use]
pub fn per_cent(part: f32) -> String {
    match 100.0 * part {
        n if n > 0.0 && n < 0.01 => "< 0.01 %".to_owned(),
        n if n < 0.995 => format!("{n:.2} %"),
        n if n < 9.95 => format!("{n:.1} %"),
        n => format!("{n:.0} %"),
    }
}

/// A message as a sentence in a text: with a full stop, unless it ends with another mark.
#[must_use]
pub fn sentence(message: &str) -> String {
    let ended = message.ends_with(['.', '?', '!', '…']);
    format!("{message}{}", if ended { "" } else { "." })
}

/// A text with a capital letter at its beginning.
#[must_use]
pub fn capitalised(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

/// A digit or minus sign raised, as in 10⁻³; other characters stay.
#[must_use]
pub fn superscript(c: char) -> char {
    const DIGITS: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    if "-−".contains(c) { '⁻' } else { c.to_digit(10).map_or(c, |digit| DIGITS[digit as usize]) }
}

/// The rule that a value must be one of several words.
#[must_use]
pub fn one_of<'a>(what: &str, words: impl Iterator<Item = &'a str>) -> String {
    format!("{what} must be {}", listed(&words.map(quoted).collect::<Vec<_>>(), "or"))
}

/// A text in double quotes for messages, shortened and with control characters escaped.
#[must_use]
pub fn quoted(text: &str) -> String {
    shortened(&format!("{text:?}"))
}

/// The beginning of a text that is too long for a message, on one line: control characters become spaces, and other
/// invisible ones their code points, such as U+FEFF.
#[must_use]
pub fn shortened(text: &str) -> String {
    /// Maximum number of characters that read well within a sentence.
    const LONGEST: usize = 60;
    let (mut shown, mut rest) = (String::new(), text.chars());
    for c in rest.by_ref().take(LONGEST) {
        match c {
            c if c.is_control() => shown.push(' '),
            c if is_invisible(c) => shown += &code_point(c),
            c => shown.push(c),
        }
    }
    if rest.next().is_some() {
        shown.push('…');
    }
    shown
}

/// True for characters that show nothing, or change only the direction or the lines of others: control characters, byte
/// order marks, spaces without width. Joiners shape the letters beside them, so they count as visible.
#[must_use]
pub(crate) fn is_invisible(c: char) -> bool {
    c.is_control()
        || matches!(
            c,
            '\u{AD}' | '\u{61C}' | '\u{180E}' | '\u{200B}' | '\u{200E}' | '\u{200F}' | '\u{2028}'..='\u{202E}'
                | '\u{2060}'..='\u{206F}' | '\u{FEFF}' | '\u{FFF9}'..='\u{FFFB}'
        )
}

/// A character by its number: "U+FEFF".
#[must_use]
fn code_point(c: char) -> String {
    format!("U+{:04X}", u32::from(c))
}

/// True for characters that nobody finds by looking at the text: [invisible](is_invisible) ones, and spaces that are not
/// the one of the keyboard.
#[must_use]
pub(crate) fn is_hard_to_see(c: char) -> bool {
    is_invisible(c) || c.is_whitespace() && c != ' '
}

/// A character that is hard to see, by its number and its name if that is short: "U+FEFF (byte order mark)".
#[must_use]
pub(crate) fn named_character(c: char) -> String {
    let name = match c {
        '\u{A0}' => " (no-break space)",
        '\u{AD}' => " (soft hyphen)",
        '\u{200B}' => " (zero-width space)",
        '\u{200E}' => " (left-to-right mark)",
        '\u{200F}' => " (right-to-left mark)",
        '\u{2028}' => " (line separator)",
        '\u{2029}' => " (paragraph separator)",
        '\u{202F}' => " (narrow no-break space)",
        '\u{2060}' => " (word joiner)",
        '\u{3000}' => " (ideographic space)",
        '\u{FEFF}' => " (byte order mark)",
        _ => "",
    };
    code_point(c) + name
}

/// A rule that follows the name of what breaks it: "metallic is 2, but it must be …", not "but the metallic must be …".
#[must_use]
pub fn behind<'r>(name: &str, rule: &'r str) -> Cow<'r, str> {
    match rule.split_once(&format!("the {name} must be ")) {
        Some(("", range)) => Cow::Owned(format!("it must be {range}")),
        Some((kind, range)) if range.starts_with("between ") || range.starts_with("greater ") => {
            Cow::Owned(format!("{}, {range}", kind.trim_end_matches(": ")))
        }
        _ => Cow::Borrowed(rule),
    }
}

/// Facts in one line, without those that are empty: "GGX · B. Walter 2007".
#[must_use]
pub fn facts<const N: usize>(all: [&str; N]) -> String {
    let given: Vec<_> = all.into_iter().filter(|fact| !fact.is_empty()).collect();
    given.join(" · ")
}

/// "a sphere", "an icosahedron".
#[must_use]
pub fn with_article(id: &str) -> String {
    let article = if id.starts_with(['a', 'e', 'i', 'o', 'u']) { "an" } else { "a" };
    format!("{article} {id}")
}

/// "1 light", "2 lights".
#[must_use]
pub fn plural(n: usize, what: &str) -> String {
    if n == 1 { format!("1 {what}") } else { format!("{n} {what}s") }
}

/// The number as a person would write it: 0.1, not its nearest 32-bit neighbour in 64 bits.
#[must_use]
pub fn number(v: f32) -> Json {
    if v.fract() == 0.0 && v.abs() < 1e9 {
        return (v as i64).into();
    }
    v.to_string().parse::<f64>().ok().and_then(serde_json::Number::from_f64).map_or(Json::Null, Json::Number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_told_in_per_cent_with_two_digits() {
        let told = [0.0, 0.00001, 0.005, 0.00996, 0.0123, 0.0996, 0.123].map(per_cent);
        assert_eq!(told, ["0.00 %", "< 0.01 %", "0.50 %", "1.0 %", "1.2 %", "10 %", "12 %"]);
    }

    #[test]
    fn excerpts_show_what_is_invisible() {
        let told = shortened("a\u{feff}b\u{200b}\nc\u{202e}");
        assert_eq!(told, "aU+FEFFbU+200B cU+202E");
        assert!(!quoted("\u{feff}\u{1b}\u{2060}").contains(is_invisible));
        let family = "größe 中文 👩\u{200d}🔬";
        assert_eq!(shortened(family), family);
        assert_eq!(shortened(&"ö".repeat(60)), "ö".repeat(60));
        assert_eq!(shortened(&"\u{feff}".repeat(61)), "U+FEFF".repeat(60) + "…");
    }

    #[test]
    fn characters_that_are_hard_to_see_have_their_names() {
        for (c, told) in [
            ('\u{feff}', "U+FEFF (byte order mark)"),
            ('\u{200b}', "U+200B (zero-width space)"),
            ('\u{a0}', "U+00A0 (no-break space)"),
            ('\u{202e}', "U+202E"),
        ] {
            assert!(is_hard_to_see(c), "{told}");
            assert_eq!(named_character(c), told);
        }
        assert!(![' ', 'a', 'ö', '中'].into_iter().any(is_hard_to_see));
    }

    #[test]
    fn facts_that_are_not_given_leave_no_gap() {
        assert_eq!(facts(["GGX", "B. Walter 2007"]), "GGX · B. Walter 2007");
        assert_eq!(facts(["GGX", ""]), "GGX");
        assert_eq!(facts(["", "computed per pixel"]), "computed per pixel");
    }

    #[test]
    fn a_rule_does_not_repeat_the_name_before_it() {
        assert_eq!(behind("metallic", "the metallic must be 1"), "it must be 1");
        let text = behind("metallic", "it must be a number: the metallic must be between 0 and 1");
        assert_eq!(text, "it must be a number, between 0 and 1");
        for rule in ["the clear coat must be 1", "the clearcoat of it must be 1", "clearcoat must be 1"] {
            assert_eq!(behind("clearcoat", rule), rule);
        }
    }

    #[test]
    fn names_are_listed_as_people_do() {
        assert_eq!(listed(&["A"], "and"), "A");
        assert_eq!(listed(&["A", "B"], "and"), "A and B");
        assert_eq!(listed(&["A", "B", "C"], "and"), "A, B and C");
    }

    #[test]
    fn a_question_ends_its_message() {
        let question = did_you_mean("lambrt", [("lambert", "lambert")].into_iter());
        let message = format!("there is no lambrt{question}");
        assert_eq!(detailed(&message, "see a"), "there is no lambrt; see a; did you mean \"lambert\"?");
        assert_eq!(detailed("there is no x", "see a"), "there is no x; see a");
        assert_eq!(sentence(&message), message);
        assert_eq!(sentence("there is no x"), "there is no x.");
        assert_eq!(sentence("there is no …"), "there is no …");
    }

    #[test]
    fn suggestions_forgive_case_separators_and_slips() {
        let known = || ["scene_size", "lights", "objects"].map(|k| (k, k)).into_iter();
        assert_eq!(nearest("sceneSize", known()), Some("scene_size"));
        assert_eq!(nearest("lihgts", known()), Some("lights"));
        assert_eq!(nearest("object", known()), Some("objects"));
        assert_eq!(nearest("banana", known()), None);
        let symbols = || [("V_d", "abbe_number"), ("k_s", "k_s")].into_iter();
        assert_eq!(nearest("vd", symbols()), Some("abbe_number"));
        assert_eq!(nearest("k_d", symbols()), Some("k_s"));
        assert_eq!(nearest("k_d", symbols().take(1)), None, "a symbol is written as it is");
        assert_eq!(nearest(&"l".repeat(1 << 20), known()), None);
    }
}
