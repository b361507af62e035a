//! Recovery copies and Ctrl+C in the window: hands unsaved changes to the [`Keeper`], and asks about what an earlier
//! window left.

use std::{
    collections::VecDeque,
    path::{self, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::{Duration, SystemTime},
};

use bevy::{
    app::{App, Last, Plugin, PreUpdate},
    ecs::prelude::*,
};

use super::{
    ViewOptions,
    ending::{Guard, PATIENCE},
    files::DiskFiles,
    order::Loading,
    watching::{complain, waker},
};
use crate::files::Shown as _;
use crate::{
    panel::{
        files::Files as _,
        state::{Action, LabEffect, Offer, Question, RecoveryChoice, Session, Severity},
    },
    recovery::{About, Keeper, Left, Store, ago},
    registry::Registry,
    render::schedule::LabFrame,
    signals::Interrupt,
};

/// Keeps copies of unsaved work, asks about those that earlier windows left, and hears Ctrl+C.
#[derive(Clone, Debug)]
pub struct RecoveryPlugin {
    /// The file that the window opens: its copy is asked about first.
    pub file: Option<PathBuf>,
    /// True if copies of earlier windows are looked for.
    pub look: bool,
    /// True if the user is asked about them; else they are only mentioned.
    pub ask: bool,
}

impl RecoveryPlugin {
    pub(super) fn of(options: &ViewOptions) -> Self {
        let attended = options.exit_after.is_none();
        Self {
            file: options.file.clone().or_else(|| options.open.clone()),
            look: attended || !options.quiet,
            ask: attended,
        }
    }
}

impl Plugin for RecoveryPlugin {
    fn build(&self, app: &mut App) {
        let store = Store::of_user();
        let farewell = Farewell::prepare(store.clone(), app.world());
        let mut copies = Recovery::new(farewell);
        if self.look {
            copies.look(store.as_ref(), self.file.as_deref(), self.ask);
        }
        app.insert_resource(copies)
            .add_systems(PreUpdate, interrupted)
            .add_systems(LabFrame, (stayed, offer).chain().in_set(Loading::Recovery))
            .add_systems(Last, keep);
    }
}

/// The part of the window that outlives it.
#[derive(Clone)]
pub(super) struct Farewell {
    pub(super) keeper: Keeper,
    interrupt: Interrupt,
    /// The user decided to close the window.
    closing: Arc<AtomicBool>,
}

impl Farewell {
    /// Begins to keep copies, and to listen to signals.
    fn prepare(store: Option<Store>, world: &World) -> Self {
        let keeper = Keeper::start(store, waker(world));
        let last = keeper.clone();
        let last_act = move |signal: &str| {
            if let Some(sentence) = last.settle(PATIENCE).sentence() {
                complain(&format!("ended by {signal}; {sentence}"));
            }
        };
        let interrupt = Interrupt::listen(waker(world), last_act).unwrap_or_else(|error| {
            complain(&format!("signals end the window without a question: {error}"));
            Interrupt::default()
        });
        Self { keeper, interrupt, closing: Arc::default() }
    }

    /// The user decided to close the window, whatever is unsaved.
    pub(super) fn close(&self) {
        self.closing.store(true, Ordering::SeqCst);
    }

    /// The window is closed. What is unsaved and was not given up is kept; Ctrl+C ends the process here.
    pub(super) fn say(&self) {
        if self.closing.load(Ordering::SeqCst) {
            self.keeper.forget();
        }
        if let Some(sentence) = self.keeper.settle(PATIENCE).sentence() {
            complain(&sentence);
        }
        self.interrupt.end_if_asked();
    }
}

/// The copies: that of this window, and those that others left.
#[derive(Resource)]
pub(super) struct Recovery {
    pub(super) farewell: Farewell,
    /// Copies still to be asked about, the best first.
    left: VecDeque<Left>,
    /// The copy that the question is about.
    asked: Option<Left>,
    registry: Option<Arc<Registry>>,
    /// While it is here, this says farewell when the window goes.
    guard: Option<Guard>,
}

impl Drop for Recovery {
    fn drop(&mut self) {
        if self.guard.take().is_some() && !thread::panicking() {
            self.farewell.say();
        }
    }
}

impl Recovery {
    /// Leaves the farewell to whoever runs the window.
    pub(super) fn hand_over(&mut self) -> Option<(Farewell, Guard)> {
        Some((self.farewell.clone(), self.guard.take()?))
    }

    /// Without anything to ask.
    fn new(farewell: Farewell) -> Self {
        let guard = Guard::set(&farewell.keeper);
        Self { farewell, left: VecDeque::new(), asked: None, registry: None, guard: Some(guard) }
    }

    /// Looks for what earlier windows left, that of the file on the command line first. `ask` is false where there is
    /// nobody to answer: then it is only said.
    fn look(&mut self, store: Option<&Store>, file: Option<&path::Path>, ask: bool) {
        let mut left = store.map(Store::left).unwrap_or_default();
        let file = file.and_then(|file| path::absolute(file).ok());
        left.sort_by_key(|left| file.is_none() || left.about.path != file);
        if ask {
            self.left = left.into();
            return;
        }
        for left in left {
            complain(&format!(
                "unsaved changes of “{}” are kept in {}; a window without --exit-after offers them",
                left.about.title,
                left.journal.file().shown()
            ));
        }
    }

    /// Carries out the answer to the question about a copy.
    pub(super) fn answer(
        &mut self,
        choice: RecoveryChoice,
        session: &mut Session,
        files: &mut DiskFiles,
        registry: &Registry,
    ) {
        let Some(left) = self.asked.take() else { return };
        match choice {
            RecoveryChoice::Recovered => {
                if let Some(path) = &left.about.path {
                    files.expect(path, left.about.stamp);
                }
                let registry = Arc::new(registry.clone());
                self.farewell.keeper.adopt(left.journal, &session.document, about(session, files), &registry);
                let more = self.left.len();
                self.left.clear();
                if more > 0 {
                    let copies = if more == 1 { "One more copy is" } else { "More copies are" };
                    let text = format!("{copies} kept: the window offers them at its next start.");
                    session.say(Severity::Info, text);
                }
            }
            RecoveryChoice::Discarded => left.journal.remove(),
            RecoveryChoice::Next => {}
            RecoveryChoice::Later => self.left.clear(),
        }
    }
}

fn about(session: &Session, files: &DiskFiles) -> About {
    About {
        title: session.own_title(),
        // The next window may be started somewhere else.
        path: session.own_path().map(|path| path::absolute(path).unwrap_or_else(|_| path.to_owned())),
        stamp: session.own_path().and_then(|path| files.known(path)),
        process: 0,
    }
}

/// Ctrl+C in the terminal is Ctrl+Q in the window.
fn interrupted(
    recovery: Res<Recovery>,
    mut session: ResMut<Session>,
    registry: Res<Registry>,
    mut effects: MessageWriter<LabEffect>,
) {
    if recovery.farewell.interrupt.take() {
        effects.write_batch(session.apply(Action::Quit, &registry).into_iter().map(LabEffect));
    }
}

/// After Ctrl+C the user may decide to stay. Runs right after the effects are carried out: what closes the window is
/// none on its way then.
fn stayed(recovery: Res<Recovery>, session: Res<Session>) {
    if !recovery.farewell.closing.load(Ordering::SeqCst) && !session.questions.is_quitting() {
        recovery.farewell.interrupt.stay();
    }
}

/// Asks about the next copy, as soon as nothing else is asked.
fn offer(mut recovery: ResMut<Recovery>, mut session: ResMut<Session>, registry: Res<Registry>) {
    if recovery.left.is_empty() || session.questions.open.is_some() {
        return;
    }
    let Some(left) = recovery.left.pop_front() else { return };
    let scene = left.scene(&registry);
    if let Err(problems) = &scene {
        // The latest stands on top: the first problem.
        for problem in problems.iter().rev() {
            session.say(Severity::Warning, problem.clone());
        }
        complain(&problems.join("\n"));
    }
    let age = SystemTime::now().duration_since(left.when).unwrap_or(Duration::ZERO);
    session.questions.ask(Question::Recover(Box::new(Offer {
        title: left.about.title.clone(),
        path: left.about.path.clone(),
        file: left.journal.file(),
        when: ago(age),
        scene: scene.map_err(|problems| problems.into_iter().next().unwrap_or_default()),
    })));
    recovery.asked = Some(left);
}

/// Hands unsaved changes to the keeper; runs after all that changes the document in a frame.
fn keep(
    mut recovery: ResMut<Recovery>,
    mut session: ResMut<Session>,
    files: Res<DiskFiles>,
    registry: Res<Registry>,
) {
    let recovery = &mut *recovery;
    if registry.is_changed() {
        recovery.registry = None;
    }
    if let Some(why) = recovery.farewell.keeper.problem() {
        session.say(Severity::Warning, format!("There is no recovery copy of the unsaved changes: {why}."));
    }
    if !session.is_changed() && !files.is_changed() {
        return;
    }
    if !session.is_dirty() {
        recovery.farewell.keeper.forget();
        return;
    }
    let registry = recovery.registry.get_or_insert_with(|| Arc::new(registry.clone()));
    recovery.farewell.keeper.keep(session.own_document(), about(&session, &files), registry);
}
