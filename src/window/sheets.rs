//! Saves sheets and films to files in the background.

use std::path::{Path, PathBuf};

use bevy::ecs::prelude::*;

use super::background::Background;
use crate::files::Shown as _;
use crate::{
    export::write::inputs,
    failure::Failure,
    files,
    panel::state::{Session, Severity, SheetOf, SheetOptions},
    platform::fs,
    progress::Progress,
    reference,
    registry::Registry,
    scene::{Comparison, Scene, comparison::Compared},
    sweep::{Axis, Format, Look, Parts, Plan, Settings, Sweep},
};

/// The sheet being written: its file, and the error if it failed.
#[derive(Debug, Default, Resource)]
pub(super) struct SheetFiles(pub(super) Background<(), (PathBuf, Result<Option<&'static str>, String>)>);

impl SheetFiles {
    /// Starts to write a sheet, or a film, and returns at once. Calls `wake` at each step.
    pub(super) fn begin(
        &self,
        (subject, path): (SheetOf, PathBuf),
        session: &mut Session,
        registry: &Registry,
        wake: impl Fn() + Send + 'static,
    ) {
        if self.0.running().is_some() {
            return session
                .say(Severity::Info, "A sheet is still being drawn: wait for it, or cancel it below.");
        }
        let file = files::meant(&path, "png", |file| Format::of(file).is_some());
        // The dialog asked only about the exact name that was typed.
        let asked = file == path;
        let mut held = session.document.named(registry);
        let inputs = inputs(session.path.as_deref(), [&held], registry);
        let Some(format) = Format::of(&file) else {
            let why = format!("{} is the name of no sheet (.png) and no film (.gif, .apng)", file.shown());
            return session.sheet_written(&file, Err(why));
        };
        if let Err(refused) = files::may_replace(&file, format.signature(), asked, &inputs) {
            return session.sheet_written(&file, Err(refused.to_string()));
        }
        if subject != SheetOf::Views && session.observer_problem().is_some() {
            let why = "the camera is outside the room, or in the place of a light or an object; move it";
            return session.sheet_written(&file, Err(why.to_owned()));
        }
        let elsewhere;
        (held.observer, elsewhere) = session.observer_in_file();
        // As seen from the current camera.
        let scene = Scene { observer: session.facts.observer(held.observer), ..held.clone() };
        let options = session.settings.sheet.clone();
        let view = session.active();
        let (source, registry) = (session.title(), registry.clone());
        let broken = (file.clone(), Err("an internal error".to_owned()));
        self.0.begin((), wake, broken, move |progress| {
            let (scene, held, registry, options) = (&scene, &held, &registry, &options);
            let job = Job { scene, held, registry, options, subject, view, format };
            let outcome = job.write(&file, &source, progress);
            (file, outcome.map(|()| elsewhere))
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

/// A sheet or a film to write.
struct Job<'a> {
    scene: &'a Scene,
    /// The scene in the file.
    held: &'a Scene,
    registry: &'a Registry,
    options: &'a SheetOptions,
    subject: SheetOf,
    /// The view that is shown, unless each has a picture.
    view: usize,
    format: Format,
}

impl Job<'_> {
    /// Draws the sheet and writes it. Finished pictures that took long are kept for another try.
    fn write(&self, file: &Path, source: &str, progress: &Progress) -> Result<(), String> {
        let Self { scene, held, registry, options, subject, view, format } = *self;
        let axis = match subject {
            SheetOf::Row(object) => Axis::copies(object, scene, registry)?,
            SheetOf::Views => Axis::views(&(0..=scene.variants.len()).collect::<Vec<_>>(), scene, registry)?,
            SheetOf::Turn(what) => {
                Axis::turn(&format!("{}=360:{}", what.id(), options.turn), scene, registry)?
            }
        };
        let compares =
            options.differences && subject == SheetOf::Views && axis.count() > 1 && !format.is_film();
        let column = (options.against as usize).min(axis.count().saturating_sub(1));
        let sweep = Sweep::new(scene, view, vec![axis], registry).map_err(|why| match subject {
            SheetOf::Turn(what) => format!(
                "on its way something would leave the room; move it nearer to the middle, or choose another turn than \
                 that of {}",
                what.name().to_lowercase()
            ),
            _ => why,
        })?;
        let compared = Comparison { values: Compared::Codes, ..scene.comparison };
        let look = Look {
            format,
            size: Some(options.size),
            columns: self.columns(),
            against: compares.then_some((column, compared)),
            words: options.labels,
            rate: options.rate,
        };
        let settings = Settings { samples: options.samples(), ..Settings::default() };
        let plan = Plan::new(&sweep, look, settings)?.holding(held);
        let check = |seen: &Scene| self.check(seen);
        plan.write(file, source, &check, progress).map(drop).map_err(|failure| {
            let parts = Parts::beside(file);
            match fs::is_dir(parts.folder()) {
                true => format!(
                    "{failure}; finished pictures are kept in {} for another try",
                    parts.folder().shown()
                ),
                false => failure.to_string(),
            }
        })
    }

    /// The number of columns of a sheet: as chosen, or those of a grid.
    fn columns(&self) -> Option<usize> {
        let of_grid = || match self.subject {
            SheetOf::Row(object) => {
                let repeat = self.scene.row(object)?.repeat;
                (repeat.rows > 1).then_some(repeat.columns as usize)
            }
            _ => None,
        };
        let chosen = (self.options.columns > 0).then_some(self.options.columns as usize);
        chosen.or_else(of_grid).filter(|_| !self.format.is_film())
    }

    /// Fails if the CPU renderer cannot draw a scene.
    fn check(&self, seen: &Scene) -> Result<(), Failure> {
        match reference::not_on_cpu(seen, self.registry) {
            Some((_, why)) => Err(Failure::NoRenderer(format!("the CPU cannot draw it: {why}"))),
            None => Ok(()),
        }
    }
}
