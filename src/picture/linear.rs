//! OpenEXR and Radiance files: pictures of linear light with the metadata of PNG files.

use std::{
    io::{self, Write as _},
    path::Path,
};

use super::png::About;
use crate::{
    files::Output,
    linear::{Channels, Format, Notes},
    scene::formats::SCENE_KEYWORD,
};

/// Writes a picture with its metadata. As with [`png::write`](super::png::write), missing folders are created, and a
/// file appears complete or not at all.
///
/// # Errors
/// Returns the errors of [`Channels::encode`], and an error if the file cannot be written.
pub fn write(path: &Path, format: Format, channels: &Channels, about: &About) -> io::Result<()> {
    // Before the file is begun.
    let bytes = encode(format, channels, about)?;
    Output::put(path, |to| to.write_all(&bytes))
}

/// The picture as the bytes of a file.
///
/// # Errors
/// Returns the errors of [`Channels::encode`].
pub fn encode(format: Format, channels: &Channels, about: &About) -> io::Result<Vec<u8>> {
    let (software, texts): (Vec<_>, Vec<_>) =
        about.texts.iter().partition(|(keyword, _)| *keyword == "Software");
    let software = software.first().map_or("", |(_, text)| text.as_str());
    let comment = |(keyword, text): &(&str, String)| format!("{keyword}: {}\n", text.replace('\n', " "));
    let comments: String = texts.into_iter().map(comment).collect();
    let scene = about.scene.as_deref().map(|scene| (SCENE_KEYWORD, scene));
    let notes = Notes { software: software.into(), comments: comments.trim_end().into(), scene };
    channels.encode(format, &notes)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use glam::Vec4;

    use super::*;
    use crate::{
        registry::Registry,
        scene::{
            Scene,
            load::{self, Defaults},
        },
    };

    fn channels() -> Channels {
        let mut channels = Channels::new(16, 8);
        let pixels: Vec<_> = (0..16 * 8).map(|i| Vec4::splat(i as f32)).collect();
        channels.add("", &["R", "G", "B", "A"], &pixels);
        channels
    }

    #[test]
    fn the_program_opens_what_it_writes() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let registry = Registry::builtin();
        let scene = Scene { name: Some("Blinn–Phong\n\u{1}".to_owned()), ..Scene::default() };
        let about = About::scene(&scene, &registry).with("Source", "a\nb.json");
        for format in [Format::Exr, Format::Hdr] {
            let path = folder.path().join("new/folder/picture").with_extension(format.extension());
            write(&path, format, &channels(), &about).expect("can be written");
            let bytes = fs::read(&path).expect("exists");
            assert_eq!(encode(format, &channels(), &about).expect("in memory"), bytes);
            let has = |text: &str| bytes.windows(text.len()).any(|part| part == text.as_bytes());
            assert!(
                has("Lights, Camera, Models!") && has("Source: a b.json") && has("Reflection model: lambert")
            );
            let back = load::file(&path, &registry, Defaults::Refuse).expect("has a scene").scene;
            assert_eq!(back, scene);
            // By its first bytes alone.
            let unnamed = load::from_bytes(&bytes, "picture", &registry, Defaults::Refuse);
            assert_eq!(unnamed.expect("has a scene").scene, scene);
            write(&path, format, &channels(), &about.clone().without_scene()).expect("can be written");
            let said = load::file(&path, &registry, Defaults::Refuse).expect_err("has no scene").to_string();
            assert!(said.contains("there is no scene in this picture"), "{said}");
            // No other files are left.
            fs::remove_file(&path).expect("there");
            assert_eq!(fs::read_dir(path.parent().expect("has one")).expect("readable").count(), 0);
        }
    }

    #[test]
    fn a_picture_that_cannot_be_written_leaves_nothing() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("new/a.exr");
        let mut wrong = channels();
        wrong.add("x", &["R"], &[]);
        assert!(write(&path, Format::Exr, &wrong, &About::program()).is_err());
        assert!(write(folder.path(), Format::Exr, &channels(), &About::program()).is_err());
        assert_eq!(fs::read_dir(folder.path()).expect("readable").count(), 0);
        #[cfg(target_os = "linux")]
        {
            let full = write(Path::new("/dev/full"), Format::Exr, &channels(), &About::program());
            assert_eq!(full.expect_err("the disk is full").kind(), io::ErrorKind::StorageFull);
        }
    }
}
