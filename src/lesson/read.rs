//! Reads a lesson from a file or a text, reporting all problems at once.

use std::{
    borrow::Cow,
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{
    Lesson, Problem, check, front,
    limits::MAX_FILE_BYTES,
    markdown,
    problem::Problems,
    state::{self, Shelf},
};
use crate::{
    files::{self, FileError, Kind},
    parameter::Outside,
    platform::fs,
    registry::Registry,
    scene::{Scene, encoding, error::LoadError},
};

/// Name of the lesson file in a folder.
const IN_FOLDER: &str = "lesson.md";

/// Reads a lesson from a file or a folder.
pub(super) fn file(path: &Path, registry: &Registry, outside: &Outside) -> Result<Lesson, Vec<Problem>> {
    let is_folder = files::kind(path).is_ok_and(|kind| kind == Kind::Folder);
    let file: Cow<Path> = if is_folder { path.join(IN_FOLDER).into() } else { path.into() };
    let whole = |message: String| vec![Problem::of_file(message)];
    // A folder may come from anybody: only files within it are read.
    let place = if is_folder { files::inside(path, &file) } else { Ok(file.to_path_buf()) };
    let bytes = place.and_then(|place| files::read(&place, MAX_FILE_BYTES)).map_err(|error| {
        whole(match error {
            FileError::TooLarge(_) => {
                format!("the file is larger than {} MiB, the most allowed for a lesson", MAX_FILE_BYTES >> 20)
            }
            FileError::Io(error) if error.kind() == std::io::ErrorKind::NotFound && is_folder => {
                format!(
                    "the folder has no {IN_FOLDER}; a lesson is a Markdown file, or a folder with {IN_FOLDER}"
                )
            }
            FileError::Io(error) if error.kind() == std::io::ErrorKind::NotFound => {
                "file not found".to_owned()
            }
            error => format!("the file could not be read: {error}"),
        })
    })?;
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&bytes);
    let content = encoding::decode(bytes, "").map_err(|error| match error {
        LoadError::NotUtf8 { place, what, .. } => {
            let line = bytes.split(|b| *b == b'\n').nth(place.line - 1).unwrap_or_default();
            let source = String::from_utf8_lossy(line).chars().take(400).collect();
            vec![Problem { place: Some(place), message: format!("not UTF-8 text: {what}"), source }]
        }
        error => whole(error.to_string()),
    })?;
    // The name "." has no meaning.
    let absolute = fs::absolute(path).unwrap_or_else(|_| path.to_owned());
    let named = if is_folder { absolute.file_name() } else { absolute.file_stem() };
    let id = named.unwrap_or_default().to_string_lossy();
    let folder: PathBuf = files::folder_of(&file).to_owned();
    text(content, &id, Shelf { folder: Some(&folder), outside, registry })
}

/// Reads a lesson from text.
pub(super) fn text(whole: &str, name: &str, shelf: Shelf) -> Result<Lesson, Vec<Problem>> {
    let whole = whole.strip_prefix('\u{feff}').unwrap_or(whole);
    let mut problems = Problems::of(whole);
    if whole.len() as u64 > MAX_FILE_BYTES {
        problems.at(0, format!("the lesson is larger than {} MiB, the most allowed", MAX_FILE_BYTES >> 20));
        return Err(problems.finish());
    }
    let front = front::read(whole, &mut problems);
    let mut is_known = true;
    let start = match &front.scene {
        None => Scene::default(),
        Some((at, file)) => state::open(file, shelf).unwrap_or_else(|what| {
            problems.at(*at, what);
            is_known = false;
            Scene::default()
        }),
    };
    let drafts = markdown::steps(whole, front.end, shelf, &mut problems);
    let start = Arc::new(start);
    // Without the intended scene, everything about it would seem wrong.
    if is_known && !problems.are_enough() {
        check::steps(&start, &drafts, shelf.registry, &mut problems);
    }
    if !problems.is_empty() {
        return Err(problems.finish());
    }
    Ok(Lesson {
        id: name.to_owned(),
        title: front.title,
        summary: front.summary,
        minutes: front.minutes,
        start,
        steps: drafts.into_iter().map(|draft| draft.step).collect(),
    })
}
