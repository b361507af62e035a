//! `lcm study`: the four phenomena as a report.

use std::{
    fs,
    path::{Path, PathBuf},
    time::Instant,
};

use clap::Args;

use super::{Options, Outcome, progress};
use crate::{
    failure::Failure,
    files::{Draft, FileError},
    registry::Registry,
    study,
};

/// Where the report goes when nothing else is said.
const FOLDER: &str = "study";

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// The folder for the report and its numbers
    #[arg(long, short, value_name = "FOLDER", default_value = FOLDER)]
    output: PathBuf,
    /// Small pictures and a tenth of the materials, to try that everything works
    #[arg(long)]
    quick: bool,
    /// Replace a report that is in the folder already
    #[arg(long)]
    overwrite: bool,
}

pub(super) fn run(arguments: &Arguments, options: Options, registry: &Registry) -> Outcome {
    let folder = &arguments.output;
    // What cannot be written is better known now than in half a minute.
    free(folder, arguments.overwrite)?;
    writable(folder)?;
    let start = Instant::now();
    let bar = progress(study::STEPS, options);
    let tell = |what: &str| {
        if bar.is_hidden() {
            options.detail(format_args!("{what} …"));
        } else {
            bar.set_message(what.to_owned());
            bar.inc(1);
        }
    };
    let study = study::run(registry, study::Settings { quick: arguments.quick }, &tell)
        .map_err(|e| Failure::Invalid(e.to_string()))?;
    bar.finish_and_clear();
    study
        .write(folder)
        .map_err(|e| Failure::Write(format!("{} could not be written: {e}", folder.display())))?;
    options.tell(format_args!(
        "wrote {} ({:.0} s)",
        folder.join("index.html").display(),
        start.elapsed().as_secs_f64()
    ));
    Ok(())
}

/// Refuses a folder that holds something: a report is only replaced when the user says so, anything else never.
fn free(folder: &Path, overwrite: bool) -> Outcome {
    // What is wrong with a folder that cannot be read shows when it is written to.
    let Ok(mut entries) = fs::read_dir(folder) else { return Ok(()) };
    let name = folder.display();
    match (entries.next(), study::is_report(folder)) {
        (None, _) => Ok(()),
        (_, true) if overwrite => Ok(()),
        (_, true) => Err(Failure::Write(format!(
            "{name} holds a report already; it was left alone: --overwrite replaces it, -o FOLDER names another folder"
        ))),
        (_, false) => Err(Failure::Write(format!(
            "{name} holds files that are no report; it was left alone: -o FOLDER names another folder"
        ))),
    }
}

/// Makes the folder, and says so if files cannot be put there.
fn writable(folder: &Path) -> Outcome {
    fs::create_dir_all(folder)
        .map_err(FileError::from)
        .and_then(|()| Draft::new(&folder.join(study::PAGE)).map(drop))
        .map_err(|e| Failure::Write(format!("{} could not be written: {e}", folder.display())))
}
