//! Parameters that name a file: its numbers are read once for all that name it, and read again when it
//! changes. They are read on first use, so that all files of a scene can be read at once, by [`read_all`].

use std::{
    borrow::Cow,
    collections::HashMap,
    hash::{DefaultHasher, Hasher as _},
    path::{Path, PathBuf},
    sync::{
        Arc, LazyLock, Mutex, OnceLock, RwLock, RwLockReadGuard, Weak,
        atomic::{AtomicU64, AtomicUsize, Ordering},
    },
};

use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use rayon::prelude::*;
use serde::{Serialize, Serializer};

use super::outside::Outside;
use crate::{
    caught::{lock, unpoisoned},
    declared::debug_by,
    files::{self, Shown as _},
    platform::fs,
};

/// The files that a parameter may name, and how they are read.
pub struct FileFormat {
    /// Name with an article, for messages: "an IES photometric file".
    pub name: &'static str,
    /// The extensions of its files, without the dot.
    pub extensions: &'static [&'static str],
    /// Maximum size; larger files are not read.
    pub max_bytes: u64,
    /// The numbers of a file, for renderers.
    pub read: fn(&[u8]) -> Result<Vec<f32>, FileProblem>,
    /// Files that are part of the program, by name: at least the default.
    pub shipped: &'static [(&'static str, Shipped)],
}

/// The content of a file that is part of the program.
#[derive(Clone, Copy, Debug)]
pub enum Shipped {
    /// A file as it could be on disk.
    Bytes(&'static [u8]),
    /// Numbers that the program calculates, as [`FileFormat::read`] would return them.
    Numbers(fn() -> Vec<f32>),
}

/// A mistake in a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileProblem {
    /// The line of the mistake, from 1; `None` if it is about the whole file.
    pub line: Option<usize>,
    /// The mistake and the remedy.
    pub message: String,
}

impl PartialEq for FileFormat {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

debug_by!(FileFormat: name);

/// A file named in a scene.
#[derive(Clone, Reflect)]
#[reflect(opaque)]
#[reflect(Clone, Debug, PartialEq)]
pub struct NamedFile {
    /// The name as in the scene file, relative to its folder.
    name: Cow<'static, str>,
    content: Arc<Content>,
}

/// The content of a file, shared by all that name it.
struct Content {
    /// The file, or its content if it is part of the program.
    source: Result<PathBuf, Shipped>,
    /// The folder of the scenes that name it, which must contain it; `None` if it may be anywhere.
    folder: Option<PathBuf>,
    format: &'static FileFormat,
    /// Set once it was read for the first time.
    first: OnceLock<()>,
    state: RwLock<State>,
}

#[derive(Default)]
struct State {
    /// The numbers of the last version that was legal.
    numbers: Option<Arc<Numbers>>,
    /// The mistake in the present version.
    problem: Option<String>,
    /// The present version, if a later one would have another stamp.
    stamp: Option<files::Stamp>,
}

/// The numbers of a file, shared by all paths that lead to it.
struct Numbers {
    all: Arc<[f32]>,
    /// Differs for every change of the numbers of any file.
    version: u64,
    /// The hash of the numbers, once it was asked for.
    digest: OnceLock<u64>,
}

/// Identifies files, whatever their paths: identity and format.
type Key = (files::Identity, &'static str);

/// The contents of files on disk that are in use, by path, by the folder that must contain them and by format.
type Contents = HashMap<(PathBuf, Option<PathBuf>, &'static str), Weak<Content>>;
/// The contents of shipped files, by name and format.
type OfProgram = HashMap<(&'static str, &'static str), Arc<Content>>;

static CONTENTS: LazyLock<Mutex<Contents>> = LazyLock::new(Mutex::default);
static SHIPPED: LazyLock<Mutex<OfProgram>> = LazyLock::new(Mutex::default);
/// The numbers in use. An entry keeps none of them.
static NUMBERS: LazyLock<Mutex<HashMap<Key, Weak<Numbers>>>> = LazyLock::new(Mutex::default);
static CHANGES: AtomicU64 = AtomicU64::new(0);
/// The files that [`read_all`] has read and is about to read.
static READING: [AtomicUsize; 2] = [const { AtomicUsize::new(0) }; 2];

/// Number of changes of the numbers of any file.
#[must_use]
pub fn file_changes() -> u64 {
    CHANGES.load(Ordering::Relaxed)
}

/// Maximum size of all files named in a scene, in bytes, each counted once, whatever paths lead to it. Twenty
/// measured materials of 34 MiB are within it.
pub const MAX_FILES_BYTES: u64 = 768 << 20;
/// Maximum number of values in all files named in a scene: 1 GiB in memory. Models in text have a third as
/// many numbers as bytes, binary ones about as many; but a small file may show the same triangles often.
pub const MAX_FILES_NUMBERS: usize = 256 << 20;

/// Reads all files of a scene that were not read yet, in parallel on all processors. A file named in several
/// ways is read once.
///
/// # Errors
/// Returns an error if the files together have more than [`MAX_FILES_BYTES`], which is checked before any is
/// read, or more than [`MAX_FILES_NUMBERS`]: the rest is then not read. The message follows the scene: "names
/// files of …".
pub fn read_all<'f>(files: impl Iterator<Item = &'f NamedFile>) -> Result<(), String> {
    read_within(files, MAX_FILES_BYTES, MAX_FILES_NUMBERS)
}

fn read_within<'f>(
    files: impl Iterator<Item = &'f NamedFile>,
    max_bytes: u64,
    max_numbers: usize,
) -> Result<(), String> {
    let mut contents: Vec<_> = files.map(|file| &file.content).collect();
    contents.sort_by_key(|content| Arc::as_ptr(content));
    contents.dedup_by_key(|content| Arc::as_ptr(content));
    // Each with the others that are the same file.
    let mut groups: Vec<Vec<&Arc<Content>>> = Vec::with_capacity(contents.len());
    let mut known: HashMap<Key, usize> = HashMap::new();
    let mut bytes = 0u64;
    for content in contents {
        match content.identity() {
            None => groups.push(vec![content]),
            Some((key, length)) => match known.get(&key) {
                Some(group) => groups[*group].push(content),
                None => {
                    known.insert(key, groups.len());
                    groups.push(vec![content]);
                    // Larger files are refused one by one, unread.
                    bytes += if length > content.format.max_bytes { 0 } else { length };
                }
            },
        }
    }
    if bytes > max_bytes {
        let [all, most] = [bytes.div_ceil(1 << 20), max_bytes >> 20];
        return Err(format!("names files of {all} MiB in total; at most {most} MiB are read"));
    }
    let is_new = |group: &[&Arc<Content>]| group.iter().any(|content| content.first.get().is_none());
    let numbers = AtomicUsize::new(0);
    let [done, all] = &READING;
    all.fetch_add(groups.iter().filter(|group| is_new(group)).count(), Ordering::Relaxed);
    groups.par_iter().for_each(|group| {
        let is_new = is_new(group);
        if let Some((first, others)) = group.split_first()
            && numbers.load(Ordering::Relaxed) <= max_numbers
        {
            let count = first.state().numbers.as_ref().map_or(0, |numbers| numbers.all.len());
            numbers.fetch_add(count, Ordering::Relaxed);
            others.iter().for_each(|other| other.read_as(first));
        }
        done.fetch_add(usize::from(is_new), Ordering::Relaxed);
    });
    if numbers.into_inner() > max_numbers {
        return Err(format!("names files with more than {max_numbers} numbers in total, the most allowed"));
    }
    Ok(())
}

/// The number of files that [`read_all`] has read, and of those that it was asked to read, in this process.
#[must_use]
pub fn files_read() -> [usize; 2] {
    READING.each_ref().map(|count| count.load(Ordering::Relaxed))
}

impl NamedFile {
    /// The file with this name in the folder of a scene. If it does not exist, a shipped file may have that
    /// name. A file outside the folder is not read.
    #[must_use]
    pub fn named(name: &str, folder: &Path, format: &'static FileFormat) -> Self {
        Self::allowed(name, folder, format, Outside::NONE)
    }

    /// Like [`named`](Self::named), for a file chosen by the user, which may be anywhere.
    #[must_use]
    pub fn chosen(name: &str, folder: &Path, format: &'static FileFormat) -> Self {
        Self::allowed(name, folder, format, Outside::ALL)
    }

    /// Like [`named`](Self::named), for a scene that may name these files outside its folder.
    #[must_use]
    pub fn allowed(name: &str, folder: &Path, format: &'static FileFormat, outside: &Outside) -> Self {
        let path = folder.join(name);
        let shipped = format.shipped.iter().find(|(shipped, _)| *shipped == name && !fs::is_there(&path));
        if let Some((name, _)) = shipped {
            return Self::shipped(name, format);
        }
        // Nothing is the working folder.
        let [path, folder] = [path, folder.join(".")].map(|p| fs::absolute(&p).unwrap_or(p));
        let folder = (!outside.allows(&path)).then_some(folder);
        Self { name: Cow::Owned(name.to_owned()), content: Content::of(path, folder, format) }
    }

    /// A shipped file.
    pub(super) fn shipped(name: &'static str, format: &'static FileFormat) -> Self {
        let found = format.shipped.iter().find(|(shipped, _)| *shipped == name);
        let source = found.map_or(Shipped::Bytes(&[]), |(_, content)| *content);
        let mut shipped = lock(&SHIPPED);
        let content =
            shipped.entry((name, format.name)).or_insert_with(|| Content::new(Err(source), None, format));
        Self { name: Cow::Borrowed(name), content: content.clone() }
    }

    /// The name as in the scene file.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The name without folders.
    #[must_use]
    pub fn short_name(&self) -> Cow<'_, str> {
        Path::new(self.name()).file_name().map_or(Cow::Borrowed(self.name()), |name| name.to_string_lossy())
    }

    /// The file under another name.
    #[must_use]
    pub fn renamed(&self, name: impl Into<Cow<'static, str>>) -> Self {
        Self { name: name.into(), content: self.content.clone() }
    }

    /// Maximum size; larger files are not read.
    #[must_use]
    pub fn max_bytes(&self) -> u64 {
        self.content.format.max_bytes
    }

    /// The file, unless it is part of the program.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.content.path()
    }

    /// The file for a scene in this folder: by its name if that leads to it, or else by its path.
    #[must_use]
    pub fn seen_from(&self, folder: &Path) -> Self {
        let there = fs::absolute(folder.join(&*self.name)).ok();
        match self.path() {
            Some(path) if there.as_deref() != Some(path) => {
                let mut content = self.content.clone();
                // Anyone who could use it here may use it there.
                if self.numbers().is_some() {
                    content = Content::of(path.to_owned(), None, content.format);
                    content.read_as(&self.content);
                }
                Self { name: Cow::Owned(path.to_string_lossy().into_owned()), content }
            }
            _ => self.clone(),
        }
    }

    /// The numbers of the last version that was legal, if there was one.
    #[must_use]
    pub fn numbers(&self) -> Option<Arc<[f32]>> {
        self.content.state().numbers.as_ref().map(|numbers| numbers.all.clone())
    }

    /// The mistake in the present version: file, line, mistake.
    #[must_use]
    pub fn problem(&self) -> Option<String> {
        self.content.state().problem.clone()
    }

    /// True if it is outside a folder: a scene there can read it only if that is allowed.
    #[must_use]
    pub fn is_outside(&self, folder: &Path) -> bool {
        let leads_out = |path| matches!(files::inside(folder, path), Err(files::FileError::Outside(_)));
        self.path().is_some_and(leads_out)
    }

    /// The version of the numbers, which differs for other numbers, also of other files.
    #[must_use]
    pub fn version(&self) -> u64 {
        self.content.state().numbers.as_ref().map_or(0, |numbers| numbers.version)
    }

    /// A hash of the numbers, the same in every run of the program; 0 without numbers.
    #[must_use]
    pub fn digest(&self) -> u64 {
        let state = self.content.state();
        let Some(numbers) = &state.numbers else { return 0 };
        *numbers.digest.get_or_init(|| {
            let mut hasher = DefaultHasher::new();
            numbers.all.iter().for_each(|v| hasher.write_u32(v.to_bits()));
            hasher.finish()
        })
    }

    /// A value shared by all with the same content, and by nobody else.
    #[must_use]
    pub fn identity(&self) -> usize {
        Arc::as_ptr(&self.content) as usize
    }

    /// Reads the file again, for all that name it. True if its numbers or its errors changed.
    #[must_use]
    pub fn read_again(&self) -> bool {
        let mut is_first = false;
        self.content.first.get_or_init(|| is_first = self.content.read());
        is_first || self.content.read()
    }

    /// True if the file is read in this format.
    #[must_use]
    pub fn is_in(&self, format: &FileFormat) -> bool {
        self.content.format == format
    }
}

impl Outside {
    /// Allows those of these files that may be anywhere already, for example because the user chose them.
    pub fn allow<'f>(&mut self, files: impl IntoIterator<Item = &'f NamedFile>) {
        let anywhere = files.into_iter().filter(|file| file.content.folder.is_none());
        anywhere.filter_map(NamedFile::path).for_each(|path| self.add(path));
    }
}

impl Content {
    fn new(
        source: Result<PathBuf, Shipped>,
        folder: Option<PathBuf>,
        format: &'static FileFormat,
    ) -> Arc<Self> {
        Arc::new(Self { source, folder, format, first: OnceLock::new(), state: RwLock::default() })
    }

    /// The content of a file on disk, shared with those that use it, and read again if it has changed.
    fn of(path: PathBuf, folder: Option<PathBuf>, format: &'static FileFormat) -> Arc<Self> {
        let mut contents = lock(&CONTENTS);
        contents.retain(|_, content| content.strong_count() > 0);
        let known = contents.entry((path.clone(), folder.clone(), format.name)).or_default();
        let content = match known.upgrade() {
            Some(content) => {
                // It may have changed since it was read; many parts may name it.
                if content.first.get().is_some() && !content.is_as_read() {
                    content.read();
                }
                content
            }
            None => Self::new(Ok(path), folder, format),
        };
        *known = Arc::downgrade(&content);
        content
    }

    /// The content of the file, read now unless read before.
    fn state(&self) -> RwLockReadGuard<'_, State> {
        self.first.get_or_init(|| _ = self.read());
        unpoisoned(self.state.read())
    }

    /// Copies the state of another content for the same file, unless this was read already.
    fn read_as(&self, other: &Self) {
        self.first.get_or_init(|| {
            let (numbers, problem, stamp) = {
                let state = other.state();
                (state.numbers.clone(), state.problem.clone(), state.stamp)
            };
            // Each is reported by its own name.
            let names = [other, self].map(|content| content.path().map(|path| path.shown().to_string()));
            let problem = match (problem, names) {
                (Some(problem), [Some(theirs), Some(ours)]) => Some(
                    problem.strip_prefix(&theirs).map_or(problem.clone(), |what| format!("{ours}{what}")),
                ),
                (problem, _) => problem,
            };
            *unpoisoned(self.state.write()) = State { numbers, problem, stamp };
        });
    }

    /// The identity of the file, if it may be read, and its length.
    fn identity(&self) -> Option<(Key, u64)> {
        self.identity_at(&self.place(self.path()?).ok()?)
    }

    fn identity_at(&self, place: &Path) -> Option<(Key, u64)> {
        let (identity, length) = files::identity(place)?;
        Some(((identity, self.format.name), length))
    }

    /// The path from which the file is read, if permitted.
    fn place(&self, path: &Path) -> Result<PathBuf, String> {
        let Some(folder) = &self.folder else { return Ok(path.to_owned()) };
        files::inside(folder, path).map_err(|error| match error {
            files::FileError::Outside(_) => {
                format!(
                    "{error}, but a scene may read only files in its own folder, unless {} is given",
                    Outside::OPTION
                )
            }
            error => error.to_string(),
        })
    }

    /// True if the file is the one that was read last.
    fn is_as_read(&self) -> bool {
        let known = unpoisoned(self.state.read()).stamp;
        known.is_some() && known == self.path().and_then(files::Stamp::settled)
    }

    fn path(&self) -> Option<&Path> {
        self.source.as_deref().ok()
    }

    fn read(&self) -> bool {
        let stamp = self.path().and_then(files::Stamp::settled);
        let mut key = None;
        let read = match &self.source {
            Err(Shipped::Bytes(bytes)) => (self.format.read)(bytes).map_err(|problem| problem.message),
            Err(Shipped::Numbers(calculate)) => Ok(calculate()),
            Ok(path) => {
                let bytes = self.place(path).and_then(|place| {
                    let length;
                    (key, length) = self.identity_at(&place).unzip();
                    let bytes = files::read(&place, self.format.max_bytes).map_err(|error| {
                        match (&error, length) {
                            (files::FileError::TooLarge(_), Some(length)) => {
                                format!("{error}: it has {length} bytes")
                            }
                            _ => error.to_string(),
                        }
                    })?;
                    if bytes.is_empty() { Err(files::EMPTY.to_owned()) } else { Ok(bytes) }
                });
                bytes.map_err(|error| format!("{}: {error}", path.shown())).and_then(|bytes| {
                    (self.format.read)(&bytes).map_err(|FileProblem { line, message }| {
                        let line = line.map_or(String::new(), |line| format!(":{line}"));
                        format!("{}{line}: {message}", path.shown())
                    })
                })
            }
        };
        let mut state = unpoisoned(self.state.write());
        state.stamp = stamp;
        match read {
            Ok(numbers) => {
                let others = state.numbers.as_ref().is_none_or(|known| known.all[..] != numbers[..]);
                if others {
                    state.numbers = Some(shared(key, numbers));
                }
                state.problem.take().is_some() || others
            }
            Err(problem) => {
                let news = state.problem.as_ref() != Some(&problem);
                state.problem = Some(problem);
                news
            }
        }
    }
}

/// Numbers that were just read: those in use, if another path to the same file has equal ones.
fn shared(key: Option<Key>, numbers: Vec<f32>) -> Arc<Numbers> {
    let mut all = lock(&NUMBERS);
    all.retain(|_, numbers| numbers.strong_count() > 0);
    if let Some(known) = key.and_then(|key| all.get(&key)?.upgrade())
        && known.all[..] == numbers[..]
    {
        return known;
    }
    let version = CHANGES.fetch_add(1, Ordering::Relaxed) + 1;
    let numbers = Arc::new(Numbers { all: numbers.into(), version, digest: OnceLock::new() });
    if let Some(key) = key {
        all.insert(key, Arc::downgrade(&numbers));
    }
    numbers
}

/// Equal if the name and the file are the same.
impl PartialEq for NamedFile {
    fn eq(&self, other: &Self) -> bool {
        // Shipped files of one name and format are one.
        self.name == other.name && self.content.format == other.content.format && self.path() == other.path()
    }
}

debug_by!(NamedFile: name);

impl Serialize for NamedFile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.name)
    }
}

/// A file with its numbers, for calculation.
#[derive(Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(opaque)]
#[reflect(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// The file.
    pub file: Option<NamedFile>,
    /// The numbers of the file when the table was taken.
    pub numbers: Arc<[f32]>,
}

#[cfg(test)]
mod tests;
