//! Effects: work that needs files, entities or the operating system.

use std::{path::PathBuf, sync::Arc};

use bevy::ecs::message::Message;
use glam::Vec3;

use super::SheetOf;
use crate::{
    document::Selection,
    matching::Measure,
    materials::Material,
    parameter::Parameter,
    scene::{Key, load::Stamp},
};

/// Work that needs files, entities or the operating system: a message to the systems that carry it out.
#[derive(Clone, Debug, PartialEq, Message)]
pub enum Effect {
    /// Show a dialog: see [`Dialogs`](crate::panel::Dialogs).
    Pick(Pick),
    /// Read a file; see [`effects::run`](crate::panel::effects::run).
    OpenFile(PathBuf),
    /// Write the document, or a copy of the scene of the open lesson; see [`effects::run`](crate::panel::effects::run).
    SaveFile {
        /// The file.
        path: PathBuf,
        /// True to overwrite a file that changed on disk since it was read, or that was never read.
        overwrite: bool,
    },
    /// Forget everything that belonged to the previous document.
    DocumentChanged,
    /// Check whether the document's file changed on disk; see [`reload::check`](crate::panel::reload::check).
    CheckFile {
        /// True to discard unsaved changes if so, after asking the user.
        discard: bool,
    },
    /// Check the file again after a moment, since it may be in the process of being written.
    LookAgain(PathBuf),
    /// Allow saving to overwrite this version of a file, which the user has seen.
    ExpectFile {
        /// The file.
        path: PathBuf,
        /// Version of the file.
        version: Stamp,
    },
    /// Apply the user's decision about the recovery copy that was offered.
    Recovery(RecoveryChoice),
    /// Write to standard error.
    Complain(String),
    /// Quit the program.
    Quit,
    /// Move the camera to the observer.
    HomeView,
    /// Turn the camera to the selection.
    FocusSelection,
    /// Move the observer to the camera.
    ObserverFromView,
    /// Move the camera a little.
    Steer(Steer),
    /// Copy text to the clipboard.
    CopyText(String),
    /// Save the settings.
    SaveSettings,
    /// Create the file of a new custom model.
    NewModel {
        /// Id of the model to copy, if any.
        of: Option<String>,
        /// Id of the model, also the file name.
        id: String,
        /// Display name.
        name: String,
    },
    /// Save a material in the user's folder.
    SaveMaterial {
        /// The material.
        material: Box<Material>,
        /// True to overwrite an existing file, after asking the user.
        overwrite: bool,
    },
    /// Copy a file into the folder of custom models.
    AdoptModel(PathBuf),
    /// Write the manual, and show it in the browser.
    OpenManual,
    /// Open a file in an editor.
    OpenInEditor {
        /// The file.
        path: PathBuf,
        /// The line to go to, from 1.
        line: usize,
    },
    /// Open a file in the panel *Code*; see [`effects::run`](crate::panel::effects::run).
    OpenCode {
        /// The file.
        path: PathBuf,
        /// The line to go to, from 1.
        line: usize,
    },
    /// Open a file in the panel *Code*, with the unsaved text of an earlier window.
    RecoverCode {
        /// The file.
        path: PathBuf,
        /// The text.
        text: Arc<str>,
    },
    /// Write the text of the panel *Code* to its file.
    SaveCode {
        /// The file.
        path: PathBuf,
        /// True to overwrite a file that changed on disk since it was read, after asking the user.
        overwrite: bool,
    },
    /// Look at a file that is open in the panel *Code*, and may have changed on disk.
    LookAtCode(PathBuf),
    /// Search for violations of the laws of a model.
    CheckLaws(String),
    /// Export the scene.
    Export {
        /// Id of the format.
        form: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// True to overwrite existing files, after asking the user.
        overwrite: bool,
    },
    /// Save or copy the picture of a single view, or of all as shown.
    Picture {
        /// The single view, if any.
        view: Option<usize>,
        /// The file; `None` for the clipboard.
        file: Option<PathBuf>,
        /// True to overwrite an existing file, after asking the user.
        overwrite: bool,
    },
    /// Match a view to view A: see [`match_view`](crate::matching::match_view).
    Match {
        /// The view: 1 is view B.
        view: usize,
        /// The quantity to compare, and the metric.
        measure: Measure,
        /// Names of the free parameters.
        parameters: Vec<&'static str>,
    },
    /// Match every model to a measurement: see [`match_each`](crate::matching::each::match_each).
    MatchEvery {
        /// The view with the measurement.
        view: usize,
        /// The quantity to compare, and the metric.
        measure: Measure,
    },
    /// Save the plot to a file.
    WritePlot(PathBuf),
    /// Save a sheet or a film to a file.
    WriteSheet {
        /// The pictures of the sheet or film.
        subject: SheetOf,
        /// The file.
        path: PathBuf,
    },
    /// Stop drawing the picture for a file.
    CancelPicture,
    /// Stop drawing the sheet.
    CancelSheet,
    /// Stop the running match.
    CancelMatch,
    /// Stop the running export.
    CancelExport,
    /// Show a folder in the file manager.
    Reveal(PathBuf),
    /// Read a lesson; see [`effects::run`](crate::panel::effects::run).
    OpenLesson(PathBuf),
    /// Reload the open lesson, whose file may have changed.
    LookAtLesson,
    /// Save the progress in the lesson of this name.
    SaveProgress(String),
    /// Change the camera along with the document.
    Camera(CameraChange),
    /// Export the shaders to a folder for editing.
    ExportShaders(PathBuf),
}

/// The purpose of a file dialog.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pick {
    /// A file to open.
    Open,
    /// A file to save to.
    Save,
    /// A file for a parameter of a light, an object or a material, by its key there.
    File(Selection, Key, &'static Parameter),
    /// The destination of an export in a format, by its id.
    Export(&'static str),
    /// A file for the picture of a single view, or of all as shown.
    Picture(Option<usize>),
    /// A file for the plot.
    Plot,
    /// A file for a sheet or a film.
    Sheet(SheetOf),
    /// A lesson.
    Lesson,
    /// A folder for the shaders.
    ShaderFolder,
}

/// Change of the camera when the user's own document is set aside or restored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraChange {
    /// Keep the camera, then move it to the observer.
    PutAside,
    /// Exchange the camera with the one kept.
    Exchange,
}

/// A small camera movement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steer {
    /// Orbit the target, to the right and up, in degrees.
    Turn(f32, f32),
    /// Move to the right and up, in steps of a twentieth of the distance.
    Move(f32, f32),
    /// Multiply the distance from the target.
    Zoom(f32),
    /// Orbit a point at constant distance until the view is along the given direction or opposite to it.
    Along {
        /// The point, which becomes the target.
        point: Vec3,
        /// The direction of view.
        way: Vec3,
    },
}

/// The user's decision about a recovery copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecoveryChoice {
    /// It has become the document.
    Recovered,
    /// The user has discarded it.
    Discarded,
    /// It is kept for later; other copies may follow.
    Next,
    /// All copies are kept for later.
    Later,
}
