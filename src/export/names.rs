//! Unique names.

use std::collections::{BTreeMap, BTreeSet};

/// Hands out each name once.
#[derive(Default)]
pub(super) struct Names {
    given: BTreeSet<String>,
    /// The last number used for each name.
    last: BTreeMap<String, usize>,
}

impl Names {
    /// The name, with a number appended if it is taken.
    pub(super) fn unique(&mut self, name: String) -> String {
        let mut unique = name.clone();
        while !self.given.insert(unique.clone()) {
            let last = self.last.entry(name.clone()).or_insert(1);
            *last += 1;
            unique = format!("{name}_{last}");
        }
        unique
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_name_is_given_once() {
        let mut names = Names::default();
        let all = ["a", "a", "b", "a"].map(|n| names.unique(n.to_owned()));
        assert_eq!(all, ["a", "a_2", "b", "a_3"]);
    }
}
