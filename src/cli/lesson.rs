//! `lcm lesson`: lists the shipped lessons, and checks and prints teachers' own lessons.

use std::{
    fmt::Write as _,
    path::{Path, PathBuf},
};

use clap::Subcommand;

use super::{Checked, Options, Outcome, Reach, complain, print_text};
use crate::files::Shown as _;
use crate::{
    failure::Failure,
    lesson::{Lesson, Problem, limits::MAX_PROBLEMS, shipped::LESSONS},
    registry::Registry,
    text::plural,
};

#[derive(Subcommand, Debug)]
pub(super) enum Command {
    /// List the shipped lessons
    List,
    /// Check lessons and print their problems, with line and column
    Check {
        /// Markdown files, or folders with lesson.md
        #[arg(required = true, value_name = "FILE")]
        files: Vec<PathBuf>,
        /// Print the result as JSON
        #[arg(long)]
        json: bool,
        #[command(flatten)]
        reach: Reach,
    },
    /// Print a lesson as text, with its answers and conditions
    Show {
        /// A Markdown file, a folder with lesson.md, or the name of a shipped lesson
        file: PathBuf,
        #[command(flatten)]
        reach: Reach,
    },
}

impl Command {
    /// The files that scenes of lessons may name; `None` if no lesson is read.
    pub(super) fn reach(&self) -> Option<Reach> {
        match self {
            Self::List => None,
            Self::Check { reach, .. } | Self::Show { reach, .. } => Some(*reach),
        }
    }
}

/// The file to which the problems of a path belong.
fn file_of(path: &Path) -> PathBuf {
    if path.is_dir() { path.join("lesson.md") } else { path.to_owned() }
}

pub(super) fn run(command: &Command, options: Options, registry: &Registry) -> Outcome {
    match command {
        Command::List => list(),
        Command::Check { files, json, .. } => check(files, *json, options, registry),
        Command::Show { file, .. } => show(file, options, registry),
    }
}

fn list() -> Outcome {
    let width = LESSONS.iter().map(|lesson| lesson.id.chars().count()).max().unwrap_or_default();
    let mut text = String::new();
    for lesson in LESSONS.iter() {
        let time = lesson.minutes.map_or(String::new(), |minutes| format!(", {minutes} min"));
        let (id, steps) = (&lesson.id, plural(lesson.steps.len(), "step"));
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{id:width$}  {} ({steps}{time}): {}", lesson.title, lesson.summary);
    }
    print_text(&text)
}

fn check(files: &[PathBuf], json: bool, options: Options, registry: &Registry) -> Outcome {
    let mut checked = Checked::new();
    for path in files {
        let mut problems = Vec::new();
        match Lesson::read(path, registry, options.outside()) {
            Ok(lesson) => {
                let tasks = lesson.steps.iter().filter(|step| step.task.is_some()).count();
                let (steps, tasks) = (plural(lesson.steps.len(), "step"), plural(tasks, "task"));
                let _ = writeln!(checked.listed, "{}: valid: {steps}, {tasks}", path.shown());
            }
            Err(found) => problems = found,
        }
        let file = file_of(path);
        if !json {
            complain_about(&problems, &file.shown().to_string());
        }
        checked.add(file.to_string_lossy().into_owned(), problems);
    }
    checked.print(json, options, "lessons")
}

/// Prints the problems of a lesson as far as anybody reads them, and their number.
fn complain_about(problems: &[Problem], file: &str) {
    /// Maximum number of problems that are printed, in about five lines each.
    const MOST_PRINTED: usize = 40;
    problems.iter().take(MOST_PRINTED).for_each(|problem| complain(problem.annotated(file)));
    let least = if problems.len() >= MAX_PROBLEMS { "at least " } else { "" };
    let all = plural(problems.len(), "problem");
    match problems.len().saturating_sub(MOST_PRINTED) {
        0 if problems.len() < 2 => {}
        0 => complain(format_args!("{file}: {all}")),
        more => complain(format_args!(
            "{file}: {least}{all}: the first {MOST_PRINTED} are printed, and --json has {more} more"
        )),
    }
}

fn show(file: &Path, options: Options, registry: &Registry) -> Outcome {
    let shipped = LESSONS.iter().find(|lesson| Path::new(&lesson.id) == file && !file.exists());
    if let Some(lesson) = shipped {
        return print_text(&lesson.to_text());
    }
    match Lesson::read(file, registry, options.outside()) {
        Ok(lesson) => print_text(&lesson.to_text()),
        Err(problems) => {
            let name = file_of(file).shown().to_string();
            let lines: Vec<_> = problems.iter().map(|problem| problem.annotated(&name)).collect();
            Err(Failure::Invalid(lines.join("\n")))
        }
    }
}
