//! The actions of a user, and their dispatch.

use std::path::PathBuf;

use glam::Vec3;

use super::{
    Alike, Arrangement, CodeCommand, CompareCommand, Effect, LessonCommand, MatchCommand, MaterialCommand,
    PlotCommand, Session, Severity, TakeCommand, ViewChange,
};
use crate::{
    document::{Edit, Selection},
    registry::Registry,
};

/// An action of the user, as returned by panels.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Start a new default scene.
    New,
    /// Choose a file to open.
    OpenDialog,
    /// Open a file.
    Open(PathBuf),
    /// Open one of [`EXAMPLES`](crate::scene::examples::EXAMPLES) as an unsaved document.
    OpenExample(usize),
    /// Reload the file from disk.
    Reload,
    /// Save to the file of the document, or choose one if there is none.
    Save,
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
    /// Select a light or an object besides what is selected; or no longer, if it is selected.
    SelectAlso(Selection),
    /// Select the lights and objects from the selection to this one, in the order of the list.
    SelectRange(Selection),
    /// Select these lights and objects, or add them to what is selected.
    SelectEach(Vec<Selection>, bool),
    /// Select all lights and objects that are like the selection.
    SelectAlike(Alike),
    /// Select the next object.
    SelectNext,
    /// Select the previous object.
    SelectPrevious,
    /// Add a light of this type.
    AddLight(String),
    /// Add an object of this type.
    AddObject(String),
    /// Duplicate a light or an object.
    Duplicate(Selection),
    /// Make a row of an object.
    MakeRow(Selection),
    /// Remove a light, an object, or its row.
    Remove(Selection),
    /// Hide or show an object; switch a light on or off.
    Toggle(Selection),
    /// Hide all objects that are not selected, and show those that are.
    HideOthers,
    /// Show all objects.
    ShowAll,
    /// Align or distribute what is selected along an axis: 0 for x, 1 for y, 2 for z.
    Arrange(Arrangement, usize),
    /// Open files dropped on the window, or add them to the scene.
    Drop(Vec<PathBuf>),
    /// Start to rename a part in the scene list.
    BeginRename(Selection),
    /// Cancel renaming.
    CancelRename,
    /// Start a drag in the picture, whose changes form one step of the history.
    BeginDrag,
    /// Move, turn or resize the selection by one step in this world direction, as the handles would.
    Nudge(Vec3),
    /// Change the scene.
    Edit(Edit),
    /// Undo the latest step.
    Undo,
    /// Redo the step undone last.
    Redo,
    /// Undo or redo until this number of steps is applied.
    GoToStep(usize),
    /// Select the reflection model with this id, as at the top of the window.
    ChooseModel(String),
    /// Select the n-th recent model, from 0.
    RecentModel(usize),
    /// Change the exposure by this many EV.
    Expose(f32),
    /// Isolate the next term of the equation.
    NextTerms,
    /// Change the view state.
    View(ViewChange),
    /// Pin the pixel under the pointer, or else the centre of the picture, so that it stays explained; unpin if that one,
    /// or without a pointer any, is pinned.
    Pin,
    /// Move the camera around the pinned point until it faces the plane of the point's vectors.
    LookFromSide,
    /// Carry out an effect, which changes nothing in the session.
    Do(Effect),
    /// A command for custom models and shaders.
    Model(ModelCommand),
    /// A command for the library of materials.
    Material(MaterialCommand),
    /// A command for the editor.
    Code(CodeCommand),
    /// A command for exports.
    Export(ExportCommand),
    /// Copy a text, and say this once it is copied.
    Copy(String, String),
    /// Copy a link.
    CopyLink(LinkTo),
    /// A command for the views of a comparison.
    Compare(CompareCommand),
    /// A command for matching views.
    Match(MatchCommand),
    /// A command for saved pictures and sheets.
    Take(TakeCommand),
    /// A command for the plots.
    Plot(PlotCommand),
    /// A command for lessons.
    Lesson(LessonCommand),
    /// Move the keyboard focus, which the panels do.
    Focus(FocusMove),
    /// Show a message.
    Say(Severity, String),
    /// Dismiss a message.
    Dismiss(usize),
    /// Dismiss all messages.
    DismissAll,
}

/// A movement of the keyboard focus.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FocusMove {
    /// To the next panel.
    NextPanel,
    /// To the panel before.
    PreviousPanel,
    /// Into the menu of this name, or out of it.
    Menu(&'static str),
}

/// The answer to a question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// Save first, then perform the pending action.
    Save,
    /// Discard the changes and perform the pending action.
    Discard,
    /// Do nothing.
    Cancel,
    /// Use the defaults.
    UseDefaults,
    /// Overwrite the version on disk.
    Overwrite,
    /// Load the version on disk.
    Reload,
    /// Keep the version on screen; saving will overwrite the one on disk.
    Keep,
    /// Continue with the unsaved work of an earlier window.
    Recover,
}

/// A command for exports.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExportCommand {
    /// Choose a destination for an export in a format, by its id.
    Dialog(&'static str),
    /// Export to a destination.
    To {
        /// Id of the format.
        form: &'static str,
        /// The file or folder.
        path: PathBuf,
    },
}

/// Where a link leads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LinkTo {
    /// To the scene that is shown, which the link holds.
    Scene,
    /// To the step of the open lesson.
    Step,
}

/// A command for custom models and shaders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelCommand {
    /// Start a new model: ask for its name.
    New,
    /// Start a copy of the current model: ask for its name.
    Duplicate,
    /// Start a copy of the model with this id: ask for its name.
    DuplicateOf(String),
    /// The name of the model, as typed.
    Type(String),
    /// Create the file of the model.
    Create,
    /// Cancel the new model.
    Cancel,
    /// Open the file of the current model in an editor.
    EditShown,
    /// Search for violations of the laws of the current model.
    CheckLaws,
}

impl Action {
    /// True if a dialog or a question may follow, to which the next keys belong.
    #[must_use]
    pub(in crate::panel) fn may_ask(&self) -> bool {
        matches!(
            self,
            Self::New
                | Self::OpenDialog
                | Self::Open(_)
                | Self::OpenExample(_)
                | Self::Reload
                | Self::Save
                | Self::SaveAs(_)
                | Self::Quit
                | Self::Do(Effect::Pick(_))
                | Self::Model(ModelCommand::New | ModelCommand::Duplicate | ModelCommand::DuplicateOf(_))
                | Self::Material(MaterialCommand::Ask)
                | Self::Match(MatchCommand::Ask(_))
                | Self::Take(TakeCommand::Ask(_))
                | Self::Export(ExportCommand::Dialog(_))
        )
    }
}

impl Session {
    /// Applies an action. Returns the effects, which need files, entities or the operating system.
    pub fn apply(&mut self, action: Action, registry: &Registry) -> Vec<Effect> {
        self.act(action, registry);
        self.requests()
    }

    /// Applies an action; its effects are [requested](Self::request).
    pub(super) fn act(&mut self, action: Action, registry: &Registry) {
        let revision = self.document.revision();
        let words = self.default_words();
        let undoes = matches!(action, Action::Undo | Action::Redo | Action::GoToStep(_));
        self.carry_out(action, registry);
        if !undoes && self.document.revision() != revision {
            self.forget_default_words(words);
        }
        self.resume_lesson();
        // The button would undo a different step.
        self.messages.check_undo(&self.last_step());
    }

    /// Requests an effect.
    pub(super) fn request(&mut self, effect: Effect) {
        self.requested.push(effect);
    }

    /// The effects requested since the last call.
    pub(in crate::panel) fn requests(&mut self) -> Vec<Effect> {
        std::mem::take(&mut self.requested)
    }

    pub(super) fn carry_out(&mut self, action: Action, registry: &Registry) {
        match action {
            Action::New
            | Action::OpenDialog
            | Action::Open(_)
            | Action::OpenExample(_)
            | Action::Reload
            | Action::Quit => self.unless_unsaved(action, registry),
            Action::Save => self.save(),
            Action::SaveAs(path) => self.save_as(&path, registry),
            Action::ClearRecent => self.clear_recent(),
            Action::Answer(answer) => self.answered(answer, registry),
            Action::Select(_)
            | Action::SelectAlso(_)
            | Action::SelectRange(_)
            | Action::SelectEach(..)
            | Action::SelectAlike(_)
            | Action::SelectNext
            | Action::SelectPrevious => self.choose(action),
            Action::AddLight(id) => self.add_light(&id, |_| (), registry),
            Action::AddObject(id) => self.add_object(&id, None, |_| (), registry),
            Action::Duplicate(part) => self.duplicate(part, registry),
            Action::MakeRow(part) => self.make_row(part, registry),
            Action::Remove(part) => self.remove(part, registry),
            Action::Toggle(part) => self.toggle(part, registry),
            Action::HideOthers => self.hide_others(registry),
            Action::ShowAll => self.show_all(registry),
            Action::Arrange(how, axis) => self.arrange(how, axis, registry),
            Action::Drop(paths) => self.dropped(paths, registry),
            Action::BeginRename(part) => self.begin_rename(part),
            Action::CancelRename => self.renaming = None,
            Action::BeginDrag => self.document.end_gesture(),
            Action::Nudge(way) => self.nudge(way, registry),
            Action::Edit(edit) => self.edit(edit, registry),
            Action::Undo => self.undo(registry),
            Action::Redo => self.redo(registry),
            Action::GoToStep(done) => self.go_to_step(done, registry),
            Action::ChooseModel(id) => self.edit(self.edit_model(&id), registry),
            Action::RecentModel(slot) => self.choose_recent(slot, registry),
            Action::Expose(ev) => self.expose(ev, registry),
            Action::NextTerms => self.next_terms(registry),
            Action::Compare(command) => self.compare(command, registry),
            Action::Match(command) => self.matching(command, registry),
            Action::Take(command) => self.take(command),
            Action::Plot(command) => self.plot(command),
            Action::Lesson(command) => self.lesson(command, registry),
            Action::View(change) => self.change_active_view(change, registry),
            Action::Pin => self.toggle_pin(),
            // The panels have made a movement of it, or a message.
            Action::LookFromSide | Action::Focus(_) => {}
            Action::Do(effect) => self.request(effect),
            Action::Model(ask) => self.author(ask, registry),
            Action::Material(command) => self.material(command, registry),
            Action::Code(command) => self.code(command, registry),
            Action::Export(command) => self.export(command),
            Action::Copy(..) | Action::CopyLink(_) => self.carry_away(action, registry),
            Action::Say(severity, text) => self.say(severity, text),
            Action::Dismiss(index) => self.messages.dismiss(index),
            Action::DismissAll => self.messages.clear(),
        }
    }
    fn choose(&mut self, action: Action) {
        match action {
            Action::Select(selection) => self.select(selection),
            Action::SelectAlso(part) => self.select_also(part),
            Action::SelectRange(to) => self.select_range(to),
            Action::SelectEach(parts, add) => self.select_each(parts, add),
            Action::SelectAlike(by) => self.select_alike(by),
            Action::SelectNext => self.step_selection(1),
            Action::SelectPrevious => self.step_selection(-1),
            _ => {}
        }
    }
}
