//! The list of words at the cursor.

use bevy_egui::egui::{Area, Frame, Order};

use super::{CodePanel, Offering, find, language, tokens::is_of_word, words::Word};
use crate::panel::{prelude::*, state::OpenCode};

/// Rows of the list, and its width in points.
const ROWS: usize = 8;
const WIDTH: f32 = 420.0;
/// Distances of the list from the cursor, and of its rows from each other, in points.
const AWAY: f32 = 2.0;
const GAP: f32 = 1.0;
/// Most lines of the help for a word in the list.
const MOST_LINES: usize = 3;
/// Letters after which words are offered unasked.
const LETTERS: usize = 2;

impl CodePanel {
    /// Offers the words that fit at the cursor. Unasked, only where a word has begun.
    pub(super) fn begin_offer(&mut self, open: &OpenCode, asked: bool, context: &PanelContext<'_>) {
        self.offer = None;
        let at = self.buffer.floor_char_boundary(self.cursor[0]);
        let before = self.buffer.get(..at).unwrap_or_default();
        let begun = before.chars().rev().take_while(|c| is_of_word(*c)).count();
        let after_dot = before.ends_with("m.") || before.ends_with("frame.");
        if !asked && begun < LETTERS && !after_dot {
            return;
        }
        let parameters = self.parameters(open);
        self.vocabulary(context);
        let Some((_, words)) = &self.vocabulary else { return };
        let offer = words.offer(&self.buffer, at, language(open), parameters);
        let typed = self.buffer.get(offer.place.clone()).unwrap_or_default();
        // Nothing to add to what is typed.
        let complete = offer.words.first().is_some_and(|word| word.name == typed || word.insert == typed);
        let numeric = typed.starts_with(|c: char| c.is_ascii_digit());
        if !offer.words.is_empty() && (asked || !complete && !numeric) {
            self.offer = Some(Offering { offer, chosen: 0, wanted: asked });
        }
    }

    /// Puts the chosen word into the text.
    pub(super) fn accept(&mut self, ctx: &Context, open: &OpenCode, context: &mut PanelContext<'_>) {
        let Some(Offering { offer, chosen, .. }) = self.offer.take() else { return };
        let Some(word) = offer.words.get(chosen) else { return };
        if self.buffer.get(offer.place.clone()).is_none() {
            return;
        }
        let text = find::replace(&self.buffer, std::slice::from_ref(&offer.place), &word.insert);
        self.put(text, context);
        let end = offer.place.start + word.insert.len();
        self.select(ctx, open, end..end);
    }

    /// Shows the list below the cursor, or above it where there is more room. A click takes a word.
    pub(super) fn offers(&mut self, ui: &Ui, open: &OpenCode, context: &mut PanelContext<'_>) {
        let Some(offering) = &self.offer else { return };
        let (editor, window) = (ui.max_rect(), ui.ctx().content_rect());
        let width = WIDTH.min(editor.width() - Frame::popup(ui.style()).total_margin().sum().x).max(0.0);
        let notes = notes(ui, offering, width);
        let (above, below) = (self.cursor_at.top() - window.top(), window.bottom() - self.cursor_at.bottom());
        let fits = rows_within(ui, &notes, above.max(below));
        let (pivot, at) = match rows_within(ui, &notes, below) < fits.min(offering.offer.words.len()) {
            true => (Align2::LEFT_BOTTOM, self.cursor_at.left_top() - vec2(0.0, AWAY)),
            false => (Align2::LEFT_TOP, self.cursor_at.left_bottom() + vec2(0.0, AWAY)),
        };
        let first = offering.chosen.saturating_sub(fits - 1);
        let mut taken = None;
        let area = Area::new(Id::new("offered words")).order(Order::Foreground);
        // Within the editor from left to right.
        let area = area.constrain_to(Rect::from_x_y_ranges(editor.x_range(), window.y_range()));
        area.pivot(pivot).fixed_pos(at).show(ui.ctx(), |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_width(width);
                ui.spacing_mut().item_spacing.y = GAP;
                for (i, word) in offering.offer.words.iter().enumerate().skip(first).take(fits) {
                    if row(ui, word, i == offering.chosen, width).clicked() {
                        taken = Some(i);
                    }
                }
                for note in notes {
                    ui.label(note);
                }
            });
        });
        if let Some(i) = taken {
            if let Some(offering) = &mut self.offer {
                offering.chosen = i;
            }
            self.accept(ui.ctx(), open, context);
        }
    }
}

/// What stands below the list: help for the chosen word, and the keys.
fn notes(ui: &Ui, offering: &Offering, width: f32) -> Vec<Arc<Galley>> {
    let help = offering.offer.words.get(offering.chosen).map_or("", |word| word.help.as_str());
    let all = [help, "Tab takes the word, ↑ ↓ choose, Esc closes the list"].into_iter();
    let ink = Palette::here(ui).weak;
    all.filter(|text| !text.is_empty())
        .map(|text| theme::lines(ui, text, TextStyle::Small, ink, (width, MOST_LINES)))
        .collect()
}

/// The rows that have room above these notes in a list of a height, at least one.
fn rows_within(ui: &Ui, notes: &[Arc<Galley>], height: f32) -> usize {
    let around = Frame::popup(ui.style()).total_margin().sum().y + AWAY;
    let below: f32 = notes.iter().map(|note| note.size().y + GAP).sum();
    let letters = ui.text_style_height(&TextStyle::Monospace) + 2.0 * ui.spacing().button_padding.y;
    let row = letters.max(ui.spacing().interact_size.y) + GAP;
    (((height - around - below) / row).max(1.0) as usize).min(ROWS)
}

/// A row: the word, and at its right how it is used, cut off where it is too long.
fn row(ui: &mut Ui, word: &Word, chosen: bool, width: f32) -> Response {
    let spacing = ui.spacing();
    // The two texts and the space that grows between them have two gaps.
    let room = width - 2.0 * (spacing.button_padding.x + spacing.icon_spacing) - 2.0;
    // The button has the colour of its letters.
    let name = theme::elided(ui, &word.name, TextStyle::Monospace, Color32::PLACEHOLDER, 0.7 * room);
    let weak = Palette::here(ui).weak;
    let usage = theme::elided(ui, &word.usage, TextStyle::Small, weak, room - name.size().x);
    let button = Button::selectable(chosen, name).min_size(vec2(width, 0.0));
    ui.add(if word.usage.is_empty() { button } else { button.right_text(usage) })
}
