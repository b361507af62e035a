//! The lines in which two texts differ.
//!
//! The longest common subsequence of the lines between the common beginning and the common end (J. W. Hunt and
//! M. D. McIlroy 1976, *An Algorithm for Differential File Comparison*), as far as that is cheap: beyond
//! `MOST_PAIRS` the middle counts as replaced.

/// Most pairs of lines that are compared.
const MOST_PAIRS: usize = 1 << 22;

/// A line of a difference.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change<S> {
    /// In both texts.
    Both(S),
    /// Only in the first.
    Mine(S),
    /// Only in the second.
    Theirs(S),
}

impl Change<&str> {
    /// The change with a line of its own.
    pub(super) fn owned(self) -> Change<String> {
        match self {
            Self::Both(line) => Change::Both(line.to_owned()),
            Self::Mine(line) => Change::Mine(line.to_owned()),
            Self::Theirs(line) => Change::Theirs(line.to_owned()),
        }
    }
}

/// The lines of both texts in order.
#[must_use]
pub fn difference<'a>(mine: &'a str, theirs: &'a str) -> Vec<Change<&'a str>> {
    let (a, b): (Vec<_>, Vec<_>) = (mine.lines().collect(), theirs.lines().collect());
    let before = a.iter().zip(&b).take_while(|(a, b)| a == b).count();
    let after = a[before..].iter().rev().zip(b[before..].iter().rev()).take_while(|(a, b)| a == b).count();
    let (a_middle, b_middle) = (&a[before..a.len() - after], &b[before..b.len() - after]);
    let mut all: Vec<_> = a[..before].iter().map(|line| Change::Both(*line)).collect();
    all.extend(middle(a_middle, b_middle));
    all.extend(a[a.len() - after..].iter().map(|line| Change::Both(*line)));
    all
}

fn middle<'a>(a: &[&'a str], b: &[&'a str]) -> Vec<Change<&'a str>> {
    let (rows, columns) = (a.len() + 1, b.len() + 1);
    let replaced = || {
        a.iter().map(|line| Change::Mine(*line)).chain(b.iter().map(|line| Change::Theirs(*line))).collect()
    };
    if rows.saturating_mul(columns) > MOST_PAIRS {
        return replaced();
    }
    // Length of the longest common subsequence of the ends from each pair of lines on.
    let mut longest = vec![0_u32; rows * columns];
    for i in (0..a.len()).rev() {
        for j in (0..b.len()).rev() {
            longest[i * columns + j] = match a[i] == b[j] {
                true => longest[(i + 1) * columns + j + 1] + 1,
                false => longest[(i + 1) * columns + j].max(longest[i * columns + j + 1]),
            };
        }
    }
    let (mut i, mut j, mut all) = (0, 0, Vec::new());
    while i < a.len() || j < b.len() {
        if i < a.len() && j < b.len() && a[i] == b[j] {
            all.push(Change::Both(a[i]));
            (i, j) = (i + 1, j + 1);
        } else if j == b.len()
            || i < a.len() && longest[(i + 1) * columns + j] >= longest[i * columns + j + 1]
        {
            all.push(Change::Mine(a[i]));
            i += 1;
        } else {
            all.push(Change::Theirs(b[j]));
            j += 1;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One side of a difference.
    fn side<'a>(all: &[Change<&'a str>], mine: bool) -> Vec<&'a str> {
        let of = |change: &Change<&'a str>| match *change {
            Change::Both(line) => Some(line),
            Change::Mine(line) => mine.then_some(line),
            Change::Theirs(line) => (!mine).then_some(line),
        };
        all.iter().filter_map(of).collect()
    }

    #[test]
    fn a_difference_has_both_texts_and_no_more_than_it_needs() {
        let (mine, theirs) = ("a\nb\nc\nd\n", "a\nc\nx\nd\n");
        let all = difference(mine, theirs);
        let expected =
            [Change::Both("a"), Change::Mine("b"), Change::Both("c"), Change::Theirs("x"), Change::Both("d")];
        assert_eq!(all, expected);
        for (mine, theirs) in [("", ""), ("", "a"), ("a\na\na", "a\na"), ("x\ny", "y\nx"), ("a", "b")] {
            let all = difference(mine, theirs);
            assert_eq!(side(&all, true), mine.lines().collect::<Vec<_>>());
            assert_eq!(side(&all, false), theirs.lines().collect::<Vec<_>>());
        }
    }

    #[test]
    fn texts_with_many_other_lines_are_replaced_as_a_whole() {
        let numbered = |from: usize| (from..from + 5000).map(|i| format!("{i}\n")).collect::<String>();
        let (mine, theirs) = (numbered(0), numbered(10_000));
        let all = difference(&mine, &theirs);
        assert_eq!((side(&all, true).len(), side(&all, false).len()), (5000, 5000));
        assert!(all[..5000].iter().all(|change| matches!(change, Change::Mine(_))));
    }
}
