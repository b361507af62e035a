//! Conditions of tasks: comparisons of quantities, joined by `and`, `or`, `not` and brackets.

mod check;
mod evaluate;
mod known;
mod never;
mod parse;
mod probe;
mod quantity;
mod scene;
mod subject;
mod unmet;

use std::{fmt, sync::Arc};

pub(super) use known::Knowledge;
pub use quantity::{QUANTITIES, Quantity};

use quantity::Asked;

use super::Situation;

/// A condition, including its text as written.
#[derive(Clone)]
pub struct Condition {
    text: Arc<str>,
    expression: Arc<Expression>,
}

impl fmt::Debug for Condition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Condition").field(&self.text).finish()
    }
}

impl PartialEq for Condition {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

/// An expression that is true, false or undecided.
#[derive(Debug)]
enum Expression {
    All(Vec<Expression>),
    Any(Vec<Expression>),
    Not(Box<Expression>),
    Comparison { left: Operand, sign: Sign, right: Operand },
    Truth(Operand),
}

/// A value, with its byte in the text.
#[derive(Debug)]
struct Operand {
    at: usize,
    what: Term,
}

#[derive(Debug)]
enum Term {
    Value(Value),
    Quantity(Asked),
}

/// A value of a quantity.
#[derive(Clone, Debug, PartialEq)]
enum Value {
    Number(f64),
    Text(String),
    Truth(bool),
}

/// The operator of a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sign {
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    Equal,
    NotEqual,
}

impl Sign {
    /// The operator that holds exactly if this one does not.
    fn opposite(self) -> Self {
        match self {
            Self::Less => Self::GreaterOrEqual,
            Self::LessOrEqual => Self::Greater,
            Self::Greater => Self::LessOrEqual,
            Self::GreaterOrEqual => Self::Less,
            Self::Equal => Self::NotEqual,
            Self::NotEqual => Self::Equal,
        }
    }

    /// The operator with its sides exchanged.
    fn mirrored(self) -> Self {
        match self {
            Self::Less => Self::Greater,
            Self::LessOrEqual => Self::GreaterOrEqual,
            Self::Greater => Self::Less,
            Self::GreaterOrEqual => Self::LessOrEqual,
            Self::Equal | Self::NotEqual => self,
        }
    }
}

impl Condition {
    /// Reads a condition.
    ///
    /// # Errors
    /// Returns the byte of the first mistake, and a sentence.
    pub fn parse(text: &str) -> Result<Self, (usize, String)> {
        Ok(Self { text: text.into(), expression: Arc::new(parse::expression(text)?) })
    }

    /// The condition as written.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// True if the condition holds. This may take a few milliseconds, so call it when something changed, not
    /// in every frame.
    #[must_use]
    pub fn holds(&self, situation: &Situation) -> bool {
        evaluate::holds(&self.expression, &|asked| asked.value(situation)) == Some(true)
    }

    /// The reason why the condition is undecided, if it is, as in "nothing is pinned": that of the first
    /// quantity without a value.
    #[must_use]
    pub fn missing(&self, situation: &Situation) -> Option<String> {
        let value = |asked: &Asked| asked.value(situation);
        match evaluate::holds(&self.expression, &value) {
            Some(_) => None,
            None => evaluate::missing(&self.expression, &value),
        }
    }
}

#[cfg(test)]
mod tests;
