//! The front matter: the lines between two lines `---` at the top of a lesson.

use super::{
    limits::LONGEST_TITLE,
    problem::Problems,
    words::{Line, lines, pair},
};
use crate::text::quoted;

/// The keys, in the order of the documentation.
const KEYS: [&str; 4] = ["title", "summary", "minutes", "scene"];
/// Longest lesson, in minutes.
const LONGEST: u32 = 120;

/// The front matter.
#[derive(Debug, Default)]
pub(super) struct Front {
    pub(super) title: String,
    pub(super) summary: String,
    pub(super) minutes: Option<u32>,
    /// The name of the scene and its byte.
    pub(super) scene: Option<(usize, String)>,
    /// The byte at which the steps begin.
    pub(super) end: usize,
}

/// Reads the front matter of a text.
pub(super) fn read(text: &str, problems: &mut Problems) -> Front {
    let mut front = Front::default();
    let mut all = lines(text, 0);
    let is_fence = |line: &Line| line.text.trim_end() == "---";
    let Some(first) = all.find(|line| !line.text.trim().is_empty()) else {
        problems.at(0, "the lesson is empty; begin it with a line ---, its title and its summary");
        return front;
    };
    if !is_fence(&first) {
        let remedy = "begin the file with a line ---, then title: and summary:, then a line ---";
        problems.at(first.at, format!("the front matter is missing; {remedy}"));
        return front;
    }
    let mut given = Vec::new();
    let mut closed = false;
    for line in all {
        front.end = line.end;
        if is_fence(&line) {
            closed = true;
            break;
        }
        if line.text.trim().is_empty() {
            continue;
        }
        if problems.are_enough() {
            return front;
        }
        if line.text.starts_with("##") {
            front.end = line.at;
            break;
        }
        let Some((key, value)) = pair(&line) else {
            problems.at(line.at, "each line of the front matter must be KEY: VALUE");
            continue;
        };
        let Some(known) = problems.key(key, ("the front matter", "key"), &KEYS, &mut given) else { continue };
        if value.text.is_empty() {
            problems.at(value.at, format!("{known} is empty"));
            continue;
        }
        if value.text.chars().nth(LONGEST_TITLE).is_some() {
            let what = format!("{known} has more than {LONGEST_TITLE} characters, the most allowed");
            problems.at(value.at, what);
            continue;
        }
        match known {
            "title" => value.text.clone_into(&mut front.title),
            "summary" => value.text.clone_into(&mut front.summary),
            "scene" => front.scene = Some((value.at, value.text.to_owned())),
            _ => match value.text.parse() {
                Ok(minutes @ 1..=LONGEST) => front.minutes = Some(minutes),
                _ => {
                    let rule = format!("it must be a whole number from 1 to {LONGEST}");
                    problems.at(value.at, format!("minutes is {}, but {rule}", quoted(value.text)));
                }
            },
        }
    }
    if !closed {
        problems.at(first.at, "the front matter is never closed; end it with a line ---");
    }
    for key in ["title", "summary"] {
        if !given.contains(&key) {
            problems.at(first.at, format!("the front matter has no {key}; add a line {key}: …"));
        }
    }
    front
}
