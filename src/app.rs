//! The plugins and the order of the systems.

use crate::cli::{Failure, ViewOptions};

/// Opens the window and returns when it is closed.
///
/// # Errors
/// [`Failure::NoRenderer`] where there is no display.
pub fn view(options: ViewOptions) -> Result<(), Failure> {
    let what = options.file.map_or_else(|| "the default scene".to_owned(), |f| f.display().to_string());
    Err(Failure::NoRenderer(format!("{what}: this build has no window")))
}
