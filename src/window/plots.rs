//! Plots that are written to files, beside the window.

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

/// The plot that is being written: its file, and the notes on it or why there is none.
#[derive(Debug, Default, Resource)]
pub(super) struct PlotFiles(Background<(), (PathBuf, Result<Vec<String>, String>)>);

impl PlotFiles {
    /// Begins to write and comes back at once. `wake` is called at the end.
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
        let place = file.clone();
        let broken = move || (place, Err("an error of this program".to_owned()));
        // The dialog asked about the file that was typed, and about no other.
        let asked = file == path;
        self.0.begin((), wake, broken, move |progress| {
            let outcome = write(&request, &file, asked, &inputs, progress);
            (file, outcome)
        });
    }

    /// Says how it ended.
    pub(super) fn report(&self, session: &mut ResMut<Session>) {
        if let Some((path, outcome)) = self.0.take() {
            session.plot_written(path, outcome);
        }
    }
}
