//! Reading shader files, and locating bytes that are not text.

use std::{io, path::Path};

use crate::{
    files::{self, FileError, Shown as _},
    platform::fs,
    shader::check::ShaderProblem,
};

/// Maximum size of a file, in bytes. The declaration and the WGSL have separate limits of length and depth:
/// [`LIMITS`](crate::shader::limits::LIMITS).
pub const MAX_BYTES: u64 = 1 << 20;

/// Reads a file, called `name` in messages, and removes a byte order mark.
///
/// # Errors
/// Returns an error if the file is missing, cannot be read, is larger than [`MAX_BYTES`], or is not UTF-8.
pub fn read(file: &Path, name: &str) -> Result<String, ShaderProblem> {
    text_of(files::read(file, MAX_BYTES), file, name)
}

/// Like [`read`], for files in the folder of custom models: a link must not lead out of that folder.
///
/// # Errors
/// Returns an error if [`read`] does, or if the file is a link to a file in another folder.
pub fn read_model(file: &Path, name: &str) -> Result<String, ShaderProblem> {
    let read = files::inside(files::folder_of(file), file).and_then(|end| files::read(&end, MAX_BYTES));
    let read = match read {
        // What is neither a file nor a link to one is named as what it is.
        Err(FileError::Outside(folder)) => match files::kind(file) {
            Ok(files::Kind::File) | Err(_) => Err(FileError::Outside(folder)),
            Ok(kind) => Err(FileError::Kind(kind)),
        },
        read => read,
    };
    text_of(read, file, name)
}

/// The text of a file, from its bytes.
fn text_of(read: Result<Vec<u8>, FileError>, file: &Path, name: &str) -> Result<String, ShaderProblem> {
    let failed = |message: String| ShaderProblem {
        file: name.to_owned(),
        line: 1,
        column: 1,
        source: String::new(),
        message,
    };
    let bytes = read.map_err(|error| {
        failed(match error {
            FileError::Io(e) if e.kind() == io::ErrorKind::NotFound && fs::symlink_metadata(file).is_ok() => {
                "this is a link to a file that is missing".to_owned()
            }
            FileError::Io(e) if e.kind() == io::ErrorKind::NotFound => {
                "the file is missing; it reloads when restored".to_owned()
            }
            FileError::Outside(folder) => {
                format!("this is a link that leads out of the folder {}; copy the file there", folder.shown())
            }
            FileError::Kind(kind) => format!("this is {kind}, not a regular file"),
            FileError::TooLarge(_) => {
                format!("the file is larger than {} MiB, the most allowed for a shader", MAX_BYTES >> 20)
            }
            error => format!("the file could not be read: {error}"),
        })
    })?;
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let bytes = error.as_bytes();
        let start = bytes[..at].iter().rposition(|b| *b == b'\n').map_or(0, |i| i + 1);
        let end = bytes[at..].iter().position(|b| *b == b'\n').map_or(bytes.len(), |i| at + i);
        ShaderProblem {
            line: bytes[..at].iter().filter(|b| **b == b'\n').count() + 1,
            column: String::from_utf8_lossy(&bytes[start..at]).chars().count() + 1,
            source: String::from_utf8_lossy(&bytes[start..end]).into_owned(),
            ..failed(format!("the byte 0x{:02x} is not UTF-8; save the file as UTF-8", bytes[at]))
        }
    })?;
    Ok(text.strip_prefix('\u{FEFF}').map_or(text.clone(), str::to_owned))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(bytes: &[u8]) -> Result<String, String> {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("a.wgsl");
        fs::write(&file, bytes).expect("writable");
        read(&file, "a.wgsl").map_err(|p| p.to_string())
    }

    #[test]
    fn what_is_no_text_is_told_with_its_place() {
        assert_eq!(said(b"fn f() {}\n"), Ok("fn f() {}\n".to_owned()));
        assert_eq!(said("\u{FEFF}// é\r\n".as_bytes()), Ok("// é\r\n".to_owned()));
        assert_eq!(
            said(b"// one\n// caf\xe9\n"),
            Err("a.wgsl:2:7: the byte 0xe9 is not UTF-8; save the file as UTF-8".to_owned())
        );
        let large = said(&vec![b' '; MAX_BYTES as usize + 1]).expect_err("too large");
        assert!(large.contains("larger than 1 MiB"), "{large}");
        let gone = read(Path::new("/nonexistent/a.wgsl"), "a.wgsl").expect_err("is not there");
        assert!(gone.message.contains("the file is missing"), "{gone}");
        let folder = tempfile::tempdir().expect("a folder");
        let is_folder = read(folder.path(), "a.wgsl").expect_err("is a folder");
        assert!(is_folder.message.contains("not a regular file"), "{is_folder}");
    }
}
