//! Reading custom models: at once, or on a thread of its own where a window must not wait for it.

use std::{
    collections::BTreeMap,
    path::PathBuf,
    sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError},
    thread,
    time::{Duration, Instant},
};

use crate::{
    custom,
    optics::colour::Encoding,
    parameter::Values,
    reflection::ends::check_that_it_ends,
    registry::{CustomModel, MODELS, Registry},
    shader::{check::ShaderProblem, compose::Sources},
};

/// The shortest time between two calls of `wake`: many models are taken together.
const PACE: Duration = Duration::from_millis(100);

/// A model to read.
pub struct Job {
    /// The source path, as messages name it.
    pub source: String,
    /// The file on disk.
    pub file: PathBuf,
    /// Its text.
    pub text: String,
    /// The texts and models to read it with.
    pub registry: Registry,
    /// The texts to read it with if a file that all models share has a mistake.
    pub lenient: Sources,
}

/// A model that was read, or why it cannot be.
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
            // The mistake is in a file that all models share, and is reported there.
            *registry.sources_mut() = lenient;
            result = custom::read(&file, &text, &registry);
        }
        if let Ok(model) = &result
            && let Err(why) = check_that_it_ends(&model.entry, &Values::default(), Encoding::Srgb)
        {
            let line = text.lines().position(|line| line.contains("fn response")).unwrap_or_default();
            result = Err(vec![ShaderProblem {
                file: source.clone(),
                line: line + 1,
                column: 1,
                source: text.lines().nth(line).unwrap_or_default().to_owned(),
                message: why.to_string(),
            }]);
        }
        Done { source, text, result }
    }
}

/// Reads models, one after the other.
#[derive(Default)]
pub struct Reader {
    /// The work of a thread of its own; without one, models are read at once.
    thread: Option<Arc<Shared>>,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    news: Condvar,
}

#[derive(Default)]
struct State {
    /// By file: a newer text replaces an older one.
    jobs: BTreeMap<String, Job>,
    reading: Option<String>,
    done: Vec<Done>,
    closed: bool,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Reader {
    /// A reader with a thread of its own, which calls `wake` after each model.
    pub fn apart(wake: impl Fn() + Send + 'static) -> Self {
        let shared = Arc::new(Shared::default());
        let theirs = shared.clone();
        let started = thread::Builder::new().name("custom models".to_owned()).spawn(move || {
            let mut told = Instant::now();
            loop {
                let mut state = theirs.lock();
                let job = loop {
                    if state.closed {
                        return;
                    }
                    if let Some((source, job)) = state.jobs.pop_first() {
                        state.reading = Some(source);
                        break job;
                    }
                    state = theirs.news.wait(state).unwrap_or_else(PoisonError::into_inner);
                };
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
            }
        });
        // Without a thread, models are read at once.
        Self { thread: started.ok().map(|_| shared) }
    }

    /// Reads a model: the outcome, or none if that comes later.
    pub fn read(&self, job: Job) -> Option<Done> {
        let Some(shared) = &self.thread else { return Some(job.done()) };
        shared.lock().jobs.insert(job.source.clone(), job);
        shared.news.notify_all();
        None
    }

    /// The models that were read meanwhile.
    pub fn finished(&self) -> Vec<Done> {
        self.thread.as_ref().map_or_else(Vec::new, |shared| std::mem::take(&mut shared.lock().done))
    }

    /// True while a model waits to be read, or for its outcome to be taken.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.thread.as_ref().is_some_and(|shared| {
            let state = shared.lock();
            state.reading.is_some() || !state.jobs.is_empty() || !state.done.is_empty()
        })
    }

    /// True while the thread works, and will wake who waits.
    #[must_use]
    pub fn is_reading(&self) -> bool {
        self.thread.as_ref().is_some_and(|shared| {
            let state = shared.lock();
            state.done.is_empty() && (state.reading.is_some() || !state.jobs.is_empty())
        })
    }
}

impl Drop for Reader {
    fn drop(&mut self) {
        if let Some(shared) = &self.thread {
            shared.lock().closed = true;
            shared.news.notify_all();
        }
    }
}
