//! Rephrases the compiler's errors for authors: at the author's line, with the mistake and the remedy.
//!
//! naga refers to expressions by number, to its grammar, and to the declaration instead of the call. Errors
//! in a text that it cannot parse are explained by tables ([`words`], [`grammar`]) and by the surrounding
//! text; errors in a text that it can parse, by the types of the values ([`values`]). Other messages stay
//! unchanged.

use naga::{
    Module, WithSpan,
    front::wgsl::{self, ParseError},
    valid::ValidationError,
};

use super::compose::{Composed, shown};

mod calls;
mod field;
mod grammar;
mod scan;
mod values;
mod words;

use scan::Scan;

/// A byte of the composed text, if known, and the message.
pub(super) type Explained = (Option<usize>, String);

/// The error in a text that cannot be parsed.
pub(super) fn unreadable(composed: &Composed, error: &ParseError) -> Explained {
    let text = &composed.text;
    let labels: Vec<Label> = error
        .labels()
        .filter_map(|(span, says)| Some(Label { text, range: span.to_range()?, says }))
        .filter(|label| text.get(label.range.clone()).is_some())
        .collect();
    let complaint = Complaint { composed, error, labels };
    Scan::new(text).and_then(|scan| complaint.explained(&scan)).unwrap_or_else(|| {
        (complaint.labels.first().map(|label| label.range.start), error.message().to_owned())
    })
}

/// The error in an invalid module.
pub(super) fn invalid(composed: &Composed, module: &Module, error: &WithSpan<ValidationError>) -> Explained {
    // The first position is the enclosing function.
    let last = error.spans().last().and_then(|(span, _)| Some(span.to_range()?.start));
    Scan::new(&composed.text)
        .and_then(|scan| values::explained(&scan, module, error.as_inner()))
        .map(|(at, message)| (at.or(last), message))
        .unwrap_or_else(|| (last, innermost(error.as_inner())))
}

/// The reason without its context, such as "Function [54] 'response' is invalid: Expression [18] is invalid".
fn innermost(error: &dyn std::error::Error) -> String {
    let mut reason = error;
    while let Some(inner) = reason.source() {
        reason = inner;
    }
    reason.to_string()
}

/// A position named by the compiler, with its message there.
struct Label<'a> {
    text: &'a str,
    range: std::ops::Range<usize>,
    says: &'a str,
}

impl<'a> Label<'a> {
    fn source(&self) -> &'a str {
        &self.text[self.range.clone()]
    }
}

/// A complaint about a text.
struct Complaint<'a> {
    composed: &'a Composed,
    error: &'a ParseError,
    labels: Vec<Label<'a>>,
}

impl Complaint<'_> {
    fn explained(&self, scan: &Scan) -> Option<Explained> {
        let message = self.error.message();
        let Some(first) = self.labels.first() else {
            let plain = grammar::plain(message, "").map(|(_, plain)| plain);
            return Some((self.unplaced(scan), plain.unwrap_or_else(|| message.to_owned())));
        };
        let here = |message: String| (Some(first.range.start), message);
        let i = scan.at(first.range.start);
        if let Some([name]) = between(message, "no definition in scope for identifier: `{}`") {
            return Some(here(words::unknown(scan, i, name)));
        }
        if let Some([field]) = between(message, "invalid field accessor `{}`") {
            return Some(here(field::unknown(scan, i, field)));
        }
        if let Some([name]) = between(message, "redefinition of `{}`") {
            return self.redefined(name);
        }
        if message == "invalid left-hand side of assignment" {
            return Some(here(self.assigned(scan, first)));
        }
        if message.ends_with(" is recursive") || message.ends_with(" is cyclic") {
            // Whatever uses a type uses what has its name.
            let defines = |label: &&Label| {
                let before = scan.before(scan.at(label.range.start), 1);
                words::is_type(label.source()) && matches!(before, "fn" | "struct" | "const" | "alias")
            };
            if let Some(label) = self.labels.iter().find(defines) {
                let rule = "is the name of a type of WGSL; choose another name";
                return Some((Some(label.range.start), format!("`{}` {rule}", label.source())));
            }
        }
        if let Some([expected, found]) = between(message, "expected {}, found {}") {
            return grammar::unexpected(scan, first.range.start, expected, found);
        }
        calls::explained(scan, self).or_else(|| {
            let (label, message) = grammar::plain(message, first.source())?;
            Some((Some(self.labels.get(label).unwrap_or(first).range.start), message))
        })
    }

    /// A name defined in two places, of which one may be the author's.
    fn redefined(&self, name: &str) -> Option<Explained> {
        let [current, previous, ..] = &self.labels[..] else { return None };
        let place = |label: &Label| {
            let line = label.text[..label.range.start].matches('\n').count() + 1;
            self.composed.map.locate(line)
        };
        let ((here, _), (there, line)) = (place(current)?, place(previous)?);
        // Names used by the light loop, a light or a shading model come after the model.
        let (at, file) = match there.starts_with("models/") && !here.starts_with("models/") {
            true => (previous, here),
            false => (current, there),
        };
        let message = if file.starts_with('(') {
            format!("{name} is defined by the declaration of the model; choose another name")
        } else if here == there {
            format!("`{name}` is already defined in line {line}; choose another name")
        } else {
            format!("{} defines {name} too; choose another name", shown(file))
        };
        Some((Some(at.range.start), message))
    }

    /// A value that cannot be assigned to.
    fn assigned(&self, scan: &Scan, target: &Label) -> String {
        let source = target.source();
        let name = source.split(['.', '[']).next().unwrap_or(source).trim();
        let declared = self.labels.get(1).map(|binding| scan.before(scan.at(binding.range.start), 1));
        let swizzle = |part: &str| part.len() > 1 && part.chars().all(|c| "xyzwrgba".contains(c));
        if matches!(declared, Some("let" | "const")) {
            format!("`{name}` is declared with let and keeps its value; declare it with var to change it")
        } else if declared.is_none() && source.rsplit_once('.').is_some_and(|(_, part)| swizzle(part)) {
            format!("only one component can be set at a time, as in `{name}.x = …;`")
        } else {
            format!(
                "`{name}` keeps its value, as all parameters of functions do; change a copy: `var copy = {name};`"
            )
        }
    }

    /// The statement with an error without a position: the first one up to which the text has the error.
    fn unplaced(&self, scan: &Scan) -> Option<usize> {
        /// Maximum size of a text that is parsed repeatedly, in bytes.
        const LONGEST: usize = 1 << 17;
        if scan.text.len() > LONGEST {
            return None;
        }
        let fails =
            |text: &str| wgsl::parse_str(text).is_err_and(|error| error.message() == self.error.message());
        let body = scan.bodies().into_iter().rev().find(|body| {
            let start = scan.tokens[body.start].at + 1;
            let end = scan.tokens[body.end].at;
            !fails(&[&scan.text[..start], &scan.text[end..]].concat())
        })?;
        let end = scan.tokens[body.end].at;
        let ends = scan.statements(&body);
        let wrong = ends.partition_point(|(last, open)| {
            let token = scan.tokens[*last];
            let closing = "}".repeat(open - 1);
            !fails(&[&scan.text[..token.at + 1], &closing, &scan.text[end..]].concat())
        });
        let before = wrong.checked_sub(1).map_or(body.start, |i| ends[i].0);
        (before + 1..=body.end).find(|i| scan.word(*i) != "}").map(|i| scan.tokens[i].at)
    }
}

/// The parts of a message that match the `{}` of a pattern.
fn between<'m, const N: usize>(message: &'m str, pattern: &str) -> Option<[&'m str; N]> {
    let mut pieces = pattern.split("{}");
    let mut rest = message.strip_prefix(pieces.next()?)?;
    let mut found = [""; N];
    for part in &mut found {
        let piece = pieces.next()?;
        (*part, rest) = if piece.is_empty() { (rest, "") } else { rest.split_once(piece)? };
    }
    (rest.is_empty() && pieces.next().is_none()).then_some(found)
}
