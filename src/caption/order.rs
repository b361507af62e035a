//! The order in which captions of several views give parameters: the same for all, and that of the models' declarations.

use std::cmp::Reverse;

/// Names of several lists, each once: in the order of the longest list, and what only others have behind what they have
/// before it.
pub(crate) fn merged(mut lists: Vec<Vec<&'static str>>) -> Vec<&'static str> {
    lists.sort_by_key(|list| Reverse(list.len()));
    let mut all: Vec<&'static str> = Vec::new();
    for list in lists {
        let mut next = 0;
        for name in list {
            let at = all.iter().position(|known| *known == name).unwrap_or_else(|| {
                all.insert(next, name);
                next
            });
            next = at + 1;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(lists: &[&[&'static str]]) -> String {
        merged(lists.iter().map(|list| list.to_vec()).collect()).concat()
    }

    #[test]
    fn each_list_keeps_its_order_as_far_as_a_longer_one_has_no_other() {
        assert_eq!(of(&[&["a", "b", "c"]]), "abc");
        assert_eq!(of(&[&["b", "x"], &["a", "b", "c"]]), "abxc", "what only one has is where that has it");
        assert_eq!(of(&[&["x", "a"], &["a", "b", "c"], &["c", "y"]]), "xabcy");
        assert_eq!(of(&[&["c", "a"], &["a", "b", "c"]]), "abc", "the longest one decides");
        assert_eq!(of(&[&["p", "q"], &[]]), "pq");
    }
}
