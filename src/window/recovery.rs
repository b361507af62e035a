//! Recovery copies and Ctrl+C in the window: hands unsaved changes to the [`Keeper`], and offers those left by earlier
//! windows.

use std::{
    collections::VecDeque,
    path::{self, Path, PathBuf},
    sync::{
        Arc,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Duration,
};

use bevy::prelude::*;

use super::{
    Acting, ViewOptions,
    ending::{Guard, PATIENCE},
    files::DiskFiles,
    order::Loading,
    watching::{complain, waker},
};
use crate::files::Shown as _;
use crate::{
    panel::{
        files::Files as _,
        state::{Action, KeptCode, Offer, OpenCode, Question, RecoveryChoice, Session, Severity},
    },
    platform::{self, fs},
    recovery::{
        Abandoned, About, Keeper, Store, ago,
        texts::{self, KeptText, OF_SCENE, TextKeeper, Texts},
    },
    registry::Registry,
    render::{live::RendererFailed, schedule::LabFrame},
    signals::Interrupt,
};

/// Keeps copies of unsaved work, offers those left by earlier windows, and handles Ctrl+C.
#[derive(Clone, Debug)]
pub struct RecoveryPlugin {
    /// The file that the window opens: its copy is offered first.
    pub file: Option<PathBuf>,
    /// True to search for copies of earlier windows.
    pub search: bool,
    /// True to ask the user about them; false to only mention them.
    pub ask: bool,
}

impl RecoveryPlugin {
    pub(super) fn of(options: &ViewOptions) -> Self {
        let attended = options.exit_after.is_none();
        Self {
            file: options.file.clone().or_else(|| options.open.clone()),
            search: attended || !options.quiet,
            ask: attended,
        }
    }
}

impl Plugin for RecoveryPlugin {
    fn build(&self, app: &mut App) {
        let store = Store::of_user();
        let farewell = Farewell::prepare(store.clone(), app.world());
        let keeper = farewell.keeper.clone();
        platform::attend(waker(app.world()), move || keeper.hurry());
        let mut copies = Recovery::new(farewell);
        if self.search {
            copies.search(store.as_ref(), self.file.as_deref(), self.ask);
        }
        app.insert_resource(copies)
            .add_systems(PreUpdate, interrupted)
            .add_observer(renderer_failed)
            .add_systems(LabFrame, (stayed, offer).chain().in_set(Loading::Recovery))
            .add_systems(Last, (keep, keep_texts));
        let store = Store::of_texts();
        let kept = store.as_ref().filter(|_| self.search).map(texts::left).unwrap_or_default();
        app.insert_resource(CodeCopies { keeper: TextKeeper::start(store), kept, offered: !self.ask });
    }
}

/// Final steps that outlive the window.
#[derive(Clone)]
pub(super) struct Farewell {
    pub(super) keeper: Keeper,
    interrupt: Interrupt,
    /// True once the user has decided to close the window.
    closing: Arc<AtomicBool>,
}

impl Farewell {
    /// Starts to keep copies, and to listen to signals.
    fn prepare(store: Option<Store>, world: &World) -> Self {
        let keeper = Keeper::start(store, waker(world));
        let last = keeper.clone();
        let last_act = move |signal: &str| {
            if let Some(sentence) = last.settle(PATIENCE).sentence() {
                complain(&format!("ended by {signal}; {sentence}"));
            }
        };
        let interrupt = Interrupt::listen(waker(world), last_act).unwrap_or_else(|error| {
            complain(&format!("signals will close the window without asking: {error}"));
            Interrupt::default()
        });
        Self { keeper, interrupt, closing: Arc::default() }
    }

    /// Records that the user has decided to close the window, regardless of unsaved changes.
    pub(super) fn close(&self) {
        self.closing.store(true, Ordering::SeqCst);
    }

    /// Finishes after the window has closed: keeps unsaved changes, unless the user discarded them, and ends the
    /// process after Ctrl+C.
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

/// The copies of this window, and those left by others.
#[derive(Resource)]
pub(super) struct Recovery {
    pub(super) farewell: Farewell,
    /// Copies still to be offered, the best first.
    offers: VecDeque<Abandoned>,
    /// The copy being offered.
    asked: Option<Abandoned>,
    registry: Option<Arc<Registry>>,
    /// While present, dropping this resource runs the farewell.
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
    /// Hands the farewell over to the caller, which runs the window.
    pub(super) fn hand_over(&mut self) -> Option<(Farewell, Guard)> {
        Some((self.farewell.clone(), self.guard.take()?))
    }

    /// Creates the state without any copies to offer.
    fn new(farewell: Farewell) -> Self {
        let guard = Guard::set(&farewell.keeper);
        Self { farewell, offers: VecDeque::new(), asked: None, registry: None, guard: Some(guard) }
    }

    /// Looks for copies of earlier windows, that of the opened file first. If `ask` is false because nobody can answer,
    /// they are only mentioned.
    fn search(&mut self, store: Option<&Store>, file: Option<&path::Path>, ask: bool) {
        let mut copies = store.map(Store::abandoned).unwrap_or_default();
        let file = file.and_then(|file| fs::absolute(file).ok());
        copies.sort_by_key(|copy| file.is_none() || copy.about.path != file);
        if ask {
            self.offers = copies.into();
            return;
        }
        for copy in copies {
            complain(&format!(
                "unsaved changes of “{}” are kept in {}; a window without --exit-after offers them",
                copy.about.title,
                copy.journal.file().shown()
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
        let Some(copy) = self.asked.take() else { return };
        match choice {
            RecoveryChoice::Recovered => {
                if let Some(path) = &copy.about.path {
                    files.expect(path, copy.about.stamp);
                }
                let registry = Arc::new(registry.clone());
                self.farewell.keeper.adopt(copy.journal, &session.document, about(session, files), &registry);
                let more = self.offers.len();
                self.offers.clear();
                if more > 0 {
                    let copies = if more == 1 { "One more copy is" } else { "More copies are" };
                    let text = format!("{copies} kept: the window offers them at its next start.");
                    session.say(Severity::Info, text);
                }
            }
            RecoveryChoice::Discarded => copy.journal.remove(),
            RecoveryChoice::Next => {}
            RecoveryChoice::Later => self.offers.clear(),
        }
    }
}

fn about(session: &Session, files: &DiskFiles) -> About {
    // The next window may start in another folder.
    let absolute = |path: &Path| fs::absolute(path).unwrap_or_else(|_| path.to_owned());
    About {
        title: session.own_title(),
        path: session.own_path().map(absolute),
        models: session.shaders.folders.models.as_deref().map(absolute),
        stamp: session.own_path().and_then(|path| files.known(path)),
        process: 0,
    }
}

/// Treats Ctrl+C in the terminal like Ctrl+Q in the window.
fn interrupted(recovery: Res<Recovery>, mut acting: Acting) {
    if recovery.farewell.interrupt.take() {
        acting.apply(Action::Quit);
    }
}

/// Resets the interrupt if the user decides to stay after Ctrl+C. Runs right after the effects are carried out, when no
/// closing is pending in between.
fn stayed(recovery: Res<Recovery>, session: Res<Session>) {
    if !recovery.farewell.closing.load(Ordering::SeqCst) && !session.questions.is_quitting() {
        recovery.farewell.interrupt.stay();
    }
}

/// Hurries with the copy of unsaved changes once there are no more pictures, and says so where the program goes on.
fn renderer_failed(failed: On<RendererFailed>, recovery: Res<Recovery>) {
    recovery.farewell.keeper.hurry();
    let why = if failed.device_lost { "The graphics card was lost" } else { "The renderer has failed" };
    platform::stopped(&format!("{why}: load the page again to go on."));
}

/// Offers the next copy as soon as no question is open.
fn offer(mut recovery: ResMut<Recovery>, mut session: ResMut<Session>, registry: Res<Registry>) {
    if recovery.offers.is_empty() || session.questions.open.is_some() {
        return;
    }
    let Some(copy) = recovery.offers.pop_front() else { return };
    let scene = copy.scene(&registry);
    if let Err(problems) = &scene {
        // The latest message is on top: the first problem.
        for problem in problems.iter().rev() {
            session.say(Severity::Warning, problem.clone());
        }
        complain(&problems.join("\n"));
    }
    let age = platform::now().duration_since(copy.when).unwrap_or(Duration::ZERO);
    session.questions.ask(Question::Recover(Box::new(Offer {
        title: copy.about.title.clone(),
        path: copy.about.path.clone(),
        file: copy.journal.file(),
        when: ago(age),
        scene: scene.map_err(|problems| problems.into_iter().next().unwrap_or_default()),
    })));
    recovery.asked = Some(copy);
}

/// Copies of unsaved texts of the editor: of this window, and of earlier ones.
#[derive(Resource)]
struct CodeCopies {
    keeper: TextKeeper,
    kept: Vec<KeptText>,
    offered: bool,
}

/// Hands unsaved texts of the editor to their keeper, and offers those left by earlier windows. A copy stays until the
/// text is open here, or its file has been saved.
fn keep_texts(mut copies: ResMut<CodeCopies>, mut session: ResMut<Session>) {
    let copies = &mut *copies;
    if !std::mem::replace(&mut copies.offered, true) && !copies.kept.is_empty() {
        let of = |kept: &KeptText| KeptCode {
            path: kept.path.clone(),
            text: kept.text.as_str().into(),
            when: kept.when.clone(),
        };
        session.offer_code(copies.kept.iter().map(of).collect());
    }
    if !session.is_changed() {
        return;
    }
    let unsaved = session.code.open.iter().filter(|open| open.is_unsaved());
    let place = |open: &OpenCode| open.path().unwrap_or(Path::new(OF_SCENE)).to_owned();
    let texts: Texts = unsaved.map(|open| (place(open), open.text.clone())).collect();
    let is_done = |kept: &mut KeptText| {
        let is_open = texts.get(&kept.path).is_some_and(|text| **text == *kept.text);
        is_open || session.code.outdated.contains(&kept.path)
    };
    copies.kept.extract_if(.., is_done).for_each(KeptText::remove);
    copies.keeper.keep(texts);
}

/// Hands unsaved changes to the keeper; runs after everything that changes the document in a frame.
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
