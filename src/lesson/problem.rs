//! The problems of a lesson: each is a sentence with its position and the affected line.

use std::fmt;

use annotate_snippets::{AnnotationKind, Level, Origin, Renderer, Snippet};
use serde::Serialize;

use super::{limits::MAX_PROBLEMS, words::Piece};
use crate::{
    files::printable,
    text::{
        did_you_mean, is_invisible, listed,
        place::{Lines, Place},
        quoted,
    },
};

/// A problem of a lesson.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Problem {
    /// Position in the file; `None` for the whole file.
    #[serde(flatten)]
    pub place: Option<Place>,
    /// The mistake and the remedy.
    pub message: String,
    /// The line at that position, as far as it is shown.
    #[serde(skip)]
    pub source: String,
}

impl Problem {
    /// A problem with a file as a whole.
    #[must_use]
    pub fn of_file(message: impl Into<String>) -> Self {
        Self { place: None, message: message.into(), source: String::new() }
    }

    /// The problem as lines of plain text: the message, file, line and column, the line itself and a caret.
    #[must_use]
    pub fn annotated(&self, file: &str) -> String {
        // The annotation crate escapes control characters only in ASCII.
        let fit = |text: &str| text.replace(|c: char| is_invisible(c) && !c.is_ascii(), "\u{fffd}");
        let (file, message) = (printable(file), fit(&self.message));
        let Some(place) = self.place else {
            return format!("error: {file}: {}", printable(&self.message));
        };
        let (source, title) = (fit(&self.source), Level::ERROR.primary_title(&message));
        if place.column > source.chars().count() + 1 {
            let origin = Origin::path(&*file).line(place.line).char_column(place.column);
            return Renderer::plain().render(&[title.element(origin)]);
        }
        let mut characters = source.char_indices().skip(place.column.saturating_sub(1));
        let end = source.len();
        let start = characters.next().map_or(end, |(at, _)| at);
        let next = characters.next().map_or(end, |(at, _)| at);
        let snippet = Snippet::source(&source)
            .line_start(place.line)
            .path(&*file)
            .annotation(AnnotationKind::Primary.span(start..next));
        Renderer::plain().render(&[title.element(snippet)])
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.place {
            Some(place) => write!(f, "{place}: {}", self.message),
            None => f.write_str(&self.message),
        }
    }
}

/// The problems found so far in a text, by byte.
pub(super) struct Problems<'a> {
    text: &'a str,
    found: Vec<(usize, String)>,
}

impl<'a> Problems<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        Self { text, found: Vec::new() }
    }

    /// Adds a problem at a byte.
    pub(super) fn at(&mut self, at: usize, message: impl Into<String>) {
        self.found.push((at, message.into()));
    }

    /// The known key of an entry, which may be given once.
    pub(super) fn key(
        &mut self,
        key: Piece,
        (place, word): (&str, &str),
        known: &[&'static str],
        given: &mut Vec<&'static str>,
    ) -> Option<&'static str> {
        let Some(found) = known.iter().find(|known| **known == key.text) else {
            let near = did_you_mean(key.text, known.iter().map(|k| (*k, *k)));
            let (written, all) = (quoted(key.text), listed(known, "and"));
            self.at(key.at, format!("{place} has no {word} {written}; its {word}s are {all}{near}"));
            return None;
        };
        if given.contains(found) {
            self.at(key.at, format!("{found} is given twice; remove one"));
            return None;
        }
        given.push(found);
        Some(found)
    }

    /// Appends words to the last problem found at a byte.
    pub(super) fn add(&mut self, at: usize, words: &str) {
        if let Some((_, message)) = self.found.iter_mut().rev().find(|(found, _)| *found == at) {
            message.push_str(words);
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.found.is_empty()
    }

    /// True if further problems would not help.
    pub(super) fn are_enough(&self) -> bool {
        self.found.len() >= MAX_PROBLEMS
    }

    pub(super) fn count(&self) -> usize {
        self.found.len()
    }

    /// All problems, in textual order.
    pub(super) fn finish(mut self) -> Vec<Problem> {
        self.found.sort_by_key(|(at, _)| *at);
        self.found.dedup();
        self.found.truncate(MAX_PROBLEMS);
        let lines = Lines::new(self.text);
        let line_of = |at: usize| {
            let at = at.min(self.text.len());
            let start = self.text[..at].rfind('\n').map_or(0, |i| i + 1);
            let line = self.text[start..].lines().next().unwrap_or_default();
            // A line may be as long as the file; mistakes beyond this have no line to show.
            line.chars().take(4000).collect()
        };
        self.found
            .into_iter()
            .map(|(at, message)| Problem { place: Some(lines.place(at)), source: line_of(at), message })
            .collect()
    }
}
