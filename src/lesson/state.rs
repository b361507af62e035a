//! The scene on entering a step: values of scene files, set one after the other and checked like a file.

use std::{
    io::ErrorKind,
    path::{Component, Path as FilePath, PathBuf},
    sync::Arc,
};

use serde_json::Value as Json;

use super::{
    limits::{MAX_LINES, MAX_PROBLEMS},
    problem::Problems,
    words::{Piece, lines},
};
use crate::{
    files::{self, FileError},
    parameter::Outside,
    registry::Registry,
    scene::{
        Scene, SceneIn,
        error::{LoadError, Path, Segment},
        examples::EXAMPLES,
        load::{self, Defaults, Loaded},
        syntax::check_syntax,
    },
    text::{did_you_mean, quoted, sentence, shortened},
};

pub(super) use crate::scene::at::path;

/// Name of the scene in the reader of scene files, which determines its format.
const NAME: &str = "step.json";

/// The places of a lesson's scenes.
#[derive(Clone, Copy)]
pub(super) struct Shelf<'a> {
    /// The folder of the lesson, if it has one; it must contain the scenes.
    pub folder: Option<&'a FilePath>,
    /// The files outside their folder that the scenes may name.
    pub outside: &'a Outside,
    pub registry: &'a Registry,
}

/// The change of the scene on entering a step.
#[derive(Clone, Debug, Default)]
pub struct SceneChange {
    operations: Vec<Operation>,
    /// The folder of the files named in the scene.
    folder: PathBuf,
    /// The files outside that folder that it may name.
    outside: Outside,
}

#[derive(Clone, Debug)]
struct Operation {
    /// Byte of the change in the lesson.
    at: usize,
    what: What,
}

#[derive(Clone, Debug)]
enum What {
    /// Replaces the scene.
    Open(Arc<Scene>),
    /// Sets a value; null removes it.
    Set(Path, Json),
}

impl SceneChange {
    /// True if another scene replaces the present one.
    pub(super) fn opens(&self) -> bool {
        self.operations.iter().any(|operation| matches!(operation.what, What::Open(_)))
    }

    /// The paths of the values set.
    pub(super) fn paths(&self) -> impl Iterator<Item = &Path> {
        self.operations.iter().filter_map(|operation| match &operation.what {
            What::Set(path, _) => Some(path),
            What::Open(_) => None,
        })
    }

    /// The scene after the change.
    ///
    /// # Errors
    /// Returns an error if the scene breaks a rule.
    pub fn apply(&self, scene: &Scene, registry: &Registry) -> Result<Scene, String> {
        self.applied(scene, registry)
            .map_err(|problems| problems.into_iter().map(|(_, what)| what).collect::<Vec<_>>().join("\n"))
    }

    /// The scene after the change, or the problems with their bytes.
    pub(super) fn applied(&self, scene: &Scene, registry: &Registry) -> Result<Scene, Vec<(usize, String)>> {
        let opened = self.operations.iter().rposition(|o| matches!(o.what, What::Open(_)));
        let base = match opened.map(|i| &self.operations[i].what) {
            Some(What::Open(scene)) => scene,
            _ => scene,
        };
        let sets: Vec<_> = self.operations[opened.map_or(0, |i| i + 1)..]
            .iter()
            .filter_map(|o| match &o.what {
                What::Set(path, value) => Some((o.at, path, value)),
                What::Open(_) => None,
            })
            .collect();
        if sets.is_empty() {
            return Ok(base.clone());
        }
        let mut json = serde_json::to_value(SceneIn(base, registry)).unwrap_or_default();
        for (at, path, value) in &sets {
            set(&mut json, path.segments(), value).map_err(|what| vec![(*at, format!("{path} {what}"))])?;
        }
        let text = json.to_string();
        let mut outside = self.outside.clone();
        outside.allow(base.files());
        let how = Defaults::Use.allowing(&outside);
        let read = load::in_folder(text.as_bytes(), (NAME, &self.folder), registry, how);
        read.map(|Loaded { scene, .. }| scene).map_err(|error| {
            let of = |problem: &Path| {
                let alike = |path: &Path| {
                    path.segments().iter().zip(problem.segments()).take_while(|(a, b)| a == b).count()
                };
                sets.iter().rev().max_by_key(|(_, path, _)| alike(path)).map_or(0, |(at, ..)| *at)
            };
            let problems = error.problems().into_iter().take(MAX_PROBLEMS);
            problems
                .map(|p| (of(&p.path), crate::scene::error::Problem { place: None, ..p }.to_string()))
                .collect()
        })
    }
}

/// Sets a value of a scene.
fn set(json: &mut Json, path: &[Segment], value: &Json) -> Result<(), String> {
    let Some((step, rest)) = path.split_first() else {
        *json = value.clone();
        return Ok(());
    };
    match step {
        Segment::Key(key) => {
            if json.is_null() {
                *json = Json::Object(serde_json::Map::new());
            }
            let Json::Object(map) = json else {
                return Err("leads into a value that has no keys".to_owned());
            };
            if rest.is_empty() && value.is_null() {
                map.remove(key.as_ref());
                return Ok(());
            }
            set(map.entry(key.as_ref()).or_insert(Json::Null), rest, value)
        }
        Segment::Index(index) => {
            if json.is_null() {
                *json = Json::Array(Vec::new());
            }
            let Json::Array(list) = json else {
                return Err("leads into a value that is not a list".to_owned());
            };
            if *index > list.len() {
                let count = list.len();
                let has = format!("the list has {count} entries, counted from 0");
                return Err(format!("does not exist: {has}; [{count}] adds one"));
            }
            if rest.is_empty() && value.is_null() {
                if *index < list.len() {
                    list.remove(*index);
                }
                return Ok(());
            }
            if *index == list.len() {
                list.push(Json::Null);
            }
            set(&mut list[*index], rest, value)
        }
    }
}

/// The scene with a name in a lesson: a file in its folder, or else a shipped scene.
pub(super) fn open(name: &str, shelf: Shelf) -> Result<Scene, String> {
    let Shelf { folder, outside, registry } = shelf;
    let refused = || {
        let name = quoted(name);
        Err(format!(
            "{name} is outside the folder of the lesson; put the scene itself beside the lesson, or give {}",
            Outside::OPTION
        ))
    };
    let joined = folder.map(|folder| folder.join(name)).unwrap_or_default();
    let beside = match folder.map(|folder| files::inside(folder, &joined)) {
        None if FilePath::new(name).components().any(|c| !matches!(c, Component::Normal(_))) => {
            return refused();
        }
        None => None,
        Some(Ok(_)) => Some(joined),
        Some(Err(FileError::Io(error))) if error.kind() == ErrorKind::NotFound => None,
        Some(Err(FileError::Outside(_))) if outside.allows(&joined) => Some(joined),
        Some(Err(FileError::Outside(_))) => return refused(),
        Some(Err(error)) => return Err(format!("the scene {} could not be read: {error}", quoted(name))),
    };
    let loaded = match beside {
        Some(path) => load::file(&path, registry, Defaults::Use.allowing(outside)).map(|loaded| loaded.scene),
        None => match EXAMPLES.iter().find(|example| example.file == name) {
            Some(example) => example.scene(registry),
            None => {
                let near = did_you_mean(name, EXAMPLES.iter().map(|e| (e.file, e.file)));
                let wherever =
                    if folder.is_some() { "neither beside the lesson nor among" } else { "not among" };
                return Err(format!("the scene {} is {wherever} the shipped scenes{near}", quoted(name)));
            }
        },
    };
    loaded.map_err(|error| match &error {
        LoadError::Invalid { .. } => {
            format!("the scene has problems: {}", error.to_string().replace('\n', "; "))
        }
        error => error.to_string(),
    })
}

/// Reads the body of a `scene` block.
pub(super) fn read(body: Piece, shelf: Shelf, problems: &mut Problems) -> SceneChange {
    let folder = shelf.folder.map(FilePath::to_owned).unwrap_or_default();
    let mut change = SceneChange { operations: Vec::new(), folder, outside: shelf.outside.clone() };
    // A value continues over lines that do not begin with a path.
    let mut statements: Vec<(usize, usize)> = Vec::new();
    for line in lines(body.text, body.at) {
        let piece = line.piece();
        if piece.text.is_empty() {
            continue;
        }
        let begins = piece.text.starts_with("open:")
            || ['=', ':'].into_iter().any(|sign| {
                piece.text.split_once(sign).is_some_and(|(path, _)| {
                    path.starts_with(|c: char| c.is_alphabetic() || c == '$') && !path.contains('"')
                })
            });
        match statements.last_mut() {
            Some(last) if !begins => last.1 = piece.end(),
            _ => statements.push((piece.at, piece.end())),
        }
    }
    let mut opened = false;
    for (i, (start, end)) in statements.into_iter().enumerate() {
        if i == MAX_LINES {
            let what = format!("a scene block sets at most {MAX_LINES} values; open a scene that has them");
            problems.at(start, what);
            break;
        }
        let piece = body.part(start - body.at, end - body.at);
        if let Some(name) = piece.text.strip_prefix("open:") {
            let name = piece.part(piece.text.len() - name.len(), piece.text.len()).trimmed();
            if std::mem::replace(&mut opened, true) {
                problems.at(piece.at, "the block opens two scenes; keep the last one");
                continue;
            }
            match open(name.text, shelf) {
                Ok(scene) => {
                    change.operations.push(Operation { at: name.at, what: What::Open(Arc::new(scene)) });
                }
                Err(what) => problems.at(name.at, what),
            }
            continue;
        }
        let equals = piece.text.find('=');
        // As in a `view` block.
        let colon = piece.text.find(':').filter(|colon| equals.is_none_or(|equals| *colon < equals));
        if let Some(colon) = colon.filter(|colon| path(piece.text[..*colon].trim_end()).is_ok()) {
            let value = piece.text[colon + 1..].trim();
            let value = if value.is_empty() { "VALUE" } else { value };
            let meant = format!("{} = {value}", piece.text[..colon].trim_end());
            let what = format!("a scene block sets values with =; write {}", shortened(&meant));
            problems.at(piece.at + colon, what);
            continue;
        }
        let Some(equals) = equals else {
            problems.at(piece.at, "each line of a scene block must be PATH = VALUE or open: FILE");
            continue;
        };
        let written = piece.part(0, equals).trimmed();
        let value = piece.part(equals + 1, piece.text.len()).trimmed();
        let path = path(written.text).map_err(|(at, what)| problems.at(written.at + at, what));
        let value = json(value).map_err(|(at, what)| problems.at(at, what));
        if let (Ok(path), Ok(value)) = (path, value) {
            change.operations.push(Operation { at: written.at, what: What::Set(path, value) });
        }
    }
    change
}

/// A value as in scene files, or the byte of a mistake, with the remedy.
fn json(piece: Piece) -> Result<Json, (usize, String)> {
    if piece.text.is_empty() {
        return Err((piece.at, "the value is missing; write it as in a scene file".to_owned()));
    }
    if let Err((at, what)) = check_syntax(piece.text) {
        let what = match what {
            what if what.contains("truncated") => "the value ends too early".to_owned(),
            what => what.replace("the end of the file after the scene", "the end of the value"),
        };
        let is_word = piece.text.starts_with(|c: char| c.is_alphabetic());
        let hint = if is_word { ". Text needs double quotes, as in \"phong\"." } else { "" };
        return Err((piece.at + at, sentence(&what).trim_end_matches('.').to_owned() + hint));
    }
    serde_json::from_str(piece.text).map_err(|error| (piece.at, error.to_string()))
}
