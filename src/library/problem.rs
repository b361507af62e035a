//! The age of problems: recent ones are not reported.

use std::time::Duration;

use web_time::Instant;

/// Minimum age of a reported problem: many editors empty a file before they write it.
pub const GRACE: Duration = Duration::from_millis(300);

/// One or several problems, and the time since when they exist.
#[derive(Clone, Debug)]
pub struct Problem<T> {
    /// The problem.
    pub what: T,
    since: Instant,
}

impl<T: PartialEq> Problem<T> {
    /// A new problem.
    pub fn new(what: T) -> Self {
        Self { what, since: Instant::now() }
    }

    /// A problem found after another one: if they are equal, it keeps its age.
    pub fn after(before: Option<&Self>, what: T) -> Self {
        let since = before.filter(|before| before.what == what).map_or_else(Instant::now, |b| b.since);
        Self { what, since }
    }

    /// True if the problem is old enough to be reported.
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
