//! What the page reports: what other tabs of the site do, what has been copied, and what has failed.
//!
//! All tabs share the files that the browser keeps. What one writes, the others hear, as a desktop tells of files that
//! another program changes. If two write a file before they hear of each other, that of the first stays, and that of the
//! second gets another name.

use std::path::{Path, PathBuf};

use super::{super::notice::Notice, fs};

/// Deals with something that the page reports. Returns what the user should know about it.
pub(super) fn happened(what: &str, subject: &str, bytes: Vec<u8>) -> Option<Notice> {
    let path = Path::new(subject);
    match what {
        "written" => fs::hear(path, Some(bytes)),
        "removed" => fs::hear(path, None),
        "clash" => return clash(path, bytes),
        "unkept" => return Some(unkept(path)),
        "tabs" => {
            let text = "The laboratory is open in another tab, too. Both have the same files: what one saves, the other \
                        reloads. Each keeps its own copy of unsaved work.";
            return Some(Notice::Info(text.to_owned()));
        }
        "memory" => {
            let text = format!(
                "The browser keeps no files for this page ({subject}): download what you want to keep."
            );
            return Some(Notice::Warning(text));
        }
        "copied" => return Some(Notice::Copied(subject.to_owned())),
        "uncopied" => {
            let why = String::from_utf8_lossy(&bytes);
            return Some(Notice::Uncopied(subject.to_owned(), why.trim_end_matches('.').to_owned()));
        }
        "copied picture" => return Some(Notice::Info(format!("Copied the picture: {subject} pixels."))),
        "uncopied picture" => {
            let why = subject.trim_end_matches('.');
            return Some(Notice::Warning(format!("The picture was not copied: {why}. Save it instead.")));
        }
        "fatal" => {
            let text = format!(
                "The page ended the last time it drew with {subject}: the graphics driver may hang or crash. This page \
                 does not draw with it until the file is changed."
            );
            return Some(Notice::Warning(text));
        }
        _ => {}
    }
    None
}

/// Takes over the file of another tab, and keeps what this one wrote to it beside it.
fn clash(path: &Path, theirs: Vec<u8>) -> Option<Notice> {
    let own = fs::read(path).ok().filter(|own| *own != theirs);
    fs::hear(path, Some(theirs));
    // As on a desktop, the last of the program's own records are those that count.
    let own = own.filter(|_| path.parent() != Some(Path::new(fs::DATA)))?;
    let place = beside(path);
    let kept = fs::write(&place, own);
    let text = match kept {
        Ok(()) => format!(
            "Another tab has saved {} at the same time: the file has its version, and {} has yours.",
            path.display(),
            place.display()
        ),
        Err(why) => return Some(Notice::Unkept(path.to_owned(), why.to_string())),
    };
    Some(Notice::Warning(text))
}

/// A free name beside that of a file.
fn beside(path: &Path) -> PathBuf {
    let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    let (stem, extension) = (part(path.file_stem()), part(path.extension()));
    let end = if extension.is_empty() { extension } else { format!(".{extension}") };
    let mut names = (2..).map(|number| path.with_file_name(format!("{stem}_{number}{end}")));
    names.find(|place| !fs::is_there(place)).unwrap_or_else(|| path.to_owned())
}

/// A file that the browser could not keep.
fn unkept(path: &Path) -> Notice {
    let is_copy =
        path.strip_prefix(fs::DATA).is_ok_and(|path| path.to_string_lossy().starts_with("recovery"));
    if is_copy {
        let why = fs::NO_ROOM;
        return Notice::Warning(format!("There is no recovery copy of the unsaved changes: {why}."));
    }
    Notice::Unkept(path.to_owned(), fs::NO_ROOM.to_owned())
}
