//! The text field: gutter, text, marks.

use std::ops::Range;

use bevy_egui::egui::{
    Event, TextBuffer, TextEdit,
    text::{CCursor, CCursorRange},
    text_edit::{TextEditOutput, TextEditState},
};

use super::{
    CodePanel, Mark,
    find::line,
    finder, keyboard,
    keyboard::{Line, Typing},
    language,
    steps::State,
    tokens,
    words::Word,
};
use crate::panel::{
    focus,
    prelude::*,
    state::{CodeCommand, OpenCode},
};

/// Height of the line below the text, in points.
const FOOT: f32 = 22.0;
/// Room between line numbers and text, in points.
const GAP: f32 = 10.0;

/// Thickness of the line below a word with an error, and the distance of its middle from the end of the row, in points.
const UNDERLINE: (f32, f32) = (1.5, 2.0);

/// Lines that stay in sight above and below the cursor.
const AROUND: f32 = 2.0;

/// The id of the field of a text.
fn id_of(open: &OpenCode) -> Id {
    Id::new(("code", open.number))
}

/// The byte of a character.
pub(super) fn byte(text: &str, character: usize) -> usize {
    text.char_indices().nth(character).map_or(text.len(), |(at, _)| at)
}

/// The character of a byte.
pub(super) fn character(text: &str, byte: usize) -> usize {
    text[..text.floor_char_boundary(byte)].chars().count()
}

/// The fill and the rim of a place that was found, or of the one that is selected.
fn found_look(selected: bool, palette: &Palette) -> (Color32, Stroke) {
    match selected {
        true => (palette.warning.gamma_multiply(0.35), Stroke::new(2.0, palette.warning)),
        false => (Color32::TRANSPARENT, Stroke::new(1.0, palette.warning)),
    }
}

/// The byte of another version of a text that is beside the same as a byte of this one. Within what has changed, it stays
/// as far from the start, as nearly as it can.
fn moved(from: &str, to: &str, at: usize) -> usize {
    let alike = |all: &mut dyn Iterator<Item = (char, char)>| -> usize {
        all.take_while(|(a, b)| a == b).map(|(a, _)| a.len_utf8()).sum()
    };
    let at = at.min(from.len());
    let before = alike(&mut from.chars().zip(to.chars()));
    if at <= before {
        return at;
    }
    let behind = alike(&mut from[before..].chars().rev().zip(to[before..].chars().rev()));
    if at + behind >= from.len() {
        return to.len() - (from.len() - at);
    }
    to.floor_char_boundary(at.clamp(before, to.len() - behind))
}

/// Puts the cursor of a text, and the other end of what is selected, at these bytes.
fn put_cursor(ctx: &Context, open: &OpenCode, ends: [usize; 2]) {
    let mut state = TextEditState::load(ctx, id_of(open)).unwrap_or_default();
    if state.cursor.char_range().is_none() {
        return;
    }
    let [end, start] = ends.map(|at| CCursor::new(character(&open.text, at)));
    state.cursor.set_char_range(Some(CCursorRange::two(start, end)));
    state.store(ctx, id_of(open));
}

impl CodePanel {
    /// Takes in another text, or one that something else has changed, which undoing brings back.
    pub(super) fn take_in(&mut self, ctx: &Context, open: &OpenCode, session: &Session) {
        let same = self.same.replace((open.number, open.text.clone()));
        match same.filter(|(number, _)| *number == open.number) {
            Some((_, text)) if Arc::ptr_eq(&text, &open.text) => return,
            Some((number, text)) => {
                let now = self.cursor.map(|at| moved(&text, &open.text, at));
                let before = State { text, cursor: self.cursor };
                self.steps.entry(number).or_default().record(before, &open.text, None);
                self.cursor = now;
                put_cursor(ctx, open, now);
            }
            None => {
                let state = TextEditState::load(ctx, id_of(open)).unwrap_or_default();
                let range = state.cursor.char_range().unwrap_or_default();
                self.cursor = [range.primary, range.secondary].map(|c| byte(&open.text, c.index.0));
                self.steps.retain(|number, _| session.code.open.iter().any(|open| open.number == *number));
            }
        }
        self.buffer = open.text.to_string();
        self.offer = None;
    }

    /// The bytes that are selected.
    pub(super) fn selection(&self) -> Range<usize> {
        let [a, b] = self.cursor;
        a.min(b)..a.max(b)
    }

    /// Selects a place of the text, and brings it into sight.
    pub(super) fn select(&mut self, ctx: &Context, open: &OpenCode, place: Range<usize>) {
        let ends = [place.start, place.end].map(|at| CCursor::new(character(&self.buffer, at)));
        let mut state = TextEditState::load(ctx, id_of(open)).unwrap_or_default();
        state.cursor.set_char_range(Some(CCursorRange::two(ends[0], ends[1])));
        state.store(ctx, id_of(open));
        self.cursor = [place.end, place.start];
        self.steps.entry(open.number).or_default().end();
        self.reveals = true;
    }

    /// Replaces the text, as one step.
    pub(super) fn put(&mut self, text: String, context: &mut PanelContext<'_>) {
        self.buffer = text;
        self.changed(self.cursor, None, context);
    }

    /// Passes on that the text was changed, with the cursor before. `typed` is the time if it was typed.
    fn changed(&mut self, cursor: [usize; 2], typed: Option<f64>, context: &mut PanelContext<'_>) {
        let Some((number, before)) = self.same.clone() else { return };
        let text: Arc<str> = self.buffer.as_str().into();
        self.steps.entry(number).or_default().record(State { text: before, cursor }, &text, typed);
        self.becomes(number, text, context);
    }

    fn becomes(&mut self, number: u64, text: Arc<str>, context: &mut PanelContext<'_>) {
        self.same = Some((number, text.clone()));
        context.act(Action::Code(CodeCommand::Type(number, text)));
    }

    /// Undoes a step of the text, or does it again.
    fn step(&mut self, ctx: &Context, open: &OpenCode, again: bool, context: &mut PanelContext<'_>) {
        let now = State { text: self.buffer.as_str().into(), cursor: self.cursor };
        let steps = self.steps.entry(open.number).or_default();
        let other = if again { steps.redo(now) } else { steps.undo(now) };
        let Some(State { text, cursor: [end, start] }) = other else { return };
        self.buffer = text.to_string();
        self.offer = None;
        self.becomes(open.number, text, context);
        self.select(ctx, open, start..end);
    }

    /// The text before the cursor.
    fn before(&self) -> &str {
        &self.buffer[..self.buffer.floor_char_boundary(self.cursor[0])]
    }

    pub(super) fn field(&mut self, ui: &mut Ui, open: &OpenCode, context: &mut PanelContext<'_>) {
        let (ctx, id) = (ui.ctx().clone(), id_of(open));
        if let Some((number, wanted)) = context.session().code.goto
            && number == open.number
        {
            if let Some(before) = open.replaced.clone() {
                let before = State { text: before, cursor: [0; 2] };
                self.steps.entry(number).or_default().keep(before);
            }
            if wanted > 0 {
                let start = line(&self.buffer, wanted).start;
                self.select(&ctx, open, start..start);
            }
            ctx.memory_mut(|memory| memory.request_focus(id));
            context.act(Action::Code(CodeCommand::Arrived));
        }
        self.obey(ui, open, context);
        finder::show(ui, self, open, context);
        let whole = ui.available_rect_before_wrap();
        let (text, foot) = whole.split_top_bottom_at_y(whole.bottom() - FOOT);
        ui.painter().rect_filled(text, 2.0, Palette::here(ui).field);
        let before = self.buffer.len();
        let field = ui.scope_builder(UiBuilder::new().max_rect(text), |ui| self.text(ui, id, open, context));
        focus::scrolls_itself(&ctx, id);
        if field.inner && self.buffer.len() > before {
            self.begin_offer(open, false, context);
        }
        self.offers(ui, open, context);
        theme::column(ui, foot, |ui| self.foot(ui, open, context));
        let behind = self.buffer.get(self.selection().end..).unwrap_or_default();
        let line = Line::new(self.before(), behind, language(open), self.selection().is_empty());
        let (finds, bar) = (self.finder.open, self.finder.widgets.clone());
        let (offers, takes_enter) = (self.offer.is_some(), self.offer.as_ref().is_some_and(|o| o.wanted));
        kept::with(&ctx, |typing: &mut Typing| {
            (typing.id, typing.offers, typing.takes_enter) = (Some(id), offers, takes_enter);
            (typing.finds, typing.bar, typing.line) = (finds, bar, line);
        });
    }

    /// Does what keys asked for.
    fn obey(&mut self, ui: &Ui, open: &OpenCode, context: &mut PanelContext<'_>) {
        let asked = kept::with(ui.ctx(), |typing: &mut Typing| std::mem::take(&mut typing.asked));
        for ask in asked {
            match ask {
                keyboard::Ask::Find(replace) => self.begin_finding(replace),
                keyboard::Ask::Next(backwards) => self.find_next(ui.ctx(), open, backwards),
                keyboard::Ask::Escape => {
                    if self.offer.take().is_none() {
                        self.finder.open = false;
                    }
                    ui.ctx().memory_mut(|memory| memory.request_focus(id_of(open)));
                }
                keyboard::Ask::Complete => self.begin_offer(open, true, context),
                keyboard::Ask::Choose(by) => {
                    if let Some(offering) = &mut self.offer {
                        let count = offering.offer.words.len();
                        offering.chosen = (offering.chosen + count).saturating_add_signed(by) % count.max(1);
                        offering.wanted = true;
                    }
                }
                keyboard::Ask::Accept => self.accept(ui.ctx(), open, context),
                keyboard::Ask::Undo => self.step(ui.ctx(), open, false, context),
                keyboard::Ask::Redo => self.step(ui.ctx(), open, true, context),
            }
        }
    }

    /// The gutter and the text. True if something was typed.
    fn text(&mut self, ui: &mut Ui, id: Id, open: &OpenCode, context: &mut PanelContext<'_>) -> bool {
        let font = TextStyle::Monospace.resolve(ui.style());
        let digits = self.buffer.split('\n').count().to_string().len().max(3);
        let letter = ui.fonts_mut(|fonts| fonts.glyph_width(&font, '0'));
        let gutter = letter * digits as f32 + 2.0 * GAP;
        let whole = ui.available_rect_before_wrap();
        let (numbers, inside) = whole.split_left_right_at_x(whole.left() + gutter);
        let (before, cursor) = (self.buffer.len(), self.cursor);
        let marks = self.marks(open, context.session());
        let mut shown = None;
        ui.scope_builder(UiBuilder::new().max_rect(inside), |ui| {
            ScrollArea::both().id_salt(id).auto_shrink(false).show(ui, |ui| {
                shown = Some((self.edit(ui, id, open, &marks), ui.clip_rect()));
            });
        });
        let Some((output, clip)) = shown else { return false };
        let changed = output.response.changed();
        if changed || before != self.buffer.len() {
            let pasted = |event: &Event| matches!(event, Event::Paste(_) | Event::Cut);
            let typed = ui.input(|i| (!i.events.iter().any(pasted)).then_some(i.time));
            self.changed(cursor, typed, context);
        }
        self.gutter(ui, numbers, &marks, &output.galley, output.galley_pos, clip);
        changed
    }

    /// The text itself, with what is marked in it.
    fn edit(&mut self, ui: &mut Ui, id: Id, open: &OpenCode, marks: &[Mark]) -> TextEditOutput {
        let palette = Palette::here(ui);
        let Self { buffer, layouts, .. } = self;
        let language = language(open);
        let mut lay = |ui: &Ui, text: &dyn TextBuffer, _: f32| layouts.lay(ui, text.as_str(), language);
        let mut output = TextEdit::multiline(buffer)
            .id(id)
            .font(TextStyle::Monospace)
            .lock_focus(true)
            .frame(egui::Frame::NONE)
            .desired_width(f32::INFINITY)
            .min_size(ui.available_size())
            .cursor_at_end(false)
            .layouter(&mut lay)
            .show(ui);
        // It keeps steps of its own, each with the whole text.
        output.state.clear_undoer();
        if let Some(cursor) = output.cursor_range {
            let ends = [cursor.primary, cursor.secondary].map(|c| byte(buffer, c.index.0));
            let moved = std::mem::replace(&mut self.cursor, ends) != ends;
            if moved && !output.response.changed() {
                self.offer = None;
                self.steps.entry(open.number).or_default().end();
            }
            // Under the pointer, the text stays where it is.
            self.reveals |= moved && !ui.input(|i| i.pointer.any_down());
        }
        let at = CCursor::new(character(&self.buffer, self.cursor[0]));
        self.cursor_at = output.galley.pos_from_cursor(at).translate(output.galley_pos.to_vec2());
        if std::mem::take(&mut self.reveals) {
            let row = self.cursor_at.height();
            let around = (AROUND * row).min(0.5 * (ui.clip_rect().height() - row)).max(0.0);
            ui.scroll_to_rect(self.cursor_at.expand2(vec2(8.0, around)), None);
        }
        self.places(ui, &output.galley, output.galley_pos, &palette);
        self.underline(ui, marks, &output.galley, output.galley_pos, &palette);
        output
    }

    /// Numbers of the lines in sight.
    fn gutter(&self, ui: &Ui, place: Rect, marks: &[Mark], galley: &Galley, at: Pos2, clip: Rect) {
        let (palette, font) = (Palette::here(ui), TextStyle::Monospace.resolve(ui.style()));
        let painter = ui.painter().with_clip_rect(place.intersect(ui.clip_rect()));
        let now = self.before().matches('\n').count();
        for row in in_sight(galley, at, clip) {
            let y = at.y + galley.rows[row].pos.y;
            let colour = if row == now { palette.text } else { palette.weak };
            if marks.iter().any(|mark| mark.line == row + 1) {
                let centre = pos2(place.left() + 0.6 * GAP, y + 0.5 * galley.rows[row].size.y);
                icon::severity(&painter, centre, 4.5, Severity::Error, &palette);
            }
            let place = pos2(place.right() - GAP, y);
            painter.text(place, Align2::RIGHT_TOP, (row + 1).to_string(), font.clone(), colour);
        }
    }

    /// Lines below the words with errors.
    fn underline(&self, ui: &Ui, marks: &[Mark], galley: &Galley, at: Pos2, palette: &Palette) {
        let rows = in_sight(galley, at, ui.clip_rect());
        for mark in marks.iter().filter(|mark| rows.contains(&mark.line.saturating_sub(1))) {
            let row = &galley.rows[mark.line.saturating_sub(1)];
            let text = &self.buffer[line(&self.buffer, mark.line)];
            let from = mark.column.saturating_sub(1).min(text.chars().count());
            let word = word_length(text.chars().skip(from));
            let (from, to) = match mark.column {
                0 => (0, text.chars().count().max(1)),
                _ => (from, from + word),
            };
            let x = |column: usize| at.x + row.pos.x + row.x_offset(column.into());
            // Within the row, so that it does not touch the letters of the next one.
            let y = at.y + row.pos.y + row.size.y - UNDERLINE.1;
            let right = x(to).max(x(from) + 4.0);
            ui.painter().hline(x(from)..=right, y, Stroke::new(UNDERLINE.0, palette.error));
        }
    }

    /// The places that were found.
    fn places(&self, ui: &Ui, galley: &Galley, at: Pos2, palette: &Palette) {
        let rows = in_sight(galley, at, ui.clip_rect());
        let selection = self.selection();
        for place in self.finder.places_in(&self.buffer, &rows) {
            let [from, to] = [place.start, place.end]
                .map(|byte| galley.pos_from_cursor(CCursor::new(character(&self.buffer, byte))));
            let area = from.union(to).translate(at.to_vec2());
            let (fill, stroke) = found_look(place == selection, palette);
            ui.painter().rect(area.expand(1.0), 2.0, fill, stroke, StrokeKind::Outside);
        }
    }

    /// The line below the text.
    fn foot(&mut self, ui: &mut Ui, open: &OpenCode, context: &PanelContext<'_>) {
        let before = self.before();
        let line = before.matches('\n').count() + 1;
        let column = before.rsplit('\n').next().map_or(0, |last| last.chars().count()) + 1;
        let marks = self.marks(open, context.session());
        let (language, parameters, at) = (language(open), self.parameters(open), self.cursor[0]);
        let known = kept::of_key(ui.ctx(), Id::new("help in the code"), (open.text.to_string(), at), || {
            self.vocabulary(context);
            let (_, words) = self.vocabulary.as_ref()?;
            words.help(&self.buffer, at, language, parameters)
        });
        let mut goes = None;
        ui.horizontal(|ui| {
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.label(theme::small(ui, format!("line {line}, column {column}")));
                if !marks.is_empty() && ui.small_button("Next error").clicked() {
                    let next = marks.iter().find(|mark| mark.line > line).or(marks.first());
                    goes = next.map(|mark| mark.line);
                }
                let here = marks.iter().find(|mark| mark.line == line).or(marks.first());
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| said(ui, here, known));
            });
        });
        if let Some(wanted) = goes {
            let start = self::line(&self.buffer, wanted).start;
            self.select(ui.ctx(), open, start..start);
            ui.ctx().memory_mut(|memory| memory.request_focus(id_of(open)));
        }
    }
}

/// An error, or help for a word.
fn said(ui: &mut Ui, mark: Option<&Mark>, word: Option<Word>) {
    if let Some(mark) = mark {
        icon::sign(ui, [14.0, 18.0], 5.0, Severity::Error);
        let text = RichText::new(format!("line {}: {}", mark.line, mark.message));
        ui.add(Label::new(text.color(Palette::here(ui).error)).truncate());
    } else if let Some(word) = word {
        ui.add(Label::new(RichText::new(&word.usage).monospace()).truncate());
        ui.add(Label::new(theme::small(ui, word.help)).truncate());
    }
}

/// The number of characters of the word at the beginning: a text with its quotes, a number with its sign, a name.
fn word_length(from: impl Iterator<Item = char>) -> usize {
    let mut from = from.peekable();
    let first = from.next_if(|c| matches!(c, '"' | '-'));
    if first == Some('"') {
        let mut escaped = false;
        let within = from.take_while(|c| {
            let goes_on = escaped || *c != '"';
            escaped = !escaped && *c == '\\';
            goes_on
        });
        return within.count() + 2;
    }
    let is_number = from.peek().is_some_and(char::is_ascii_digit);
    let rest = from.take_while(|c| tokens::is_of_word(*c) || is_number && *c == '.').count();
    (usize::from(first.is_some()) + rest).max(1)
}

/// The rows of a layout that are in sight.
fn in_sight(galley: &Galley, at: Pos2, clip: Rect) -> Range<usize> {
    let above = |y: f32| galley.rows.partition_point(|row| at.y + row.pos.y + row.size.y < y);
    above(clip.top())..(above(clip.bottom()) + 1).min(galley.rows.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_with_an_error_is_underlined_with_its_quotes_or_its_sign() {
        let all =
            [("\"a b\\\"c\": 1", 8), ("-0.5, 1", 4), ("roughness: f32", 9), ("m.x", 1), (", 1", 1), ("", 1)];
        for (text, length) in all {
            assert_eq!(word_length(text.chars()), length, "{text}");
        }
    }

    #[test]
    fn a_place_stays_beside_what_it_is_beside_when_the_text_changes_elsewhere() {
        let (from, to) = ("one\ntwo\nthree", "one\né\ntwo\nthree");
        for (at, c) in from.char_indices().chain([(from.len(), ' ')]) {
            let now = moved(from, to, at);
            assert_eq!(now, if at <= 4 { at } else { at + "é\n".len() }, "{c} at {at}");
            assert_eq!(moved(to, from, now), at, "and back");
        }
        // In what was replaced, it stays within what is there now.
        assert_eq!(moved("a(bcdef)g", "a(é)g", 7), 4);
        assert_eq!(moved("a(bcdef)g", "a(é)g", 4), 4);
        assert_eq!(moved("a(bcdef)g", "a(é)g", 3), 2);
        assert_eq!(moved("abc", "", 9), 0);
    }

    #[test]
    fn bytes_characters_and_lines_lead_to_each_other() {
        let text = "é\nab\n\n漢";
        for (at, _) in text.char_indices().chain([(text.len(), ' ')]) {
            assert_eq!(byte(text, character(text, at)), at);
        }
        assert_eq!((byte(text, 99), character(text, 1)), (text.len(), 0));
        assert_eq!([1, 2, 3, 4, 9].map(|number| &text[line(text, number)]), ["é", "ab", "", "漢", "漢"]);
        assert_eq!(line("", 1), 0..0);
    }
}
