//! Readable layout of JSON.

use std::io;

use jsonc_parser::common::Ranged as _;
use serde_json::ser::Formatter;

use crate::text::json::{self, Ast, STRICT};

/// Compact JSON with the shortest numbers that are read back exactly, and whole numbers without `.0`.
pub(crate) struct ShortNumbers;

impl Formatter for ShortNumbers {
    fn write_f32<W: ?Sized + io::Write>(&mut self, writer: &mut W, value: f32) -> io::Result<()> {
        if value != 0.0 && !(1e-6..1e15).contains(&value.abs()) {
            write!(writer, "{value:e}")
        } else {
            write!(writer, "{value}")
        }
    }
}

/// The maximum length of a line that can be broken.
const LINE_WIDTH: usize = 110;

/// Formats JSON: anything that fits on a line is on one; lists of objects have at least one line per entry.
pub(crate) fn pretty(compact: &str) -> Option<String> {
    let value = json::parse(compact, &STRICT).ok()??;
    let mut out = String::with_capacity(2 * compact.len());
    lay_out(&value, compact, 0, 0, &mut out);
    out.push('\n');
    Some(out)
}

/// The values in an object or a list, each with its name as written, in quotes, if it has one; and the brackets around
/// them, and what stands after each name. None for other values.
type Items<'v> = Option<(Vec<(&'v str, &'v Ast<'v>)>, [&'static str; 3])>;

fn items<'v>(value: &'v Ast<'v>, text: &'v str) -> Items<'v> {
    match value {
        Ast::Object(object) => {
            let named = object.properties.iter().map(|property| (property.name.text(text), &property.value));
            Some((named.collect(), ["{", "}", ": "]))
        }
        Ast::Array(array) => Some((array.elements.iter().map(|item| ("", item)).collect(), ["[", "]", ""])),
        _ => None,
    }
}

/// Writes a value; the cursor is at `column`, and broken lines are indented by `depth` steps.
fn lay_out(value: &Ast, text: &str, depth: usize, column: usize, out: &mut String) {
    let has_objects =
        matches!(value, Ast::Array(a) if a.elements.iter().any(|e| matches!(e, Ast::Object(_))));
    if depth > 0 && !has_objects {
        let start = out.len();
        lay_flat(value, text, out);
        // Room for the comma that may follow.
        if column + out[start..].chars().count() < LINE_WIDTH {
            return;
        }
        out.truncate(start);
    }
    let Some((items, [open, close, after])) = items(value, text) else {
        return out.push_str(value.text(text));
    };
    let indent = |out: &mut String, depth: usize| {
        out.push('\n');
        out.extend(std::iter::repeat_n("  ", depth));
    };
    out.push_str(open);
    for (i, (name, item)) in items.into_iter().enumerate() {
        out.push_str(if i > 0 { "," } else { "" });
        indent(out, depth + 1);
        out.extend([name, after]);
        lay_out(item, text, depth + 1, 2 * (depth + 1) + name.chars().count() + after.len(), out);
    }
    indent(out, depth);
    out.push_str(close);
}

/// Writes a value on one line.
fn lay_flat(value: &Ast, text: &str, out: &mut String) {
    let Some((items, [open, close, after])) = items(value, text) else {
        return out.push_str(value.text(text));
    };
    let space = if items.is_empty() || after.is_empty() { "" } else { " " };
    out.extend([open, space]);
    for (i, (name, item)) in items.into_iter().enumerate() {
        out.extend([if i > 0 { ", " } else { "" }, name, after]);
        lay_flat(item, text, out);
    }
    out.extend([space, close]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_as_short_as_they_can_be_and_read_back_exactly() {
        for (v, expected) in [
            (0.1, "0.1"),
            (2.0, "2"),
            (-0.0, "-0"),
            (f32::MAX, "3.4028235e38"),
            (f32::MIN_POSITIVE, "1.1754944e-38"),
            (1.0 / 3.0, "0.33333334"),
        ] {
            let mut text = Vec::new();
            ShortNumbers.write_f32(&mut text, v).expect("memory takes all");
            let text = String::from_utf8(text).expect("numbers are ASCII");
            assert_eq!(text, expected);
            assert_eq!(text.parse::<f32>().map(f32::to_bits), Ok(v.to_bits()));
        }
    }
}
