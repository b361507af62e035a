//! Values of the wrong type or number: in constructors, in calls, in results of functions.

use super::{
    Complaint, Explained, between,
    scan::{Scan, called, given, misfit, remedy, result, shown},
};
use crate::text::{listed, plural};

/// WGSL functions as called, for messages.
const USAGE: &str = include_str!("usage.txt");

/// A WGSL function as called; only its name if that is sufficient.
fn usage(name: &str) -> &str {
    let with = |usage: &&str| usage.strip_prefix(name).is_some_and(|rest| rest.starts_with('('));
    USAGE.lines().find(with).unwrap_or(name)
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
        // The first position is that of the declaration, with a struct.
        let value = labels.last()?;
        if let Some(name) = scan.name_of(scan.at(value.range.start)) {
            let target = shown(first.source().split('=').next().unwrap_or_default().trim());
            let message = format!("{target} is {}, but {}", called(expected), misfit(expected, got, name));
            return Some((place(first), message));
        }
        return Some((
            place(value),
            converted(scan, scan.at(value.range.start), expected, got, value.source()),
        ));
    }
    if let Some([name, expected, got]) =
        between(message, "the type of `{}` is expected to be `{}`, but got `{}`")
    {
        // The position is that of the name.
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
        // The end of a range is exclusive.
        let fewest = expected.split("..").next()?;
        let count = plural(fewest.parse().ok()?, "value");
        let takes = if fewest == expected { count } else { format!("at least {count}") };
        return Some((
            place(first),
            format!("{} takes {takes}, but {}", usage(name), given(found.parse().ok()?)),
        ));
    }
    if let Some([name]) = between(message, "too many arguments passed to `{}`") {
        let [number] = between(rest.first()?.says, "unexpected argument #{}")?;
        let count = plural(number.parse::<usize>().ok()?.saturating_sub(1), "value");
        let hint = if name == "atan" { "; the angle of a point is atan2(y, x)" } else { "" };
        return Some((place(first), format!("{} takes {count}, but more are given{hint}", usage(name))));
    }
    // The compiler names the position where a named value was calculated; the call is the first position.
    let call = scan.at(first.range.start);
    let argument = |number: &str| {
        let part = scan.parts(call + 1).get(number.parse::<usize>().ok()?.checked_sub(1)?)?.clone();
        Some((Some(scan.tokens[part.start].at), scan.source(part)))
    };
    if let Some([number, name]) = between(message, "wrong type passed as argument #{} to `{}`") {
        let [_, got] = between(rest.first()?.says, "argument #{} has type `{}`")?;
        let (at, value) = argument(number)?;
        let fields = scan.fields_of(got, value);
        let what = format!("argument {number} of {} is {}, {}", usage(name), shown(value), called(got));
        return Some((at, what + &fields.unwrap_or_else(|| allowed(complaint, got, value))));
    }
    if let Some([number, name]) = between(message, "inconsistent type passed as argument #{} to `{}`") {
        let [wrong, other] = rest else { return None };
        let [_, got] = between(wrong.says, "argument #{} has type {}")?;
        let [of] = between(other.says, "this argument has type {}, which constrains subsequent arguments")?;
        let report = complaint.error.emit_to_string(&complaint.composed.text);
        let earlier = report.split_once("Because argument #")?.1.split(' ').next()?;
        let ((at, value), (_, before)) = (argument(number)?, argument(earlier)?);
        let hint = match remedy(of, got, value) {
            hint if hint.contains("write") => hint,
            _ if of.starts_with("vec") => String::new(),
            _ => remedy(got, of, before),
        };
        let both = format!("{} is {} and {} is {}", shown(before), called(of), shown(value), called(got));
        return Some((
            at,
            format!("the arguments of {} must have the same type, but {both}{hint}", usage(name)),
        ));
    }
    None
}

/// The end of a message about a value of a type that a function does not accept. The compiler lists the
/// accepted types only in the notes of its report.
fn allowed(complaint: &Complaint, got: &str, value: &str) -> String {
    let report = complaint.error.emit_to_string(&complaint.composed.text);
    let types = report.lines().filter_map(|line| line.split_once("allowed type: "));
    let types: Vec<_> = types.map(|(_, of)| of.trim()).collect();
    let number = types.contains(&"f32");
    let vectors = types.iter().any(|of| of.starts_with("vec") && of.contains("f32"));
    match (number, vectors) {
        (true, _) if matches!(got, "i32" | "u32" | "bool") => remedy("f32", got, value),
        (true, true) => "; it must be a number or a vector".to_owned(),
        (false, true) => "; it must be a vector".to_owned(),
        _ => format!("; it must be {}", listed(&types, "or")),
    }
}

/// The message about a value, the token `i`, that cannot be converted to the expected type.
fn converted(scan: &Scan, i: usize, expected: &str, got: &str, value: &str) -> String {
    if scan.before(i, 1) == "return" {
        return result(scan, scan.function(i).unwrap_or("the function"), Some(expected), got, value);
    }
    let target = scan.before(i, 2);
    if scan.before(i, 1) == "=" && matches!(scan.before(i, 3), ";" | "{" | "}") {
        return format!("`{target}` is {}, but {}", called(expected), misfit(expected, got, value));
    }
    let call = scan
        .around(i)
        .and_then(|(open, nth)| scan.declared(scan.before(open, 1))?.wants_other(nth, got, value));
    call.unwrap_or_else(|| format!("this must be {}, but {}", called(expected), misfit(expected, got, value)))
}
