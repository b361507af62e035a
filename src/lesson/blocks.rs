//! The fenced blocks of a step.

use super::{
    AnswerChoice, Block, Condition, Control, Goal, Run, Task, controls,
    draft::Draft,
    limits::MAX_LINES,
    problem::Problems,
    runs::inline,
    state::{self, Shelf},
    window,
    words::{Line, Piece, lines, pair},
};
use crate::text::{did_you_mean, listed, mathematics::beyond_limits, nearest, quoted};

/// The kinds of blocks.
const KINDS: [&str; 7] = ["equation", "scene", "view", "point", "predict", "do", "find"];
/// Maximum number of answers to a question: their keys are 1 to 9.
const MOST_ANSWERS: usize = 9;

/// Reads a block with what stands behind its opening fence.
pub(super) fn read(
    info: &str,
    at: usize,
    body: Piece,
    draft: &mut Draft,
    shelf: Shelf,
    problems: &mut Problems,
) {
    let Some(kind) = KINDS.into_iter().find(|kind| *kind == info) else {
        let near = did_you_mean(info, KINDS.iter().map(|k| (*k, *k)));
        let found = if info.is_empty() { "without a kind".to_owned() } else { quoted(info) };
        problems.at(at, format!("this is a block {found}; a block is {}{near}", listed(&KINDS, "or")));
        return;
    };
    if kind != "equation" && draft.kinds.contains(&kind) {
        problems.at(at, format!("the step has two {kind} blocks; merge them, or begin another step with ##"));
        return;
    }
    draft.kinds.push(kind);
    if body.text.trim().is_empty() {
        problems.at(at, format!("the {kind} block is empty"));
        return;
    }
    match kind {
        "equation" => {
            let lost = || brackets(body.text).map(|(at, what)| (at, what.to_owned()));
            if let Some((inside, what)) = beyond_limits(body.text).or_else(lost) {
                problems.at(body.at + inside, what);
                return;
            }
            let lines: Vec<_> = lines(body.text, body.at).map(|line| line.text.trim_end()).collect();
            draft.step.blocks.push(Block::Equation(lines.join("\n").trim_matches('\n').to_owned()));
        }
        "scene" => {
            let before = problems.count();
            draft.step.scene = Some(state::read(body, shelf, problems));
            draft.is_lost = problems.count() > before;
        }
        "view" => {
            let mut given = Vec::new();
            for line in settings(body, problems) {
                window::setting(&line, &mut given, draft, problems);
            }
        }
        "point" => {
            for line in settings(body, problems) {
                let Some((key, value)) = pair(&line) else {
                    problems.at(line.piece().at, "each line of a point block must be KIND: NAME");
                    continue;
                };
                match controls::control(key, value, shelf.registry, problems) {
                    Some(control) => {
                        draft.points.push(value.at);
                        draft.step.points.push(control);
                    }
                    None if key.text == "part" => draft.misnamed.push((value.at, value.text.to_owned())),
                    None => {}
                }
            }
        }
        _ => {
            if draft.step.blocks.contains(&Block::Task) {
                problems.at(at, "the step has two tasks; begin another step with ## for this one");
                return;
            }
            draft.step.blocks.push(Block::Task);
            draft.step.task = match kind {
                "predict" => question(at, body, problems),
                "do" => goal(at, body, draft, problems).map(Task::Do),
                _ => goal(at, body, draft, problems).map(Task::Find),
            };
        }
    }
}

/// The lines of a block with one entry per line, up to the limit.
fn settings<'a>(body: Piece<'a>, problems: &mut Problems) -> Vec<Line<'a>> {
    let all = lines(body.text, body.at).filter(|line| !line.text.trim().is_empty());
    let mut lines: Vec<_> = all.take(MAX_LINES + 1).collect();
    if let Some(line) = lines.get(MAX_LINES) {
        problems.at(line.at, format!("a block has at most {MAX_LINES} lines"));
        lines.truncate(MAX_LINES);
    }
    lines
}

/// The byte of an unmatched bracket in an equation, and a sentence. Intervals may mix ( and [.
fn brackets(equation: &str) -> Option<(usize, &'static str)> {
    let mut open = Vec::new();
    for (at, c) in equation.char_indices() {
        match c {
            '(' | '[' | '{' => open.push((at, c == '{')),
            ')' | ']' | '}' => match open.pop() {
                Some((_, curly)) if curly == (c == '}') => {}
                _ => return Some((at, "there is no opening bracket for this one")),
            },
            _ => {}
        }
    }
    open.last().map(|(at, _)| (*at, "this bracket is never closed"))
}

/// The marker of an answer, and true if the answer is right.
fn mark(text: &str) -> Option<(usize, bool)> {
    [("[ ]", false), ("[]", false), ("[x]", true), ("[X]", true)]
        .into_iter()
        .find(|(mark, _)| text.starts_with(mark))
        .map(|(mark, right)| (mark.len(), right))
}

/// Reads a question with its answers.
fn question(at: usize, body: Piece, problems: &mut Problems) -> Option<Task> {
    let before = problems.count();
    let marked = |piece: Piece| mark(piece.text).map(|(length, right)| (piece.at - body.at, length, right));
    let marks: Vec<_> = lines(body.text, body.at).filter_map(|line| marked(line.piece())).collect();
    if marks.len() > MOST_ANSWERS {
        let count = marks.len();
        problems.at(at, format!("a question has at most {MOST_ANSWERS} answers; this one has {count}"));
        return None;
    }
    let end = marks.first().map_or(body.text.len(), |mark| mark.0);
    let asked = body.part(0, end).trimmed();
    if asked.text.is_empty() {
        problems.at(at, "the question is missing; write it before the answers");
    }
    let text = inline(asked, problems);
    let mut answers = Vec::new();
    for (i, (start, length, right)) in marks.iter().enumerate() {
        let end = marks.get(i + 1).map_or(body.text.len(), |next| next.0);
        let answer = body.part(start + length, end);
        let (said, feedback) = match answer.text.find('|') {
            Some(bar) => (answer.part(0, bar), Some(answer.part(bar + 1, answer.text.len()))),
            None => (answer, None),
        };
        if said.text.trim().is_empty() {
            problems.at(body.at + start, "this answer is empty");
        }
        let feedback = feedback.map(Piece::trimmed).filter(|feedback| !feedback.text.is_empty());
        if feedback.is_none() {
            problems.at(body.at + start, "this answer has no feedback; write | and why it is right or wrong");
        }
        answers.push(AnswerChoice {
            text: inline(said.trimmed(), problems),
            right: *right,
            feedback: feedback.map_or_else(Vec::new, |feedback| inline(feedback, problems)),
        });
    }
    match answers.iter().filter(|answer| answer.right).count() {
        _ if answers.len() < 2 => {
            let rule = "begin each with [ ], and the right one with [x]";
            problems.at(at, format!("a question needs at least two answers; {rule}"));
        }
        0 => problems.at(at, "the question has no right answer; mark it with [x] instead of [ ]"),
        right if right == answers.len() => {
            problems.at(at, "the question has no wrong answer; mark wrong ones with [ ]");
        }
        _ => {}
    }
    (problems.count() == before).then_some(Task::Predict { question: text, answers })
}

/// The part of a task that a word probably stands for.
fn part_meant(word: &str) -> Option<&'static str> {
    const MEANT: [(&str, &[&str]); 2] = [
        ("until", &["until", "condition", "when", "goal"]),
        ("hint", &["hint", "tip", "help", "clue", "note", "advice"]),
    ];
    nearest(word, MEANT.iter().flat_map(|(part, words)| words.iter().map(|word| (*word, *part))))
}

/// Reads a task with its condition.
fn goal(at: usize, body: Piece, draft: &mut Draft, problems: &mut Problems) -> Option<Goal> {
    const PARTS: [&str; 2] = ["until", "hint"];
    let before = problems.count();
    // Each part continues until the next begins; the text comes first.
    let mut parts: Vec<(&str, usize, usize)> = vec![("", 0, 0)];
    for line in lines(body.text, body.at) {
        let piece = line.piece();
        let Some((key, value)) = pair(&line) else { continue };
        let Some(part) = PARTS.into_iter().find(|part| *part == key.text) else { continue };
        if parts.iter().any(|(known, ..)| *known == part) {
            problems.at(piece.at, format!("{part} is given twice; remove one"));
        }
        parts.push((part, piece.at - body.at, value.at - body.at));
    }
    let piece = |name: &str| {
        let i = parts.iter().position(|(part, ..)| *part == name)?;
        let end = parts.get(i + 1).map_or(body.text.len(), |next| next.1);
        Some(body.part(parts[i].2, end).trimmed())
    };
    let text = piece("").map_or_else(Vec::new, |text| inline(text, problems));
    if text.is_empty() {
        problems.at(at, "the task is missing; before until:, write what the learner should do");
    }
    let mut hint: Option<Vec<Run>> = None;
    if let Some(written) = piece("hint") {
        if written.text.is_empty() {
            problems.at(written.at, "the hint is empty");
        }
        hint = Some(inline(written, problems));
    }
    let Some(written) = piece("until").filter(|until| !until.text.is_empty()) else {
        let meant = lines(body.text, body.at)
            .find_map(|line| pair(&line).filter(|(key, _)| part_meant(key.text) == Some("until")));
        match meant {
            Some((key, _)) => {
                problems.at(key.at, format!("a task has no {}; did you mean until:?", quoted(key.text)))
            }
            None => problems
                .at(at, "the task has no condition; add a line until: with the condition that ends it"),
        }
        return None;
    };
    // Conditions contain no colon: a line with one was meant for another part.
    if let Some((key, _)) = lines(written.text, written.at).skip(1).find_map(|line| pair(&line)) {
        let meant = part_meant(key.text).map_or_else(String::new, |part| format!("; did you mean {part}:?"));
        let found = quoted(key.text);
        problems.at(key.at, format!("a task has no key {found}; its keys are until and hint{meant}"));
        return None;
    }
    draft.until = Some(written.at);
    match Condition::parse(written.text) {
        Ok(until) => (problems.count() == before).then_some(Goal { text, until, hint }),
        Err((inside, what)) => {
            problems.at(written.at + inside, what);
            None
        }
    }
}

/// The part of the scene that a control names, if any.
pub(super) fn part(control: &Control) -> Option<&super::PartName> {
    match control {
        Control::Part(part) => Some(part),
        _ => None,
    }
}
