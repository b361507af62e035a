//! Values of a wrong type or number: where a struct is made, in calls, in what a function returns.

use super::{
    Complaint, Explained, between,
    scan::{Scan, are, called, misfit, remedy, result, shown},
};
use crate::text::{listed, plural};

/// Functions of WGSL as called, for messages.
const USAGE: &[&str] = &[
    "atan2(y, x)",
    "clamp(x, low, high)",
    "cross(a, b)",
    "distance(a, b)",
    "dot(a, b)",
    "max(a, b)",
    "min(a, b)",
    "mix(a, b, t)",
    "pow(base, exponent)",
    "reflect(direction, normal)",
    "refract(direction, normal, ratio)",
    "select(if_false, if_true, condition)",
    "smoothstep(low, high, x)",
    "step(edge, x)",
];

/// A function of WGSL as called; its name alone if that is clear.
fn usage(name: &str) -> &str {
    let with = |usage: &&&str| usage.strip_prefix(name).is_some_and(|rest| rest.starts_with('('));
    USAGE.iter().find(with).copied().unwrap_or(name)
}

/// The explanation of a complaint about values.
pub(super) fn explained(scan: &Scan, complaint: &Complaint) -> Option<Explained> {
    let message = complaint.error.message();
    let labels = &complaint.labels;
    let [first, rest @ ..] = &labels[..] else { return None };
    let place = |label: &super::Label| Some(label.range.start);
    let converts = between(message, "automatic conversions cannot convert `{}` to `{}`")
        .or_else(|| between(message, "automatic conversions cannot convert elements of `{}` to `{}`"));
    if let Some([got, expected]) = converts {
        // The first place is that of the declaration, with a struct.
        let value = labels.last()?;
        return Some((
            place(value),
            converted(scan, scan.at(value.range.start), expected, got, value.source()),
        ));
    }
    if let Some([name, expected, got]) =
        between(message, "the type of `{}` is expected to be `{}`, but got `{}`")
    {
        // The place is that of the name.
        let i = scan.at(first.range.start);
        let begins = (i..scan.tokens.len()).find(|j| scan.word(*j) == "=")? + 1;
        let end = (begins..scan.tokens.len()).find(|j| scan.word(*j) == ";")?;
        let value = scan.source(begins..end);
        let message =
            format!("`{name}` is declared as {}, but {}", called(expected), misfit(expected, got, value));
        return Some((place(first), message));
    }
    if let Some([expected, found]) = between(message, "wrong number of arguments: expected {}, found {}") {
        let name = scan.word(scan.at(first.range.start));
        // The end of a range is beyond it.
        let fewest = expected.split("..").next()?;
        let count = plural(fewest.parse().ok()?, "value");
        let takes = if fewest == expected { count } else { format!("at least {count}") };
        return Some((
            place(first),
            format!("{} takes {takes}, but here {}", usage(name), are(found.parse().ok()?)),
        ));
    }
    if let Some([name]) = between(message, "too many arguments passed to `{}`") {
        let [number] = between(rest.first()?.says, "unexpected argument #{}")?;
        let count = plural(number.parse::<usize>().ok()?.saturating_sub(1), "value");
        let hint = if name == "atan" { "; the angle of a point is atan2(y, x)" } else { "" };
        return Some((place(first), format!("{} takes {count}, but here are more{hint}", usage(name))));
    }
    if let Some([_, name]) = between(message, "wrong type passed as argument #{} to `{}`") {
        let value = rest.first()?;
        let [number, got] = between(value.says, "argument #{} has type `{}`")?;
        let allowed = allowed(complaint);
        let hint = match remedy("f32", got, value.source()) {
            hint if allowed.contains(&"f32".to_owned()) && !hint.is_empty() => hint,
            _ => format!("; it must be {}", listed(&allowed, "or")),
        };
        let what = format!("value {number} of {} is {}, {}", usage(name), shown(value.source()), called(got));
        return Some((place(value), what + &hint));
    }
    if let Some([_, name]) = between(message, "inconsistent type passed as argument #{} to `{}`") {
        let [value, other] = rest else { return None };
        let [_, got] = between(value.says, "argument #{} has type {}")?;
        let [of] = between(other.says, "this argument has type {}, which constrains subsequent arguments")?;
        let (value, other) = match remedy(of, got, value.source()) {
            hint if hint.contains("write") => {
                (misfit(of, got, value.source()), format!("{} is {}", shown(other.source()), called(of)))
            }
            _ => (format!("{} is {}", shown(value.source()), called(got)), misfit(got, of, other.source())),
        };
        return Some((
            place(rest.first()?),
            format!("the values of {} must have one type, but {other} and {value}", usage(name)),
        ));
    }
    None
}

/// The types that the compiler allows, which it tells in the notes of its report only; those of numbers if there are.
fn allowed(complaint: &Complaint) -> Vec<String> {
    let report = complaint.error.emit_to_string(&complaint.composed.text);
    let types = report.lines().filter_map(|line| line.split_once("allowed type: "));
    let mut types: Vec<_> = types.map(|(_, of)| of.trim().to_owned()).collect();
    if types.iter().any(|of| of.contains("f32")) {
        types.retain(|of| of.contains("f32"));
    }
    types
}

/// The message about a value, the token `i`, that does not become one of the expected type.
fn converted(scan: &Scan, i: usize, expected: &str, got: &str, value: &str) -> String {
    if scan.before(i, 1) == "return" {
        return result(scan, scan.function(i).unwrap_or("the function"), Some(expected), got, value);
    }
    let call = scan
        .around(i)
        .and_then(|(open, nth)| scan.declared(scan.before(open, 1))?.wants_other(nth, got, value));
    call.unwrap_or_else(|| format!("here belongs {}, but {}", called(expected), misfit(expected, got, value)))
}
