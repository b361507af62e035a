//! The pieces of captions.

/// A piece of a caption; a line is never broken within one.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Part {
    /// The symbol before the words; often empty.
    pub symbol: &'static str,
    /// The words or the number.
    pub text: String,
    /// True if the part belongs to the one before it: a comma separates them instead of a dot.
    pub continues: bool,
    /// Parts of the highest rank are dropped first where space is short; 0 is never dropped.
    pub rank: u8,
}

impl Part {
    /// A part with this rank, which decides when it is dropped.
    #[must_use]
    pub fn new(rank: u8, text: impl Into<String>) -> Self {
        Self { text: text.into(), rank, ..Self::default() }
    }

    pub(super) fn continued(self) -> Self {
        Self { continues: true, ..self }
    }

    /// The part as text.
    #[must_use]
    pub fn words(&self) -> String {
        format!("{} {}", self.symbol, self.text).trim().to_owned()
    }

    /// True for a heading, which ends in a colon: it leads the next part.
    pub(super) fn leads(&self) -> bool {
        self.text.ends_with(':')
    }

    /// The separator between the previous part and this one.
    pub(crate) fn joint(&self, before: &Self) -> &'static str {
        if before.leads() {
            " "
        } else if self.continues {
            ", "
        } else {
            " · "
        }
    }
}

/// What remains of a separator at the end of a line: a comma, but no dot, which looks like a mistake where nothing follows.
pub(crate) fn closing(joint: &str) -> &str {
    joint.trim_end_matches([' ', '·'])
}

/// Parts of a caption as one text.
#[must_use]
pub fn line(parts: &[Part]) -> String {
    let mut line = String::new();
    for (i, part) in parts.iter().enumerate() {
        if let Some(before) = i.checked_sub(1) {
            line.push_str(part.joint(&parts[before]));
        }
        line.push_str(&part.words());
    }
    line
}
