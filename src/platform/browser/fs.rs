//! Files in memory, as `std::fs` has them on a desktop. The page keeps those that outlive it, and shares them with other
//! tabs of the site.

use std::{
    collections::BTreeMap,
    ffi::OsString,
    io::{self, Read, Seek, SeekFrom, Write},
    path::{Component, Path, PathBuf},
    sync::{
        Arc, LazyLock, Mutex, MutexGuard,
        atomic::{AtomicBool, AtomicU64, Ordering},
    },
    time::SystemTime,
};

use super::{now, page};
use crate::caught::lock;

/// The folder of what the program keeps for its user: settings, progress, models, copies of unsaved work.
pub(super) const DATA: &str = "/Data";
/// The folder of files that the user brought along or saved.
pub(super) const FILES: &str = "/Files";
/// The folder whose files are handed to the browser as downloads.
pub(super) const DOWNLOADS: &str = "/Downloads";
/// Why a file is not written.
pub(super) const NO_ROOM: &str = "the browser has no room for more files of this page";

/// What lies at a path.
#[derive(Clone, Debug)]
enum Node {
    Folder(SystemTime),
    File(Arc<Mutex<Content>>),
}

#[derive(Debug)]
struct Content {
    id: u64,
    bytes: Vec<u8>,
    changed: SystemTime,
    /// The path while it is locked.
    locked: Option<PathBuf>,
}

impl Content {
    fn new(bytes: Vec<u8>) -> Arc<Mutex<Self>> {
        static LAST: AtomicU64 = AtomicU64::new(0);
        let id = LAST.fetch_add(1, Ordering::Relaxed) + 1;
        Arc::new(Mutex::new(Self { id, bytes, changed: now(), locked: None }))
    }
}

type Tree = BTreeMap<PathBuf, Node>;

static TREE: LazyLock<Mutex<Tree>> = LazyLock::new(|| {
    let mut tree = Tree::new();
    for folder in ["/", DATA, FILES, DOWNLOADS, "/tmp"] {
        tree.insert(PathBuf::from(folder), Node::Folder(now()));
    }
    for (path, bytes) in page::kept() {
        let path = whole(Path::new(&path));
        for folder in path.ancestors().skip(1) {
            tree.entry(folder.to_owned()).or_insert_with(|| Node::Folder(now()));
        }
        tree.insert(path, Node::File(Content::new(bytes)));
    }
    Mutex::new(tree)
});

fn tree() -> MutexGuard<'static, Tree> {
    lock(&TREE)
}

/// A path from the root, without `.` and `..`.
fn whole(path: &Path) -> PathBuf {
    let mut whole = PathBuf::from(if path.has_root() { "/" } else { FILES });
    for part in path.components() {
        match part {
            Component::Normal(name) => whole.push(name),
            Component::ParentDir => _ = whole.pop(),
            Component::RootDir | Component::CurDir | Component::Prefix(_) => {}
        }
    }
    whole
}

fn error(kind: io::ErrorKind) -> io::Error {
    kind.into()
}

/// The files that the program has changed, until they are taken, and who hears of them.
static CHANGED: Mutex<(Vec<PathBuf>, Option<Arc<dyn Fn() + Send + Sync>>)> = Mutex::new((Vec::new(), None));

/// Calls a function after the program has changed files.
pub(super) fn tell_of_changes(wake: impl Fn() + Send + Sync + 'static) {
    lock(&CHANGED).1 = Some(Arc::new(wake));
}

/// The files that the program has changed since the last call, each once.
pub(super) fn own_changes() -> Vec<PathBuf> {
    std::mem::take(&mut lock(&CHANGED).0)
}

/// Counts a file as changed.
pub(super) fn note_change(path: &Path) {
    let mut changed = lock(&CHANGED);
    let (paths, wake) = &mut *changed;
    if !paths.iter().any(|known| known == path) {
        paths.push(path.to_owned());
    }
    if let Some(wake) = wake.clone() {
        // Not before what is being done is done.
        super::once(move || wake());
    }
}

/// True for a file that ends with the page.
fn is_fleeting(path: &Path) -> bool {
    path.starts_with("/tmp") || path.starts_with(DOWNLOADS)
}

/// True for a file that is not complete yet.
fn is_draft(path: &Path) -> bool {
    path.file_name().is_some_and(|name| name.to_string_lossy().starts_with(".lcm-"))
}

/// Locks a file for this tab. False if another one has it.
fn hold(path: &Path) -> bool {
    is_fleeting(path) || is_draft(path) || page::hold(&path.to_string_lossy())
}

/// Lets other tabs lock a file.
fn release(path: &Path) {
    if !is_fleeting(path) && !is_draft(path) {
        page::release(&path.to_string_lossy());
    }
}

/// Tells the page about a file that is complete, or gone.
fn settle(path: &Path, node: Option<&Node>) {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    if is_draft(path) || path.starts_with("/tmp") {
        return;
    }
    note_change(path);
    match node {
        None if path.starts_with(DOWNLOADS) => {}
        None => page::forget(&path.to_string_lossy()),
        Some(Node::Folder(_)) => {}
        Some(Node::File(content)) => {
            let content = lock(content);
            if path.starts_with(DOWNLOADS) {
                page::download(&name, &content.bytes);
            } else {
                page::keep(&path.to_string_lossy(), &content.bytes);
            }
        }
    }
}

/// What is known about a file or a folder.
#[derive(Clone, Debug)]
pub struct Metadata {
    id: u64,
    kind: FileType,
    length: u64,
    changed: SystemTime,
}

impl Metadata {
    fn of(node: &Node) -> Self {
        match node {
            Node::Folder(changed) => {
                Self { id: 0, kind: FileType { folder: true }, length: 0, changed: *changed }
            }
            Node::File(content) => Self::of_file(&lock(content)),
        }
    }

    fn of_file(content: &Content) -> Self {
        let Content { id, bytes, changed, .. } = content;
        Self { id: *id, kind: FileType { folder: false }, length: bytes.len() as u64, changed: *changed }
    }

    /// What identifies the file.
    pub(super) fn id(&self) -> u64 {
        self.id
    }

    /// The kind.
    #[must_use]
    pub fn file_type(&self) -> FileType {
        self.kind
    }

    /// True for a folder.
    #[must_use]
    pub fn is_dir(&self) -> bool {
        self.kind.is_dir()
    }

    /// True for a file.
    #[must_use]
    pub fn is_file(&self) -> bool {
        self.kind.is_file()
    }

    /// There are no links.
    #[must_use]
    pub fn is_symlink(&self) -> bool {
        false
    }

    /// The length in bytes.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "as of the standard library")]
    pub fn len(&self) -> u64 {
        self.length
    }

    /// When it was last changed.
    ///
    /// # Errors
    /// Returns none.
    pub fn modified(&self) -> io::Result<SystemTime> {
        Ok(self.changed)
    }

    /// Everything is permitted.
    #[must_use]
    pub fn permissions(&self) -> Permissions {
        Permissions
    }
}

/// Everything is permitted.
#[derive(Clone, Debug)]
pub struct Permissions;

impl Permissions {
    /// Everything is permitted.
    #[must_use]
    pub fn readonly(&self) -> bool {
        false
    }
}

/// A file or a folder.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FileType {
    folder: bool,
}

impl FileType {
    /// True for a folder.
    #[must_use]
    pub fn is_dir(&self) -> bool {
        self.folder
    }

    /// True for a file.
    #[must_use]
    pub fn is_file(&self) -> bool {
        !self.folder
    }

    /// There are no links.
    #[must_use]
    pub fn is_symlink(&self) -> bool {
        false
    }
}

/// Why a file was not locked.
#[derive(Debug)]
pub enum TryLockError {
    /// For another reason.
    Error(io::Error),
    /// It is locked already.
    WouldBlock,
}

impl From<TryLockError> for io::Error {
    fn from(error: TryLockError) -> Self {
        match error {
            TryLockError::Error(error) => error,
            TryLockError::WouldBlock => io::ErrorKind::WouldBlock.into(),
        }
    }
}

/// An open file.
#[derive(Debug)]
pub struct File {
    /// `None` for a folder.
    content: Option<Arc<Mutex<Content>>>,
    path: PathBuf,
    position: u64,
    appends: bool,
    written: bool,
    /// True while it holds the lock.
    locked: AtomicBool,
}

impl File {
    /// Opens a file or a folder to read it.
    ///
    /// # Errors
    /// Returns an error if it is not there.
    pub fn open(path: impl AsRef<Path>) -> io::Result<Self> {
        OpenOptions::new().read(true).open(path)
    }

    /// Opens a new file.
    ///
    /// # Errors
    /// Returns an error if something is there, or its folder is not.
    pub fn create_new(path: impl AsRef<Path>) -> io::Result<Self> {
        OpenOptions::new().read(true).write(true).create_new(true).open(path)
    }

    /// Opens a new file, or one that loses its content.
    ///
    /// # Errors
    /// Returns an error if a folder is there, or its folder is not.
    pub fn create(path: impl AsRef<Path>) -> io::Result<Self> {
        OpenOptions::new().write(true).create(true).truncate(true).open(path)
    }

    fn content(&self) -> io::Result<MutexGuard<'_, Content>> {
        self.content.as_ref().map(|content| lock(content)).ok_or_else(|| error(io::ErrorKind::IsADirectory))
    }

    /// What is known about it.
    ///
    /// # Errors
    /// Returns none.
    pub fn metadata(&self) -> io::Result<Metadata> {
        Ok(match &self.content {
            Some(content) => Metadata::of_file(&lock(content)),
            None => Metadata::of(&Node::Folder(now())),
        })
    }

    /// Locks the file until it is closed.
    ///
    /// # Errors
    /// Returns an error if it is locked already.
    pub fn try_lock(&self) -> Result<(), TryLockError> {
        let Some(content) = &self.content else { return Ok(()) };
        if self.locked.load(Ordering::Relaxed) {
            return Ok(());
        }
        let mut content = lock(content);
        if content.locked.is_some() || !hold(&self.path) {
            return Err(TryLockError::WouldBlock);
        }
        content.locked = Some(self.path.clone());
        self.locked.store(true, Ordering::Relaxed);
        Ok(())
    }

    /// Everything is in memory.
    ///
    /// # Errors
    /// Returns none.
    pub fn sync_all(&self) -> io::Result<()> {
        Ok(())
    }

    /// Everything is permitted.
    ///
    /// # Errors
    /// Returns none.
    pub fn set_permissions(&self, _permissions: Permissions) -> io::Result<()> {
        Ok(())
    }

    /// Changes the length.
    ///
    /// # Errors
    /// Returns an error for a folder.
    pub fn set_len(&self, length: u64) -> io::Result<()> {
        let mut content = self.content()?;
        content.bytes.resize(length as usize, 0);
        content.changed = now();
        Ok(())
    }
}

impl Drop for File {
    fn drop(&mut self) {
        let Some(content) = &self.content else { return };
        if self.written {
            settle(&self.path, Some(&Node::File(content.clone())));
        }
        if self.locked.load(Ordering::Relaxed) {
            let path = lock(content).locked.take();
            path.iter().for_each(|path| release(path));
        }
    }
}

impl Read for File {
    fn read(&mut self, to: &mut [u8]) -> io::Result<usize> {
        let read = {
            let content = self.content()?;
            let rest = content.bytes.get(self.position as usize..).unwrap_or_default();
            let read = rest.len().min(to.len());
            to[..read].copy_from_slice(&rest[..read]);
            read
        };
        self.position += read as u64;
        Ok(read)
    }
}

impl Write for File {
    fn write(&mut self, from: &[u8]) -> io::Result<usize> {
        if !is_fleeting(&self.path) && page::room() < from.len() as f64 {
            return Err(io::Error::new(io::ErrorKind::StorageFull, NO_ROOM));
        }
        let end = {
            let mut content = self.content()?;
            let begin = if self.appends { content.bytes.len() } else { self.position as usize };
            let end = begin + from.len();
            if content.bytes.len() < end {
                content.bytes.resize(end, 0);
            }
            content.bytes[begin..end].copy_from_slice(from);
            content.changed = now();
            end
        };
        (self.position, self.written) = (end as u64, true);
        Ok(from.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Seek for File {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        let length = self.content()?.bytes.len() as i64;
        let position = match to {
            SeekFrom::Start(position) => position as i64,
            SeekFrom::End(from) => length + from,
            SeekFrom::Current(from) => self.position as i64 + from,
        };
        self.position = u64::try_from(position).map_err(|_| error(io::ErrorKind::InvalidInput))?;
        Ok(self.position)
    }
}

/// How a file is opened.
#[derive(Clone, Debug, Default)]
pub struct OpenOptions {
    append: bool,
    truncate: bool,
    create: bool,
    create_new: bool,
}

impl OpenOptions {
    /// No options yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Every file can be read.
    pub fn read(&mut self, _read: bool) -> &mut Self {
        self
    }

    /// Every file can be written.
    pub fn write(&mut self, _write: bool) -> &mut Self {
        self
    }

    /// Whether writing appends.
    pub fn append(&mut self, append: bool) -> &mut Self {
        self.append = append;
        self
    }

    /// Whether it loses its content.
    pub fn truncate(&mut self, truncate: bool) -> &mut Self {
        self.truncate = truncate;
        self
    }

    /// Whether it is made.
    pub fn create(&mut self, create: bool) -> &mut Self {
        self.create = create;
        self
    }

    /// Whether it must be made.
    pub fn create_new(&mut self, create_new: bool) -> &mut Self {
        self.create_new = create_new;
        self
    }

    /// Opens a file, or a folder to read it.
    ///
    /// # Errors
    /// Returns an error if it is not there, or there although it must not be.
    pub fn open(&self, path: impl AsRef<Path>) -> io::Result<File> {
        let path = whole(path.as_ref());
        let mut tree = tree();
        let content = match tree.get(&path) {
            Some(_) if self.create_new => return Err(error(io::ErrorKind::AlreadyExists)),
            Some(Node::Folder(_)) => None,
            Some(Node::File(content)) => Some(content.clone()),
            None if self.create || self.create_new => {
                check_parent(&tree, &path)?;
                let content = Content::new(Vec::new());
                tree.insert(path.clone(), Node::File(content.clone()));
                Some(content)
            }
            None => return Err(error(io::ErrorKind::NotFound)),
        };
        if let Some(content) = content.as_ref().filter(|_| self.truncate) {
            lock(content).bytes.clear();
        }
        Ok(File {
            content,
            path,
            position: 0,
            appends: self.append,
            written: false,
            locked: AtomicBool::default(),
        })
    }
}

fn check_parent(tree: &Tree, path: &Path) -> io::Result<()> {
    match path.parent().and_then(|parent| tree.get(parent)) {
        Some(Node::Folder(_)) => Ok(()),
        Some(Node::File(_)) => Err(error(io::ErrorKind::NotADirectory)),
        None => Err(error(io::ErrorKind::NotFound)),
    }
}

/// The content of a file.
///
/// # Errors
/// Returns an error if there is none.
pub fn read(path: impl AsRef<Path>) -> io::Result<Vec<u8>> {
    let file = File::open(path)?;
    let bytes = file.content()?.bytes.clone();
    Ok(bytes)
}

/// The text of a file.
///
/// # Errors
/// Returns an error if there is none, or it is no text.
pub fn read_to_string(path: impl AsRef<Path>) -> io::Result<String> {
    String::from_utf8(read(path)?).map_err(|why| io::Error::new(io::ErrorKind::InvalidData, why))
}

/// Writes a file.
///
/// # Errors
/// Returns an error if its folder is not there.
pub fn write(path: impl AsRef<Path>, bytes: impl AsRef<[u8]>) -> io::Result<()> {
    File::create(path)?.write_all(bytes.as_ref())
}

/// What is known about a file or folder.
///
/// # Errors
/// Returns an error if it is not there.
pub fn metadata(path: impl AsRef<Path>) -> io::Result<Metadata> {
    tree().get(&whole(path.as_ref())).map(Metadata::of).ok_or_else(|| error(io::ErrorKind::NotFound))
}

/// As [`metadata`]: there are no links.
///
/// # Errors
/// Returns an error if it is not there.
pub fn symlink_metadata(path: impl AsRef<Path>) -> io::Result<Metadata> {
    metadata(path)
}

/// The path from the root.
///
/// # Errors
/// Returns an error if nothing is there.
pub fn canonicalize(path: impl AsRef<Path>) -> io::Result<PathBuf> {
    metadata(&path).map(|_| whole(path.as_ref()))
}

/// The path from the root, whether something is there or not.
///
/// # Errors
/// Returns none.
pub fn absolute(path: impl AsRef<Path>) -> io::Result<PathBuf> {
    Ok(whole(path.as_ref()))
}

/// There are no links.
///
/// # Errors
/// Returns an error always.
pub fn read_link(_path: impl AsRef<Path>) -> io::Result<PathBuf> {
    Err(error(io::ErrorKind::InvalidInput))
}

/// Makes a folder.
///
/// # Errors
/// Returns an error if something is there, or its parent is not.
pub fn create_dir(path: impl AsRef<Path>) -> io::Result<()> {
    let path = whole(path.as_ref());
    let mut tree = tree();
    if tree.contains_key(&path) {
        return Err(error(io::ErrorKind::AlreadyExists));
    }
    check_parent(&tree, &path)?;
    tree.insert(path, Node::Folder(now()));
    Ok(())
}

/// Makes a folder and those around it.
///
/// # Errors
/// Returns an error if a file is in the way.
pub fn create_dir_all(path: impl AsRef<Path>) -> io::Result<()> {
    let path = whole(path.as_ref());
    let mut tree = tree();
    for folder in path.ancestors() {
        if let Node::File(_) = tree.entry(folder.to_owned()).or_insert_with(|| Node::Folder(now())) {
            return Err(error(io::ErrorKind::NotADirectory));
        }
    }
    Ok(())
}

/// Makes folders.
#[derive(Debug, Default)]
pub struct DirBuilder {
    recursive: bool,
}

impl DirBuilder {
    /// No options yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Whether the folders around it are made.
    pub fn recursive(&mut self, recursive: bool) -> &mut Self {
        self.recursive = recursive;
        self
    }

    /// Makes a folder.
    ///
    /// # Errors
    /// Returns the errors of [`create_dir`].
    pub fn create(&self, path: impl AsRef<Path>) -> io::Result<()> {
        if self.recursive { create_dir_all(path) } else { create_dir(path) }
    }
}

/// Removes a file.
///
/// # Errors
/// Returns an error if there is none.
pub fn remove_file(path: impl AsRef<Path>) -> io::Result<()> {
    let path = whole(path.as_ref());
    let mut tree = tree();
    match tree.get(&path) {
        Some(Node::File(_)) => tree.remove(&path),
        Some(Node::Folder(_)) => return Err(error(io::ErrorKind::IsADirectory)),
        None => return Err(error(io::ErrorKind::NotFound)),
    };
    drop(tree);
    settle(&path, None);
    Ok(())
}

/// Removes an empty folder.
///
/// # Errors
/// Returns an error if there is none, or something is in it.
pub fn remove_dir(path: impl AsRef<Path>) -> io::Result<()> {
    let path = whole(path.as_ref());
    let mut tree = tree();
    match tree.get(&path) {
        Some(Node::Folder(_)) => {}
        Some(Node::File(_)) => return Err(error(io::ErrorKind::NotADirectory)),
        None => return Err(error(io::ErrorKind::NotFound)),
    }
    if tree.keys().any(|other| other.parent() == Some(&path)) {
        return Err(error(io::ErrorKind::DirectoryNotEmpty));
    }
    tree.remove(&path);
    Ok(())
}

/// Removes a folder and all in it.
///
/// # Errors
/// Returns an error if there is none.
pub fn remove_dir_all(path: impl AsRef<Path>) -> io::Result<()> {
    let path = whole(path.as_ref());
    let mut tree = tree();
    if !matches!(tree.get(&path), Some(Node::Folder(_))) {
        return Err(error(io::ErrorKind::NotFound));
    }
    let gone: Vec<_> = tree.extract_if(.., |at, _| at.starts_with(&path)).collect();
    drop(tree);
    gone.iter().filter(|(_, node)| matches!(node, Node::File(_))).for_each(|(at, _)| settle(at, None));
    Ok(())
}

/// Gives a file or a folder another name. A file there is replaced, and an empty folder.
///
/// # Errors
/// Returns an error if there is nothing, or it has no place there.
pub fn rename(from: impl AsRef<Path>, to: impl AsRef<Path>) -> io::Result<()> {
    let (from, to) = (whole(from.as_ref()), whole(to.as_ref()));
    let mut tree = tree();
    check_parent(&tree, &to)?;
    let is_folder = match tree.get(&from) {
        Some(node) => matches!(node, Node::Folder(_)),
        None => return Err(error(io::ErrorKind::NotFound)),
    };
    match tree.get(&to) {
        Some(Node::File(_)) if is_folder => return Err(error(io::ErrorKind::NotADirectory)),
        Some(Node::Folder(_)) if !is_folder => return Err(error(io::ErrorKind::IsADirectory)),
        Some(Node::Folder(_)) if tree.keys().any(|other| other.parent() == Some(&to)) => {
            return Err(error(io::ErrorKind::DirectoryNotEmpty));
        }
        _ => {}
    }
    let moved: Vec<_> = tree.extract_if(.., |at, _| at.starts_with(&from)).collect();
    for (at, node) in moved {
        let below = at.strip_prefix(&from).unwrap_or(Path::new(""));
        let place = if below.as_os_str().is_empty() { to.clone() } else { to.join(below) };
        if let Node::File(content) = &node {
            settle(&at, None);
            settle(&place, Some(&node));
            if let Some(locked) = &mut lock(content).locked {
                release(locked);
                hold(&place);
                locked.clone_from(&place);
            }
        }
        tree.insert(place, node);
    }
    Ok(())
}

/// An entry of a folder.
#[derive(Clone, Debug)]
pub struct DirEntry {
    path: PathBuf,
    kind: FileType,
}

impl DirEntry {
    /// The path, which begins with that of the folder.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.path.clone()
    }

    /// The name.
    #[must_use]
    pub fn file_name(&self) -> OsString {
        self.path.file_name().unwrap_or_default().to_owned()
    }

    /// The kind.
    ///
    /// # Errors
    /// Returns none.
    pub fn file_type(&self) -> io::Result<FileType> {
        Ok(self.kind)
    }

    /// What is known about it.
    ///
    /// # Errors
    /// Returns an error if it is gone.
    pub fn metadata(&self) -> io::Result<Metadata> {
        metadata(&self.path)
    }
}

/// The entries of a folder.
///
/// # Errors
/// Returns an error if there is none.
pub fn read_dir(path: impl AsRef<Path>) -> io::Result<std::vec::IntoIter<io::Result<DirEntry>>> {
    let shown = path.as_ref();
    let path = whole(shown);
    let tree = tree();
    match tree.get(&path) {
        Some(Node::Folder(_)) => {}
        Some(Node::File(_)) => return Err(error(io::ErrorKind::NotADirectory)),
        None => return Err(error(io::ErrorKind::NotFound)),
    }
    let inside = tree.iter().filter(|(at, _)| at.parent() == Some(&path));
    let entry = |(at, node): (&PathBuf, &Node)| {
        let path = shown.join(at.file_name().unwrap_or_default());
        Ok(DirEntry { path, kind: FileType { folder: matches!(node, Node::Folder(_)) } })
    };
    Ok(inside.map(entry).collect::<Vec<_>>().into_iter())
}

/// True if something is there.
pub fn is_there(path: impl AsRef<Path>) -> bool {
    metadata(path).is_ok()
}

/// True if a folder is there.
pub fn is_dir(path: impl AsRef<Path>) -> bool {
    metadata(path).is_ok_and(|there| there.is_dir())
}

/// True if a file is there.
pub fn is_file(path: impl AsRef<Path>) -> bool {
    metadata(path).is_ok_and(|there| there.is_file())
}

/// True for a link.
pub fn is_symlink(_path: impl AsRef<Path>) -> bool {
    false
}

/// Puts a file in its place, with the folders around it.
fn put(path: &Path, bytes: Vec<u8>) -> Node {
    let mut tree = tree();
    for folder in path.ancestors().skip(1) {
        tree.entry(folder.to_owned()).or_insert_with(|| Node::Folder(now()));
    }
    let node = Node::File(Content::new(bytes));
    tree.insert(path.to_owned(), node.clone());
    node
}

/// Puts a file of the user's in the folder for these. Returns its path.
pub(super) fn bring(name: &str, bytes: Vec<u8>) -> PathBuf {
    let name = Path::new(name).file_name().unwrap_or(std::ffi::OsStr::new("file"));
    let path = Path::new(FILES).join(name);
    let node = put(&path, bytes);
    settle(&path, Some(&node));
    path
}

/// Takes over what another tab has written to a file, or that it has removed it: `None`.
pub(super) fn hear(path: &Path, bytes: Option<Vec<u8>>) {
    match bytes {
        Some(bytes) => _ = put(path, bytes),
        None => _ = tree().remove(path),
    }
    note_change(path);
}
