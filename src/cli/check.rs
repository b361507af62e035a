//! `lcm check`: all problems of scenes.

use std::{fmt::Write as _, path::PathBuf};

use clap::Args;
use serde::Serialize;

use super::{Options, Outcome, complain, print, print_text, scenes::Source, workshop::Workshop};
use crate::{
    failure::Failure,
    scene::{error::Problem, load::Defaults},
};

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Scene files; `-` is standard input
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
}

/// The result for one scene, for programs.
#[derive(Serialize)]
struct Report {
    file: String,
    valid: bool,
    problems: Vec<Problem>,
}

pub(super) fn run(arguments: &Arguments, options: Options, workshop: &mut Workshop) -> Outcome {
    // A check asks no questions: missing parts are problems, unless `--use-defaults` is given.
    let defaults = match options.defaults() {
        Defaults::Ask => Defaults::Refuse,
        answered => answered,
    };
    let mut reports = Vec::new();
    let mut listed = String::new();
    let mut invalid = 0;
    for path in &arguments.scenes {
        let source = Source::named(path);
        let mut problems = Vec::new();
        match source.read(workshop, defaults) {
            Ok(loaded) => {
                let counted = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
                // Writing to a String cannot fail.
                let mut counts = vec![
                    counted(loaded.scene.lights.len(), "light"),
                    counted(loaded.scene.objects.len(), "object"),
                ];
                if !loaded.scene.variants.is_empty() {
                    counts.push(counted(loaded.scene.variants.len(), "variant"));
                }
                let _ = writeln!(listed, "{}: valid: {}", source.name(), counts.join(", "));
            }
            Err(error) => {
                invalid += 1;
                problems = error.problems();
                if !arguments.json {
                    complain(&error);
                }
            }
        }
        reports.push(Report { file: source.name(), valid: problems.is_empty(), problems });
    }
    if arguments.json {
        let json = serde_json::to_string_pretty(&reports).unwrap_or_default();
        print(&format!("{json}\n"))?;
    } else if !options.quiet {
        print_text(&listed)?;
    }
    match invalid {
        0 => Ok(()),
        _ if arguments.json || reports.len() == 1 => Err(Failure::Invalid(String::new())),
        n => Err(Failure::Invalid(format!(
            "{n} of {} scenes {} invalid",
            arguments.scenes.len(),
            if n == 1 { "is" } else { "are" }
        ))),
    }
}
