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
    files::{self, Kind, Shown as _, is_descriptor, kind, words},
    linear::{Channels, Format},
    picture::{
        linear,
        png::{self, About},
    },
};

/// Parser of all files and folders that commands write. An empty path is refused, and so is `-`: where standard output is allowed, it
/// has a name. No folder is made only to be left again.
pub(super) fn place() -> impl TypedValueParser<Value = PathBuf> {
    OsStringValueParser::new().try_map(|text: OsString| {
        if text == "-" {
            let rule = "results go to files and folders; name one (./- for one called -). For pictures, /dev/stdout is standard output";
            return Err(rule);
        }
        if text.is_empty() {
            return Err("the path is empty; name a file or a folder");
        }
        Ok(files::without_detours(Path::new(&text)))
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

/// Fails unless an option is a single picture, next to the numbers on standard output.
pub(super) fn one_picture(option: &str, path: &Path) -> Outcome {
    let usage = |why: &str| Failure::Usage(format!("{option} {}: {why}", path.shown()));
    let stdout = ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"];
    if stdout.iter().any(|name| path == Path::new(name)) {
        return Err(usage("standard output is for the numbers; name a PNG file"));
    }
    if is_file(option, path, false)? { Ok(()) } else { Err(usage("name a PNG file")) }
}

/// True if an option is a file, and not a folder. A path that ends in `.png` is one, unless it is an existing folder, and so
/// is one of a linear picture, where these are possible, and a device or a pipe. Other picture formats are refused;
/// anything else is a folder.
pub(super) fn is_file(option: &str, path: &Path, linear: bool) -> Result<bool, Failure> {
    match kind(path) {
        Ok(Kind::Folder) => return Ok(false),
        Ok(Kind::Device | Kind::Pipe) => return Ok(true),
        Ok(Kind::Socket | Kind::Unknown) => {
            return Err(Failure::Write(format!("{option} {} is neither a file nor a folder", path.shown())));
        }
        Ok(Kind::File) if is_descriptor(path) => return Ok(true),
        Ok(Kind::File) | Err(_) => {}
    }
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    match extension.as_str() {
        "png" => Ok(true),
        _ if linear && Format::of(path).is_some() => Ok(true),
        "jpg" | "jpeg" | "gif" | "bmp" | "tif" | "tiff" | "webp" | "exr" | "hdr" | "ppm" | "tga" | "svg"
        | "pdf" => {
            let (file, png) = (path.shown(), path.with_extension("png"));
            let hint = format!("did you mean {}?", png.shown());
            let formats = if linear { "PNG, OpenEXR and Radiance" } else { "PNG" };
            Err(Failure::Usage(format!("{option} {file}: only {formats} files can be written; {hint}")))
        }
        _ if path.is_file() => Err(Failure::Write(format!(
            "{option} {} is not a PNG file; name a PNG file or a folder",
            path.shown()
        ))),
        _ => Ok(false),
    }
}
