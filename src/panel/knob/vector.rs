//! Knobs for three numbers.

use bevy_egui::egui::{
    Align2, CursorIcon, Id, Response, Sense, TextStyle, Ui, WidgetInfo, WidgetType, pos2, vec2,
};
use glam::Vec3;

use super::{
    field::{complaint, field, shown},
    line::{Caption, explain, knob, tooltip, unit},
    slider::round_to,
};
use crate::{
    panel::{
        narrow,
        theme::{self, Palette},
    },
    scene::limits::Limits,
};

/// The letter in front of a field; dragging it sideways changes the value.
pub(super) fn axis_letter(
    ui: &mut Ui,
    letter: &str,
    name: &str,
    limits: &Limits,
    value: f64,
    set: impl FnOnce(f64),
) {
    let palette = Palette::here(ui);
    let size = vec2(14.0, narrow::high(ui.ctx(), 22.0));
    let (rect, response) = ui.allocate_exact_size(size, Sense::DRAG);
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

/// Width of three letters, the unit, and the gaps between these and three fields, in points.
const BETWEEN: f32 = 3.0 * 14.0 + 18.0 + 6.0 * 4.0;
/// Minimum width of a field beside the label, in points: a number with a sign and three decimals.
const LEAST: f32 = 56.0;

/// Three letters with one field each, and the unit at the end of the line. Returns the new value, and the first error
/// with the value that is kept and the field.
pub(super) fn three_fields(
    ui: &mut Ui,
    id: Id,
    caption: &Caption,
    letters: [&str; 3],
    value: Vec3,
    limits: &[Limits; 3],
) -> (Option<Vec3>, Option<(String, f64, Response)>) {
    let mut out = None;
    let mut wrong = None;
    let width = ((ui.available_width() - BETWEEN) / 3.0).clamp(36.0, 96.0).floor();
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

/// A knob for three numbers, each with its own limits.
pub fn vector_knob(ui: &mut Ui, caption: &Caption, value: Vec3, limits: &[Limits; 3]) -> Option<Vec3> {
    const LETTERS: [&str; 3] = ["x", "y", "z"];
    let id = ui.make_persistent_id(caption.salt);
    knob(ui, caption, |ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        let font = TextStyle::Body.resolve(ui.style());
        let palette = Palette::here(ui);
        let colour = if caption.disabled.is_none() { palette.text } else { palette.weak };
        let galley = ui.painter().layout_no_wrap(caption.label.to_owned(), font, colour);
        let column = galley.size().x.max(54.0);
        let word = |ui: &mut Ui| {
            let (rect, label) = ui.allocate_exact_size(vec2(column, 22.0), Sense::hover());
            ui.painter().galley(pos2(rect.left(), rect.center().y - galley.size().y / 2.0), galley, colour);
            explain(label, |ui| {
                tooltip(ui, caption, "", "");
                for (letter, limits) in LETTERS.iter().zip(limits) {
                    ui.label(theme::small(ui, format!("{letter}: {}", limits.rule())));
                }
            });
        };
        // If numbers would be cut off, the label gets a separate line.
        let beside = ui.available_width() - column - 4.0 - BETWEEN >= 3.0 * LEAST;
        let word = if beside {
            Some(word)
        } else {
            word(ui);
            None
        };
        let row = ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            word.into_iter().for_each(|word| word(ui));
            let (new, wrong) = three_fields(ui, id, caption, LETTERS, value, limits);
            if let Some((error, kept, field)) = wrong {
                complaint(ui, &field, &error, &shown(kept));
            }
            new
        });
        ui.add_space(6.0);
        row.inner
    })
}
