//! A lesson as plain text, for terminals and for reading before class.

use std::fmt::Write as _;

use super::{Block, Lesson, Run, RunStyle, Task};

/// Line width.
const WIDTH: usize = 80;

/// Text with Markdown signs for styles.
fn marked(runs: &[Run]) -> String {
    let marked = |run: &Run| match run.style {
        RunStyle::Plain => run.text.clone(),
        RunStyle::Emphasis => format!("*{}*", run.text),
        RunStyle::Strong => format!("**{}**", run.text),
        RunStyle::Code => format!("`{}`", run.text),
    };
    runs.iter().map(marked).collect()
}

/// Appends text in lines of [`WIDTH`]: the first prefixed with `first`, the others with `rest`.
fn wrap(text: &str, first: &str, rest: &str, to: &mut String) {
    let mut begin = first;
    for paragraph in text.split('\n') {
        let mut line = begin.to_owned();
        let mut empty = true;
        for word in paragraph.split_whitespace() {
            if !empty && line.chars().count() + 1 + word.chars().count() > WIDTH {
                let _ = writeln!(to, "{line}");
                rest.clone_into(&mut line);
                empty = true;
            }
            if !empty {
                line.push(' ');
            }
            line.push_str(word);
            empty = false;
        }
        let _ = writeln!(to, "{}", line.trim_end());
        begin = rest;
    }
}

/// The lesson as plain text.
pub(super) fn of(lesson: &Lesson) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "{}\n{}", lesson.title, "=".repeat(lesson.title.chars().count()));
    wrap(&lesson.summary, "", "", &mut out);
    if let Some(minutes) = lesson.minutes {
        let _ = writeln!(out, "About {}.", crate::text::plural(minutes as usize, "minute"));
    }
    for (i, step) in lesson.steps.iter().enumerate() {
        let heading = format!("{}. {}", i + 1, step.title);
        let _ = writeln!(out, "\n{heading}\n{}", "-".repeat(heading.chars().count()));
        for block in &step.blocks {
            let in_list = matches!(block, Block::Item { .. });
            if !in_list {
                out.push('\n');
            }
            match block {
                Block::Paragraph(runs) => wrap(&marked(runs), "", "", &mut out),
                Block::Item { number, depth, runs } => {
                    let mark = number.map_or("- ".to_owned(), |number| format!("{number}. "));
                    let indent = "  ".repeat(*depth);
                    let rest = format!("{indent}{}", " ".repeat(mark.len()));
                    wrap(&marked(runs), &format!("{indent}{mark}"), &rest, &mut out);
                }
                Block::Equation(equation) => {
                    for line in equation.lines() {
                        let _ = writeln!(out, "    {line}");
                    }
                }
                Block::Task => task(step.task.as_ref(), &mut out),
            }
        }
    }
    out
}

fn task(task: Option<&Task>, out: &mut String) {
    match task {
        None => {}
        Some(Task::Predict { question, answers }) => {
            wrap(&marked(question), "Predict: ", "  ", out);
            for answer in answers {
                let mark = if answer.right { "  [x] " } else { "  [ ] " };
                wrap(&marked(&answer.text), mark, "      ", out);
                wrap(&marked(&answer.feedback), "      → ", "        ", out);
            }
        }
        Some(Task::Do(goal) | Task::Find(goal)) => {
            let word = if matches!(task, Some(Task::Find(_))) { "Find: " } else { "Do: " };
            wrap(&marked(&goal.text), word, "  ", out);
            wrap(goal.until.text(), "  Until: ", "    ", out);
            if let Some(hint) = &goal.hint {
                wrap(&marked(hint), "  Hint: ", "    ", out);
            }
        }
    }
}
