//! The part of a condition that fails, as a sentence with its present value.

use std::{cell::RefCell, collections::HashMap};

use super::{
    Condition, Expression, Operand, Sign, Term, Value, evaluate,
    quantity::{Argument, Asked},
    subject,
};
use crate::{
    channel::DebugChannel,
    curves::Kind as Plot,
    lesson::Situation,
    optics::tone::ToneMapping,
    registry::Registry,
    text::{path::Segment, shortened},
};

/// Maximum number of alternatives named.
const MOST: usize = 3;

impl Condition {
    /// The first part that fails, as in "N·L is 0.975; it must be above 0.98"; `None` if the condition holds.
    /// Names every alternative. Does not reveal a solution that is a name or a single number,
    /// except that of a numbered choice.
    #[must_use]
    pub fn unmet(&self, situation: &Situation) -> Option<String> {
        let state = State { situation, known: RefCell::default() };
        if evaluate::holds(&self.expression, &|asked| state.value(asked)) == Some(true) {
            return None;
        }
        let mut reasons = reasons(&self.expression, true, &state);
        reasons.truncate(MOST);
        Some(reasons.join(". Or: "))
    }
}

/// The situation, and the values known so far: a curve takes milliseconds.
struct State<'a> {
    situation: &'a Situation<'a>,
    known: RefCell<HashMap<*const Asked, Result<Value, String>>>,
}

impl State<'_> {
    fn value(&self, asked: &Asked) -> Result<Value, String> {
        let calculated = || asked.value(self.situation);
        self.known.borrow_mut().entry(std::ptr::from_ref(asked)).or_insert_with(calculated).clone()
    }
}

/// The reasons why an expression does not have the wanted value: one, or one for each alternative.
fn reasons(expression: &Expression, wanted: bool, state: &State) -> Vec<String> {
    match (expression, wanted) {
        (Expression::Not(part), _) => reasons(part, !wanted, state),
        (Expression::All(parts), true) | (Expression::Any(parts), false) => {
            let ask = |asked: &Asked| state.value(asked);
            let failing = parts.iter().find(|part| evaluate::holds(part, &ask) != Some(wanted));
            failing.map_or_else(Vec::new, |part| reasons(part, wanted, state))
        }
        (Expression::All(parts), false) | (Expression::Any(parts), true) => {
            let mut all: Vec<String> = Vec::new();
            for reason in parts.iter().flat_map(|part| reasons(part, wanted, state)) {
                if !all.contains(&reason) {
                    all.push(reason);
                }
            }
            all
        }
        (Expression::Truth(operand), _) => vec![truth(operand, state)],
        (Expression::Comparison { left, sign, right }, _) => {
            let sign = if wanted { *sign } else { sign.opposite() };
            vec![comparison(left, sign, right, state)]
        }
    }
}

fn value(operand: &Operand, state: &State) -> Result<Value, String> {
    evaluate::value(operand, &|asked| state.value(asked))
}

/// States that a quantity is true, or that it is false.
fn truth(operand: &Operand, state: &State) -> String {
    let situation = state.situation;
    let Term::Quantity(asked) = &operand.what else { return "this condition can never be met".to_owned() };
    match value(operand, state) {
        Ok(Value::Truth(is)) => match subject::truth(asked, is) {
            Some(sentence) => sentence.to_owned(),
            None => {
                let name = subject::of(asked, situation).name;
                format!("{} is {is}", name.strip_prefix("the ").unwrap_or(&name))
            }
        },
        Ok(_) => format!("{} is neither true nor false", subject::of(asked, situation).name),
        Err(why) => why,
    }
}

fn comparison(left: &Operand, sign: Sign, right: &Operand, state: &State) -> String {
    let situation = state.situation;
    let (left, sign, right) = match (&left.what, &right.what) {
        (Term::Value(_), Term::Quantity(_)) => (right, sign.mirrored(), left),
        _ => (left, sign, right),
    };
    let Term::Quantity(asked) = &left.what else { return "this condition can never be met".to_owned() };
    let (now, bound) = match (value(left, state), value(right, state)) {
        (Ok(now), Ok(bound)) => (now, bound),
        (Err(why), _) | (_, Err(why)) => return why,
    };
    match (&now, &bound) {
        (Value::Number(now), Value::Number(bound)) => {
            let other = match &right.what {
                Term::Quantity(other) => Some(subject::of(other, situation).name),
                Term::Value(_) => None,
            };
            number(asked, *now, sign, *bound, other.as_deref(), situation)
        }
        (Value::Truth(_), Value::Truth(_)) => truth(left, state),
        (Value::Text(now), bound) => {
            let must = match (sign, bound) {
                (Sign::NotEqual, _) => "; it must be another".to_owned(),
                (Sign::Equal, Value::Text(bound)) => numbered(asked, bound, situation.registry)
                    .map_or_else(String::new, |name| format!("; it must be {name}")),
                _ => String::new(),
            };
            text(asked, now, situation) + &must
        }
        _ => format!("{} has a value of another type", subject::of(asked, situation).name),
    }
}

/// States that a number is too small, too large, or not the required one.
fn number(
    asked: &Asked,
    now: f64,
    sign: Sign,
    bound: f64,
    other: Option<&str>,
    situation: &Situation,
) -> String {
    if asked.quantity.name == "window.selected_index" && sign == Sign::Equal {
        return format!("{} {now} is selected", crate::lesson::kind_of(situation.selection));
    }
    let subject = subject::of(asked, situation);
    if now.is_nan() {
        return format!("{} is not a number", subject.name);
    }
    let unit = |number: String| match subject.unit {
        "" => number,
        "°" => number + "°",
        unit => format!("{number} {unit}"),
    };
    let limit = match other {
        Some(other) => format!("{other}, which is {}", unit(digits(bound, now))),
        None => unit(plain(bound)),
    };
    let must = match (sign, other) {
        (Sign::Less, _) => format!("below {limit}"),
        (Sign::LessOrEqual, _) => format!("at most {limit}"),
        (Sign::Greater, _) => format!("above {limit}"),
        (Sign::GreaterOrEqual, _) => format!("at least {limit}"),
        (Sign::Equal, Some(_)) => format!("the same as {limit}"),
        // The number itself would be the solution.
        (Sign::Equal, None) if now < bound => "higher".to_owned(),
        (Sign::Equal, None) => "lower".to_owned(),
        (Sign::NotEqual, _) => "another number".to_owned(),
    };
    format!("{} is {}; it must be {must}", subject.name, unit(digits(now, bound)))
}

/// A number with three digits, or with as many as needed to distinguish it from another.
fn digits(number: f64, other: f64) -> String {
    let rounded = |after: usize| format!("{number:.after$e}").parse().unwrap_or(number);
    let apart =
        |rounded: &f64| (*rounded < other) == (number < other) && (*rounded == other) == (number == other);
    plain((2..8).map(rounded).find(apart).unwrap_or(number))
}

/// A number in plain notation.
fn plain(number: f64) -> String {
    number.to_string().replace('-', "−")
}

/// The present value of a text quantity.
fn text(asked: &Asked, now: &str, situation: &Situation) -> String {
    let registry = situation.registry;
    let model = || registry.model(now).map_or(now, |entry| entry.declaration.name);
    let shading = || registry.shading_model(now).map_or(now, |entry| entry.declaration.name);
    match asked.quantity.name {
        "window.selected" => match now {
            "room" | "observer" => format!("the {now} is selected"),
            now => format!("{} is selected", crate::text::with_article(now)),
        },
        "window.channel" => match DebugChannel::ALL.into_iter().find(|channel| channel.id() == now) {
            Some(channel) => format!("the picture shows the debug channel {}", channel.name()),
            None => "the picture shows no debug channel".to_owned(),
        },
        "window.terms" => match now {
            "all" => "all terms are shown".to_owned(),
            now => format!("the {now} term alone is shown"),
        },
        "window.plots" => match Plot::ALL.into_iter().find(|kind| kind.id() == now) {
            Some(kind) => format!("the plot that is shown is that of the {}", kind.name()),
            None => "no plot is shown".to_owned(),
        },
        "window.active" => format!("view {now} is active"),
        "window.reflection_model" => format!("the reflection model is {}", model()),
        "window.shading_model" => format!("the shading model is {}", shading()),
        "probe.object" => format!("the pinned pixel is on “{}”", shortened(now)),
        _ => {
            let subject = subject::of(asked, situation).name;
            let shown = match last(asked) {
                "reflection_model" => model(),
                "shading_model" => shading(),
                "tone_mapping" => ToneMapping::from_id(now).map_or(now, |curve| curve.name()),
                "encoding" if now == "srgb" => "sRGB",
                name => subject::parameter(name, registry).and_then(|p| p.kind.option(now)).unwrap_or(now),
            };
            format!("{subject} is {}", shortened(shown))
        }
    }
}

/// The last word of a quantity: the key of a value of the scene, or the name of a parameter.
fn last(asked: &Asked) -> &str {
    match &asked.argument {
        Argument::Name(name) => name,
        Argument::Path(path) => match path.segments().last() {
            Some(Segment::Key(key)) => key,
            _ => "",
        },
        Argument::None | Argument::Angle(_) | Argument::Declared(_) => "",
    }
}

/// The name of a choice that has a number. Unlike a name, such a number can be looked up but not be found by thinking.
fn numbered(asked: &Asked, id: &str, registry: &Registry) -> Option<&'static str> {
    let parameter = subject::parameter(last(asked), registry).filter(|p| p.kind.is_numbered())?;
    parameter.kind.option(id)
}
