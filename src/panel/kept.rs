//! State that panels keep in egui's memory, one value of each type, and calculations in threads.

use std::{
    sync::{
        Arc, Mutex,
        mpsc::{self, Receiver, RecvTimeoutError},
    },
    time::Duration,
};

use bevy_egui::egui::{Context, Id};

use crate::{caught::lock, platform};

/// Applies a function to the value of a type. The function must not use the context.
pub(super) fn with<T, R>(ctx: &Context, of: impl FnOnce(&mut T) -> R) -> R
where
    T: Clone + Default + Send + Sync + 'static,
{
    ctx.data_mut(|data| of(data.get_temp_mut_or_default::<T>(Id::NULL)))
}

/// The value of a type.
pub(super) fn get<T: Clone + Default + Send + Sync + 'static>(ctx: &Context) -> T {
    with(ctx, |value: &mut T| value.clone())
}

/// Replaces the value of a type, and returns the previous one.
pub(super) fn set<T: Clone + Default + Send + Sync + 'static>(ctx: &Context, value: T) -> T {
    with(ctx, |kept| std::mem::replace(kept, value))
}

/// The value under an id, made again whenever its key changes.
pub(super) fn of_key<K, T>(ctx: &Context, id: Id, key: K, make: impl FnOnce() -> T) -> T
where
    K: Clone + PartialEq + Send + Sync + 'static,
    T: Clone + Send + Sync + 'static,
{
    of_keys(ctx, id, (key, ()), true, make)
}

/// The value under an id, made again whenever its first key changes, and its second one while that counts.
pub(super) fn of_keys<K, S, T>(
    ctx: &Context,
    id: Id,
    (first, second): (K, S),
    counts: bool,
    make: impl FnOnce() -> T,
) -> T
where
    K: Clone + PartialEq + Send + Sync + 'static,
    S: Clone + PartialEq + Send + Sync + 'static,
    T: Clone + Send + Sync + 'static,
{
    let stays = |(of, by, _): &(K, S, T)| *of == first && (!counts || *by == second);
    if let Some((.., known)) = ctx.data(|d| d.get_temp::<(K, S, T)>(id)).filter(stays) {
        return known;
    }
    let made = make();
    ctx.data_mut(|d| d.insert_temp(id, (first, second, made.clone())));
    made
}

/// Applies a function to the value of a type that threads use too. The function may use the context.
pub(super) fn shared<T: Default + Send + 'static, R>(ctx: &Context, of: impl FnOnce(&mut T) -> R) -> R {
    let shared: Arc<Mutex<T>> = get(ctx);
    of(&mut lock(&shared))
}

/// A value that equals only itself and its copies.
#[derive(Debug)]
pub(super) struct Same<T>(pub(super) Arc<T>);

impl<T> Clone for Same<T> {
    fn clone(&self) -> Self {
        Self(self.0.clone())
    }
}

impl<T> PartialEq for Same<T> {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// The answers of a thread to questions, one at a time.
pub(super) struct Answers<Q, A> {
    /// The latest answer, with its question.
    pub(super) shown: Option<(Q, A)>,
    running: Option<(Q, Receiver<A>)>,
    /// Number of calculations so far.
    pub(super) calculations: u64,
}

impl<Q, A> Default for Answers<Q, A> {
    fn default() -> Self {
        Self { shown: None, running: None, calculations: 0 }
    }
}

impl<Q: Clone + PartialEq, A: Send + 'static> Answers<Q, A> {
    /// True while an answer is being calculated.
    pub(super) fn is_busy(&self) -> bool {
        self.running.is_some()
    }

    /// Asks a question, and waits for a new answer for at most this long. `work` makes the calculation; the answer that
    /// is shown meanwhile is that to an earlier question.
    pub(super) fn ask<W: FnOnce() -> A + Send + 'static>(
        &mut self,
        ctx: &Context,
        question: &Q,
        patience: Duration,
        mut work: impl FnMut() -> Option<W>,
    ) {
        // A running calculation may answer an older question.
        for _ in 0..2 {
            if self.shown.as_ref().is_some_and(|(asked, _)| asked == question) {
                break;
            }
            let new = self.running.is_none();
            let running = self.running.take().or_else(|| Some((question.clone(), start(ctx, work()?))));
            let Some((asked, receiver)) = running else { break };
            self.calculations += u64::from(new);
            match platform::receive(&receiver, if new { patience } else { Duration::ZERO }) {
                Ok(answer) => self.shown = Some((asked, answer)),
                Err(error) => {
                    self.running = (error == RecvTimeoutError::Timeout).then_some((asked, receiver));
                    break;
                }
            }
        }
    }
}

/// Starts a calculation.
fn start<A: Send + 'static>(ctx: &Context, work: impl FnOnce() -> A + Send + 'static) -> Receiver<A> {
    let (sender, receiver) = mpsc::channel();
    let ctx = ctx.clone();
    platform::once(move || {
        // The receiver is gone once nobody wants the answer any more.
        drop(sender.send(work()));
        ctx.request_repaint();
    });
    receiver
}
