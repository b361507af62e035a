//! The colour picker: a square of saturation and brightness above a bar of hues, for the mouse and the arrow keys.

use bevy_egui::egui::{
    Color32, CornerRadius, Frame, Id, Mesh, Pos2, Rect, Response, Sense, Stroke, StrokeKind, Ui, Vec2,
    WidgetInfo, WidgetType, ecolor::HsvaGamma, pos2, vec2,
};

use crate::panel::{focus, theme::Palette};

const SQUARE: Vec2 = vec2(220.0, 150.0);
const BAR: Vec2 = vec2(220.0, 18.0);
/// Step of an arrow key; ten times as much with Shift.
const STEP: f32 = 0.01;

/// Picks a colour, sRGB-encoded. `name` is the name of the parameter. Returns the new colour if it changed.
pub(in crate::panel) fn picker(ui: &mut Ui, id: Id, name: &str, rgb: [u8; 3]) -> Option<[u8; 3]> {
    let encoded = |colour: HsvaGamma| {
        let [r, g, b, _] = Color32::from(colour).to_array();
        [r, g, b]
    };
    Frame::new()
        .inner_margin(6.0)
        .show(ui, |ui| {
            // Grey has no hue: keep the hue chosen before.
            let known: Option<HsvaGamma> = ui.data(|d| d.get_temp(id)).filter(|known| encoded(*known) == rgb);
            let [r, g, b] = rgb;
            let pass = ui.ctx().cumulative_pass_nr();
            let mut colour = known.unwrap_or_else(|| Color32::from_rgb(r, g, b).into());
            let before = colour;
            ui.spacing_mut().item_spacing.y = 8.0;

            let mut place = vec2(colour.s, 1.0 - colour.v);
            let pure = HsvaGamma { h: colour.h, s: 1.0, v: 1.0, a: 1.0 };
            let square =
                area(ui, SQUARE, 16, 12, &mut place, |at| HsvaGamma { s: at.x, v: 1.0 - at.y, ..pure });
            (colour.s, colour.v) = (place.x, 1.0 - place.y);
            let says = format!("{name}: saturation and brightness");
            square.widget_info(|| WidgetInfo::labeled(WidgetType::Slider, true, &says));
            if ui.data(|d| d.get_temp::<u64>(id)).is_none_or(|last| last + 1 < pass) {
                // The picker was just opened.
                square.request_focus();
            }
            square.on_hover_text(
                "Saturation to the right, brightness up. Arrow keys move it; Shift moves it faster.",
            );

            let mut place = vec2(colour.h, 0.5);
            let bar = area(ui, BAR, 36, 1, &mut place, |at| HsvaGamma { h: at.x, ..pure });
            colour.h = place.x;
            bar.widget_info(|| {
                WidgetInfo::slider(true, f64::from(360.0 * colour.h), format!("{name}: hue, degrees"))
            });
            bar.on_hover_text("Hue");

            ui.data_mut(|d| {
                d.insert_temp(id, pass);
                d.insert_temp(id, colour);
            });
            Some(encoded(colour)).filter(|new| colour != before && *new != rgb)
        })
        .inner
}

/// A rectangle of colours with a handle; both coordinates of `place` range from 0 to 1.
fn area(
    ui: &mut Ui,
    size: Vec2,
    columns: u32,
    rows: u32,
    place: &mut Vec2,
    colour: impl Fn(Vec2) -> HsvaGamma,
) -> Response {
    let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
    if let Some(pointer) = response.interact_pointer_pos() {
        response.request_focus();
        *place = ((pointer - rect.min) / size).clamp(Vec2::ZERO, Vec2::ONE);
    }
    let [right, down] = focus::steps(ui, &response, [true; 2]).map(|steps| steps as f32 * STEP);
    *place = (*place + vec2(right, down)).clamp(Vec2::ZERO, Vec2::ONE);
    if rows == 1 {
        place.y = 0.5;
    }

    let palette = Palette::here(ui);
    let at = |x: u32, y: u32| vec2(x as f32 / columns as f32, y as f32 / rows as f32);
    let mut mesh = Mesh::default();
    for y in 0..=rows {
        for x in 0..=columns {
            mesh.colored_vertex(rect.min + at(x, y) * size, colour(at(x, y)).into());
        }
    }
    for (x, y) in (0..rows).flat_map(|y| (0..columns).map(move |x| (x, y))) {
        let corner = y * (columns + 1) + x;
        mesh.add_triangle(corner, corner + 1, corner + columns + 1);
        mesh.add_triangle(corner + 1, corner + columns + 1, corner + columns + 2);
    }
    ui.painter().add(mesh);
    let edge =
        if response.has_focus() { Stroke::new(2.0, palette.accent) } else { Stroke::new(1.0, palette.line) };
    ui.painter().rect_stroke(rect, CornerRadius::ZERO, edge, StrokeKind::Outside);
    handle(ui, rect, rect.min + *place * size, colour(*place).into());
    response
}

/// A ring that stands out from every colour.
fn handle(ui: &Ui, rect: Rect, at: Pos2, colour: Color32) {
    let at = pos2(at.x.clamp(rect.left(), rect.right()), at.y.clamp(rect.top(), rect.bottom()));
    ui.painter().circle(at, 7.0, colour, Stroke::new(4.0, Color32::BLACK));
    ui.painter().circle_stroke(at, 7.0, Stroke::new(2.0, Color32::WHITE));
}
