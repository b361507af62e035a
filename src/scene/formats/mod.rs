//! The formats of scene files. Each reads a file into a [`Scene`], and may write one; the extension of the
//! file selects the format. The window, the command line and [`load`](super::load) use this list, so a new
//! format is known everywhere: in the dialogs, on the command line, and when a file is followed, saved or
//! recovered.
//!
//! Rules are checked for all formats alike, after reading.

use std::{any::Any, path::Path as FilePath, sync::Arc};

pub use super::error::UnknownExtension;
use super::{Scene, error::LoadError, load::MAX_FILE_BYTES, schema};
use crate::{
    files, linear,
    registry::{FormatEntry, Registry},
    text::listed,
};

mod csv;
mod exr;
mod hdr;
mod json;
mod parsed;
mod picture;
mod png;
mod source;

pub(super) use parsed::{Located, checked};
pub use {
    csv::{Csv, column_table},
    exr::Exr,
    hdr::Hdr,
    json::Json,
    parsed::Parsed,
    picture::SCENE_KEYWORD,
    png::Png,
    source::Source,
};

/// A format of scene files. `examples/format.rs` has one, and the program that knows it:
///
/// ```no_run
/// use lights_camera_models::{cli, prelude::*, scene::formats::Csv};
/// # use lights_camera_models::{registry::Registry, scene::{error::LoadError, formats::{Parsed, Source}}};
///
/// struct Sheet;
///
/// // The table of another program: the same columns under another extension.
/// impl SceneFormat for Sheet {
///     fn name(&self) -> &'static str {
///         "sheet"
///     }
///
///     fn extensions(&self) -> &'static [&'static str] {
///         &["sheet"]
///     }
///
///     fn read<'a>(&self, source: &'a Source<'_>, registry: &'a Registry) -> Result<Parsed<'a>, LoadError> {
///         Csv.read(source, registry)
///     }
/// }
///
/// # fn main() -> std::process::ExitCode {
/// cli::main_with(|registry| { registry.add_scene_format(Sheet); }, |_| ())
/// # }
/// ```
pub trait SceneFormat: Send + Sync + 'static {
    /// The display name: `JSON`.
    fn name(&self) -> &'static str;

    /// The extensions of its files, in lower case, without the dot. Saving uses the first.
    fn extensions(&self) -> &'static [&'static str];

    /// True if content without a name, for example from a pipe, is in this format. Content that no format
    /// recognises is read as JSON.
    fn recognises(&self, content: &[u8]) -> bool {
        let _ = content;
        false
    }

    /// Reads a file. Which values are legal is checked afterwards, as for every format.
    ///
    /// # Errors
    /// Returns a [`LoadError`] if the file is not in this format: see [`Source::syntax_error`]. Problems with
    /// single values belong in the result, so that all are reported at once: see [`Parsed::with_problems`].
    fn read<'a>(&self, source: &'a Source<'_>, registry: &'a Registry) -> Result<Parsed<'a>, LoadError>;

    /// The writer; `None` if the format can only be read. Scenes are then saved in another format.
    fn writer(&self) -> Option<&dyn SceneWriter> {
        None
    }
}

/// The writer of a format of scene files. It need not be lossless: except for JSON, the written data is read
/// again before it replaces a file, and refused if it is another scene.
pub trait SceneWriter {
    /// The content of a file with a valid scene.
    ///
    /// # Errors
    /// Returns the part of the scene that the format cannot express, as the end of "it was not written: …".
    fn write(&self, scene: &Scene, target: &Target<'_>, registry: &Registry) -> Result<Vec<u8>, String>;
}

/// The file to be written.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Target<'a> {
    /// The folder of the file.
    pub folder: &'a FilePath,
    /// The present content, if any, from which things that a scene does not contain can be kept, such as
    /// comments.
    pub old: Option<&'a [u8]>,
}

impl<'a> Target<'a> {
    /// A file in a folder, with its present content if there is any.
    #[must_use]
    pub fn new(folder: &'a FilePath, old: Option<&'a [u8]>) -> Self {
        Self { folder, old }
    }
}

/// The reason why a format was rejected.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("scene format “{name}”: {problem}")]
#[non_exhaustive]
pub struct FormatError {
    /// The name of the format.
    pub name: &'static str,
    /// The mistake and how to correct it.
    pub problem: String,
}

/// Registers formats of scene files, in a [`Registry`] or an app.
pub trait SceneFormats {
    /// Registers a format.
    ///
    /// # Errors
    /// Returns a [`FormatError`] if an extension is invalid, or belongs to another format.
    fn try_add_scene_format(&mut self, format: impl SceneFormat) -> Result<&mut Self, FormatError>;

    /// Like [`try_add_scene_format`](Self::try_add_scene_format), but panics.
    ///
    /// # Panics
    /// Panics with the message of the error: a mistake of the format's author, found at the first start.
    fn add_scene_format(&mut self, format: impl SceneFormat) -> &mut Self {
        match self.try_add_scene_format(format) {
            Ok(registered) => registered,
            Err(error) => panic!("{error}"),
        }
    }
}

impl SceneFormats for Registry {
    fn try_add_scene_format(&mut self, format: impl SceneFormat) -> Result<&mut Self, FormatError> {
        let (name, extensions) = (format.name(), format.extensions());
        let refused = |problem| Err(FormatError { name, problem });
        if name.trim().is_empty() {
            return refused("it needs a display name".to_owned());
        }
        if extensions.is_empty() {
            return refused("it needs an extension, such as \"csv\"".to_owned());
        }
        for (i, extension) in extensions.iter().enumerate() {
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "-_".contains(c);
            if extension.is_empty() || !extension.chars().all(plain) {
                return refused(format!(
                    "the extension {extension:?} must be lower-case letters and digits, without a dot"
                ));
            }
            if extensions[..i].contains(extension) {
                return refused(format!("the extension {extension:?} is listed twice"));
            }
        }
        for other in all(self) {
            if other.name() == name {
                return refused("a format of that name already exists".to_owned());
            }
            if let Some(extension) = extensions.iter().find(|e| other.extensions().contains(e)) {
                return refused(format!(
                    "the extension {extension:?} belongs to the format {}",
                    other.name()
                ));
            }
        }
        let format: Arc<dyn Any + Send + Sync> = Arc::new(Box::new(format) as Box<dyn SceneFormat>);
        self.put_scene_format(FormatEntry::new(name, extensions, format));
        Ok(self)
    }
}

/// The built-in formats.
static BUILT_IN: [&dyn SceneFormat; 5] = [&Json, &Csv, &Png, &Exr, &Hdr];
/// The formats of pictures.
static PICTURES: [&dyn SceneFormat; 3] = [&Png, &Exr, &Hdr];

/// All formats: the built-in ones, JSON first, and those that were added.
pub fn all(registry: &Registry) -> impl Iterator<Item = &dyn SceneFormat> {
    let added = registry.scene_formats().iter().filter_map(|entry| {
        let format = entry.format.downcast_ref::<Box<dyn SceneFormat>>()?;
        Some(&**format)
    });
    BUILT_IN.into_iter().chain(added)
}

/// True for JSON, the reference for other formats.
pub(super) fn is_json(format: &dyn SceneFormat) -> bool {
    format.name() == Json.name()
}

/// The extension of a file in lower case, if it has one.
fn extension(path: &FilePath) -> Option<String> {
    Some(path.extension()?.to_string_lossy().to_lowercase()).filter(|extension| !extension.is_empty())
}

fn by_extension<'r>(extension: &str, registry: &'r Registry) -> Option<&'r dyn SceneFormat> {
    all(registry).find(|format| format.extensions().contains(&extension))
}

/// The format of a file by its extension; JSON for names without one.
///
/// # Errors
/// Returns [`UnknownExtension`] if no format has the extension.
pub fn of_path<'r>(path: &FilePath, registry: &'r Registry) -> Result<&'r dyn SceneFormat, UnknownExtension> {
    let Some(extension) = extension(path) else { return Ok(&Json) };
    by_extension(&extension, registry)
        .ok_or_else(|| UnknownExtension { extension, known: shown_extensions(registry) })
}

/// The format of content: by the extension of its name, or without an extension by its appearance.
pub(super) fn of_source<'r>(
    source: &Source,
    registry: &'r Registry,
) -> Result<&'r dyn SceneFormat, UnknownExtension> {
    let path = FilePath::new(source.name);
    match extension(path) {
        Some(_) => of_path(path, registry),
        None => Ok(all(registry).find(|format| format.recognises(source.bytes)).unwrap_or(&Json)),
    }
}

/// True if a file has the extension of a scene; schemas have that of JSON, but are not scenes.
#[must_use]
pub fn is_scene_file(path: &FilePath, registry: &Registry) -> bool {
    let is_schema = path.to_string_lossy().to_lowercase().ends_with(schema::EXTENSION);
    !is_schema && extension(path).is_some_and(|extension| by_extension(&extension, registry).is_some())
}

/// True if a file has the extension of pictures, which may hold a scene.
pub(super) fn is_picture(path: &FilePath) -> bool {
    extension(path).is_some_and(|own| PICTURES.iter().any(|format| format.extensions().contains(&&*own)))
}

/// True if a file holds a scene, or is none of the pictures that may hold one. Linear pictures are also pictures of
/// surroundings, which hold none.
#[must_use]
pub fn holds_scene(path: &FilePath) -> bool {
    let find: fn(&[u8], u64) -> Result<String, String> = match linear::Format::of(path) {
        Some(linear::Format::Exr) => exr::scene_text,
        Some(linear::Format::Hdr) => hdr::scene_text,
        None => return true,
    };
    // It is in the header.
    files::read_start(path, 2 * MAX_FILE_BYTES).is_ok_and(|start| find(&start, MAX_FILE_BYTES).is_ok())
}

/// True if a file has the extension of a format that can be written.
#[must_use]
pub fn can_write(path: &FilePath, registry: &Registry) -> bool {
    let known = extension(path).and_then(|extension| by_extension(&extension, registry));
    known.is_some_and(|format| format.writer().is_some())
}

/// The extensions of all formats.
#[must_use]
pub fn extensions(registry: &Registry) -> Vec<&'static str> {
    all(registry).flat_map(|format| format.extensions().iter().copied()).collect()
}

/// All extensions with the names of their formats: "*.json (JSON), *.csv (CSV), *.png (PNG picture) or …".
#[must_use]
pub fn shown_extensions(registry: &Registry) -> String {
    let each: Vec<_> = all(registry)
        .map(|format| {
            let extensions: Vec<_> = format.extensions().iter().map(|e| format!("*.{e}")).collect();
            format!("{} ({})", extensions.join(", "), format.name())
        })
        .collect();
    listed(&each, "or")
}
