//! Errors in shader files, each with its source line.

use super::open_in_editor;
use crate::{
    library::status::{Trouble, shown_instead},
    panel::{prelude::*, state::Effect},
    shader::report::annotated,
};

/// The consequence of a problem for the picture.
#[must_use]
pub fn consequence(trouble: &Trouble) -> String {
    if trouble.stale.is_empty() {
        return "Nothing in the picture depends on it.".to_owned();
    }
    format!("The picture shows {} until this is corrected.", shown_instead(&trouble.stale))
}

/// Width of a tab, in characters.
const TAB: usize = 4;

/// A source line, short enough for display, and the position of an error in it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Excerpt {
    /// The text without tabs, cut to the available width; `…` marks a cut.
    pub text: String,
    /// Index of the character in question, from 0; may be one past the end.
    pub caret: usize,
}

/// The part of a source line around a column (in characters, from 1, possibly past the end) that fits into `room`
/// characters. Tabs become spaces up to the next multiple of four.
#[must_use]
pub fn excerpt(source: &str, column: usize, room: usize) -> Excerpt {
    let mut chars: Vec<char> = Vec::new();
    let mut caret = None;
    for (i, c) in source.trim_end().chars().enumerate() {
        if i + 1 == column.max(1) {
            caret = Some(chars.len());
        }
        match c {
            '\t' => chars.extend(std::iter::repeat_n(' ', TAB - chars.len() % TAB)),
            c => chars.push(c),
        }
    }
    let mut caret = caret.unwrap_or(chars.len());
    // Indentation carries no information.
    let indent = chars.iter().take(caret).take_while(|c| **c == ' ').count();
    let room = room.max(8);
    if chars.len() > room && indent > 0 {
        chars.drain(..indent);
        caret -= indent;
    }
    if chars.len() > room {
        // The text before the position explains more than the text after it.
        let start = (caret + room / 3 + 1).saturating_sub(room).min(chars.len() - room);
        let end = (start + room).min(chars.len());
        let (cut_start, cut_end) = (start > 0, end < chars.len());
        chars = chars[start..end].to_vec();
        caret -= start;
        if cut_start {
            chars[0] = '…';
        }
        if cut_end && let Some(last) = chars.last_mut() {
            *last = '…';
        }
    }
    Excerpt { text: chars.into_iter().collect(), caret }
}

/// A problem as text: message, location, source line with caret, consequence.
#[must_use]
pub fn report(trouble: &Trouble) -> String {
    let path = trouble.path.as_ref().map(|path| path.shown().to_string());
    let text = annotated(&trouble.problem, path.as_deref().unwrap_or(&trouble.problem.file));
    format!("{text}\n{}\n", consequence(trouble))
}

pub(super) fn troubles(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let mut all: Vec<_> = context.session().shaders.troubles.iter().collect();
    // Problems that affect the picture come first.
    all.sort_by_key(|t| t.stale.is_empty());
    ScrollArea::vertical().id_salt("troubles").auto_shrink(false).show(ui, |ui| {
        ui.set_width(ui.available_width() - 8.0);
        for (i, trouble) in all.into_iter().enumerate() {
            if i > 0 {
                ui.separator();
            }
            ui.push_id(i, |ui| self::trouble(ui, trouble, context));
        }
    });
}

fn trouble(ui: &mut Ui, trouble: &Trouble, context: &mut PanelContext<'_>) {
    let p = &trouble.problem;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        icon::sign(ui, [16.0, 24.0], 6.0, Severity::Error).on_hover_text(Severity::Error.name());
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            if let Some(path) = &trouble.path {
                let open = ui.button("Open in editor").on_hover_text(path.shown().to_string());
                context.on_click(&open, || open_in_editor(path, p.line.max(1)));
            }
            let button = ui.button("Copy").on_hover_text("Copy place, message and line");
            context.on_click(&button, || Action::Do(Effect::CopyText(report(trouble))));
            let place = p.place(&p.file);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                ui.add(Label::new(theme::strong(ui, place)).truncate());
            });
        });
    });
    ui.add(Label::new(RichText::new(&p.message).color(Palette::here(ui).error)).wrap().selectable(true));
    source_line(ui, trouble);
    ui.add(Label::new(consequence(trouble)).wrap());
}

/// The source line with its number, and a caret below the position.
fn source_line(ui: &mut Ui, trouble: &Trouble) {
    let p = &trouble.problem;
    if p.source.trim().is_empty() {
        return;
    }
    let palette = Palette::here(ui);
    let font = FontId::monospace(TextStyle::Body.resolve(ui.style()).size);
    let plain = |text: String, colour| ui.painter().layout_no_wrap(text, font.clone(), colour);
    let number = plain(p.line.to_string(), palette.weak);
    let advance = plain("0".repeat(10), palette.text).size().x / 10.0;
    let padding = vec2(8.0, 4.0);
    let gutter = number.size().x + 2.0 * padding.x;
    let width = ui.available_width();
    let room = ((width - gutter - 2.0 * padding.x) / advance).floor().max(0.0) as usize;
    let shown = excerpt(&p.source, p.column, room);
    let source = plain(shown.text.clone(), palette.text);
    // Larger than the text, so that it is easy to find.
    let large = FontId::monospace(1.5 * font.size);
    let caret = ui.painter().layout_no_wrap("^".to_owned(), large, palette.error);
    let height = source.size().y + 0.55 * caret.size().y + 2.0 * padding.y;
    let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
    theme::says(&response, WidgetType::Label, format!("line {}: {}", p.line, p.source.trim()));
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 4.0, palette.field);
    let top = rect.min + padding;
    painter.galley(top, number, palette.weak);
    let left = rect.left() + gutter;
    painter.vline(left - 0.5 * padding.x, rect.y_range().shrink(2.0), Stroke::new(1.0, palette.line));
    let at = pos2(left + padding.x, top.y);
    // Taken from the laid-out text, since not all characters have the same width.
    let here = source.pos_from_cursor(egui::text::CCursor::new(shown.caret));
    let middle = here.min.x + 0.5 * advance;
    let under = at + vec2(middle - 0.5 * caret.size().x, source.size().y - 0.1 * caret.size().y);
    painter.galley(at, source, palette.text);
    painter.galley(under, caret, palette.error);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(source: &str, column: usize, room: usize) -> (String, usize) {
        let e = excerpt(source, column, room);
        (e.text, e.caret)
    }

    #[test]
    fn the_caret_stands_under_the_column_whatever_comes_before() {
        assert_eq!(at("let x = ;", 9, 80), ("let x = ;".to_owned(), 8));
        assert_eq!(at("\tlet x = ;", 10, 80), ("    let x = ;".to_owned(), 12), "a tab is four wide");
        assert_eq!(at("ab\tx", 4, 80), ("ab  x".to_owned(), 4), "a tab ends at the next stop");
        assert_eq!(at("/* 漢 */ x", 9, 80).1, 8, "characters, not bytes");
        assert_eq!(at("abc", 99, 80), ("abc".to_owned(), 3), "past the end");
        assert_eq!(at("abc", 0, 80).1, 0);
        assert_eq!(at("", 1, 80), (String::new(), 0));
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let line: String = ('a'..='z').cycle().take(200).collect();
        for column in [1, 5, 30, 100, 170, 200, 201] {
            let (text, caret) = at(&line, column, 40);
            assert_eq!(text.chars().count(), 40, "{column}");
            assert!(caret <= 40);
            if column <= 200 {
                let meant = line.chars().nth(column - 1);
                let shown = text.chars().nth(caret);
                assert!(
                    shown == meant || shown == Some('…') && (column == 1 || column == 200),
                    "{column}: {text}"
                );
            }
        }
        let (text, caret) = at(&format!("{}let x = ;", " ".repeat(60)), 69, 40);
        assert_eq!((text.as_str(), caret), ("let x = ;", 8), "indentation goes first");
    }
}
