//! Results must not replace inputs, nor files of another kind.

use std::path::{Path, PathBuf};

use super::{Outcome, complain};
use crate::{failure::Failure, files, registry::Registry};

/// The inputs of a command: scenes, and the files from which its registry was read.
pub(super) fn inputs<'a>(scenes: impl IntoIterator<Item = &'a Path>, registry: &Registry) -> Vec<PathBuf> {
    scenes.into_iter().map(Path::to_owned).chain(registry.files_on_disk()).collect()
}

/// Refuses a picture that would replace an input, or a file that is no picture. Called before anything is drawn.
pub(super) fn picture(output: &Path, inputs: &[PathBuf]) -> Outcome {
    files::may_overwrite(output, files::PNG, inputs.iter().map(PathBuf::as_path))
        .map_err(|refused| Failure::Write(refused.to_string()))
}

/// Tidies the folder of a file to be written, and reports problems that need a person.
pub(super) fn tidy_beside(file: &Path) {
    files::tidy(files::folder_of(file)).iter().for_each(complain);
}
