//! The file of the lesson that is open is followed while its author edits it.

use std::{
    path::{Path, PathBuf},
    time::Duration,
};

use bevy::ecs::prelude::*;

use super::watching::{FileWatch, FilesChanged, GRACE};
use crate::panel::state::{Effect, LabEffect, LessonSource, Session};

/// The file, or the folder, of the lesson that is open.
#[derive(Default)]
pub(super) struct Watched {
    path: Option<PathBuf>,
    /// It changed, and may be in the middle of being written.
    suspect: bool,
}

/// Watches the file of the lesson that is open, and reads it again when it changed.
pub(super) fn follow_lesson(
    mut changed: MessageReader<FilesChanged>,
    mut watch: ResMut<FileWatch>,
    session: Res<Session>,
    mut effects: MessageWriter<LabEffect>,
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
            // A folder has the scenes of the lesson too.
            if path.is_dir() {
                watch.0.watch_folder(path)
            } else {
                watch.0.watch_file(path)
            }
            // It may have changed between being read and being watched.
            watch.0.report_later(path, Duration::ZERO);
        }
        *watched = Watched { path: wanted.map(Path::to_owned), suspect: false };
    }
    let concerned = |file: &Path| watched.path.as_ref().is_some_and(|path| file.starts_with(path));
    let news = changed.read().flat_map(|files| &files.0).find(|file| concerned(file)).cloned();
    let Some(file) = news else { return };
    if std::mem::replace(&mut watched.suspect, false) {
        effects.write(LabEffect(Effect::LookAtLesson));
    } else {
        // Many editors write in steps.
        watched.suspect = true;
        watch.0.report_later(&file, GRACE);
    }
}
