//! Results must replace neither inputs nor files of another kind.

use std::{
    ffi::OsString,
    io,
    path::{Path, PathBuf},
};

use clap::builder::{OsStringValueParser, TypedValueParser};

use super::{Outcome, complain};
use crate::{
    failure::Failure,
    files::{self, Shown as _, words},
    linear::{Channels, Format},
    picture::{
        linear,
        png::{self, About},
    },
};

/// Parser of all files and folders that commands write. An empty path is refused, and so is `-`: where standard output is allowed, it
/// has a name.
pub(super) fn place() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|text: OsString| {
        if text == "-" {
            let rule = "results go to files; name one (./- for one called -). For pictures, /dev/stdout is standard output";
            return Err(rule);
        }
        if text.is_empty() {
            return Err("the path is empty; name a file or a folder");
        }
        Ok(PathBuf::from(text))
    })
}

/// Refuses a result that would replace an input. Called before anything is calculated.
pub(super) fn spare(output: &Path, inputs: &[PathBuf]) -> Outcome {
    files::spare(output, inputs.iter().map(PathBuf::as_path)).map_err(refused)
}

/// Refuses a picture that would replace an input, or a file that is not a picture. Called before anything is
/// drawn.
pub(super) fn picture(output: &Path, inputs: &[PathBuf]) -> Outcome {
    of_format(output, files::PNG, inputs)
}

/// Refuses a file of some format that would replace an input, or a file of another format, or that cannot be written.
pub(super) fn of_format(output: &Path, format: files::Signature, inputs: &[PathBuf]) -> Outcome {
    replaces_nothing(output, format, inputs)?;
    can_begin(output)
}

/// Refuses a file of some format that would replace an input, or a file of another format.
pub(super) fn replaces_nothing(output: &Path, format: files::Signature, inputs: &[PathBuf]) -> Outcome {
    files::may_overwrite(output, format, inputs.iter().map(PathBuf::as_path)).map_err(refused)
}

/// Refuses a file that cannot be written. Called before anything is calculated.
pub(super) fn can_begin(output: &Path) -> Outcome {
    files::can_begin(output).map_err(|error| unwritten(output, &error.into()))
}

fn refused(refused: files::Refused) -> Failure {
    Failure::Write(refused.to_string())
}

/// Writes a picture to a path that was checked before.
pub(super) fn write_picture(output: &Path, [width, height]: [u32; 2], rgb8: &[u8], about: &About) -> Outcome {
    png::write(output, width, height, rgb8, about).map_err(|e| unwritten(output, &e))
}

/// Writes a linear picture to a path that was checked before.
pub(super) fn write_linear(output: &Path, format: Format, channels: &Channels, about: &About) -> Outcome {
    linear::write(output, format, channels, about).map_err(|e| unwritten(output, &e))
}

pub(super) fn unwritten(output: &Path, error: &io::Error) -> Failure {
    match error.kind() {
        io::ErrorKind::BrokenPipe => Failure::Closed,
        _ => Failure::Write(format!("{} could not be written: {}", output.shown(), words(error))),
    }
}

/// Tidies the folder of a file to be written, and reports problems that need the user's attention.
pub(super) fn tidy_beside(file: &Path) {
    files::tidy(files::folder_of(file)).iter().for_each(complain);
}
