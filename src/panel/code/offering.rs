//! The list of words at the cursor.

use bevy_egui::egui::{Area, Frame, Order};

use super::{CodePanel, Offering, find, language, tokens::is_of_word};
use crate::panel::{prelude::*, state::OpenCode};

/// Rows of the list, and its width in points.
const ROWS: usize = 8;
const WIDTH: f32 = 420.0;
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

    /// Shows the list. A click takes a word.
    pub(super) fn offers(&mut self, ui: &Ui, open: &OpenCode, context: &mut PanelContext<'_>) {
        let Some(offering) = &self.offer else { return };
        let palette = Palette::here(ui);
        let first = offering.chosen.saturating_sub(ROWS - 1);
        let shown = offering.offer.words.iter().enumerate().skip(first).take(ROWS);
        let mut taken = None;
        let area = Area::new(Id::new("offered words")).order(Order::Foreground).constrain(true);
        area.fixed_pos(self.cursor_at.left_bottom() + vec2(0.0, 2.0)).show(ui.ctx(), |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_width(WIDTH);
                ui.spacing_mut().item_spacing.y = 1.0;
                for (i, word) in shown {
                    let text = RichText::new(&word.name).monospace();
                    let button = Button::selectable(i == offering.chosen, text);
                    let usage = theme::elided(ui, &word.usage, TextStyle::Small, palette.weak, 0.55 * WIDTH);
                    let row = ui.add(button.min_size(vec2(WIDTH, 0.0)).right_text(usage.text().to_owned()));
                    if row.clicked() {
                        taken = Some(i);
                    }
                }
                if let Some(word) = offering.offer.words.get(offering.chosen).filter(|w| !w.help.is_empty()) {
                    theme::note(ui, word.help.clone());
                }
                theme::note(ui, "Tab takes the word, ↑ ↓ choose, Esc closes the list");
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
