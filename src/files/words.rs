//! Errors of the operating system in words.

use std::io::{self, ErrorKind};

/// An error without its number, rephrased where the system's words are unhelpful.
#[must_use]
pub fn words(error: &io::Error) -> String {
    let said = error.to_string();
    // Errors with a number come from the system, even if a library appends the path of a draft.
    let Some((system, _)) = said.split_once(" (os error ") else {
        let zero = error.kind() == ErrorKind::InvalidInput && said.contains("NUL byte");
        return if zero { "the name has a zero character (\\0), which no file has".to_owned() } else { said };
    };
    let own = match error.kind() {
        ErrorKind::NotFound => "there is no such file or folder",
        ErrorKind::PermissionDenied => "no permission",
        ErrorKind::AlreadyExists => "something of that name already exists",
        ErrorKind::NotADirectory => "a part of its path is not a folder",
        ErrorKind::ReadOnlyFilesystem => "the disk is read-only",
        ErrorKind::StorageFull => "the disk is full",
        ErrorKind::QuotaExceeded => "the disk quota of this user is exhausted",
        ErrorKind::ResourceBusy => "it is in use by the system",
        ErrorKind::InvalidFilename => "the name is too long",
        _ if system.starts_with("Too many levels of symbolic links") => super::CIRCLE,
        _ => system,
    };
    own.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(target_os = "linux")]
    fn failures_have_no_numbers() {
        for (number, expected) in [
            (libc::ENOENT, "there is no such file or folder"),
            (libc::EACCES, "no permission"),
            (libc::ENOTDIR, "a part of its path is not a folder"),
            (libc::EBUSY, "it is in use by the system"),
            (libc::ENAMETOOLONG, "the name is too long"),
            (libc::ENOSPC, "the disk is full"),
            (libc::EROFS, "the disk is read-only"),
            (libc::ELOOP, "too many links, each leading to the next"),
            (libc::EIO, "Input/output error"),
        ] {
            assert_eq!(words(&io::Error::from_raw_os_error(number)), expected);
        }
        let of_draft = tempfile::tempfile_in("/proc").expect_err("nobody makes files there");
        assert_eq!(words(&of_draft), "there is no such file or folder");
        let zero = std::fs::metadata("a\0b").expect_err("no name");
        assert_eq!(words(&zero), "the name has a zero character (\\0), which no file has");
        // This program's own errors stay unchanged.
        let own = io::Error::new(ErrorKind::NotADirectory, "it is not a folder");
        assert_eq!(words(&own), "it is not a folder");
    }
}
