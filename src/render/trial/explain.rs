//! Explains why a candidate was refused, in terms of the author's file.

use naga::{Module, Span, front::wgsl::ParseError};
use naga_oil::compose::{ComposerError, ComposerErrorInner, ErrSource};

use super::{tools::Tools, verdict::Verdict};
use crate::shader::{
    check::{self, ShaderProblem, locate, reason},
    compose::{Composed, WRAPPER},
    whole::judged,
};

/// Mask of positions in the text, in which naga_oil packs the number of a module.
const POSITION: usize = (1 << 21) - 1;

/// The problem of a nonexistent module of Bevy: at the line that imports it, or at the line that uses a name
/// without an import.
pub(super) fn unknown_import(composed: &Composed, name: &str, tools: Tools) -> Box<ShaderProblem> {
    let modules: Vec<_> =
        tools.shaders.iter().map(|(_, s)| s.import_path.module_name().into_owned()).collect();
    let exists = |path: &str| modules.iter().any(|m| path == m || path.starts_with(&format!("{m}::")));
    let lines = || composed.text.lines().enumerate();
    let wrong = lines().find_map(|(i, line)| {
        let rest = line.trim_start().strip_prefix("#import")?.trim_start();
        let path = rest.split([' ', '{', ',']).next()?.trim_end_matches(':');
        (!exists(path)).then_some((i + 1, path))
    });
    if let Some((line, path)) = wrong {
        let message = format!(
            "there is no module `{path}` to import; files of your own are imported by name: `#import \"file.wgsl\"`"
        );
        return locate(composed, Some((line, 1)), message);
    }
    let used = lines().find_map(|(i, line)| Some((i + 1, line.find(&format!("{name}::"))? + 1)));
    locate(composed, used, format!("`{name}` is used, but no `#import` provides it"))
}

/// The composer's error, in terms of the author's file.
pub(super) fn refusal(composed: &Composed, faces: bool, error: &ComposerError) -> Verdict {
    use ComposerErrorInner as Inner;
    let about_text = matches!(
        error.inner,
        Inner::WgslParseError(_) | Inner::HeaderValidationError(_) | Inner::ShaderValidationError(_)
    );
    // The same wording as elsewhere, if the text can be parsed without the composer.
    if let Some(Err(problem)) = about_text.then(|| judged(composed, faces)).flatten() {
        return Verdict::Bad(problem);
    }
    let offset = match &error.source {
        ErrSource::Constructing { offset, .. } => *offset,
        // In one of Bevy's own modules: the wrapper imports it.
        ErrSource::Module { name, .. } => {
            let line = composed.text.lines().position(|l| l.contains(name.as_str())).map(|l| (l + 1, 1));
            return Verdict::Bad(locate(composed, line, error.inner.to_string()));
        }
    };
    let parse = |e: &ParseError| located(composed, offset, e.labels().map(|l| l.0), e.message().to_owned());
    match &error.inner {
        Inner::WgslParseError(e) => parse(e),
        Inner::HeaderValidationError(e) | Inner::ShaderValidationError(e) => {
            located(composed, offset, e.spans().map(|s| s.0), reason(e.as_inner()))
        }
        Inner::InvalidIdentifier { at, .. } => {
            located(composed, offset, [*at].into_iter(), error.inner.to_string())
        }
        Inner::ImportParseError(_, at)
        | Inner::ImportNotFound(_, at)
        | Inner::NotEnoughEndIfs(at)
        | Inner::TooManyEndIfs(at)
        | Inner::ElseWithoutCondition(at)
        | Inner::UnknownShaderDef { pos: at, .. }
        | Inner::UnknownShaderDefOperator { pos: at, .. }
        | Inner::InvalidShaderDefComparisonValue { pos: at, .. }
        | Inner::OverrideNotVirtual { pos: at, .. }
        | Inner::DefineInModule(at)
        | Inner::InvalidShaderDefDefinitionValue { pos: at, .. } => {
            let span = Span::new(*at as u32, *at as u32 + 1);
            located(composed, 0, [span].into_iter(), error.inner.to_string())
        }
        Inner::DecorationInSource(range) => {
            let span = Span::new(range.start as u32, range.end as u32);
            located(composed, 0, [span].into_iter(), error.inner.to_string())
        }
        other => Verdict::Bad(locate(composed, None, other.to_string())),
    }
}

/// A problem at the first of several places that are one. The composer inserts `offset` bytes before our
/// text, and replaces everything that it handles by as many spaces, so that lines and columns stay.
pub(super) fn located(
    composed: &Composed,
    offset: usize,
    spans: impl Iterator<Item = Span>,
    message: String,
) -> Verdict {
    let text = &composed.text;
    let place = spans
        .filter_map(|span| span.to_range())
        .filter_map(|range| (range.start & POSITION).checked_sub(offset))
        .find(|at| *at < text.len() && text.is_char_boundary(*at))
        .map(|at| {
            let before = &text[..at];
            let line_start = before.rfind('\n').map_or(0, |i| i + 1);
            (before.matches('\n').count() + 1, at - line_start + 1)
        });
    Verdict::Bad(locate(composed, place, message))
}

/// The distance between positions in a composed module and in our text, by the majority of functions.
pub(super) fn offset(module: &Module, text: &str) -> usize {
    let mut offsets: Vec<usize> = module
        .functions
        .iter()
        .filter_map(|(handle, function)| {
            let start = module.functions.get_span(handle).to_range()?.start & POSITION;
            start.checked_sub(text.find(&format!("fn {}(", function.name.as_deref()?))?)
        })
        .collect();
    offsets.sort_unstable();
    let runs = offsets.chunk_by(|a, b| a == b);
    runs.max_by_key(|run| run.len()).and_then(|run| run.first()).copied().unwrap_or(0)
}

/// The driver's error about a composed source, in terms of the author's file.
pub(crate) fn refused(composed: &Composed, error: &wgpu::Error) -> Box<ShaderProblem> {
    let (place, message) = explain(composed, &deepest(error));
    locate(composed, place, message)
}

/// The last two links of a chain of errors: the mismatch and its reason.
pub(super) fn deepest(error: &dyn std::error::Error) -> String {
    let links: Vec<_> =
        std::iter::successors(error.source(), |e| e.source()).map(ToString::to_string).collect();
    match &links[..] {
        [] => error.to_string(),
        links => links[links.len().saturating_sub(2)..].join(": "),
    }
}

/// The driver's error, and the corresponding line of the composed text: it names binding numbers, locations
/// and entry points, but no lines.
pub(super) fn explain(composed: &Composed, complaint: &str) -> (Option<(usize, usize)>, String) {
    let line_of = |what: &str| {
        let lines: Vec<_> = composed.text.lines().collect();
        lines.iter().rposition(|line| line.contains(what)).map(|line| (line + 1, 1))
    };
    let number = |after: &str| {
        let digits: String =
            complaint.split(after).nth(1)?.chars().take_while(char::is_ascii_digit).collect();
        (!digits.is_empty()).then_some(digits)
    };
    let message = complaint.lines().map(str::trim).filter(|l| !l.is_empty()).collect::<Vec<_>>().join(" ");
    let binding = number("binding: ").map(|n| {
        let message = format!(
            "@binding({n}) does not exist: the renderer provides 0, the parameters, and 1, the lights ({message})"
        );
        (line_of(&format!("@binding({n})")), message)
    });
    let location = || {
        let n = number("ocation[").or_else(|| number("@location("))?;
        let message = format!("@location({n}) differs between the vertex and the fragment stage ({message})");
        Some((line_of(&format!("@location({n})")), message))
    };
    let entry = || {
        let name = complaint.split("entry point '").nth(1)?.split('\'').next()?;
        let message = format!("the function `{name}` with @{name} is missing: it is the entry point");
        Some((line_of(&format!("@{name}")), message))
    };
    let wrapper = || {
        let of_wrapper = |l: &usize| composed.map.locate(*l).is_some_and(|(f, _)| f == WRAPPER.path);
        (1..=composed.text.lines().count()).find(of_wrapper).map(|l| (l, 1))
    };
    binding
        .or_else(location)
        .or_else(entry)
        .unwrap_or_else(|| (wrapper(), format!("the graphics driver rejects it: {message}")))
}

/// The problem of a text on which the composer itself fails.
pub(super) fn without_place(composed: &Composed) -> Box<ShaderProblem> {
    // Plain parsing may find the cause.
    match check::validate(composed) {
        Err(problem) if problem.file != WRAPPER.path => problem,
        _ => locate(composed, None, "the shader cannot be composed; the last change is the cause".to_owned()),
    }
}
