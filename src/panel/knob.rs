//! The knobs: how one value is shown, dragged, typed, and kept within its limits.
//!
//! A knob never yields an illegal value. What is typed and not legal stays in the field, in the error
//! style and with the rule beside it, until it is corrected or given up with Escape.

use bevy_egui::egui::{
    self, Align, Align2, Area, Button, Color32, CursorIcon, Id, Key, Order, Popup, PopupCloseBehavior, Rect,
    RectAlign, Response, RichText, Sense, Stroke, TextEdit, TextStyle, Ui, WidgetInfo, WidgetType, pos2,
    vec2,
};
use glam::Vec3;

use super::{
    chooser, maths,
    theme::{self, Palette},
};
use crate::document::limits::{Limits, number};
use crate::{
    parameter::{Parameter, ParameterKind, Value},
    reflection::{Readout, ReadoutValue},
};

/// What a knob says about itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct Caption<'a> {
    /// The symbol in the equation; empty for none.
    pub symbol: &'a str,
    /// The word.
    pub label: &'a str,
    /// The unit; empty for none.
    pub unit: &'a str,
    /// What it does.
    pub help: &'a str,
    /// Why it can not be turned, if so.
    pub disabled: Option<&'a str>,
}

/// What is being typed into a field.
#[derive(Clone, Debug, Default, PartialEq)]
struct Draft {
    text: String,
    /// The value that the field had when typing began: what Escape goes back to.
    before: f64,
    /// The value that the field last yielded, to notice a change from elsewhere.
    last: f64,
}

/// What a field says.
#[derive(Debug)]
pub struct Field<T = f64> {
    /// The response of the text field.
    pub response: Response,
    /// A new legal value.
    pub value: Option<T>,
    /// The rule that the text in the field breaks.
    pub error: Option<String>,
}

/// Reads a number as people type it: with a point or a comma, with a real minus sign.
#[must_use]
pub fn parse(text: &str) -> Option<f64> {
    let text = text.trim().replace('−', "-").replace(',', ".");
    text.parse::<f64>().ok().filter(|v| v.is_finite())
}

/// A field for one number. `name` is what a screen reader says.
pub fn field(ui: &mut Ui, id: Id, name: &str, value: f64, limits: &Limits, width: f32) -> Field {
    let palette = Palette::here(ui);
    let draft_id = id.with("draft");
    let mut draft: Option<Draft> = ui.data(|d| d.get_temp(draft_id));
    // Somebody else changed the value: what was typed is about another one.
    if draft.as_ref().is_some_and(|d| d.last != value) {
        draft = None;
    }
    let mut text = draft.as_ref().map_or_else(|| number(value), |d| d.text.clone());
    let problem = |text: &str| match parse(text) {
        Some(v) if limits.allows(v) => None,
        Some(_) => Some(format!("must be {}", limits.rule())),
        None => Some(format!("is not a number; must be {}", limits.rule())),
    };
    let wrong = draft.as_ref().and_then(|d| problem(&d.text));

    let focused = ui.memory(|m| m.has_focus(id));
    // The arrow keys turn the value; taken before the text field sees them.
    let mut step = 0.0;
    if focused {
        ui.input_mut(|i| {
            for (key, sign) in [(Key::ArrowUp, 1.0), (Key::ArrowDown, -1.0)] {
                for (modifiers, factor) in [(egui::Modifiers::SHIFT, 10.0), (egui::Modifiers::NONE, 1.0)] {
                    if i.consume_key(modifiers, key) {
                        step += sign * factor;
                    }
                }
            }
        });
    }

    let stroke = match (&wrong, focused) {
        (Some(_), _) => Stroke::new(1.5, palette.error),
        (None, true) => Stroke::new(1.5, palette.accent),
        (None, false) => Stroke::new(1.0, palette.line),
    };
    let edit = TextEdit::singleline(&mut text)
        .id(id)
        .desired_width(width - 10.0)
        .min_size(vec2(width, 22.0))
        .vertical_align(Align::Center)
        .horizontal_align(Align::Max)
        .clip_text(true)
        .text_color(if wrong.is_some() { palette.error } else { palette.text })
        .frame(field_frame(&palette, stroke));
    let response = ui.add_sized(vec2(width, 22.0), edit);
    response.widget_info(|| {
        let mut info = WidgetInfo::text_edit(ui.is_enabled(), number(value), &text, "");
        info.label = Some(name.to_owned());
        info
    });

    let mut out = None;
    if response.gained_focus() {
        draft = Some(Draft { text: text.clone(), before: value, last: value });
        select_all(ui, id, &text);
    }
    if response.changed() {
        let d = draft.get_or_insert_with(|| Draft { text: String::new(), before: value, last: value });
        d.text.clone_from(&text);
        // What was typed on the way to something illegal (3, 30, 300) was never meant: the value from
        // before counts again.
        let legal = parse(&text).filter(|v| limits.allows(*v));
        out = legal.or_else(|| Some(d.before).filter(|v| *v != value && limits.allows(*v)));
    }
    if step != 0.0 {
        let base = parse(&text).filter(|v| limits.allows(*v)).unwrap_or(value);
        let v = round_to(base + step * nudge(limits, base), nudge(limits, base))
            .clamp(limits.min.max(-1e12), limits.max);
        let v = if limits.is_above_zero() && v <= limits.min { base } else { v };
        if limits.allows(v) {
            out = Some(v);
            let d = draft.get_or_insert_with(|| Draft { before: value, last: value, text: String::new() });
            d.text = number(v);
        }
    }
    // egui itself takes the focus away at Escape.
    let escape = response.lost_focus() && ui.input(|i| i.key_pressed(Key::Escape));
    if escape && let Some(d) = draft.take() {
        out = Some(d.before).filter(|v| *v != value && limits.allows(*v));
    } else if response.lost_focus() && draft.as_ref().is_some_and(|d| problem(&d.text).is_none()) {
        draft = None;
    }
    if let (Some(v), Some(d)) = (out, draft.as_mut()) {
        d.last = f64::from(v as f32);
    }
    let error = draft.as_ref().and_then(|d| problem(&d.text));
    ui.data_mut(|d| match draft {
        Some(draft) => {
            d.insert_temp(draft_id, draft);
        }
        None => d.remove::<Draft>(draft_id),
    });
    Field { response, value: out.filter(|v| *v as f32 != value as f32 || limits.whole && *v != value), error }
}

fn select_all(ui: &Ui, id: Id, text: &str) {
    use egui::text::{CCursor, CCursorRange};
    if let Some(mut state) = egui::text_edit::TextEditState::load(ui.ctx(), id) {
        let all = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
        state.cursor.set_char_range(Some(all));
        state.store(ui.ctx(), id);
    }
}

/// What one press of an arrow key adds: about a hundredth of the range, a round number.
fn nudge(limits: &Limits, value: f64) -> f64 {
    if limits.whole {
        return 1.0;
    }
    let range =
        if curved(limits) { value.abs().max(1.0) * 10.0 } else { limits.slider_max - limits.slider_min };
    if range.is_finite() && range > 0.0 { 10f64.powf((range / 100.0).log10().round()) } else { 0.1 }
}

fn round_to(value: f64, step: f64) -> f64 {
    let rounded = (value / step).round() * step;
    // Powers of ten below one are not exact in binary: cut what the multiplication added.
    (rounded * 1e9).round() / 1e9
}

/// Whether the slider spends more of its length on small values.
fn curved(limits: &Limits) -> bool {
    limits.slider_min >= 0.0 && limits.slider_max - limits.slider_min > 60.0 && limits.slider_max > 64.0
}

const CURVE: f64 = 2.5;

fn to_slider(limits: &Limits, value: f64) -> f64 {
    let t = ((value - limits.slider_min) / (limits.slider_max - limits.slider_min)).clamp(0.0, 1.0);
    if curved(limits) { t.powf(1.0 / CURVE) } else { t }
}

fn from_slider(limits: &Limits, t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    let shaped = if curved(limits) { t.powf(CURVE) } else { t };
    let value = limits.slider_min + shaped * (limits.slider_max - limits.slider_min);
    let range = limits.slider_max - limits.slider_min;
    let fine = if curved(limits) { value.abs().max(range / 1000.0) } else { range };
    let step = if limits.whole { 1.0 } else { 10f64.powf((fine / 100.0).log10().floor()) };
    let value = round_to(value, step).clamp(limits.min, limits.max);
    if limits.is_above_zero() && value < step { step.min(limits.max) } else { value }
}

/// A slider. Double-click sets the default; the arrow keys step; Home and End go to the ends.
fn slider(
    ui: &mut Ui,
    name: &str,
    value: f64,
    default: Option<f64>,
    limits: &Limits,
    width: f32,
) -> (Response, Option<f64>) {
    let palette = Palette::here(ui);
    let height = 16.0;
    let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::slider(ui.is_enabled(), value, name));
    let radius = 6.0;
    let rail = Rect::from_min_max(
        pos2(rect.left() + radius, rect.center().y - 1.5),
        pos2(rect.right() - radius, rect.center().y + 1.5),
    );
    let mut out = None;
    if let Some(pointer) = response.interact_pointer_pos()
        && (response.dragged() || response.clicked())
    {
        let t = f64::from((pointer.x - rail.left()) / rail.width());
        out = Some(from_slider(limits, t));
    }
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    if response.double_clicked()
        && let Some(default) = default
    {
        out = Some(default);
    }
    if response.has_focus() {
        let filter = egui::EventFilter { horizontal_arrows: true, ..Default::default() };
        ui.memory_mut(|m| m.set_focus_lock_filter(response.id, filter));
        ui.input(|i| {
            let factor = if i.modifiers.shift { 10.0 } else { 1.0 };
            let presses = i.num_presses(Key::ArrowRight) as f64 - i.num_presses(Key::ArrowLeft) as f64;
            if presses != 0.0 {
                let step = nudge(limits, value);
                let v = round_to(value + presses * factor * step, step)
                    .clamp(limits.min.max(limits.slider_min), limits.max);
                out = Some(if limits.allows(v) { v } else { value });
            }
            if i.key_pressed(Key::Home) {
                out = Some(from_slider(limits, 0.0));
            }
            if i.key_pressed(Key::End) {
                out = Some(from_slider(limits, 1.0));
            }
            if i.key_pressed(Key::Backspace) {
                out = default.or(out);
            }
        });
    }
    if ui.is_rect_visible(rect) {
        let painter = ui.painter();
        let x = |v: f64| rail.left() + to_slider(limits, v) as f32 * rail.width();
        painter.rect_filled(rail, 1.5, palette.line);
        let handle = pos2(x(out.unwrap_or(value)), rail.center().y);
        painter.rect_filled(Rect::from_min_max(rail.min, pos2(handle.x, rail.bottom())), 1.5, palette.accent);
        if let Some(default) = default {
            let tick = x(default);
            painter.vline(
                tick,
                rail.center().y + 3.5..=rail.center().y + 7.0,
                Stroke::new(1.0, palette.weak),
            );
        }
        let hot = response.hovered() || response.dragged() || response.has_focus();
        let r = if hot { radius } else { radius - 1.0 };
        let outside = value < limits.slider_min || value > limits.slider_max;
        let fill = if outside {
            palette.panel
        } else if ui.is_enabled() {
            palette.text
        } else {
            palette.weak
        };
        painter.circle(handle, r, fill, Stroke::new(2.0, if hot { palette.accent } else { palette.panel }));
        if outside {
            painter.circle_stroke(handle, r, Stroke::new(1.5, palette.text));
        }
    }
    let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
    (response, out.filter(|v| limits.allows(*v) && *v as f32 != value as f32))
}

/// The room of symbol and word in the line of a knob.
#[derive(Clone, Copy, Debug)]
enum Words {
    /// As much as they need; these points are left for the rest.
    Leave(f32),
    /// A column as wide in every knob, so that sliders begin in line.
    Column,
}

/// The line of a knob: symbol and word at the left, the widgets of `right` at the right.
fn head<R>(ui: &mut Ui, caption: &Caption, words: Words, right: impl FnOnce(&mut Ui) -> R) -> (Response, R) {
    let palette = Palette::here(ui);
    let marked = !caption.symbol.is_empty()
        && maths::highlighted(ui.ctx()).is_some_and(|m| maths::same_symbol(&m, caption.symbol));
    let row = ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let height = 22.0;
        let symbol_size = 16.0;
        let symbol_column = if caption.symbol.is_empty() {
            0.0
        } else {
            (maths::symbol_width(ui, caption.symbol, symbol_size) + 6.0).max(28.0)
        };
        let colour = if ui.is_enabled() && caption.disabled.is_none() { palette.text } else { palette.weak };
        let room = match words {
            Words::Leave(points) => (ui.available_width() - points).max(symbol_column + 40.0),
            Words::Column => (COLUMN * ui.available_width()).max(symbol_column + 40.0).floor(),
        };
        // A parameter without a symbol of its own has its name for one, and need not say it twice.
        let word = if caption.symbol == caption.label { "" } else { caption.label };
        let galley = theme::elided(ui, word, TextStyle::Body, colour, room - symbol_column);
        let width = match words {
            Words::Leave(_) => symbol_column + galley.size().x,
            Words::Column => room,
        };
        let (rect, response) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
        if marked {
            ui.painter().rect_filled(rect.expand2(vec2(4.0, 0.0)), 3.0, palette.chosen);
        }
        if !caption.symbol.is_empty() {
            let at = pos2(rect.left(), rect.center().y + 5.0);
            maths::paint_symbol(ui, at, caption.symbol, symbol_size, colour);
        }
        let at = pos2(rect.left() + symbol_column, rect.center().y - galley.size().y / 2.0);
        ui.painter().galley(at, galley, colour);
        (response, ui.with_layout(egui::Layout::right_to_left(Align::Center), right).inner)
    });
    row.inner
}

/// The part of the line that symbol and word take in knobs with a slider.
const COLUMN: f32 = 0.49;
/// The points that a number and its unit take at the right of a knob.
const NUMBER: f32 = 96.0;
/// The points that a choice takes at the right of a knob.
const CHOICE: f32 = 150.0;

/// The tooltip of a knob: its name, what it does, what is legal, the default.
fn tooltip(ui: &mut Ui, caption: &Caption, rule: &str, default: &str) {
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

/// The range as the tooltip says it: the rule, and the ends of the slider if more can be typed.
fn range(limits: &Limits) -> String {
    let rule = limits.rule();
    let (left, right) = (number(limits.slider_min), number(limits.slider_max));
    match (limits.min < limits.slider_min, limits.max > limits.slider_max) {
        (false, false) => rule,
        (false, true) => format!("{rule}. Slider: {left} to {right}. Larger values can be typed"),
        (true, false) => format!("{rule}. Slider: {left} to {right}. Smaller values can be typed"),
        (true, true) => format!("{rule}. Slider: {left} to {right}. Other values can be typed"),
    }
}

/// Shows this where the pointer rests on a widget, also on a disabled one, which has a reason to say.
fn explain(response: Response, tip: impl Fn(&mut Ui)) {
    response.on_hover_ui(&tip).on_disabled_hover_ui(&tip);
}

fn capitalised(text: &str) -> String {
    let mut chars = text.chars();
    chars.next().map_or_else(String::new, |c| c.to_uppercase().chain(chars).collect())
}

/// The sentence under a field that holds something illegal. It lies over what is below, so that nothing
/// moves while one types, and is gone when one goes elsewhere; the field stays red.
fn complaint(ui: &Ui, field: &Response, error: &str, kept: &str) {
    if !(field.has_focus() || field.hovered()) || !ui.is_rect_visible(field.rect) {
        return;
    }
    let palette = Palette::here(ui);
    let gap = vec2(0.0, 4.0);
    let below = field.rect.bottom() + 56.0 < ui.ctx().content_rect().bottom();
    let (pivot, at) = if below {
        (Align2::RIGHT_TOP, field.rect.right_bottom() + gap)
    } else {
        (Align2::RIGHT_BOTTOM, field.rect.right_top() - gap)
    };
    let area = Area::new(field.id.with("complaint")).order(Order::Tooltip).interactable(false);
    area.pivot(pivot).fixed_pos(at).constrain(true).show(ui.ctx(), |ui| {
        egui::Frame::popup(ui.style()).stroke(Stroke::new(1.0, palette.error)).show(ui, |ui| {
            ui.set_max_width(300.0);
            let text = format!("{error}; the picture keeps {kept}");
            ui.add(egui::Label::new(RichText::new(text).small().color(palette.error)).wrap());
        });
    });
}

/// The unit, outside the field, in a column of its own.
fn unit(ui: &mut Ui, text: &str) {
    let palette = Palette::here(ui);
    let font = TextStyle::Small.resolve(ui.style());
    let galley = ui.painter().layout_no_wrap(text.to_owned(), font, palette.weak);
    let width = 18.0_f32.max(galley.size().x);
    let (rect, _) = ui.allocate_exact_size(vec2(width, 22.0), Sense::hover());
    ui.painter().galley(pos2(rect.left(), rect.center().y - galley.size().y / 2.0), galley, palette.weak);
}

/// The unit as a choice: each option is a sign and a word. As wide as a plain unit, so that fields stay in
/// line. Returns the index of a new choice.
pub fn unit_choice(ui: &mut Ui, chosen: usize, options: &[[&str; 2]]) -> Option<usize> {
    let palette = Palette::here(ui);
    let [sign, word] = options.get(chosen).copied().unwrap_or(["–", "unknown"]);
    let (rect, response) = ui.allocate_exact_size(vec2(18.0, 22.0), Sense::click());
    response
        .widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, ui.is_enabled(), format!("unit: {word}")));
    let hot = response.hovered() || response.has_focus();
    let colour = if hot { palette.accent } else { palette.text };
    let font = TextStyle::Small.resolve(ui.style());
    let at = rect.center() - vec2(0.0, 3.0);
    ui.painter().text(at, egui::Align2::CENTER_CENTER, sign, font, colour);
    let tip = rect.center_bottom() - vec2(0.0, 2.0);
    let corners = [tip, tip + vec2(-3.5, -4.0), tip + vec2(3.5, -4.0)];
    ui.painter().add(egui::Shape::convex_polygon(corners.to_vec(), colour, Stroke::NONE));
    let mut out = None;
    egui::Popup::menu(&response).show(|ui| {
        for (i, [sign, word]) in options.iter().enumerate() {
            if ui.selectable_label(i == chosen, format!("{sign}  {word}")).clicked() && i != chosen {
                out = Some(i);
            }
        }
    });
    response
        .on_hover_cursor(CursorIcon::PointingHand)
        .on_hover_text(format!("In {word}. Choose another unit: the light stays the same."));
    out
}

/// A knob for a number: returns a new legal value.
pub fn number_knob(
    ui: &mut Ui,
    salt: &str,
    caption: &Caption,
    value: f64,
    default: Option<f64>,
    limits: &Limits,
) -> Option<f64> {
    number_knob_beside(ui, salt, caption, value, default, limits, |ui| unit(ui, caption.unit))
}

/// The same with something of its own where the unit stands.
pub fn number_knob_beside(
    ui: &mut Ui,
    salt: &str,
    caption: &Caption,
    value: f64,
    default: Option<f64>,
    limits: &Limits,
    beside: impl FnOnce(&mut Ui),
) -> Option<f64> {
    let id = ui.make_persistent_id(salt);
    let mut out = None;
    ui.add_enabled_ui(caption.disabled.is_none(), |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let finite = limits.slider_min.is_finite() && limits.slider_max.is_finite();
        let words = if finite { Words::Column } else { Words::Leave(NUMBER) };
        let (label, (field, slider)) = head(ui, caption, words, |ui| {
            beside(ui);
            let field = field(ui, id, caption.label, value, limits, 56.0);
            let width = (ui.available_width() - 2.0).max(24.0);
            (field, finite.then(|| slider(ui, caption.label, value, default, limits, width)))
        });
        out = field.value;
        let mut hot = label.hovered() || field.response.hovered();
        let (rule, default_text) = (range(limits), default.map(number).unwrap_or_default());
        let tip = |ui: &mut Ui| tooltip(ui, caption, &rule, &default_text);
        explain(label, tip);
        if let Some((slider, new)) = slider {
            out = new.or(out);
            hot |= slider.hovered() || slider.dragged() || slider.has_focus();
            explain(slider, tip);
        }
        if hot && !caption.symbol.is_empty() {
            maths::highlight(ui.ctx(), caption.symbol);
        }
        match &field.error {
            Some(error) => complaint(ui, &field.response, &capitalised(error), &number(value)),
            // While one types it would hide what is below.
            None if field.response.has_focus() => {}
            None => explain(field.response, tip),
        }
        ui.add_space(3.0);
    });
    out
}

/// A knob for a whole colour, sRGB-encoded: swatch with picker, three integers, hexadecimal.
pub fn colour_knob(
    ui: &mut Ui,
    salt: &str,
    caption: &Caption,
    value: [u8; 3],
    default: Option<[u8; 3]>,
) -> Option<[u8; 3]> {
    let id = ui.make_persistent_id(salt);
    let mut out = None;
    ui.add_enabled_ui(caption.disabled.is_none(), |ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        let rule = "three whole numbers from 0 to 255: red, green, blue";
        let default_text = default.map(|[r, g, b]| format!("{r}, {g}, {b}")).unwrap_or_default();
        let [r, g, b] = value;
        let (label, hex) = head(ui, caption, Words::Leave(NUMBER), |ui| {
            unit(ui, "");
            let name = format!("{} in hexadecimal", caption.label);
            let shown = format!("#{r:02x}{g:02x}{b:02x}");
            let read = |text: &str| {
                parse_hex(text)
                    .ok_or_else(|| "is not a colour; must be # and six hexadecimal digits".to_owned())
            };
            text_field(ui, id.with("hex"), &name, &shown, "", 72.0, read)
        });
        out = hex.value;
        let mut hot = label.hovered();
        let rule = format!("{rule}, encoded as sRGB. Default {default_text}");
        explain(label, |ui| tooltip(ui, caption, &rule, ""));
        let mut wrong = hex.error.map(|e| (e, hex.response));
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let mut rgb = value;
            let swatch = swatch(ui, id.with("swatch"), caption.label, &mut rgb, default);
            hot |= swatch.hovered();
            if rgb != value {
                out = Some(rgb);
            }
            let limits = Limits::between(0.0, 255.0).whole();
            for (channel, letter) in ["R", "G", "B"].into_iter().enumerate() {
                let name = format!("{}: {}", caption.label, ["red", "green", "blue"][channel]);
                axis_letter(ui, letter, &name, &limits, f64::from(value[channel]), |v| {
                    let mut rgb = value;
                    rgb[channel] = v as u8;
                    out = Some(rgb);
                });
                let f = field(ui, id.with(channel), &name, f64::from(value[channel]), &limits, 40.0);
                if let Some(v) = f.value {
                    let mut rgb = value;
                    rgb[channel] = v as u8;
                    out = Some(rgb);
                }
                wrong = wrong.take().or(f.error.map(|e| (e, f.response)));
            }
            unit(ui, caption.unit);
        });
        if hot && !caption.symbol.is_empty() {
            maths::highlight(ui.ctx(), caption.symbol);
        }
        if let Some((error, field)) = wrong {
            complaint(ui, &field, &capitalised(&error), &format!("{r}, {g}, {b}"));
        }
        ui.add_space(6.0);
    });
    out.filter(|c| *c != value)
}

/// The colour itself; a click opens the picker, a double-click sets the default.
fn swatch(ui: &mut Ui, id: Id, name: &str, rgb: &mut [u8; 3], default: Option<[u8; 3]>) -> Response {
    let palette = Palette::here(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(44.0, 22.0), Sense::click());
    let says = format!("{name}: choose a colour");
    response.widget_info(|| WidgetInfo::labeled(WidgetType::ColorButton, ui.is_enabled(), &says));
    let [r, g, b] = *rgb;
    let hot = response.hovered() || response.has_focus();
    let stroke = Stroke::new(if hot { 1.5 } else { 1.0 }, if hot { palette.accent } else { palette.weak });
    ui.painter().rect(rect, 4.0, Color32::from_rgb(r, g, b), stroke, egui::StrokeKind::Inside);
    if response.double_clicked()
        && let Some(default) = default
    {
        *rgb = default;
        egui::Popup::close_id(ui.ctx(), id);
        return response;
    }
    egui::Popup::from_toggle_button_response(&response)
        .id(id)
        .close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            ui.spacing_mut().slider_width = 220.0;
            let mut colour = Color32::from_rgb(rgb[0], rgb[1], rgb[2]);
            if egui::color_picker::color_picker_color32(ui, &mut colour, egui::color_picker::Alpha::Opaque) {
                *rgb = [colour.r(), colour.g(), colour.b()];
            }
        });
    response.on_hover_text("Choose a colour. Double-click: default.")
}

/// A colour that follows from something else.
pub fn colour_sample(ui: &mut Ui, rgb: [u8; 3]) {
    let palette = Palette::here(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(44.0, 22.0), Sense::hover());
    let [r, g, b] = rgb;
    let stroke = Stroke::new(1.0, palette.line);
    ui.painter().rect(rect, 4.0, Color32::from_rgb(r, g, b), stroke, egui::StrokeKind::Inside);
    response.on_hover_text(format!("The colour in sRGB: {r}, {g}, {b}"));
}

/// The box around what is typed.
fn field_frame(palette: &Palette, stroke: Stroke) -> egui::Frame {
    egui::Frame::new()
        .fill(palette.field)
        // A stroke of another width would move what stands below.
        .stroke(Stroke::new(1.0, stroke.color))
        .corner_radius(4.0)
        .inner_margin(egui::Margin::symmetric(4, 2))
}

/// A field for a value that is not one number: `read` takes what is typed or says what is wrong. What is
/// not legal is gone when the field is left. `name` is what a screen reader says.
fn text_field<T>(
    ui: &mut Ui,
    id: Id,
    name: &str,
    shown: &str,
    hint: &str,
    width: f32,
    read: impl Fn(&str) -> Result<T, String>,
) -> Field<T> {
    let palette = Palette::here(ui);
    let draft_id = id.with("draft");
    let draft: Option<String> = ui.data(|d| d.get_temp(draft_id));
    let focused = ui.memory(|m| m.has_focus(id));
    let mut text = draft.filter(|_| focused).unwrap_or_else(|| shown.to_owned());
    let wrong = focused && text != shown && read(&text).is_err();
    let stroke = if wrong {
        Stroke::new(1.5, palette.error)
    } else if focused {
        Stroke::new(1.5, palette.accent)
    } else {
        Stroke::new(1.0, palette.line)
    };
    let edit = TextEdit::singleline(&mut text)
        .id(id)
        .hint_text(RichText::new(hint).color(palette.weak))
        .desired_width(width - 10.0)
        .min_size(vec2(width, 22.0))
        .vertical_align(Align::Center)
        .horizontal_align(Align::Max)
        .text_color(if wrong { palette.error } else { palette.text })
        .frame(field_frame(&palette, stroke));
    let response = ui.add_sized(vec2(width, 22.0), edit);
    response.widget_info(|| {
        let mut info = WidgetInfo::text_edit(ui.is_enabled(), shown, &text, hint);
        info.label = Some(name.to_owned());
        info
    });
    if response.gained_focus() {
        select_all(ui, id, &text);
    }
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

/// Reads `#rrggbb`, `rrggbb` or `#rgb`.
#[must_use]
pub fn parse_hex(text: &str) -> Option<[u8; 3]> {
    let digits = text.trim().trim_start_matches('#');
    if !digits.is_ascii() {
        return None;
    }
    let digits = match digits.len() {
        3 => digits.chars().flat_map(|c| [c, c]).collect(),
        6 => digits.to_owned(),
        _ => return None,
    };
    let at = |i: usize| u8::from_str_radix(&digits[i..i + 2], 16).ok();
    Some([at(0)?, at(2)?, at(4)?])
}

/// The letter before a field; dragging it sideways turns the value.
fn axis_letter(ui: &mut Ui, letter: &str, name: &str, limits: &Limits, value: f64, set: impl FnOnce(f64)) {
    let palette = Palette::here(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(14.0, 22.0), Sense::DRAG);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::DragValue, ui.is_enabled(), name));
    let colour = if response.hovered() || response.dragged() { palette.accent } else { palette.weak };
    let font = TextStyle::Small.resolve(ui.style());
    ui.painter().text(rect.right_center() - vec2(2.0, 0.0), Align2::RIGHT_CENTER, letter, font, colour);
    if response.dragged() {
        let id = response.id.with("drag");
        let start: f64 =
            if response.drag_started() { value } else { ui.data(|d| d.get_temp(id)).unwrap_or(value) };
        ui.data_mut(|d| d.insert_temp(id, start));
        if let Some(moved) = response.total_drag_delta() {
            let range = limits.slider_max - limits.slider_min;
            let range = if range.is_finite() { range } else { 10.0 };
            let step = if limits.whole { 1.0 } else { 10f64.powf((range / 100.0).log10().round()) };
            let wanted = round_to(start + f64::from(moved.x) * range / 400.0, step);
            let low = if limits.is_above_zero() { step } else { limits.min };
            let wanted = wanted.clamp(low.min(limits.max), limits.max);
            if limits.allows(wanted) && wanted as f32 != value as f32 {
                set(wanted);
            }
        }
    }
    response
        .on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal)
        .on_hover_text("Drag sideways to change the value");
}

/// Three letters with a field each, from where the line is to the unit at its end. Returns the new
/// value, and the first complaint with the field that it is about.
fn three_fields(
    ui: &mut Ui,
    id: Id,
    caption: &Caption,
    letters: [&str; 3],
    value: Vec3,
    limits: &[Limits; 3],
) -> (Option<Vec3>, Option<(String, f64, Response)>) {
    let mut out = None;
    let mut wrong = None;
    // Three letters, three fields, the unit, and the gaps between the seven.
    let room = ui.available_width() - (3.0 * 14.0 + 18.0 + 6.0 * 4.0);
    let width = (room / 3.0).clamp(36.0, 96.0).floor();
    for axis in 0..3 {
        let component = f64::from(value.to_array()[axis]);
        let name = format!("{} {}", caption.label, letters[axis]);
        let mut set = |v: f64| {
            let mut new = value.to_array();
            new[axis] = v as f32;
            out = Some(Vec3::from_array(new));
        };
        axis_letter(ui, letters[axis], &name, &limits[axis], component, &mut set);
        let f = field(ui, id.with(axis), &name, component, &limits[axis], width);
        if let Some(v) = f.value {
            set(v);
        }
        wrong = wrong.or(f.error.map(|e| (format!("{} {e}", letters[axis]), component, f.response)));
    }
    unit(ui, caption.unit);
    (out.filter(|v| *v != value), wrong)
}

/// A field for three numbers, each with its own limits.
pub fn vector_knob(
    ui: &mut Ui,
    salt: &str,
    caption: &Caption,
    value: Vec3,
    limits: &[Limits; 3],
) -> Option<Vec3> {
    const LETTERS: [&str; 3] = ["x", "y", "z"];
    let id = ui.make_persistent_id(salt);
    let mut out = None;
    ui.add_enabled_ui(caption.disabled.is_none(), |ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let font = TextStyle::Body.resolve(ui.style());
            let colour = Palette::here(ui).text;
            let galley = ui.painter().layout_no_wrap(caption.label.to_owned(), font, colour);
            let column = galley.size().x.max(54.0);
            let (rect, label) = ui.allocate_exact_size(vec2(column, 22.0), Sense::hover());
            ui.painter().galley(pos2(rect.left(), rect.center().y - galley.size().y / 2.0), galley, colour);
            label.on_hover_ui(|ui| {
                ui.set_max_width(300.0);
                ui.label(caption.help);
                for (letter, limits) in LETTERS.iter().zip(limits) {
                    ui.label(theme::small(ui, format!("{letter}: {}", limits.rule())));
                }
            });
            let (new, wrong) = three_fields(ui, id, caption, LETTERS, value, limits);
            out = new;
            if let Some((error, kept, field)) = wrong {
                complaint(ui, &field, &error, &number(kept));
            }
        });
        ui.add_space(6.0);
    });
    out
}

/// A knob for a number in red, green and blue: a field for all three at once, and one for each.
pub fn triple_knob(
    ui: &mut Ui,
    salt: &str,
    caption: &Caption,
    value: [f32; 3],
    default: [f32; 3],
    limits: &Limits,
) -> Option<[f32; 3]> {
    let id = ui.make_persistent_id(salt);
    let mut out = None;
    ui.add_enabled_ui(caption.disabled.is_none(), |ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        let plain = |v: f32| number(f64::from(v));
        let list = |v: [f32; 3]| v.map(plain).join(", ");
        let same = value[0] == value[1] && value[1] == value[2];
        let (label, all) = head(ui, caption, Words::Leave(NUMBER), |ui| {
            unit(ui, "");
            let shown = if same { plain(value[0]) } else { String::new() };
            let read = |text: &str| match parse(text) {
                Some(v) if limits.allows(v) => Ok([v as f32; 3]),
                Some(_) => Err(format!("must be {}", limits.rule())),
                None => Err(format!("is not a number; must be {}", limits.rule())),
            };
            let name = format!("{}: all three", caption.label);
            text_field(ui, id.with("all"), &name, &shown, "all", 64.0, read)
        });
        out = all.value;
        if (label.hovered() || all.response.hovered()) && !caption.symbol.is_empty() {
            maths::highlight(ui.ctx(), caption.symbol);
        }
        let rule = format!("each {}. Default {}", limits.rule(), list(default));
        explain(label, |ui| tooltip(ui, caption, &rule, ""));
        let mut wrong = all.error.map(|e| (capitalised(&e), list(value), all.response));
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let bounds = [limits.clone(), limits.clone(), limits.clone()];
            let (new, bad) = three_fields(ui, id, caption, ["R", "G", "B"], value.into(), &bounds);
            out = new.map(Into::into).or(out);
            wrong = wrong.take().or(bad.map(|(e, kept, field)| (e, number(kept), field)));
        });
        if let Some((error, kept, field)) = wrong {
            complaint(ui, &field, &error, &kept);
        }
        ui.add_space(6.0);
    });
    out.filter(|v| *v != value)
}

/// What follows from the knobs: symbol, word, and the value with a sample of its colour.
pub fn readout(ui: &mut Ui, readout: &Readout) {
    let palette = Palette::here(ui);
    let caption = Caption { symbol: readout.symbol, label: readout.label, ..Caption::default() };
    let digits = |v: f32| format!("{v:.3}");
    let text = match readout.value {
        ReadoutValue::Number(v) => digits(v),
        ReadoutValue::Reflectance(rgb) => rgb.to_array().map(digits).join("  "),
    };
    let value = |ui: &mut Ui| {
        unit(ui, "");
        if let ReadoutValue::Reflectance(rgb) = readout.value {
            let (rect, _) = ui.allocate_exact_size(vec2(22.0, 14.0), Sense::hover());
            let stroke = Stroke::new(1.0, palette.weak);
            ui.painter().rect(rect, 3.0, theme::swatch(rgb), stroke, egui::StrokeKind::Inside);
        }
        let value = ui.label(&text);
        let spoken = format!("{}: {text}", readout.label);
        value.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, &spoken));
        value
    };
    let tip = |ui: &mut Ui| {
        ui.set_max_width(300.0);
        ui.label(theme::strong(ui, readout.label));
        ui.label(readout.help);
    };
    let (label, value) = match readout.value {
        ReadoutValue::Number(_) => head(ui, &caption, Words::Leave(NUMBER), value),
        // Three numbers and the sample have a line of their own.
        ReadoutValue::Reflectance(_) => {
            let spacing = std::mem::take(&mut ui.spacing_mut().item_spacing.y);
            let (label, ()) = head(ui, &caption, Words::Leave(0.0), |_| ());
            let row = vec2(ui.available_width(), 20.0);
            let layout = egui::Layout::right_to_left(Align::Center);
            let value = ui.allocate_ui_with_layout(row, layout, value).inner;
            ui.spacing_mut().item_spacing.y = spacing;
            (label, value)
        }
    };
    label.on_hover_ui(tip);
    value.on_hover_ui(tip);
}

/// One of many: word at the left; the button at the right opens what `list` shows, until that returns
/// something. `list` gets an id of its own.
pub fn list_knob<R>(
    ui: &mut Ui,
    salt: &str,
    caption: &Caption,
    shown: &str,
    list: impl FnOnce(&mut Ui, Id) -> Option<R>,
) -> Option<R> {
    let palette = Palette::here(ui);
    let id = ui.make_persistent_id(salt);
    let (label, button) = head(ui, caption, Words::Leave(CHOICE), |ui| {
        ui.add_space(22.0);
        let width = (ui.available_width() - 4.0).clamp(80.0, 190.0);
        let button = Button::new(shown).right_text(RichText::new("▾").color(palette.weak)).truncate();
        let button = ui.add_sized(vec2(width, 24.0), button);
        button.widget_info(|| {
            WidgetInfo::labeled(WidgetType::ComboBox, true, format!("{}: {shown}", caption.label))
        });
        button
    });
    explain(label, |ui| tooltip(ui, caption, "", ""));
    let out = drop_down(&button, id, list);
    if out.is_some() {
        Popup::close_id(ui.ctx(), id);
    }
    ui.add_space(4.0);
    out
}

/// What a button opens and closes: `list`, which gets an id of its own.
pub(super) fn drop_down<R>(
    button: &Response,
    id: Id,
    list: impl FnOnce(&mut Ui, Id) -> Option<R>,
) -> Option<R> {
    let width = 352.0;
    let list_id = id.with("list");
    let popup = Popup::from_toggle_button_response(button)
        .id(id)
        .align(RectAlign::BOTTOM_END)
        .width(width)
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            ui.set_width(width);
            list(ui, list_id)
        });
    if popup.is_none() {
        chooser::forget(&button.ctx, list_id);
    }
    popup.and_then(|popup| popup.inner)
}

/// One of several: word at the left, list at the right. Returns the index of a new choice.
pub fn choice_knob(
    ui: &mut Ui,
    salt: &str,
    caption: &Caption,
    chosen: usize,
    options: &[&str],
) -> Option<usize> {
    let plain: Vec<_> = options.iter().map(|name| [*name, "", ""]).collect();
    told_choice_knob(ui, salt, caption, chosen, &plain)
}

/// The same where each option is a name, its author and what it does; the latter two may be empty.
pub fn told_choice_knob(
    ui: &mut Ui,
    salt: &str,
    caption: &Caption,
    chosen: usize,
    options: &[[&str; 3]],
) -> Option<usize> {
    let tip = |ui: &mut Ui, [name, author, summary]: [&str; 3]| {
        ui.set_max_width(300.0);
        ui.label(theme::strong(ui, name));
        ui.label(summary);
        if !author.is_empty() {
            ui.label(theme::small(ui, author));
        }
    };
    let mut out = None;
    ui.add_enabled_ui(caption.disabled.is_none(), |ui| {
        let id = ui.make_persistent_id(salt);
        let (label, ()) = head(ui, caption, Words::Leave(CHOICE), |ui| {
            ui.add_space(22.0);
            let width = (ui.available_width() - 4.0).clamp(80.0, 190.0);
            let now = options.get(chosen).copied();
            let [shown, _, told] = now.unwrap_or(["–", "", ""]);
            let combo = egui::ComboBox::from_id_salt(id)
                .width(width)
                .truncate()
                .selected_text(shown)
                .show_ui(ui, |ui| {
                    for (i, option) in options.iter().enumerate() {
                        let response = ui.selectable_label(i == chosen, option[0]);
                        if response.clicked() && i != chosen {
                            out = Some(i);
                        }
                        if !option[2].is_empty() {
                            response.on_hover_ui(|ui| tip(ui, *option));
                        }
                    }
                });
            combo.response.widget_info(|| {
                WidgetInfo::labeled(WidgetType::ComboBox, true, format!("{}: {shown}", caption.label))
            });
            if caption.disabled.is_some() {
                explain(combo.response, |ui| tooltip(ui, caption, "", ""));
            } else if !told.is_empty() {
                combo.response.on_hover_ui(|ui| now.into_iter().for_each(|now| tip(ui, now)));
            }
        });
        if label.hovered() && !caption.symbol.is_empty() {
            maths::highlight(ui.ctx(), caption.symbol);
        }
        explain(label, |ui| tooltip(ui, caption, "", ""));
        ui.add_space(4.0);
    });
    out
}

/// The limits that a declaration gives, for numbers.
#[must_use]
pub fn limits_of(parameter: &Parameter) -> Option<Limits> {
    match parameter.kind {
        ParameterKind::Number { min, max, .. } => Some(Limits {
            min: f64::from(min),
            max: f64::from(max),
            slider_min: if f64::from(min) < 1e-30 { f64::from(min.min(0.0)) } else { f64::from(min) },
            slider_max: f64::from(max),
            whole: false,
            because: None,
        }),
        ParameterKind::Integer { min, max, slider_max, .. } => Some(Limits {
            min: min as f64,
            max: max.map_or(f64::INFINITY, |m| m as f64),
            slider_min: min as f64,
            slider_max: max.unwrap_or(slider_max).min(slider_max.max(min + 1)) as f64,
            whole: true,
            because: None,
        }),
        ParameterKind::Colour { .. } | ParameterKind::Triple { .. } | ParameterKind::Choice { .. } => None,
    }
}

/// The knob of a declared parameter. Returns a new legal value.
pub fn parameter_knob(
    ui: &mut Ui,
    salt: &str,
    parameter: &Parameter,
    value: &Value,
    disabled: Option<&str>,
) -> Option<Value> {
    let caption = Caption {
        symbol: parameter.symbol,
        label: parameter.label,
        unit: parameter.unit,
        help: parameter.help,
        disabled,
    };
    match (&parameter.kind, value) {
        (ParameterKind::Number { default, .. }, Value::Number(v)) => {
            let limits = limits_of(parameter)?;
            // The limits are f32: a value at an end must not fall outside for being an f64.
            number_knob(ui, salt, &caption, f64::from(*v), Some(f64::from(*default)), &limits)
                .map(|v| Value::Number(v as f32))
                .filter(|v| parameter.allows(v))
        }
        (ParameterKind::Integer { default, .. }, Value::Integer(v)) => {
            let limits = limits_of(parameter)?;
            number_knob(ui, salt, &caption, *v as f64, Some(*default as f64), &limits)
                .map(|v| Value::Integer(v as i64))
                .filter(|v| parameter.allows(v))
        }
        (ParameterKind::Colour { default }, Value::Colour(rgb)) => {
            colour_knob(ui, salt, &caption, *rgb, Some(*default)).map(Value::Colour)
        }
        (ParameterKind::Triple { min, max, default }, Value::Triple(v)) => {
            let limits = Limits::between(f64::from(*min), f64::from(*max));
            triple_knob(ui, salt, &caption, *v, *default, &limits)
                .map(Value::Triple)
                .filter(|v| parameter.allows(v))
        }
        (ParameterKind::Choice { options, .. }, Value::Choice(id)) => {
            let chosen = options.iter().position(|(o, _)| *o == id.as_ref()).unwrap_or(0);
            let names: Vec<_> = options.iter().map(|(_, name)| *name).collect();
            choice_knob(ui, salt, &caption, chosen, &names).map(|i| Value::Choice(options[i].0.into()))
        }
        _ => None,
    }
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

    #[test]
    fn colours_are_read_in_hexadecimal() {
        assert_eq!(parse_hex("#ff8000"), Some([255, 128, 0]));
        assert_eq!(parse_hex("F80"), Some([255, 136, 0]));
        for nonsense in ["", "#ff80", "#gg0000", "ü1234"] {
            assert_eq!(parse_hex(nonsense), None, "{nonsense:?}");
        }
    }

    #[test]
    fn sliders_stay_legal_and_find_their_way_back() {
        let all = [
            Limits::between(0.5, 1.0),
            Limits::above_zero(90.0),
            Limits::between(0.0, f64::INFINITY).slider(0.0, 512.0).whole(),
            Limits::between(1.0, 170.0),
        ];
        for limits in all {
            for i in 0..=100 {
                let t = f64::from(i) / 100.0;
                let value = from_slider(&limits, t);
                assert!(limits.allows(value), "{value} at {t} in {limits:?}");
                assert!((to_slider(&limits, value) - t).abs() < 0.16, "{value} at {t} in {limits:?}");
            }
        }
    }
}
