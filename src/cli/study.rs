//! `lcm study`: the four phenomena as a report.

use std::{
    path::{Path, PathBuf},
    time::Instant,
};

use clap::Args;

use super::{Failure, Options, Outcome, progress};
use crate::{registry::Registry, study};

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
}

pub(super) fn run(arguments: &Arguments, options: Options, registry: &Registry) -> Outcome {
    let folder = &arguments.output;
    // What cannot be written is better known now than in half a minute.
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

/// Makes the folder, and says so if files cannot be put there.
fn writable(folder: &Path) -> Outcome {
    std::fs::create_dir_all(folder)
        .and_then(|()| tempfile::tempfile_in(folder).map(drop))
        .map_err(|e| Failure::Write(format!("{} could not be written: {e}", folder.display())))
}
