//! The law check of the window: runs `lcm models check` in a separate process, so that a slow or crashing driver does
//! not block the window.

use std::{
    io::Read as _,
    path::{Path, PathBuf},
    process::{Command, Stdio},
    thread,
    time::Duration,
};

use bevy::ecs::prelude::*;
use web_time::Instant;

use super::background::Background;
use crate::{files, library::assets::Folders, platform::fs, reflection::law_report::LawReport};

/// Maximum duration of a check: software Vulkan needs seconds for a model at the limits.
const LONGEST: Duration = Duration::from_secs(120);

/// The result of a check: the findings, or why there are none.
pub type Outcome = Result<LawReport, String>;

/// Checks laws, one model at a time.
#[derive(Debug, Default, Resource)]
pub struct LawChecks {
    program: Option<PathBuf>,
    work: Background<(), (String, Outcome)>,
}

impl LawChecks {
    /// Creates checks that run the given program, normally this one.
    #[must_use]
    pub fn by(program: Option<PathBuf>) -> Self {
        Self { program, ..Self::default() }
    }

    /// Starts a check and returns at once. Calls `wake` when there is a result.
    pub fn begin(&self, id: &str, folders: &Folders, wake: impl Fn() + Send + 'static) {
        let (program, id, folders) = (self.program.clone(), id.to_owned(), folders.clone());
        let broken = (id.clone(), Err("an internal error".to_owned()));
        self.work.begin((), wake, broken, move |_| {
            let outcome = match program {
                Some(program) => checked(&program, &id, &folders),
                None => Err("this program cannot be started again".to_owned()),
            };
            (id, outcome)
        });
    }

    /// The result since the last call, with the id of the model.
    #[must_use]
    pub fn take(&self) -> Option<(String, Outcome)> {
        self.work.take()
    }
}

/// Runs a check to completion.
fn checked(program: &Path, id: &str, folders: &Folders) -> Outcome {
    let mut command = Command::new(program);
    command.args(["models", "check", id, "--json", "--quiet"]);
    if let Some(assets) = folders.shaders.as_ref().and_then(|shaders| shaders.parent()) {
        command.arg("--assets").arg(assets);
    }
    // The folder of a new user does not exist yet.
    if let Some(models) = folders.models.as_ref().filter(|folder| fs::is_there(folder)) {
        command.arg("--models").arg(models);
    }
    let streams = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = streams.spawn().map_err(|e| format!("the check did not start: {}", files::words(&e)))?;
    let read = |stream: Option<Box<dyn std::io::Read + Send>>| {
        thread::spawn(move || {
            let mut text = String::new();
            // Anything but text is not a report.
            let _ = stream.map(|mut stream| stream.read_to_string(&mut text));
            text
        })
    };
    let out = read(child.stdout.take().map(|s| Box::new(s) as _));
    let err = read(child.stderr.take().map(|s| Box::new(s) as _));
    let started = Instant::now();
    let status = loop {
        match child.try_wait() {
            Ok(Some(status)) => break status,
            Ok(None) if started.elapsed() < LONGEST => thread::sleep(Duration::from_millis(20)),
            _ => {
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("the check took longer than {} s", LONGEST.as_secs()));
            }
        }
    };
    let out = out.join().unwrap_or_default();
    let err = err.join().unwrap_or_default();
    serde_json::from_str(&out).map_err(|_| match err.trim() {
        "" => format!("the check ended with {status}"),
        why => why.to_owned(),
    })
}
