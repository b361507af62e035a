//! Caught panics, so that the program can continue: in somebody's panel, in a shader that is tried, in work
//! on a thread.

use std::{
    any::Any,
    cell::Cell,
    panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook},
    sync::{
        LockResult, Mutex, MutexGuard, Once, PoisonError,
        atomic::{AtomicUsize, Ordering},
    },
};

static COUNT: AtomicUsize = AtomicUsize::new(0);

thread_local! {
    /// True while a panic of this thread is not shown.
    static IS_SILENT: Cell<bool> = const { Cell::new(false) };
}

/// The result of a call, or its panic. Callers must leave no inconsistent state that others see.
pub fn catch<T>(call: impl FnOnce() -> T) -> Result<T, Box<dyn Any + Send>> {
    let result = catch_unwind(AssertUnwindSafe(call));
    if result.is_err() {
        COUNT.fetch_add(1, Ordering::SeqCst);
    }
    result
}

/// Like [`catch`], and shows nothing of the panic of this call. Panics of other threads are shown as before.
pub fn catch_silently<T>(call: impl FnOnce() -> T) -> Result<T, Box<dyn Any + Send>> {
    static SILENCE: Once = Once::new();
    // The hook belongs to all threads, and stays: to put the former one back would undo what others set meanwhile.
    SILENCE.call_once(|| {
        let usual = take_hook();
        set_hook(Box::new(move |info| {
            if !IS_SILENT.get() {
                usual(info);
            }
        }));
    });
    let before = IS_SILENT.replace(true);
    let result = catch(call);
    IS_SILENT.set(before);
    result
}

/// The number of panics caught so far. The panic that ends the program comes after them.
#[must_use]
pub fn count() -> usize {
    COUNT.load(Ordering::SeqCst)
}

/// Locks a value that is consistent even if a thread panicked while it held the lock.
pub fn lock<T>(value: &Mutex<T>) -> MutexGuard<'_, T> {
    unpoisoned(value.lock())
}

/// The result of another access to such a value: of a wait, or of an [`RwLock`](std::sync::RwLock).
pub fn unpoisoned<T>(accessed: LockResult<T>) -> T {
    accessed.unwrap_or_else(PoisonError::into_inner)
}

/// The message of a panic.
#[must_use]
pub fn message(payload: &(dyn Any + Send)) -> &str {
    let text = payload.downcast_ref::<String>().map(String::as_str);
    text.or_else(|| payload.downcast_ref::<&str>().copied()).unwrap_or("it gave no reason")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_caught_panic_is_counted_and_has_its_message() {
        let before = count();
        assert_eq!(catch(|| 7).ok(), Some(7));
        let payload = catch(|| panic!("the {} is broken", "lens")).expect_err("it panicked");
        assert_eq!(message(&*payload), "the lens is broken");
        assert_eq!(message(&*catch(|| panic!("plain")).expect_err("it panicked")), "plain");
        assert_eq!(message(&7), "it gave no reason");
        assert!(count() >= before + 2);
    }

    #[test]
    fn a_silent_panic_silences_its_thread_alone_and_no_longer_than_it_lasts() {
        let silent = || {
            let other = std::thread::spawn(|| IS_SILENT.get()).join().expect("it does not panic");
            (IS_SILENT.get(), other)
        };
        assert_eq!(catch_silently(silent).ok(), Some((true, false)));
        let within = || (catch_silently(|| panic!("the driver")).err(), IS_SILENT.get());
        let (inner, still) = catch_silently(within).expect("the panic is caught");
        assert_eq!((message(&*inner.expect("it panicked")), still), ("the driver", true));
        assert_eq!(silent(), (false, false));
    }

    #[test]
    fn a_panic_under_a_lock_does_not_close_it() {
        use std::sync::RwLock;

        let (one, other) = (Mutex::new(1), RwLock::new(2));
        let _ = catch(|| {
            let _held = (lock(&one), unpoisoned(other.write()));
            panic!("with both");
        });
        assert!(one.is_poisoned() && other.is_poisoned());
        *lock(&one) += 10;
        *unpoisoned(other.write()) += 10;
        assert_eq!((*lock(&one), *unpoisoned(other.read())), (11, 12));
    }
}
