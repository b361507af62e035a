//! Converts Markdown to steps: headings, paragraphs, lists and fenced blocks. Everything else is refused with
//! its position.

use pulldown_cmark::{Event, HeadingLevel, Parser, Tag, TagEnd};

use super::{
    Block, Run, Step, Task, blocks,
    draft::Draft,
    limits::{LONGEST_STEP, LONGEST_TITLE, MAX_PROBLEMS, MAX_STEPS},
    plain,
    problem::Problems,
    runs::{Runs, options, refusal},
    state::Shelf,
    words::Piece,
};

/// Maximum nesting of lists.
const DEEPEST_LIST: usize = 3;

/// Reads the steps of a lesson.
struct Reader<'a, 'p, 'q> {
    whole: &'a str,
    shelf: Shelf<'a>,
    problems: &'p mut Problems<'q>,
    steps: Vec<Draft>,
    runs: Runs,
    /// The enclosing lists, with the number of the next item.
    lists: Vec<Option<u64>>,
    /// The enclosing items: their numbers, and true once they have text.
    items: Vec<(Option<u64>, bool)>,
    /// True once a missing heading has been reported.
    headless: bool,
}

/// Reads the steps in a text from a byte on.
pub(super) fn steps(whole: &str, from: usize, shelf: Shelf, problems: &mut Problems) -> Vec<Draft> {
    let mut reader = Reader {
        whole,
        shelf,
        problems,
        steps: Vec::new(),
        runs: Runs::default(),
        lists: Vec::new(),
        items: Vec::new(),
        headless: false,
    };
    let parser = Parser::new_ext(&whole[from..], options());
    // Link definitions are shown nowhere, not even as events.
    let definitions = parser.reference_definitions().iter().map(|(_, d)| d.span.start);
    let definitions: Vec<_> = definitions.take(MAX_PROBLEMS).collect();
    for start in definitions {
        reader.problems.at(from + start, refusal(&Event::FootnoteReference("".into())));
    }
    let mut skipped = 0usize;
    for (event, range) in parser.into_offset_iter() {
        if reader.problems.are_enough() {
            return reader.steps;
        }
        match &event {
            Event::Start(_) if skipped > 0 => skipped += 1,
            Event::End(_) if skipped > 0 => skipped -= 1,
            _ if skipped > 0 => {}
            Event::Start(Tag::Heading { .. }) if reader.steps.len() == MAX_STEPS => {
                let what = format!("a lesson has at most {MAX_STEPS} steps; make two lessons of this one");
                reader.problems.at(from + range.start, what);
                return reader.steps;
            }
            _ => {
                let refused = reader.event(&event, from + range.start, from + range.end);
                if let Some(draft) = reader.steps.last_mut().filter(|_| refused) {
                    // The refused content was meant to be there.
                    draft.is_empty = false;
                }
                skipped = usize::from(refused && matches!(event, Event::Start(_)));
            }
        }
    }
    let Reader { steps, problems, .. } = reader;
    if steps.is_empty() {
        problems.at(whole.len(), "the lesson has no step; begin one with ## and its name");
    }
    for draft in steps.iter().filter(|draft| draft.is_empty) {
        problems.at(draft.at, "the step is empty; write what the learner should see or do");
    }
    for draft in &steps {
        if draft.step.title.chars().nth(LONGEST_TITLE).is_some() {
            problems.at(draft.at, format!("the name of a step has at most {LONGEST_TITLE} characters"));
        }
        let length = length(&draft.step);
        if length > LONGEST_STEP {
            let rule = format!("at most {LONGEST_STEP} are allowed: begin another step with ##");
            problems.at(draft.at, format!("the step has {length} characters of text; {rule}"));
        }
    }
    steps
}

/// The number of characters shown by a step.
fn length(step: &Step) -> usize {
    let of = |runs: &[Run]| runs.iter().map(|run| run.text.chars().count()).sum::<usize>();
    let blocks = step.blocks.iter().map(|block| match block {
        // An empty line takes space too.
        Block::Paragraph(runs) | Block::Item { runs, .. } => 1 + of(runs),
        Block::Equation(text) => 1 + text.chars().count(),
        Block::Task => 0,
    });
    let task = match &step.task {
        None => 0,
        Some(Task::Predict { question, answers }) => {
            of(question) + answers.iter().map(|a| of(&a.text) + of(&a.feedback)).sum::<usize>()
        }
        Some(Task::Do(goal) | Task::Find(goal)) => of(&goal.text) + goal.hint.as_deref().map_or(0, of),
    };
    blocks.sum::<usize>() + task
}

impl Reader<'_, '_, '_> {
    /// The current step.
    fn step(&mut self, at: usize) -> Option<&mut Draft> {
        if self.steps.is_empty() && !std::mem::replace(&mut self.headless, true) {
            self.problems.at(at, "there is text before the first step; begin the step with ## and its name");
        }
        let draft = self.steps.last_mut()?;
        draft.is_empty = false;
        Some(draft)
    }

    fn push(&mut self, block: Block, at: usize) {
        if let Some(draft) = self.step(at) {
            draft.step.blocks.push(block);
        }
    }

    /// Stores the text of the innermost item.
    fn item(&mut self, at: usize) {
        let runs = self.runs.take();
        if runs.is_empty() {
            return;
        }
        let depth = self.items.len().saturating_sub(1);
        let Some((number, done)) = self.items.last_mut() else { return };
        let number = *number;
        if std::mem::replace(done, true) {
            self.problems.at(at, "an item of a list is one paragraph; begin another item, or end the list");
        } else {
            self.push(Block::Item { number, depth, runs }, at);
        }
    }

    /// Handles an event from one byte to another. True if it was refused, with everything in it.
    fn event(&mut self, event: &Event, at: usize, end: usize) -> bool {
        self.runs.check(event, Piece { at: 0, text: self.whole }, &(at..end), self.problems);
        if self.runs.takes(event) {
            return false;
        }
        match event {
            Event::Start(Tag::Heading { level, .. }) => {
                let is_step = *level == HeadingLevel::H2;
                // A line of - below text makes it a heading too.
                let is_marked = self.whole[at..].trim_start().starts_with('#');
                let problem = match (is_step, is_marked) {
                    (true, true) => None,
                    (false, true) => Some("headings of steps begin with ##; there are no others"),
                    _ => Some(
                        "a line of - or = below text makes it a heading; leave an empty line between them, or \
                         begin headings with ##",
                    ),
                };
                if let Some(problem) = problem {
                    self.problems.at(at, problem);
                    if is_marked {
                        // Intended as a step: its blocks do not belong to the step before.
                        if let Some(before) = self.steps.last_mut() {
                            before.is_empty = false;
                        }
                        self.steps.push(Draft { at, ..Draft::default() });
                    }
                    return true;
                }
                if !self.items.is_empty() {
                    self.problems.at(at, "a heading cannot be in a list");
                    return true;
                }
            }
            Event::End(TagEnd::Heading(_)) => {
                let title = plain(&self.runs.take());
                if title.trim().is_empty() {
                    self.problems.at(at, "the step has no name; write one after ##");
                }
                self.steps.push(Draft {
                    step: Step { title, ..Step::default() },
                    at,
                    is_empty: true,
                    ..Draft::default()
                });
            }
            Event::Start(Tag::Paragraph) if self.items.is_empty() => {}
            Event::End(TagEnd::Paragraph) if self.items.is_empty() => {
                let runs = self.runs.take();
                self.push(Block::Paragraph(runs), at);
            }
            Event::Start(Tag::Paragraph) | Event::End(TagEnd::Paragraph) => self.item(at),
            Event::Start(Tag::List(first)) => {
                self.item(at);
                if self.lists.len() >= DEEPEST_LIST {
                    self.problems.at(at, format!("lists within lists are at most {DEEPEST_LIST} deep"));
                    return true;
                }
                self.lists.push(*first);
            }
            Event::End(TagEnd::List(_)) => {
                self.lists.pop();
            }
            Event::Start(Tag::Item) => {
                let number = self.lists.last_mut().and_then(|next| {
                    let number = *next;
                    *next = number.map(|n| n.saturating_add(1));
                    number
                });
                self.items.push((number, false));
            }
            Event::End(TagEnd::Item) => {
                self.item(at);
                if self.items.pop().is_some_and(|(_, done)| !done) {
                    self.problems.at(at, "this item of a list is empty");
                }
            }
            Event::Start(Tag::CodeBlock(kind)) => {
                self.block(kind, at, end);
                return true;
            }
            other => {
                self.problems.at(at, refusal(other));
                return true;
            }
        }
        false
    }

    /// Reads a code block.
    fn block(&mut self, kind: &pulldown_cmark::CodeBlockKind, at: usize, end: usize) {
        let pulldown_cmark::CodeBlockKind::Fenced(info) = kind else {
            self.problems.at(at, "text indented by four spaces is a block without a kind; remove the spaces");
            return;
        };
        if !self.items.is_empty() {
            self.problems.at(at, "a block cannot be in a list; write it from the left margin");
            return;
        }
        let piece = Piece { at, text: self.whole.get(at..end).unwrap_or_default() };
        let Some(body) = fenced(piece) else {
            self.problems.at(at, "this block is never closed; end it with a line ```");
            return;
        };
        let shelf = self.shelf;
        if self.step(at).is_none() {
            return;
        }
        if let Some(draft) = self.steps.last_mut() {
            blocks::read(info.trim(), at, body, draft, shelf, self.problems);
        }
    }
}

/// The lines between the fences of a block, if both exist.
fn fenced(block: Piece) -> Option<Piece> {
    let first = block.text.find('\n')? + 1;
    let opening = block.text.trim_start();
    let sign = opening.chars().next()?;
    let least = opening.chars().take_while(|c| *c == sign).count();
    let text = block.text.trim_end();
    let last = text.rfind('\n')? + 1;
    let closing = text[last..].trim();
    let closes = closing.chars().count() >= least && closing.chars().all(|c| c == sign);
    (closes && last >= first).then(|| block.part(first, last))
}
