//! Knobs for one number.

use bevy_egui::egui::{self, CursorIcon, Sense, Stroke, TextStyle, Ui, WidgetInfo, WidgetType, vec2};

use super::{
    Declared, Knob,
    field::{complaint, field, shown},
    line::{Caption, NUMBER, Words, explain, head, knob, range, tooltip, unit},
    slider::{Amount, slider},
};
use crate::{
    panel::{
        menu, narrow,
        theme::{self, Palette},
    },
    parameter::{Value, kind::number::Number},
    scene::limits::number,
    text::capitalised,
};

impl Knob for Number {
    fn show(&self, ui: &mut Ui, of: &Declared, value: &Value) -> Option<Value> {
        of_parameter(ui, of, value, self.default.into())
    }
}

/// The knob of a parameter that is one number.
pub(super) fn of_parameter(ui: &mut Ui, of: &Declared, value: &Value, default: f64) -> Option<Value> {
    let kind = &of.parameter.kind;
    let (now, limits) = (kind.number_of(value)?, kind.limits()?);
    let new = number_knob(ui, &of.caption, Amount::new(now, Some(default), &limits))?;
    Some(kind.of_numbers([new; 3]))
}

/// The unit as a choice: each option has a sign and a name. As wide as the longest sign and at least as a plain unit, so
/// that the field stays in its place. Returns the index of a new choice.
pub fn unit_choice(ui: &mut Ui, chosen: usize, options: &[[&str; 2]]) -> Option<usize> {
    let palette = Palette::here(ui);
    let [sign, word] = options.get(chosen).copied().unwrap_or(["–", "unknown"]);
    let font = TextStyle::Small.resolve(ui.style());
    let wide = |[sign, _]: &[&str; 2]| theme::small_width(ui, sign).ceil();
    // The text does not touch the edge of the panel.
    let width = options.iter().map(wide).fold(16.0, f32::max) + 2.0;
    let size = vec2(width, narrow::high(ui.ctx(), 22.0));
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response
        .widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, ui.is_enabled(), format!("unit: {word}")));
    let hot = response.hovered() || response.has_focus();
    let colour = if hot { palette.accent } else { palette.text };
    let at = rect.center() - vec2(0.0, 3.0);
    ui.painter().text(at, egui::Align2::CENTER_CENTER, sign, font, colour);
    let tip = rect.center_bottom() - vec2(0.0, 2.0);
    let corners = [tip, tip + vec2(-3.5, -4.0), tip + vec2(3.5, -4.0)];
    ui.painter().add(egui::Shape::convex_polygon(corners.to_vec(), colour, Stroke::NONE));
    let mut out = None;
    let mut by_key = false;
    egui::Popup::menu(&response).show(|ui| {
        for (i, [sign, word]) in options.iter().enumerate() {
            let choice = menu::choice(ui, i == chosen, format!("{sign}  {word}"), &mut by_key);
            if choice.clicked() && i != chosen {
                out = Some(i);
            }
        }
    });
    if by_key {
        response.request_focus();
    }
    response
        .on_hover_cursor(CursorIcon::PointingHand)
        .on_hover_text(format!("In {word}. Choose another unit: the light stays the same."));
    out
}

/// Width of a line below which a long unit leaves no room for a slider, and that of a long unit, in points.
const SLIM: f32 = 300.0;
const LONG_UNIT: f32 = 24.0;

/// A knob for a number. Returns a new valid value.
pub fn number_knob(ui: &mut Ui, caption: &Caption, amount: Amount) -> Option<f64> {
    number_knob_beside(ui, caption, amount, |ui| unit(ui, caption.unit))
}

/// A knob for a number with other widgets in place of the unit.
pub fn number_knob_beside(
    ui: &mut Ui,
    caption: &Caption,
    amount: Amount,
    beside: impl FnOnce(&mut Ui),
) -> Option<f64> {
    let Amount { value, default, limits } = amount;
    let id = ui.make_persistent_id(caption.salt);
    knob(ui, caption, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let finite = limits.slider_min.is_finite() && limits.slider_max.is_finite();
        let is_slim = ui.available_width() < SLIM && theme::small_width(ui, caption.unit) > LONG_UNIT;
        let words = match finite {
            true if is_slim => Words::Slim,
            true => Words::Column,
            false => Words::Leave(NUMBER),
        };
        let (label, (field, slider)) = head(ui, caption, words, |ui| {
            beside(ui);
            let field = field(ui, id, caption.label, value, limits, 56.0);
            let width = (ui.available_width() - 2.0).max(24.0);
            (field, finite.then(|| slider(ui, caption.label, amount, width)))
        });
        let mut out = field.value;
        let (rule, default_text) = (range(limits), default.map(number).unwrap_or_default());
        let tip = |ui: &mut Ui| tooltip(ui, caption, &rule, &default_text);
        explain(label, tip);
        if let Some((slider, new)) = slider {
            out = new.or(out);
            explain(slider, tip);
        }
        match &field.error {
            Some(error) => complaint(ui, &field.response, &capitalised(error), &shown(value)),
            // During typing, a tooltip would hide what is below.
            None if field.response.has_focus() => {}
            None => explain(field.response, tip),
        }
        ui.add_space(3.0);
        out
    })
}
