//! The state of the window: the document, what is selected, what is shown; and the actions that
//! change it.
//!
//! [`Session`] is a Bevy resource, and knows nothing of Bevy otherwise: panels read it and return
//! [`Action`]s, [`Session::apply`] carries them out and returns the [`Effect`]s that need files, entities
//! or the operating system. All of it can be driven without a window.

use std::path::PathBuf;

use bevy::ecs::resource::Resource;

pub use action::{Action, Answer, ExportCommand, ModelCommand, PictureCommand};
pub use area::{Cell, PictureArea};
pub use aside::Aside;
pub(super) use author::BUILT_IN;
pub use author::{LawCheck, ModelDraft, NameProblem, check_name};
pub use compare::CompareCommand;
pub use disk::OnDisk;
pub use effect::{CameraChange, Effect, LabEffect, RecoveryChoice, Steer};
pub use facts::{Clipping, Converging, Exporting, Facts, LARGEST, Matching, Numbers};
pub use files::RECENT_FILES;
pub use lesson::{LessonCommand, LessonSource};
pub use lobe::{LobeChoice, LobeScale};
pub use matching::{MatchCommand, MatchDraft};
pub use messages::{Badge, MAX_MESSAGES, Messages, Note};
pub use open_lesson::OpenLesson;
pub(super) use open_lesson::problem_of;
pub use own_keys::{GivenKeys, OwnKeys, Pairs, Replaced};
pub use pictures::PictureEnd;
pub use place::{PanelInfo, Place};
pub use plots::{MOST_LIGHT, Of, PinnedCurve, PlotCommand, Plots, Slot};
pub use probe::{EXPLAIN_TAB, Pin};
pub use progress::{Past, Progress};
pub use question::{MissingPart, Question, Questions};
pub use recovery::Offer;
pub use severity::Severity;
pub use shortcut::Shortcut;
pub use slots::{MODEL_SLOTS, ModelSlots};
pub use stash::StashedValues;
pub(super) use stash::{Kept, ParameterPlace};
pub use view::{
    HandleChange, HandleMode, Labels, MESSAGES_TAB, PLOTS_TAB, SCALES, SHADER_TAB, ThemeChoice, View,
    ViewChange, nearest_scale,
};

use super::terms::KnownTerms;
use crate::{
    document::{Document, Selection},
    library::status::ShaderStatus,
    scene::Scene,
};

mod action;
mod area;
mod aside;
mod author;
mod compare;
mod disk;
mod dropped;
mod edit;
mod effect;
mod export;
mod facts;
mod files;
mod learning;
mod lesson;
mod lobe;
mod matching;
mod messages;
mod nudge;
mod open_lesson;
mod own_keys;
mod parts;
mod pictures;
mod place;
mod plots;
mod probe;
mod progress;
mod question;
mod recovery;
mod selection;
mod severity;
mod shortcut;
mod shown;
mod slots;
mod stash;
mod view;

/// The state of the window.
#[derive(Clone, Debug, Resource)]
pub struct Session {
    /// The document: the scene and the way to it.
    pub document: Document,
    /// The file that the document came from or was last saved to.
    pub path: Option<PathBuf>,
    /// Facts about the document's file on disk.
    pub disk: OnDisk,
    /// Values that the document had and no model takes at present.
    pub(super) stashed: StashedValues,
    /// The part that the inspector shows.
    pub selection: Selection,
    /// The part whose name is being typed in the tree.
    pub renaming: Option<Selection>,
    /// The choice of what is shown, and how.
    pub view: View,
    /// The choices of the plots.
    pub plots: Plots,
    /// The lesson that is open: its scene is shown, and the user's own document waits.
    pub lesson: Option<OpenLesson>,
    /// A lesson that waits until a question about the user's own document is settled.
    parked: Option<Box<OpenLesson>>,
    /// What was done of the lessons.
    pub progress: Progress,
    /// Messages to the user.
    pub messages: Messages,
    /// Questions to the user.
    pub questions: Questions,
    /// Files opened or saved, latest first.
    pub recent_files: Vec<PathBuf>,
    /// The keys that the user gave to commands.
    pub keys: OwnKeys,
    /// The models that keys 1–9 choose.
    pub model_slots: ModelSlots,
    /// Facts that the app feeds without marking the session as changed.
    pub facts: Facts,
    /// The folders of the shaders and the problems in them, fed by the app.
    pub shaders: ShaderStatus,
    /// The problems of the shaders in the frame before, by file and message.
    pub(super) seen_troubles: Vec<(String, String)>,
    /// The custom model that is about to be written.
    pub draft: Option<ModelDraft>,
    /// The match that is about to begin.
    pub match_draft: Option<MatchDraft>,
    /// The model that is chosen as soon as it is known: one whose file was just written.
    pub wanted_model: Option<String>,
    /// The last check of the laws of a model.
    pub laws: Option<LawCheck>,
    /// The panels that there are, for the menus; written when they are shown.
    pub panels: Vec<PanelInfo>,
    /// A dialog that something other than the panels wants opened: what waited for the document to be
    /// saved.
    pub wanted_dialog: Option<Effect>,
    known_terms: KnownTerms,
    seen: compare::Seen,
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
            path: None,
            disk: OnDisk::default(),
            stashed: StashedValues::default(),
            selection: Selection::Room,
            renaming: None,
            view: View::default(),
            plots: Plots::default(),
            lesson: None,
            parked: None,
            progress: Progress::default(),
            messages: Messages::default(),
            questions: Questions::default(),
            recent_files: Vec::new(),
            keys: OwnKeys::default(),
            model_slots: ModelSlots::default(),
            facts: Facts::at(&scene.observer),
            shaders: ShaderStatus::default(),
            seen_troubles: Vec::new(),
            draft: None,
            match_draft: None,
            wanted_model: None,
            laws: None,
            panels: Vec::new(),
            wanted_dialog: None,
            known_terms: KnownTerms::default(),
            seen: compare::Seen::default(),
            document: Document::new(scene),
        };
        session.select_first();
        session.model_slots.take(&session.document.reflection_model);
        session
    }
}
