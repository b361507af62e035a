//! Exports of the window: one at a time, in the background.

use std::path::{Path, PathBuf};

use bevy::ecs::prelude::*;

use super::background::Background;
use crate::{
    export::{
        ExportError, Form, Progress, Request, form, view,
        write::{WriteError, inputs, may_write, write},
    },
    files::{self, Before, Shown as _},
    panel::{
        export::{SIZE, object},
        state::{Question, Session, Severity},
    },
    platform::{self, fs},
    registry::Registry,
};

/// The notes on an export, or why it failed.
type Outcome = Result<Vec<String>, Vec<String>>;

/// The running export, labelled with the name of its format.
#[derive(Debug, Default, Resource)]
pub(super) struct Exports(pub(super) Background<&'static str, Ended>);

/// The id of the format, the destination, and the outcome.
type Ended = (&'static str, PathBuf, Outcome);

impl Exports {
    /// Starts an export and returns at once; if the destination exists, asks the user instead. Calls `wake` at each
    /// step.
    pub(super) fn begin(
        &self,
        id: &str,
        path: PathBuf,
        overwrite: bool,
        session: &mut Session,
        registry: &Registry,
        wake: impl Fn() + Send + 'static,
    ) {
        let Some(form) = form(id) else { return };
        if self.0.running().is_some() {
            return;
        }
        let path = file_of(form, path);
        let inputs = inputs(session.path.as_deref(), [session.document.scene()], registry);
        let before = match may_write(form, &path, overwrite, &inputs) {
            Ok(before) => before,
            Err(WriteError::Exists(_)) => {
                return session.questions.ask(Question::ReplaceExport { form: form.id, path });
            }
            Err(error) => return session.say(Severity::Error, format!("{error}.")),
        };
        let (point, remark) = if form.explains() { pinned(session) } else { (None, None) };
        let (scene, registry, stem) = ((*session.document).clone(), registry.clone(), session.stem());
        let (object, view) = (object(session).unwrap_or_default(), form.of_view.then_some(session.active()));
        let failed = Err(vec!["The export failed: an internal error.".to_owned()]);
        let broken = (form.id, path.clone(), failed);
        self.0.begin(form.name, wake, broken, move |progress| {
            let (scene, of_view) = view::exported(form, &scene, view, &stem, &registry);
            let (scene, registry, stem) = (&scene, &registry, &*stem);
            let request = Request { scene, registry, stem, size: SIZE, object, point };
            let notes = written(form, &request, &path, &before, progress);
            let remarks = remark.map(str::to_owned);
            let outcome = notes.map(|notes| of_view.into_iter().chain(notes).chain(remarks).collect());
            (form.id, path, outcome)
        });
    }

    /// Reports the progress to the panels. Returns the folder of an export that has just succeeded.
    pub(super) fn report(&self, session: &mut ResMut<Session>) -> Option<PathBuf> {
        session.bypass_change_detection().facts.export = self.0.running();
        let (form, path, outcome) = self.0.take()?;
        let folder = if fs::is_dir(&path) { path.clone() } else { files::folder_of(&path).to_owned() };
        let done = outcome.is_ok().then_some(folder);
        session.exported(form, path, outcome);
        done
    }
}

/// The pinned pixel in the picture of an export, and a remark about it.
fn pinned(session: &Session) -> (Option<[u32; 2]>, Option<&'static str>) {
    let Some(pin) = session.view.pinned else { return (None, None) };
    let point = pin.inside(SIZE.into(), session.document.view_angle());
    let remark = match point {
        None => Some(
            "The pinned pixel is beyond the edge of the page's picture, so the page does not explain it.",
        ),
        Some(_) if session.facts.camera_is_free => Some(
            "The page explains the pinned pixel as the observer of the scene sees it; the camera of the window is \
             elsewhere.",
        ),
        Some(_) => None,
    };
    (point, remark)
}

/// The file with the extension of the format, once.
fn file_of(form: &Form, typed: PathBuf) -> PathBuf {
    match form.makes {
        crate::export::Makes::File(extension) if !extension.is_empty() => {
            let is_known =
                |path: &Path| path.extension().is_some_and(|own| own.eq_ignore_ascii_case(extension));
            files::meant(&typed, extension, is_known)
        }
        _ => typed,
    }
}

/// Makes an export and writes it. Returns its notes.
fn written(form: &Form, request: &Request, path: &Path, before: &Before, progress: &Progress) -> Outcome {
    let made = (form.make)(request, progress).and_then(|export| {
        progress.step(1.0, "writing it")?;
        Ok(export)
    });
    let export = made.map_err(|error| match error {
        ExportError::Refused(reasons) => reasons.into_iter().map(|reason| format!("{reason}.")).collect(),
        ExportError::Cancelled => vec!["The export was cancelled.".to_owned()],
    })?;
    write(&export, path, before).map_err(|error| vec![format!("{error}.")])?;
    Ok(export.notes)
}

/// Shows a folder in the file manager. The error is a sentence.
pub(super) fn reveal(folder: &Path) -> Result<(), String> {
    platform::open(folder)
        .map_err(|why| format!("The folder {} could not be shown: {}.", folder.shown(), files::words(&why)))
}
