//! Long work: without the lock of Python, on the cores of this process, and ended by Ctrl+C.

use std::{
    sync::{
        Arc, Condvar, Mutex,
        atomic::{AtomicBool, Ordering},
    },
    thread,
    time::Duration,
};

use lights_camera_models::{
    caught::{catch, lock, message, unpoisoned},
    progress::Progress,
};
use pyo3::{
    exceptions::{PyMemoryError, PyRuntimeError},
    prelude::*,
};
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::bug;

/// The time after which Python is asked for signals.
const TICK: Duration = Duration::from_millis(50);

/// The threads of this process, by its number: a forked one has none of its parent's.
static POOL: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

fn pool() -> PyResult<Arc<ThreadPool>> {
    let mut place = lock(&POOL);
    let process = std::process::id();
    if let Some((_, pool)) = place.as_ref().filter(|(owner, _)| *owner == process) {
        return Ok(pool.clone());
    }
    // The end of a pool waits for its threads, which are in the parent.
    std::mem::forget(place.take());
    let pool =
        ThreadPoolBuilder::new().build().map_err(|e| PyRuntimeError::new_err(format!("no threads: {e}")))?;
    let pool = Arc::new(pool);
    *place = Some((process, pool.clone()));
    Ok(pool)
}

/// Does some work that reports its progress on another thread while this one waits for it or for Ctrl+C. Panics become
/// exceptions.
pub fn long<T: Send>(py: Python<'_>, work: impl FnOnce(&Progress) -> T + Send) -> PyResult<T> {
    until_stopped(py, |stop| {
        work(&Progress { tell: &|_, _| (), cancelled: &|| stop.load(Ordering::Relaxed) })
    })
}

/// Runs work on several threads until Ctrl+C sets the flag that it watches.
pub fn until_stopped<T: Send>(py: Python<'_>, work: impl FnOnce(&AtomicBool) -> T + Send) -> PyResult<T> {
    let pool = pool()?;
    let cancelled = AtomicBool::new(false);
    let (done, signal) = (Mutex::new(None), Condvar::new());
    let result = thread::scope(|scope| {
        let apart = || {
            let result = catch(|| pool.install(|| work(&cancelled)));
            *lock(&done) = Some(result);
            signal.notify_one();
        };
        let thread = thread::Builder::new().spawn_scoped(scope, apart);
        thread.map_err(|e| PyRuntimeError::new_err(format!("no thread could be started: {e}")))?;
        let mut interrupted = Ok(());
        loop {
            let result = py.detach(|| {
                let waited = signal.wait_timeout_while(lock(&done), TICK, |done| done.is_none());
                unpoisoned(waited).0.take()
            });
            if let Some(result) = result {
                return interrupted.map(|()| result);
            }
            if let Err(error) = py.check_signals() {
                cancelled.store(true, Ordering::Relaxed);
                interrupted = Err(error);
            }
        }
    })?;
    result.map_err(|panic| bug(message(&*panic)))
}

/// Does work that takes less time than starting a thread.
pub fn short<T: Send>(py: Python<'_>, work: impl FnOnce() -> T + Send) -> PyResult<T> {
    py.detach(|| catch(work)).map_err(|panic| bug(message(&*panic)))
}

/// Fails if so many bytes of memory cannot be had: without it, the process would end.
pub fn room(bytes: usize) -> PyResult<()> {
    let mut room = Vec::<u8>::new();
    room.try_reserve_exact(bytes)
        .map_err(|_| PyMemoryError::new_err(format!("{} MB of memory are needed", bytes / 1_000_000)))
}
