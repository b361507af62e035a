//! Reads custom models: immediately, or on a separate thread if a window must not wait.

use std::{
    collections::BTreeMap,
    path::PathBuf,
    sync::{Arc, Mutex, MutexGuard},
    time::Duration,
};

use web_time::Instant;

use crate::{
    caught::lock,
    custom,
    optics::colour::Encoding,
    parameter::Values,
    platform::{Next, Worker},
    reflection::ends::check_that_it_ends,
    registry::{CustomModel, MODELS, Registry},
    shader::{check::ShaderProblem, compose::Sources},
};

/// Minimum interval between calls of `wake`: many models are handled together.
const PACE: Duration = Duration::from_millis(100);

/// A model to read.
pub struct Job {
    /// Source path, as in messages.
    pub source: String,
    /// The file on disk.
    pub file: PathBuf,
    /// Text of the file.
    pub text: String,
    /// The texts and models with which it is read.
    pub registry: Registry,
    /// The texts to use instead if a shared file has an error.
    pub lenient: Sources,
}

/// The result of reading a model.
pub struct Done {
    /// See [`Job::source`].
    pub source: String,
    /// See [`Job::text`].
    pub text: String,
    /// The model, or its problems.
    pub result: Result<CustomModel, Vec<ShaderProblem>>,
}

impl Job {
    fn done(self) -> Done {
        let Self { source, file, text, mut registry, lenient } = self;
        let mut result = custom::read(&file, &text, &registry);
        if let Err(problems) = &result
            && problems.iter().any(|p| !p.file.starts_with(MODELS))
        {
            // The error is in a shared file, and is reported there.
            *registry.sources_mut() = lenient;
            result = custom::read(&file, &text, &registry);
        }
        if let Ok(model) = &result
            && let Err(why) = check_that_it_ends(&model.entry, &Values::default(), Encoding::Srgb)
        {
            let before = &text[..text.find("fn response").unwrap_or_default()];
            let line = before.rfind('\n').map_or(0, |i| i + 1);
            result = Err(vec![ShaderProblem::at(&source, &text, line, why.to_string())]);
        }
        Done { source, text, result }
    }
}

/// Reads models one after the other.
#[derive(Default)]
pub struct Reader {
    /// The work in the background and its state; without it, models are read immediately.
    apart: Option<(Worker, Arc<Shared>)>,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    /// Jobs by file: a newer text replaces an older one.
    jobs: BTreeMap<String, Job>,
    reading: Option<String>,
    done: Vec<Done>,
    closed: bool,
}

impl State {
    fn is_at_work(&self) -> bool {
        self.reading.is_some() || !self.jobs.is_empty()
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        lock(&self.state)
    }
}

impl Reader {
    /// A reader that reads in the background, and calls `wake` after each model.
    pub fn apart(wake: impl Fn() + Send + 'static) -> Self {
        let shared = Arc::new(Shared::default());
        let theirs = shared.clone();
        let mut told = Instant::now();
        let started = Worker::start("custom models", move || {
            let mut state = theirs.lock();
            if state.closed {
                return Next::Never;
            }
            let Some((source, job)) = state.jobs.pop_first() else { return Next::Woken };
            state.reading = Some(source);
            drop(state);
            let done = job.done();
            let mut state = theirs.lock();
            state.reading = None;
            state.done.push(done);
            let last = state.jobs.is_empty();
            drop(state);
            if last || told.elapsed() > PACE {
                told = Instant::now();
                wake();
            }
            Next::Now
        });
        // Without a thread, models are read immediately.
        Self { apart: started.ok().map(|worker| (worker, shared)) }
    }

    /// Reads a model, and returns the result, or `None` if it comes later.
    pub fn read(&self, job: Job) -> Option<Done> {
        let Some((worker, shared)) = &self.apart else { return Some(job.done()) };
        shared.lock().jobs.insert(job.source.clone(), job);
        worker.wake();
        None
    }

    /// The models read meanwhile.
    pub fn finished(&self) -> Vec<Done> {
        self.apart.as_ref().map_or_else(Vec::new, |(_, shared)| std::mem::take(&mut shared.lock().done))
    }

    /// True while a model waits to be read, or its result to be collected.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.is(|state| state.is_at_work() || !state.done.is_empty())
    }

    /// True while it reads, and will call `wake`.
    #[must_use]
    pub fn is_reading(&self) -> bool {
        self.is(|state| state.is_at_work() && state.done.is_empty())
    }

    fn is(&self, so: impl Fn(&State) -> bool) -> bool {
        self.apart.as_ref().is_some_and(|(_, shared)| so(&shared.lock()))
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        if let Some((worker, shared)) = &self.apart {
            shared.lock().closed = true;
            worker.wake();
        }
    }
}
