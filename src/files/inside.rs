//! Paths confined to a folder.

use std::path::{Component, Path, PathBuf};

use super::FileError;
use crate::platform::fs;

/// The target of a path, with links resolved, if it is in or below a folder. Nothing is accessed if the path
/// leads out of the folder by its name.
///
/// # Errors
/// Returns [`FileError::Outside`], or an error if the target does not exist.
pub fn inside(folder: &Path, path: &Path) -> Result<PathBuf, FileError> {
    let outside = || FileError::Outside(folder.to_owned());
    if !plain(path)?.starts_with(plain(folder)?) {
        return Err(outside());
    }
    let end = fs::canonicalize(path)?;
    if end.starts_with(fs::canonicalize(folder)?) { Ok(end) } else { Err(outside()) }
}

/// The absolute path without `.` and `..`, by name alone.
fn plain(path: &Path) -> Result<PathBuf, FileError> {
    let mut plain = PathBuf::new();
    for component in fs::absolute(path)?.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => _ = plain.pop(),
            component => plain.push(component),
        }
    }
    Ok(plain)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn what_leads_out_of_a_folder_is_told_from_what_stays() {
        let root = tempfile::tempdir().expect("a folder");
        let folder = root.path().join("a/scene");
        fs::create_dir_all(folder.join("below")).expect("made");
        for file in ["a/scene/m.obj", "a/scene/below/m.obj", "a/m.obj", "a/scenery.obj"] {
            fs::write(root.path().join(file), "").expect("written");
        }
        let of = |name: &str| match inside(&folder, &folder.join(name)) {
            Ok(_) => "inside",
            Err(FileError::Outside(_)) => "outside",
            Err(_) => "missing",
        };
        for name in
            ["m.obj", "./m.obj", "below/m.obj", "below/../m.obj", "../scene/m.obj", "nowhere/../m.obj"]
        {
            // The last one is invalid for the operating system.
            let expected = if name.starts_with("nowhere") { "missing" } else { "inside" };
            assert_eq!(of(name), expected, "{name}");
        }
        for name in
            ["../m.obj", "below/../../m.obj", "../scenery.obj", "/etc/passwd", "../missing.obj", "../.."]
        {
            assert_eq!(of(name), "outside", "{name}");
        }
        assert_eq!(of("missing.obj"), "missing");
        assert_eq!(of(&folder.join("m.obj").display().to_string()), "inside");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_to_their_ends() {
        use std::os::unix::fs::symlink;
        let root = tempfile::tempdir().expect("a folder");
        let folder = root.path().join("scene");
        fs::create_dir_all(&folder).expect("made");
        fs::write(root.path().join("secret"), "").expect("written");
        fs::write(folder.join("m.obj"), "").expect("written");
        symlink("../secret", folder.join("file")).expect("made");
        symlink("..", folder.join("up")).expect("made");
        symlink("m.obj", folder.join("here")).expect("made");
        // The folder itself may be a link.
        symlink(&folder, root.path().join("link")).expect("made");
        for through in [&folder, &root.path().join("link")] {
            let of = |name: &str| inside(through, &through.join(name));
            for name in ["file", "up/secret", "up"] {
                assert!(matches!(of(name), Err(FileError::Outside(_))), "{name}");
            }
            assert_eq!(of("here").expect("inside"), folder.canonicalize().expect("there").join("m.obj"));
            assert!(of("up/scene/m.obj").is_ok());
        }
    }
}
