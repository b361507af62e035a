//! A browser without a window: Chromium, driven over WebDriver (W3C), which is HTTP with JSON.

#![cfg(target_os = "linux")]

use std::{
    io::{BufRead as _, BufReader, Read as _, Write as _},
    net::TcpStream,
    path::Path,
    process::{Child, Command, Stdio},
    thread,
    time::{Duration, Instant},
};

use base64::{Engine as _, engine::general_purpose::STANDARD};
use serde_json::{Value, json};

use super::skipped::skip;

/// Chromium draws on the CPU: WebGPU by its own SwiftShader, WebGL by Mesa. Colours are not adapted to a display.
const ARGUMENTS: [&str; 9] = [
    "--headless=new",
    "--no-sandbox",
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--use-gl=angle",
    "--use-angle=gl-egl",
    "--ignore-gpu-blocklist",
    "--force-color-profile=srgb",
    "--hide-scrollbars",
];

/// Software draws a page with all models under softboxes in a minute, and in several on a busy machine.
const PATIENCE: Duration = Duration::from_secs(240);

/// A browser, closed when dropped.
pub struct Browser {
    driver: Child,
    port: u16,
    session: String,
}

impl Browser {
    /// Starts one. On other systems than Linux, tests without Chromium's driver are skipped.
    pub fn start() -> Option<Self> {
        let spawned =
            Command::new("chromedriver").arg("--port=0").stdout(Stdio::piped()).stderr(Stdio::null()).spawn();
        let mut driver = match spawned {
            Ok(driver) => driver,
            Err(error) if cfg!(target_os = "linux") => {
                panic!(
                    "chromedriver: {error}; on Debian and Ubuntu: apt-get install chromium chromium-driver"
                )
            }
            Err(error) => {
                skip(&format!("chromedriver: {error}; it comes with Chromium or Chrome"));
                return None;
            }
        };
        let output = BufReader::new(driver.stdout.take().expect("piped"));
        let port = output.lines().map_while(Result::ok).find_map(|line| {
            let (_, port) = line.split_once("successfully on port ")?;
            port.trim_end_matches('.').parse().ok()
        });
        let mut browser = Self { driver, port: port.expect("it says its port"), session: String::new() };
        let options = json!({ "goog:chromeOptions": { "args": ARGUMENTS } });
        let answer = browser.ask("POST", "", &json!({ "capabilities": { "alwaysMatch": options } }));
        browser.session = format!("/{}", answer["sessionId"].as_str().expect("an id"));
        Some(browser)
    }

    /// Sends one command; panics with the answer if it is an error.
    fn ask(&self, method: &str, path: &str, body: &Value) -> Value {
        let body = if method == "POST" { body.to_string() } else { String::new() };
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        stream.set_read_timeout(Some(PATIENCE)).expect("a timeout");
        let length = body.len();
        let session = &self.session;
        write!(
            stream,
            "{method} /session{session}{path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n\
             Content-Length: {length}\r\nConnection: close\r\n\r\n{body}"
        )
        .expect("it reads");
        let mut reader = BufReader::new(stream);
        let mut length = 0;
        loop {
            let mut line = String::new();
            reader.read_line(&mut line).expect("an answer");
            if let Some((_, value)) = line.to_lowercase().split_once("content-length:") {
                length = value.trim().parse().expect("a number");
            }
            if line.trim().is_empty() {
                break;
            }
        }
        let mut answer = vec![0; length];
        reader.read_exact(&mut answer).expect("an answer");
        let mut answer: Value = serde_json::from_slice(&answer).expect("JSON");
        let value = answer["value"].take();
        assert!(value.get("error").is_none(), "{method} {path}: {value}");
        value
    }

    /// The value returned by a function body run in the page.
    pub fn run(&self, script: &str) -> Value {
        self.ask("POST", "/execute/sync", &json!({ "script": script, "args": [] }))
    }

    /// Opens a page of an export, and waits until it has drawn, or reported why it cannot.
    pub fn open(&self, file: &Path, fragment: &str) {
        self.begin(file, fragment);
        self.settle();
        let failure = self.run("return document.getElementById('failure').textContent");
        assert_eq!(failure, "", "{}", file.display());
    }

    /// Opens a page of an export, and waits for no picture.
    pub fn begin(&self, file: &Path, fragment: &str) {
        // A change of the fragment alone would not reload it.
        self.ask("POST", "/url", &json!({ "url": "about:blank" }));
        self.visit(&format!("{}#{fragment}", file.display()));
    }

    /// Runs a script in each page that is opened from now on, before the scripts of the page.
    pub fn run_first(&self, script: &str) {
        let parameters = json!({ "source": script });
        let command = json!({ "cmd": "Page.addScriptToEvaluateOnNewDocument", "params": parameters });
        self.ask("POST", "/goog/cdp/execute", &command);
    }

    /// Opens a file, with a fragment in its address.
    pub fn visit(&self, address: &str) {
        self.ask("POST", "/url", &json!({ "url": format!("file://{address}") }));
    }

    /// Opens a page.
    pub fn go(&self, address: &str) {
        self.ask("POST", "/url", &json!({ "url": address }));
    }

    /// Lets pages take as long as tests do.
    pub fn be_patient(&self) {
        let patience = PATIENCE.as_millis() as u64;
        self.ask("POST", "/timeouts", &json!({ "script": patience, "pageLoad": patience }));
    }

    /// Presses keys together, as a user does: one after the other.
    pub fn press(&self, keys: &[char]) {
        let key = |sort: &'static str| move |key: &char| json!({ "type": sort, "value": key.to_string() });
        let down = keys.iter().map(key("keyDown"));
        let hold = std::iter::once(json!({ "type": "pause", "duration": 50 }));
        let steps: Vec<_> = down.chain(hold).chain(keys.iter().rev().map(key("keyUp"))).collect();
        self.act(&json!({ "type": "key", "id": "keys", "actions": steps }));
    }

    /// Clicks a place in the page.
    pub fn click(&self, x: u32, y: u32) {
        let pause = json!({ "type": "pause", "duration": 150 });
        let steps = json!([
            { "type": "pointerMove", "duration": 0, "x": x, "y": y, "origin": "viewport" },
            pause,
            { "type": "pointerDown", "button": 0 },
            pause,
            { "type": "pointerUp", "button": 0 },
        ]);
        let parameters = json!({ "pointerType": "mouse" });
        self.act(&json!({ "type": "pointer", "id": "mouse", "parameters": parameters, "actions": steps }));
    }

    fn act(&self, source: &Value) {
        self.ask("POST", "/actions", &json!({ "actions": [source] }));
    }

    /// The tab in front.
    pub fn tab(&self) -> Value {
        self.ask("GET", "/window", &Value::Null)
    }

    /// Opens another tab behind it.
    pub fn new_tab(&self) -> Value {
        self.ask("POST", "/window/new", &json!({ "type": "tab" }))["handle"].take()
    }

    /// Brings a tab to the front.
    pub fn show_tab(&self, tab: &Value) {
        self.ask("POST", "/window", &json!({ "handle": tab }));
    }

    /// Waits until the picture shows all settings, or the page has reported that it cannot.
    pub fn settle(&self) {
        let state = "return document.body?.dataset.state ?? null";
        self.wait(state, |state| state == "ready" || state == "failed");
    }

    /// Waits until a value satisfies a condition.
    pub fn wait(&self, script: &str, wanted: impl Fn(&Value) -> bool) -> Value {
        let begin = Instant::now();
        // Each question takes time from a page that is drawing.
        let mut pause = Duration::from_millis(10);
        loop {
            let value = self.run(script);
            if wanted(&value) {
                return value;
            }
            assert!(begin.elapsed() < PATIENCE, "{script}: {value}");
            thread::sleep(pause);
            pause = (pause * 2).min(Duration::from_millis(100));
        }
    }

    /// Resizes the page, as if on a screen of that size.
    pub fn resize(&self, width: u32, height: u32) {
        let parameters = json!({ "width": width, "height": height, "deviceScaleFactor": 1, "mobile": false });
        let command = json!({ "cmd": "Emulation.setDeviceMetricsOverride", "params": parameters });
        self.ask("POST", "/goog/cdp/execute", &command);
    }

    /// The visible page: red, green and blue of each pixel, and the width.
    pub fn look(&self) -> (Vec<u8>, usize) {
        let answer = self.ask("GET", "/screenshot", &Value::Null);
        let png = STANDARD.decode(answer.as_str().expect("base64")).expect("base64");
        rgb(&png)
    }
}

/// Red, green and blue of each pixel of a PNG file, and the width.
pub fn rgb(png: &[u8]) -> (Vec<u8>, usize) {
    let mut reader = png::Decoder::new(std::io::Cursor::new(png)).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("a size")];
    let info = reader.next_frame(&mut pixels).expect("a PNG");
    pixels.truncate(info.buffer_size());
    let channels = info.color_type.samples();
    let rgb = pixels.chunks(channels).flat_map(|p| p[..3].to_vec()).collect();
    (rgb, info.width as usize)
}

impl Drop for Browser {
    fn drop(&mut self) {
        if !self.session.is_empty() && !thread::panicking() {
            self.ask("DELETE", "", &Value::Null);
        }
        let _ = self.driver.kill();
        let _ = self.driver.wait();
    }
}
