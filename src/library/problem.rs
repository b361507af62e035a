//! The age of problems: young ones are not reported.

use std::time::{Duration, Instant};

/// The age at which a problem is reported: many editors empty a file before they write it.
pub const GRACE: Duration = Duration::from_millis(300);

/// A problem, or several at once, and since when.
#[derive(Clone, Debug)]
pub struct Problem<T> {
    /// The problem.
    pub what: T,
    since: Instant,
}

impl<T: PartialEq> Problem<T> {
    /// A problem that is new.
    pub fn new(what: T) -> Self {
        Self { what, since: Instant::now() }
    }

    /// A problem that is found where there was one before: the same one keeps its age.
    pub fn after(before: Option<&Self>, what: T) -> Self {
        let since = before.filter(|before| before.what == what).map_or_else(Instant::now, |b| b.since);
        Self { what, since }
    }

    /// True if it is old enough to be reported.
    #[must_use]
    pub fn has_settled(&self) -> bool {
        self.since.elapsed() >= GRACE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_problem_that_stays_keeps_its_age() {
        let young = Problem::new("a");
        assert!(!young.has_settled());
        let old = Problem { since: Instant::now() - GRACE, ..young };
        assert!(old.has_settled());
        assert!(Problem::after(Some(&old), "a").has_settled());
        assert!(!Problem::after(Some(&old), "b").has_settled());
        assert!(!Problem::after(None, "a").has_settled());
    }
}
