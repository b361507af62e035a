//! Follows the file of the open lesson while its author edits it.

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use bevy::ecs::prelude::*;

use super::watching::{FileWatch, FilesChanged, GRACE};
use crate::{
    panel::state::{Effect, LessonSource, Session},
    platform::fs,
};

/// The watched file or folder of the open lesson.
#[derive(Default)]
pub(super) struct Watched {
    path: Option<PathBuf>,
    /// True if the file changed, and may still be in the process of being written.
    suspect: bool,
}

/// Watches the file of the open lesson, and requests a reload when it has changed.
pub(super) fn follow_lesson(
    mut changed: MessageReader<FilesChanged>,
    mut watch: ResMut<FileWatch>,
    session: Res<Session>,
    mut effects: MessageWriter<Effect>,
    mut watched: Local<Watched>,
) {
    let wanted = match session.lesson.as_ref().map(|open| &open.source) {
        Some(LessonSource::File(path)) => Some(path.as_path()),
        _ => None,
    };
    if watched.path.as_deref() != wanted {
        if let Some(path) = watched.path.take() {
            watch.0.forget(&path);
        }
        if let Some(path) = wanted {
            // A folder also contains the scenes of the lesson.
            if fs::is_dir(path) {
                watch.0.watch_folder(path)
            } else {
                watch.0.watch_file(path)
            }
            // The file may have changed after it was read and before it was watched.
            watch.0.report_later(path, Duration::ZERO);
        }
        *watched = Watched { path: wanted.map(Path::to_owned), suspect: false };
    }
    let concerned = |file: &Path| watched.path.as_ref().is_some_and(|path| file.starts_with(path));
    let news = changed.read().flat_map(|files| &files.0).find(|file| concerned(file)).cloned();
    let Some(file) = news else { return };
    if std::mem::replace(&mut watched.suspect, false) {
        effects.write(Effect::LookAtLesson);
    } else {
        // Many editors write in steps.
        watched.suspect = true;
        watch.0.report_later(&file, GRACE);
    }
}
