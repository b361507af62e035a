//! Background work in threads.

use std::{
    io, panic,
    sync::{
        Arc, Condvar, Mutex,
        mpsc::{Receiver, RecvTimeoutError},
    },
    thread,
    time::Duration,
};

use super::super::next::Next;
use crate::caught::{lock, unpoisoned};

/// Background work in steps.
#[derive(Clone, Debug)]
pub struct Worker(Arc<Bell>);

#[derive(Debug, Default)]
struct Bell {
    rung: Mutex<bool>,
    heard: Condvar,
}

impl Bell {
    fn wait(&self, most: Option<Duration>) {
        let silent = |rung: &mut bool| !*rung;
        let rung = lock(&self.rung);
        *match most {
            None => unpoisoned(self.heard.wait_while(rung, silent)),
            Some(most) => unpoisoned(self.heard.wait_timeout_while(rung, most, silent)).0,
        } = false;
    }
}

impl Worker {
    /// Starts work whose steps say when the next follows.
    ///
    /// # Errors
    /// Returns an error if there is no thread for it.
    pub fn start(name: &str, mut step: impl FnMut() -> Next + Send + 'static) -> io::Result<Self> {
        let bell = Arc::<Bell>::default();
        let theirs = bell.clone();
        thread::Builder::new().name(name.to_owned()).spawn(move || {
            loop {
                match step() {
                    Next::Now => {}
                    Next::After(wait) => theirs.wait(Some(wait)),
                    Next::Woken => theirs.wait(None),
                    Next::Never => return,
                }
            }
        })?;
        Ok(Self(bell))
    }

    /// Lets the next step follow at once.
    pub fn wake(&self) {
        *lock(&self.0.rung) = true;
        self.0.heard.notify_all();
    }
}

/// Does some work in the background.
pub fn once(work: impl FnOnce() + Send + 'static) {
    thread::spawn(work);
}

/// Does some work in the background after a time.
pub fn later(wait: Duration, work: impl FnOnce() + Send + 'static) {
    thread::spawn(move || {
        thread::sleep(wait);
        work();
    });
}

/// The next value of background work, for which this waits at most so long.
///
/// # Errors
/// Returns an error if there is none by then, or will be none.
pub fn receive<T>(from: &Receiver<T>, patience: Duration) -> Result<T, RecvTimeoutError> {
    from.recv_timeout(patience)
}

/// Does some work in the background while something else is done.
pub fn beside<T: Send>(work: impl FnOnce() -> T + Send, meanwhile: impl FnOnce()) -> T {
    thread::scope(|scope| {
        let work = scope.spawn(work);
        meanwhile();
        work.join().unwrap_or_else(|panic| panic::resume_unwind(panic))
    })
}

/// Calls a function in a thread of this name, on a stack of this many bytes; `None` if it panics, or if the stack cannot be allocated.
pub fn on_stack<T: Send>(name: &str, bytes: usize, call: impl FnOnce() -> T + Send) -> Option<T> {
    thread::scope(|scope| {
        let thread = thread::Builder::new().name(name.to_owned()).stack_size(bytes);
        thread.spawn_scoped(scope, call).ok()?.join().ok()
    })
}
