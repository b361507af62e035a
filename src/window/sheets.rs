//! Saves sheets of the views, or of the copies of a row, to files in the background.

use std::path::{Path, PathBuf};

use bevy::ecs::prelude::*;

use super::background::Background;
use crate::files::Shown as _;
use crate::{
    export::write::inputs,
    failure::Failure,
    files::{self, PNG},
    panel::state::{Session, Severity, SheetOptions},
    progress::Progress,
    reference,
    registry::Registry,
    scene::{Comparison, Scene, comparison::Compared},
    sweep::{Axis, Format, Look, Parts, Plan, Settings, Sweep},
};

/// The sheet being written: its file, and the error if it failed.
#[derive(Debug, Default, Resource)]
pub(super) struct SheetFiles(pub(super) Background<(), (PathBuf, Result<(), String>)>);

impl SheetFiles {
    /// Starts to write a sheet of the row of an object, or of the views, and returns at once. Calls `wake` at each step.
    pub(super) fn begin(
        &self,
        (row, path): (Option<usize>, PathBuf),
        session: &mut Session,
        registry: &Registry,
        wake: impl Fn() + Send + 'static,
    ) {
        if self.0.running().is_some() {
            return session
                .say(Severity::Info, "A sheet is still being drawn: wait for it, or cancel it below.");
        }
        // The dialog asked only about the exact name that was typed.
        let asked = path.extension().is_some();
        let file = if asked { path } else { path.with_extension("png") };
        let mut scene = session.document.scene().clone();
        let inputs = inputs(session.path.as_deref(), [&scene], registry);
        let is_png = file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
        let allowed = match is_png {
            true => files::may_replace(&file, PNG, asked, &inputs).map_err(|refused| refused.to_string()),
            false => Err(format!("{} is not the name of a PNG file", file.shown())),
        };
        if allowed.is_err() {
            return session.sheet_written(&file, allowed);
        }
        // As seen from the current camera.
        scene.observer = session.facts.observer(scene.observer);
        let options = session.settings.sheet.clone();
        let (source, registry) = (session.title(), registry.clone());
        let broken = (file.clone(), Err("an internal error".to_owned()));
        self.0.begin((), wake, broken, move |progress| {
            let job = Job { scene: &scene, registry: &registry, options: &options, row };
            let outcome = job.write(&file, &source, progress);
            (file, outcome)
        });
    }

    /// Reports the progress and the result.
    pub(super) fn report(&self, session: &mut ResMut<Session>) {
        session.bypass_change_detection().facts.sheet = self.0.running();
        if let Some((path, outcome)) = self.0.take() {
            session.sheet_written(&path, outcome);
        }
    }
}

/// A sheet to write.
struct Job<'a> {
    scene: &'a Scene,
    registry: &'a Registry,
    options: &'a SheetOptions,
    /// An object of the row whose copies it shows; `None` for the views.
    row: Option<usize>,
}

impl Job<'_> {
    /// Draws the sheet and writes it. Finished pictures that took long are kept for another try.
    fn write(&self, file: &Path, source: &str, progress: &Progress) -> Result<(), String> {
        let Self { scene, registry, options, row } = *self;
        let axis = match row {
            Some(object) => Axis::copies(object, scene, registry)?,
            None => Axis::views(&(0..=scene.variants.len()).collect::<Vec<_>>(), scene, registry)?,
        };
        let compares = options.differences && row.is_none() && axis.count() > 1;
        let sweep = Sweep::new(scene, 0, vec![axis], registry)?;
        let compared = Comparison { values: Compared::Codes, ..scene.comparison };
        let look = Look {
            format: Format::Sheet,
            size: Some(options.size),
            columns: (options.columns > 0).then_some(options.columns as usize),
            against: compares.then_some((0, compared)),
            words: options.labels,
            rate: 1,
        };
        let settings = Settings { samples: options.samples(), ..Settings::default() };
        let plan = Plan::new(&sweep, look, settings)?;
        let check = |seen: &Scene| self.check(seen);
        plan.write(file, source, &check, progress).map(drop).map_err(|failure| {
            let parts = Parts::beside(file);
            match parts.folder().is_dir() {
                true => format!(
                    "{failure}; finished pictures are kept in {} for another try",
                    parts.folder().shown()
                ),
                false => failure.to_string(),
            }
        })
    }

    /// Fails if the CPU renderer cannot draw a scene.
    fn check(&self, seen: &Scene) -> Result<(), Failure> {
        match reference::not_on_cpu(seen, self.registry) {
            Some((_, why)) => Err(Failure::NoRenderer(format!("the CPU cannot draw it: {why}"))),
            None => Ok(()),
        }
    }
}
