//! Text of Markdown with its styles: what lies within a paragraph, and a paragraph alone.

use std::ops::Range;

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

use super::{Run, RunStyle, problem::Problems, words::Piece};

/// Markdown beyond CommonMark: recognised, so that it is refused instead of shown as signs.
pub(super) fn options() -> Options {
    Options::ENABLE_TABLES | Options::ENABLE_FOOTNOTES | Options::ENABLE_STRIKETHROUGH
}

/// Gathers text with its styles.
#[derive(Default)]
pub(super) struct Runs {
    runs: Vec<Run>,
    styles: Vec<RunStyle>,
    /// The row of equal signs that was looked at last, and true if it was said to be stray.
    row: (Range<usize>, bool),
}

impl Runs {
    fn push(&mut self, text: &str, style: RunStyle) {
        match self.runs.last_mut() {
            Some(last) if last.style == style => last.text.push_str(text),
            _ => self.runs.push(Run { text: text.to_owned(), style }),
        }
    }

    pub(super) fn take(&mut self) -> Vec<Run> {
        self.styles.clear();
        std::mem::take(&mut self.runs)
    }

    /// Says a sign of emphasis that stands in a text as it is; once for a row of them.
    pub(super) fn check(
        &mut self,
        event: &Event,
        whole: Piece,
        range: &Range<usize>,
        problems: &mut Problems,
    ) {
        let Some(text) = whole.text.get(range.clone()).filter(|_| matches!(event, Event::Text(_))) else {
            return;
        };
        for (inside, sign) in text.match_indices(['*', '`']) {
            let at = range.start + inside;
            // A row may be as long as the text, and each of its signs an event of its own.
            if self.row.0.contains(&at) {
                continue;
            }
            self.row = row(whole.text, at, sign);
            if self.row.1 {
                let names =
                    if sign == "*" { "emphasis is *word*, bold is **word**" } else { "code is `word`" };
                let what = format!("this {sign} is not paired: {names}; write \\{sign} for the sign itself");
                problems.at(whole.at + at, what);
                return;
            }
        }
    }

    /// Takes text and styles; false for everything else.
    pub(super) fn takes(&mut self, event: &Event) -> bool {
        let style = self.styles.last().copied().unwrap_or_default();
        match event {
            Event::Text(text) => self.push(text, style),
            Event::Code(text) => self.push(text, RunStyle::Code),
            Event::SoftBreak => self.push(" ", style),
            Event::HardBreak => self.push("\n", style),
            Event::Start(Tag::Emphasis) => self.styles.push(RunStyle::Emphasis),
            Event::Start(Tag::Strong) => self.styles.push(RunStyle::Strong),
            Event::End(TagEnd::Emphasis | TagEnd::Strong) => {
                self.styles.pop();
            }
            _ => return false,
        }
        true
    }
}

/// The reason why an event is refused.
pub(super) fn refusal(event: &Event) -> &'static str {
    match event {
        Event::Start(Tag::Image { .. }) => {
            "images are not shown; a scene block shows the scene itself, in the picture"
        }
        Event::Start(Tag::Link { .. } | Tag::FootnoteDefinition(_)) | Event::FootnoteReference(_) => {
            "links and footnotes are not shown; write the words alone, and \\[ for the sign ["
        }
        Event::Html(_) | Event::InlineHtml(_) | Event::Start(Tag::HtmlBlock) => {
            "HTML is not shown; write Markdown, and \\< for the sign <"
        }
        Event::Start(Tag::Table(_)) => "tables are not shown; write a list",
        Event::Start(Tag::BlockQuote(_)) => {
            "quotations are not shown; write a paragraph, and \\> for the sign >"
        }
        Event::Start(Tag::Strikethrough) => "struck text is not shown; write \\~ for the sign ~",
        Event::Rule => "rules are not shown; a heading ## begins the next step",
        _ => "this Markdown is not shown; a lesson has headings ##, paragraphs, lists and fenced blocks",
    }
}

/// The row of equal signs of emphasis around a byte, and true if it has no meaning as it stands. `2 * 3` is meant.
fn row(whole: &str, at: usize, sign: &str) -> (Range<usize>, bool) {
    let word = |c: Option<char>| c.is_some_and(char::is_alphanumeric);
    let space = |c: Option<char>| c.is_none_or(char::is_whitespace);
    let (start, end) =
        (whole[..at].trim_end_matches(sign).len(), whole.len() - whole[at..].trim_start_matches(sign).len());
    let (before, after) = (whole[..start].chars().next_back(), whole[end..].chars().next());
    let is_meant = before == Some('\\') || word(before) && word(after) || space(before) && space(after);
    (start..end, !is_meant)
}

/// Reads a text that is one paragraph: a question, an answer, a hint.
pub(super) fn inline(piece: Piece, problems: &mut Problems) -> Vec<Run> {
    let mut runs = Runs::default();
    let (mut skipped, mut paragraphs) = (0usize, 0);
    for (event, range) in Parser::new_ext(piece.text, options()).into_offset_iter() {
        runs.check(&event, piece, &range, problems);
        match &event {
            Event::Start(_) if skipped > 0 => skipped += 1,
            Event::End(_) if skipped > 0 => skipped -= 1,
            _ if skipped > 0 || runs.takes(&event) => {}
            Event::Start(Tag::Paragraph) => {
                paragraphs += 1;
                if paragraphs == 2 {
                    problems.at(piece.at + range.start, "this must be one paragraph; remove the empty line");
                }
            }
            Event::End(_) => {}
            other => {
                let what = match other {
                    Event::Start(Tag::List(_) | Tag::Heading { .. } | Tag::CodeBlock(_)) => {
                        "this must be a paragraph, without lists, headings and blocks"
                    }
                    other => refusal(other),
                };
                problems.at(piece.at + range.start, what);
                skipped = usize::from(matches!(other, Event::Start(_)));
            }
        }
    }
    runs.take()
}
