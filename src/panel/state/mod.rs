//! The state of the window: document, selection, view settings; and the actions that change it.
//!
//! [`Session`] is a Bevy resource, but otherwise independent of Bevy: panels read it and return [`Action`]s;
//! [`Session::apply`] applies them and returns the [`Effect`]s, which need files, entities or the operating system. All
//! of it can be driven without a window.

use std::path::PathBuf;

use bevy::prelude::{Deref, DerefMut, Resource};

pub use action::{Action, Answer, ExportCommand, FocusMove, LinkTo, ModelCommand};
pub use alike::Alike;
pub use area::{Cell, PictureArea};
pub use arrange::{Arrangement, Together};
pub use aside::Aside;
pub(super) use author::BUILT_IN;
pub use author::{Authoring, LawCheck, ModelDraft, NameProblem, check_name};
pub use code::{Code, CodeOf, KeptCode, MOST_CODE, OpenCode, SCENE_JSON, Theirs};
pub use code_command::{CODE_TAB, CodeCommand};
pub use compare::CompareCommand;
pub use desk::Desk;
pub use disk::OnDisk;
pub use effect::{CameraChange, Effect, Pick, RecoveryChoice, Steer};
pub use export::PictureEnd;
pub use facts::{Clipping, Converging, Facts, LARGEST, NoNumber, Numbers, Running};
pub use fits::Fits;
pub use lesson::{LessonCommand, LessonSource};
pub use lobe::{LobeChoice, LobeScale};
pub use matching::{MatchCommand, MatchDraft};
pub use materials::{MATERIALS_TAB, MaterialCommand, Materials};
pub use messages::{Badge, MAX_MESSAGES, Messages, Note};
pub use open_lesson::OpenLesson;
pub(super) use open_lesson::problem_of;
pub use own_keys::{GivenKeys, OwnKeys, Pairs, Replaced};
pub use place::{Over, PanelInfo, Place};
pub use plots::{MOST_LIGHT, Of, PinnedCurve, PlotCommand, Plots, Slot};
pub use probe::{EXPLAIN_TAB, Pin};
pub use progress::{Past, Progress};
pub use question::{MissingPart, Offer, Question, Questions};
pub(in crate::panel) use scene_code::read_scene;
pub use settings::{RECENT_FILES, SCALES, Settings, ThemeChoice, nearest_scale};
pub use severity::Severity;
pub use sheet_of::{SheetOf, Turning};
pub use shortcut::Shortcut;
pub use slots::{MODEL_SLOTS, ModelSlots};
pub use stash::StashedValues;
pub(super) use stash::{Kept, ParameterPlace};
pub use tabs::{MESSAGES_TAB, PLOTS_TAB, SHADER_TAB};
pub use taking::{PictureOptions, PictureSize, SheetOptions, TakeCommand, TakeDraft, Taken};
use travels::Traveller;
pub use travels::Travels;
pub use view::{HandleChange, HandleMode, Labels, View, ViewChange};

use seen::Seen;

use crate::{
    declared::with_defaults,
    document::{Document, Selection},
    library::status::ShaderStatus,
    parameter::Outside,
    scene::{Observer, Scene},
};

mod action;
mod alike;
mod area;
mod arrange;
mod aside;
mod author;
mod carry;
mod carry_view;
mod clipboard;
mod code;
mod code_command;
mod compare;
mod desk;
mod disk;
mod dropped;
mod edit;
mod effect;
mod export;
mod facts;
mod files;
mod fits;
pub mod follow;
mod group;
mod learning;
mod lesson;
mod link;
mod lobe;
mod matching;
mod materials;
mod messages;
mod nudge;
mod open_lesson;
mod own_keys;
mod parts;
mod place;
mod placing;
mod plots;
mod probe;
mod progress;
mod question;
mod rows;
mod scene_code;
mod seen;
mod selection;
mod settings;
mod severity;
mod sheet_of;
mod shortcut;
mod shown;
mod slots;
mod stash;
mod tabs;
mod taking;
mod terms;
mod travels;
mod view;

with_defaults! {
    /// The state of the window. The [`Desk`] holds the state of the open document besides its scene and file.
    #[derive(Clone, Debug, Deref, DerefMut, Resource)]
    pub struct Session {
        /// The document: the scene and its edit history.
        pub document: Document = Document::new(Scene::default()),
        /// The file that the document came from or was last saved to.
        pub path: Option<PathBuf> = None,
        /// The part shown in the properties panel.
        pub selection: Selection = Selection::Object(0),
        #[deref]
        desk: Desk = Desk::with(&Scene::default().reflection_model),
        /// The part being renamed in the scene list.
        pub renaming: Option<Selection> = None,
        /// View settings.
        pub view: View = View::default(),
        /// The open lesson; its scene is shown while the user's own document is set aside.
        pub lesson: Option<OpenLesson> = None,
        /// A lesson that is interrupted by a question about the user's own document.
        parked: Option<Box<OpenLesson>> = None,
        /// Progress in the lessons.
        pub progress: Progress = Progress::default(),
        /// Messages to the user.
        pub messages: Messages = Messages::default(),
        /// Questions to the user.
        pub questions: Questions = Questions::default(),
        /// The files outside their folders that scenes may name.
        pub outside: Outside = Outside::default(),
        /// The settings, which are kept between sessions.
        pub settings: Settings = Settings::default(),
        /// The keys of the user's own that are in force.
        pub keys: OwnKeys = OwnKeys::default(),
        /// Facts that the app provides without marking the session as changed.
        pub facts: Facts = Facts::at(&Observer::default()),
        /// Folders and problems of the shaders, provided by the app.
        pub shaders: ShaderStatus = ShaderStatus::default(),
        /// The writing of custom models and shaders.
        pub authoring: Authoring = Authoring::default(),
        /// The texts that are open in the editor.
        pub code: Code = Code::default(),
        /// The library of materials.
        pub materials: Materials = Materials::default(),
        /// The match that is about to start.
        pub match_draft: Option<MatchDraft> = None,
        /// The fits of every model to a measurement.
        pub fits: Option<Fits> = None,
        /// The options of a picture or a sheet that is about to be saved.
        pub take_draft: Option<TakeDraft> = None,
        /// The available panels, for the menus; updated when they are shown.
        pub panels: Vec<PanelInfo> = Vec::new(),
        /// A dialog to open on behalf of code other than the panels: an action that was pending until the document was
        /// saved.
        pub wanted_dialog: Option<Effect> = None,
        seen: Seen = Seen::default(),
        /// The texts that are on their way to the clipboard, and what is said once they are there.
        copying: Vec<(String, Note)> = Vec::new(),
        /// The effects that the action has requested so far.
        requested: Vec<Effect> = Vec::new(),
    }
}

impl Session {
    /// A session with a scene that has no file.
    #[must_use]
    pub fn new(scene: Scene) -> Self {
        let (facts, desk) = (Facts::at(&scene.observer), Desk::with(&scene.reflection_model));
        let mut session = Self { document: Document::new(scene), facts, desk, ..Self::default() };
        session.select_first();
        session
    }
}
