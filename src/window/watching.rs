//! Wakes the sleeping window when files change on disk.

use std::{
    collections::{BTreeMap, BTreeSet},
    path::{Path, PathBuf},
    time::Duration,
};

use bevy::{
    prelude::*,
    winit::{EventLoopProxyWrapper, WinitUserEvent},
};

use super::order::Loading;
use crate::{
    files::{self, Shown as _},
    panel::state::{Effect, Session, Severity},
    parameter::NamedFile,
    platform,
    render::{entities::CurrentScene, schedule::LabFrame},
    watch::Watcher,
};

/// Time for which an unusable file may still be in the process of being written.
pub(super) const GRACE: Duration = Duration::from_millis(150);

/// The file watcher of the window, shared by everything. It wakes the window.
#[derive(Debug, Resource)]
pub struct FileWatch(pub Watcher);

/// Files that may have changed on disk, the oldest change first, with the paths under which they are watched.
#[derive(Clone, Debug, PartialEq, Eq, Message)]
pub struct FilesChanged(pub Vec<PathBuf>);

/// Watches files on disk: [`FileWatch`], and the file of the document.
#[derive(Clone, Copy, Debug, Default)]
pub struct WatchingPlugin;

impl Plugin for WatchingPlugin {
    fn build(&self, app: &mut App) {
        let wake = waker(app.world());
        app.add_message::<FilesChanged>().insert_resource(FileWatch(Watcher::new(wake))).add_systems(
            LabFrame,
            (
                collect.in_set(Loading::Watch),
                (
                    watch_files.run_if(resource_changed::<Session>),
                    follow_document,
                    follow_named_files,
                    follow_code,
                )
                    .chain()
                    .in_set(Loading::Follow),
            ),
        );
    }
}

/// A function that wakes the sleeping window, from any thread.
pub(super) fn waker(world: &World) -> impl Fn() + Send + Sync + 'static + use<> {
    wake(world.get_resource::<EventLoopProxyWrapper>())
}

/// Wakes the window with this event loop, if there is one.
pub(super) fn wake(proxy: Option<&EventLoopProxyWrapper>) -> impl Fn() + Send + Sync + 'static + use<> {
    let proxy = proxy.map(|proxy| (**proxy).clone());
    move || {
        if let Some(proxy) = &proxy {
            // An error means that the window is closed.
            let _ = proxy.send_event(WinitUserEvent::WakeUp);
        }
    }
}

/// Collects changes from the watcher.
fn collect(
    watch: Res<FileWatch>,
    mut changed: MessageWriter<FilesChanged>,
    mut session: ResMut<Session>,
    mut complaint: Local<Option<String>>,
) {
    let files = watch.0.changed();
    if !files.is_empty() {
        changed.write(FilesChanged(files));
    }
    let now = watch.0.complaint();
    if *complaint != now {
        if let Some(text) = &now {
            session.say(Severity::Warning, text.clone());
        }
        *complaint = now;
    }
}

/// Watches the file of the current document, and those that its lights and objects refer to.
fn watch_files(mut watch: ResMut<FileWatch>, session: Res<Session>, mut watched: Local<BTreeSet<PathBuf>>) {
    let named = session.document.files().filter_map(|file| file.path().map(Path::to_owned));
    let own = session.path.iter().filter(|path| watched.contains(*path) || !files::is_stream(path));
    let wanted: BTreeSet<_> = named.chain(own.cloned()).collect();
    watched.difference(&wanted).for_each(|path| watch.0.forget(path));
    for path in wanted.difference(&watched) {
        watch.0.watch_file(path);
        // The file may have changed after it was read and before it was watched.
        watch.0.report_later(path, Duration::ZERO);
    }
    *watched = wanted;
}

/// Reloads changed files that lights and objects refer to. If a file is unusable, its last good version stays in use;
/// that is reported after a moment, since many editors write in steps.
fn follow_named_files(
    mut changed: MessageReader<FilesChanged>,
    watch: Res<FileWatch>,
    mut session: ResMut<Session>,
    mut scene: ResMut<CurrentScene>,
    mut suspects: Local<BTreeSet<PathBuf>>,
) {
    let changed: BTreeSet<_> = changed.read().flat_map(|files| files.0.clone()).collect();
    if changed.is_empty() {
        return;
    }
    let known = |file: &NamedFile| Some((file.identity(), (file.path()?.to_owned(), file.clone())));
    let files: BTreeMap<_, _> = session.document.files().filter_map(known).collect();
    for (path, file) in files.into_values().filter(|(path, _)| changed.contains(path)) {
        let news = file.read_again();
        match file.problem() {
            Some(problem) if suspects.remove(&path) => {
                complain(&problem);
                let text = format!("{problem}; the last good version is shown.");
                session.say_about(&path, Severity::Error, text);
            }
            Some(_) if news => {
                watch.0.report_later(&path, GRACE);
                suspects.insert(path);
            }
            None if news => {
                suspects.remove(&path);
                session.healed(&path);
                scene.set_changed();
                session.say(Severity::Info, format!("{} was reloaded: it changed on disk.", path.shown()));
            }
            _ => {}
        }
    }
}

/// Requests a look at the files in the editor that have changed.
fn follow_code(
    mut changed: MessageReader<FilesChanged>,
    session: Res<Session>,
    mut effects: MessageWriter<Effect>,
) {
    let changed: BTreeSet<_> = changed.read().flat_map(|files| &files.0).collect();
    let open = session.code.open.iter().filter_map(|open| open.path());
    for path in open.filter(|path| changed.iter().any(|file| file.as_path() == *path)) {
        effects.write(Effect::LookAtCode(path.to_owned()));
    }
}

/// Requests a check of the document's file when it has changed.
fn follow_document(
    mut changed: MessageReader<FilesChanged>,
    session: Res<Session>,
    mut effects: MessageWriter<Effect>,
) {
    let concerned = |files: &FilesChanged| session.path.as_ref().is_some_and(|path| files.0.contains(path));
    if changed.read().filter(|files| concerned(files)).count() > 0 {
        effects.write(Effect::CheckFile { discard: false });
    }
}

/// Writes to standard error, with control characters removed.
pub(super) fn complain(text: &str) {
    complain_in_colour(&files::printable(text));
}

/// Writes to standard error a text whose only control characters are its own colours.
pub(super) fn complain_in_colour(text: &str) {
    platform::tell(text);
}
