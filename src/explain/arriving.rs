//! The light that arrives at a point, factor by factor: each as its equation, with numbers, and its value.

use super::{
    Lit,
    lines::{Known, calculation},
    put::{Symbols, put_in},
    workings::sides,
};
use crate::{
    light::Factor,
    text::{
        expression::{Expression, Value},
        mathematics::definitions,
    },
};

/// A step in the calculation of a factor.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The equation as written: `1/d^2`, or `x = cos θ`.
    pub text: String,
    /// The right side with numbers.
    pub numbers: String,
    /// The value of the step.
    pub value: Value,
}

impl Factor {
    /// The calculation of the factor from given numbers, the factor itself first; empty if the light type
    /// provides none, or one that does not yield the factor.
    #[must_use]
    pub fn steps(&self, digits: usize) -> Vec<Step> {
        let given = self.from.iter().map(|(symbol, value, unit)| {
            let value = f64::from(*value);
            ((*symbol).to_owned(), if *unit == "°" { Value::angle(value) } else { Value::number(value) })
        });
        let mut known = Known(given.collect());
        let mut steps = Vec::new();
        if self.equation.is_empty() {
            return steps;
        }
        // Later definitions are inputs of earlier ones.
        for text in definitions(self.equation).into_iter().rev() {
            let (head, body) = sides(text).unwrap_or(("", text));
            let Ok(value) = Expression::read(body).and_then(|e| e.value(&mut known)) else {
                return Vec::new();
            };
            let numbers = with_numbers(body, &known, &value, digits);
            let text = match head {
                "" if self.symbol == body => body.to_owned(),
                "" => format!("{} = {body}", self.symbol),
                head => format!("{head} = {body}"),
            };
            known.0.push((head.to_owned(), value));
            steps.insert(0, Step { text, numbers, value });
        }
        steps
    }
}

/// An expression with numbers, with as many digits as needed.
fn with_numbers(body: &str, known: &Known, value: &Value, digits: usize) -> String {
    let values = || known.0.iter().map(|(name, value)| (name.as_str(), *value));
    let with =
        |digits: usize| put_in(body, &Symbols::of(values(), digits)).unwrap_or_else(|| body.to_owned());
    calculation(digits, value, with)
}

impl Lit {
    /// The equation of the arriving light: `I(p) = …`.
    #[must_use]
    pub fn arrival(&self) -> &'static str {
        if self.equation.is_empty() { "I(p)" } else { self.equation }
    }
}
