//! `lcm study`: the four phenomena as a report.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use clap::Args;
use web_time::Instant;

use super::{Options, Outcome, outputs, progress};
use crate::files::Shown as _;
use crate::{
    export::write::inputs,
    failure::Failure,
    files::{self, Draft, FileError, FolderDraft},
    registry::Registry,
    study,
};

/// Default folder of the report.
const FOLDER: &str = "study";

#[derive(Args, Debug)]
pub(super) struct Arguments {
    /// Folder for the report and its numbers
    #[arg(long, short, value_name = "FOLDER", default_value = FOLDER, value_parser = outputs::place())]
    output: PathBuf,
    /// Use small pictures and a tenth of the materials, for a quick trial
    #[arg(long)]
    quick: bool,
    /// Replace an existing report in the folder
    #[arg(long)]
    overwrite: bool,
}

/// The reason why no report was made.
enum Stopped {
    /// The folder cannot be created.
    Folder(io::Error),
    Failed(Failure),
}

impl From<io::Error> for Stopped {
    fn from(error: io::Error) -> Self {
        Self::Folder(error)
    }
}

pub(super) fn run(arguments: &Arguments, options: Options, registry: &Registry) -> Outcome {
    let folder = &arguments.output;
    // A write error is better detected now than in half a minute.
    outputs::spare(folder, &inputs([], [], registry))?;
    free(folder, arguments.overwrite)?;
    // Around everything, so that no empty folder remains if the process ends. A new report is made next to
    // its destination.
    let within = if folder.exists() { folder } else { files::folder_of(folder) };
    files::in_folder(within, || report(arguments, options, registry).map_err(Stopped::Failed)).map_err(
        |stopped| match stopped {
            Stopped::Folder(error) => unwritten(folder, &FileError::from(error)),
            Stopped::Failed(failure) => failure,
        },
    )
}

fn report(arguments: &Arguments, options: Options, registry: &Registry) -> Outcome {
    let folder = &arguments.output;
    let begun = match folder.exists() {
        true => Draft::new(&folder.join(study::PAGE)).map(drop),
        false => FolderDraft::new(folder).map(drop),
    };
    begun.map_err(|error| unwritten(folder, &error))?;
    let had_report = study::is_report(folder);
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
    if !had_report && free(folder, false).is_err() {
        let said = format!("another program wrote to {} in the meantime", folder.shown());
        return Err(Failure::Write(format!("{said}; its files were kept, and this report was not written")));
    }
    study.write(folder).map_err(|error| unwritten(folder, &error.into()))?;
    let (page, seconds) = (folder.join("index.html"), start.elapsed().as_secs_f64());
    options.tell(format_args!("wrote {} ({seconds:.0} s)", page.shown()));
    Ok(())
}

fn unwritten(folder: &Path, error: &FileError) -> Failure {
    Failure::Write(format!("{} could not be written: {error}", folder.shown()))
}

/// Refuses a folder with files in it: a report is replaced only at the user's request, anything else never.
fn free(folder: &Path, overwrite: bool) -> Outcome {
    // A problem with an unreadable folder appears on writing.
    let Ok(mut entries) = fs::read_dir(folder) else { return Ok(()) };
    let name = folder.shown();
    let why = match (entries.next(), study::is_report(folder)) {
        (None, _) => return Ok(()),
        (_, true) if overwrite => return Ok(()),
        (_, true) => "already has a report; --overwrite replaces it, -o FOLDER writes to another folder",
        (_, false) => "has files that are not a report; use -o FOLDER to write to another folder",
    };
    Err(Failure::Write(format!("{name} {why}")))
}
