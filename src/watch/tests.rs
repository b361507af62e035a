//! Tests the ways in which editors save, with real files.
#![allow(clippy::unwrap_used)]

use std::{fs, fs::File, io, io::Write as _, process::Command, sync::mpsc::RecvTimeoutError};

use notify::ErrorKind;

use super::*;

/// Longer than any change takes.
const DEADLINE: Duration = Duration::from_secs(10);
/// Long enough for a wrong report to arrive.
const SILENCE: Duration = Duration::from_millis(150);

struct Bench {
    watcher: Watcher,
    woken: Receiver<()>,
    folder: tempfile::TempDir,
}

impl Bench {
    fn new() -> Self {
        let (wake, woken) = mpsc::channel();
        let watcher = Watcher::new(move || wake.send(()).unwrap_or_default());
        assert_eq!(watcher.complaint(), None);
        Self { watcher, woken, folder: tempfile::tempdir().unwrap() }
    }

    /// A watched folder with these files.
    fn folder(files: &[&str]) -> Self {
        let mut bench = Self::new();
        for file in files {
            bench.write(file, "old");
        }
        bench.watcher.watch_folder(&bench.path(""));
        bench
    }

    /// One watched file, and another one.
    fn file() -> Self {
        let mut bench = Self::new();
        bench.write("room.json", "old");
        bench.write("other.json", "old");
        bench.watcher.watch_file(&bench.path("room.json"));
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        if name.is_empty() { self.folder.path().to_owned() } else { self.folder.path().join(name) }
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }

    fn rename(&self, from: &str, to: &str) {
        fs::rename(self.path(from), self.path(to)).unwrap();
    }

    /// The next reports, as names in the folder; waits for a wake-up.
    fn news(&self) -> Vec<String> {
        let begin = Instant::now();
        loop {
            let remaining = DEADLINE.saturating_sub(begin.elapsed());
            self.woken.recv_timeout(remaining).expect("a change is reported");
            let news = self.poll();
            if !news.is_empty() {
                return news;
            }
        }
    }

    fn poll(&self) -> Vec<String> {
        let changed = self.watcher.changed();
        let short = |p: &PathBuf| p.strip_prefix(self.folder.path()).unwrap_or(p).display().to_string();
        changed.iter().map(short).collect()
    }

    /// Waits until everything named was reported, in any order, and nothing else.
    fn expect(&self, names: &[&str]) {
        let mut missing: Vec<_> = names.to_vec();
        while !missing.is_empty() {
            for name in self.news() {
                assert!(names.contains(&&*name), "{name} was reported, not only {names:?}");
                missing.retain(|m| *m != name);
            }
        }
        self.expect_only(names);
    }

    /// Checks that for a while only these are reported, again.
    fn expect_only(&self, names: &[&str]) {
        let end = Instant::now() + SILENCE;
        while let Ok(()) = self.woken.recv_timeout(end.saturating_duration_since(Instant::now())) {
            let news = self.poll();
            assert!(news.iter().all(|n| names.contains(&&**n)), "{news:?} was reported, not only {names:?}");
        }
    }

    /// Checks that for a while nothing is reported, without a wake-up.
    fn expect_silence(&self) {
        let woken = self.woken.recv_timeout(SILENCE);
        assert_eq!(woken, Err(RecvTimeoutError::Timeout), "{:?}", self.poll());
        assert!(self.poll().is_empty());
    }
}

/// Performs an action in a watched folder and around a watched file.
fn in_both(act: impl Fn(&Bench)) {
    for bench in [Bench::folder(&["room.json", "other.json"]), Bench::file()] {
        act(&bench);
        bench.expect(&["room.json"]);
    }
}

#[test]
fn a_watcher_can_be_kept_in_a_resource() {
    fn check<T: Send + Sync + 'static>() {}
    check::<Watcher>();
}

#[test]
fn rewriting_in_place_is_one_report() {
    for bench in [Bench::folder(&["room.json"]), Bench::file()] {
        bench.write("room.json", "new");
        assert_eq!(bench.news(), ["room.json"]);
        bench.expect_silence();
        // The same length, and too soon for the clock of some file systems.
        bench.write("room.json", "NEW");
        assert_eq!(bench.news(), ["room.json"]);
    }
}

#[test]
fn emptying_and_writing_like_vs_code() {
    in_both(|bench| {
        let mut file = File::create(bench.path("room.json")).unwrap();
        thread::sleep(Duration::from_millis(5));
        file.write_all(b"new").unwrap();
    });
}

#[test]
fn renaming_the_old_one_and_writing_anew_like_vim() {
    in_both(|bench| {
        bench.write("4913", "");
        fs::remove_file(bench.path("4913")).unwrap();
        bench.write(".room.json.swp", "swap");
        bench.rename("room.json", "room.json~");
        bench.write("room.json", "new");
        fs::remove_file(bench.path("room.json~")).unwrap();
    });
}

#[test]
fn writing_another_and_renaming_it_over_like_jetbrains() {
    in_both(|bench| {
        bench.write("room.json___jb_tmp___", "new");
        bench.rename("room.json", "room.json___jb_old___");
        bench.rename("room.json___jb_tmp___", "room.json");
        fs::remove_file(bench.path("room.json___jb_old___")).unwrap();
    });
}

#[test]
fn a_temporary_file_with_a_name_that_nobody_knows() {
    in_both(|bench| {
        // As Qt's safe writing does.
        bench.write("room.json.Xy12Zw", "new");
        bench.rename("room.json.Xy12Zw", "room.json");
    });
}

#[test]
fn sed_in_place() {
    in_both(|bench| {
        let sed =
            Command::new("sed").args(["-i", "s/old/new/"]).arg(bench.path("room.json")).status().unwrap();
        assert!(sed.success());
        assert_eq!(fs::read_to_string(bench.path("room.json")).unwrap(), "new");
    });
}

#[test]
fn deleting_and_writing_anew_like_git() {
    in_both(|bench| {
        bench.write(".git/index.lock", "");
        fs::remove_file(bench.path("room.json")).unwrap();
        bench.write("room.json", "new");
    });
}

#[test]
fn deletion_is_reported_and_so_is_coming_back() {
    for bench in [Bench::folder(&["room.json"]), Bench::file()] {
        fs::remove_file(bench.path("room.json")).unwrap();
        bench.expect(&["room.json"]);
        bench.write("room.json", "back");
        bench.expect(&["room.json"]);
        bench.rename("room.json", "elsewhere~");
        bench.expect(&["room.json"]);
        bench.rename("elsewhere~", "room.json");
        bench.expect(&["room.json"]);
    }
}

#[test]
fn both_names_of_a_renamed_file_are_reported() {
    let bench = Bench::folder(&["a.wgsl"]);
    bench.rename("a.wgsl", "b.wgsl");
    bench.expect(&["a.wgsl", "b.wgsl"]);
}

#[test]
fn another_file_beside_a_watched_one_wakes_nobody() {
    let bench = Bench::file();
    bench.write("other.json", "new");
    bench.write("third.json", "new");
    fs::create_dir(bench.path("folder")).unwrap();
    bench.expect_silence();
    bench.write("room.json", "new");
    bench.expect(&["room.json"]);
}

#[test]
fn reading_is_no_change() {
    let bench = Bench::folder(&["a.wgsl", "b.wgsl"]);
    fs::read(bench.path("a.wgsl")).unwrap();
    fs::read_dir(bench.path("")).unwrap().for_each(drop);
    bench.expect_silence();
}

#[test]
fn what_is_there_at_the_beginning_is_no_news() {
    Bench::folder(&["a.wgsl", "deep/b.wgsl"]).expect_silence();
    Bench::file().expect_silence();
}

#[test]
fn temporary_and_hidden_files_wake_nobody() {
    let bench = Bench::folder(&["a.wgsl"]);
    for name in
        ["a.wgsl~", ".a.wgsl.swp", "#a.wgsl#", ".#a.wgsl", "4913", "a.wgsl___jb_tmp___", "sedAb12xY", "a.tmp"]
    {
        bench.write(name, "x");
    }
    bench.write(".git/a.wgsl", "x");
    bench.expect_silence();
    // A file watched by name is reported, whatever its name.
    let mut bench = Bench::new();
    bench.watcher.watch_file(&bench.path(".room.tmp"));
    bench.write(".room.tmp", "x");
    bench.expect(&[".room.tmp"]);
}

#[test]
fn changes_are_told_oldest_first_and_each_once() {
    let bench = Bench::folder(&["a", "b", "c"]);
    for name in ["c", "a", "b", "c", "a"] {
        bench.write(name, "new");
        thread::sleep(Duration::from_millis(1));
    }
    thread::sleep(SILENCE);
    assert_eq!(bench.poll(), ["c", "a", "b"]);
    let bench = Bench::folder(&["a", "b"]);
    for _ in 0..2 {
        bench.write("a", "new");
        thread::sleep(SILENCE);
    }
    assert_eq!(bench.poll(), ["a"], "reports that nobody fetched are not piled up");
}

#[test]
fn a_file_that_is_written_all_the_time_is_reported_nevertheless() {
    let bench = Bench::folder(&["a.wgsl"]);
    let mut file = File::create(bench.path("a.wgsl")).unwrap();
    let writing = Instant::now();
    let mut reports = 0;
    while reports < 3 {
        assert!(writing.elapsed() < DEADLINE, "{reports} reports");
        file.write_all(b"more").unwrap();
        thread::sleep(QUIET / 5);
        reports += bench.poll().len();
    }
    assert!(writing.elapsed() > PATIENCE, "it was reported while it was not quiet");
}

#[test]
fn what_is_not_quiet_yet_is_pending() {
    let bench = Bench::folder(&["a.wgsl"]);
    assert_eq!(bench.watcher.pending(), None);
    let mut file = File::create(bench.path("a.wgsl")).unwrap();
    let writing = Instant::now();
    let pending = loop {
        assert!(writing.elapsed() < DEADLINE, "never pending");
        file.write_all(b"more").unwrap();
        if let Some(pending) = bench.watcher.pending() {
            break pending;
        }
    };
    assert!(pending <= QUIET);
    assert_eq!(bench.news(), ["a.wgsl"]);
    thread::sleep(SILENCE);
    assert_eq!(bench.watcher.pending(), None);
}

#[test]
fn new_folders_are_watched_with_what_is_in_them() {
    let bench = Bench::folder(&["a.wgsl"]);
    bench.write("deep/er/b.wgsl", "new");
    bench.expect(&["deep/er/b.wgsl"]);
    bench.write("deep/er/b.wgsl", "again");
    bench.expect(&["deep/er/b.wgsl"]);
    bench.rename("deep", "moved");
    bench.expect(&["deep/er/b.wgsl", "moved/er/b.wgsl"]);
    bench.write("moved/er/b.wgsl", "again");
    bench.expect(&["moved/er/b.wgsl"]);
}

#[test]
fn a_folder_may_appear_later_and_come_back() {
    let mut bench = Bench::new();
    bench.watcher.watch_folder(&bench.path("not/yet"));
    bench.watcher.watch_file(&bench.path("no/room.json"));
    bench.expect_silence();
    bench.write("not/yet/a.wgsl", "new");
    bench.write("no/room.json", "new");
    bench.expect(&["not/yet/a.wgsl", "no/room.json"]);
    for _ in 0..2 {
        fs::remove_dir_all(bench.path("not")).unwrap();
        fs::remove_dir_all(bench.path("no")).unwrap();
        bench.expect(&["not/yet/a.wgsl", "no/room.json"]);
        bench.write("not/yet/a.wgsl", "back");
        bench.write("no/room.json", "back");
        bench.expect(&["not/yet/a.wgsl", "no/room.json"]);
        bench.write("not/yet/a.wgsl", "changed");
        bench.write("no/room.json", "changed");
        bench.expect(&["not/yet/a.wgsl", "no/room.json"]);
    }
}

#[test]
fn a_folder_that_is_replaced_at_once_is_watched_still() {
    let bench = Bench::folder(&["deep/a.wgsl"]);
    for n in 0..4 {
        fs::remove_dir_all(bench.path("deep")).unwrap();
        bench.write("deep/a.wgsl", &format!("new {n}"));
        bench.expect(&["deep/a.wgsl"]);
        bench.write("deep/a.wgsl", &format!("changed {n}"));
        bench.expect(&["deep/a.wgsl"]);
    }
}

#[test]
fn a_file_is_reported_later_when_that_is_asked_for() {
    let bench = Bench::file();
    let after = Duration::from_millis(80);
    let begin = Instant::now();
    // It does not matter whether the file exists.
    for name in ["room.json", "none.json"] {
        bench.watcher.report_later(&bench.path(name), after);
    }
    let mut news = bench.news();
    assert!(begin.elapsed() >= after);
    while news.len() < 2 {
        news.extend(bench.news());
    }
    assert_eq!(news, ["room.json", "none.json"]);
    bench.expect_silence();
}

#[test]
fn what_is_forgotten_is_not_reported() {
    let mut bench = Bench::folder(&["a.wgsl"]);
    bench.write("file.json", "old");
    bench.expect(&["file.json"]);
    bench.watcher.watch_file(&bench.path("file.json"));
    bench.write("a.wgsl", "new");
    bench.watcher.forget(&bench.path(""));
    bench.poll();
    while bench.woken.try_recv().is_ok() {}
    bench.write("a.wgsl", "newer");
    bench.expect_silence();
    // Another one in the same folder stays.
    bench.write("file.json", "new");
    bench.expect(&["file.json"]);
    bench.watcher.forget(&bench.path("file.json"));
    bench.write("file.json", "newer");
    bench.expect_silence();
}

#[test]
fn a_relative_path_is_reported_as_it_was_given() {
    // Tests run in the folder of the package.
    let folder = tempfile::tempdir_in("target").or_else(|_| tempfile::tempdir_in(".")).unwrap();
    let here = std::env::current_dir().unwrap();
    let relative = folder.path().strip_prefix(&here).unwrap_or(folder.path()).join("room.json");
    let mut bench = Bench::new();
    bench.watcher.watch_file(&relative);
    fs::write(&relative, "new").unwrap();
    assert_eq!(bench.news(), [relative.display().to_string()]);
}

#[cfg(unix)]
#[test]
fn links_are_followed_and_watched() {
    use std::os::unix::fs::symlink;
    let mut bench = Bench::new();
    bench.write("real/a.wgsl", "old");
    bench.write("other/a.wgsl", "old");
    bench.write("lone/room.json", "old");
    symlink(bench.path("real"), bench.path("linked")).unwrap();
    symlink("../lone/room.json", bench.path("other/room.json")).unwrap();
    symlink(".", bench.path("real/circle")).unwrap();
    bench.watcher.watch_folder(&bench.path("linked"));
    bench.watcher.watch_file(&bench.path("other/room.json"));
    bench.write("real/a.wgsl", "new");
    bench.expect(&["linked/a.wgsl"]);
    bench.write("lone/room.json", "new");
    bench.expect(&["other/room.json"]);
    // The links lead elsewhere.
    fs::remove_file(bench.path("linked")).unwrap();
    symlink(bench.path("other"), bench.path("linked")).unwrap();
    bench.expect(&["linked/a.wgsl", "linked/room.json"]);
    bench.write("other/a.wgsl", "new");
    bench.expect(&["linked/a.wgsl"]);
    bench.write("lone/room.json", "newer");
    bench.expect(&["linked/room.json", "other/room.json"]);
    bench.write("real/a.wgsl", "newer");
    bench.expect_silence();
}

/// A system that cannot watch anything, and reports it.
struct Refusing;

impl notify::Watcher for Refusing {
    fn new<F: notify::EventHandler>(_: F, _: notify::Config) -> notify::Result<Self> {
        Ok(Self)
    }

    fn watch(&mut self, _: &Path, _: RecursiveMode) -> notify::Result<()> {
        Err(notify::Error::new(ErrorKind::MaxFilesWatch))
    }

    fn unwatch(&mut self, _: &Path) -> notify::Result<()> {
        Ok(())
    }

    fn kind() -> notify::WatcherKind {
        notify::WatcherKind::NullWatcher
    }
}

fn with_backend(make: impl FnOnce() -> notify::Result<Backend>) -> Bench {
    let (wake, woken) = mpsc::channel();
    let watcher = Watcher::with_backend(move || wake.send(()).unwrap_or_default(), |_| make());
    Bench { watcher, woken, folder: tempfile::tempdir().unwrap() }
}

#[test]
fn where_the_system_refuses_files_are_looked_at() {
    let limit = || Err(notify::Error::io(io::Error::from_raw_os_error(24)));
    for (mut bench, limit) in
        [(with_backend(|| Ok(Box::new(Refusing))), "max_user_watches"), (with_backend(limit), "watch")]
    {
        bench.write("a.wgsl", "old");
        bench.watcher.watch_folder(&bench.path(""));
        let complaint = bench.watcher.complaint().unwrap();
        assert!(complaint.contains(limit) && complaint.contains("twice a second"), "{complaint}");
        bench.write("a.wgsl", "new!");
        bench.expect(&["a.wgsl"]);
        bench.write("deep/b.wgsl", "new");
        bench.expect(&["deep/b.wgsl"]);
        fs::remove_file(bench.path("a.wgsl")).unwrap();
        bench.expect(&["a.wgsl"]);
    }
}

#[test]
fn a_system_that_never_tells_is_noticed_by_these_tests() {
    let mut bench = with_backend(|| Ok(Box::new(notify::NullWatcher)));
    bench.write("a.wgsl", "old");
    bench.watcher.watch_folder(&bench.path(""));
    bench.write("a.wgsl", "new");
    bench.expect_silence();
}
