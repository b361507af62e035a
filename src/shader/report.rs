//! Shader problems for display: the message, file, line and column, the line itself and a caret below the
//! character in question.

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};

use super::check::ShaderProblem;
use crate::{files::printable, text::is_invisible};

/// A problem as several lines of plain text. `file` is the file name for the reader: its path on disk if it
/// has one.
#[must_use]
pub fn annotated(problem: &ShaderProblem, file: &str) -> String {
    rendered(problem, file, &Renderer::plain())
}

/// The problem in terminal colours.
#[must_use]
pub fn coloured(problem: &ShaderProblem, file: &str) -> String {
    rendered(problem, file, &Renderer::styled())
}

fn rendered(problem: &ShaderProblem, file: &str, renderer: &Renderer) -> String {
    // The annotation crate escapes control characters only in ASCII, and no line separators.
    let fit = |text: &str| text.replace(|c: char| is_invisible(c) && !c.is_ascii(), "\u{fffd}");
    let (source, message) = (fit(&problem.source), fit(&problem.message));
    let file = printable(file);
    if problem.line == 0 {
        let whole = format!("{file}: {message}");
        return renderer.render(&[Group::with_title(Level::ERROR.primary_title(&whole))]);
    }
    let mut characters = source.char_indices().skip(problem.column.saturating_sub(1));
    let end = source.len();
    let start = characters.next().map_or(end, |(at, _)| at);
    let next = characters.next().map_or(end, |(at, _)| at);
    let snippet = Snippet::source(&source)
        .line_start(problem.line)
        .path(&*file)
        .annotation(AnnotationKind::Primary.span(start..next));
    renderer.render(&[Level::ERROR.primary_title(&message).element(snippet)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_caret_stands_below_the_character_that_is_meant() {
        let mut problem = ShaderProblem {
            file: "models/a.wgsl".to_owned(),
            line: 12,
            column: 5,
            source: "α = βx;".to_owned(),
            message: "there is no βx".to_owned(),
        };
        let text = annotated(&problem, "/tmp/a.wgsl");
        let lines: Vec<_> = text.lines().collect();
        assert_eq!(lines[0], "error: there is no βx");
        assert!(lines[1].ends_with("--> /tmp/a.wgsl:12:5"), "{text}");
        let at = |line: &str, what| line.chars().position(|c| c == what);
        let source = lines.iter().find(|l| l.contains("α = βx;")).expect("shows the line");
        let caret = lines.iter().find(|l| l.contains('^')).expect("has a caret");
        assert_eq!(at(caret, '^'), at(source, 'β'), "{text}");
        assert!(!text.contains('\u{1b}') && coloured(&problem, "a").contains('\u{1b}'));
        // Beyond the end of the line, and in an empty one.
        problem.column = 99;
        assert!(annotated(&problem, "a").contains("there is no"));
        problem.source.clear();
        assert!(annotated(&problem, "a").contains("a:12:1"));
        // A whole file has no line to show.
        problem.line = 0;
        assert_eq!(annotated(&problem, "a"), "error: a: there is no βx");
        assert_eq!(problem.to_string(), "models/a.wgsl: there is no βx");
    }

    #[test]
    fn nothing_that_a_terminal_obeys_comes_through() {
        let odd = "a\u{1b}[2J\u{9b}2J\u{202e}\u{2028}\u{feff}b";
        let problem = ShaderProblem {
            file: odd.to_owned(),
            line: 1,
            column: 1,
            source: odd.to_owned(),
            message: odd.to_owned(),
        };
        let text = annotated(&problem, odd);
        let obeyed = text.chars().find(|c| is_invisible(*c) && *c != '\n');
        assert_eq!(obeyed, None, "{text:?}");
    }
}
