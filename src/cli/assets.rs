//! `lcm assets`: copies of the built-in shaders and of the example models for editing.

use std::path::PathBuf;

use clap::Subcommand;

use super::{Options, Outcome, complain, outputs, print_paths};
use crate::files::Shown as _;
use crate::{failure::Failure, library::assets, registry::Registry};

#[derive(Subcommand, Debug)]
pub(super) enum Command {
    /// Write the built-in shaders to FOLDER/shaders and the example models to FOLDER/models; existing files that differ
    /// are kept
    Export {
        /// Destination folder; created if it does not exist
        #[arg(value_parser = outputs::place())]
        folder: PathBuf,
    },
}

pub(super) fn run(command: &Command, options: Options, registry: &Registry) -> Outcome {
    let Command::Export { folder } = command;
    let exported = assets::export(folder, registry).map_err(|e| Failure::Write(e.to_string()))?;
    print_paths(exported.written.iter().map(PathBuf::as_path))?;
    for path in &exported.kept {
        complain(format_args!("{} differs from the built-in file and was kept", path.shown()));
    }
    let (new, old) = (exported.written.len(), exported.same + exported.kept.len());
    let remedy = format!("run lcm view --assets {} and edit them", folder.shown());
    options.tell(format_args!("wrote {new} files, {old} already existed; {remedy}"));
    Ok(())
}
