//! Curves are calculated in the background, the coarse ones at once, the fine ones when nothing has changed for a
//! moment. It stops when the plots are no longer shown.

use std::{
    sync::{
        LazyLock, Mutex, MutexGuard,
        atomic::{AtomicU64, Ordering},
    },
    thread,
    time::Duration,
};

use rayon::{ThreadPool, ThreadPoolBuilder};
use web_time::Instant;

use super::request::{Drawn, Key, NoCurve, Recipe};
use crate::{
    caught::{catch, lock},
    curves::{Detail, Kind, Setup},
    panel::{prelude::*, state::Slot},
    platform::{Next, Worker as Background},
    progress::Progress,
};

/// Fine curves wait until nothing has changed for so long.
const REST: Duration = Duration::from_millis(120);
/// Passes of the window without the plots before they count as closed.
const PASSES: u64 = 3;

/// A few threads, so that the frames of the window have the others.
static POOL: LazyLock<Option<ThreadPool>> = LazyLock::new(|| {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    ThreadPoolBuilder::new().num_threads((cores / 4).clamp(1, 4)).build().ok()
});

/// Curves to be calculated.
pub(super) struct Job {
    pub(super) setup: Setup,
    pub(super) items: Vec<Item>,
    /// Knows the models that have the quantity, where some have not.
    pub(super) registry: Option<Registry>,
}

pub(super) struct Item {
    pub(super) slot: Slot,
    pub(super) key: Key,
    pub(super) recipe: Recipe,
    /// The coarse curve is there.
    pub(super) coarse: bool,
}

/// A curve that was calculated.
#[derive(Clone, Debug)]
pub(super) struct Done {
    pub(super) slot: Slot,
    pub(super) key: Key,
    pub(super) setup: Setup,
    pub(super) fine: bool,
    pub(super) outcome: Result<Arc<Drawn>, String>,
}

#[derive(Default)]
struct State {
    /// The newest job, until it is begun.
    job: Option<Job>,
    /// The quantity of the newest job.
    kind: Option<Kind>,
    /// The number of jobs so far.
    jobs: u64,
    done: Vec<Done>,
    /// What calculates, while it does.
    working: Option<Background>,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    /// The last pass of the window in which the plots were shown.
    pass: AtomicU64,
}

/// Calculates curves.
#[derive(Clone, Default)]
pub(super) struct Worker(Arc<Shared>);

impl Worker {
    /// The plots are shown in this pass.
    pub(super) fn shown(&self, ctx: &Context) {
        self.0.pass.store(ctx.cumulative_pass_nr(), Ordering::Relaxed);
    }

    /// True while something is calculated.
    pub(super) fn is_busy(&self) -> bool {
        self.0.lock().working.is_some()
    }

    /// The results since the last call.
    pub(super) fn take(&self) -> Vec<Done> {
        std::mem::take(&mut self.0.lock().done)
    }

    /// Calculates these curves instead of those that were asked for last.
    pub(super) fn ask(&self, ctx: &Context, job: Job) {
        let mut state = self.0.lock();
        state.kind = Some(job.setup.kind);
        state.job = Some(job);
        state.jobs += 1;
        match &state.working {
            Some(working) => working.wake(),
            None => state.working = Background::start("plots", self.0.clone().work(ctx.clone())).ok(),
        }
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        lock(&self.state)
    }

    fn is_closed(&self, ctx: &Context) -> bool {
        ctx.cumulative_pass_nr() > self.pass.load(Ordering::Relaxed) + PASSES
    }

    /// Calculates one job after the other.
    fn work(self: Arc<Self>, ctx: Context) -> impl FnMut() -> Next + Send {
        // The job whose fine curves wait, and since when.
        let mut coarse: Option<(Job, u64, Instant)> = None;
        move || {
            if let Some((job, number, since)) = coarse.take() {
                let newer = || self.is_closed(&ctx) || self.lock().jobs != number;
                let left = REST.saturating_sub(since.elapsed());
                if !newer() && !left.is_zero() {
                    coarse = Some((job, number, since));
                    return Next::After(left);
                }
                if !newer() {
                    self.calculate(&ctx, &job, Detail::Fine, &newer);
                }
            }
            let (job, number) = {
                let mut state = self.lock();
                let Some(job) = state.job.take().filter(|_| !self.is_closed(&ctx)) else {
                    state.working = None;
                    drop(state);
                    // What was cancelled is asked for again if the plots are shown.
                    ctx.request_repaint();
                    return Next::Never;
                };
                (job, state.jobs)
            };
            // A coarse curve that is old is better than none while a knob is dragged.
            let other = || self.is_closed(&ctx) || self.lock().kind != Some(job.setup.kind);
            if self.calculate(&ctx, &job, Detail::Coarse, &other) {
                coarse = Some((job, number, Instant::now()));
            }
            Next::Now
        }
    }

    /// False if it was cancelled.
    fn calculate(
        &self,
        ctx: &Context,
        job: &Job,
        detail: Detail,
        cancelled: &(dyn Fn() -> bool + Sync),
    ) -> bool {
        let fine = detail == Detail::Fine;
        for item in job.items.iter().filter(|item| fine || !item.coarse) {
            let draw = || {
                let progress = Progress { tell: &|_, _| {}, cancelled };
                // Said once.
                let registry = job.registry.as_ref().filter(|_| item.slot == Slot::Live);
                item.recipe.draw(&job.setup, detail, registry, &progress)
            };
            let made = catch(|| match &*POOL {
                Some(pool) => pool.install(draw),
                None => draw(),
            });
            let outcome = match made {
                Ok(Err(NoCurve::Cancelled)) => return false,
                Ok(Err(NoCurve::Because(why))) => Err(why),
                Ok(Ok(drawn)) => Ok(Arc::new(drawn)),
                Err(_) => Err(format!("{}: an internal error", item.recipe.name())),
            };
            let (slot, key, setup) = (item.slot, item.key.clone(), job.setup);
            // What failed will not do better with more points.
            let fine = fine || outcome.is_err();
            self.lock().done.push(Done { slot, key, setup, fine, outcome });
            ctx.request_repaint();
        }
        true
    }
}
