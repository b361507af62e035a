//! The temporary files of this process, which are removed when a signal ends it.

use std::{
    io,
    path::PathBuf,
    sync::{Mutex, MutexGuard, TryLockError},
    thread,
    time::Duration,
};

use web_time::Instant;

use super::litter;
use crate::{caught::lock, platform::fs};

/// Maximum wait for a write that hangs, before the process ends without cleaning up.
const PATIENCE: Duration = Duration::from_secs(2);
/// The time between two checks.
const PAUSE: Duration = Duration::from_millis(5);

/// Held during every step that creates, renames or fills something temporary, so that the process never ends
/// between two of these.
static LIVING: Mutex<Vec<Temporary>> = Mutex::new(Vec::new());

/// A temporary item that exists only while this process works on it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Temporary {
    /// The draft of a file.
    File(PathBuf),
    /// A folder that stays if something is written into it.
    Draft(PathBuf),
    /// A folder and this many folders from it outwards, which stay if something is written into them.
    Folders(PathBuf, usize),
}

/// A temporary item, registered until this is dropped.
#[derive(Debug)]
pub(super) struct Living(Temporary);

impl Living {
    /// Creates something temporary.
    pub(super) fn making<T>(
        make: impl FnOnce() -> io::Result<T>,
        temporary: impl FnOnce(&T) -> Temporary,
    ) -> io::Result<(T, Self)> {
        let mut living = step();
        let made = make()?;
        let temporary = temporary(&made);
        living.push(temporary.clone());
        Ok((made, Self(temporary)))
    }
}

impl Drop for Living {
    fn drop(&mut self) {
        let mut living = step();
        if let Some(place) = living.iter().position(|temporary| *temporary == self.0) {
            living.swap_remove(place);
        }
    }
}

/// A step with something temporary, for which the end of the process waits. Once the end has begun, no step
/// starts.
pub(super) fn step() -> MutexGuard<'static, Vec<Temporary>> {
    lock(&LIVING)
}

/// Removes all temporary files of this process, which is about to end: after this, no other thread can create
/// or finish one.
pub fn give_up() {
    let begin = Instant::now();
    let mut living = loop {
        match LIVING.try_lock() {
            Ok(living) => break living,
            Err(TryLockError::Poisoned(poisoned)) => break poisoned.into_inner(),
            Err(TryLockError::WouldBlock) if begin.elapsed() > PATIENCE => return,
            Err(TryLockError::WouldBlock) => thread::sleep(PAUSE),
        }
    };
    // Items that cannot be removed are left to the next tidying. Folders come last, inner ones first, since
    // they contain the rest.
    for temporary in living.iter() {
        match temporary {
            Temporary::File(path) => drop(fs::remove_file(path)),
            Temporary::Draft(path) => litter::remove_draft(path),
            Temporary::Folders(..) => {}
        }
    }
    let mut folders: Vec<PathBuf> = living
        .drain(..)
        .flat_map(|temporary| match temporary {
            Temporary::Folders(path, count) => path.ancestors().take(count).map(PathBuf::from).collect(),
            Temporary::File(_) | Temporary::Draft(_) => Vec::new(),
        })
        .collect();
    folders.sort_by_cached_key(|path| std::cmp::Reverse(path.components().count()));
    // Only empty folders are removed.
    folders.iter().for_each(|path| drop(fs::remove_dir(path)));
    std::mem::forget(living);
}
