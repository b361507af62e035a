//! The temporary files of this process, which go when a signal ends it.

use std::{
    fs, io,
    path::PathBuf,
    sync::{Mutex, MutexGuard, PoisonError, TryLockError},
    thread,
    time::{Duration, Instant},
};

use super::litter;

/// The longest wait for a write that hangs, before the process ends without cleaning up.
const PATIENCE: Duration = Duration::from_secs(2);
/// The time between two looks at it.
const PAUSE: Duration = Duration::from_millis(5);

/// Held during every step that makes, renames or fills something temporary, so that the end never falls between two.
static LIVING: Mutex<Vec<Temporary>> = Mutex::new(Vec::new());

/// Something that is there only while this process works.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Temporary {
    /// The draft of a file.
    File(PathBuf),
    /// The draft of a folder.
    Draft(PathBuf),
    /// A folder that stays if something is written into it.
    Folder(PathBuf),
}

/// A temporary thing, known until this is dropped.
#[derive(Debug)]
pub(super) struct Living(Temporary);

impl Living {
    /// Makes something temporary.
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

/// One step with something temporary, which the end of the process waits for. Once the end has begun, nobody gets one.
pub(super) fn step() -> MutexGuard<'static, Vec<Temporary>> {
    LIVING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes all temporary files of this process, which is about to end: no other thread can make or finish one after
/// this.
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
    // What cannot be removed is left to the next tidying. Folders, which hold the rest, come last, inner ones first.
    for temporary in living.iter() {
        match temporary {
            Temporary::File(path) => drop(fs::remove_file(path)),
            Temporary::Draft(path) => litter::remove_draft(path),
            Temporary::Folder(_) => {}
        }
    }
    let mut folders: Vec<_> = living
        .drain(..)
        .filter_map(|temporary| match temporary {
            Temporary::Folder(path) => Some(path),
            Temporary::File(_) | Temporary::Draft(_) => None,
        })
        .collect();
    folders.sort_by_key(|path| std::cmp::Reverse(path.components().count()));
    // Only empty ones go.
    folders.iter().for_each(|path| drop(fs::remove_dir(path)));
    std::mem::forget(living);
}
