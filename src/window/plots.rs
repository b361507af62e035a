//! Saves plots to files in the background.

use std::path::PathBuf;

use bevy::ecs::prelude::*;

use super::background::Background;
use crate::{
    export::write::inputs,
    panel::{
        plots::{Request, file_of, write},
        state::{Session, Severity},
    },
    registry::Registry,
};

/// The plot being written: its file, and the notes or the error.
#[derive(Debug, Default, Resource)]
pub(super) struct PlotFiles(Background<(), (PathBuf, Result<Vec<String>, String>)>);

impl PlotFiles {
    /// Starts to write a plot and returns at once. Calls `wake` at the end.
    pub(super) fn begin(
        &self,
        path: PathBuf,
        session: &mut Session,
        registry: &Registry,
        wake: impl Fn() + Send + 'static,
    ) {
        if self.0.running().is_some() {
            return session.say(Severity::Info, "A plot is still being written: wait for it.");
        }
        let file = file_of(&path);
        let request = Request::of(session, registry);
        let inputs = inputs(session.path.as_deref(), [session.document.scene()], registry);
        let broken = (file.clone(), Err("an internal error".to_owned()));
        // The dialog asked only about the exact name that was typed.
        let asked = file == path;
        self.0.begin((), wake, broken, move |progress| {
            let outcome = write(&request, &file, asked, &inputs, progress);
            (file, outcome)
        });
    }

    /// Reports the result.
    pub(super) fn report(&self, session: &mut ResMut<Session>) {
        if let Some((path, outcome)) = self.0.take() {
            session.plot_written(path, outcome);
        }
    }
}
