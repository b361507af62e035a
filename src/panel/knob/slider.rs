//! The slider of a number.

use bevy_egui::egui::{
    CursorIcon, Key, Rect, Response, Sense, Stroke, Ui, WidgetInfo, WidgetType, pos2, vec2,
};

use crate::{
    panel::{focus, narrow, theme::Palette},
    scene::limits::Limits,
};

/// The value of a number, its default and its limits.
#[derive(Clone, Copy, Debug)]
pub struct Amount<'a> {
    /// The value.
    pub value: f64,
    /// The default, if there is one.
    pub default: Option<f64>,
    /// The limits.
    pub limits: &'a Limits,
}

impl<'a> Amount<'a> {
    /// A value with a default and limits.
    #[must_use]
    pub fn new(value: f64, default: Option<f64>, limits: &'a Limits) -> Self {
        Self { value, default, limits }
    }
}

/// Step of an arrow key: about a hundredth of the range, rounded.
pub(super) fn nudge(limits: &Limits, value: f64) -> f64 {
    if limits.whole {
        return 1.0;
    }
    let range =
        if curved(limits) { value.abs().max(1.0) * 10.0 } else { limits.slider_max - limits.slider_min };
    if range.is_finite() && range > 0.0 { 10f64.powf((range / 100.0).log10().round()) } else { 0.1 }
}

pub(super) fn round_to(value: f64, step: f64) -> f64 {
    let rounded = (value / step).round() * step;
    // Powers of ten below one are not exact in binary: remove the rounding error of the multiplication.
    (rounded * 1e9).round() / 1e9
}

/// True if the slider devotes more of its length to small values.
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

/// Height of a slider, and of its rail, in points.
const HEIGHT: f32 = 16.0;
const RAIL: f32 = 3.0;
/// Half the height of the handle, in points.
const RADIUS: f32 = 6.0;

/// A slider. A double-click sets the default; arrow keys step; Home and End go to the ends.
pub(super) fn slider(ui: &mut Ui, name: &str, amount: Amount, width: f32) -> (Response, Option<f64>) {
    let size = vec2(width, narrow::high(ui.ctx(), HEIGHT));
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    let Amount { value, limits, .. } = amount;
    response.widget_info(|| match value.is_nan() {
        true => WidgetInfo::labeled(WidgetType::Slider, ui.is_enabled(), name),
        false => WidgetInfo::slider(ui.is_enabled(), value, name),
    });
    let rail = rect.shrink2(vec2(RADIUS, 0.5 * (rect.height() - RAIL)));
    let out = asked(ui, &response, rail, amount);
    if ui.is_rect_visible(rect) {
        paint(ui, &response, rail, out.unwrap_or(value), amount);
    }
    let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
    (response, out.filter(|v| limits.allows(*v) && *v as f32 != value as f32))
}

/// The value that pointer or keys ask for.
fn asked(ui: &Ui, response: &Response, rail: Rect, Amount { value, default, limits }: Amount) -> Option<f64> {
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
    if response.double_clicked() {
        out = default.or(out);
    }
    let [steps, _] = focus::steps(ui, response, [true, false]);
    if steps != 0.0 {
        let step = nudge(limits, value);
        let v = round_to(value + steps * step, step).clamp(limits.min.max(limits.slider_min), limits.max);
        out = Some(if limits.allows(v) { v } else { value });
    }
    if response.has_focus() {
        let pressed = |key| ui.input(|i| i.key_pressed(key));
        for (key, end) in [(Key::Home, 0.0), (Key::End, 1.0)] {
            out = if pressed(key) { Some(from_slider(limits, end)) } else { out };
        }
        out = default.filter(|_| pressed(Key::Backspace)).or(out);
    }
    out
}

/// Paints the slider of a value, with its handle at `now`.
fn paint(ui: &Ui, response: &Response, rail: Rect, now: f64, Amount { value, default, limits }: Amount) {
    let (palette, painter) = (Palette::here(ui), ui.painter());
    let x = |v: f64| rail.left() + to_slider(limits, v) as f32 * rail.width();
    painter.rect_filled(rail, 1.5, palette.line);
    // Several values that differ have no handle.
    if now.is_nan() {
        return;
    }
    let handle = pos2(x(now), rail.center().y);
    painter.rect_filled(rail.with_max_x(handle.x), 1.5, palette.accent);
    if let Some(default) = default {
        let tick = rail.center().y + 3.5..=rail.center().y + 7.0;
        painter.vline(x(default), tick, Stroke::new(1.0, palette.weak));
    }
    let hot = response.hovered() || response.dragged() || response.has_focus();
    let r = if hot { RADIUS } else { RADIUS - 1.0 };
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

#[cfg(test)]
mod tests {
    use super::*;

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
