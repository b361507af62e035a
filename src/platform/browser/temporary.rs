//! Temporary files and folders, as the crate tempfile has them on a desktop.

use std::{
    io::{self, Write},
    path::{Path, PathBuf},
    sync::atomic::{AtomicU32, Ordering},
};

use super::fs::{self, File};

/// Makes temporary files and folders.
#[derive(Debug, Default)]
pub struct Builder {
    prefix: String,
    suffix: String,
}

impl Builder {
    /// No names yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// How names begin.
    pub fn prefix(&mut self, prefix: &str) -> &mut Self {
        prefix.clone_into(&mut self.prefix);
        self
    }

    /// How names end.
    pub fn suffix(&mut self, suffix: &str) -> &mut Self {
        suffix.clone_into(&mut self.suffix);
        self
    }

    fn place(&self, folder: &Path) -> PathBuf {
        static LAST: AtomicU32 = AtomicU32::new(0);
        let number = LAST.fetch_add(1, Ordering::Relaxed);
        folder.join(format!("{}{number:06}{}", self.prefix, self.suffix))
    }

    /// A temporary file in a folder.
    ///
    /// # Errors
    /// Returns an error if there is no such folder.
    pub fn tempfile_in(&self, folder: impl AsRef<Path>) -> io::Result<NamedTempFile> {
        let path = self.place(folder.as_ref());
        Ok(NamedTempFile { file: Some(File::create_new(&path)?), path })
    }

    /// A temporary folder in a folder.
    ///
    /// # Errors
    /// Returns an error if there is no such folder.
    pub fn tempdir_in(&self, folder: impl AsRef<Path>) -> io::Result<TempDir> {
        let path = self.place(folder.as_ref());
        fs::create_dir(&path)?;
        Ok(TempDir { path, stays: false })
    }
}

/// A temporary file, removed unless it is put in its place.
#[derive(Debug)]
pub struct NamedTempFile {
    /// `None` once it is in its place.
    file: Option<File>,
    path: PathBuf,
}

/// Why a file was not put in its place.
#[derive(Debug)]
pub struct PersistError {
    /// The reason.
    pub error: io::Error,
}

impl NamedTempFile {
    /// The file.
    ///
    /// # Panics
    /// Never: it is there until it is put in its place.
    #[must_use]
    pub fn as_file(&self) -> &File {
        self.file.as_ref().expect("not in its place yet")
    }

    /// The path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Puts it in its place, and replaces what is there.
    ///
    /// # Errors
    /// Returns an error if it has no place there.
    pub fn persist(mut self, place: impl AsRef<Path>) -> Result<File, PersistError> {
        let moved = fs::rename(&self.path, &place).and_then(|()| {
            self.file = None;
            File::open(place)
        });
        moved.map_err(|error| PersistError { error })
    }

    /// Puts it in its place, if that is free.
    ///
    /// # Errors
    /// Returns an error if it is not.
    pub fn persist_noclobber(self, place: impl AsRef<Path>) -> Result<File, PersistError> {
        if fs::is_there(&place) {
            return Err(PersistError { error: io::ErrorKind::AlreadyExists.into() });
        }
        self.persist(place)
    }
}

impl Drop for NamedTempFile {
    fn drop(&mut self) {
        if self.file.take().is_some() {
            let _ = fs::remove_file(&self.path);
        }
    }
}

impl Write for NamedTempFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match &mut self.file {
            Some(file) => file.write(bytes),
            None => Err(io::ErrorKind::NotFound.into()),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// A temporary folder, removed when this is dropped.
#[derive(Debug)]
pub struct TempDir {
    path: PathBuf,
    stays: bool,
}

impl TempDir {
    /// The path.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether it stays.
    pub fn disable_cleanup(&mut self, stays: bool) {
        self.stays = stays;
    }
}

impl Drop for TempDir {
    fn drop(&mut self) {
        if !self.stays {
            let _ = fs::remove_dir_all(&self.path);
        }
    }
}
