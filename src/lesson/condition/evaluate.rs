//! Evaluates expressions: true, false, or undecided if a quantity has no value.

use super::{Expression, Operand, Sign, Term, Value, quantity::Asked};

/// Returns the value of a quantity, or the reason why it has none.
type Ask<'a> = dyn Fn(&Asked) -> Result<Value, String> + 'a;

/// Tolerance of equality: scenes have 32-bit numbers, and people write few digits.
const EQUAL: f64 = 1e-5;

pub(super) fn value(operand: &Operand, ask: &Ask) -> Result<Value, String> {
    match &operand.what {
        Term::Value(value) => Ok(value.clone()),
        Term::Quantity(asked) => ask(asked),
    }
}

fn compare(left: &Value, sign: Sign, right: &Value) -> Option<bool> {
    let equal = match (left, right) {
        (Value::Number(a), Value::Number(b)) if a.is_nan() || b.is_nan() => return None,
        (Value::Number(a), Value::Number(b)) => {
            match sign {
                Sign::Less => return Some(a < b),
                Sign::LessOrEqual => return Some(a <= b),
                Sign::Greater => return Some(a > b),
                Sign::GreaterOrEqual => return Some(a >= b),
                Sign::Equal | Sign::NotEqual => {}
            }
            a == b || (a - b).abs() <= EQUAL * a.abs().max(b.abs())
        }
        (Value::Text(a), Value::Text(b)) => a == b,
        (Value::Truth(a), Value::Truth(b)) => a == b,
        // Refused when the lesson is read, unless the scene has changed its structure since.
        _ => return None,
    };
    match sign {
        Sign::Equal => Some(equal),
        Sign::NotEqual => Some(!equal),
        _ => None,
    }
}

/// True if an expression holds, false if it does not; `None` if undecided.
pub(super) fn holds(expression: &Expression, ask: &Ask) -> Option<bool> {
    match expression {
        Expression::All(parts) => join(parts, false, ask),
        Expression::Any(parts) => join(parts, true, ask),
        Expression::Not(part) => holds(part, ask).map(|holds| !holds),
        Expression::Comparison { left, sign, right } => {
            compare(&value(left, ask).ok()?, *sign, &value(right, ask).ok()?)
        }
        Expression::Truth(operand) => match value(operand, ask) {
            Ok(Value::Truth(holds)) => Some(holds),
            _ => None,
        },
    }
}

/// A single `decisive` part decides; otherwise all parts must be known.
fn join(parts: &[Expression], decisive: bool, ask: &Ask) -> Option<bool> {
    let mut unknown = false;
    for part in parts {
        match holds(part, ask) {
            Some(holds) if holds == decisive => return Some(decisive),
            Some(_) => {}
            None => unknown = true,
        }
    }
    (!unknown).then_some(!decisive)
}

/// The reason why a quantity has no value, for the first such quantity.
pub(super) fn missing(expression: &Expression, ask: &Ask) -> Option<String> {
    operands(expression).into_iter().find_map(|operand| value(operand, ask).err())
}

/// All operands, in textual order.
pub(super) fn operands(expression: &Expression) -> Vec<&Operand> {
    match expression {
        Expression::All(parts) | Expression::Any(parts) => parts.iter().flat_map(operands).collect(),
        Expression::Not(part) => operands(part),
        Expression::Comparison { left, right, .. } => vec![left, right],
        Expression::Truth(operand) => vec![operand],
    }
}
