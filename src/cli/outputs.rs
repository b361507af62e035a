//! Results that must not take the place of what is read, or of what is no result of this program.

use std::path::{Path, PathBuf};

use super::{Outcome, complain};
use crate::{failure::Failure, files, registry::Registry};

/// What a command reads: scenes, and the files that its registry was read from.
pub(super) fn inputs<'a>(scenes: impl IntoIterator<Item = &'a Path>, registry: &Registry) -> Vec<PathBuf> {
    let models = registry.custom_models().map(|(_, path)| path.to_owned());
    // Looking for the file of each of many models among all of them would take a while.
    let shaders = registry.sources().edited().filter_map(|source| match source.strip_prefix("models/") {
        Some(file) => Some(registry.custom_folder()?.join(file)),
        None => registry.path_on_disk(source),
    });
    scenes.into_iter().map(Path::to_owned).chain(models).chain(shaders).collect()
}

/// Refuses a picture that would cost one of the inputs, or a file that is no picture. This is asked before anything
/// is drawn.
pub(super) fn picture(output: &Path, inputs: &[PathBuf]) -> Outcome {
    files::may_overwrite(output, files::PNG, inputs.iter().map(PathBuf::as_path))
        .map_err(|refused| Failure::Write(refused.to_string()))
}

/// Tidies up the folder of a file that is going to be written, and tells of what needs a person.
pub(super) fn tidy_beside(file: &Path) {
    files::tidy(files::folder_of(file)).iter().for_each(complain);
}
