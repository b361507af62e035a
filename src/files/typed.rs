//! Names of files as users type them into dialogs.

use std::path::{Path, PathBuf};

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

#[cfg(test)]
mod tests {
    use super::*;

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
