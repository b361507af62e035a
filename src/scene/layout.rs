//! Readable layout of JSON.

use std::io;

use jsonc_parser::common::Ranged as _;
use serde_json::ser::Formatter;

use crate::text::json::{self, Ast, STRICT};

/// Compact JSON with the shortest numbers that are read back exactly, and whole numbers without `.0`.
pub(super) struct ShortNumbers;

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
pub(super) fn pretty(compact: &str) -> Option<String> {
    let value = json::parse(compact, &STRICT).ok()??;
    let mut out = String::with_capacity(2 * compact.len());
    lay_out(&value, compact, 0, 0, &mut out);
    out.push('\n');
    Some(out)
}

/// Writes a value; the cursor is at `column`, and broken lines are indented by `depth` steps.
fn lay_out(value: &Ast, text: &str, depth: usize, column: usize, out: &mut String) {
    let has_objects =
        matches!(value, Ast::Array(a) if a.elements.iter().any(|e| matches!(e, Ast::Object(_))));
    // Room for the comma that may follow.
    if depth > 0 && !has_objects && column + width(value, text) < LINE_WIDTH {
        return lay_flat(value, text, out);
    }
    let indent = |out: &mut String, depth: usize| {
        out.push('\n');
        out.extend(std::iter::repeat_n("  ", depth));
    };
    match value {
        Ast::Object(object) => {
            out.push('{');
            for (i, property) in object.properties.iter().enumerate() {
                if i > 0 {
                    out.push(',');
                }
                indent(out, depth + 1);
                let name = name_text(property, text);
                out.push_str(name);
                out.push_str(": ");
                let column = 2 * (depth + 1) + name.chars().count() + 2;
                lay_out(&property.value, text, depth + 1, column, out);
            }
            indent(out, depth);
            out.push('}');
        }
        Ast::Array(array) => {
            out.push('[');
            for (i, element) in array.elements.iter().enumerate() {
                if i > 0 {
                    out.push(',');
                }
                indent(out, depth + 1);
                lay_out(element, text, depth + 1, 2 * (depth + 1), out);
            }
            indent(out, depth);
            out.push(']');
        }
        scalar => out.push_str(scalar.text(text)),
    }
}

/// The name of a property as written, in quotes.
fn name_text<'t>(property: &jsonc_parser::ast::ObjectProp, text: &'t str) -> &'t str {
    property.name.text(text)
}

/// The width of a value on one line.
fn width(value: &Ast, text: &str) -> usize {
    match value {
        Ast::Object(o) if o.properties.is_empty() => 2,
        Ast::Object(o) => {
            let fields = o.properties.iter();
            2 + fields
                .map(|p| name_text(p, text).chars().count() + 2 + width(&p.value, text) + 2)
                .sum::<usize>()
        }
        Ast::Array(a) => {
            a.elements.iter().map(|e| width(e, text)).sum::<usize>() + 2 * a.elements.len().max(1)
        }
        scalar => scalar.text(text).chars().count(),
    }
}

/// Writes a value on one line.
fn lay_flat(value: &Ast, text: &str, out: &mut String) {
    match value {
        Ast::Object(o) if o.properties.is_empty() => out.push_str("{}"),
        Ast::Object(o) => {
            for (i, property) in o.properties.iter().enumerate() {
                out.push_str(if i == 0 { "{ " } else { ", " });
                out.push_str(name_text(property, text));
                out.push_str(": ");
                lay_flat(&property.value, text, out);
            }
            out.push_str(" }");
        }
        Ast::Array(a) => {
            out.push('[');
            for (i, element) in a.elements.iter().enumerate() {
                if i > 0 {
                    out.push_str(", ");
                }
                lay_flat(element, text, out);
            }
            out.push(']');
        }
        scalar => out.push_str(scalar.text(text)),
    }
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
