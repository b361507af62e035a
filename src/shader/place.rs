//! Places in composed texts, in terms of the author's files.

use super::{compose::Composed, problem::ShaderProblem};

/// Line and column of a byte, both from 1.
pub(super) fn place(composed: &Composed, at: usize) -> (usize, usize) {
    let before = composed.text.get(..at).unwrap_or_default();
    (before.matches('\n').count() + 1, before.len() - before.rfind('\n').map_or(0, |i| i + 1) + 1)
}

/// A problem at a line and column of the composed text, in terms of the author's file.
pub(crate) fn locate(
    composed: &Composed,
    place: Option<(usize, usize)>,
    message: String,
) -> Box<ShaderProblem> {
    /// The longest message, characters: some of naga's repeat the text.
    const LONGEST: usize = 400;
    let message = match message.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &message[..end]),
        None => message,
    };
    let (line, column) = place.unwrap_or((1, 1));
    let (file, file_line) = composed.map.locate(line).unwrap_or(("(composed)", line));
    let source = composed.text.lines().nth(line.saturating_sub(1)).unwrap_or_default();
    Box::new(ShaderProblem {
        file: file.to_owned(),
        line: file_line,
        // naga counts bytes.
        column: source.char_indices().take_while(|(at, _)| at + 1 < column).count() + 1,
        source: source.to_owned(),
        message,
    })
}
