//! The presentation (F5): the picture fills the screen, and the equation and the caption are laid over it, large
//! enough for the last row.

use std::{thread, time::Duration};

use bevy_egui::egui::{
    Align2, Context, CornerRadius, FontId, Id, Rect, TextStyle, Ui, UiBuilder, Vec2, vec2,
};

use super::{
    caption::caption_text,
    keys, maths,
    state::{Action, Lab, ViewChange},
    theme::{self, Palette},
};
use crate::{reflection::EquationPart, registry::Registry};

/// The size of the caption, as a fraction of the height of the screen. The capitals of its font are 0.727 of it high.
const CAPTION: f32 = 0.036;
/// The body size under which the smallest symbols of an equation have capitals of the same height: they are set 1.1
/// times as large, in a font whose capitals are 0.66 of its size.
const BODY: f32 = 0.035;
/// The most of the height that the equation covers.
const MOST: f32 = 0.4;
/// How long it says how to leave, seconds.
const REMINDER: f64 = 5.0;

/// Escape leaves, unless it is another's.
pub fn left(ctx: &Context, lab: &Lab) -> Option<Action> {
    let left = lab.view.presenting && keys::escapes(ctx, lab);
    left.then_some(Action::View(ViewChange::Presenting(false)))
}

/// Lays equation and caption over the picture, each on a ground of its own, so that they can be read on any. Returns
/// what is left below the equation.
pub fn overlay(ui: &mut Ui, rect: Rect, lab: &Lab, registry: &Registry) -> Rect {
    let palette = Palette::here(ui);
    let height = rect.height();
    let padding = vec2(0.022, 0.014) * height;
    let most = rect.width() - 2.0 * padding.x;
    let font = FontId::proportional(CAPTION * height);
    let caption = ui.painter().layout(caption_text(lab, registry), font, palette.text, most);
    let plate = Align2::LEFT_BOTTOM.anchor_size(rect.left_bottom(), caption.size() + 2.0 * padding);
    ui.painter().rect_filled(plate, CornerRadius { ne: 8, ..CornerRadius::ZERO }, palette.panel);
    ui.painter().galley(plate.min + padding, caption, palette.text);
    reminder(ui, rect);

    let parts = registry.model(lab.model_shown()).map_or(&[][..], |m| m.declaration.equation);
    let mut ui = ui.new_child(UiBuilder::new().id_salt("presentation").max_rect(rect));
    ui.style_mut().text_styles.insert(TextStyle::Body, FontId::proportional(BODY * height));
    let (count, size) = fitting(&mut ui, parts, vec2(most, MOST * height));
    if count == 0 {
        return rect;
    }
    let plate = Rect::from_min_size(rect.min, size + 2.0 * padding);
    ui.painter().rect_filled(plate, CornerRadius { se: 8, ..CornerRadius::ZERO }, palette.panel);
    let place = Rect::from_min_size(plate.min + padding, size);
    maths::equation(&mut ui.new_child(UiBuilder::new().max_rect(place)), &parts[..count], |_| None);
    rect.with_min_y(plate.bottom())
}

/// How many lines of an equation find room, and how much they need. The first say what the others only spell out.
fn fitting(ui: &mut Ui, parts: &'static [EquationPart], room: Vec2) -> (usize, Vec2) {
    let id = Id::new("fitting equation");
    let key = (parts.as_ptr() as usize, parts.len(), [room.x.to_bits(), room.y.to_bits()]);
    let known = ui.data(|d| d.get_temp::<((usize, usize, [u32; 2]), (usize, Vec2))>(id));
    if let Some((_, fit)) = known.filter(|(of, _)| *of == key) {
        return fit;
    }
    let heights = (1..=parts.len()).rev().map(|n| (n, measured(ui, &parts[..n], room.x)));
    let (count, height) = heights.into_iter().find(|(n, h)| *n == 1 || *h <= room.y).unwrap_or_default();
    // The narrowest width in which they are no higher.
    let (mut narrow, mut wide) = (0.0, room.x);
    while count > 0 && wide - narrow > 4.0 {
        let middle = 0.5 * (narrow + wide);
        let fits = measured(ui, &parts[..count], middle) <= height;
        *(if fits { &mut wide } else { &mut narrow }) = middle;
    }
    let fit = (count, vec2(wide, height));
    ui.data_mut(|d| d.insert_temp(id, (key, fit)));
    fit
}

/// How high an equation is.
fn measured(ui: &mut Ui, parts: &[EquationPart], width: f32) -> f32 {
    let room = Rect::from_min_size(ui.max_rect().min, vec2(width, f32::INFINITY));
    let mut trial = ui.new_child(UiBuilder::new().id_salt("trial").max_rect(room).invisible());
    maths::equation(&mut trial, parts, |_| None).rect.height()
}

/// For a moment it says how to get out.
fn reminder(ui: &Ui, rect: Rect) {
    let id = Id::new("presentation since");
    let (now, pass) = (ui.input(|i| i.time), ui.ctx().cumulative_pass_nr());
    let since =
        ui.data(|d| d.get_temp::<(f64, u64)>(id)).filter(|(_, last)| last + 2 > pass).map_or(now, |s| s.0);
    ui.data_mut(|d| d.insert_temp(id, (since, pass)));
    if now - since > REMINDER {
        return;
    }
    if now == since {
        // Nothing else wakes a window at rest.
        let ctx = ui.ctx().clone();
        thread::spawn(move || {
            thread::sleep(Duration::from_secs_f64(REMINDER + 0.1));
            ctx.request_repaint();
        });
    }
    let palette = Palette::here(ui);
    let font = FontId::proportional(CAPTION * rect.height());
    let galley = ui.painter().layout_no_wrap("Esc leaves the presentation".to_owned(), font, palette.text);
    // The caption has the bottom, the equation begins at the left.
    let place =
        Align2::RIGHT_TOP.anchor_size(rect.right_top() + vec2(-12.0, 12.0), galley.size() + vec2(24.0, 12.0));
    ui.painter().rect_filled(place, theme::UNIT, palette.panel);
    ui.painter().galley(place.min + vec2(12.0, 6.0), galley, palette.text);
}
