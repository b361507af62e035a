//! When background work goes on.

use std::time::Duration;

/// When background work goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Next {
    /// At once.
    Now,
    /// After a time, or when it is woken.
    After(Duration),
    /// When it is woken.
    Woken,
    /// Never: it has ended.
    Never,
}
