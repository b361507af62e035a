//! The actions of a user, and their dispatch.

use std::path::PathBuf;

use glam::Vec3;

use super::{
    CompareCommand, Effect, LessonCommand, MatchCommand, PlotCommand, Session, Severity, Steer, ViewChange,
};
use crate::{
    document::{Edit, LightField, ObjectField, Selection, VariantField},
    optics::TermSelection,
    parameter::Parameter,
    registry::Registry,
    scene::{Display, limits},
};

/// An action of a user. Panels return these.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// Start a new default scene.
    New,
    /// Choose a file to open.
    OpenDialog,
    /// Open a file.
    Open(PathBuf),
    /// Open one of [`EXAMPLES`](crate::scene::examples::EXAMPLES) as a document that is in no file.
    OpenExample(usize),
    /// Read the file again.
    Reload,
    /// Save to the file of the document, or choose one.
    Save,
    /// Choose a file and save to it.
    SaveAsDialog,
    /// Save to a file.
    SaveAs(PathBuf),
    /// Choose a file for a parameter of a light or an object.
    FileDialog(Selection, &'static Parameter),
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
    /// Open what was dropped on the window, or add it to the scene.
    Drop(Vec<PathBuf>),
    /// Show the manual in the browser.
    Manual,
    /// Begin typing the name of a part in the tree.
    BeginRename(Selection),
    /// Stop typing without a change.
    CancelRename,
    /// A drag in the picture begins: what it changes is a step of its own.
    BeginDrag,
    /// Move, turn or resize what is selected by one step in this direction of the room, as the handles would.
    Nudge(Vec3),
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
    /// Pin the pixel under the pointer, or else the middle of the picture, so that it stays explained; let go of the one
    /// that is pinned.
    Pin,
    /// Put the camera where the observer is.
    HomeView,
    /// Let the camera look at what is selected.
    FocusSelection,
    /// Turn the camera around the pinned point until the plane of its vectors is seen face on.
    LookFromSide,
    /// Moves the observer to the camera.
    ObserverFromView,
    /// Move the camera a little.
    Steer(Steer),
    /// Put text on the clipboard.
    Copy(String),
    /// Something about custom models and shaders.
    Model(ModelCommand),
    /// Something about exports.
    Export(ExportCommand),
    /// Something about pictures.
    Picture(PictureCommand),
    /// Something about the views of a comparison.
    Compare(CompareCommand),
    /// Something about matching views.
    Match(MatchCommand),
    /// Something about the plots.
    Plot(PlotCommand),
    /// Something about lessons.
    Lesson(LessonCommand),
    /// Say something.
    Say(Severity, String),
    /// Remove a message.
    Dismiss(usize),
    /// Remove all messages.
    DismissAll,
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

/// A command about exports.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ExportCommand {
    /// Choose a place for an export in a form, by its id.
    Dialog(&'static str),
    /// Export to a place.
    To {
        /// The id of the form.
        form: &'static str,
        /// The file or folder.
        path: PathBuf,
    },
    /// Stop the export that runs.
    Cancel,
    /// Show a folder in the file manager.
    Reveal(PathBuf),
}

/// A command about pictures. The view is the one that is wanted alone; `None` means all as they are shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PictureCommand {
    /// Choose a file for the picture.
    Dialog(Option<usize>),
    /// Save the picture to a file.
    To {
        /// The view.
        view: Option<usize>,
        /// The file.
        path: PathBuf,
    },
    /// Put the picture on the clipboard.
    Copy(Option<usize>),
}

/// A command about custom models and shaders.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ModelCommand {
    /// Begin a new model: ask what it shall be called.
    New,
    /// Begin a copy of the shown model: ask what it shall be called.
    Duplicate,
    /// The name of the model, as typed.
    Type(String),
    /// Write the file of the model.
    Create,
    /// Do not write it.
    Cancel,
    /// Open the file of the shown model in an editor.
    EditShown,
    /// Open a file in an editor.
    Edit {
        /// The file.
        path: PathBuf,
        /// The line to go to, from 1.
        line: usize,
    },
    /// Try to find the laws of the shown model broken.
    CheckLaws,
    /// Choose a folder and write the shaders into it.
    ExportDialog,
    /// Write the shaders into a folder.
    Export(PathBuf),
    /// Copy a file into the folder of custom models, and choose its model.
    Adopt(PathBuf),
}

impl Session {
    /// Carries out an action. Returns what needs files, entities or the operating system.
    pub fn apply(&mut self, action: Action, registry: &Registry) -> Vec<Effect> {
        let revision = self.document.revision();
        let words = self.default_words();
        let undoes = matches!(action, Action::Undo | Action::Redo | Action::GoToStep(_));
        let mut effects = self.carry_out(action, registry);
        if !undoes && self.document.revision() != revision {
            self.forget_default_words(words);
        }
        effects.extend(self.resume_lesson());
        // It would undo something else.
        self.messages.check_undo(&self.last_step());
        effects
    }

    pub(super) fn carry_out(&mut self, action: Action, registry: &Registry) -> Vec<Effect> {
        match action {
            Action::New => return self.unless_unsaved(Action::New, |session| session.start_new()),
            Action::Quit => return self.unless_unsaved(Action::Quit, |_| vec![Effect::Quit]),
            Action::OpenDialog => return self.unless_unsaved(Action::OpenDialog, |_| vec![Effect::PickOpen]),
            Action::Open(path) if std::mem::take(&mut self.questions.may_discard) => {
                return vec![Effect::OpenFile(path)];
            }
            Action::Open(path) => {
                let again = Action::Open(path.clone());
                return self.unless_unsaved(again, |_| vec![Effect::OpenFile(path)]);
            }
            Action::Drop(paths) => return self.dropped(paths, registry),
            Action::Manual => return vec![Effect::OpenManual],
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
            Action::FileDialog(part, parameter) => return vec![Effect::PickFile(part, parameter)],
            Action::SaveAs(path) => return self.save_as(&path, registry),
            Action::ClearRecent => {
                self.recent_files.clear();
                return vec![Effect::SaveSettings];
            }
            Action::Answer(answer) => {
                let mut effects = self.answer(answer, registry);
                if self.questions.open.is_none() && std::mem::take(&mut self.disk.deferred) {
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
            Action::BeginDrag => self.document.end_gesture(),
            Action::Nudge(way) => self.nudge(way, registry),
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
                let exposure = self.scene().display.exposure + ev;
                if limits::exposure().allows(f64::from(exposure)) {
                    self.edit(Edit::Display(Display { exposure, ..self.scene().display }), registry);
                }
            }
            Action::NextTerms => {
                let offered = self.offered_terms(registry);
                let shown = self.terms();
                let next = match offered.iter().position(|t| *t == shown) {
                    Some(at) => offered[(at + 1) % offered.len()],
                    None => TermSelection::All,
                };
                if offered.len() == 1 && shown == next {
                    self.say(
                        Severity::Info,
                        "The equation has one term here: there is nothing to take apart.",
                    );
                }
                return self.carry_out(Action::View(ViewChange::Terms(next)), registry);
            }
            Action::View(ViewChange::Terms(terms)) if self.active() > 0 => {
                let edit = Edit::Variant(self.active() - 1, VariantField::Terms(Some(terms)));
                self.edit_here(edit, registry);
            }
            Action::Compare(command) => self.compare(command, registry),
            Action::Match(command) => return self.matching(command, registry),
            Action::Plot(command) => return self.plot(command),
            Action::Lesson(command) => return self.lesson(command, registry),
            Action::View(change) => return self.change_view(change),
            Action::Pin => self.toggle_pin(),
            Action::HomeView => return vec![Effect::HomeView],
            Action::FocusSelection => return vec![Effect::FocusSelection],
            // The panels have made a movement of it, or a message.
            Action::LookFromSide => {}
            Action::ObserverFromView => return vec![Effect::ObserverFromView],
            Action::Steer(steer) => return vec![Effect::Steer(steer)],
            Action::Copy(text) => return vec![Effect::CopyText(text)],
            Action::Model(ask) => return self.author(ask, registry),
            Action::Export(command) => return self.export(command),
            Action::Picture(command) => return self.picture(command),
            Action::Say(severity, text) => self.say(severity, text),
            Action::Dismiss(index) => self.messages.dismiss(index),
            Action::DismissAll => self.messages.clear(),
        }
        Vec::new()
    }
}
