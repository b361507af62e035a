//! Comparisons that can never hold: numbers beyond the range of a quantity.

use super::{Operand, Sign, Term, Value, quantity::Argument, subject};
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
    let never = match sign {
        Sign::Less => *number <= least,
        Sign::LessOrEqual => *number < least,
        Sign::Greater => *number >= most,
        Sign::GreaterOrEqual => *number > most,
        Sign::Equal => *number < least || *number > most,
        Sign::NotEqual => false,
    };
    if !never {
        return None;
    }
    let word = match sign {
        Sign::Less => "less than ",
        Sign::LessOrEqual => "at most ",
        Sign::Greater => "more than ",
        Sign::GreaterOrEqual => "at least ",
        Sign::Equal | Sign::NotEqual => "",
    };
    let name = match &asked.argument {
        Argument::Path(path) => format!("scene.{path}"),
        Argument::Name(name) => format!("knob.{name}"),
        Argument::Angle(angle) => format!("curve.albedo({angle})"),
        Argument::None => asked.quantity.name.to_owned(),
    };
    let range = if most.is_finite() {
        format!("it ranges from {least} to {most}")
    } else {
        format!("its smallest value is {least}")
    };
    Some((bound.at, detailed(&format!("{name} is never {word}{number}"), &range)))
}
