//! The state of the window: the document, what is selected, what is shown; and the actions that
//! change it.
//!
//! [`Session`] is a Bevy resource, and knows nothing of Bevy otherwise: panels read it and return
//! [`Action`]s, [`Session::apply`] carries them out and returns the [`Effect`]s that need files, entities
//! or the operating system. All of it can be driven without a window.

use std::path::{Path, PathBuf};

use bevy::ecs::{message::Message, resource::Resource};
use bevy_egui::egui;
use glam::{Quat, Vec3};

use super::{
    PanelInfo,
    author::{LawCheck, ModelCommand, ModelDraft},
    clipping::Clipping,
    follow::StashedValues,
    placing::Stand,
    recovery::{Choice, Offer},
    reload::OnDisk,
    settings::{SCALES, Settings, nearest_scale},
    terms::KnownTerms,
};
use crate::document::limits;
use crate::{
    document::{Document, Edit, Extent, LightField, ObjectField, Selection, names::free_name},
    files::printable,
    library::status::ShaderStatus,
    light::MAX_LIGHTS,
    optics::TermSelection,
    registry::Registry,
    scene::{
        Display, Light, MAX_OBJECTS, Object, Scene, check::same_place, examples::EXAMPLES, load::Stamp,
        observer::rotation,
    },
};

/// The most models that keys 1–9 reach.
pub const MODEL_SLOTS: usize = 9;
/// The most files that the list of recent files holds.
pub const RECENT_FILES: usize = 10;
/// The most messages that are kept; the oldest give way.
pub const MAX_MESSAGES: usize = 500;
/// What the scene has, and objects may override.
const MODEL: &str = "reflection model";

/// The state of the window.
#[derive(Clone, Debug, Resource)]
pub struct Session {
    /// The document: the scene and the way to it.
    pub document: Document,
    /// The file that the document came from or was last saved to.
    pub path: Option<PathBuf>,
    /// What the inspector shows.
    pub selection: Selection,
    /// Messages, oldest first; each stays until it is dismissed, or until [`MAX_MESSAGES`] newer ones are there.
    pub messages: Vec<Note>,
    /// What is shown and how.
    pub view: View,
    /// Files opened or saved, latest first.
    pub recent_files: Vec<PathBuf>,
    /// The models that keys 1–9 choose. A model keeps its number while it is among them.
    pub model_slots: Vec<String>,
    /// Facts for the status line, fed by the app.
    pub status: Status,
    /// What the picture must say about itself, fed by the app.
    pub badges: Vec<Badge>,
    /// Where the picture clips, fed by the app; `None` where nothing does.
    pub clipping: Option<Clipping>,
    /// What is known of the document's file on disk.
    pub disk: OnDisk,
    /// Where shaders are edited and what is wrong with them, fed by the app.
    pub shaders: ShaderStatus,
    /// The custom model that is about to be written.
    pub draft: Option<ModelDraft>,
    /// The last check of the laws of a model.
    pub laws: Option<LawCheck>,
    /// The model that is chosen as soon as it is known: one whose file was just written.
    pub wanted_model: Option<String>,
    /// The orientation of the camera, fed by the app; turns the axes in the corner of the picture.
    pub camera: Quat,
    /// The place of the camera, fed by the app.
    pub eye: Vec3,
    /// The question that waits for an answer. While there is one, nothing else can be done.
    pub question: Option<Question>,
    /// Where the picture is, in points; written by the panels.
    pub picture_rect: egui::Rect,
    /// The part of it that shows what the observer sees; around it the picture goes on. Written by the panels.
    pub picture_frame: egui::Rect,
    /// What is written over it: marks keep clear of that; written by the panels.
    pub overlays: Vec<egui::Rect>,
    /// How many points of the window are a point of the panels; written by them.
    pub zoom: f32,
    /// True if the pointer is over the picture with no panel, menu or dialog between; written by the
    /// panels. What turns the camera must ask here first.
    pub pointer_in_picture: bool,
    /// True if a menu or a list is open, which the next click elsewhere closes and does nothing else; written by the
    /// panels.
    pub popup_open: bool,
    /// True if keys may steer the picture: no field has the focus and no question is open; written by
    /// the panels.
    pub keyboard_free: bool,
    /// The panels that there are, for the menus; written when they are shown.
    pub panels: Vec<PanelInfo>,
    /// The part whose name is being typed in the tree.
    pub renaming: Option<Selection>,
    /// The document came from a recovery copy: no file is known to have it.
    pub(super) recovered: bool,
    /// What waits for the document to be saved first.
    after_save: Option<Action>,
    /// A dialog that something other than the panels wants opened: what waited for the document to be
    /// saved.
    pub wanted_dialog: Option<Effect>,
    /// True if the next file that is opened may replace unsaved changes: the user was asked.
    may_discard: bool,
    /// The names of the parts that the file lacks and that the document got as defaults.
    pub(super) defaulted: Vec<String>,
    /// Slots of [`Self::model_slots`] in the order of use, latest last.
    slot_use: Vec<String>,
    /// The problems of the shaders in the frame before, by file and message.
    pub(super) seen_troubles: Vec<(String, String)>,
    /// What the document had and no model takes at present.
    pub(super) stashed: StashedValues,
    known_terms: KnownTerms,
    /// The step that a message offers to undo: how many were done with it, and its name.
    undo_offered: Option<(usize, Option<String>)>,
    /// True if the camera has left the observer, fed by the app.
    pub camera_left: bool,
}

/// A message to the user.
#[derive(Clone, Debug, PartialEq)]
pub struct Note {
    /// How bad it is.
    pub severity: Severity,
    /// What happened, where, and what to do.
    pub text: String,
    /// A button beside it, and what it does.
    pub offer: Option<(&'static str, Box<Action>)>,
}

/// How bad a message is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// Good to know.
    Info,
    /// Something is not as asked, and the picture is still right.
    Warning,
    /// Something failed.
    Error,
}

impl Severity {
    /// The word for it.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Info => "note",
            Self::Warning => "warning",
            Self::Error => "error",
        }
    }
}

/// Light or dark.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ThemeChoice {
    /// Near-black panels: for judging pictures.
    #[default]
    Dark,
    /// Near-white panels: for bright rooms and projectors.
    Light,
}

/// What is shown and how.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Light or dark.
    pub theme: ThemeChoice,
    /// The size of everything, per cent: one of [`SCALES`].
    pub scale: u16,
    /// True if the strip of examples is below the picture.
    pub examples_open: bool,
    /// The picture fills the screen, with the equation over it; the panels are hidden.
    pub presenting: bool,
    /// True if the window fills the screen.
    pub fullscreen: bool,
    /// The same before the presentation began.
    pub fullscreen_before: bool,
    /// True if lights have gizmos in the picture.
    pub show_gizmos: bool,
    /// True if the outline of the room is drawn.
    pub show_room: bool,
    /// True if clipped pixels are marked.
    pub show_clipping: bool,
    /// Which terms of the equation the picture shows.
    pub terms: TermSelection,
    /// True if the strip at the bottom is unfolded.
    pub bottom_open: bool,
    /// Id of the panel that the strip at the bottom shows.
    pub bottom_tab: String,
    /// True if the tree at the left is shown.
    pub left_open: bool,
    /// True if the inspector at the right is shown.
    pub right_open: bool,
    /// Width of the tree, points.
    pub left_width: f32,
    /// Width of the inspector, points.
    pub right_width: f32,
    /// Height of the strip at the bottom, points.
    pub bottom_height: f32,
    /// True if the list of keys is open.
    pub keys_open: bool,
    /// True if "about" is open.
    pub about_open: bool,
    /// True if the chooser of reflection models is open.
    pub chooser_open: bool,
}

impl Default for View {
    fn default() -> Self {
        Self {
            theme: ThemeChoice::Dark,
            scale: 100,
            examples_open: false,
            presenting: false,
            fullscreen: false,
            fullscreen_before: false,
            show_gizmos: true,
            show_room: true,
            show_clipping: false,
            terms: TermSelection::All,
            bottom_open: false,
            bottom_tab: "messages".to_owned(),
            left_open: true,
            right_open: true,
            left_width: 208.0,
            right_width: 344.0,
            bottom_height: 144.0,
            keys_open: false,
            about_open: false,
            chooser_open: false,
        }
    }
}

/// Facts for the status line.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Status {
    /// Mean time per frame, milliseconds; 0 when not yet known.
    pub frame_ms: f32,
    /// The interface to the GPU: "Vulkan", "Metal", …
    pub backend: String,
    /// The GPU.
    pub adapter: String,
    /// How the shaders are.
    pub shaders: Shaders,
    /// What is in progress, from 0 to 1, and what it is.
    pub progress: Option<(String, f32)>,
}

impl Status {
    /// Frames per second; 0 when not yet known.
    #[must_use]
    pub fn fps(&self) -> f32 {
        if self.frame_ms > 0.0 { 1000.0 / self.frame_ms } else { 0.0 }
    }
}

/// How the shaders are.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Shaders {
    /// All compiled.
    #[default]
    Ready,
    /// Some are being compiled.
    Compiling,
    /// The last change does not compile; the picture shows the one before.
    Stale,
}

/// What the picture says about itself in its corner, such as "stale shader".
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Badge {
    /// How bad it is.
    pub severity: Severity,
    /// A few words.
    pub text: String,
    /// The whole story, for the tooltip.
    pub help: String,
}

/// A question that must be answered.
#[derive(Clone, Debug, PartialEq)]
pub enum Question {
    /// There are unsaved changes, and this would lose them.
    Unsaved {
        /// What was asked for.
        then: Box<Action>,
    },
    /// A file lacks parts that have defaults (R3).
    MissingParts {
        /// The file.
        path: PathBuf,
        /// The scene with the defaults in place.
        scene: Box<Scene>,
        /// Which parts are missing.
        parts: Vec<MissingPart>,
    },
    /// The file is empty (R2).
    EmptyFile {
        /// The file.
        path: PathBuf,
    },
    /// The file changed on disk since it was read.
    ChangedOnDisk {
        /// The file.
        path: PathBuf,
    },
    /// The file of the document changed on disk, and so did the document.
    NewerOnDisk {
        /// The file.
        path: PathBuf,
        /// The scene in it.
        scene: Box<Scene>,
        /// The state of the file.
        version: Stamp,
    },
    /// An earlier window left unsaved changes.
    Recover(Box<Offer>),
}

/// A part that a scene file lacks, and its default.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingPart {
    /// What people call it: "the scene size".
    pub name: String,
    /// The default in words: "10 × 10 × 10 m".
    pub default: String,
}

/// The answer to a question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Save first, then do what was asked for.
    Save,
    /// Lose the changes and do what was asked for.
    Discard,
    /// Do nothing.
    Cancel,
    /// Use the defaults.
    UseDefaults,
    /// Replace what is on disk.
    Overwrite,
    /// Take what is on disk.
    Reload,
    /// Keep what is on screen; saving replaces what is on disk now.
    Keep,
    /// Go on with what an earlier window left.
    Recover,
}

/// What a user can do. Panels return these.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Start a new default scene.
    New,
    /// Choose a file to open.
    OpenDialog,
    /// Open a file.
    Open(PathBuf),
    /// Open one of [`EXAMPLES`] as a document that is in no file.
    OpenExample(usize),
    /// Read the file again.
    Reload,
    /// Save to the file of the document, or choose one.
    Save,
    /// Choose a file and save to it.
    SaveAsDialog,
    /// Save to a file.
    SaveAs(PathBuf),
    /// Forget the list of recent files.
    ClearRecent,
    /// Close the window.
    Quit,
    /// Answer the open question.
    Answer(Answer),
    /// Select a part of the scene.
    Select(Selection),
    /// Select the next object.
    SelectNext,
    /// Select the object before.
    SelectPrevious,
    /// Add a light of this type.
    AddLight(String),
    /// Add an object of this type.
    AddObject(String),
    /// Add another one like this.
    Duplicate(Selection),
    /// Remove a light or an object.
    Remove(Selection),
    /// Hide an object or show it again; switch a light off or on.
    Toggle(Selection),
    /// Begin typing the name of a part in the tree.
    BeginRename(Selection),
    /// Stop typing without a change.
    CancelRename,
    /// Change the scene.
    Edit(Edit),
    /// Take the last step back.
    Undo,
    /// Do the step again that was taken back last.
    Redo,
    /// Take steps back, or do them again, until so many are done.
    GoToStep(usize),
    /// Choose the n-th of the recent models, from 0.
    RecentModel(usize),
    /// Change the exposure by so many EV.
    Expose(f32),
    /// Show the next term of the equation alone.
    NextTerms,
    /// Change what is shown.
    View(ViewChange),
    /// Put the camera where the observer is.
    HomeView,
    /// Let the camera look at what is selected.
    FocusSelection,
    /// Make the place of the camera that of the observer.
    ObserverFromView,
    /// Move the camera a little.
    Steer(Steer),
    /// Put text on the clipboard.
    Copy(String),
    /// Something about custom models and shaders.
    Model(ModelCommand),
    /// Say something.
    Say(Severity, String),
    /// Remove a message.
    Dismiss(usize),
    /// Remove all messages.
    DismissAll,
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
}

/// A change of what is shown.
#[derive(Clone, Debug, PartialEq)]
pub enum ViewChange {
    /// See [`View::theme`].
    Theme(ThemeChoice),
    /// See [`View::scale`]; the nearest of [`SCALES`] is taken.
    Scale(u16),
    /// The next of [`SCALES`].
    Larger,
    /// The one before.
    Smaller,
    /// See [`View::examples_open`].
    Examples(bool),
    /// See [`View::presenting`].
    Presenting(bool),
    /// See [`View::fullscreen`].
    Fullscreen(bool),
    /// See [`View::show_gizmos`].
    Gizmos(bool),
    /// See [`View::show_room`].
    Room(bool),
    /// See [`View::show_clipping`].
    Clipping(bool),
    /// See [`View::terms`].
    Terms(TermSelection),
    /// True if the strip at the bottom is unfolded.
    Bottom(bool),
    /// Which panel the strip at the bottom shows; unfolds it.
    BottomTab(String),
    /// See [`View::left_open`].
    Left(bool),
    /// See [`View::right_open`].
    Right(bool),
    /// The widths of the panels after dragging: tree, inspector, height of the strip.
    Sizes {
        /// See [`View::left_width`].
        left: f32,
        /// See [`View::right_width`].
        right: f32,
        /// See [`View::bottom_height`].
        bottom: f32,
    },
    /// See [`View::keys_open`].
    Keys(bool),
    /// See [`View::about_open`].
    About(bool),
    /// See [`View::chooser_open`].
    Chooser(bool),
}

/// What needs files, entities or the operating system; the app carries these out.
#[derive(Clone, Debug, PartialEq)]
pub enum Effect {
    /// Show the dialog that chooses a file to open.
    PickOpen,
    /// Show the dialog that chooses a file to save to.
    PickSave,
    /// Read a file; see [`files::run`](super::files::run).
    OpenFile(PathBuf),
    /// Write the document; see [`files::run`](super::files::run).
    SaveFile {
        /// Where to.
        path: PathBuf,
        /// True to replace a file that changed on disk since it was read, or that was never read.
        overwrite: bool,
    },
    /// The document is another one: forget what belonged to the one before.
    DocumentChanged,
    /// Look whether the document's file changed on disk; see [`reload::look`](super::reload::look).
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
    /// What becomes of the recovery copy that the question was about.
    Recovery(Choice),
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
        /// What people call it.
        name: String,
    },
    /// Write a model as a file of one's own.
    DuplicateModel {
        /// Id of the model that is copied.
        model: String,
        /// Id of the copy, which is also the name of the file.
        id: String,
        /// What people call it.
        name: String,
    },
    /// Open a file in an editor.
    OpenInEditor {
        /// The file.
        path: PathBuf,
        /// The line to go to, from 1.
        line: usize,
    },
    /// Try to find the laws of a model broken.
    CheckLaws(String),
    /// Show the dialog that chooses a folder for the shaders.
    PickShaderFolder,
    /// Write the shaders into a folder, to be edited there.
    ExportShaders(PathBuf),
}

/// An [`Effect`] on its way to the systems that carry it out.
#[derive(Clone, Debug, PartialEq, Message)]
pub struct LabEffect(pub Effect);

impl Default for Session {
    fn default() -> Self {
        Self::new(Scene::default())
    }
}

impl Session {
    /// A window on a scene that is in no file.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        let mut session = Self {
            selection: Selection::Room,
            path: None,
            messages: Vec::new(),
            view: View::default(),
            recent_files: Vec::new(),
            model_slots: Vec::new(),
            status: Status::default(),
            badges: Vec::new(),
            clipping: None,
            disk: OnDisk::default(),
            shaders: ShaderStatus::default(),
            draft: None,
            laws: None,
            wanted_model: None,
            camera: rotation(scene.observer.direction),
            eye: scene.observer.position,
            question: None,
            picture_rect: egui::Rect::NOTHING,
            picture_frame: egui::Rect::NOTHING,
            overlays: Vec::new(),
            zoom: 1.0,
            pointer_in_picture: false,
            popup_open: false,
            keyboard_free: true,
            panels: Vec::new(),
            renaming: None,
            recovered: false,
            after_save: None,
            wanted_dialog: None,
            may_discard: false,
            defaulted: Vec::new(),
            slot_use: Vec::new(),
            seen_troubles: Vec::new(),
            stashed: StashedValues::default(),
            known_terms: KnownTerms::default(),
            undo_offered: None,
            camera_left: false,
            document: Document::new(scene),
        };
        session.select_first();
        session.use_slot(&session.document.reflection_model.clone());
        session
    }

    /// True if the document differs from its file.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        self.recovered || !self.defaulted.is_empty() || self.disk.gone || self.document.differs()
    }

    /// True while the user is asked about unsaved changes, or saves them, in order to close the window.
    #[must_use]
    pub fn is_quitting(&self) -> bool {
        let asked = matches!(&self.question, Some(Question::Unsaved { then }) if **then == Action::Quit);
        asked || self.after_save == Some(Action::Quit)
    }

    /// What the window calls the document: the name of the scene, else the name of the file.
    #[must_use]
    pub fn title(&self) -> String {
        let file = || Some(printable(&self.path.as_ref()?.file_stem()?.to_string_lossy()).into_owned());
        self.document.name.clone().or_else(file).unwrap_or_else(|| "Untitled scene".to_owned())
    }

    /// What people call a part of the scene: its name, or its type and its number among its type.
    #[must_use]
    pub fn name_of(&self, part: Selection, registry: &Registry) -> String {
        self.document.name_of(part, registry)
    }

    /// The selected object, if it has a reflection model of its own: the choice at the top is then about
    /// that one, since a choice for the scene would not reach it.
    #[must_use]
    pub fn model_override(&self) -> Option<(usize, &str)> {
        let Selection::Object(i) = self.selection else { return None };
        Some((i, self.document.objects.get(i)?.reflection_model.as_deref()?))
    }

    /// The same for its shading model.
    #[must_use]
    pub fn shading_override(&self) -> Option<(usize, &str)> {
        let Selection::Object(i) = self.selection else { return None };
        Some((i, self.document.objects.get(i)?.shading_model.as_deref()?))
    }

    /// Id of the reflection model that the top of the window shows and changes.
    #[must_use]
    pub fn model_shown(&self) -> &str {
        self.model_override().map_or(&self.document.reflection_model, |(_, id)| id)
    }

    /// Id of the shading model that the top of the window shows and changes.
    #[must_use]
    pub fn shading_shown(&self) -> &str {
        self.shading_override().map_or(&self.document.shading_model, |(_, id)| id)
    }

    /// The edit that chooses another reflection model at the top of the window.
    #[must_use]
    pub fn edit_model(&self, id: &str) -> Edit {
        match self.model_override() {
            Some((i, _)) => Edit::Object(i, ObjectField::Model(Some(id.to_owned()))),
            None => Edit::Model(id.to_owned()),
        }
    }

    /// The edit that chooses another shading model at the top of the window.
    #[must_use]
    pub fn edit_shading_model(&self, id: &str) -> Edit {
        match self.shading_override() {
            Some((i, _)) => Edit::Object(i, ObjectField::ShadingModel(Some(id.to_owned()))),
            None => Edit::ShadingModel(id.to_owned()),
        }
    }

    /// The terms that the picture can show alone, and all of them; the terms that are 0 everywhere are left out.
    #[must_use]
    pub fn offered_terms(&self, registry: &Registry) -> Vec<TermSelection> {
        self.known_terms.offered(&self.document, registry)
    }

    /// True if nothing of the picture has the term that is shown alone.
    #[must_use]
    pub fn lacks_term(&self, registry: &Registry) -> bool {
        let shown = self.view.terms;
        shown != TermSelection::All && !self.known_terms.present(&self.document, registry).contains(&shown)
    }

    /// Why the observer cannot be where the camera is.
    #[must_use]
    pub fn observer_problem(&self) -> Option<&'static str> {
        let scene = &self.document;
        let taken = (scene.lights.iter().filter_map(|l| l.position))
            .chain(scene.objects.iter().map(|o| o.position))
            .any(|p| same_place(p, self.eye));
        match scene.scene_size.contains(self.eye) {
            false => Some("The view is outside the room."),
            true if taken => Some("The view is from the place of a light or an object."),
            true => None,
        }
    }

    /// The name of the window: what it calls the document, and the file where that is called otherwise.
    #[must_use]
    pub fn window_title(&self) -> String {
        let title = self.title();
        match self.path.as_ref().filter(|p| p.file_stem().is_none_or(|stem| *stem != *title)) {
            Some(path) => {
                let file = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
                format!("{title} — {}", printable(&file))
            }
            None => title,
        }
    }

    /// The change that folds the strip at the bottom away, or unfolds it with the messages.
    #[must_use]
    pub fn strip_change(&self) -> ViewChange {
        if self.view.bottom_open {
            ViewChange::Bottom(false)
        } else {
            ViewChange::BottomTab("messages".to_owned())
        }
    }

    /// Adds a message; an error unfolds the strip that shows it.
    pub fn say(&mut self, severity: Severity, text: impl Into<String>) {
        self.note(Note { severity, text: printable(&text.into()).into_owned(), offer: None });
    }

    fn note(&mut self, message: Note) {
        let severity = message.severity;
        // The same words twice in a row say no more than once.
        if self.messages.last() != Some(&message) {
            if self.messages.len() >= MAX_MESSAGES {
                self.messages.remove(0);
            }
            self.messages.push(message);
        }
        if severity == Severity::Error {
            self.view.bottom_open = true;
            "messages".clone_into(&mut self.view.bottom_tab);
        }
    }

    /// How many steps are done, and the last one's name.
    fn last_step(&self) -> (usize, Option<String>) {
        let done = self.document.done();
        let last = done.checked_sub(1).and_then(|last| self.document.steps().nth(last));
        (done, last.map(str::to_owned))
    }

    /// No message offers any more to undo the last step.
    fn withdraw_undo(&mut self) {
        let undo = |note: &Note| note.offer.as_ref().is_some_and(|(_, action)| **action == Action::Undo);
        self.messages.iter_mut().filter(|note| undo(note)).for_each(|note| note.offer = None);
        self.undo_offered = None;
    }

    /// The worst severity among the messages.
    #[must_use]
    pub fn worst(&self) -> Option<Severity> {
        self.messages.iter().map(|m| m.severity).max()
    }

    /// The scene of a file has been read: it becomes the document.
    pub fn opened(&mut self, path: PathBuf, scene: Scene) -> Vec<Effect> {
        self.view.examples_open = false;
        self.remember_file(&path);
        self.replace_document(Some(path), scene);
        vec![Effect::DocumentChanged, Effect::SaveSettings]
    }

    /// The document has been written. Returns what waited for it.
    pub fn saved(&mut self, path: PathBuf, registry: &Registry) -> Vec<Effect> {
        self.remember_file(&path);
        self.note_saved(&path);
        self.path = Some(path);
        self.document.mark_saved();
        self.recovered = false;
        self.defaulted.clear();
        self.disk_settled();
        let mut effects = vec![Effect::SaveSettings];
        if let Some(action) = self.after_save.take() {
            effects.extend(self.apply(action, registry));
        }
        effects
    }

    fn note_saved(&mut self, path: &Path) {
        let mut text = format!("Saved to {}.", printable(&path.to_string_lossy()));
        let mut offer = None;
        if self.camera_left {
            text.push_str(" The view you turned to is not in the file: it has the observer’s.");
            match self.observer_problem() {
                None => offer = Some(("Set observer to this view", Box::new(Action::ObserverFromView))),
                Some(why) => text.push_str(&format!(" {why}")),
            }
        }
        self.messages.retain(|m| m.severity != Severity::Info || !m.text.starts_with("Saved to "));
        self.note(Note { severity: Severity::Info, text, offer });
    }

    /// The document could not be written, or no file was chosen: what waited for it is dropped.
    pub fn not_saved(&mut self) {
        self.after_save = None;
    }

    /// Asks a question.
    pub fn ask(&mut self, question: Question) {
        self.question = Some(question);
    }

    /// Carries out an action. Returns what needs files, entities or the operating system.
    pub fn apply(&mut self, action: Action, registry: &Registry) -> Vec<Effect> {
        let effects = self.carry_out(action, registry);
        // It would undo something else.
        if self.undo_offered.as_ref().is_some_and(|step| *step != self.last_step()) {
            self.withdraw_undo();
        }
        effects
    }

    fn carry_out(&mut self, action: Action, registry: &Registry) -> Vec<Effect> {
        match action {
            Action::New => return self.unless_unsaved(Action::New, |session| session.start_new()),
            Action::Quit => return self.unless_unsaved(Action::Quit, |_| vec![Effect::Quit]),
            Action::OpenDialog => return self.unless_unsaved(Action::OpenDialog, |_| vec![Effect::PickOpen]),
            Action::Open(path) if std::mem::take(&mut self.may_discard) => {
                return vec![Effect::OpenFile(path)];
            }
            Action::Open(path) => {
                let again = Action::Open(path.clone());
                return self.unless_unsaved(again, |_| vec![Effect::OpenFile(path)]);
            }
            Action::OpenExample(i) => {
                return self
                    .unless_unsaved(Action::OpenExample(i), |session| session.open_example(i, registry));
            }
            Action::Reload => {
                return match self.path.clone() {
                    Some(path) => self.unless_unsaved(Action::Reload, |_| vec![Effect::OpenFile(path)]),
                    None => Vec::new(),
                };
            }
            Action::Save => {
                return match self.path.clone() {
                    Some(path) => vec![Effect::SaveFile { path, overwrite: false }],
                    None => vec![Effect::PickSave],
                };
            }
            Action::SaveAsDialog => return vec![Effect::PickSave],
            Action::SaveAs(path) => {
                // The default scene is called as its file from now on.
                if self.path.is_none() && self.document.name == Scene::default().name {
                    self.document
                        .change("Name of the scene", Extent::Rest, self.selection, |scene| scene.name = None);
                }
                // The dialog adds an extension to whatever is typed, and asked about that file only.
                let typed =
                    path.to_str().and_then(|p| p.strip_suffix(".json")).filter(|p| p.ends_with(".json"));
                return vec![match typed.map(PathBuf::from) {
                    Some(path) => Effect::SaveFile { path, overwrite: false },
                    None => Effect::SaveFile { path, overwrite: true },
                }];
            }
            Action::ClearRecent => {
                self.recent_files.clear();
                return vec![Effect::SaveSettings];
            }
            Action::Answer(answer) => {
                let mut effects = self.answer(answer, registry);
                if self.question.is_none() && std::mem::take(&mut self.disk.deferred) {
                    effects.push(Effect::LookAtFile { discard: false });
                }
                return effects;
            }
            Action::Select(selection) => self.select(selection),
            Action::SelectNext => self.step_selection(1),
            Action::SelectPrevious => self.step_selection(-1),
            Action::AddLight(id) => self.add_light(&id, registry),
            Action::AddObject(id) => self.add_object(&id, registry),
            Action::Duplicate(part) => self.duplicate(part, registry),
            Action::Remove(part) => self.remove(part, registry),
            Action::Toggle(part) => match part {
                Selection::Light(i) if self.exists(part) => {
                    let on = !self.document.lights[i].enabled;
                    self.edit(Edit::Light(i, LightField::Enabled(on)), registry);
                }
                Selection::Object(i) if self.exists(part) => {
                    let on = !self.document.objects[i].visible;
                    self.edit(Edit::Object(i, ObjectField::Visible(on)), registry);
                }
                _ => self.say(Severity::Info, "Select an object to hide it, or a light to switch it off."),
            },
            Action::BeginRename(part) => {
                self.select(part);
                self.renaming = Some(part);
            }
            Action::CancelRename => self.renaming = None,
            Action::Edit(edit) => self.edit(edit, registry),
            Action::Undo => match self.document.done().checked_sub(1) {
                Some(done) => self.go_to_step(done, registry),
                None => self.say(Severity::Info, "There is nothing to undo."),
            },
            Action::Redo if self.document.done() == self.document.steps().len() => {
                self.say(Severity::Info, "There is nothing to redo.");
            }
            Action::Redo => self.go_to_step(self.document.done() + 1, registry),
            Action::GoToStep(done) => self.go_to_step(done, registry),
            Action::RecentModel(slot) => {
                if let Some(edit) = self.model_slots.get(slot).map(|id| self.edit_model(id)) {
                    self.edit(edit, registry);
                }
            }
            Action::Expose(ev) => {
                let exposure = self.document.display.exposure + ev;
                if limits::exposure().allows(f64::from(exposure)) {
                    self.edit(Edit::Display(Display { exposure, ..self.document.display }), registry);
                }
            }
            Action::NextTerms => {
                let offered = self.offered_terms(registry);
                let next = match offered.iter().position(|t| *t == self.view.terms) {
                    Some(at) => offered[(at + 1) % offered.len()],
                    None => TermSelection::All,
                };
                if offered.len() == 1 && self.view.terms == next {
                    self.say(
                        Severity::Info,
                        "The equation has one term here: there is nothing to take apart.",
                    );
                }
                self.view.terms = next;
            }
            Action::View(change) => return self.change_view(change),
            Action::HomeView => return vec![Effect::HomeView],
            Action::FocusSelection => return vec![Effect::FocusSelection],
            Action::ObserverFromView => return vec![Effect::ObserverFromView],
            Action::Steer(steer) => return vec![Effect::Steer(steer)],
            Action::Copy(text) => return vec![Effect::CopyText(text)],
            Action::Model(ask) => return self.author(ask, registry),
            Action::Say(severity, text) => self.say(severity, text),
            Action::Dismiss(index) => {
                if index < self.messages.len() {
                    self.messages.remove(index);
                }
            }
            Action::DismissAll => self.messages.clear(),
        }
        Vec::new()
    }

    /// What should survive a restart.
    #[must_use]
    pub fn settings(&self) -> Settings {
        Settings {
            theme: self.view.theme,
            scale: self.view.scale,
            left_width: self.view.left_width,
            right_width: self.view.right_width,
            bottom_height: self.view.bottom_height,
            recent_files: self.recent_files.clone(),
        }
    }

    /// Takes over what survived a restart.
    pub fn adopt(&mut self, settings: Settings) {
        self.view.theme = settings.theme;
        self.view.scale = settings.scale;
        self.view.left_width = settings.left_width;
        self.view.right_width = settings.right_width;
        self.view.bottom_height = settings.bottom_height;
        self.recent_files = settings.recent_files;
        self.recent_files.truncate(RECENT_FILES);
    }

    // ── documents ──

    fn unless_unsaved(&mut self, action: Action, go: impl FnOnce(&mut Self) -> Vec<Effect>) -> Vec<Effect> {
        if self.is_dirty() {
            self.question = Some(Question::Unsaved { then: Box::new(action) });
            return Vec::new();
        }
        go(self)
    }

    /// An action whose loss of unsaved changes the user has accepted. The changes are not gone before
    /// it succeeds: a dialog can still be cancelled, a file can turn out to be broken.
    fn confirmed(&mut self, action: Action, registry: &Registry) -> Vec<Effect> {
        match action {
            Action::New => self.start_new(),
            Action::Quit => vec![Effect::Quit],
            Action::Open(path) => vec![Effect::OpenFile(path)],
            Action::OpenExample(i) => self.open_example(i, registry),
            Action::Reload => self.path.clone().map(Effect::OpenFile).into_iter().collect(),
            Action::OpenDialog => {
                self.may_discard = true;
                vec![Effect::PickOpen]
            }
            other => self.apply(other, registry),
        }
    }

    /// The dialog that chooses a file to open was closed without a choice.
    pub fn not_opened(&mut self) {
        self.may_discard = false;
    }

    /// Keys 1–9 choose a model from the start: the numbers that are free go to the registered models in
    /// their order.
    pub fn fill_model_slots(&mut self, registry: &Registry) {
        for model in registry.models() {
            let id = model.declaration.id;
            if self.model_slots.len() < MODEL_SLOTS && !self.model_slots.iter().any(|m| m == id) {
                self.model_slots.push(id.to_owned());
                // Never used, so the first to give way.
                self.slot_use.insert(0, id.to_owned());
            }
        }
    }

    fn start_new(&mut self) -> Vec<Effect> {
        self.replace_document(None, Scene::default());
        vec![Effect::DocumentChanged]
    }

    fn open_example(&mut self, i: usize, registry: &Registry) -> Vec<Effect> {
        match EXAMPLES.get(i).map(|example| example.scene(registry)) {
            Some(Ok(scene)) => {
                self.replace_document(None, scene);
                vec![Effect::DocumentChanged]
            }
            Some(Err(error)) => {
                self.say(Severity::Error, error.to_string());
                Vec::new()
            }
            None => Vec::new(),
        }
    }

    fn replace_document(&mut self, path: Option<PathBuf>, scene: Scene) {
        self.document = Document::new(scene);
        self.path = path;
        self.stashed.clear();
        self.renaming = None;
        self.after_save = None;
        self.may_discard = false;
        self.recovered = false;
        self.defaulted.clear();
        self.disk_settled();
        self.view.terms = TermSelection::All;
        self.select_first();
        self.use_slot(&self.document.reflection_model.clone());
    }

    /// The scene of a recovery copy becomes the document; it is unsaved.
    pub(super) fn recovered(&mut self, path: Option<PathBuf>, scene: Scene) {
        self.replace_document(path, scene);
        self.recovered = true;
    }

    fn remember_file(&mut self, path: &Path) {
        // The next start may be in another folder.
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        self.recent_files.retain(|p| *p != path);
        self.recent_files.insert(0, path);
        self.recent_files.truncate(RECENT_FILES);
    }

    fn answer(&mut self, answer: Answer, registry: &Registry) -> Vec<Effect> {
        let Some(question) = self.question.take() else { return Vec::new() };
        match (question, answer) {
            (Question::Unsaved { then }, Answer::Discard) => self.confirmed(*then, registry),
            (Question::Unsaved { then }, Answer::Save) => {
                self.after_save = Some(*then);
                self.apply(Action::Save, registry)
            }
            (Question::MissingParts { path, scene, parts }, Answer::UseDefaults) => {
                let effects = self.opened(path, *scene);
                // Until it is saved, the file differs from what is on screen.
                self.defaulted = parts.into_iter().map(|p| p.name).collect();
                effects
            }
            (Question::MissingParts { path, parts, .. }, _) => {
                let names: Vec<_> = parts.iter().map(|p| p.name.as_str()).collect();
                self.say(
                    Severity::Warning,
                    format!("{} was not opened: it lacks {}.", path.display(), names.join(" and ")),
                );
                Vec::new()
            }
            (Question::EmptyFile { .. }, Answer::UseDefaults) => self.start_new(),
            (Question::Recover(offer), answer) => self.answer_offer(*offer, answer),
            (Question::ChangedOnDisk { path }, Answer::Overwrite) => {
                vec![Effect::SaveFile { path, overwrite: true }]
            }
            (Question::ChangedOnDisk { path }, Answer::Reload) => {
                self.not_saved();
                vec![Effect::OpenFile(path)]
            }
            (Question::NewerOnDisk { path, scene, version }, Answer::Keep) => {
                // What is on disk is known now: saving replaces it.
                self.document.set_saved(*scene);
                self.recovered = false;
                self.disk_settled();
                vec![Effect::ExpectFile { path, version }]
            }
            (Question::NewerOnDisk { .. }, Answer::Reload) => vec![Effect::LookAtFile { discard: true }],
            (Question::NewerOnDisk { path, .. }, _) => {
                self.disk_undecided(&path);
                Vec::new()
            }
            _ => {
                self.not_saved();
                Vec::new()
            }
        }
    }

    // ── selection ──

    fn select_first(&mut self) {
        self.selection =
            if self.document.objects.is_empty() { Selection::Room } else { Selection::Object(0) };
    }

    fn exists(&self, part: Selection) -> bool {
        match part {
            Selection::Room | Selection::Observer => true,
            Selection::Light(i) => i < self.document.lights.len(),
            Selection::Object(i) => i < self.document.objects.len(),
        }
    }

    fn select(&mut self, selection: Selection) {
        if self.exists(selection) {
            if self.renaming != Some(selection) {
                self.renaming = None;
            }
            self.selection = selection;
        }
    }

    /// Selects what the last step made or left.
    fn select_new(&mut self, selection: Selection) {
        self.select(selection);
        self.document.selected(self.selection);
    }

    fn step_selection(&mut self, by: isize) {
        let count = self.document.objects.len() as isize;
        if count == 0 {
            return;
        }
        let next = match self.selection {
            Selection::Object(i) => (i as isize + by).rem_euclid(count),
            _ if by > 0 => 0,
            _ => count - 1,
        };
        self.select(Selection::Object(next as usize));
    }

    // ── lights and objects ──

    fn add_light(&mut self, id: &str, registry: &Registry) {
        let Some(entry) = registry.light(id) else { return };
        if self.document.lights.len() >= MAX_LIGHTS {
            self.say(Severity::Info, format!("A scene has at most {MAX_LIGHTS} lights."));
            return;
        }
        let d = entry.declaration;
        let stand = self.stand(registry);
        let position = stand.light(None);
        let mut light = Light {
            light_type: id.to_owned(),
            position: d.has_position.then_some(position),
            direction: d.has_direction.then(|| stand.towards_middle(position)),
            intensity: d.default_intensity,
            ..Light::default()
        };
        let (intensity, clips) = stand.intensity(&light, entry);
        light.intensity = intensity;
        let at = self.document.lights.len();
        self.document.insert_light(at, light, "Add", self.selection, registry);
        self.select_new(Selection::Light(at));
        if clips {
            let name = self.name_of(self.selection, registry);
            let text = format!("With {name} the picture clips: lower the exposure, or dim another light.");
            self.say(Severity::Info, text);
        }
    }

    fn add_object(&mut self, id: &str, registry: &Registry) {
        if registry.shape(id).is_none() {
            return;
        }
        if self.document.objects.len() >= MAX_OBJECTS {
            self.say(Severity::Info, format!("A scene has at most {MAX_OBJECTS} objects."));
            return;
        }
        let (position, size) = self.stand(registry).object(id);
        let object = Object { object_type: id.to_owned(), position, size, ..Object::default() };
        let at = self.document.objects.len();
        self.document.insert_object(at, object, "Add", self.selection, registry);
        self.select_new(Selection::Object(at));
    }

    fn duplicate(&mut self, part: Selection, registry: &Registry) {
        match part {
            Selection::Light(i) if i < self.document.lights.len() => {
                if self.document.lights.len() >= MAX_LIGHTS {
                    self.say(Severity::Info, format!("A scene has at most {MAX_LIGHTS} lights."));
                    return;
                }
                let mut copy = self.document.lights[i].clone();
                copy.position = copy.position.map(|p| self.stand(registry).light(Some(p)));
                copy.name = copy.name.map(|n| free_name(&self.document, &n));
                self.document.insert_light(i + 1, copy, "Duplicate", self.selection, registry);
                self.select_new(Selection::Light(i + 1));
            }
            Selection::Object(i) if i < self.document.objects.len() => {
                if self.document.objects.len() >= MAX_OBJECTS {
                    self.say(Severity::Info, format!("A scene has at most {MAX_OBJECTS} objects."));
                    return;
                }
                let mut copy = self.document.objects[i].clone();
                copy.position = self.stand(registry).copy(&copy);
                copy.name = copy.name.map(|n| free_name(&self.document, &n));
                let from = self.document.object_id(i);
                self.document.insert_object(i + 1, copy, "Duplicate", self.selection, registry);
                if let Some((from, to)) = from.zip(self.document.object_id(i + 1)) {
                    self.stashed.copied(from, to);
                }
                self.select_new(Selection::Object(i + 1));
            }
            _ => self.say(Severity::Info, "Select a light or an object to duplicate it."),
        }
    }

    fn remove(&mut self, part: Selection, registry: &Registry) {
        match part {
            Selection::Light(_) if self.document.lights.len() <= 1 => {
                self.say(
                    Severity::Info,
                    "The last light stays: a scene needs at least one to show anything.",
                );
            }
            Selection::Object(_) if self.document.objects.len() <= 1 => {
                self.say(Severity::Info, "Can’t delete the last object: a scene needs at least one.");
            }
            Selection::Light(_) | Selection::Object(_) if self.exists(part) => {
                let text = format!("Deleted “{}”.", self.name_of(part, registry));
                self.document.remove(part, registry);
                // What was selected stays so; in the place of what is gone comes its neighbour.
                let (lights, objects) = (self.document.lights.len(), self.document.objects.len());
                self.select_new(match (self.selection, part) {
                    (Selection::Light(at), Selection::Light(gone)) => {
                        Selection::Light((at - usize::from(at > gone)).min(lights - 1))
                    }
                    (Selection::Object(at), Selection::Object(gone)) => {
                        Selection::Object((at - usize::from(at > gone)).min(objects - 1))
                    }
                    (other, _) => other,
                });
                self.renaming = None;
                self.withdraw_undo();
                self.undo_offered = Some(self.last_step());
                let offer = Some(("Undo", Box::new(Action::Undo)));
                self.note(Note { severity: Severity::Info, text, offer });
            }
            Selection::Observer => {
                self.say(Severity::Info, "The observer stays: a scene has exactly one.");
            }
            _ => self.say(Severity::Info, "Select a light or an object to remove it."),
        }
    }

    /// The scene before the camera, as a place for what is added.
    fn stand<'a>(&'a self, registry: &'a Registry) -> Stand<'a> {
        Stand::new(&self.document, registry, self.eye, self.camera)
    }

    // ── changing the scene ──

    fn edit(&mut self, edit: Edit, registry: &Registry) {
        let model = match &edit {
            Edit::Model(id) | Edit::Object(_, ObjectField::Model(Some(id))) => Some(id.clone()),
            _ => None,
        };
        let scene_choice = match &edit {
            Edit::Model(_) => Some(MODEL),
            Edit::ShadingModel(_) => Some("shading model"),
            _ => None,
        };
        let named =
            matches!(edit, Edit::Light(_, LightField::Name(_)) | Edit::Object(_, ObjectField::Name(_)));
        let done = match edit {
            Edit::Light(i, LightField::Type(id)) if registry.light(&id).is_some() => {
                self.change_light_type(i, &id, registry);
                Ok(())
            }
            edit => self.document.edit(edit, self.selection, registry),
        };
        if let Err(why) = done {
            return self.say(Severity::Warning, why);
        }
        if let Some(id) = model {
            self.use_slot(&id);
        }
        if let Some(what) = scene_choice {
            let own = |o: &Object| match what {
                MODEL => o.reflection_model.is_some(),
                _ => o.shading_model.is_some(),
            };
            if self.document.shown().next().is_some() && self.document.shown().all(own) {
                let text = format!(
                    "Every visible object overrides the {what}, so the scene’s does not show. Select an object to change its own."
                );
                self.say(Severity::Info, text);
            }
        }
        if named {
            self.renaming = None;
        }
    }

    /// Takes over what something other than the panels changed: a system that changed a component.
    ///
    /// # Errors
    /// Why it is refused; the document stays as it is.
    pub fn submit(&mut self, scene: Scene, registry: &Registry) -> Result<(), String> {
        self.document.submit(scene, self.selection, registry)?;
        if !self.exists(self.selection) {
            self.selection = Selection::Room;
        }
        Ok(())
    }

    fn change_light_type(&mut self, i: usize, id: &str, registry: &Registry) {
        let Some(light) = self.document.lights.get(i) else { return };
        let stand = self.stand(registry);
        let position = light.position.unwrap_or_else(|| stand.light(None));
        let direction = light.direction.unwrap_or_else(|| stand.towards_middle(position));
        self.document.change_light_type(i, id, (position, direction), self.selection, registry);
    }

    /// Takes a step back, or does it again, until so many are done.
    fn go_to_step(&mut self, done: usize, registry: &Registry) {
        let model = self.document.reflection_model.clone();
        while self.document.done() != done.min(self.document.steps().len()) {
            let step = if self.document.done() > done { self.document.undo() } else { self.document.redo() };
            let Some((_, selection)) = step else { break };
            self.selection = selection;
        }
        if !self.exists(self.selection) {
            self.selection = Selection::Room;
        }
        self.renaming = None;
        if self.document.reflection_model != model {
            self.use_slot(&self.document.reflection_model.clone());
        }
        // The models may be others than when the step was made.
        super::follow::follow_registry(self, registry);
    }

    /// Gives a model one of the keys 1–9: the one that it has, a free one, or that of the model that
    /// was not used for longest. The others keep theirs, so that fingers can learn them.
    pub(super) fn use_slot(&mut self, id: &str) {
        self.slot_use.retain(|m| m != id);
        self.slot_use.push(id.to_owned());
        if self.model_slots.iter().any(|m| m == id) {
            return;
        }
        if self.model_slots.len() < MODEL_SLOTS {
            self.model_slots.push(id.to_owned());
            return;
        }
        let oldest = self.slot_use.remove(0);
        if let Some(slot) = self.model_slots.iter_mut().find(|m| **m == oldest) {
            id.clone_into(slot);
        }
    }

    fn change_view(&mut self, change: ViewChange) -> Vec<Effect> {
        let before = self.settings();
        let view = &mut self.view;
        match change {
            ViewChange::Theme(theme) => view.theme = theme,
            ViewChange::Scale(percent) => view.scale = nearest_scale(percent),
            ViewChange::Larger => {
                view.scale = SCALES.into_iter().find(|s| *s > view.scale).unwrap_or(view.scale)
            }
            ViewChange::Smaller => {
                view.scale = SCALES.into_iter().rfind(|s| *s < view.scale).unwrap_or(view.scale);
            }
            ViewChange::Examples(on) => view.examples_open = on,
            ViewChange::Presenting(on) if on != view.presenting => {
                let before = std::mem::replace(&mut view.fullscreen_before, view.fullscreen);
                view.fullscreen = on || before;
                view.presenting = on;
            }
            ViewChange::Presenting(_) => {}
            ViewChange::Fullscreen(on) => view.fullscreen = on,
            ViewChange::Gizmos(on) => view.show_gizmos = on,
            ViewChange::Room(on) => view.show_room = on,
            ViewChange::Clipping(on) => view.show_clipping = on,
            ViewChange::Terms(terms) => view.terms = terms,
            ViewChange::Bottom(open) => view.bottom_open = open,
            ViewChange::BottomTab(id) => {
                view.bottom_tab = id;
                view.bottom_open = true;
            }
            ViewChange::Left(open) => view.left_open = open,
            ViewChange::Right(open) => view.right_open = open,
            ViewChange::Sizes { left, right, bottom } => {
                (view.left_width, view.right_width, view.bottom_height) = (left, right, bottom);
            }
            ViewChange::Keys(open) => view.keys_open = open,
            ViewChange::About(open) => view.about_open = open,
            ViewChange::Chooser(open) => view.chooser_open = open,
        }
        if before == self.settings() { Vec::new() } else { vec![Effect::SaveSettings] }
    }
}
