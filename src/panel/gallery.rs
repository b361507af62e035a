//! Small pictures and the like, made in the background, each once, as long as a panel asks for them.

use std::{collections::HashMap, hash::Hash, time::Duration};

use bevy_egui::egui::Context;
use web_time::Instant;

use super::kept;
use crate::platform::{Next, Worker};

/// Time after which nobody wants a picture for which nobody has asked: the panel is closed, or its part out of sight.
const REST: Duration = Duration::from_secs(2);
/// Interval at which that is looked at.
const GLANCE: Duration = Duration::from_millis(20);

/// What is made, and what is still to be made from what is queued.
pub(super) struct Gallery<K, J, V> {
    known: HashMap<K, V>,
    /// The next one last.
    queue: Vec<(K, J)>,
    working: bool,
    asked: Option<Instant>,
}

impl<K, J, V> Default for Gallery<K, J, V> {
    fn default() -> Self {
        Self { known: HashMap::new(), queue: Vec::new(), working: false, asked: None }
    }
}

/// A thing to be made.
pub(super) struct Wanted<J, V> {
    pub(super) job: J,
    /// What stands in its place meanwhile.
    pub(super) waiting: V,
    /// True if it is made before others.
    pub(super) is_urgent: bool,
}

impl<K, J, V> Gallery<K, J, V>
where
    K: Clone + Eq + Hash + Send + 'static,
    J: Send + 'static,
    V: Clone + Send + 'static,
{
    /// Maximum number of things kept.
    const MOST: usize = 256;

    /// What there is under a key, asked for in every frame in which it is in sight.
    pub(super) fn of<M>(
        ctx: &Context,
        key: &K,
        wanted: impl FnOnce() -> Wanted<J, V>,
        maker: impl FnOnce() -> M,
    ) -> V
    where
        M: Fn(&Context, J) -> V + Send + 'static,
    {
        kept::shared(ctx, |store: &mut Self| {
            store.asked = Some(Instant::now());
            if let Some(known) = store.known.get(key) {
                return known.clone();
            }
            if store.known.len() >= Self::MOST {
                store.known.clear();
                store.queue.clear();
            }
            let Wanted { job, waiting, is_urgent } = wanted();
            store.known.insert(key.clone(), waiting.clone());
            let place = if is_urgent { store.queue.len() } else { 0 };
            store.queue.insert(place, (key.clone(), job));
            if !std::mem::replace(&mut store.working, true) {
                let (ctx, make) = (ctx.clone(), maker());
                // Without a thread, what stands in its place stays.
                let _ = Worker::start("gallery", Self::work(ctx, make));
            }
            waiting
        })
    }

    /// Forgets what does not hold.
    pub(super) fn retain(ctx: &Context, holds: impl Fn(&K) -> bool) {
        kept::shared(ctx, |store: &mut Self| {
            store.known.retain(|key, _| holds(key));
            store.queue.retain(|(key, _)| holds(key));
        });
    }

    /// Makes one after the other.
    fn work(ctx: Context, make: impl Fn(&Context, J) -> V + Send + 'static) -> impl FnMut() -> Next + Send {
        let mut end = None;
        let next = |store: &mut Self| {
            let next = store.queue.pop();
            store.working = next.is_some();
            next
        };
        move || {
            if let Some(since) = end {
                match kept::shared(&ctx, |store: &mut Self| store.is_wanted(since)) {
                    Some(true) => {}
                    Some(false) => return Next::Never,
                    None => return Next::After(GLANCE),
                }
            }
            let Some((key, job)) = kept::shared(&ctx, next) else { return Next::Never };
            let made = make(&ctx, job);
            kept::shared(&ctx, |store: &mut Self| store.known.insert(key, made));
            end = Some(Instant::now());
            ctx.request_repaint();
            Next::Now
        }
    }

    /// True once a frame has asked since a time; false if none does, and what is queued is left until it is asked for
    /// again; `None` if one may yet.
    fn is_wanted(&mut self, since: Instant) -> Option<bool> {
        if self.asked.is_some_and(|asked| asked > since) {
            return Some(true);
        }
        if since.elapsed() < REST {
            return None;
        }
        self.working = false;
        for (key, _) in std::mem::take(&mut self.queue) {
            self.known.remove(&key);
        }
        Some(false)
    }
}

#[cfg(test)]
mod tests {
    use std::sync::{
        Arc,
        atomic::{AtomicUsize, Ordering},
    };
    use std::thread;

    use super::*;

    type Numbers = Gallery<u32, u32, Option<u32>>;

    #[test]
    fn what_nobody_asks_for_any_more_is_not_made_until_somebody_does() {
        let (ctx, made) = (Context::default(), Arc::new(AtomicUsize::new(0)));
        let ask = |key: u32| {
            let made = made.clone();
            let maker = || {
                move |_: &Context, job: u32| {
                    made.fetch_add(1, Ordering::SeqCst);
                    thread::sleep(Duration::from_millis(30));
                    Some(2 * job)
                }
            };
            Numbers::of(&ctx, &key, || Wanted { job: key, waiting: None, is_urgent: false }, maker)
        };
        let until = |what: &dyn Fn() -> bool| {
            let begin = Instant::now();
            while !what() {
                assert!(begin.elapsed() < Duration::from_secs(60), "it takes too long");
                thread::sleep(Duration::from_millis(5));
            }
        };
        until(&|| (0..4).map(ask).collect::<Vec<_>>() == [Some(0), Some(2), Some(4), Some(6)]);
        assert_eq!(made.load(Ordering::SeqCst), 4, "each once");
        // Nobody looks on: of a hundred the one in work is made.
        (100..200).for_each(|key| assert_eq!(ask(key), None));
        until(&|| kept::shared(&ctx, |store: &mut Numbers| !store.working));
        assert_eq!(made.load(Ordering::SeqCst), 5);
        until(&|| (100..104).map(ask).all(|one| one.is_some()));
    }
}
