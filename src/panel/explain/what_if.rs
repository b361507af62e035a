//! The numbers of the scene that influence the pixel most, by finite differences, each with its control; and the pixel
//! before and after a change.

use super::{
    probe::{self, Explained},
    rows,
};
use crate::{
    explain::{Influence, Knob, rounded},
    panel::{keys, knob, maths, prelude::*},
    scene::{Light, limits::Limits},
};

/// Maximum number of listed numbers.
const MOST: usize = 8;
/// Length of the longest bar, in points.
const BAR: f32 = 48.0;
/// Widths of the columns of symbols and of effects, in points.
const SYMBOL: f32 = 26.0;
const EFFECT: f32 = 68.0;

/// Shows the list, initially folded.
pub(super) fn what_if(ui: &mut Ui, explained: &Explained, context: &mut PanelContext<'_>) {
    change(ui, explained, context);
    let header = egui::CollapsingHeader::new(theme::strong(ui, "What would change this pixel?"))
        .id_salt("what would change this pixel")
        .show_unindented(ui, |ui| list(ui, explained, context));
    header.header_response.on_hover_text(
        "The numbers of the material and the intensities of the lights, the one that moves the pixel most first: by how much \
         the luminance of its light changes when the number changes by a hundredth of its range. Calculated by differences: \
         the pixel is drawn with a little less and a little more.",
    );
}

/// The numbers with their controls.
fn list(ui: &mut Ui, explained: &Explained, context: &mut PanelContext<'_>) {
    if explained.view != context.session().active() {
        let text =
            "Click the view of this pixel to make it the active one; then its numbers can be changed here.";
        theme::note(ui, text);
        return;
    }
    let all = probe::influences(ui.ctx(), context.registry());
    let order = probe::ranking(ui.ctx(), &all, MOST);
    let shown: Vec<_> = order.iter().filter_map(|knob| all.iter().find(|i| i.knob == *knob)).collect();
    if shown.is_empty() {
        theme::note(ui, "No number of the material or of a light changes this pixel.");
        return;
    }
    let most = shown.iter().map(|influence| influence.effect().abs()).fold(0.0, f32::max);
    for influence in shown {
        row(ui, influence, most, context);
    }
    theme::note(ui, "Change of luminance for 1 % of the range, by differences. Colours are not in the list.");
}

/// The pixel before and after changes made in this list.
fn change(ui: &mut Ui, explained: &Explained, context: &mut PanelContext<'_>) {
    let Some(before) = probe::before(ui.ctx()) else { return };
    let after = explained.explanation.code();
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        let code = |ui: &mut Ui, codes: [u8; 3]| {
            rows::chip(ui, codes, vec2(28.0, 16.0));
            ui.label(theme::strong(ui, rows::codes(codes)));
        };
        ui.label("before");
        code(ui, before);
        ui.label("→ after");
        code(ui, after);
        let tip = keys::hint(ui.ctx(), "Take back the last change", "undo");
        context.on_click(&ui.small_button("Undo").on_hover_text(tip), || Action::Undo);
        if ui.small_button("Done").on_hover_text("Keep the change, and compare from here").clicked() {
            probe::forget_before(ui.ctx());
        }
    });
}

fn row(ui: &mut Ui, influence: &Influence, most: f32, context: &mut PanelContext<'_>) {
    let session = context.session();
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        let scale = theme::scale_here(ui);
        let (cell, symbol) = ui.allocate_exact_size(vec2(SYMBOL, 20.0) * scale, Sense::hover());
        let at = pos2(cell.left(), cell.center().y + 5.0 * scale);
        maths::paint_symbol(ui, at, influence.symbol, 14.0 * scale, theme::Palette::here(ui).text);
        symbol.on_hover_text(influence.label.as_str());
        let limits = limits_of(influence);
        let id = Id::new(("what if", influence.label.as_str()));
        let field = knob::field(ui, id, &influence.label, influence.value, &limits, 64.0);
        if let Some(value) = field.value {
            probe::keep_before(ui.ctx());
            context.edit(edit(influence, value as f32, session));
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let effect = influence.effect();
            let sign = if effect > 0.0 { "+" } else { "" };
            let (size, layout) = (vec2(EFFECT, 20.0) * scale, Layout::right_to_left(Align::Center));
            let number = ui.allocate_ui_with_layout(size, layout, |ui| {
                ui.set_min_width(EFFECT * scale);
                ui.label(format!("{sign}{}", rows::of_digits(effect, influence.digits)))
            });
            let [r, g, b] = influence.derivative().to_array().map(|v| rows::of_digits(v, influence.digits));
            let ([from, to], symbol) = (influence.tried.map(|v| rounded(v, 4)), influence.symbol);
            let text = format!("Δ light/Δ {symbol} = ({r}, {g}, {b}) between {from} and {to}");
            number.inner.on_hover_text(text);
            let (bar, _) = ui.allocate_exact_size(vec2(BAR, 8.0), Sense::hover());
            let part = if most > 0.0 { effect.abs() / most } else { 0.0 };
            let palette = theme::Palette::here(ui);
            ui.painter().rect_filled(bar, 2.0, palette.field);
            ui.painter().rect_filled(bar.with_min_x(bar.right() - part * bar.width()), 2.0, palette.accent);
            let room = ui.available_width();
            let unit = if influence.unit.is_empty() { "" } else { ", " };
            let label = format!("{}{unit}{}", influence.label, influence.unit);
            let label = theme::elided(ui, &label, TextStyle::Small, palette.weak, room);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| ui.label(label));
        });
    });
}

fn limits_of(influence: &Influence) -> Limits {
    match influence.knob {
        Knob::Material { parameter, .. } => {
            parameter.kind.limits().unwrap_or_else(|| Limits::between(0.0, 1.0))
        }
        Knob::Intensity { .. } => Light::intensity.limits(),
    }
}

fn edit(influence: &Influence, value: f32, session: &Session) -> Edit {
    match influence.knob {
        Knob::Material { object, parameter } => {
            let value = parameter.kind.of_numbers([value.into(); 3]);
            Edit::material(Part::Object(object), parameter.name, value)
        }
        Knob::Intensity { light } => {
            let flux = session.scene().lights.get(light).is_some_and(|light| light.luminous_flux.is_some());
            let field = if flux { Light::luminous_flux } else { Light::intensity };
            Edit::set(Part::Light(light), field, value)
        }
    }
}
