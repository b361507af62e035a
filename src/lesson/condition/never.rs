//! Comparisons that can never hold: numbers beyond the range of a quantity.

use super::{Operand, Sign, Term, Value, subject};
use crate::{registry::Registry, text::detailed};

/// The byte of a number that a quantity cannot reach, and a sentence.
pub(super) fn beyond(
    left: &Operand,
    sign: Sign,
    right: &Operand,
    registry: &Registry,
) -> Option<(usize, String)> {
    let (quantity, sign, bound) = match (&left.what, &right.what) {
        (Term::Value(_), Term::Quantity(_)) => (right, sign.mirrored(), left),
        _ => (left, sign, right),
    };
    let (Term::Quantity(asked), Term::Value(Value::Number(number))) = (&quantity.what, &bound.what) else {
        return None;
    };
    let [least, most] = subject::range(asked, registry)?;
    let (never, word) = match sign {
        Sign::Less => (*number <= least, "less than "),
        Sign::LessOrEqual => (*number < least, "at most "),
        Sign::Greater => (*number >= most, "more than "),
        Sign::GreaterOrEqual => (*number > most, "at least "),
        Sign::Equal => (*number < least || *number > most, ""),
        Sign::NotEqual => (false, ""),
    };
    if !never {
        return None;
    }
    let range = if most.is_finite() {
        format!("it ranges from {least} to {most}")
    } else {
        format!("its smallest value is {least}")
    };
    Some((bound.at, detailed(&format!("{} is never {word}{number}", asked.written()), &range)))
}
