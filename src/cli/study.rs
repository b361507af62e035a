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

/// The default folder of the report.
const FOLDER: &str = "study";

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Folder for the report and its numbers
    #[arg(long, short, value_name = "FOLDER", default_value = FOLDER)]
    output: PathBuf,
    /// Use small pictures and a tenth of the materials, for a quick trial
    #[arg(long)]
    quick: bool,
    /// Replace an existing report in the folder
    #[arg(long)]
    overwrite: bool,
}

pub(super) fn run(arguments: &Arguments, options: Options, registry: &Registry) -> Outcome {
    let folder = &arguments.output;
    // A write error is better known now than in half a minute.
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

/// Refuses a folder with files in it: a report is replaced only at the user's request, anything else never.
fn free(folder: &Path, overwrite: bool) -> Outcome {
    // A problem of a folder that cannot be read shows on writing.
    let Ok(mut entries) = fs::read_dir(folder) else { return Ok(()) };
    let name = folder.display();
    match (entries.next(), study::is_report(folder)) {
        (None, _) => Ok(()),
        (_, true) if overwrite => Ok(()),
        (_, true) => Err(Failure::Write(format!(
            "{name} already has a report; --overwrite replaces it, -o FOLDER writes to another folder"
        ))),
        (_, false) => Err(Failure::Write(format!(
            "{name} has files that are not a report; use -o FOLDER to write to another folder"
        ))),
    }
}

/// Creates the folder, and fails if it cannot be written to.
fn writable(folder: &Path) -> Outcome {
    fs::create_dir_all(folder)
        .map_err(FileError::from)
        .and_then(|()| Draft::new(&folder.join(study::PAGE)).map(drop))
        .map_err(|e| Failure::Write(format!("{} could not be written: {e}", folder.display())))
}
