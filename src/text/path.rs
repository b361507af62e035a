//! Paths to values in JSON.

use std::{borrow::Cow, fmt};

use serde::{Serialize, Serializer};

use super::quoted;

/// A step of a path.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Segment {
    /// Into an object, by key.
    Key(Cow<'static, str>),
    /// Into a list, counted from 0.
    Index(usize),
}

/// The path from the outermost value to another one: `objects[0].material.k_d`. Empty for the outermost value
/// itself.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Path(Vec<Segment>);

impl Path {
    /// The path of the outermost value.
    #[must_use]
    pub fn root() -> Self {
        Self::default()
    }

    /// The path with these steps.
    #[must_use]
    pub fn of(steps: Vec<Segment>) -> Self {
        Self(steps)
    }

    /// The path to the same place from farther outside: `size` within `objects[0]` is `objects[0].size`.
    #[must_use]
    pub fn within(&self, outer: &Self) -> Self {
        Self(outer.0.iter().chain(&self.0).cloned().collect())
    }

    /// True if it leads into the value of another path, or is that.
    #[must_use]
    pub fn starts_with(&self, outer: &Self) -> bool {
        self.0.starts_with(&outer.0)
    }

    /// The path extended by a step.
    #[must_use]
    pub fn then(mut self, step: Segment) -> Self {
        self.0.push(step);
        self
    }

    /// The value under a key.
    #[must_use]
    pub fn key(&self, key: impl Into<Cow<'static, str>>) -> Self {
        self.clone().then(Segment::Key(key.into()))
    }

    /// The entry of a list.
    #[must_use]
    pub fn index(&self, index: usize) -> Self {
        self.clone().then(Segment::Index(index))
    }

    /// The index in a top-level list: 3 for `objects[3].size` in `objects`.
    #[must_use]
    pub fn index_in(&self, list: &str) -> Option<usize> {
        match self.0.as_slice() {
            [Segment::Key(key), Segment::Index(index), ..] if key == list => Some(*index),
            _ => None,
        }
    }

    /// The key at the end; empty if there is none.
    #[must_use]
    pub fn last_key(&self) -> &str {
        match self.0.last() {
            Some(Segment::Key(key)) => key,
            _ => "",
        }
    }

    /// The steps from the outermost value.
    #[must_use]
    pub fn segments(&self) -> &[Segment] {
        &self.0
    }

    /// All prefixes of this path, including the empty path and this one.
    pub fn ancestors(&self) -> impl Iterator<Item = Self> + '_ {
        (0..=self.0.len()).map(|n| Self(self.0[..n].to_vec()))
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, segment) in self.0.iter().enumerate() {
            match segment {
                Segment::Index(index) => write!(f, "[{index}]")?,
                Segment::Key(key) if is_plain(key) => {
                    if i > 0 {
                        f.write_str(".")?;
                    }
                    f.write_str(key)?;
                }
                Segment::Key(key) => write!(f, "[{}]", quoted(key))?,
            }
        }
        Ok(())
    }
}

impl Serialize for Path {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// True if a key can appear in a path without quotes.
fn is_plain(key: &str) -> bool {
    !key.is_empty() && key.len() <= 60 && key.chars().all(|c| c.is_alphanumeric() || "_-$".contains(c))
}
