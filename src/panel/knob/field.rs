//! Text fields.
//!
//! Invalid text stays in the field, in the error style and with the rule shown, until it is corrected or cancelled with
//! Escape.

use bevy_egui::egui::{
    self, Align, Align2, Area, Id, Key, Order, Response, RichText, Stroke, TextEdit, TextStyle, Ui, pos2,
    vec2,
};

use super::slider::{nudge, round_to};
use crate::{
    panel::{
        narrow,
        theme::{self, Palette},
    },
    scene::limits::{Limits, number},
};

/// Text being edited in a field.
#[derive(Clone, Debug, Default, PartialEq)]
struct Draft {
    text: String,
    /// The value before editing, which Escape restores.
    before: f64,
    /// The value last returned by the field, to detect changes from elsewhere.
    last: f64,
}

/// The response of a field, and the new value or the error.
#[derive(Debug)]
pub struct Field<T = f64> {
    /// The response of the text field.
    pub response: Response,
    /// The new valid value.
    pub value: Option<T>,
    /// The rule that the text violates.
    pub error: Option<String>,
}

/// Parses a number as people type it: with a point or a comma, also with a typographic minus sign.
#[must_use]
pub fn parse(text: &str) -> Option<f64> {
    let text = text.trim().replace('−', "-").replace(',', ".");
    text.parse::<f64>().ok().filter(|v| v.is_finite())
}

/// The valid number in a text, or the error.
pub(super) fn read(text: &str, limits: &Limits) -> Result<f64, String> {
    match parse(text) {
        Some(v) if limits.allows(v) => Ok(v),
        Some(_) => Err(format!("must be {}", limits.rule())),
        None => Err(format!("is not a number; must be {}", limits.rule())),
    }
}

/// A number as fields show it; a dash stands for one that is not a number: for several that differ.
pub(super) fn shown(value: f64) -> String {
    if value.is_nan() { "–".to_owned() } else { number(value) }
}

/// A field for one number. `name` is for screen readers.
pub fn field(ui: &mut Ui, id: Id, name: &str, value: f64, limits: &Limits, width: f32) -> Field {
    let draft_id = id.with("draft");
    // A value changed elsewhere makes the edited text obsolete.
    let mut draft = ui
        .data(|d| d.get_temp::<Draft>(draft_id))
        .filter(|d| d.last == value || d.last.is_nan() && value.is_nan());
    let begun = |text: String| Draft { text, before: value, last: value };
    let whole = shown(value);
    let mut text = match &draft {
        Some(draft) => draft.text.clone(),
        None if ui.memory(|m| m.has_focus(id)) => whole.clone(),
        None => fitted(ui, value, width - PADDING),
    };
    let cut = draft.is_none() && text != whole;
    let is_dash = |draft: &Draft| value.is_nan() && draft.text == whole;
    let problem = |draft: &Draft| read(&draft.text, limits).err().filter(|_| !is_dash(draft));
    let wrong = draft.as_ref().and_then(problem).is_some();
    let steps = steps(ui, id);
    let entry = Entry { id, name, shown: &whole, hint: "", width };
    let mut response = text_edit(ui, entry, &mut text, wrong);
    if cut && !response.has_focus() {
        response = response.on_hover_text(&whole);
    }

    let mut out = None;
    if response.gained_focus() {
        draft = Some(begun(if response.changed() { text.clone() } else { whole.clone() }));
    }
    if response.changed() {
        let d = draft.get_or_insert_with(|| begun(String::new()));
        d.text.clone_from(&text);
        // The prefixes of an invalid number (3, 30, 300) were never intended: restore the value from before.
        out =
            read(&text, limits).ok().or_else(|| Some(d.before).filter(|v| *v != value && limits.allows(*v)));
    }
    if steps != 0.0
        && let Some(v) = stepped(read(&text, limits).unwrap_or(value), steps, limits)
    {
        out = Some(v);
        draft.get_or_insert_with(|| begun(String::new())).text = number(v);
    }
    // egui itself drops the focus on Escape.
    let escape = response.lost_focus() && ui.input(|i| i.key_pressed(Key::Escape));
    if escape && let Some(d) = draft.take() {
        out = Some(d.before).filter(|v| *v != value && limits.allows(*v));
    } else if response.lost_focus() {
        draft = draft.filter(|d| problem(d).is_some());
    }
    if let (Some(v), Some(d)) = (out, draft.as_mut()) {
        d.last = f64::from(v as f32);
    }
    let error = draft.as_ref().and_then(problem);
    ui.data_mut(|d| match draft {
        Some(draft) => _ = d.insert_temp(draft_id, draft),
        None => d.remove::<Draft>(draft_id),
    });
    Field { response, value: out.filter(|v| *v as f32 != value as f32 || limits.whole && *v != value), error }
}

/// Steps that the arrow keys ask of a field; consumed before the text field sees them.
fn steps(ui: &Ui, id: Id) -> f64 {
    let mut steps = 0.0;
    if ui.memory(|m| m.has_focus(id)) {
        let keys = [(Key::ArrowUp, 1.0), (Key::ArrowDown, -1.0)];
        for (modifiers, factor) in [(egui::Modifiers::SHIFT, 10.0), (egui::Modifiers::NONE, 1.0)] {
            let pressed = keys.map(|(key, _)| ui.input_mut(|i| i.consume_key(modifiers, key)));
            steps += keys
                .iter()
                .zip(pressed)
                .map(|((_, sign), on)| if on { sign * factor } else { 0.0 })
                .sum::<f64>();
        }
    }
    steps
}

/// The value some steps from another, if it is valid.
fn stepped(base: f64, steps: f64, limits: &Limits) -> Option<f64> {
    let step = nudge(limits, base);
    let v = round_to(base + steps * step, step).clamp(limits.min.max(-1e12), limits.max);
    let v = if limits.is_above_zero() && v <= limits.min { base } else { v };
    limits.allows(v).then_some(v)
}

/// Horizontal padding of the text in a field, in points.
const PADDING: f32 = 10.0;

/// A number shortened to the available width by rounding decimals.
fn fitted(ui: &Ui, value: f64, room: f32) -> String {
    let font = TextStyle::Body.resolve(ui.style());
    let fits = |text: &String| {
        ui.painter().layout_no_wrap(text.clone(), font.clone(), egui::Color32::WHITE).size().x <= room
    };
    let whole = shown(value);
    if fits(&whole) || value.is_nan() {
        return whole;
    }
    let rounded = (0..4).rev().map(|decimals| round_to(value, 0.1_f64.powi(decimals)));
    // A small number must not appear as 0.
    rounded.filter(|v| *v != 0.0).map(number).find(fits).unwrap_or(whole)
}

/// Space for an error, and the distance of the error from the panel, in points.
const COMPLAINT: f32 = 352.0;
const BESIDE: f32 = 4.0;

/// Shows the error beside the panel, level with the field, so that nothing moves during typing and no other knob is
/// covered. It disappears with focus and pointer; the field stays red.
pub(super) fn complaint(ui: &Ui, field: &Response, error: &str, kept: &str) {
    if !(field.has_focus() || field.hovered()) || !ui.is_rect_visible(field.rect) {
        return;
    }
    let palette = Palette::here(ui);
    // Below the field if there is no room beside it, as for a popup at the edge.
    let left = ui.clip_rect().left() - BESIDE;
    let (pivot, at) = if left - ui.ctx().content_rect().left() > COMPLAINT {
        (Align2::RIGHT_CENTER, pos2(left, field.rect.center().y))
    } else {
        (Align2::RIGHT_TOP, field.rect.right_bottom() + vec2(0.0, 4.0))
    };
    let area = Area::new(field.id.with("complaint")).order(Order::Tooltip).interactable(false);
    area.pivot(pivot).fixed_pos(at).constrain(true).show(ui.ctx(), |ui| {
        egui::Frame::popup(ui.style()).stroke(Stroke::new(1.0, palette.error)).show(ui, |ui| {
            ui.set_max_width(COMPLAINT - 32.0);
            let text = format!("{error}; the picture keeps {kept}");
            ui.add(egui::Label::new(RichText::new(text).small().color(palette.error)).wrap());
        });
    });
}

/// The place of a text.
#[derive(Clone, Copy)]
pub(super) struct Entry<'a> {
    pub(super) id: Id,
    /// The name, for screen readers.
    pub(super) name: &'a str,
    /// The text while nobody types.
    pub(super) shown: &'a str,
    pub(super) hint: &'a str,
    pub(super) width: f32,
}

/// The framed text field; gaining the focus selects all text.
fn text_edit(ui: &mut Ui, entry: Entry, text: &mut String, wrong: bool) -> Response {
    let Entry { id, name, shown, hint, width } = entry;
    let (palette, size) = (Palette::here(ui), vec2(width, narrow::high(ui.ctx(), 22.0)));
    let line = if wrong {
        palette.error
    } else if ui.memory(|m| m.has_focus(id)) {
        palette.accent
    } else {
        palette.line
    };
    let frame = egui::Frame::new()
        .fill(palette.field)
        // A change of the stroke width would move the widgets below.
        .stroke(Stroke::new(1.0, line))
        .corner_radius(4.0)
        .inner_margin(egui::Margin::symmetric(4, 2));
    let edit = TextEdit::singleline(text)
        .id(id)
        .hint_text(RichText::new(hint).color(palette.weak))
        .desired_width(width - PADDING)
        .min_size(size)
        .vertical_align(Align::Center)
        .horizontal_align(Align::Max)
        .text_color(if wrong { palette.error } else { palette.text })
        .frame(frame);
    let response = ui.add_sized(size, edit);
    theme::names_field(&response, name, [shown, &*text, hint]);
    if response.gained_focus() {
        // The text may have been rounded until now.
        theme::select_all(ui, id, if shown.len() > text.len() { shown } else { text });
    }
    response
}

/// A field for a value other than a number: `read` parses the text or explains the error. Invalid text is dropped when
/// the field loses the focus.
pub(super) fn text_field<T>(ui: &mut Ui, entry: Entry, read: impl Fn(&str) -> Result<T, String>) -> Field<T> {
    let Entry { id, shown, .. } = entry;
    let draft_id = id.with("draft");
    let draft: Option<String> = ui.data(|d| d.get_temp(draft_id));
    let focused = ui.memory(|m| m.has_focus(id));
    let mut text = draft.filter(|_| focused).unwrap_or_else(|| shown.to_owned());
    let wrong = focused && text != shown && read(&text).is_err();
    let response = text_edit(ui, entry, &mut text, wrong);
    let mut value = None;
    if response.changed() {
        value = read(&text).ok();
        ui.data_mut(|d| d.insert_temp(draft_id, text.clone()));
    }
    if response.lost_focus() {
        ui.data_mut(|d| d.remove::<String>(draft_id));
    }
    let error = if wrong { read(&text).err() } else { None };
    Field { response, value, error }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_read_as_people_type_them() {
        assert_eq!(parse(" 0,5 "), Some(0.5));
        assert_eq!(parse("−3"), Some(-3.0));
        assert_eq!(parse("1e-3"), Some(0.001));
        for nonsense in ["", "-", "a", "1 2", "inf", "nan"] {
            assert_eq!(parse(nonsense), None, "{nonsense:?}");
        }
    }
}
