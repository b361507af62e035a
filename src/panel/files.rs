//! Carrying out the effects that need files: opening, saving, settings.

use std::path::{Path, PathBuf};

use super::{
    reload, settings,
    state::{Effect, MissingPart, Question, Session, Severity},
};
use crate::{
    files::tidy,
    registry::Registry,
    scene::{Scene, load::Stamp},
};

/// The boundary to reading and writing scene files: what the window needs, and nothing of how it is
/// done.
pub trait Files: Send + Sync + 'static {
    /// Reads a scene file.
    fn open(&mut self, path: &Path, registry: &Registry) -> Opened;
    /// Writes a scene file, all or nothing. Without `overwrite`, a file that changed on disk since it
    /// was opened or saved is left alone.
    fn save(&mut self, path: &Path, scene: &Scene, registry: &Registry, overwrite: bool) -> Saved;
    /// Reads a scene file if its content is another one than when it was opened or saved.
    fn look(&mut self, path: &Path, registry: &Registry) -> Looked;
    /// From now on this is what saving may replace: a content, or that there is no file.
    fn expect(&mut self, path: &Path, version: Option<Stamp>);
}

/// The result of looking at a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Looked {
    /// It is as it was last seen.
    Same,
    /// There is no such file.
    Gone,
    /// Its content is another one.
    Changed {
        /// Tells this content from others.
        version: Stamp,
        /// Its content.
        content: Opened,
    },
}

/// The result of opening a file.
#[derive(Clone, Debug, PartialEq)]
pub enum Opened {
    /// It holds a legal scene.
    Scene(Box<Scene>),
    /// It holds a scene that lacks parts; here it is with the defaults in place.
    Incomplete {
        /// With defaults.
        scene: Box<Scene>,
        /// The missing parts.
        parts: Vec<MissingPart>,
    },
    /// It is empty.
    Empty,
    /// It cannot be used: every problem, one sentence each.
    Failed(Vec<String>),
}

/// The result of saving a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Saved {
    /// It is on disk.
    Done,
    /// Somebody else changed it; it was left alone.
    ChangedOnDisk,
    /// It could not be written: why.
    Failed(String),
}

/// The file that is meant by what was typed as the name of a scene: it ends in `.json`, once.
#[must_use]
pub fn scene_file(typed: &Path) -> PathBuf {
    let json = |path: &Path| path.extension().is_some_and(|e| e.eq_ignore_ascii_case("json"));
    match (json(typed), typed.file_stem().map(Path::new)) {
        (false, _) => {
            let mut name = typed.as_os_str().to_owned();
            name.push(".json");
            name.into()
        }
        // Some dialogs add an extension to whatever is typed.
        (true, Some(stem)) if json(stem) => typed.with_file_name(stem),
        _ => typed.to_owned(),
    }
}

/// Carries out an effect that needs files. Returns the effects that follow, among them the one given
/// when it is none of this module's.
#[must_use]
pub fn run(session: &mut Session, registry: &Registry, effect: Effect, files: &mut dyn Files) -> Vec<Effect> {
    match effect {
        Effect::OpenFile(path) => match files.open(&path, registry) {
            Opened::Scene(scene) => session.opened(path, *scene),
            Opened::Incomplete { scene, parts } => {
                session.questions.ask(Question::MissingParts { path, scene, parts });
                Vec::new()
            }
            Opened::Empty => {
                session.questions.ask(Question::EmptyFile { path });
                Vec::new()
            }
            Opened::Failed(problems) => {
                // The latest stands on top: the first problem, and above it what it means.
                for problem in problems.into_iter().rev() {
                    session.say(Severity::Error, problem);
                }
                session.say(
                    Severity::Error,
                    format!("{} was not opened; {} is still shown.", path.display(), session.title()),
                );
                Vec::new()
            }
        },
        Effect::SaveFile { path, overwrite } => {
            match files.save(&path, &session.document, registry, overwrite) {
                Saved::Done => session.saved(path, registry),
                Saved::ChangedOnDisk => {
                    session.questions.ask(Question::ChangedOnDisk { path });
                    Vec::new()
                }
                Saved::Failed(why) => {
                    session.questions.not_saved();
                    session.say(Severity::Error, why);
                    Vec::new()
                }
            }
        }
        Effect::LookAtFile { discard } => reload::look(session, registry, discard, files),
        Effect::ExpectFile { path, version } => {
            files.expect(&path, Some(version));
            Vec::new()
        }
        Effect::SaveSettings => {
            save_settings(session);
            Vec::new()
        }
        other => vec![other],
    }
}

/// Reads the settings of the last session into the state; says so when they cannot be read.
pub fn load_settings(session: &mut Session) {
    if let Some(folder) = settings::folder() {
        // What is unfinished in there is settings, and those are read in a moment.
        let _ = tidy(&folder);
        let (settings, complaint) = settings::load(&folder);
        session.adopt(settings);
        if let Some(complaint) = complaint {
            session.say(Severity::Warning, complaint);
        }
    }
}

/// Writes the settings for the next session; says so when they cannot be written.
pub fn save_settings(session: &mut Session) {
    if let Some(folder) = settings::folder()
        && let Err(complaint) = settings::save(&folder, &session.settings())
    {
        session.say(Severity::Warning, complaint);
    }
}
