//! Saves sheets of the views to files in the background.

use std::path::{Path, PathBuf};

use bevy::ecs::prelude::*;

use super::background::Background;
use crate::files::Shown as _;
use crate::{
    export::write::inputs,
    failure::Failure,
    files,
    panel::state::{Session, Severity},
    progress::Progress,
    registry::Registry,
    scene::{Comparison, Scene, comparison::Compared},
    sweep::{Axis, Format, Look, Plan, Settings, Sweep},
};

/// The size of each picture, pixels.
const SIZE: [u32; 2] = [640, 360];

/// The sheet being written: its file, and the error if it failed.
#[derive(Debug, Default, Resource)]
pub(super) struct SheetFiles(Background<(), (PathBuf, Result<(), String>)>);

impl SheetFiles {
    /// Starts to write a sheet of the views and returns at once. Calls `wake` at the end.
    pub(super) fn begin(
        &self,
        path: PathBuf,
        session: &mut Session,
        registry: &Registry,
        wake: impl Fn() + Send + 'static,
    ) {
        if self.0.running().is_some() {
            return session.say(Severity::Info, "A sheet is still being written: wait for it.");
        }
        // The dialog asked only about the exact name that was typed.
        let asked = path.extension().is_some();
        let file = if asked { path } else { path.with_extension("png") };
        let mut scene = session.document.scene().clone();
        let inputs = inputs(session.path.as_deref(), [&scene], registry);
        if let Err(why) = may_write(&file, asked, &inputs) {
            return session.sheet_written(&file, Err(why));
        }
        // As seen from the current camera.
        scene.observer = session.facts.observer(scene.observer);
        let (source, registry) = (session.title(), registry.clone());
        let broken = (file.clone(), Err("an internal error".to_owned()));
        self.0.begin((), wake, broken, move |progress| {
            let outcome = write(&scene, &registry, &file, &source, progress);
            (file, outcome)
        });
    }

    /// Reports the result.
    pub(super) fn report(&self, session: &mut ResMut<Session>) {
        if let Some((path, outcome)) = self.0.take() {
            session.sheet_written(&path, outcome);
        }
    }
}

/// Fails if a file must not be replaced by a sheet.
fn may_write(file: &Path, asked: bool, inputs: &[PathBuf]) -> Result<(), String> {
    if !file.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
        return Err(format!("{} is not the name of a PNG file", file.shown()));
    }
    files::may_overwrite(file, files::PNG, inputs.iter().map(PathBuf::as_path))
        .map_err(|refused| refused.to_string())?;
    match !asked && file.exists() {
        true => Err(format!("{} exists; choose it in the list of files to replace it", file.shown())),
        false => Ok(()),
    }
}

/// Writes a sheet of all views, with their differences from view A.
fn write(
    scene: &Scene,
    registry: &Registry,
    file: &Path,
    source: &str,
    progress: &Progress,
) -> Result<(), String> {
    let views: Vec<usize> = (0..=scene.variants.len()).collect();
    let axis = Axis::views(&views, scene, registry)?;
    let sweep = Sweep::new(scene, 0, vec![axis], registry)?;
    let compared = Comparison { values: Compared::Codes, ..scene.comparison };
    let look = Look {
        format: Format::Sheet,
        size: Some(SIZE),
        columns: None,
        against: (views.len() > 1).then_some((0, compared)),
        words: true,
        rate: 1,
    };
    let plan = Plan::new(&sweep, look, Settings::default())?;
    let check = |seen: &Scene| {
        let models = seen.objects.iter().filter_map(|object| registry.model(seen.model_of(object)));
        match models.into_iter().find_map(|model| model.not_on_cpu()) {
            Some(why) => Err(Failure::NoRenderer(format!("the CPU cannot draw it: {why}"))),
            None => Ok(()),
        }
    };
    plan.write(file, source, &check, progress).map(drop).map_err(|failure| failure.to_string())
}
