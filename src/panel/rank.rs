//! Ranking of names by a few letters: whole words first, then beginnings of words, initials, parts of words, and letters
//! with gaps. Search by such letters takes one function; crates for it bring tables for files and shells.

/// More words of a search than a name has are left out.
const MOST: usize = 12;

/// The rank of what is called exactly as the search, above every other.
const NAMED: i32 = 100_000;
/// What another name adds that is exactly the search: who types it means this, not what has the word in its name.
const ALSO_NAMED: i32 = 10_000;
/// What a name adds that begins with the search: more than a short one does.
const BEGINS: i32 = 100;
/// The rank of a word that is said beside the name.
const SAID: i32 = 20;
/// Amount by which letters with gaps rank behind everything else.
const GAPS: i32 = 100_000;

/// The words of a text, in lower case.
fn words(text: &str) -> Vec<String> {
    let lower = text.to_lowercase();
    let parts = lower.split(|c: char| c.is_whitespace() || "–-_,&()/:;.…‘’“”'\"".contains(c));
    parts.filter(|word| !word.is_empty()).map(str::to_owned).collect()
}

/// The letters in a text that are one after another those of a word, if all are there; the fewer gaps, the better.
fn with_gaps(text: &[char], word: &[char]) -> Option<i32> {
    let begin = text.iter().position(|c| c == word.first().unwrap_or(c))?;
    let (mut at, mut gaps) = (begin, 0);
    for letter in &word[1..] {
        let step = text[at + 1..].iter().position(|c| c == letter)?;
        gaps += i32::from(step > 0);
        at += step + 1;
    }
    let spread = (at - begin + 1 - word.len()) as i32;
    Some((18 - 3 * gaps - spread / 2).max(1))
}

/// The score of one word against the words of a name.
fn fit(name: &[String], word: &str) -> Option<i32> {
    let early = |at: usize| 4 - (at as i32).min(4);
    let first = |is: &dyn Fn(&str) -> bool| name.iter().position(|own| is(own));
    if let Some(at) = first(&|own| own == word) {
        return Some(100 + early(at));
    }
    if let Some(at) = first(&|own| own.starts_with(word)) {
        return Some(80 + early(at));
    }
    let letters: Vec<char> = word.chars().collect();
    let initials: String = name.iter().filter_map(|own| own.chars().next()).collect();
    if letters.len() > 1 && initials.contains(word) {
        return Some(60);
    }
    if letters.len() > 1 && first(&|own| own.contains(word)).is_some() {
        return Some(40);
    }
    if letters.len() < 3 {
        return None;
    }
    with_gaps(&name.join(" ").chars().collect::<Vec<_>>(), &letters)
}

/// Leaves out what is found by letters with gaps, which fit by chance: they count where nothing else does.
pub(super) fn leave_out_chance<T>(found: &mut Vec<(i32, T)>) {
    if found.iter().any(|(rank, _)| *rank > 0) {
        found.retain(|(rank, _)| *rank > 0);
    }
}

/// The score of a search against a name, or else other names and what more there is to say; below 0 if it takes letters with
/// gaps, `None` if a word of the search fits nothing.
pub(super) fn rank(name: &str, others: &[&str], more: &str, search: &str) -> Option<i32> {
    let (lower, typed) = (name.to_lowercase(), search.trim().to_lowercase());
    if lower == typed {
        return Some(NAMED);
    }
    let whole = if others.iter().any(|other| other.to_lowercase() == typed) {
        ALSO_NAMED
    } else if lower.starts_with(&typed) {
        BEGINS
    } else {
        0
    };
    let (own, more) = (words(name), words(&format!("{} {more}", others.join(" "))));
    let (mut all, mut gaps) = (0, false);
    for word in words(search).into_iter().take(MOST) {
        let said = || more.iter().any(|other| other.starts_with(&word)).then_some(SAID);
        let fits = fit(&own, &word);
        // A word that is said is meant, rather than letters with gaps.
        let fits = fits.filter(|fits| *fits > SAID).or_else(said).or(fits)?;
        all += 10 * fits;
        gaps |= fits < SAID;
    }
    all -= if gaps { GAPS } else { 0 };
    // Of those that fit alike, the shorter.
    Some(all + whole - own.iter().map(|word| word.chars().count() as i32).sum::<i32>().min(60))
}

#[cfg(test)]
mod tests {
    use std::cmp::Reverse;

    use super::*;

    /// The names that a search finds, the best first.
    fn found<'a>(names: &[&'a str], search: &str) -> Vec<&'a str> {
        let mut all: Vec<_> =
            names.iter().filter_map(|name| rank(name, &[], "", search).map(|rank| (rank, *name))).collect();
        all.sort_by_key(|(rank, _)| -rank);
        all.into_iter().map(|(_, name)| name).collect()
    }

    #[test]
    fn whole_words_come_before_beginnings_initials_parts_and_gaps() {
        let names =
            ["Save", "Save as…", "Theme: Dark", "Set observer to this view", "Resave it", "Scattered vapour"];
        assert_eq!(found(&names, "save")[..3], ["Save", "Save as…", "Resave it"]);
        assert_eq!(found(&names, "sav")[0], "Save");
        assert_eq!(found(&names, "sot")[0], "Set observer to this view", "by initials");
        assert_eq!(found(&names, "obsr"), ["Set observer to this view"], "with gaps");
        assert_eq!(found(&names, "dark theme"), ["Theme: Dark"], "in any order");
        assert_eq!(found(&names, "save dark"), Vec::<&str>::new(), "every word counts");
        assert_eq!(found(&names, "").len(), names.len());
        assert!(found(&names, "qq").is_empty() && found(&names, "…").len() == names.len());
    }

    #[test]
    fn what_more_there_is_to_say_counts_less_than_a_name() {
        let by_name = rank("PNG", &[], "", "png").expect("found");
        let said = rank("Save the picture…", &[], "Write a PNG file", "png").expect("found");
        assert!(by_name > said);
        assert_eq!(rank("Save", &[], "Write a file", "ng"), None);
        // Where it is said, letters with gaps do not count.
        assert_eq!(rank("Phong", &[], "pin", "pin"), rank("Lobes", &[], "pin", "pin"));
    }

    #[test]
    fn what_has_the_very_name_comes_first_then_what_is_also_called_so_then_what_begins_so() {
        let all: [(&str, &[&str]); 5] = [
            ("Flakes of steel", &[]),
            ("Steel, brushed, oiled and etched", &[]),
            ("Alloy", &["Steel"]),
            ("Steel", &[]),
            ("Old steel", &[]),
        ];
        let mut found = all.map(|(name, others)| (rank(name, others, "", " steel "), name));
        found.sort_by_key(|(rank, _)| Reverse(*rank));
        let expected = ["Steel", "Alloy", "Steel, brushed, oiled and etched", "Old steel", "Flakes of steel"];
        assert_eq!(found.map(|(_, name)| name), expected);
        assert!(rank("Steel", &[], "", "Old steel").is_none(), "only a part of it");
    }

    #[test]
    fn nothing_typed_is_too_much() {
        for search in ["α", "ﬃ𝄞", "\u{0}\u{202e}", &"a ".repeat(2000), &"x".repeat(20_000)] {
            let _ = rank("Blinn–Phong, normalised", &["Blinn"], "Blinn 1977 α_x", search);
        }
        assert!(rank("Phong", &[], "shininess α", "α").is_some());
    }
}
