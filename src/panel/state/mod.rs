//! The state of the window: the document, what is selected, what is shown; and the actions that
//! change it.
//!
//! [`Session`] is a Bevy resource, and knows nothing of Bevy otherwise: panels read it and return
//! [`Action`]s, [`Session::apply`] carries them out and returns the [`Effect`]s that need files, entities
//! or the operating system. All of it can be driven without a window.

use std::path::PathBuf;

use bevy::ecs::resource::Resource;
use bevy_egui::egui;
use glam::{Quat, Vec3};

pub use action::{Action, Steer};
pub use effect::{Effect, LabEffect};
pub use facts::{Shaders, Status};
pub use files::RECENT_FILES;
pub use messages::{Badge, MAX_MESSAGES, Note, Severity};
pub use question::{Answer, MissingPart, Question};
pub use slots::MODEL_SLOTS;
pub use view::{ThemeChoice, View, ViewChange};

use super::{
    PanelInfo,
    author::{LawCheck, ModelDraft},
    clipping::Clipping,
    follow::StashedValues,
    reload::OnDisk,
    terms::KnownTerms,
};
use crate::{
    document::{Document, Selection},
    library::status::ShaderStatus,
    scene::{Scene, observer::rotation},
};

mod action;
mod edit;
mod effect;
mod facts;
mod files;
mod messages;
mod parts;
mod question;
mod selection;
mod shown;
mod slots;
mod view;

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
}
