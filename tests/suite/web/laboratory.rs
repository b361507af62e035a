//! The laboratory in a page, driven by keys. What it has done shows in the title, in the files that the browser keeps,
//! and in what arrives on the clipboard.

use std::{
    env, fs,
    io::{BufRead as _, BufReader, Write as _},
    net::{TcpListener, TcpStream},
    path::{Path, PathBuf},
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    thread,
};

use base64::{Engine as _, engine::general_purpose::STANDARD};
use serde_json::Value;

use crate::helpers::{browser::Browser, skipped::skip, support::root};

/// Names the folder of the site.
const VARIABLE: &str = "LCM_SITE";
/// One at a time: each draws in software.
static ALONE: Mutex<()> = Mutex::new(());

pub const CONTROL: char = '\u{e009}';
pub const SHIFT: char = '\u{e008}';
pub const ALT: char = '\u{e00a}';
pub const ENTER: char = '\u{e007}';
pub const BACKSPACE: char = '\u{e003}';
pub const RIGHT: char = '\u{e014}';
pub const F8: char = '\u{e038}';

/// The size of the page, if a test needs no other.
pub const SIZE: [u32; 2] = [1280, 720];

/// The laboratory in a browser.
pub struct Laboratory {
    pub browser: Browser,
    /// The address of the site.
    pub site: String,
    _alone: MutexGuard<'static, ()>,
}

impl Laboratory {
    /// A browser without the page yet. Without a site, the test is skipped.
    pub fn start([width, height]: [u32; 2]) -> Option<Self> {
        let Some(folder) = env::var_os(VARIABLE) else {
            skip(&format!(
                "scripts/web FOLDER builds the site, and {VARIABLE}=FOLDER, a whole path, names it"
            ));
            return None;
        };
        let alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
        let site = format!("http://localhost:{}/", serve(PathBuf::from(folder)));
        let browser = Browser::start()?;
        browser.be_patient();
        browser.run_first(include_str!("first.js"));
        browser.resize(width, height);
        Some(Self { browser, site, _alone: alone })
    }

    /// The laboratory as it is without a link.
    pub fn open() -> Option<Self> {
        let laboratory = Self::start(SIZE)?;
        laboratory.visit("");
        Some(laboratory)
    }

    /// Opens a page of the site whose address ends so, and waits for the first picture.
    pub fn visit(&self, end: &str) {
        self.visit_at(&format!("{}{end}", self.site));
    }

    pub fn visit_at(&self, address: &str) {
        self.load(address);
        self.wait_for_picture();
    }

    /// Opens a page, and waits for no picture.
    pub fn load(&self, address: &str) {
        self.browser.go("about:blank");
        self.browser.go(address);
    }

    pub fn wait_for_picture(&self) {
        // Where no picture comes, the page says why.
        let shown = "const of = (id) => document.getElementById(id); return of('before')?.hidden || of('said')?.textContent";
        self.browser.wait(shown, |shown| *shown == true);
        self.frames();
    }

    /// Waits for a few frames: what was typed has arrived, and what it opened is there.
    pub fn frames(&self) {
        self.browser.run(
            "return new Promise((done) => {
                let left = 12;
                const next = () => (left-- > 0 ? requestAnimationFrame(next) : done());
                next();
            })",
        );
    }

    /// Presses keys together, and waits for some frames.
    pub fn press(&self, keys: &[char]) {
        self.browser.press(keys);
        self.frames();
    }

    pub fn write(&self, text: &str) {
        text.chars().for_each(|letter| self.browser.press(&[letter]));
        self.frames();
    }

    /// Runs the command that the finder offers first.
    pub fn find(&self, words: &str) {
        self.press(&[CONTROL, 'f']);
        self.write(words);
        self.press(&[ENTER]);
    }

    pub fn title(&self) -> String {
        text(&self.browser.run("return document.title"))
    }

    pub fn wait_for_title(&self, wanted: impl Fn(&str) -> bool) {
        self.browser.wait("return document.title", |title| wanted(title.as_str().unwrap_or_default()));
    }

    /// Waits until the title shows unsaved work, or none.
    pub fn wait_for_unsaved(&self, unsaved: bool) {
        self.wait_for_title(|title| title.contains('•') == unsaved);
    }

    /// Waits until the files that the browser keeps satisfy a condition: an object with their texts.
    pub fn wait_for_files(&self, wanted: impl Fn(&Value) -> bool) -> Value {
        self.browser.wait(FILES, wanted)
    }

    pub fn files(&self) -> Value {
        self.browser.run(FILES)
    }

    /// The value of a part of what the tests see.
    pub fn seen(&self, what: &str) -> Value {
        self.browser.run(&format!("return seen.{what}"))
    }

    /// Does something, and returns the text that it copies.
    pub fn copied_by(&self, act: impl Fn()) -> String {
        let before = list(&self.seen("copied")).len();
        act();
        let copied = self.browser.wait("return seen.copied", |copied| list(copied).len() > before);
        list(&copied).last().map(text).expect("one more")
    }

    /// The link to the scene, copied by its command.
    pub fn link(&self) -> String {
        self.copied_by(|| self.find("copy link scene"))
    }

    /// The messages in their panel, which is in front, by its button *Copy all*.
    pub fn messages(&self) -> String {
        self.copied_by(|| {
            self.browser.click(44, 592);
            self.frames();
        })
    }

    /// The picture as *Copy the picture* gives it: a PNG file.
    pub fn picture(&self) -> Vec<u8> {
        let before = list(&self.seen("pictures")).len();
        self.press(&[CONTROL, SHIFT, 'p']);
        self.browser.wait("return seen.pictures.length", |count| count.as_u64() > Some(before as u64));
        let picture = self.seen("pictures.at(-1)");
        STANDARD.decode(text(&picture)).expect("base64")
    }
}

const FILES: &str = r#"
return (async () => {
    const settled = (request) => new Promise((done, failed) => {
        request.onsuccess = () => done(request.result);
        request.onerror = () => failed(request.error);
    });
    const database = await settled(indexedDB.open("lights-camera-models"));
    const store = database.transaction("files").objectStore("files");
    const [paths, files] = await Promise.all([settled(store.getAllKeys()), settled(store.getAll())]);
    database.close();
    const decoder = new TextDecoder();
    return Object.fromEntries(paths.map((path, i) => [path, decoder.decode(files[i].bytes)]));
})()"#;

pub fn text(value: &Value) -> String {
    value.as_str().unwrap_or_else(|| panic!("no text: {value}")).to_owned()
}

pub fn list(value: &Value) -> &[Value] {
    value.as_array().map_or_else(|| panic!("no list: {value}"), Vec::as_slice)
}

/// The copies of unsaved scenes among the files.
pub fn copies(files: &Value) -> Vec<String> {
    let files = files.as_object().expect("an object");
    let scenes =
        files.iter().filter(|(path, _)| path.starts_with("/Data/recovery/") && path.ends_with("/scene.json"));
    scenes.map(|(_, scene)| text(scene)).collect()
}

/// Serves the site, and the scenes of the package in its folder `scenes`, as long as the test runs.
fn serve(folder: PathBuf) -> u16 {
    let listener = TcpListener::bind(("127.0.0.1", 0)).expect("a port");
    let port = listener.local_addr().expect("bound").port();
    let folder = Arc::new(folder);
    thread::spawn(move || {
        for stream in listener.incoming().flatten() {
            let folder = folder.clone();
            // A browser may leave while it is answered.
            thread::spawn(move || _ = answer(stream, &folder));
        }
    });
    port
}

fn answer(mut stream: TcpStream, folder: &Path) -> std::io::Result<()> {
    let mut lines = BufReader::new(stream.try_clone()?).lines();
    let first = lines.next().transpose()?.unwrap_or_default();
    while lines.next().transpose()?.is_some_and(|line| !line.is_empty()) {}
    let asked = first.split(' ').nth(1).unwrap_or_default();
    let name = match asked.split('?').next().unwrap_or_default().trim_start_matches('/') {
        "" => "index.html",
        name => name,
    };
    let place = if name.starts_with("scenes/") { root() } else { folder };
    let sort = match name.rsplit('.').next().unwrap_or_default() {
        "html" => "text/html",
        "js" => "text/javascript",
        "css" => "text/css",
        "svg" => "image/svg+xml",
        "webp" => "image/webp",
        _ => "application/octet-stream",
    };
    let (status, bytes) = match fs::read(place.join(name)) {
        Ok(bytes) => ("200 OK", bytes),
        Err(_) => ("404 Not Found", Vec::new()),
    };
    let length = bytes.len();
    write!(
        stream,
        "HTTP/1.1 {status}\r\nContent-Type: {sort}\r\nContent-Length: {length}\r\nConnection: close\r\n\r\n"
    )?;
    stream.write_all(&bytes)
}
