//! Exports of the window: one at a time, in the background.

use std::path::{Path, PathBuf};

use bevy::ecs::prelude::*;

use super::background::Background;
use crate::files::Shown as _;
use crate::{
    export::{
        ExportError, Form, Progress, Request, form, view,
        write::{WriteError, inputs, may_write, write},
    },
    files::{self, Before},
    panel::{
        export::{SIZE, object},
        state::{Exporting, Session, Severity},
    },
    registry::Registry,
    scene::Scene,
};

/// The notes on an export, or why it failed.
type Outcome = Result<Vec<String>, Vec<String>>;

/// The running export, labelled with the name of its format.
#[derive(Debug, Default, Resource)]
pub(super) struct Exports(Background<&'static str, Ended>);

/// The id of the format, the destination, and the outcome.
type Ended = (&'static str, PathBuf, Outcome);

/// An export with all its inputs.
struct Job {
    form: &'static Form,
    scene: Scene,
    registry: Registry,
    stem: String,
    object: usize,
    /// The pinned pixel, and a remark about it.
    point: Option<[u32; 2]>,
    remark: Option<&'static str>,
    /// The active view.
    view: usize,
    path: PathBuf,
    /// State of the destination when the user chose it.
    before: Before,
}

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
        let path = with_extension(form, path);
        let inputs = inputs(session.path.as_deref(), [session.document.scene()], registry);
        let before = match may_write(form, &path, overwrite, &inputs) {
            Ok(before) => before,
            Err(WriteError::Exists(_)) => return session.export_exists(form.id, path),
            Err(error) => return session.say(Severity::Error, format!("{error}.")),
        };
        let (point, remark) = if form.explains() { pinned(session) } else { (None, None) };
        let job = Job {
            form,
            scene: (*session.document).clone(),
            registry: registry.clone(),
            stem: session.stem(),
            object: object(session).unwrap_or_default(),
            point,
            remark,
            view: session.active(),
            path,
            before,
        };
        let broken = vec!["The export failed: an internal error.".to_owned()];
        let place = job.path.clone();
        self.0.begin(
            form.name,
            wake,
            move || (form.id, place, Err(broken)),
            move |progress| {
                let outcome = run(&job, progress);
                (form.id, job.path, outcome)
            },
        );
    }

    /// Stops the export at its next step.
    pub(super) fn cancel(&self) {
        self.0.cancel();
    }

    /// Reports the progress to the panels. Returns the folder of an export that has just succeeded.
    pub(super) fn report(&self, session: &mut ResMut<Session>) -> Option<PathBuf> {
        let running =
            self.0.running().map(|now| Exporting { name: now.label, done: now.done, step: now.step });
        if session.facts.export != running {
            session.bypass_change_detection().facts.export = running;
        }
        let (form, path, outcome) = self.0.take()?;
        let folder = if path.is_dir() { path.clone() } else { files::folder_of(&path).to_owned() };
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

/// Appends the extension of the format, if the user typed none.
fn with_extension(form: &Form, path: PathBuf) -> PathBuf {
    match form.makes {
        crate::export::Makes::File(extension) if !extension.is_empty() && path.extension().is_none() => {
            path.with_extension(extension)
        }
        _ => path,
    }
}

fn run(job: &Job, progress: &Progress) -> Outcome {
    let Job { form, scene, registry, stem, object, point, remark, view, path, before } = job;
    let view = form.of_view.then_some(*view);
    let (scene, of_view) = view::exported(form, scene, view, stem, registry);
    let request = Request { scene: &scene, registry, stem, size: SIZE, object: *object, point: *point };
    let made = (form.make)(&request, progress).and_then(|export| {
        progress.step(1.0, "writing it")?;
        Ok(export)
    });
    let export = made.map_err(|error| match error {
        ExportError::Refused(reasons) => reasons.into_iter().map(|reason| format!("{reason}.")).collect(),
        ExportError::Cancelled => vec!["The export was cancelled.".to_owned()],
    })?;
    write(&export, path, before).map_err(|error| vec![format!("{error}.")])?;
    Ok(of_view.into_iter().chain(export.notes).chain(remark.map(str::to_owned)).collect())
}

/// Shows a folder in the file manager.
pub(super) fn reveal(folder: &Path, session: &mut Session) {
    if let Err(error) = ::open::that_detached(folder) {
        session.say(
            Severity::Warning,
            format!("The folder {} could not be shown: {}.", folder.shown(), files::words(&error)),
        );
    }
}
