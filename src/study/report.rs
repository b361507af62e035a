//! The page with the chapters.

use std::time::UNIX_EPOCH;

use maud::{PreEscaped, html};

use super::{Chapter, Lab, PHENOMENA, StudyError, text::values};
use crate::{platform, text::plural};

/// The name of the program in the head of a report, followed by its version.
pub(super) const GENERATOR: &str = "Lights, Camera, Models! ";

const STYLE: &str = include_str!("report.css");

/// A date in words, from days since 1970: H. Hinnant (2013), *chrono-Compatible Low-Level Date Algorithms*,
/// `civil_from_days`.
fn date(days: i64) -> String {
    let z = days + 719_468;
    let era = z.div_euclid(146_097);
    let day_of_era = z.rem_euclid(146_097);
    let year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36_524 - day_of_era / 146_096) / 365;
    let day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let month = (5 * day_of_year + 2) / 153;
    let day = day_of_year - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = year_of_era + era * 400 + i64::from(month <= 2);
    const NAMES: &str =
        "January February March April May June July August September October November December";
    let name = NAMES.split(' ').nth(month as usize - 1).unwrap_or_default();
    format!("{day} {name} {year}")
}

fn today() -> String {
    let seconds = platform::now().duration_since(UNIX_EPOCH).map_or(0, |d| d.as_secs());
    date((seconds / 86_400) as i64)
}

/// The whole page.
pub(super) fn page(lab: &mut Lab, chapters: &[(&str, Chapter)]) -> Result<String, StudyError> {
    let (phenomena, beyond) = chapters.split_at(PHENOMENA);
    let shown = phenomena.iter().filter(|(_, chapter)| chapter.shown).count();
    let count = ["None", "One", "Two", "Three", "Four"][shown];
    let findings = |chapters: &[(&str, Chapter)]| {
        html! {
            @for (id, chapter) in chapters {
                li { a href=(format!("#{id}")) { (chapter.title) } ". " (chapter.finding) }
            }
        }
    };
    let sections = |chapters: &[(&str, Chapter)], first: usize| {
        html! {
            @for (i, (id, chapter)) in chapters.iter().enumerate() {
                section id=(id) { h2 { (first + i) ". " (chapter.title) } (chapter.body) }
            }
        }
    };
    let tables = chapters.iter().flat_map(|(_, chapter)| &chapter.tables).enumerate();
    let version = env!("CARGO_PKG_VERSION");
    let threads = plural(rayon::current_num_threads(), "thread");
    let values = values! {
        style: PreEscaped(STYLE.to_owned()), version, generator: format!("{GENERATOR}{version}"), today: today(),
        machine: format!("{}, {}, {threads}", std::env::consts::ARCH, std::env::consts::OS),
        quick: lab.settings.quick, all: shown == PHENOMENA, count, count_within: count.to_lowercase(),
        findings: findings(phenomena), findings_beyond: findings(beyond), phenomena: sections(phenomena, 1),
        // The discussion of the phenomena comes in between.
        beyond: sections(beyond, PHENOMENA + 2),
        tables: html! { @for (i, table) in tables { @if i > 0 { ", " } code { (table.name) ".csv" } } },
    };
    Ok(lab.filled(include_str!("report.html"), &values)?.into_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_those_of_the_calendar() {
        for (days, expected) in [
            (0, "1 January 1970"),
            (19_782, "29 February 2024"),
            (19_783, "1 March 2024"),
            (20_453, "31 December 2025"),
        ] {
            assert_eq!(date(days), expected);
        }
    }
}
