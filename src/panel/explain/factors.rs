//! The quantities of an equation, one row each: the value and, when unfolded, the quantity's equation, a plot with the
//! current point, and the source.

use bevy_egui::egui::{lerp, remap};

use super::{probe, rows};
use crate::{
    explain::{Along, FactorCurve, Geometry, Line, Model, of_value},
    panel::{maths, prelude::*},
};

/// Size of the plot of a factor, in points.
const PLOT: [f32; 2] = [232.0, 72.0];
/// Font size of a quantity's symbol.
const LETTER: f32 = 14.5;
/// Red, green and blue for curves with colour channels, light enough for a dark background.
const CHANNELS: [Color32; 3] = [
    Color32::from_rgb(0xe8, 0x6a, 0x5c),
    Color32::from_rgb(0x3f, 0xb8, 0x6b),
    Color32::from_rgb(0x5a, 0x9d, 0xf0),
];

/// The row of a quantity and its unfolded details. Returns the symbol of a clicked number.
pub(super) fn factor(
    ui: &mut Ui,
    model: &Model,
    geometry: Option<&Geometry>,
    line: &Line,
    name: &dyn Fn(&str) -> Option<String>,
) -> Option<String> {
    let open = probe::unfolds(ui.ctx(), line.defines());
    let row = head(ui, line, open);
    if probe::is_sought(ui.ctx(), line.defines()) {
        row.scroll_to_me(None);
    }
    if row.clicked() && probe::once(ui.ctx()) {
        probe::turn(ui.ctx(), line.defines());
    }
    if !open {
        return None;
    }
    let mut clicked = None;
    rows::inset(ui, |ui| {
        if line.text.contains('=') {
            rows::equation(ui, line.term, &line.text, false, name);
            if let Some(numbers) = line.right() {
                clicked = rows::calculation(ui, numbers, &line.symbols, name);
            }
        } else {
            theme::note(ui, "Calculated by the program: it has no equation that one could follow by hand.");
        }
        if let Some(curve) = geometry.and_then(|geometry| curve(ui, model, geometry, line.defines())) {
            plot(ui, &curve, line);
        }
        let source = match line.quantity.map_or("", |quantity| quantity.source) {
            "" => model.declaration.author,
            source => source,
        };
        if !source.is_empty() {
            theme::note(ui, format!("Source: {source}"));
        }
        ui.add_space(4.0);
    });
    clicked
}

/// The symbol, value and name of a quantity, with a triangle that shows if it is unfolded.
fn head(ui: &mut Ui, line: &Line, open: bool) -> Response {
    let palette = Palette::here(ui);
    let scale = theme::scale_here(ui);
    let value = line.value.as_ref().map_or_else(String::new, |value| of_value(value, rows::DIGITS));
    let label = line.quantity.map_or("", |quantity| quantity.label);
    let text = format!("{} = {value}", line.defines());
    let size = vec2(ui.available_width(), 22.0 * scale);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let id = ui.id().with(("factor", line.defines(), line.symbol()));
    let response = rows::fold_row(ui, rect, id, &format!("{text}, {label}"), open);
    let at = pos2(rect.left() + 20.0, rect.center().y + 0.32 * LETTER * scale);
    let width = maths::paint_line(ui, at, &text, LETTER * scale, palette.text);
    let end = at.x + width + 8.0;
    let shown = theme::elided(ui, label, TextStyle::Small, palette.weak, (rect.right() - end).max(0.0));
    ui.painter().galley(pos2(end, rect.center().y - 0.5 * shown.size().y), shown, palette.weak);
    let whole = line.quantity.map_or_else(String::new, |quantity| format!(": {}", quantity.label));
    maths::tip(response, &format!("{}{whole}", line.defines()))
}

/// The curve of a quantity, calculated once per explanation.
fn curve(ui: &Ui, model: &Model, geometry: &Geometry, name: &str) -> Option<Arc<FactorCurve>> {
    let id = Id::new(("curve of a factor", name));
    let key = (probe::calculations(ui.ctx()), geometry.l.to_array().map(f32::to_bits));
    kept::of_key(ui.ctx(), id, key, || model.curve_of(name, geometry).map(Arc::new))
}

/// A small plot with the current point.
fn plot(ui: &mut Ui, curve: &FactorCurve, line: &Line) {
    let palette = Palette::here(ui);
    let scale = theme::scale_here(ui);
    let width = (PLOT[0] * scale).min(ui.available_width());
    let (rect, response) = ui.allocate_exact_size(vec2(width, (PLOT[1] + 18.0) * scale), Sense::hover());
    let who = if curve.along == Along::Light { "light" } else { "viewer" };
    let spoken = format!("{} over the angle of the {who} to the normal", line.defines());
    theme::says(&response, WidgetType::Image, &spoken);
    let room = rect.with_max_y(rect.bottom() - 18.0 * scale).shrink2(vec2(2.0, 3.0));
    let painter = ui.painter();
    painter.rect(room, 3.0, palette.field, Stroke::new(1.0, palette.line), StrokeKind::Outside);
    let values = || curve.points.iter().filter_map(|(_, value)| *value).flatten().filter(|v| v.is_finite());
    let (low, high) = values().fold((0.0f32, 0.0f32), |(low, high), v| (low.min(v), high.max(v)));
    if high <= low {
        return;
    }
    let place = |angle: f32, value: f32| {
        let y = lerp(room.bottom() - 2.0..=room.top() + 2.0, (value - low) / (high - low));
        pos2(remap(angle, -90.0..=90.0, room.x_range()), y)
    };
    painter.vline(place(0.0, 0.0).x, room.y_range(), Stroke::new(1.0, palette.line));
    let grey = curve.points.iter().all(|(_, v)| v.is_none_or(|[r, g, b]| r == g && g == b));
    let channels: &[usize] = if grey { &[0] } else { &[0, 1, 2] };
    for channel in channels {
        let colour = if grey { palette.accent } else { CHANNELS[*channel] };
        let runs = curve.points.split(|(_, value)| value.is_none_or(|v| !v[*channel].is_finite()));
        for run in runs {
            let points = run.iter().filter_map(|(angle, v)| Some(place(*angle, (*v)?[*channel]))).collect();
            painter.add(Shape::line(points, Stroke::new(1.5, colour)));
        }
        let (angle, here) = (curve.here.0, curve.here.1[*channel]);
        painter.circle(place(angle, here), 3.5, colour, Stroke::new(1.0, palette.text));
    }
    let font = FontId::new(TextStyle::Small.resolve(ui.style()).size, egui::FontFamily::Proportional);
    let under = |x: f32, align: Align2, text: &str| {
        painter.text(pos2(x, room.bottom() + 3.0), align, text, font.clone(), palette.weak);
    };
    under(room.left(), Align2::LEFT_TOP, "−90°");
    under(room.center().x, Align2::CENTER_TOP, &format!("angle of the {who}"));
    under(room.right(), Align2::RIGHT_TOP, "90°");
    let most = crate::explain::rounded(high, 2);
    painter.text(room.left_top() + vec2(4.0, 2.0), Align2::LEFT_TOP, most, font.clone(), palette.weak);
    let tip = format!(
        "{spoken}, in its plane, everything else as it is. The point is the present angle, {}°.",
        crate::explain::rounded(curve.here.0, rows::DIGITS)
    );
    maths::tip(response, &tip);
}
