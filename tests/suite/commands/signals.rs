//! Whatever ends the window from outside, unsaved changes survive, and the next window offers them.

#![cfg(target_os = "linux")]

use std::{
    cell::RefCell,
    fs,
    os::unix::process::ExitStatusExt as _,
    path::{Path, PathBuf},
    process::{Child, Command, ExitStatus, Stdio},
    thread,
    time::{Duration, Instant},
};

use lights_camera_models::{
    recovery::{Abandoned, Store},
    registry::Registry,
    scene::{
        Scene,
        load::{self, Defaults},
    },
};

use crate::{
    helpers::keyboard::{Key, Keyboard},
    helpers::screen::{Picture, Screen, lcm},
};

const SIGINT: i32 = 2;
/// The grey around the picture.
const SURROUND: u8 = 46;
/// Software Vulkan on a busy machine takes its time; a sleeping window would take forever.
const LONG: Duration = Duration::from_secs(60);
/// Ending is prompt. Busy machines get some more.
const PROMPT: Duration = Duration::from_secs(15);

/// A desk with a screen, a keyboard, a scene file and a folder for the program's data.
struct Desk {
    screen: Screen,
    keyboard: RefCell<Keyboard>,
    folder: tempfile::TempDir,
}

/// A running window; killed when dropped.
struct Window<'a> {
    desk: &'a Desk,
    program: Child,
    said: PathBuf,
}

impl Desk {
    fn new() -> Self {
        let screen = Screen::new(1280, 720);
        let keyboard = RefCell::new(Keyboard::new(screen.display()));
        let folder = tempfile::tempdir().expect("a folder");
        let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
        fs::copy(scenes.join("default.json"), folder.path().join("room.json")).expect("copied");
        Self { screen, keyboard, folder }
    }

    fn file(&self) -> PathBuf {
        self.folder.path().join("room.json")
    }

    /// The scene in the file.
    fn saved(&self) -> Scene {
        load::file(&self.file(), &Registry::builtin(), Defaults::Refuse).expect("legal").scene
    }

    fn command(&self, arguments: &[&str]) -> Command {
        let lcm = lcm(arguments, self.folder.path());
        // Whoever runs the tests may ignore some signals, and programs respect that.
        let mut command = Command::new("env");
        command.arg("--default-signal=INT,HUP,QUIT,TERM").arg(lcm.get_program()).args(lcm.get_args());
        for (name, value) in lcm.get_envs() {
            match value {
                Some(value) => command.env(name, value),
                None => command.env_remove(name),
            };
        }
        // Libraries complain if it is missing.
        command.env("XDG_RUNTIME_DIR", self.folder.path());
        command.env("DISPLAY", self.screen.display()).current_dir(self.folder.path()).stdin(Stdio::null());
        command
    }

    /// Starts the window.
    fn start(&self, arguments: &[&str]) -> Window<'_> {
        let said = self.folder.path().join("said");
        let log = fs::File::create(&said).expect("writable");
        let arguments = [&["view", "--size", "1280x720"], arguments].concat();
        let program = self.command(&arguments).stderr(log).spawn().expect("lcm starts");
        Window { desk: self, program, said }
    }

    /// Opens the window with the scene, and waits until it is shown.
    fn open(&self, more: &[&str]) -> Window<'_> {
        let mut window = self.start(&[&["room.json"], more].concat());
        window.until("the sphere", |p| p.at(610, 310).iter().all(|c| *c > 150));
        window
    }

    /// Starts the window, which must ask something before anything else.
    fn start_with_question(&self, arguments: &[&str]) -> Window<'_> {
        let mut window = self.start(arguments);
        window.until("a question", asks);
        // It gets the keyboard focus once it is laid out.
        window.at_rest();
        window
    }

    /// The copies left by windows that no longer run.
    fn abandoned(&self) -> Vec<Abandoned> {
        Store::new(self.folder.path().join("data/recovery")).abandoned()
    }

    /// The only copy left, which contains the scene with this model.
    fn copy(&self, model: &str) -> PathBuf {
        let mut copies = self.abandoned();
        assert_eq!(copies.len(), 1, "one copy");
        let copy = copies.remove(0);
        assert_eq!(copy.about.path.as_deref(), Some(&*self.file()));
        // The words of the default scene end with the first change that they do not describe.
        let expected = Scene { reflection_model: model.to_owned(), description: None, ..self.saved() };
        assert_eq!(copy.scene(&Registry::builtin()), Ok(expected));
        copy.journal.file()
    }

    fn press(&self, keys: &[Key]) {
        self.keyboard.borrow_mut().press(keys);
    }
}

impl Window<'_> {
    fn said(&self) -> String {
        fs::read_to_string(&self.said).expect("readable")
    }

    /// Waits until the screen satisfies a condition.
    fn until(&mut self, what: &str, shows: impl Fn(&Picture) -> bool) -> Picture {
        let begin = Instant::now();
        loop {
            let picture = self.desk.screen.look();
            if shows(&picture) {
                return picture;
            }
            let ended = self.program.try_wait().expect("the state of a child is known");
            if ended.is_some() || begin.elapsed() > LONG {
                let file = std::env::temp_dir().join("lcm_signals.png");
                picture.write(&file);
                panic!("never showed {what}; {}; ended: {ended:?}; said: {}", file.display(), self.said());
            }
            thread::sleep(Duration::from_millis(20));
        }
    }

    /// The screen once nothing moves in it: handles fade a while after the window opened.
    fn at_rest(&mut self) -> Picture {
        let (begin, mut since) = (Instant::now(), Instant::now());
        let mut last = self.desk.screen.look();
        while since.elapsed() < Duration::from_secs(3) && begin.elapsed() < LONG {
            thread::sleep(Duration::from_millis(100));
            let now = self.desk.screen.look();
            if picture_of(&now) != picture_of(&last) {
                (last, since) = (now, Instant::now());
            }
        }
        last
    }

    /// Selects a model by its key, which is an unsaved change, and waits only until the picture shows it.
    fn change(&mut self, key: Key) {
        let before = self.at_rest();
        self.desk.press(&[key]);
        self.until("another model", |p| picture_of(p) != picture_of(&before));
    }

    fn signal(&self, name: &str) {
        kill(name, self.program.id());
    }

    /// Waits for the program to end.
    fn ended(mut self) -> (ExitStatus, String) {
        let begin = Instant::now();
        loop {
            if let Some(status) = self.program.try_wait().expect("the state of a child is known") {
                return (status, self.said());
            }
            assert!(begin.elapsed() < PROMPT, "it goes on; said: {}", self.said());
            thread::sleep(Duration::from_millis(10));
        }
    }
}

impl Drop for Window<'_> {
    fn drop(&mut self) {
        let _ = self.program.kill();
        let _ = self.program.wait();
    }
}

fn kill(signal: &str, process: u32) {
    let command = format!("kill -{signal} {process}");
    assert!(Command::new("sh").args(["-c", &command]).status().expect("a shell").success(), "{command}");
}

/// The middle of the sphere.
fn picture_of(picture: &Picture) -> Vec<[u8; 3]> {
    (480..640)
        .step_by(8)
        .flat_map(|x| (300..440).step_by(8).map(move |y| (x, y)))
        .map(|(x, y)| picture.at(x, y))
        .collect()
}

/// True while a question covers and darkens the picture.
fn asks(picture: &Picture) -> bool {
    let [r, g, b] = picture.at(230, 60);
    r == g && g == b && (10..SURROUND).contains(&r)
}

/// True while the picture can be edited.
fn asks_nothing(picture: &Picture) -> bool {
    picture.at(230, 60) == [SURROUND; 3]
}

#[test]
fn ctrl_c_closes_a_window_without_unsaved_changes() {
    let desk = Desk::new();
    let window = desk.open(&[]);
    window.signal("INT");
    let (status, said) = window.ended();
    assert_eq!((status.signal(), &*said), (Some(SIGINT), ""));
    assert!(desk.abandoned().is_empty());
}

#[test]
fn ctrl_c_asks_about_unsaved_changes_and_the_answer_counts() {
    let desk = Desk::new();
    let mut window = desk.open(&[]);
    window.change(Key::Two);
    for _ in 0..2 {
        // After staying, the question is asked again the next time.
        window.signal("INT");
        window.until("a question", asks);
        desk.press(&[Key::Escape]);
        window.until("no question", asks_nothing);
        thread::sleep(Duration::from_millis(500));
    }
    window.signal("INT");
    window.until("a question", asks);
    // The first answer is to save.
    desk.press(&[Key::Return]);
    let (status, said) = window.ended();
    assert_eq!((status.signal(), &*said), (Some(SIGINT), ""));
    assert_eq!(desk.saved().reflection_model, "mod_lambert");
    assert!(desk.abandoned().is_empty());
}

#[test]
fn a_second_ctrl_c_ends_and_keeps_the_changes() {
    let desk = Desk::new();
    let mut window = desk.open(&[]);
    window.change(Key::Two);
    window.signal("INT");
    window.until("a question", asks);
    window.signal("INT");
    let (status, said) = window.ended();
    assert_eq!(status.signal(), Some(SIGINT), "{said}");
    let copy = desk.copy("mod_lambert");
    assert!(said.starts_with("ended by SIGINT") && said.contains(&copy.display().to_string()), "{said}");
    assert_eq!(desk.saved(), Scene::default());
}

#[test]
fn other_signals_end_at_once_and_keep_the_latest_change() {
    for (name, number) in [("TERM", 15), ("HUP", 1), ("QUIT", 3)] {
        let desk = Desk::new();
        let mut window = desk.open(&[]);
        window.change(Key::Two);
        // By now there may be a copy, but hardly one of this.
        window.change(Key::Three);
        window.signal(name);
        let (status, said) = window.ended();
        assert_eq!(status.signal(), Some(number), "{name}: {said}");
        let copy = desk.copy("phong");
        let expected = format!("ended by SIG{name}; ");
        assert!(said.starts_with(&expected) && said.contains(&copy.display().to_string()), "{said}");
        assert_eq!(said.lines().count(), 1, "{said}");
    }
}

#[test]
fn a_window_killed_within_a_lesson_leaves_the_own_scene() {
    let desk = Desk::new();
    let mut window = desk.open(&[]);
    window.change(Key::Two);
    // Help › Lessons, below the manual › the first one.
    for keys in [&[Key::Alt, Key::H][..], &[Key::Down], &[Key::Down], &[Key::Right], &[Key::Return]] {
        desk.press(keys);
        thread::sleep(Duration::from_secs(1));
    }
    // It is wider than the scene list.
    window.until("the lesson", |p| p.count(216..330, 560..640, |c| c == [21; 3]) > 5000);
    // This changes a scene of the lesson.
    desk.press(&[Key::Three]);
    thread::sleep(Duration::from_secs(3));
    window.signal("TERM");
    let (_, said) = window.ended();
    let copy = desk.copy("mod_lambert");
    assert!(said.contains(&copy.display().to_string()), "{said}");
}

#[test]
fn signals_work_while_the_window_hangs() {
    for (name, number) in [("TERM", 15), ("INT", SIGINT)] {
        let desk = Desk::new();
        let mut window = desk.open(&[]);
        window.change(Key::Two);
        // A screen that no longer answers blocks whoever draws on it.
        kill("STOP", desk.screen.process());
        fs::write(desk.file(), fs::read_to_string(desk.file()).expect("there") + " ").expect("writable");
        thread::sleep(Duration::from_secs(1));
        window.signal(name);
        if name == "INT" {
            thread::sleep(Duration::from_secs(1));
            assert!(window.program.try_wait().expect("known").is_none(), "the first is a wish");
            window.signal(name);
        }
        let (status, said) = window.ended();
        kill("CONT", desk.screen.process());
        assert_eq!(status.signal(), Some(number), "{said}");
        desk.copy("mod_lambert");
    }
}

#[test]
fn a_lost_screen_is_no_invalid_input_and_the_changes_are_kept() {
    // At rest, and while it draws.
    for more in [&[][..], &["--exit-after", "1000000"]] {
        let desk = Desk::new();
        let mut window = desk.open(more);
        window.change(Key::Two);
        kill("KILL", desk.screen.process());
        let (status, said) = window.ended();
        assert_eq!(status.code(), Some(3), "{said}");
        assert!(said.contains("the connection to the display was lost"), "{said}");
        assert!(!said.contains("panicked"), "{said}");
        let copy = desk.copy("mod_lambert");
        assert!(said.contains(&copy.display().to_string()), "{said}");
    }
}

#[test]
fn what_a_killed_window_left_is_offered_until_the_user_decides() {
    let desk = Desk::new();
    let mut window = desk.open(&[]);
    window.change(Key::Two);
    let copy = desk.folder.path().join("data/recovery");
    let written = |folder: &Path| {
        let sessions = fs::read_dir(folder).into_iter().flatten().flatten();
        sessions.filter(|session| session.path().join("scene.json").exists()).count()
    };
    let begin = Instant::now();
    while written(&copy) == 0 {
        assert!(begin.elapsed() < LONG, "no copy");
        thread::sleep(Duration::from_millis(50));
    }
    // A window that runs is nobody else's business.
    assert!(desk.abandoned().is_empty());
    window.signal("KILL");
    assert_eq!(window.ended().0.signal(), Some(9));
    let copy = desk.copy("mod_lambert");
    let name = copy.display().to_string();

    // There is nobody to answer.
    let output = desk.command(&["view", "--exit-after", "3"]).output().expect("lcm runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && said.contains(&name), "{said}");
    assert_eq!(desk.copy("mod_lambert"), copy);

    // Later is another time.
    let mut window = desk.start_with_question(&[]);
    desk.press(&[Key::Escape]);
    window.until("no question", asks_nothing);
    window.signal("TERM");
    assert_eq!(window.ended().1, "", "the scene that is shown is saved");
    assert_eq!(desk.copy("mod_lambert"), copy);

    // The recovered document is as unsaved as before, and belongs to the same file.
    let mut window = desk.start_with_question(&[]);
    desk.press(&[Key::Return]);
    window.until("no question", asks_nothing);
    window.signal("TERM");
    let said = window.ended().1;
    assert!(said.contains(&name), "{said}");
    assert_eq!(desk.copy("mod_lambert"), copy);
    let mut window = desk.start_with_question(&[]);
    desk.press(&[Key::Return]);
    window.until("no question", asks_nothing);
    desk.press(&[Key::Control, Key::S]);
    let begin = Instant::now();
    while desk.saved().reflection_model != "mod_lambert" || copy.exists() {
        assert!(begin.elapsed() < LONG, "not saved, or the copy stays");
        thread::sleep(Duration::from_millis(50));
    }
    window.signal("TERM");
    assert_eq!(window.ended().1, "");
    assert!(desk.abandoned().is_empty());
}

#[test]
fn a_copy_that_is_discarded_is_gone() {
    let desk = Desk::new();
    let mut window = desk.open(&[]);
    window.change(Key::Two);
    window.signal("TERM");
    window.ended();
    let copy = desk.copy("mod_lambert");
    // Also if another scene is to be shown.
    let mut window = desk.start_with_question(&["room.json"]);
    desk.press(&[Key::Tab]);
    desk.press(&[Key::Return]);
    window.until("no question", asks_nothing);
    let begin = Instant::now();
    while copy.exists() {
        assert!(begin.elapsed() < LONG, "the copy stays");
        thread::sleep(Duration::from_millis(50));
    }
    assert_eq!(desk.saved(), Scene::default());
}
