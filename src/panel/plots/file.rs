//! Plots as files: what `lcm plot` writes for the same curves.

use std::path::{Path, PathBuf};

use egui_file_dialog::FileDialog;

use super::request::{NoCurve, Request};
use crate::{
    curves::{Detail, Format},
    files,
    panel::prelude::*,
    progress::Progress,
};

/// The name that a dialog offers.
pub(in crate::panel) fn file_name(session: &Session) -> String {
    format!("{}_{}.svg", session.stem(), session.plots.kind.id())
}

/// Lets a dialog offer the formats. It adds the extension of the chosen one to the typed name.
pub(in crate::panel) fn offer(dialog: &mut FileDialog) {
    let name = |format: Format| match format {
        Format::Svg => "Vector graphics",
        Format::Png => "Picture",
        Format::Csv => "Numbers",
    };
    let config = std::mem::take(dialog.config_mut());
    let mut config = Format::ALL
        .into_iter()
        .fold(config, |config, format| config.add_save_extension(name(format), format.id()));
    config.default_save_extension = Some(name(Format::Svg).to_owned());
    *dialog.config_mut() = config;
}

/// The file that a typed name means: vector graphics if it has no extension.
#[must_use]
pub fn file_of(typed: &Path) -> PathBuf {
    files::meant(typed, Format::Svg.id(), |path| Format::of(path).is_ok())
}

/// Calculates a plot and writes it to a file; the name determines the format. Returns the message about it. An existing
/// file is replaced only with `replace`, and only if it is such a file and none of `inputs`.
///
/// # Errors
/// The reason why there is no file.
pub fn write(
    request: &Request,
    file: &Path,
    replace: bool,
    inputs: &[PathBuf],
    progress: &Progress,
) -> Result<Vec<String>, String> {
    let format = Format::of(file)?;
    files::may_replace(file, format.signature(), replace, inputs).map_err(|refused| refused.to_string())?;
    let setup = request.setup;
    let mut made = Vec::new();
    let mut notes = Vec::new();
    for entry in request.entries.iter().filter(|entry| entry.shown) {
        match entry.recipe.draw(&setup, Detail::Fine, None, progress) {
            Ok(drawn) => made.push((entry.style, drawn)),
            Err(NoCurve::Cancelled) => return Err("it was cancelled".to_owned()),
            // In the window it is missing from the plot, too.
            Err(NoCurve::Because(why)) => notes.push(format!("{why}.")),
        }
    }
    if made.is_empty() {
        let why = notes.join(" ");
        let why = if why.is_empty() { "no curve is shown" } else { why.trim_end_matches('.') };
        return Err(format!("it would be empty: {why}"));
    }
    let sheet = request.sheet(made.iter().map(|(style, drawn)| (*style, drawn)));
    let bytes = format.bytes(&sheet).map_err(|error| error.to_string())?;
    let written = files::in_folder(files::folder_of(file), || files::write(file, &bytes));
    written.map_err(|error| format!("{} could not be written: {error}", file.shown()))?;
    notes.extend(sheet.notes());
    Ok(notes)
}
