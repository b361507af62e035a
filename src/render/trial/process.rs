//! Trials in a separate process, with a time and memory budget: a driver that crashes there, or never
//! finishes, does no harm, and nobody waits for it.
//!
//! The process is this program with another command. It reads one [`Request`] per line and writes one
//! [`Answer`] per line. It is started for the first trial, and restarted after it died.

use std::{
    collections::{HashMap, VecDeque},
    hash::{DefaultHasher, Hash as _, Hasher as _},
    io::{BufRead as _, BufReader, Write as _},
    path::{Path, PathBuf},
    process::{Child, Command, ExitStatus, Stdio},
    sync::{Arc, Condvar, Mutex, MutexGuard, mpsc},
    thread,
    time::Duration,
};

use serde::{Deserialize, Serialize};
use web_time::Instant;

use super::verdict::Verdict;
/// The command of the program that tries shaders.
pub use crate::program::TRY_SHADERS as COMMAND;
use crate::{
    caught::{lock, unpoisoned},
    declared::with_defaults,
    files::{self, Shown as _, words},
    shader::{
        check::{ShaderProblem, locate},
        compose::{Composed, LineMap},
    },
};

/// Maximum time until a process is ready: software Vulkan starts within a second.
const START: Duration = Duration::from_secs(30);
/// Interval at which a working process is checked.
const WATCH: Duration = Duration::from_millis(10);
/// Minimum interval between reports of answers.
const PACE: Duration = Duration::from_millis(50);
/// Maximum number of answers kept in case they are requested again.
const KEPT: usize = 256;

with_defaults! {
    /// The limits of one trial; by default a hundred times the needs of the shipped models.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Budget {
        /// Time from the request to the answer.
        pub time: Duration = Duration::from_secs(10),
        /// Memory of the process in bytes; known only on Linux.
        pub memory: u64 = 1 << 30,
    }
}

/// A shader to be tried.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Request {
    /// Composed text.
    pub text: String,
    /// Files of which it is made.
    pub map: LineMap,
    /// True for meshes with data of their polygons.
    pub faces: bool,
    /// The object's row in the parameter table.
    pub row: Vec<u8>,
}

/// The answer of the process.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Answer {
    /// The process is ready.
    Ready,
    /// The shader is valid.
    Good,
    /// The shader is invalid.
    Bad(Box<ShaderProblem>),
}

/// A process that tries shaders, and its answers.
#[derive(Debug)]
pub struct TrialProcess {
    shared: Arc<Shared>,
}

#[derive(Debug, Default)]
struct Shared {
    state: Mutex<State>,
    news: Condvar,
}

#[derive(Debug, Default)]
struct State {
    queue: VecDeque<Waiting>,
    /// The request being tried.
    current: Option<u64>,
    answers: HashMap<u64, Kept>,
    frame: u64,
    closed: bool,
}

/// An answer that is kept.
#[derive(Debug)]
struct Kept {
    verdict: Verdict,
    /// Frame in which it was last requested.
    frame: u64,
    /// False if the shader was not tried, or only for too short a time: a request in a later frame tries it again.
    lasting: bool,
    /// True once it was given.
    given: bool,
}

#[derive(Debug)]
struct Waiting {
    key: u64,
    request: Request,
    /// Frame in which it was last requested.
    frame: u64,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        lock(&self.state)
    }
}

impl TrialProcess {
    /// A process of `program`, started when needed. `wake` is called when there are answers.
    #[must_use]
    pub fn new(program: PathBuf, budget: Budget, wake: impl Fn() + Send + 'static) -> Self {
        let shared = Arc::new(Shared::default());
        let theirs = shared.clone();
        let started = thread::Builder::new().name("trials".to_owned()).spawn(move || {
            let mut worker = Worker { shared: theirs, program, budget, process: None };
            let mut told = Instant::now();
            while let Some((key, request)) = worker.next() {
                let (verdict, lasting) = match worker.verdict(&request) {
                    Ok(answer) => answer,
                    Err(why) => (untried(&request, &format!("({why}); save it again to retry")), false),
                };
                let mut state = worker.shared.lock();
                state.current = None;
                let frame = state.frame;
                state.answers.insert(key, Kept { verdict, frame, lasting, given: false });
                let last = state.queue.is_empty();
                drop(state);
                if last || told.elapsed() > PACE {
                    told = Instant::now();
                    wake();
                }
            }
        });
        shared.lock().closed |= started.is_err();
        Self { shared }
    }

    /// The verdict on a shader, [`Verdict::NotYet`] until there is one. A shader that could not be tried is
    /// refused, and tried when it is requested again in a later frame.
    pub fn ask(&self, composed: &Composed, faces: bool, row: impl FnOnce() -> Vec<u8>) -> Verdict {
        let mut hasher = DefaultHasher::new();
        (&composed.text, faces).hash(&mut hasher);
        let key = hasher.finish();
        let mut state = self.shared.lock();
        let frame = state.frame;
        if let Some(kept) = state.answers.get_mut(&key) {
            (kept.frame, kept.given) = (frame, true);
            return kept.verdict.clone();
        }
        if state.current == Some(key) {
            return Verdict::NotYet;
        }
        if let Some(waiting) = state.queue.iter_mut().find(|w| w.key == key) {
            waiting.frame = frame;
            return Verdict::NotYet;
        }
        let request = Request { text: composed.text.clone(), map: composed.map.clone(), faces, row: row() };
        if state.closed {
            return untried(&request, "(there is no thread for it)");
        }
        state.queue.push_back(Waiting { key, request, frame });
        self.shared.news.notify_all();
        Verdict::NotYet
    }

    /// Begins a new frame: shaders that were not requested in the last one are no longer tried.
    pub fn begin_frame(&self) {
        let mut state = self.shared.lock();
        state.frame += 1;
        let frame = state.frame;
        state.queue.retain(|waiting| waiting.frame + 1 >= frame);
        state.answers.retain(|_, kept| kept.lasting || !kept.given);
        if state.answers.len() > KEPT {
            let mut used: Vec<_> = state.answers.values().map(|kept| kept.frame).collect();
            used.sort_unstable();
            let oldest = used[used.len() / 2];
            state.answers.retain(|_, kept| kept.frame > oldest);
        }
    }

    /// True while something is tried or waits for a trial.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        let state = self.shared.lock();
        !state.closed && (state.current.is_some() || !state.queue.is_empty())
    }
}

impl Drop for TrialProcess {
    fn drop(&mut self) {
        self.shared.lock().closed = true;
        self.shared.news.notify_all();
    }
}

/// Manages the process, on a separate thread.
struct Worker {
    shared: Arc<Shared>,
    program: PathBuf,
    budget: Budget,
    process: Option<Running>,
}

impl Worker {
    /// The next shader to try; `None` if there will be no more.
    fn next(&mut self) -> Option<(u64, Request)> {
        let waits = |state: &mut State| !state.closed && state.queue.is_empty();
        let mut state = unpoisoned(self.shared.news.wait_while(self.shared.lock(), waits));
        let waiting = state.queue.pop_front().filter(|_| !state.closed)?;
        state.current = Some(waiting.key);
        Some((waiting.key, waiting.request))
    }

    /// Tries a shader. Returns the answer, and false if another trial may have another; or the reason why there is none.
    fn verdict(&mut self, request: &Request) -> Result<(Verdict, bool), String> {
        let line = serde_json::to_string(request).map_err(|why| why.to_string())?;
        for attempt in 0..2 {
            let process = match self.process.take() {
                Some(process) => process,
                None => self.start()?,
            };
            let fate = self.fate(process, &line);
            let lasting = !matches!(fate, Fate::TooSlow);
            let message = match fate {
                Fate::Answered(Answer::Bad(problem)) => return Ok((Verdict::Bad(problem), true)),
                Fate::Answered(_) => return Ok((Verdict::Good, true)),
                Fate::TooSlow => {
                    let limit = self.budget.time.as_secs_f32();
                    format!(
                        "the graphics driver did not finish compiling it and drawing a small picture with it within {limit} s; is there a loop with very many iterations? The computer may also be busy; save the file again to retry"
                    )
                }
                Fate::TooLarge => {
                    let limit = self.budget.memory >> 20;
                    format!("the graphics driver needs more than {limit} MiB of memory to compile it")
                }
                // Somebody else may have ended the process, so it is asked once more.
                Fate::Died(_) if attempt == 0 => continue,
                Fate::Died(status) => {
                    let how = status.map_or_else(String::new, |status| format!(" ({status})"));
                    format!("the graphics driver crashes when it compiles it or draws with it{how}")
                }
            };
            return Ok((refused(request, message), lasting));
        }
        Err("it ended".to_owned())
    }

    /// Starts a process and waits until it is ready.
    fn start(&self) -> Result<Running, String> {
        let program = self.program.shown();
        let mut process = Running::start(&self.program)
            .map_err(|e| format!("{program} could not be started: {}", words(&e)))?;
        match process.answer(START, u64::MAX, || self.shared.lock().closed) {
            Fate::Answered(Answer::Ready) => Ok(process),
            Fate::Died(Some(status)) => Err(format!("{program} ended at once: {status}")),
            _ => Err(format!("{program} was not ready within {} s", START.as_secs())),
        }
    }

    fn fate(&mut self, mut process: Running, line: &str) -> Fate {
        process.send(line);
        let fate = process.answer(self.budget.time, self.budget.memory, || self.shared.lock().closed);
        if let Fate::Answered(_) = fate {
            self.process = Some(process);
        }
        fate
    }
}

fn untried(request: &Request, why: &str) -> Verdict {
    refused(request, format!("this could not be tested in another process {why}"))
}

fn refused(request: &Request, message: String) -> Verdict {
    Verdict::Bad(refused_whole(request, message))
}

/// A problem of a shader as a whole, reported at the model's file if the user wrote it.
#[must_use]
pub fn refused_whole(request: &Request, message: String) -> Box<ShaderProblem> {
    let composed = Composed { text: request.text.clone(), map: request.map.clone(), ..Composed::default() };
    let lines = 1..=request.text.lines().count();
    let own = |line: &usize| request.map.locate(*line).is_some_and(|(file, _)| file.starts_with("models/"));
    let of_response = |line: &usize| {
        own(line) && request.text.lines().nth(line - 1).is_some_and(|text| text.contains("fn response"))
    };
    let place = lines.clone().find(of_response).or_else(|| lines.clone().find(own)).map(|line| (line, 1));
    locate(&composed, place, message)
}

/// The outcome of a request.
enum Fate {
    Answered(Answer),
    TooSlow,
    TooLarge,
    Died(Option<ExitStatus>),
}

/// A running process, which ends when this value is dropped.
struct Running {
    child: Child,
    /// Requests for a writing thread: nobody must wait for a process that does not read.
    requests: Option<mpsc::Sender<String>>,
    answers: mpsc::Receiver<Answer>,
}

impl Running {
    fn start(program: &Path) -> std::io::Result<Self> {
        let mut command = Command::new(program);
        command.arg(COMMAND).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
        #[cfg(unix)]
        {
            use std::os::unix::process::CommandExt as _;
            // Ctrl+C in the terminal is meant for the window.
            command.process_group(0);
        }
        let mut child = command.spawn()?;
        let (requests, lines) = mpsc::channel::<String>();
        if let Some(mut input) = child.stdin.take() {
            thread::spawn(move || {
                for line in lines {
                    if writeln!(input, "{line}").and_then(|()| input.flush()).is_err() {
                        return;
                    }
                }
            });
        }
        let output = child.stdout.take();
        let (sender, answers) = mpsc::channel();
        if let Some(output) = output {
            thread::spawn(move || {
                for line in BufReader::new(output).lines().map_while(Result::ok) {
                    let Ok(answer) = serde_json::from_str(&line) else { continue };
                    if sender.send(answer).is_err() {
                        return;
                    }
                }
            });
        }
        Ok(Self { child, requests: Some(requests), answers })
    }

    fn send(&self, line: &str) {
        if let Some(requests) = &self.requests {
            // If nobody receives it, no answer comes.
            let _ = requests.send(line.to_owned());
        }
    }

    /// Waits for an answer within a budget.
    fn answer(&mut self, time: Duration, memory: u64, closed: impl Fn() -> bool) -> Fate {
        let start = Instant::now();
        loop {
            match self.answers.recv_timeout(WATCH) {
                Ok(answer) => return Fate::Answered(answer),
                Err(mpsc::RecvTimeoutError::Disconnected) => return Fate::Died(self.end()),
                Err(mpsc::RecvTimeoutError::Timeout) if closed() => return Fate::Died(self.end()),
                Err(mpsc::RecvTimeoutError::Timeout) => {
                    if start.elapsed() > time {
                        return Fate::TooSlow;
                    }
                    if resident(self.child.id()).is_some_and(|bytes| bytes > memory) {
                        return Fate::TooLarge;
                    }
                }
            }
        }
    }

    /// Ends the process, whatever its state. Returns how it ended.
    fn end(&mut self) -> Option<ExitStatus> {
        self.requests = None;
        // A process with a closed output is about to exit by itself, with a better status.
        for _ in 0..20 {
            match self.child.try_wait() {
                Ok(None) => thread::sleep(WATCH),
                Ok(Some(status)) => return Some(status),
                Err(_) => break,
            }
        }
        let _ = self.child.kill();
        self.child.wait().ok()
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// The memory of a process in bytes, where the system reports it.
fn resident(process: u32) -> Option<u64> {
    if !cfg!(target_os = "linux") {
        return None;
    }
    /// Page size of all processors on which the driver runs.
    const PAGE: u64 = 4096;
    let text = files::read(Path::new(&format!("/proc/{process}/statm")), PAGE).ok()?;
    let text = String::from_utf8_lossy(&text);
    Some(text.split(' ').nth(1)?.parse::<u64>().ok()? * PAGE)
}
