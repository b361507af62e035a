//! Effects: work that needs files, entities or the operating system.

use std::path::PathBuf;

use bevy::ecs::message::Message;
use glam::Vec3;

use crate::{document::Selection, matching::What, parameter::Parameter, scene::load::Stamp};

/// Work that needs files, entities or the operating system; the app carries it out.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Show the dialog that chooses a file to open.
    PickOpen,
    /// Show the dialog that chooses a file to save to.
    PickSave,
    /// Show the dialog that chooses a file for a parameter of a light or an object.
    PickFile(Selection, &'static Parameter),
    /// Read a file; see [`effects::run`](crate::panel::effects::run).
    OpenFile(PathBuf),
    /// Write the document, or a copy of the scene of the lesson that is open; see
    /// [`effects::run`](crate::panel::effects::run).
    SaveFile {
        /// The file.
        path: PathBuf,
        /// True to replace a file that changed on disk since it was read, or that was never read.
        overwrite: bool,
    },
    /// The document is another one: forget what belonged to the one before.
    DocumentChanged,
    /// Look whether the document's file changed on disk; see [`reload::look`](crate::panel::reload::look).
    LookAtFile {
        /// True to lose unsaved changes for it: the user was asked.
        discard: bool,
    },
    /// The same after a moment, since a file may be in the middle of being written.
    LookAgain(PathBuf),
    /// The user knows of this state of a file: saving may replace it.
    ExpectFile {
        /// The file.
        path: PathBuf,
        /// Its state.
        version: Stamp,
    },
    /// The fate of the recovery copy that the question was about.
    Recovery(RecoveryChoice),
    /// Write to standard error, for those who watch it.
    Complain(String),
    /// End the program.
    Quit,
    /// Put the camera where the observer is.
    HomeView,
    /// Let the camera look at what is selected.
    FocusSelection,
    /// Write the place of the camera into the observer.
    ObserverFromView,
    /// Move the camera a little.
    Steer(Steer),
    /// Put text on the clipboard.
    CopyText(String),
    /// Write the settings.
    SaveSettings,
    /// Write the file of a new custom model.
    NewModel {
        /// Its id, which is also the name of the file.
        id: String,
        /// Its name for people.
        name: String,
    },
    /// Write a model as the file of a custom model.
    DuplicateModel {
        /// Id of the model that is copied.
        model: String,
        /// Id of the copy, which is also the name of the file.
        id: String,
        /// Its name for people.
        name: String,
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
    /// Try to find the laws of a model broken.
    CheckLaws(String),
    /// Show the dialog that chooses a place for an export in a form, by its id.
    PickExport(&'static str),
    /// Export the scene.
    Export {
        /// The id of the form.
        form: &'static str,
        /// The file or folder.
        path: PathBuf,
        /// True to replace what is there: the user was asked.
        overwrite: bool,
    },
    /// Show the dialog that chooses a file for the picture of a view alone, or of all as they are shown.
    PickPicture(Option<usize>),
    /// Save or copy the picture of a view alone, or of all as they are shown.
    Picture {
        /// The view that is wanted alone.
        view: Option<usize>,
        /// The file; `None` is the clipboard.
        file: Option<PathBuf>,
        /// True to replace what is there: the user was asked.
        overwrite: bool,
    },
    /// Match a view to view A: see [`match_view`](crate::matching::match_view).
    Match {
        /// The view: 1 is view B.
        view: usize,
        /// What is compared.
        what: What,
        /// The names of the parameters that are free.
        parameters: Vec<&'static str>,
    },
    /// Show the dialog that chooses a file for the plot.
    PickPlot,
    /// Write the plot to a file.
    WritePlot(PathBuf),
    /// Stop the match that runs.
    CancelMatch,
    /// Stop the export that runs.
    CancelExport,
    /// Show a folder in the file manager.
    Reveal(PathBuf),
    /// Show the dialog that chooses a lesson.
    PickLesson,
    /// Read a lesson; see [`effects::run`](crate::panel::effects::run).
    OpenLesson(PathBuf),
    /// The file of the lesson that is open may have changed: read it again.
    LookAtLesson,
    /// Keep what was done of the lesson of this name.
    SaveProgress(String),
    /// The picture shows another document, and another view of it.
    Camera(CameraChange),
    /// Show the dialog that chooses a folder for the shaders.
    PickShaderFolder,
    /// Write the shaders into a folder, to be edited there.
    ExportShaders(PathBuf),
}

/// The camera when the user's own document is put aside, and when it comes back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CameraChange {
    /// Keep its place, then put it where the observer is.
    PutAside,
    /// Exchange its place and the one that was kept.
    Exchange,
}

/// A small movement of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Steer {
    /// Around what is looked at: to the right and up, degrees.
    Turn(f32, f32),
    /// To the right and up, in steps of a twentieth of the distance.
    Move(f32, f32),
    /// The distance to what is looked at times this.
    Zoom(f32),
    /// Around a point of the room, at the same distance from it, until it is seen along a direction or against it.
    Along {
        /// The point, which is what is looked at from then on.
        point: Vec3,
        /// The direction.
        way: Vec3,
    },
}

/// The fate of a recovery copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RecoveryChoice {
    /// It is the document now.
    Recovered,
    /// Nobody wants it.
    Discarded,
    /// It stays for another time; there may be others.
    Next,
    /// All stay for another time.
    Later,
}

/// An [`Effect`] on its way to the systems that carry it out.
#[derive(Clone, Debug, PartialEq, Message)]
pub struct LabEffect(pub Effect);
