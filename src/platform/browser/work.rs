//! Background work between the frames: each step is a task of the event loop.

use std::{
    io,
    sync::{
        Arc, Mutex,
        atomic::{AtomicBool, AtomicU32, Ordering},
        mpsc::{Receiver, RecvTimeoutError, TryRecvError},
    },
    time::Duration,
};

use wasm_bindgen::closure::Closure;

use super::{super::next::Next, page};
use crate::caught::lock;

/// Background work in steps.
#[derive(Clone)]
pub struct Worker(Arc<Plan>);

struct Plan {
    /// `None` while it is done, and after the last.
    step: Mutex<Option<Box<dyn FnMut() -> Next + Send>>>,
    /// The number of the next task: earlier ones are outdated.
    task: AtomicU32,
    /// True if it was woken while a step was done.
    woken: AtomicBool,
    name: String,
}

impl std::fmt::Debug for Worker {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_tuple("Worker").field(&self.0.name).finish()
    }
}

impl Worker {
    /// Starts work whose steps say when the next follows.
    ///
    /// # Errors
    /// Returns none.
    pub fn start(name: &str, step: impl FnMut() -> Next + Send + 'static) -> io::Result<Self> {
        let worker = Self(Arc::new(Plan {
            step: Mutex::new(Some(Box::new(step))),
            task: AtomicU32::default(),
            woken: AtomicBool::default(),
            name: name.to_owned(),
        }));
        worker.plan(Duration::ZERO);
        Ok(worker)
    }

    /// Lets the next step follow at once.
    pub fn wake(&self) {
        if lock(&self.0.step).is_some() {
            self.plan(Duration::ZERO);
        } else {
            self.0.woken.store(true, Ordering::Relaxed);
        }
    }

    fn plan(&self, wait: Duration) {
        let (worker, task) = (self.clone(), self.0.task.fetch_add(1, Ordering::Relaxed) + 1);
        later(wait, move || {
            if worker.0.task.load(Ordering::Relaxed) == task {
                worker.work();
            }
        });
    }

    fn work(&self) {
        let Some(mut step) = lock(&self.0.step).take() else { return };
        self.0.woken.store(false, Ordering::Relaxed);
        let next = step();
        if next == Next::Never {
            return;
        }
        *lock(&self.0.step) = Some(step);
        match next {
            _ if self.0.woken.load(Ordering::Relaxed) => self.plan(Duration::ZERO),
            Next::Now => self.plan(Duration::ZERO),
            Next::After(wait) => self.plan(wait),
            Next::Woken | Next::Never => {}
        }
    }
}

/// Does some work after the present task.
pub fn once(work: impl FnOnce() + Send + 'static) {
    later(Duration::ZERO, work);
}

/// Does some work after a time.
pub fn later(wait: Duration, work: impl FnOnce() + Send + 'static) {
    page::after(wait.as_secs_f64() * 1e3, &Closure::once_into_js(work));
}

/// The next value of background work, for which nobody waits.
///
/// # Errors
/// Returns an error if there is none now, or will be none.
pub fn receive<T>(from: &Receiver<T>, _patience: Duration) -> Result<T, RecvTimeoutError> {
    from.try_recv().map_err(|error| match error {
        TryRecvError::Empty => RecvTimeoutError::Timeout,
        TryRecvError::Disconnected => RecvTimeoutError::Disconnected,
    })
}

/// Does some work, and something else after it.
pub fn beside<T: Send>(work: impl FnOnce() -> T + Send, meanwhile: impl FnOnce()) -> T {
    let done = work();
    meanwhile();
    done
}

/// Calls a function on the only stack, which scripts/web makes large enough.
pub fn on_stack<T: Send>(_name: &str, _bytes: usize, call: impl FnOnce() -> T + Send) -> Option<T> {
    Some(call())
}
