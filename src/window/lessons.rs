//! The file of the lesson that is open is followed while its author edits it.

use std::{path::PathBuf, time::Duration};

use bevy::ecs::prelude::*;

use super::watching::{FileWatch, FilesChanged, GRACE};
use crate::panel::state::{Effect, LabEffect, LessonSource, Session};

/// The files of the lesson that is open.
#[derive(Default)]
pub(super) struct Watched {
    files: Vec<PathBuf>,
    /// One of them changed, and may be in the middle of being written.
    suspect: bool,
}

/// Watches the files of the lesson that is open, and reads it again when one of them changed.
pub(super) fn follow_lesson(
    mut changed: MessageReader<FilesChanged>,
    mut watch: ResMut<FileWatch>,
    session: Res<Session>,
    mut effects: MessageWriter<LabEffect>,
    mut watched: Local<Watched>,
) {
    if session.is_changed() {
        let wanted = match &session.lesson {
            Some(open) if matches!(open.source, LessonSource::File(_)) => open.lesson.files.clone(),
            _ => Vec::new(),
        };
        if watched.files != wanted {
            watched.files.iter().filter(|file| !wanted.contains(file)).for_each(|file| watch.0.forget(file));
            for file in wanted.iter().filter(|file| !watched.files.contains(file)) {
                watch.0.watch_file(file);
                // It may have changed between being read and being watched.
                watch.0.report_later(file, Duration::ZERO);
            }
            *watched = Watched { files: wanted, suspect: false };
        }
    }
    let news = changed.read().flat_map(|files| &files.0).find(|file| watched.files.contains(file)).cloned();
    let Some(file) = news else { return };
    if std::mem::replace(&mut watched.suspect, false) {
        effects.write(LabEffect(Effect::LookAtLesson));
    } else {
        // Many editors write in steps.
        watched.suspect = true;
        watch.0.report_later(&file, GRACE);
    }
}
