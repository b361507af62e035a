//! Names of files as users type them into dialogs and on the command line.

use std::path::{Component, Path, PathBuf};

use crate::platform::fs;

/// The file that a name from a dialog means, which has the usual extension if none was typed.
///
/// Dialogs offer a name with its stem selected, and some append an extension to whatever is typed. Who types `row.png` then
/// gets `row.png.png`: of two known extensions the first counts.
#[must_use]
pub fn meant(typed: &Path, usual: &str, is_known: impl Fn(&Path) -> bool) -> PathBuf {
    match (typed.extension(), typed.file_stem().map(Path::new)) {
        (None, _) => typed.with_extension(usual),
        (Some(_), Some(stem)) if is_known(typed) && is_known(stem) => typed.with_file_name(stem),
        _ => typed.to_owned(),
    }
}

/// A path without steps into missing folders and out of them again: `a/../b` is `b` if there is no `a`. For the system, `a`
/// would have to be made first, and would stay, empty.
#[must_use]
pub fn without_detours(path: &Path) -> PathBuf {
    let mut straight = PathBuf::new();
    for part in path.components() {
        let turns_back = part == Component::ParentDir
            && matches!(straight.components().next_back(), Some(Component::Normal(_)))
            && fs::symlink_metadata(&straight).is_err();
        if turns_back {
            straight.pop();
        } else {
            straight.push(part);
        }
    }
    match straight {
        same if same == path => path.to_owned(),
        here if here.as_os_str().is_empty() => PathBuf::from("."),
        straight => straight,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_that_are_left_again_are_passed_by_if_they_are_missing() {
        let around = tempfile::tempdir().expect("a folder");
        let at = |path: &str| around.path().join(path);
        fs::create_dir(at("a")).expect("made");
        for (path, expected) in [
            ("b/../c.png", "c.png"),
            ("b/./d/../../c/e.png", "c/e.png"),
            ("a/b/../c.png", "a/c.png"),
            ("a/../c.png", "a/../c.png"),
            ("a/../b/../c.png", "a/../c.png"),
        ] {
            assert_eq!(without_detours(&at(path)), at(expected), "{path}");
        }
        for (path, expected) in
            [("no such/..", "."), ("no such/../../x", "../x"), ("./no such/", "./no such/"), ("..", "..")]
        {
            assert_eq!(without_detours(Path::new(path)).as_os_str(), expected, "{path}");
        }
    }

    #[test]
    fn an_extension_is_added_once() {
        let is_known = |path: &Path| {
            let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
            ["png", "gif", "apng"].map(|known| Some(known.to_owned())).contains(&extension)
        };
        for (typed, expected) in [
            ("row", "row.png"),
            ("row.png", "row.png"),
            ("row.png.png", "row.png"),
            ("row.PNG.png", "row.PNG"),
            ("a/turn.gif.png", "a/turn.gif"),
            ("turn.apng.png", "turn.apng"),
            ("v1.2.png", "v1.2.png"),
            ("row.jpg", "row.jpg"),
            ("png.png", "png.png"),
        ] {
            assert_eq!(meant(Path::new(typed), "png", is_known), Path::new(expected), "{typed}");
        }
    }
}
