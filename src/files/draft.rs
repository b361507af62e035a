//! Replaces files, all or nothing.

use std::{
    io::{self, Seek as _, Write},
    path::{Path, PathBuf},
};

use super::{
    FileError, Node,
    before::{Before, Turn},
    folder_of, follow, litter,
    living::{self, Living, Temporary},
    overwrite::{fill, open_to_overwrite},
    regular, tidy,
};
use crate::platform::{
    fs::{self, File, Metadata},
    temporary::{self, NamedTempFile, PersistError},
};

/// Writes a document, replacing any existing one: all or nothing, and on disk when this returns. Links are
/// followed; mode, owner, group and hard links are kept where the system allows it.
///
/// # Errors
/// Returns an error if the path leads to anything but a regular file, or the document cannot be written.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let mut draft = Draft::new(path)?;
    draft.write_all(bytes)?;
    draft.replace()
}

/// Writes several documents, each as [`write()`] does; none is put in place before all are on disk.
///
/// # Errors
/// Returns the errors of [`write()`]. If one document cannot be written, as on a full disk, nothing is
/// changed.
pub fn write_all<'a>(documents: impl IntoIterator<Item = (PathBuf, &'a [u8])>) -> Result<(), FileError> {
    let draft = |(path, bytes): (PathBuf, &[u8])| -> Result<Draft, FileError> {
        let mut draft = Draft::new(&path)?;
        draft.write_all(bytes)?;
        draft.sync()?;
        Ok(draft)
    };
    let drafts = documents.into_iter().map(draft).collect::<Result<Vec<_>, _>>()?;
    drafts.into_iter().try_for_each(Draft::replace)
}

/// Writes a new document, as [`write()`] does.
///
/// # Errors
/// Returns [`io::ErrorKind::AlreadyExists`] if the file exists, and the errors of [`write()`].
pub fn create(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let mut draft = Draft::new(path)?;
    draft.write_all(bytes)?;
    draft.create()
}

/// The new content of a file, not yet in place. Dropping it deletes it.
#[derive(Debug)]
pub struct Draft {
    /// The destination, with links resolved.
    target: PathBuf,
    file: NamedTempFile,
    living: Living,
    /// True if the content must be on disk before it is put in place.
    synced: bool,
    /// True for a program.
    executable: bool,
}

impl Draft {
    /// An empty draft of a document, after [`tidy`] in its folder.
    ///
    /// # Errors
    /// Returns an error if the path leads to anything but a regular file, or its folder is not writable.
    pub fn new(path: &Path) -> Result<Self, FileError> {
        let draft = Self::beside(path, true)?;
        let _ = tidy(folder_of(&draft.target));
        Ok(draft)
    }

    /// An empty draft of something that can be calculated again, without waiting for the disk. Hard links to the file that
    /// it replaces keep the old content.
    ///
    /// # Errors
    /// Returns the errors of [`new`](Self::new).
    pub fn fleeting(path: &Path) -> Result<Self, FileError> {
        Self::beside(path, false)
    }

    fn beside(path: &Path, synced: bool) -> Result<Self, FileError> {
        let target = follow(path)?;
        let is_new = existing(&target)?.is_none();
        let mut builder = temporary::Builder::new();
        builder.prefix(litter::PREFIX).suffix(litter::DRAFT);
        #[cfg(unix)]
        if is_new {
            use std::os::unix::fs::PermissionsExt as _;
            // The mode of new files, before the umask.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        #[cfg(not(unix))]
        let _ = is_new;
        let make = || {
            litter::locked(
                || builder.tempfile_in(folder_of(&target)),
                |file| (file.as_file(), file.path().to_owned()),
            )
        };
        let missing = |error: io::Error| match error.kind() {
            io::ErrorKind::NotFound => super::missing(folder_of(&target)),
            _ => error,
        };
        let (file, living) =
            Living::making(make, |file| Temporary::File(file.path().to_owned())).map_err(missing)?;
        Ok(Self { target, file, living, synced, executable: false })
    }

    /// Makes the draft executable.
    #[must_use]
    pub fn executable(mut self) -> Self {
        self.executable = true;
        self
    }

    /// Puts the draft in place, if the place is free.
    ///
    /// # Errors
    /// Returns [`io::ErrorKind::AlreadyExists`] if the place is taken, and any error of the operating system.
    pub fn create(self) -> Result<(), FileError> {
        self.persist(|file, target| file.persist_noclobber(target))
    }

    fn persist(
        mut self,
        put: impl FnOnce(NamedTempFile, &Path) -> Result<File, PersistError>,
    ) -> Result<(), FileError> {
        if self.executable {
            make_executable(self.file.as_file())?;
        }
        self.sync()?;
        let Self { target, file, living: _living, synced, .. } = self;
        let step = living::step();
        // The file stays open, and thus locked, until its folder is on disk.
        let persisted = put(file, &target);
        drop(step);
        let _file = persisted.map_err(|e| e.error)?;
        sync_folder(&target, synced);
        Ok(())
    }

    /// Puts the draft in place, if the place is unchanged: as [`create`](Self::create) if it was free,
    /// otherwise as [`replace`](Self::replace).
    ///
    /// # Errors
    /// Returns [`FileError::Taken`] if the place has changed, and the errors of those methods.
    pub fn replace_if(self, before: &Before) -> Result<(), FileError> {
        let _turn = Turn::in_folder(folder_of(&self.target));
        if *before != Before::of(&self.target) {
            return Err(FileError::Taken);
        }
        if !before.is_nothing() {
            return self.replace();
        }
        self.create().map_err(|error| match error {
            FileError::Io(error) if error.kind() == io::ErrorKind::AlreadyExists => FileError::Taken,
            error => error,
        })
    }

    /// Puts the draft in place, replacing any file there.
    ///
    /// # Errors
    /// Returns an error if the place holds anything but a regular file, and any error of the operating
    /// system. Unless it is [`FileError::Unfinished`], the old file is unchanged.
    pub fn replace(self) -> Result<(), FileError> {
        let old = existing(&self.target)?;
        if let Some(old) = &old {
            let alike = take_after(self.file.as_file(), old);
            self.file.as_file().set_permissions(old.permissions())?;
            // A result that can be calculated again is no reason to change files of other names.
            if (!alike || self.synced && Node::of(old).links > 1)
                && let Some(place) = open_to_overwrite(&self.target, old)
            {
                return self.overwrite(place, old);
            }
        }
        self.persist(|file, target| file.persist(target))
    }

    /// Overwrites the existing file. This can be interrupted, so until it is done the draft is kept under a
    /// name that is not treated as litter.
    fn overwrite(mut self, mut place: File, old: &Metadata) -> Result<(), FileError> {
        self.synced = true;
        self.sync()?;
        let Self { target, file, living: _living, executable, .. } = self;
        let copy = litter::whole(file.path(), old);
        let step = living::step();
        let persisted = file.persist(&copy);
        drop(step);
        let mut whole = persisted.map_err(|e| e.error)?;
        sync_folder(&target, true);
        whole
            .rewind()
            .and_then(|()| fill(&mut whole, &mut place))
            .map_err(|error| FileError::Unfinished { copy: copy.clone(), error })?;
        if executable {
            make_executable(&place)?;
        }
        // Done; if the copy cannot be removed, the next tidying recognises it as a copy.
        let _ = fs::remove_file(&copy);
        Ok(())
    }

    fn sync(&mut self) -> io::Result<()> {
        self.file.flush()?;
        if self.synced { self.file.as_file().sync_all() } else { Ok(()) }
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Makes a file executable for everyone who may read it.
#[cfg_attr(not(unix), allow(unused_variables))]
pub(super) fn make_executable(file: &File) -> io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        let mode = file.metadata()?.permissions().mode();
        file.set_permissions(fs::Permissions::from_mode(mode | (mode & 0o444) >> 2))?;
    }
    Ok(())
}

/// The regular file at a path, if any.
fn existing(target: &Path) -> Result<Option<Metadata>, FileError> {
    match fs::metadata(target) {
        Ok(metadata) => regular(&metadata).map(|()| Some(metadata)),
        Err(e) if e.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(e) => Err(e.into()),
    }
}

/// Gives a file the owner and group of another; true if both succeeded.
#[cfg_attr(not(unix), allow(unused_variables))]
fn take_after(file: &File, old: &Metadata) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::{MetadataExt as _, fchown};
        let Ok(new) = file.metadata() else { return false };
        let user = (new.uid() != old.uid()).then_some(old.uid());
        let group = (new.gid() != old.gid()).then_some(old.gid());
        if (user, group) == (None, None) || fchown(file, user, group).is_ok() {
            return true;
        }
        // The group alone is better than neither.
        user.is_some() && group.is_some() && {
            let _ = fchown(file, None, group);
            false
        }
    }
    #[cfg(not(unix))]
    true
}

/// Syncs the folder of a new name. Not every file system supports this; the file itself is complete either
/// way.
#[cfg_attr(not(unix), allow(unused_variables))]
fn sync_folder(file: &Path, synced: bool) {
    #[cfg(unix)]
    if synced && let Ok(folder) = File::open(folder_of(file)) {
        let _ = folder.sync_all();
    }
}
