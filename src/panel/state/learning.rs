//! The steps of the open lesson: scenes, view settings, answers, and leaving the lesson.

use std::{
    collections::BTreeMap,
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{
    Action, Aside, CameraChange, EXPLAIN_TAB, Effect, LessonCommand, LessonSource, Note, OpenLesson,
    PLOTS_TAB, Pin, Place, Plots, Progress, Session, Severity, View,
    aside::DocumentView,
    follow::follow_registry,
    open_lesson::{Entered, problem_of},
};
use crate::{
    document::Document,
    files::{self, Shown as _},
    lesson::{Goal, Lesson, Problem, Task, WindowChange, shipped::LESSONS},
    registry::Registry,
    scene::Scene,
    text::plural,
};

/// True if a goal refers to the pinned pixel.
fn is_about_pixels(goal: &Goal) -> bool {
    goal.until.text().contains("probe.")
}

/// Size of the picture that the pinned positions of steps refer to: a window of another shape shows more or less of the
/// scene above and below.
const PICTURE: [u32; 2] = [1600, 900];

impl Session {
    pub(super) fn lesson(&mut self, command: LessonCommand, registry: &Registry) {
        let step = self.lesson.as_ref().map_or(0, |lesson| lesson.step);
        match command {
            LessonCommand::Open(LessonSource::Shipped(i)) => {
                if let Some(lesson) = LESSONS.get(i) {
                    self.begin_lesson(Arc::new(lesson.clone()), LessonSource::Shipped(i), registry);
                }
            }
            LessonCommand::Open(LessonSource::File(path)) => self.request(Effect::OpenLesson(path)),
            LessonCommand::Continue => {
                if let Some(source) = self.progress.next() {
                    self.lesson(LessonCommand::Open(source), registry);
                }
            }
            _ if self.lesson.is_none() => {
                self.say(Severity::Info, "No lesson is open: Help › Lessons lists them.");
            }
            LessonCommand::Leave => self.leave_lesson(registry),
            LessonCommand::Next => self.next_step(registry),
            LessonCommand::Previous if step == 0 => {}
            LessonCommand::Previous => self.return_to(step - 1, registry),
            LessonCommand::Again => self.return_to(step, registry),
            LessonCommand::GoTo(step) => self.return_to(step, registry),
            LessonCommand::Answer(answer) => self.record(|open, progress| open.choose(answer, progress)),
            LessonCommand::Point(pin) => {
                self.view.pin(Some(pin));
                self.view.unfold(EXPLAIN_TAB);
            }
            LessonCommand::Solved(step) => self.record(|open, progress| open.solve(step, progress)),
            LessonCommand::Hint => {
                self.lesson.iter_mut().for_each(|lesson| lesson.hint = !lesson.hint);
            }
            LessonCommand::Tree(open) => {
                self.lesson.iter_mut().for_each(|lesson| lesson.tree_open = open);
            }
        }
    }

    /// Records the events in the open lesson.
    fn record(&mut self, what: impl FnOnce(&mut OpenLesson, &mut Progress) -> Vec<Effect>) {
        let effects = self.lesson.as_mut().map(|open| what(open, &mut self.progress));
        self.requested.extend(effects.into_iter().flatten());
    }

    /// Opens a lesson at the learner's last step; a finished lesson starts again.
    pub(in crate::panel) fn begin_lesson(
        &mut self,
        lesson: Arc<Lesson>,
        source: LessonSource,
        registry: &Registry,
    ) {
        if lesson.steps.is_empty() {
            return;
        }
        self.leave_lesson(registry);
        let past = self.progress.of(&source.name()).filter(|past| !(past.finished && past.step == 0));
        let step = past.map_or(0, |past| past.step.min(lesson.steps.len() - 1));
        let (done, tries) = past.map(|past| (past.done.clone(), past.tries.clone())).unwrap_or_default();
        let scene = match lesson.state(step, registry) {
            Ok(scene) => scene,
            Err(why) => {
                let text = format!("The lesson “{}” was not opened: {why}", lesson.title);
                return self.say(Severity::Error, text);
            }
        };
        let mut aside = Aside::around(Document::new(scene), self);
        self.exchange(&mut aside);
        self.lesson = Some(OpenLesson {
            lesson,
            source,
            step,
            answers: BTreeMap::new(),
            done,
            tries,
            hint: false,
            asking: false,
            problems: Vec::new(),
            tree_open: false,
            entries: 0,
            entered: BTreeMap::new(),
            aside: Box::new(aside),
        });
        self.select_first();
        self.request(Effect::Camera(CameraChange::PutAside));
        self.show_from_start(step);
        self.arrived();
    }

    /// Shows a step with the view settings of all steps up to it.
    fn show_from_start(&mut self, step: usize) {
        let Some(lesson) = self.lesson.as_ref().map(|open| open.lesson.clone()) else { return };
        lesson.steps.iter().take(step + 1).for_each(|step| self.change_window(&step.window));
    }

    /// Applies the view settings of a step.
    fn change_window(&mut self, change: &WindowChange) {
        if let Some(active) = change.active {
            self.view.active = active.min(self.document.variants.len());
        }
        if let Some(part) = change.select.as_ref().and_then(|name| name.find(&self.document)) {
            self.select(part);
        }
        if let Some(terms) = change.terms {
            self.view.terms = terms;
        }
        if let Some(channel) = change.channel {
            let active = self.view.active;
            self.view.channels.get_mut(active).into_iter().for_each(|shown| *shown = channel);
        }
        let tab = |open: bool, tab: &str, view: &mut View| {
            if open {
                view.unfold(tab);
            } else if view.bottom_tab == tab {
                view.bottom_open = false;
            }
        };
        if let Some(on) = change.markers {
            self.view.show_markers = on;
        }
        if let Some(open) = change.explain {
            tab(open, EXPLAIN_TAB, &mut self.view);
        }
        if let Some(kind) = change.plots {
            tab(kind.is_some(), PLOTS_TAB, &mut self.view);
            kind.into_iter().for_each(|kind| self.plots.kind = kind);
        }
        if let Some(place) = change.pin {
            let Some(place) = place else {
                self.view.pin(None);
                return;
            };
            let pixel = [0, 1].map(|i| (place[i].clamp(0.0, 1.0) * PICTURE[i] as f32) as u32);
            let fov = self.document.view_angle();
            self.view.pin(Some(Pin::of_pixel(self.active(), pixel, PICTURE, fov)));
        }
    }

    /// Records the state at the start of a step, which *again* and *previous* restore.
    fn arrived(&mut self) {
        let entered = Entered {
            scene: Arc::new(self.document.scene().clone()),
            selection: self.selection,
            shown: DocumentView::of(&self.view),
            plots: self.plots.clone(),
        };
        let Some(open) = &mut self.lesson else { return };
        open.entered.insert(open.step, entered);
        // The text comes first, whatever the step opens.
        self.view.front = Place::Left;
        self.record(OpenLesson::note_step);
    }

    /// Shows a scene with a new history, unless it is shown already.
    fn show_scene(&mut self, scene: Scene, registry: &Registry) {
        if self.document == scene {
            return;
        }
        let home = self.document.observer != scene.observer;
        let types = |scene: &Scene| scene.objects.iter().map(|o| o.object_type.clone()).collect::<Vec<_>>();
        if types(&self.document) != types(&scene) {
            // With other objects, the pin becomes a new one; otherwise the point stays with its object.
            self.view.pin(self.view.pinned);
        }
        self.document = Document::new(scene);
        self.stashed.clear();
        self.travels.clear();
        self.renaming = None;
        self.messages.another_document();
        if !self.exists(self.selection) {
            self.select_first();
        }
        follow_registry(&mut *self, registry);
        if home {
            self.request(Effect::HomeView);
        }
    }

    fn next_step(&mut self, registry: &Registry) {
        let Some(open) = &mut self.lesson else { return };
        if !open.is_done() && !open.asking {
            open.asking = true;
            return;
        }
        if open.is_last() {
            return self.finish_lesson(registry);
        }
        open.step += 1;
        let (lesson, step) = (open.lesson.clone(), open.step);
        let Some(now) = lesson.steps.get(step) else { return };
        if let Some(change) = &now.scene {
            // If the learner has removed what the step changes, the step starts from its initial scene.
            let scene = change.apply(&self.document, registry).or_else(|_| lesson.state(step, registry));
            match scene {
                Ok(scene) => self.show_scene(scene, registry),
                Err(why) => self.say(Severity::Error, why),
            }
        }
        self.change_window(&now.window);
        self.arrived();
    }

    /// Returns to a step as it was when last entered.
    fn return_to(&mut self, step: usize, registry: &Registry) {
        let Some(open) = self.lesson.as_mut().filter(|open| step < open.lesson.steps.len()) else { return };
        open.step = step;
        open.answers.remove(&step);
        let (lesson, entered) = (open.lesson.clone(), open.entered.get(&step).cloned());
        let beginning = open.aside.beginning();
        let Some(entered) = entered else {
            return match lesson.state(step, registry) {
                Ok(scene) => {
                    self.show_scene(scene, registry);
                    beginning.put(&mut self.view);
                    self.plots = Plots::default();
                    self.show_from_start(step);
                    self.arrived();
                }
                Err(why) => self.say(Severity::Error, why),
            };
        };
        self.show_scene((*entered.scene).clone(), registry);
        entered.shown.put(&mut self.view);
        self.plots = entered.plots;
        self.view.front = Place::Left;
        self.select(entered.selection);
        self.record(OpenLesson::note_step);
    }

    /// The task of the current step, unless it is done.
    #[must_use]
    pub fn open_task(&self) -> Option<&Task> {
        self.lesson.as_ref().filter(|open| !open.is_done())?.now()?.task.as_ref()
    }

    /// True in a step whose task refers to the pinned pixel, which is then explained even with the panel closed.
    #[must_use]
    pub fn needs_probe(&self) -> bool {
        let step = self.lesson.as_ref().and_then(OpenLesson::now);
        let goal = step.and_then(|step| step.task.as_ref()?.goal());
        self.view.pinned.is_some() && goal.is_some_and(is_about_pixels)
    }

    /// True while the task is to find a pixel: a click into the picture pins it.
    #[must_use]
    pub fn seeks_pixel(&self) -> bool {
        matches!(self.open_task(), Some(Task::Find(goal)) if is_about_pixels(goal))
    }

    /// Finishes the lesson after the last step.
    fn finish_lesson(&mut self, registry: &Registry) {
        let Some(open) = &self.lesson else { return };
        let (title, source) = (open.lesson.title.clone(), open.source.clone());
        let (tasks, done) = (open.tasks(), open.done.len());
        let [right, first] = open.first_tries();
        let past = self.progress.lessons.entry(source.name()).or_default();
        (past.finished, past.step) = (true, 0);
        let mut text = format!("You have finished “{title}”.");
        if done < tasks {
            text.push_str(&format!(" You did {done} of {tasks} tasks."));
        }
        if right > 0 {
            text.push_str(&format!(" {first} of {} at the first try.", plural(right, "right answer")));
        }
        let mut note = Note::new(Severity::Info, text);
        if let LessonSource::Shipped(i) = source
            && let Some(next) = LESSONS.get(i + 1)
        {
            note.text.push_str(&format!(" The next one is “{}”.", next.title));
            let open = LessonCommand::Open(LessonSource::Shipped(i + 1));
            note = note.offering("Open it", Action::Lesson(open));
        }
        let name = source.name();
        self.leave_lesson(registry);
        self.note(note);
        self.request(Effect::SaveProgress(name));
    }

    /// Leaves the lesson and restores the user's own document.
    pub(super) fn leave_lesson(&mut self, registry: &Registry) {
        if let Some(mut open) = self.lesson.take() {
            self.exchange(&mut open.aside);
            // The models may have changed since the document was set aside.
            follow_registry(&mut *self, registry);
            self.request(Effect::Camera(CameraChange::Exchange));
        }
    }

    /// Leaves the lesson because another document replaces the user's own.
    pub(super) fn drop_lesson(&mut self) {
        self.parked = None;
        if let Some(mut open) = self.lesson.take() {
            self.exchange(&mut open.aside);
        }
    }

    /// Shows the user's own document while a question about it is open.
    pub(super) fn park_lesson(&mut self) {
        if let Some(mut open) = self.lesson.take() {
            self.exchange(&mut open.aside);
            self.parked = Some(Box::new(open));
            self.request(Effect::Camera(CameraChange::Exchange));
        }
    }

    /// True if a lesson was interrupted by a question, and no question is pending any more.
    pub(in crate::panel) fn is_lesson_due(&self) -> bool {
        self.parked.is_some() && !self.questions.are_pending()
    }

    /// Returns to the lesson once the question that interrupted it is settled.
    pub(in crate::panel) fn resume_lesson(&mut self) {
        let due = self.is_lesson_due();
        if let Some(mut open) = self.parked.take_if(|_| due) {
            self.exchange(&mut open.aside);
            self.lesson = Some(*open);
            self.request(Effect::Camera(CameraChange::Exchange));
        }
    }

    /// Opens a lesson that was read from a file, or reports all its problems. If it is already open, it continues at
    /// the current step.
    pub fn lesson_read(&mut self, path: PathBuf, read: Result<Lesson, Vec<Problem>>, registry: &Registry) {
        self.healed(&path);
        match read {
            Ok(lesson) => self.begin_lesson(Arc::new(lesson), LessonSource::File(path), registry),
            Err(problems) => {
                // The latest message is on top: first the problem, then above it the consequence.
                for problem in problems.iter().rev() {
                    self.say_about(&path, Severity::Error, problem_of(&path, problem));
                }
                let text = format!("The lesson {} was not opened.", path.shown());
                self.say_about(&path, Severity::Error, text);
            }
        }
    }

    /// Updates the open lesson after its file was edited. Keeps the step; restarts it if its scene or view settings
    /// have changed.
    pub fn lesson_edited(&mut self, read: Result<Lesson, Vec<Problem>>, registry: &Registry) {
        let Some(open) = &mut self.lesson else { return };
        let lesson = match read {
            Ok(lesson) if !lesson.steps.is_empty() => lesson,
            Ok(_) => return,
            Err(problems) => return open.problems = problems,
        };
        open.problems.clear();
        let step = open.step.min(lesson.steps.len() - 1);
        let before = open.lesson.state(open.step, registry);
        let windows = |lesson: &Lesson, step: usize| -> Vec<WindowChange> {
            lesson.steps.iter().take(step + 1).map(|step| step.window.clone()).collect()
        };
        let same = step == open.step
            && before == lesson.state(step, registry)
            && windows(&open.lesson, step) == windows(&lesson, step);
        open.lesson = Arc::new(lesson);
        open.entered.retain(|at, _| same && *at == step);
        open.answers.clear();
        if same {
            // The author's scroll position and rings stay.
            open.hint = false;
            self.requested.extend(open.note(&mut self.progress));
            return;
        }
        self.return_to(step, registry);
    }

    /// Folder of the open lesson's file.
    #[must_use]
    pub fn lesson_folder(&self) -> Option<&Path> {
        match &self.lesson.as_ref()?.source {
            LessonSource::File(path) => Some(files::folder_of(path)),
            LessonSource::Shipped(_) => None,
        }
    }
}
