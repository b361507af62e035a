//! The folders from which shaders and custom models are read, and the names of the files in them.

use std::path::{Path, PathBuf};

use crate::platform::fs;

/// Prefix of the source paths of custom models and their shared files.
pub(crate) const MODELS: &str = "models/";

/// The folders from which shaders and custom models are read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Folders {
    /// The folder whose files replace the built-in shaders; `None` to use those.
    pub shaders: Option<PathBuf>,
    /// The folder whose files are custom models. It need not exist yet.
    pub models: Option<PathBuf>,
    /// The folders with shaders of other crates; see [`add_shader_folder`](super::Register::add_shader_folder).
    pub extensions: Vec<PathBuf>,
}

impl Folders {
    /// The source path of a file on disk, as in messages; `None` if it is not a shader in these folders.
    #[must_use]
    pub fn source_of(&self, file: &Path) -> Option<String> {
        if file.extension().is_none_or(|e| e != "wgsl") {
            return None;
        }
        let below = |folder: Option<&PathBuf>, prefix: &str| {
            let rest = file.strip_prefix(folder?).ok()?;
            let parts: Option<Vec<_>> = rest.iter().map(|p| p.to_str()).collect();
            Some(format!("{prefix}{}", parts?.join("/")))
        };
        let shader = |folder| below(folder, "").filter(|source| !source.starts_with(MODELS));
        let mut folders = [self.shaders.as_ref()].into_iter().chain(self.extensions.iter().map(Some));
        below(self.models.as_ref(), MODELS).or_else(|| folders.find_map(shader))
    }

    /// The file on disk for a source path, existing or not; `None` for generated text. If several folders
    /// could contain it, the first that does.
    #[must_use]
    pub fn file_of(&self, source: &str) -> Option<PathBuf> {
        if source.starts_with('(') {
            return None;
        }
        match source.strip_prefix(MODELS) {
            Some(name) => Some(self.models.as_ref()?.join(name)),
            None => {
                let own = || self.shaders.iter().chain(&self.extensions).map(|folder| folder.join(source));
                own().find(|file| fs::is_file(file)).or_else(|| own().next())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_and_source_paths_lead_to_each_other() {
        // The model folder may be inside the shader folder.
        let folders = Folders {
            shaders: Some("/a/shaders".into()),
            models: Some("/a/shaders/mine".into()),
            extensions: vec!["/b".into()],
        };
        for (file, source) in [
            ("/a/shaders/loop.wgsl", "loop.wgsl"),
            ("/a/shaders/reflection/phong.wgsl", "reflection/phong.wgsl"),
            ("/a/shaders/mine/velvet.wgsl", "models/velvet.wgsl"),
        ] {
            assert_eq!(folders.source_of(Path::new(file)).as_deref(), Some(source));
            assert_eq!(folders.file_of(source), Some(file.into()));
        }
        for file in ["/a/loop.wgsl", "/a/shaders/loop.txt", "/a/shaders/models/velvet.wgsl"] {
            assert_eq!(folders.source_of(Path::new(file)), None, "{file}");
        }
        assert_eq!(folders.source_of(Path::new("/b/light/lamp.wgsl")).as_deref(), Some("light/lamp.wgsl"));
        assert_eq!(
            folders.file_of("light/lamp.wgsl"),
            Some("/a/shaders/light/lamp.wgsl".into()),
            "neither is there"
        );
        let alone = Folders { shaders: None, ..folders.clone() };
        assert_eq!(alone.file_of("light/lamp.wgsl"), Some("/b/light/lamp.wgsl".into()));
        assert_eq!(folders.file_of("(row)"), None);
        assert_eq!(Folders::default().file_of("loop.wgsl"), None);
    }
}
