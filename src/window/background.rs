//! Background work of the window: one task at a time, in a separate thread, with progress and cancellation.

use std::sync::{
    Arc, Mutex,
    atomic::{AtomicBool, Ordering},
};

use crate::{
    caught::{catch, lock},
    panel::state::Running,
    platform,
    progress::Progress,
};

/// A task with a label, and its result.
#[derive(Debug)]
pub(super) struct Background<L, T> {
    state: Arc<Mutex<State<L, T>>>,
    cancelled: Arc<AtomicBool>,
}

#[derive(Debug)]
struct State<L, T> {
    running: Option<Running<L>>,
    ended: Option<T>,
}

impl<L, T> Default for Background<L, T> {
    fn default() -> Self {
        Self { state: Arc::new(Mutex::new(State { running: None, ended: None })), cancelled: Arc::default() }
    }
}

impl<L: Clone + Send + 'static, T: Send + 'static> Background<L, T> {
    /// Starts a task and returns at once; does nothing while another task runs. Calls `wake` at each step. If the task
    /// panics, `broken` is the result: the window goes on.
    pub(super) fn begin(
        &self,
        label: L,
        wake: impl Fn() + Send + 'static,
        broken: T,
        work: impl FnOnce(&Progress) -> T + Send + 'static,
    ) {
        if self.running().is_some() {
            return;
        }
        self.cancelled.store(false, Ordering::Relaxed);
        lock(&self.state).running = Some(Running { label: label.clone(), done: 0.0, step: String::new() });
        let (state, cancelled) = (self.state.clone(), self.cancelled.clone());
        platform::once(move || {
            let tell = |done: f32, step: &str| {
                lock(&state).running = Some(Running { label: label.clone(), done, step: step.to_owned() });
                wake();
            };
            let stops = || cancelled.load(Ordering::Relaxed);
            let progress = Progress { tell: &tell, cancelled: &stops };
            let ended = catch(|| work(&progress)).unwrap_or(broken);
            *lock(&state) = State { running: None, ended: Some(ended) };
            wake();
        });
    }

    /// Stops the task at its next step.
    pub(super) fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// The running task.
    pub(super) fn running(&self) -> Option<Running<L>> {
        lock(&self.state).running.clone()
    }

    /// The result of a task that has just ended.
    pub(super) fn take(&self) -> Option<T> {
        lock(&self.state).ended.take()
    }
}

#[cfg(test)]
mod tests {
    use std::thread;

    use super::*;

    fn ended<T: Send + 'static>(work: &Background<u8, T>) -> T {
        for _ in 0..2000 {
            if let Some(result) = work.take() {
                return result;
            }
            thread::sleep(std::time::Duration::from_millis(1));
        }
        panic!("it does not end");
    }

    #[test]
    fn work_runs_alone_is_stopped_and_survives_a_panic() {
        let work = Background::<u8, Result<u8, &str>>::default();
        let forever = |progress: &Progress| loop {
            if progress.step(0.5, "on and on").is_err() {
                return Err("cancelled");
            }
            thread::sleep(std::time::Duration::from_millis(1));
        };
        work.begin(1, || (), Err("broken"), forever);
        work.begin(2, || (), Err("broken"), |_| Ok(2));
        while work.running().is_none_or(|running| running.step.is_empty()) {
            thread::yield_now();
        }
        let running = work.running();
        assert_eq!(running, Some(Running { label: 1, done: 0.5, step: "on and on".to_owned() }));
        work.cancel();
        assert_eq!(ended(&work), Err("cancelled"));
        assert_eq!(work.running(), None);
        // Cancelling one task does not cancel later ones.
        work.begin(
            3,
            || (),
            Err("broken"),
            |progress| progress.step(0.0, "").map(|()| 3).map_err(|_| "cancelled"),
        );
        assert_eq!(ended(&work), Ok(3));
        work.begin(4, || (), Err("broken"), |_| panic!("as a test"));
        assert_eq!(ended(&work), Err("broken"));
    }
}
