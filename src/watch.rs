//! Watches files on disk, so that edits by other programs appear at once.
//!
//! Editors save in different ways: some write into the file, some empty it first, some write another file and
//! rename it over the old one. [`Watcher`] watches names, not files, and reports a name once it has been
//! quiet for [`QUIET`]. It does not report what changed: its user reads the file and compares.
//!
//! A separate thread receives the operating system's events for folders. Each folder is watched separately
//! and remembered with the state of its files, so that nothing is lost if folders appear, vanish and return,
//! if links lead elsewhere, or if the system drops events.

use crate::{caught::lock, files::Shown as _, platform};
use std::{
    collections::{BTreeSet, HashMap},
    path::{Path, PathBuf},
    sync::{
        Arc, Mutex,
        mpsc::{self, Receiver, RecvTimeoutError, Sender},
    },
    thread,
    time::Duration,
};

use notify::{Event, EventKind, RecursiveMode, event::ModifyKind};
use web_time::Instant;

pub(crate) use self::scan::Print;
use self::{
    scan::{Found, Place, is_temporary},
    system::{is_absent, is_reading, reason},
};

mod scan;
mod system;
#[cfg(test)]
mod tests;

/// Time without changes after which a file is reported.
pub const QUIET: Duration = Duration::from_millis(10);
/// Interval at which a file that keeps changing is reported.
pub const PATIENCE: Duration = Duration::from_millis(100);
/// Interval between checks on systems that do not report changes.
const POLL: Duration = Duration::from_millis(500);
/// Delay of an additional check after a folder vanished or appeared: pending events may refer to the folder
/// that had its name before.
const AFTERSHOCK: Duration = Duration::from_millis(100);
/// Maximum number of events read before they are handled.
const BATCH: usize = 4096;

/// Reports files that change on disk.
#[derive(Debug)]
pub struct Watcher {
    orders: Sender<Order>,
    reported: Arc<Mutex<Reported>>,
    /// What is watched where the program alone changes files.
    own: Vec<(PathBuf, Kind)>,
}

/// The thread's reports to its owner.
#[derive(Debug, Default)]
struct Reported {
    /// Files that are quiet, and when they began to change.
    changed: Vec<(Instant, PathBuf)>,
    /// The time at which the next file will be quiet.
    next: Option<Instant>,
    complaint: Option<String>,
}

/// Messages to the thread.
enum Order {
    /// Watch this path; reply when done.
    Add(PathBuf, Kind, Sender<()>),
    /// Stop watching this path; reply when done.
    Forget(PathBuf, Sender<()>),
    /// Report this file after this time.
    Remind(PathBuf, Duration),
    /// An event from the operating system.
    Heard(notify::Result<Event>),
    Stop,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Folder,
    File,
}

type Backend = Box<dyn notify::Watcher + Send>;

impl Watcher {
    /// A watcher of nothing yet. `wake` is called from another thread whenever there is something new: files
    /// that [`changed`](Self::changed), or another [`complaint`](Self::complaint).
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        if !platform::SHARES_FILES {
            platform::tell_of_changes(wake);
            return Self { orders: mpsc::channel().0, reported: Arc::default(), own: Vec::new() };
        }
        Self::with_backend(wake, |news| {
            let hear = move |event: notify::Result<Event>| {
                // Reading changes nothing.
                if !matches!(&event, Ok(e) if is_reading(e.kind)) {
                    // Nobody listens any more after the window has closed.
                    let _ = news.send(Order::Heard(event));
                }
            };
            Ok(Box::new(notify::recommended_watcher(hear)?))
        })
    }

    fn with_backend(
        wake: impl Fn() + Send + Sync + 'static,
        make: impl FnOnce(Sender<Order>) -> notify::Result<Backend>,
    ) -> Self {
        let reported = Arc::new(Mutex::new(Reported::default()));
        let (orders, received) = mpsc::channel();
        let (backend, refusal) = match make(orders.clone()) {
            Ok(backend) => (Some(backend), None),
            Err(error) => (None, Some(reason(&error))),
        };
        let mut worker = Worker {
            backend,
            refusal,
            roots: Vec::new(),
            watched: BTreeSet::new(),
            refused: false,
            waiting: Vec::new(),
            reminders: Vec::new(),
            aftershock: None,
            next_poll: None,
            reported: reported.clone(),
            wake: Box::new(wake),
        };
        let started =
            thread::Builder::new().name("file watcher".to_owned()).spawn(move || worker.run(&received));
        if let Err(error) = started {
            lock(&reported).complaint =
                Some(format!("Changes to files on disk will not be detected: {error}."));
        }
        Self { orders, reported, own: Vec::new() }
    }

    /// Watches a folder and everything below it, including links, but not hidden folders. It may not exist
    /// yet, and may be deleted and return.
    pub fn watch_folder(&mut self, folder: &Path) {
        self.add(folder, Kind::Folder);
    }

    /// Watches a file through its folder, so that atomic renames, deletion and re-creation are noticed. It
    /// may be a link, and may not exist yet.
    pub fn watch_file(&mut self, file: &Path) {
        self.add(file, Kind::File);
    }

    fn add(&mut self, path: &Path, kind: Kind) {
        if platform::SHARES_FILES {
            self.order(|done| Order::Add(path.to_owned(), kind, done));
        } else {
            self.own.push((path.to_owned(), kind));
        }
    }

    /// Stops watching a file or folder, given the name under which it is watched.
    pub fn forget(&mut self, path: &Path) {
        self.own.retain(|(own, _)| own != path);
        self.order(|done| Order::Forget(path.to_owned(), done));
    }

    /// Reports a file after a delay, whether it changes or not.
    pub fn report_later(&self, file: &Path, after: Duration) {
        // An error: the thread has ended.
        let _ = self.orders.send(Order::Remind(file.to_owned(), after));
        platform::note_change(file);
    }

    /// Files that may have changed since the last call, each once, after being quiet for [`QUIET`], or after
    /// [`PATIENCE`], the oldest change first. They include deleted and renamed files, but not temporary files
    /// and backups of editors in watched folders. Paths begin with the name under which the folder is
    /// watched.
    pub fn changed(&self) -> Vec<PathBuf> {
        let mut changed = std::mem::take(&mut lock(&self.reported).changed);
        changed.sort_by_key(|(first, _)| *first);
        let own = platform::own_changes()
            .into_iter()
            .filter(|file| self.own.iter().any(|(path, kind)| holds(path, *kind, file)));
        changed.into_iter().map(|(_, file)| file).chain(own).collect()
    }

    /// The time until the next change is due, if any. The thread then calls `wake`.
    pub fn pending(&self) -> Option<Duration> {
        lock(&self.reported).next.map(|at| at.saturating_duration_since(Instant::now()))
    }

    /// A message for the user: the system reports no changes, so files are looked at twice a second instead.
    pub fn complaint(&self) -> Option<String> {
        lock(&self.reported).complaint.clone()
    }

    /// Sends an order and waits until it is carried out.
    fn order(&self, order: impl FnOnce(Sender<()>) -> Order) {
        let (done, wait) = mpsc::channel();
        if self.orders.send(order(done)).is_ok() {
            // An error: the thread has ended.
            let _ = wait.recv();
        }
    }
}

impl Drop for Watcher {
    fn drop(&mut self) {
        let _ = self.orders.send(Order::Stop);
    }
}

/// A watched file or folder.
struct Root {
    path: PathBuf,
    kind: Kind,
    /// The files as last reported, or as found at the beginning.
    known: HashMap<PathBuf, Print>,
    /// The places where changes matter.
    places: Vec<Place>,
}

impl Root {
    fn scan(&self) -> Found {
        match self.kind {
            Kind::Folder => scan::folder(&self.path),
            Kind::File => scan::file(&self.path),
        }
    }

    /// True if the root covers a file.
    fn holds(&self, file: &Path) -> bool {
        holds(&self.path, self.kind, file)
    }
}

/// True if a root covers a file.
fn holds(path: &Path, kind: Kind, file: &Path) -> bool {
    match kind {
        Kind::Folder => file.starts_with(path),
        Kind::File => file == path,
    }
}

/// A change not reported yet.
struct Change {
    path: PathBuf,
    first: Instant,
    last: Instant,
}

impl Change {
    fn due(&self) -> Instant {
        (self.last + QUIET).min(self.first + PATIENCE)
    }
}

/// The thread.
struct Worker {
    backend: Option<Backend>,
    /// The reason why no backend is available.
    refusal: Option<String>,
    roots: Vec<Root>,
    watched: BTreeSet<PathBuf>,
    /// True if the system refuses to watch a folder.
    refused: bool,
    /// The changes to report, the oldest first.
    waiting: Vec<Change>,
    /// Paths to report anyway, and when.
    reminders: Vec<(Instant, PathBuf)>,
    aftershock: Option<Instant>,
    next_poll: Option<Instant>,
    reported: Arc<Mutex<Reported>>,
    wake: Box<dyn Fn() + Send + Sync>,
}

impl Worker {
    fn run(&mut self, orders: &Receiver<Order>) {
        loop {
            let at = [self.next_report(), self.aftershock, self.next_poll].into_iter().flatten().min();
            let order = match at {
                None => orders.recv().map_err(|_| RecvTimeoutError::Disconnected),
                Some(at) => orders.recv_timeout(at.saturating_duration_since(Instant::now())),
            };
            let mut rescan = false;
            let mut done = Vec::new();
            let more = std::iter::from_fn(|| orders.try_recv().ok());
            let batch = match order {
                Ok(order) => Some(order).into_iter().chain(more).take(BATCH),
                Err(RecvTimeoutError::Timeout) => None.into_iter().chain(more).take(0),
                Err(RecvTimeoutError::Disconnected) => return,
            };
            for order in batch {
                match order {
                    Order::Add(path, kind, ready) => {
                        self.add(path, kind);
                        done.push(ready);
                    }
                    Order::Forget(path, ready) => {
                        self.forget(&path);
                        done.push(ready);
                    }
                    Order::Heard(Ok(event)) => rescan |= self.hear(&event),
                    Order::Remind(file, after) => self.reminders.push((Instant::now() + after, file)),
                    // Events were lost.
                    Order::Heard(Err(_)) => rescan = true,
                    Order::Stop => return,
                }
            }
            self.catch_up(rescan || !done.is_empty());
            self.report();
            for ready in done {
                let _ = ready.send(());
            }
        }
    }

    fn add(&mut self, path: PathBuf, kind: Kind) {
        if self.roots.iter().any(|r| r.path == path && r.kind == kind) {
            return;
        }
        let mut root = Root { path, kind, known: HashMap::new(), places: Vec::new() };
        // Existing files are no news.
        root.known = root.scan().files;
        self.roots.push(root);
    }

    fn forget(&mut self, path: &Path) {
        self.roots.retain(|r| r.path != path);
        let roots = &self.roots;
        let held = |file: &Path| roots.iter().any(|r| r.holds(file));
        self.waiting.retain(|c| held(&c.path));
        self.reminders.retain(|(_, file)| held(file));
        lock(&self.reported).changed.retain(|(_, file)| held(file));
    }

    /// Handles an event from the system. True if folders must be checked.
    fn hear(&mut self, event: &Event) -> bool {
        let now = Instant::now();
        let mut rescan = event.need_rescan();
        let only_data = matches!(event.kind, EventKind::Modify(ModifyKind::Data(_)) | EventKind::Access(_));
        let mut changed = Vec::new();
        for path in &event.paths {
            if self.watched.contains(path) && !only_data {
                // A folder itself came, went or was renamed.
                rescan = true;
                self.aftershock = Some(now + AFTERSHOCK);
                continue;
            }
            let (Some(folder), Some(name)) = (path.parent(), path.file_name()) else { continue };
            let places = self.roots.iter().flat_map(|r| &r.places).filter(|p| p.folder == folder);
            for place in places {
                match &place.name {
                    None if is_temporary(name) => continue,
                    None => changed.extend(place.shown.as_ref().map(|folder| folder.join(name))),
                    Some(wanted) if wanted == name => changed.extend(place.shown.clone()),
                    Some(_) => continue,
                }
                rescan |= !only_data;
            }
        }
        for path in changed {
            self.note(path, now);
        }
        rescan
    }

    fn note(&mut self, path: PathBuf, now: Instant) {
        match self.waiting.iter_mut().find(|c| c.path == path) {
            Some(change) => change.last = now,
            None => self.waiting.push(Change { path, first: now, last: now }),
        }
    }

    /// Scans folders when an event or the clock calls for it.
    fn catch_up(&mut self, rescan: bool) {
        let now = Instant::now();
        let over = |at: Option<Instant>| at.is_some_and(|at| at <= now);
        let shaken = over(self.aftershock);
        if shaken {
            self.aftershock = None;
        }
        if rescan || shaken || over(self.next_poll) {
            self.scan(shaken);
            let polls = self.refused && !self.roots.is_empty();
            self.next_poll = polls.then(|| Instant::now() + POLL);
        }
    }

    /// Scans everything watched, notes differences, and watches the folders that exist. With `anew`, folders that
    /// seem to be watched are watched again.
    fn scan(&mut self, anew: bool) {
        if anew {
            for folder in std::mem::take(&mut self.watched) {
                self.unwatch(&folder);
            }
        }
        // The next check sees anything that appears between checking and watching.
        for _ in 0..4 {
            self.compare();
            if !self.watch_places() {
                break;
            }
        }
    }

    fn compare(&mut self) {
        let now = Instant::now();
        let mut differing = BTreeSet::new();
        for root in &mut self.roots {
            let Found { files, places } = root.scan();
            root.places = places;
            let new = files.iter().filter(|(path, print)| root.known.get(*path) != Some(print));
            let gone = root.known.keys().filter(|path| !files.contains_key(*path));
            differing.extend(new.map(|(path, _)| path).chain(gone).cloned());
        }
        for path in differing {
            self.note(path, now);
        }
    }

    /// Watches exactly the folders that matter. True if some are new.
    fn watch_places(&mut self) -> bool {
        let places = self.roots.iter().flat_map(|r| &r.places);
        let wanted: BTreeSet<_> = places.map(|p| p.folder.clone()).collect();
        let stale: Vec<_> = self.watched.difference(&wanted).cloned().collect();
        for folder in stale {
            self.unwatch(&folder);
            self.watched.remove(&folder);
        }
        let mut problem = self.refusal.clone();
        let mut new = false;
        let Some(backend) = &mut self.backend else {
            self.complain(problem);
            return false;
        };
        for folder in wanted {
            if self.watched.contains(&folder) {
                continue;
            }
            match backend.watch(&folder, RecursiveMode::NonRecursive) {
                Ok(()) => {
                    self.watched.insert(folder);
                    new = true;
                }
                Err(error) if is_absent(&error) => self.aftershock = Some(Instant::now() + AFTERSHOCK),
                Err(error) => {
                    problem = Some(format!("{}: {}", folder.shown(), reason(&error)));
                }
            }
        }
        self.complain(problem);
        new
    }

    fn unwatch(&mut self, folder: &Path) {
        if let Some(backend) = &mut self.backend {
            // The system drops a deleted folder by itself.
            let _ = backend.unwatch(folder);
        }
    }

    fn complain(&mut self, problem: Option<String>) {
        self.refused = problem.is_some();
        let complaint = problem.map(|why| {
            format!(
                "The system does not report file changes: {why}. Files are checked twice a second instead."
            )
        });
        let mut reported = lock(&self.reported);
        if reported.complaint != complaint {
            reported.complaint = complaint;
            drop(reported);
            (self.wake)();
        }
    }

    fn next_report(&self) -> Option<Instant> {
        self.waiting.iter().map(Change::due).chain(self.reminders.iter().map(|r| r.0)).min()
    }

    /// Reports the files that are quiet by now.
    fn report(&mut self) {
        let now = Instant::now();
        let (due, waiting) = std::mem::take(&mut self.waiting).into_iter().partition(|c| c.due() <= now);
        self.waiting = waiting;
        let mut due: Vec<Change> = due;
        due.retain(|change| self.take_note(&change.path));
        let reminders = self.reminders.extract_if(.., |(at, _)| *at <= now);
        due.extend(reminders.map(|(at, path)| Change { path, first: at, last: at }));
        let mut reported = lock(&self.reported);
        reported.next = self.next_report();
        let before = reported.changed.len();
        for Change { path, first, .. } in due {
            if reported.changed.iter().all(|(_, known)| *known != path) {
                reported.changed.push((first, path));
            }
        }
        let news = reported.changed.len() > before;
        drop(reported);
        if news {
            (self.wake)();
        }
    }

    /// Records the present state of a file. True if it should be reported: folders should not, nor files that
    /// appeared and vanished in the meantime.
    fn take_note(&mut self, path: &Path) -> bool {
        let print = Print::of(path);
        let mut tell = false;
        for root in self.roots.iter_mut().filter(|r| r.holds(path)) {
            let before = match print {
                Some(print) => root.known.insert(path.to_owned(), print),
                None => root.known.remove(path),
            };
            tell |= print.is_some() || before.is_some();
        }
        tell
    }
}
