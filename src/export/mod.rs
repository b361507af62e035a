//! Export of a scene: as a project, as shader files, as a web page, as a program, or as a scene for another
//! renderer.
//!
//! Each form is one file here and one entry in [`FORMS`]. A form turns a [`Request`] into an [`Export`],
//! files in memory; [`write()`](write::write) writes them, all or nothing. A scene that a form cannot express
//! is refused with all reasons.

use std::path::PathBuf;

pub use crate::progress::Progress;
use crate::{progress::Cancelled, registry::Registry, scene::Scene};

mod bevy;
pub mod bodies;
pub(crate) mod executable;
pub mod html;
mod lamp_files;
pub mod lights;
pub mod lit;
pub mod manifest;
mod mitsuba;
mod names;
pub mod payload;
mod refusals;
pub mod shader;
pub mod shaders;
pub mod translate;
pub mod view;
pub mod write;

/// All forms, in the order of lists.
pub const FORMS: &[&Form] = &[
    &bevy::BEVY,
    &html::HTML,
    &executable::FORM,
    &shaders::WGSL,
    &shaders::GLSL,
    &shaders::HLSL,
    &shaders::MSL,
    &shaders::SPIRV,
    &mitsuba::FORM,
];

/// A form of code.
#[derive(Debug)]
pub struct Form {
    /// Name on the command line.
    pub id: &'static str,
    /// Display name.
    pub name: &'static str,
    /// One sentence: the content, and how to use it.
    pub summary: &'static str,
    /// Kind of output.
    pub makes: Makes,
    /// True if the form contains a single object of the scene, which must be chosen.
    pub of_object: bool,
    /// True if it holds one view of the scene; programs and pages hold all.
    pub of_view: bool,
    /// Makes the files.
    pub make: fn(&Request, &Progress) -> Result<Export, ExportError>,
}

/// The kind of output of a form.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Makes {
    /// One file, with this extension, which may be empty.
    File(&'static str),
    /// A folder of files.
    Folder,
}

/// A scene to export.
#[derive(Clone, Copy, Debug)]
pub struct Request<'a> {
    /// The scene, which is valid.
    pub scene: &'a Scene,
    /// The models, light types and shapes, with their shader sources as drawn.
    pub registry: &'a Registry,
    /// Name of the scene's file without extension, for names of files and packages.
    pub stem: &'a str,
    /// Size of pictures and windows in pixels.
    pub size: (u32, u32),
    /// Index of the object for forms that contain a single one; valid.
    pub object: usize,
    /// The pixel of a picture of that size whose colour is explained, for forms that
    /// [explain](Form::explains) one.
    pub point: Option<[u32; 2]>,
}

/// One file of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Path within the folder, with `/`; empty if the export is a single file.
    pub path: String,
    /// Content of the file.
    pub bytes: Vec<u8>,
    /// True for a program.
    pub executable: bool,
}

impl File {
    /// A file with text or other content.
    #[must_use]
    pub fn new(path: impl Into<String>, bytes: impl Into<Vec<u8>>) -> Self {
        Self { path: path.into(), bytes: bytes.into(), executable: false }
    }
}

/// A finished export.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Export {
    /// The files; a single one without a path if the export is not a folder.
    pub files: Vec<File>,
    /// Sentences about differences from the picture in the lab.
    pub notes: Vec<String>,
}

impl Export {
    /// A single file.
    #[must_use]
    pub fn file(bytes: impl Into<Vec<u8>>) -> Self {
        Self { files: vec![File::new("", bytes)], notes: Vec::new() }
    }
}

/// The reason why an export failed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ExportError {
    /// The form has no counterpart for parts of the scene; one line for each, naming the part.
    #[error("{}", .0.join("\n"))]
    Refused(Vec<String>),
    /// The user cancelled.
    #[error("the export was cancelled")]
    Cancelled,
}

impl ExportError {
    /// A refusal with a single reason.
    pub fn refused(reason: impl Into<String>) -> Self {
        Self::Refused(vec![reason.into()])
    }
}

impl From<Cancelled> for ExportError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}

/// The form with this id.
#[must_use]
pub fn form(id: &str) -> Option<&'static Form> {
    FORMS.iter().copied().find(|form| form.id == id)
}

impl Form {
    /// True if the form can explain the colour of a pixel.
    #[must_use]
    pub fn explains(&self) -> bool {
        self.id == html::HTML.id
    }

    /// The default path of an export.
    #[must_use]
    pub fn default_path(&self, stem: &str) -> PathBuf {
        /// Default folder of exports.
        const FOLDER: &str = "exports";
        let name = match self.makes {
            Makes::File("") => stem.to_owned(),
            Makes::File(extension) => format!("{stem}.{extension}"),
            Makes::Folder => format!("{stem}_{}", self.id),
        };
        PathBuf::from(FOLDER).join(name)
    }
}
