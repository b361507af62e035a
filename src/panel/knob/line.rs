//! The line of a knob: symbol and label at the left, the widgets at the right, and the tooltip.

use bevy_egui::egui::{
    self, Align, Button, FontId, Response, RichText, Sense, TextStyle, Ui, WidgetInfo, WidgetType, pos2, vec2,
};

use crate::{
    panel::{
        lesson::point,
        linked, maths, narrow,
        theme::{self, Palette},
    },
    scene::{
        Field,
        limits::{Limits, number},
    },
    text::capitalised,
};

/// Name, symbol and texts of a knob.
#[derive(Clone, Copy, Debug, Default)]
pub struct Caption<'a> {
    /// The name among the knobs of a panel, by which lessons point at it; usually the label.
    pub salt: &'a str,
    /// Symbol in the equation; empty for none.
    pub symbol: &'a str,
    /// Label.
    pub label: &'a str,
    /// Unit; empty for none.
    pub unit: &'a str,
    /// Description of the effect, for the tooltip.
    pub help: &'a str,
    /// Why the knob is disabled, if it is.
    pub disabled: Option<&'a str>,
    /// Minimum width of the symbol column, which aligns labels with those of other knobs, in points; 0 for none.
    pub indent: f32,
}

impl<'a> Caption<'a> {
    /// A label with a unit and a description, either of which may be empty, for a value without a symbol.
    #[must_use]
    pub fn new(label: &'a str, unit: &'a str, help: &'a str) -> Self {
        Self { salt: label, label, unit, help, ..Self::default() }
    }

    /// The caption of a field of a scene, with its documentation as description.
    #[must_use]
    pub fn of(field: &Field) -> Self {
        Self::new(field.label(), field.unit, field.help.trim())
    }

    /// The symbol in front of the label; empty if it is only the words of the label, as for a parameter that is declared
    /// without a symbol.
    fn shown_symbol(&self) -> &'a str {
        let words = self.symbol.replace("_{", " ").replace('}', "");
        if words == self.label { "" } else { self.symbol }
    }
}

/// Width of symbol and label in the line of a knob.
#[derive(Clone, Copy, Debug)]
pub(super) enum Words {
    /// As wide as necessary, leaving the given number of points for the rest.
    Leave(f32),
    /// A column of the same width in every knob, so that sliders are aligned.
    Column,
    /// At most that column, and no wider than the longest word needs, so that a slider beside a long unit has room.
    Slim,
}

/// A knob with its lines. It can be disabled; the equation and a lesson can point at it.
pub(super) fn knob<R>(ui: &mut Ui, caption: &Caption, add: impl FnOnce(&mut Ui) -> R) -> R {
    let shown = ui.add_enabled_ui(caption.disabled.is_none(), add);
    linked::touch(ui, shown.response.rect, &[caption.symbol]);
    point::knob(ui, caption.salt, shown.response.rect);
    shown.inner
}

/// The line of a knob with a button at the right, which shows a text and a sign.
pub(super) fn button(
    ui: &mut Ui,
    caption: &Caption,
    text: &str,
    sign: &str,
    role: WidgetType,
) -> (Response, Response) {
    let weak = Palette::here(ui).weak;
    head(ui, caption, Words::Leave(CHOICE), |ui| {
        let width = choice_width(ui);
        let button = Button::new(text).right_text(RichText::new(sign).color(weak)).truncate();
        let button = ui.add_sized(vec2(width, narrow::high(ui.ctx(), 24.0)), button);
        button.widget_info(|| WidgetInfo::labeled(role, true, format!("{}: {text}", caption.label)));
        button
    })
}

/// Leaves the room of a unit. Returns the width of a choice beside it.
pub(super) fn choice_width(ui: &mut Ui) -> f32 {
    ui.add_space(22.0);
    (ui.available_width() - 4.0).clamp(80.0, 190.0)
}

/// The line of a knob: symbol and label at the left, the widgets of `right` at the right.
pub(super) fn head<R>(
    ui: &mut Ui,
    caption: &Caption,
    words: Words,
    right: impl FnOnce(&mut Ui) -> R,
) -> (Response, R) {
    let palette = Palette::here(ui);
    let symbol = caption.shown_symbol();
    let symbol_column = symbol_column(ui, symbol).max(caption.indent);
    let colour = if ui.is_enabled() && caption.disabled.is_none() { palette.text } else { palette.weak };
    let room = match words {
        Words::Leave(points) => (ui.available_width() - points).max(symbol_column + 40.0),
        Words::Column | Words::Slim => (COLUMN * ui.available_width()).max(symbol_column + 40.0).floor(),
    };
    let font = TextStyle::Body.resolve(ui.style());
    let room = match words {
        Words::Slim => room.min(symbol_column + longest(ui, caption.label, &font) + GAP),
        _ => room,
    };
    // Wrapped rather than elided, since some labels differ only in their last words.
    let mut job = egui::text::LayoutJob::simple(caption.label.to_owned(), font, colour, room - symbol_column);
    job.wrap.max_rows = ROWS;
    let galley = ui.painter().layout_job(job);
    let line = vec2(ui.available_width(), ui.spacing().interact_size.y.max(galley.size().y));
    let row = ui.allocate_ui_with_layout(line, egui::Layout::left_to_right(Align::Center), |ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let width = match words {
            Words::Leave(_) => symbol_column + galley.size().x,
            Words::Column | Words::Slim => room,
        };
        let height = galley.size().y.max(22.0);
        let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
        if !caption.symbol.is_empty() && linked::is_sought(ui.ctx(), caption.symbol) {
            response.scroll_to_me(None);
        }
        if linked::is_lit(ui.ctx(), caption.symbol) {
            ui.painter().add(linked::row_ground(rect.expand2(vec2(4.0, 0.0)), &palette));
        }
        if !symbol.is_empty() {
            let at = pos2(rect.left(), rect.center().y + 5.0);
            maths::paint_symbol(ui, at, symbol, SYMBOL, colour);
        }
        let at = pos2(rect.left() + symbol_column, rect.center().y - galley.size().y / 2.0);
        ui.painter().galley(at, galley, colour);
        (response, ui.with_layout(egui::Layout::right_to_left(Align::Center), right).inner)
    });
    row.inner
}

/// Width of the longest word of a label.
fn longest(ui: &Ui, label: &str, font: &FontId) -> f32 {
    label.split_whitespace().map(|word| theme::width_in(ui, word, font)).fold(0.0, f32::max)
}

/// Gap between a label and a slider, in points.
const GAP: f32 = 6.0;

/// Font size of a symbol.
const SYMBOL: f32 = 16.0;

/// Maximum number of rows of a label.
const ROWS: usize = 3;

/// Width of a symbol in front of a label, including the gap between them.
pub(in crate::panel) fn symbol_column(ui: &Ui, symbol: &str) -> f32 {
    if symbol.is_empty() { 0.0 } else { (maths::symbol_width(ui, symbol, SYMBOL) + 6.0).max(28.0) }
}

/// Fraction of the line that symbol and label take in knobs with a slider.
const COLUMN: f32 = 0.49;

/// Width of a number and its unit at the right of a knob, in points.
pub(super) const NUMBER: f32 = 96.0;

/// Width of a choice at the right of a knob, in points.
pub(super) const CHOICE: f32 = 150.0;

/// The tooltip of a knob: name, effect, range, default.
pub(super) fn tooltip(ui: &mut Ui, caption: &Caption, rule: &str, default: &str) {
    ui.set_max_width(300.0);
    ui.label(theme::strong(ui, capitalised(caption.label)));
    if let Some(reason) = caption.disabled {
        ui.label(RichText::new(format!("{}.", capitalised(reason))).color(Palette::here(ui).warning));
    }
    if !caption.help.is_empty() {
        ui.label(caption.help);
    }
    if !rule.is_empty() {
        ui.label(theme::small(ui, format!("{}.", capitalised(rule))));
    }
    if !default.is_empty() {
        ui.label(theme::small(ui, format!("Default {default}: double-click the slider.")));
    }
}

/// The range for the tooltip: the rule, and the ends of the slider if values beyond them can be typed.
pub(super) fn range(limits: &Limits) -> String {
    let rule = limits.rule();
    let (left, right) = (number(limits.slider_min), number(limits.slider_max));
    match (limits.min < limits.slider_min, limits.max > limits.slider_max) {
        (false, false) => rule,
        (false, true) => format!("{rule}. Slider: {left} to {right}. Larger values can be typed"),
        (true, false) => format!("{rule}. Slider: {left} to {right}. Smaller values can be typed"),
        (true, true) => format!("{rule}. Slider: {left} to {right}. Other values can be typed"),
    }
}

/// Adds a tooltip to a widget that may be disabled.
pub(super) fn explain(response: Response, tip: impl Fn(&mut Ui)) {
    response.on_hover_ui(&tip).on_disabled_hover_ui(&tip);
}

/// The unit, outside the field, in a separate column.
pub(super) fn unit(ui: &mut Ui, text: &str) {
    let palette = Palette::here(ui);
    let font = TextStyle::Small.resolve(ui.style());
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, palette.weak);
    let width = 18.0_f32.max(galley.size().x);
    let (rect, _) = ui.allocate_exact_size(vec2(width, 22.0), Sense::hover());
    ui.painter().galley(pos2(rect.left(), rect.center().y - galley.size().y / 2.0), galley, palette.weak);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_words_of_a_label_are_no_symbol_beside_it() {
        for (symbol, label, shown) in [
            ("polish", "polish", ""),
            ("shine_{depth}", "shine depth", ""),
            ("α", "alpha", "α"),
            ("k_d", "diffuse coefficient", "k_d"),
            ("polish", "degree of polish", "polish"),
            ("", "exposure", ""),
        ] {
            let caption = Caption { symbol, label, ..Caption::default() };
            assert_eq!(caption.shown_symbol(), shown, "{label}");
        }
    }
}
