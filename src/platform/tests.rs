use std::{
    io::{self, Read as _, Seek as _, SeekFrom, Write as _},
    path::Path,
    sync::{
        Arc, Mutex,
        atomic::{AtomicU32, Ordering},
        mpsc,
    },
    time::Duration,
};

use super::*;
use crate::{
    caught::lock,
    platform::{fs as disk, temporary as disk_temporary},
};

// What a browser does without its page, tested here too.
#[path = "browser/address.rs"]
mod address;
#[allow(dead_code, reason = "the window uses the rest")]
#[path = "browser/fs.rs"]
mod fs;
#[allow(dead_code, reason = "the window uses the rest")]
#[path = "browser/tabs.rs"]
mod tabs;
#[allow(dead_code, reason = "the window uses the rest")]
#[path = "browser/temporary.rs"]
mod temporary;

/// In place of the page: notes what it is asked for.
mod page {
    use std::{cell::Cell, sync::Mutex};

    use crate::caught::lock;

    pub(super) static ASKED: Mutex<Vec<String>> = Mutex::new(Vec::new());

    thread_local! {
        /// How many bytes the browser has room for.
        pub(super) static ROOM: Cell<f64> = const { Cell::new(f64::INFINITY) };
    }

    pub(super) fn room() -> f64 {
        ROOM.get()
    }

    pub(super) fn hold(path: &str) -> bool {
        ask("hold", path, &[]);
        !path.contains("elsewhere")
    }

    pub(super) fn release(path: &str) {
        ask("release", path, &[]);
    }

    fn ask(what: &str, name: &str, bytes: &[u8]) {
        lock(&ASKED).push(format!("{what} {name} {}", String::from_utf8_lossy(bytes)));
    }

    pub(super) fn kept() -> impl Iterator<Item = (String, Vec<u8>)> {
        [("/Files/rooms/kept.json".to_owned(), b"kept".to_vec())].into_iter()
    }

    pub(super) fn keep(path: &str, bytes: &[u8]) {
        ask("keep", path, bytes);
    }

    pub(super) fn forget(path: &str) {
        ask("forget", path, &[]);
    }

    pub(super) fn download(name: &str, bytes: &[u8]) {
        ask("download", name, bytes);
    }
}

/// Held by tests of kept files, whose changes the whole process shares.
static ALONE: Mutex<()> = Mutex::new(());
/// Long enough for a busy machine.
const LONG: Duration = Duration::from_secs(60);

#[test]
fn work_goes_on_when_it_says_and_when_it_is_woken() {
    let (tell, told) = mpsc::channel();
    let mut steps = 0;
    let worker = Worker::start("test", move || {
        steps += 1;
        tell.send(steps).expect("heard");
        match steps {
            1 => Next::Now,
            2 => Next::After(Duration::from_millis(1)),
            3 => Next::After(LONG),
            4 => Next::Woken,
            _ => Next::Never,
        }
    })
    .expect("started");
    let next = || told.recv_timeout(LONG / 2);
    assert_eq!([next(), next(), next()], [Ok(1), Ok(2), Ok(3)]);
    worker.wake();
    assert_eq!(next(), Ok(4), "it does not sleep on");
    worker.wake();
    assert_eq!(next(), Ok(5));
    assert_eq!(next(), Err(mpsc::RecvTimeoutError::Disconnected), "it has ended");
    worker.wake();
}

#[test]
fn work_that_is_done_once_is_done_now_or_later() {
    let count = Arc::new(AtomicU32::default());
    let (tell, told) = mpsc::channel();
    for wait in [None, Some(Duration::from_millis(1))] {
        let (count, tell) = (count.clone(), tell.clone());
        let work = move || {
            count.fetch_add(1, Ordering::SeqCst);
            tell.send(()).expect("heard");
        };
        match wait {
            None => once(work),
            Some(wait) => later(wait, work),
        }
    }
    assert_eq!([receive(&told, LONG), receive(&told, LONG)], [Ok(()), Ok(())]);
    assert_eq!(receive(&told, Duration::ZERO), Err(mpsc::RecvTimeoutError::Timeout));
    assert_eq!(count.load(Ordering::SeqCst), 2);
    drop(tell);
    assert_eq!(on_stack("test", 1 << 20, || 7), Some(7));
    assert_eq!(on_stack("test", 1 << 20, || panic!("as a test")), None::<u8>);
}

#[test]
fn time_is_that_of_people() {
    let since = now().duration_since(std::time::UNIX_EPOCH).expect("after 1970");
    assert!(since > Duration::from_secs(1_700_000_000));
}

/// What happens in a folder of the file system of this module, in words.
macro_rules! story {
    ($fs:ident, $temporary:ident, $root:expr) => {{
        let root: &Path = $root;
        let at = |name: &str| root.join(name);
        let (a, x, y) = (at("a"), at("a/x"), at("a/b/y"));
        let mut told = Vec::new();
        let mut tell = |what: &str, result: io::Result<String>| {
            told.push(format!("{what}: {:?}", result.map_err(|error| error.kind())));
        };
        let done = |result: io::Result<()>| result.map(|()| String::new());
        tell("read nothing", $fs::read_to_string(&x));
        tell("write without a folder", done($fs::write(&x, "one")));
        tell("make a folder", done($fs::create_dir(&a)));
        tell("make it again", done($fs::create_dir(&a)));
        tell("make folders", done($fs::create_dir_all(at("a/b/c"))));
        tell("write", done($fs::write(&x, "one, two")));
        tell("make a file that is there", $fs::File::create_new(&x).map(|_| String::new()));
        tell("make a folder in a file", done($fs::create_dir(at("a/x/z"))));
        tell("write a folder", done($fs::write(&a, "one")));
        tell("write less", done($fs::write(&x, "one")));
        let appended = $fs::OpenOptions::new().append(true).open(&x);
        tell("append", appended.and_then(|mut file| done(file.write_all(b", three"))));
        let part = |mut file: $fs::File| -> io::Result<String> {
            file.seek(SeekFrom::Start(5))?;
            let mut part = [0; 3];
            file.read_exact(&mut part)?;
            let end = file.seek(SeekFrom::End(-1))?;
            let about = file.metadata()?;
            let sort = (about.is_file(), about.is_dir(), about.is_symlink());
            Ok(format!("{} {end} {} {sort:?}", String::from_utf8_lossy(&part), about.len()))
        };
        tell("read a part", $fs::File::open(&x).and_then(part));
        tell("move a file to a folder", done($fs::rename(&x, at("a/b"))));
        tell("move a file", done($fs::rename(&x, &y)));
        tell("where it was", $fs::read_to_string(&x));
        tell("move a folder", done($fs::rename(at("a/b"), at("a/d"))));
        tell("move nothing", done($fs::rename(at("a/b"), at("a/e"))));
        tell("where it is now", $fs::read_to_string(at("a/d/y")));
        let locks = |file: &$fs::File| match file.try_lock() {
            Ok(()) => "mine",
            Err($fs::TryLockError::WouldBlock) => "taken",
            Err(_) => "an error",
        };
        let [one, two] = [(); 2].map(|()| $fs::File::open(at("a/d/y")).expect("there"));
        let mut held = format!("{}, {}", locks(&one), locks(&two));
        drop(one);
        held += &format!(", {}", locks(&two));
        tell("lock", Ok(held));
        let mut draft =
            $temporary::Builder::new().prefix("draft").suffix(".tmp").tempfile_in(&a).expect("made");
        draft.write_all(b"drafted").expect("written");
        let taken = draft.persist_noclobber(at("a/d/y")).map(|_| String::new());
        tell("put a draft where something is", taken.map_err(|error| error.error));
        drop($temporary::Builder::new().tempfile_in(&a).expect("made"));
        let draft = $temporary::Builder::new().tempdir_in(&a).expect("made");
        $fs::write(draft.path().join("z"), "z").expect("written");
        drop(draft);
        let names = |folder: &Path| -> io::Result<String> {
            let entries = $fs::read_dir(folder)?.collect::<io::Result<Vec<_>>>()?;
            let mut names: Vec<_> = entries
                .iter()
                .map(|entry| (entry.file_name(), entry.file_type().is_ok_and(|sort| sort.is_dir())))
                .collect();
            names.sort();
            Ok(format!("{names:?}"))
        };
        tell("list", names(&a));
        tell("list a file", names(&at("a/d/y")));
        let whole = $fs::canonicalize(at("a/d/../d/./y"));
        let root = $fs::canonicalize(root).expect("there");
        tell("whole path", whole.map(|path| path.strip_prefix(&root).expect("in it").display().to_string()));
        tell("remove what is full", done($fs::remove_dir(&a)));
        tell("remove a file", done($fs::remove_file(at("a/d/y"))));
        tell("remove it again", done($fs::remove_file(at("a/d/y"))));
        tell("remove what is empty", done($fs::remove_dir(at("a/d/c"))));
        tell("remove all", done($fs::remove_dir_all(&a)));
        tell(
            "afterwards",
            Ok(format!("{} {} {}", $fs::is_there(&a), $fs::is_dir(&root), $fs::is_file(&root))),
        );
        told
    }};
}

#[test]
fn files_in_memory_are_like_those_on_disk() {
    if !cfg!(unix) {
        // Other systems have other errors.
        return;
    }
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(Path::new("/tmp/story")).expect("made");
    let [there, here] =
        [story!(disk, disk_temporary, folder.path()), story!(fs, temporary, Path::new("/tmp/story"))];
    assert_eq!(there, here);
    let errors = here.iter().filter(|line| line.contains("Err(")).count();
    assert!(here.len() > 25 && errors > 10 && errors < here.len() / 2, "{here:#?}");
}

/// What the page was asked for about files with this in their names.
fn asked(of: &str) -> Vec<String> {
    lock(&page::ASKED).iter().filter(|line| line.contains(of)).cloned().collect()
}

#[test]
fn a_page_keeps_whole_files_and_downloads_results() {
    let _alone = lock(&ALONE);
    assert_eq!(fs::read_to_string("rooms/kept.json").expect("kept by the page"), "kept");
    let (tell, told) = mpsc::channel();
    fs::tell_of_changes(move || _ = tell.send(()));
    fs::write("/Files/.lcm-lamp", "lamp").expect("written");
    assert_eq!(asked("lamp"), Vec::<String>::new(), "a draft");
    fs::rename("/Files/.lcm-lamp", "/Files/lamp.json").expect("moved");
    assert_eq!(receive(&told, LONG), Ok(()));
    let own = fs::own_changes();
    assert!(own.contains(&"/Files/lamp.json".into()) && fs::own_changes().is_empty(), "{own:?}");
    fs::remove_file("/Files/lamp.json").expect("removed");
    fs::write("/Downloads/lamp.png", "pixels").expect("written");
    assert_eq!(fs::bring("/etc/lamp.obj", b"mesh".to_vec()), Path::new("/Files/lamp.obj"));
    let expected = [
        "keep /Files/lamp.json lamp",
        "forget /Files/lamp.json ",
        "download lamp.png pixels",
        "keep /Files/lamp.obj mesh",
    ];
    assert_eq!(asked("lamp"), expected);
}

#[test]
fn what_another_tab_writes_arrives_and_neither_overwrites_the_other() {
    let _alone = lock(&ALONE);
    let (name, room) = ("/Files/tabs/room.json", Path::new("/Files/tabs/room.json"));
    let id = || fs::metadata(room).expect("there").id();
    assert_eq!(tabs::happened("written", name, b"first".to_vec()), None);
    let first = id();
    assert_eq!(tabs::happened("written", name, b"second".to_vec()), None);
    assert_ne!(id(), first, "it shows that it is another file");
    assert_eq!(fs::read_to_string(room).expect("there"), "second");
    assert!(fs::own_changes().contains(&room.to_owned()));
    // Both write before they hear of each other.
    fs::write(room, "mine").expect("written");
    match tabs::happened("clash", name, b"theirs".to_vec()) {
        Some(Notice::Warning(text)) => assert!(text.contains("room_2.json"), "{text}"),
        other => panic!("{other:?}"),
    }
    let beside = fs::read_to_string("/Files/tabs/room_2.json").expect("there");
    assert_eq!((fs::read_to_string(room).expect("there"), beside), ("theirs".to_owned(), "mine".to_owned()));
    assert_eq!(tabs::happened("clash", name, b"theirs".to_vec()), None, "this is known");
    assert_eq!(asked("tabs/room"), ["keep /Files/tabs/room.json mine", "keep /Files/tabs/room_2.json mine"]);
    // Of the program's own records, there is one of each.
    fs::write("/Data/tabs.json", "mine").expect("written");
    assert_eq!(tabs::happened("clash", "/Data/tabs.json", b"theirs".to_vec()), None);
    assert!(!fs::is_there("/Data/tabs_2.json"));
    assert_eq!(tabs::happened("removed", name, Vec::new()), None);
    assert!(!fs::is_there(room));
}

#[test]
fn a_page_says_what_was_copied_and_what_was_not() {
    let said = |what: &str, subject: &str, why: &str| tabs::happened(what, subject, why.into());
    assert_eq!(said("copied", "a link", ""), Some(Notice::Copied("a link".to_owned())));
    let why = "the page is not in front".to_owned();
    let uncopied = Some(Notice::Uncopied("a link".to_owned(), why.clone()));
    assert_eq!(said("uncopied", "a link", &format!("{why}.")), uncopied);
    let size = "Copied the picture: 728×547 pixels.".to_owned();
    assert_eq!(said("copied picture", "728×547", ""), Some(Notice::Info(size)));
    let picture = format!("The picture was not copied: {why}. Save it instead.");
    assert_eq!(said("uncopied picture", &format!("{why}."), ""), Some(Notice::Warning(picture)));
}

#[test]
fn what_the_browser_has_no_room_for_is_not_written() {
    let _alone = lock(&ALONE);
    page::ROOM.set(3.0);
    let full = |result: io::Result<()>| result.expect_err("no room").kind() == io::ErrorKind::StorageFull;
    assert!(full(fs::write("/Files/full.json", "long")));
    let draft = temporary::Builder::new().prefix(".lcm-").tempfile_in("/Files");
    assert!(full(draft.expect("made").write_all(b"long")));
    assert_eq!(asked("full.json"), Vec::<String>::new());
    fs::write("/Downloads/full.png", "long").expect("the browser does not keep it");
    page::ROOM.set(f64::INFINITY);
    fs::write("/Files/full.json", "long").expect("written");
    assert_eq!(asked("full.json"), ["keep /Files/full.json long"]);
    // The browser notices later.
    let unkept = |path: &str| tabs::happened("unkept", path, Vec::new());
    let why = fs::NO_ROOM.to_owned();
    assert_eq!(unkept("/Files/full.json"), Some(Notice::Unkept("/Files/full.json".into(), why)));
    match unkept("/Data/recovery/1-2/scene.json") {
        Some(Notice::Warning(text)) => assert!(text.contains("no recovery copy"), "{text}"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_file_that_another_tab_has_locked_is_taken() {
    let _alone = lock(&ALONE);
    fs::create_dir_all("/Data/held").expect("made");
    let open = |path: &str| fs::OpenOptions::new().create(true).open(path).expect("made");
    let taken = open("/Data/held/elsewhere").try_lock();
    assert!(matches!(taken, Err(fs::TryLockError::WouldBlock)), "{taken:?}");
    let own = open("/Data/held/.lock");
    own.try_lock().expect("free");
    fs::rename("/Data/held/.lock", "/Data/held/lock").expect("moved");
    drop(own);
    let expected = [
        "hold /Data/held/elsewhere ",
        "hold /Data/held/.lock ",
        "forget /Data/held/.lock ",
        "keep /Data/held/lock ",
        "release /Data/held/.lock ",
        "hold /Data/held/lock ",
        "release /Data/held/lock ",
    ];
    assert_eq!(asked("/held/"), expected);
}

#[test]
fn an_address_is_a_command_line() {
    let of = |query: &str| address::arguments(query, "")[1..].join(" ");
    assert_eq!(of(""), "");
    assert_eq!(of("?scene=glass_ball"), "glass_ball");
    assert_eq!(of("?lesson=06_gamma&step=2&fbclid=x"), "--lesson=06_gamma --step=2");
    assert_eq!(of("?scene=my+room%2Ejson%"), "my room.json%");
    assert_eq!(of("?scene=--capture"), "", "no option");
    assert_eq!(of("?scene=week_2%2Froom.json"), "week_2/room.json", "of the site");
    let of = |query: &str, fragment: &str| address::arguments(query, fragment)[1..].join(" ");
    assert_eq!(of("", "#scene=1.eNq_-A"), "#scene=1.eNq_-A");
    assert_eq!(of("?scene=gem&lesson=06_gamma", "#scene%3D1.e"), "gem --lesson=06_gamma", "no scene");
    assert_eq!(of("?scene=gem&lesson=06_gamma", "#scene=1.e%4Eq"), "--lesson=06_gamma #scene=1.eNq");
    assert_eq!(of("?scene=gem", "#about"), "gem");
}

#[test]
fn a_desktop_has_no_page() {
    assert_eq!((page_address(), loaded("room.json")), (None, None));
}
