//! The folders of shaders and custom models: locating and reading them, and exporting copies for editing.

use std::{
    collections::BTreeSet,
    env, io,
    path::{Path, PathBuf},
};

use thiserror::Error;

use crate::files::{Shown as _, words};
pub use crate::registry::Folders;
use crate::{
    custom::{self, file},
    files::{self, FileError},
    platform::fs,
    registry::{Registry, compose::SHARED},
    shader::{Source, check::ShaderProblem, compose},
};

/// Environment variable with an alternative folder for the user's data.
pub const DATA_VARIABLE: &str = "LCM_DATA_DIR";

/// The shipped example models: name and text of each.
pub const EXAMPLES: &[(&str, &str)] = &[
    ("charlie_sheen.wgsl", include_str!("../../assets/models/charlie_sheen.wgsl")),
    ("gooch.wgsl", include_str!("../../assets/models/gooch.wgsl")),
];

/// A problem with a folder.
#[derive(Debug, Error)]
pub enum AssetError {
    /// The folder contains no shaders.
    #[error("--assets is {}, but {rule}", .folder.shown())]
    NoShaders {
        /// The folder.
        folder: PathBuf,
        /// The rule for the folder, and perhaps the intended one.
        rule: String,
    },
    /// The path is a file.
    #[error("--models is {}, but it must be a folder", .0.shown())]
    NotAFolder(PathBuf),
    /// The folder, or something in it, could not be written.
    #[error("{} could not be written: {}", .path.shown(), words(.error))]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// Error of the operating system.
        error: io::Error,
    },
}

/// The environment of the process, in which folders are looked for if none is given.
#[derive(Clone, Debug, Default)]
struct Surroundings {
    /// The folders that may contain `assets`, in the order in which they are tried.
    roots: Vec<PathBuf>,
    /// The folder of the user's data.
    data: Option<PathBuf>,
}

/// The folder named by an environment variable.
fn folder(variable: &str) -> Option<PathBuf> {
    env::var_os(variable).filter(|value| !value.is_empty()).map(PathBuf::from)
}

/// The folder of the user's data: from [`DATA_VARIABLE`], or else the operating system's default; `None`
/// without either.
#[must_use]
pub fn data_folder() -> Option<PathBuf> {
    let usual = || crate::platform::data_folder(crate::program::LAB);
    folder(DATA_VARIABLE).or_else(usual)
}

impl Surroundings {
    fn of_process() -> Self {
        let beside = || Some(env::current_exe().ok()?.parent()?.to_owned());
        let roots = [folder("BEVY_ASSET_ROOT"), folder("CARGO_MANIFEST_DIR"), beside()];
        Self { roots: roots.into_iter().flatten().collect(), data: data_folder() }
    }
}

impl Folders {
    /// Finds the folders.
    ///
    /// Shaders come from `assets/shaders` if `assets` is given; otherwise from the first of that folder below
    /// `$BEVY_ASSET_ROOT`, below `$CARGO_MANIFEST_DIR` (set by `cargo run`) or next to the program that
    /// exists; otherwise the built-in shaders are used. Custom models come from `models` if given; otherwise
    /// from the folder `models` next to the shaders, or else in the user's data (`$LCM_DATA_DIR`, or the
    /// default of the operating system).
    ///
    /// # Errors
    /// Returns an error if the given folder contains no shaders, or if the model folder is a file.
    pub fn find(assets: Option<&Path>, models: Option<&Path>) -> Result<Self, AssetError> {
        Self::find_in(assets, models, &Surroundings::of_process())
    }

    fn find_in(
        assets: Option<&Path>,
        models: Option<&Path>,
        surroundings: &Surroundings,
    ) -> Result<Self, AssetError> {
        let shaders = match assets {
            Some(folder) => Some(shaders_of(folder)?),
            None => surroundings.roots.iter().map(|r| r.join("assets/shaders")).find(|s| fs::is_dir(s)),
        };
        if let Some(file) = models.filter(|m| fs::is_there(m) && !fs::is_dir(m)) {
            return Err(AssetError::NotAFolder(file.to_owned()));
        }
        let beside = || shaders.as_ref().map(|s| s.with_file_name("models"));
        let data = || surroundings.data.as_ref().map(|d| d.join("models"));
        let models = models.map(Path::to_owned).or_else(beside).or_else(data);
        Ok(Self { shaders, models, extensions: Vec::new() })
    }
}

/// The shaders of a given folder.
fn shaders_of(folder: &Path) -> Result<PathBuf, AssetError> {
    let shaders = folder.join("shaders");
    if fs::is_dir(&shaders) {
        return Ok(shaders);
    }
    let inside = folder.join("assets");
    let hint = if fs::is_dir(inside.join("shaders")) {
        format!("; did you mean {}?", inside.shown())
    } else if folder.file_name().is_some_and(|n| n == "shaders") && fs::is_dir(folder) {
        let above = folder.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        format!("; did you mean {}?", above.shown())
    } else if !fs::is_there(folder) {
        "; there is no such folder: `lcm assets export FOLDER` makes one".to_owned()
    } else {
        "; `lcm assets export FOLDER` makes one".to_owned()
    };
    Err(AssetError::NoShaders {
        folder: folder.to_owned(),
        rule: format!("it must be a folder with a folder shaders in it{hint}"),
    })
}

/// All shader files with their built-in text, except custom models: shared files, models, light types and
/// shading models.
#[must_use]
pub fn built_in_sources(registry: &Registry) -> Vec<Source> {
    let models =
        registry.models().iter().map(|m| m.declaration).filter(|d| registry.custom_file(d.id).is_none());
    compose::OPTICS
        .iter()
        .chain(compose::TRANSMISSION)
        .copied()
        .chain(SHARED)
        .chain(models.map(|d| d.wgsl))
        .chain(registry.lights().iter().map(|l| l.declaration.wgsl))
        .chain(registry.shading_models().iter().map(|m| m.declaration.wgsl))
        .collect()
}

/// Reads the shaders in a folder into a registry, where they differ from the built-in ones; they are checked
/// when used. Files without a built-in counterpart are available to `#import`.
///
/// # Errors
/// Returns the files that could not be read.
pub fn read_shaders(folder: &Path, registry: &mut Registry) -> Result<(), Vec<(PathBuf, ShaderProblem)>> {
    registry.set_shader_folder(folder);
    read_texts(folder, registry, |_| true)
}

/// Reads the shaders in the folders of other crates, as [`read_shaders`] does. There, files with the names of
/// built-in ones belong to those crates.
///
/// # Errors
/// Returns the files that could not be read.
pub fn read_extensions(registry: &mut Registry) -> Result<(), Vec<(PathBuf, ShaderProblem)>> {
    let ours = shipped(registry);
    let folders = registry.folders().extensions.clone();
    let read = |folder: &PathBuf| read_texts(folder, registry, |name| !ours.contains(name)).err();
    let problems: Vec<_> = folders.iter().filter_map(read).flatten().collect();
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

/// The source paths of the shaders shipped with this crate.
pub(super) fn shipped(registry: &Registry) -> BTreeSet<&'static str> {
    built_in_sources(registry).iter().map(|s| s.path).filter(|path| !registry.is_foreign(path)).collect()
}

fn read_texts(
    folder: &Path,
    registry: &mut Registry,
    takes: impl Fn(&str) -> bool,
) -> Result<(), Vec<(PathBuf, ShaderProblem)>> {
    let built_in = built_in_sources(registry);
    let mut problems = Vec::new();
    let mut files = Vec::new();
    collect(folder, &mut files);
    for path in files {
        let Ok(name) = path.strip_prefix(folder) else { continue };
        let name = name.components().map(|c| c.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/");
        if !takes(&name) {
            continue;
        }
        match file::read(&path, &name) {
            Ok(text) => {
                // A checkout may have other line ends than the built program.
                let same = |s: &Source| s.path == name && s.text.lines().eq(text.lines());
                if built_in.iter().any(same) {
                    registry.sources_mut().forget(&name);
                } else {
                    registry.sources_mut().edit(name, text);
                }
            }
            Err(problem) => problems.push((path, problem)),
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(problems) }
}

/// Collects the WGSL files below a folder, in order.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    let mut entries: Vec<_> = entries.flatten().map(|e| e.path()).collect();
    entries.sort();
    for path in entries {
        let hidden = path.file_name().is_some_and(|n| n.to_string_lossy().starts_with('.'));
        if hidden || fs::is_symlink(&path) && fs::is_dir(&path) {
            continue;
        }
        if fs::is_dir(&path) {
            collect(&path, files);
        } else if path.extension().is_some_and(|e| e == custom::EXTENSION) {
            files.push(path);
        }
    }
}

/// The result of an export.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Exported {
    /// Files written.
    pub written: Vec<PathBuf>,
    /// Existing files that differ, and were left unchanged.
    pub kept: Vec<PathBuf>,
    /// Number of existing, identical files.
    pub same: usize,
}

/// Writes the built-in shaders below `shaders` in a folder, and the example models below `models`, for
/// editing with `--assets FOLDER`. Existing files that differ are left unchanged. If one cannot be written, as on a full
/// disk, those before it are removed again.
///
/// # Errors
/// Returns an error if a folder or a file could not be written.
pub fn export(folder: &Path, registry: &Registry) -> Result<Exported, AssetError> {
    let shaders = folder.join("shaders");
    let sources = built_in_sources(registry).into_iter().map(|s| (shaders.join(s.path), s.text));
    let models = EXAMPLES.iter().map(|(name, text)| (folder.join("models").join(name), *text));
    let all: Vec<_> = sources.chain(models).collect();
    let is_new = |place: &&Path| *place != folder && !fs::is_there(place);
    let new: BTreeSet<PathBuf> = all
        .iter()
        .flat_map(|(path, _)| path.ancestors().skip(1).take_while(is_new).map(Path::to_owned))
        .collect();
    let (mut exported, mut at) = (Exported::default(), folder.to_owned());
    let written = files::in_folder(folder, || {
        export_each(&all, &mut exported, &mut at).inspect_err(|_| files::take_back(&exported.written, &new))
    });
    match written {
        Ok(()) => Ok(exported),
        Err(error) => Err(AssetError::Write { path: at, error }),
    }
}

/// Writes each of these files, unless it exists; `at` is the one at which it fails.
fn export_each(all: &[(PathBuf, &str)], exported: &mut Exported, at: &mut PathBuf) -> io::Result<()> {
    for (path, text) in all {
        path.clone_into(at);
        let mut there = files::read(path, file::MAX_BYTES);
        if matches!(&there, Err(FileError::Io(e)) if e.kind() == io::ErrorKind::NotFound) {
            match write_new(path, text) {
                Ok(()) => {
                    exported.written.push(path.clone());
                    continue;
                }
                // Somebody else wrote it meanwhile, such as another export.
                Err(e) if e.kind() == io::ErrorKind::AlreadyExists => {
                    there = files::read(path, file::MAX_BYTES);
                }
                Err(error) => return Err(error),
            }
        }
        match there {
            Ok(there) if there == text.as_bytes() => exported.same += 1,
            Ok(_) | Err(FileError::TooLarge(_)) => exported.kept.push(path.clone()),
            Err(error) => return Err(error.into()),
        }
    }
    Ok(())
}

/// Writes a new file, all or nothing, creating its folder if necessary. On failure, the new folder is
/// removed.
///
/// # Errors
/// Returns [`io::ErrorKind::AlreadyExists`] if the file exists; it is left unchanged.
pub fn write_new(path: &Path, text: &str) -> io::Result<()> {
    let folder = files::folder_of(path);
    let mut made = false;
    let written = files::in_folder(folder, || {
        made = true;
        files::create(path, text.as_bytes())
    });
    written.map_err(|error| match made {
        true => error.into(),
        // A file in place of the folder must not be reported as if the file itself existed.
        false => io::Error::other(format!("the folder {} could not be created: {error}", folder.shown())),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn surroundings(roots: &[&Path], data: &Path) -> Surroundings {
        Surroundings { roots: roots.iter().map(|r| (*r).to_owned()).collect(), data: Some(data.to_owned()) }
    }

    #[test]
    fn shaders_are_looked_for_in_order_and_models_beside_them() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let at = |name: &str| folder.path().join(name);
        let (a, b, data) = (at("a"), at("b"), at("data"));
        fs::create_dir_all(b.join("assets/shaders"))?;
        let find = |assets: Option<&Path>, models: Option<&Path>| {
            Folders::find_in(assets, models, &surroundings(&[&a, &b], &data))
        };
        let found = find(None, None).expect("there");
        assert_eq!(found.shaders, Some(b.join("assets/shaders")));
        assert_eq!(found.models, Some(b.join("assets/models")));
        fs::create_dir_all(a.join("assets/shaders"))?;
        assert_eq!(find(None, None).expect("there").shaders, Some(a.join("assets/shaders")));
        let named = find(Some(&b.join("assets")), Some(&at("mine"))).expect("there");
        let expected = Folders {
            shaders: Some(b.join("assets/shaders")),
            models: Some(at("mine")),
            ..Folders::default()
        };
        assert_eq!(named, expected);
        // Without any of them: the built-in shaders, and models in the user's data.
        let none = Folders::find_in(None, None, &surroundings(&[], &data)).expect("there");
        assert_eq!(none, Folders { models: Some(data.join("models")), ..Folders::default() });
        Ok(())
    }

    #[test]
    fn several_exports_at_once_complete_each_other() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let registry = Registry::builtin();
        let all: Vec<_> = std::thread::scope(|scope| {
            let begun: Vec<_> = (0..3).map(|_| scope.spawn(|| export(folder.path(), &registry))).collect();
            begun.into_iter().map(|thread| thread.join().expect("no panic")).collect()
        });
        let all: Vec<_> = all.into_iter().map(|exported| exported.expect("written")).collect();
        let count = built_in_sources(&registry).len() + EXAMPLES.len();
        assert_eq!(all.iter().map(|exported| exported.written.len()).sum::<usize>(), count);
        for exported in &all {
            assert!(exported.kept.is_empty());
            assert_eq!(exported.written.len() + exported.same, count);
        }
        Ok(())
    }

    #[test]
    fn an_export_that_fails_leaves_what_was_there() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let (place, registry) = (folder.path().join("new/er"), Registry::builtin());
        // The models come last.
        fs::create_dir_all(&place)?;
        fs::write(place.join("models"), "mine")?;
        let said = export(&place, &registry).expect_err("no folder").to_string();
        assert!(said.ends_with("a part of its path is not a folder"), "{said}");
        let names: Vec<_> = fs::read_dir(&place)?.flatten().map(|entry| entry.file_name()).collect();
        assert_eq!(names, ["models"]);
        fs::remove_file(place.join("models"))?;
        assert!(export(&place, &registry).is_ok_and(|exported| exported.same == 0));
        Ok(())
    }

    #[test]
    fn what_cannot_be_written_leaves_no_folder() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let root = folder.path();
        let long = root.join("new/models").join("x".repeat(300));
        assert!(write_new(&long, "").is_err() && !root.join("new").exists());
        fs::write(root.join("file"), "")?;
        let said = write_new(&root.join("file/models/a.wgsl"), "").expect_err("a file").to_string();
        assert!(said.contains("could not be created") && said.ends_with("file is not a folder"), "{said}");
        write_new(&root.join("new/models/a.wgsl"), "")?;
        let again = write_new(&root.join("new/models/a.wgsl"), "").expect_err("there");
        assert_eq!(again.kind(), io::ErrorKind::AlreadyExists);
        Ok(())
    }

    #[test]
    fn a_folder_that_is_none_is_told_with_the_one_that_is_meant() -> io::Result<()> {
        let folder = tempfile::tempdir()?;
        let root = folder.path();
        fs::create_dir_all(root.join("assets/shaders"))?;
        fs::write(root.join("file"), "")?;
        let said = |assets: Option<&Path>, models: Option<&Path>| {
            Folders::find_in(assets, models, &Surroundings::default())
                .err()
                .map(|e| e.to_string())
                .unwrap_or_default()
        };
        let meant = format!("did you mean {}?", root.join("assets").shown());
        assert!(said(Some(root), None).contains(&meant));
        assert!(said(Some(&root.join("assets/shaders")), None).contains(&meant));
        assert!(said(Some(&root.join("none")), None).contains("there is no such folder"));
        assert!(said(None, Some(&root.join("file"))).contains("must be a folder"));
        Ok(())
    }
}
