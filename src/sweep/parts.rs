//! Finished pictures of a sweep that was interrupted: in the files of its folder, or in a folder beside its one file.

use std::{
    hash::{DefaultHasher, Hash as _, Hasher as _},
    io,
    path::{Path, PathBuf},
    time::Duration,
};

use web_time::Instant;

use crate::{
    failure::Failure,
    files::{self, Shown as _, words},
    picture::png::{self, About},
    platform::fs,
    reference::{Settings, Until},
    registry::Registry,
    scene::{Scene, save::to_json},
};

/// The keyword of the text in a picture that identifies its inputs.
pub(super) const KEYWORD: &str = "Sweep";
/// Pictures of shorter work are not kept: drawing them again takes less time than writing them.
const PATIENCE: Duration = Duration::from_secs(2);
/// The end of the name of the folder.
const END: &str = ".parts";

/// A stamp of the inputs of a picture: the scene, the content of its files, models and shaders from files, the settings and
/// the program; empty if these are not all, since a program with models of other crates may have the same version.
pub(super) fn stamp(scene: &Scene, settings: &Settings, until: Until, registry: &Registry) -> String {
    if registry.has_foreign() {
        return String::new();
    }
    let mut hasher = DefaultHasher::new();
    to_json(scene, None, registry).hash(&mut hasher);
    scene.files().for_each(|file| file.digest().hash(&mut hasher));
    let sources = registry.sources();
    sources.edited().for_each(|path| (path, sources.get(path)).hash(&mut hasher));
    let Settings { width, height, samples, terms } = *settings;
    (width, height, samples, terms.id(), until.samples, until.noise.map(f32::to_bits)).hash(&mut hasher);
    let version = env!("CARGO_PKG_VERSION");
    format!("{version} {:016x}", hasher.finish())
}

/// The failure to write a file.
pub(super) fn unwritten(file: &Path, error: &io::Error) -> Failure {
    Failure::Write(format!("{} could not be written: {}", file.shown(), words(error)))
}

/// True if a file is the picture with a stamp.
pub(super) fn is_done(file: &Path, stamp: &str, size: [u32; 2]) -> bool {
    found(file, stamp, size).is_some()
}

/// The picture in a file, if it has this stamp and is whole.
fn found(file: &Path, stamp: &str, size: [u32; 2]) -> Option<Vec<u8>> {
    if stamp.is_empty() || !fs::is_file(file) {
        return None;
    }
    png::read_with(file, KEYWORD, stamp, size)
}

/// The folder of the parts of a sheet or a film: finished pictures, numbered.
#[derive(Debug)]
pub struct Parts {
    folder: PathBuf,
    begun: Instant,
    patience: Duration,
}

impl Parts {
    /// The parts of a file, beside it: those of `sheet.png` are in `sheet.png.parts`.
    #[must_use]
    pub fn beside(output: &Path) -> Self {
        let mut folder = output.as_os_str().to_owned();
        folder.push(END);
        let folder = PathBuf::from(folder);
        // Whoever went on once may have to do so again.
        let patience = if fs::is_dir(&folder) { Duration::ZERO } else { PATIENCE };
        Self { folder, begun: Instant::now(), patience }
    }

    /// Keeps pictures from the first one on.
    #[must_use]
    pub fn at_once(self) -> Self {
        Self { patience: Duration::ZERO, ..self }
    }

    /// The folder.
    #[must_use]
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    fn file(&self, i: usize) -> PathBuf {
        self.folder.join(format!("{i}.png"))
    }

    /// A picture of an earlier run.
    pub(super) fn find(&self, i: usize, stamp: &str, size: [u32; 2]) -> Option<Vec<u8>> {
        found(&self.file(i), stamp, size)
    }

    /// Keeps a picture, if the work takes long enough.
    pub(super) fn keep(&self, i: usize, stamp: &str, [w, h]: [u32; 2], rgb8: &[u8]) -> Result<(), Failure> {
        if stamp.is_empty() || self.begun.elapsed() < self.patience {
            return Ok(());
        }
        let file = self.file(i);
        // What somebody else put there stays.
        if files::may_overwrite(&file, files::PNG, []).is_err() {
            return Ok(());
        }
        let about = About::default().with(KEYWORD, stamp);
        png::write(&file, w, h, rgb8, &about).map_err(|error| unwritten(&file, &error))
    }

    /// Removes the pictures, once nobody needs them.
    pub fn remove(&self) {
        files::clear(&self.folder, |path| {
            let is_number =
                path.file_stem().is_some_and(|stem| stem.to_string_lossy().parse::<usize>().is_ok());
            is_number
                && path.extension().is_some_and(|end| end == "png")
                && png::text(path, KEYWORD).is_some()
        });
    }
}
