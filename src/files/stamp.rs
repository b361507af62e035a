//! Detects changes of a file without reading it.

use std::{
    path::Path,
    time::{Duration, SystemTime},
};

use crate::platform::{self, fs};

/// The time for which the clocks of file systems may stand still.
const COARSE: Duration = Duration::from_millis(100);

/// The length and the modification time of a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stamp {
    length: u64,
    changed: SystemTime,
}

impl Stamp {
    /// The stamp of a file that has not just changed: any later change also changes its stamp.
    #[must_use]
    pub fn settled(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok()?;
        let changed = metadata.modified().ok()?;
        let age = platform::now().duration_since(changed).ok()?;
        (age > COARSE).then_some(Self { length: metadata.len(), changed })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_just_changed_has_no_stamp_and_one_that_changes_gets_another() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("file");
        assert_eq!(Stamp::settled(&path), None);
        let write = |text: &str, age: u64| {
            fs::write(&path, text).expect("written");
            let file = fs::File::options().write(true).open(&path).expect("there");
            file.set_modified(SystemTime::now() - Duration::from_secs(age)).expect("set");
            Stamp::settled(&path)
        };
        assert_eq!(write("one", 0), None);
        let old = write("one", 100);
        assert!(old.is_some() && old == Stamp::settled(&path));
        assert_ne!(write("two", 50), old);
        assert_ne!(write("three", 100), old);
    }
}
