//! Overwriting a file that stays the same file.

use std::{io, path::Path};

use super::{is_same, options, regular};
use crate::platform::fs::{File, Metadata};

/// Makes an open file equal to another, and waits until that is on disk. Until then its content is a prefix of the
/// other's.
pub(super) fn fill(from: &mut File, place: &mut File) -> io::Result<()> {
    place.set_len(0)?;
    io::copy(from, place)?;
    place.sync_all()
}

/// Opens a file to overwrite it, if this user may and it is still the one examined before.
pub(super) fn open_to_overwrite(target: &Path, old: &Metadata) -> Option<File> {
    let file = options().write(true).open(target).ok()?;
    let now = file.metadata().ok()?;
    (regular(&now).is_ok() && is_same(&now, old)).then_some(file)
}
