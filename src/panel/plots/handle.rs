//! The direction of the light, as a handle in the plot.

use super::{pen::Screen, reading::degrees};
use crate::{
    curves::draw::Ground,
    panel::{focus, prelude::*, state::MOST_LIGHT},
};

/// The name for screen readers.
const NAME: &str = "Light in the plot: θ_i in degrees";
const HELP: &str = "The direction of the light. Drag it; with the focus ← and → move it, with Shift by 10°.";

/// Shows it, where the quantity depends on the light; the horizontal axis goes from an angle to another.
pub(super) fn show(
    ui: &mut Ui,
    screen: &Screen,
    (ground, axis): (&Ground, [f64; 2]),
    unit: impl Fn(Pos2) -> [f64; 2],
    context: &mut PanelContext<'_>,
) {
    let theta_i = context.session().plots.theta_i;
    let (at, angle_of): (Pos2, Box<dyn Fn([f64; 2]) -> f64>) = match *ground {
        Ground::Plot(place) => {
            let [left, _, right, _] = place;
            let [from, to] = axis;
            let at = lines(ui, screen, (place, axis), theta_i);
            (at, Box::new(move |[x, _]| -(from + (to - from) * (x - left) / (right - left))))
        }
        Ground::Polar { centre: [x, y], radius, .. } => {
            let (sin, cos) = theta_i.to_radians().sin_cos();
            // The circle has the label.
            let out = 0.88 * radius;
            let at = screen.place([x - out * sin, y - out * cos]);
            (at, Box::new(move |[to_x, to_y]| (x - to_x).atan2(y - to_y).to_degrees()))
        }
        Ground::Slices(_) => return,
    };
    let place = Rect::from_center_size(at, vec2(20.0, 20.0));
    let response = ui.interact(place, ui.id().with("light"), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::slider(true, theta_i, NAME));
    paint(ui, &response, at);
    let mut wanted = None;
    if response.dragged()
        && let Some(pointer) = response.interact_pointer_pos()
    {
        let fine = ui.input(|input| input.modifiers.shift);
        let step = if fine { 10.0 } else { 1.0 };
        wanted = Some((angle_of(unit(pointer)) * step).round() / step);
    }
    if response.clicked() || response.drag_started() {
        response.request_focus();
    }
    let [right, down] = focus::steps(ui, &response, [true; 2]);
    // The light is at the left of the normal.
    if down != right {
        wanted = Some(theta_i + down - right);
    }
    if response.has_focus() {
        for (key, angle) in [(Key::Home, 0.0), (Key::End, MOST_LIGHT)] {
            wanted = if ui.input(|input| input.key_pressed(key)) { Some(angle) } else { wanted };
        }
    }
    let wanted = wanted.map(|angle| angle.clamp(0.0, MOST_LIGHT)).filter(|angle| *angle != theta_i);
    context.actions.extend(wanted.map(|angle| Action::Plot(PlotCommand::Light(angle))));
    response.on_hover_and_drag_cursor(CursorIcon::Grab).on_hover_text(HELP);
}

/// The directions of the light and of its mirror image in a plot over the angle. Returns the upper end of the light's.
fn lines(
    ui: &Ui,
    screen: &Screen,
    ([left, top, right, bottom], [from, to]): ([f64; 4], [f64; 2]),
    theta_i: f64,
) -> Pos2 {
    let palette = Palette::here(ui);
    let x = |angle: f64| left + (angle - from) / (to - from) * (right - left);
    let line = |angle: f64| [screen.place([x(angle), top]), screen.place([x(angle), bottom])];
    ui.painter().extend(Shape::dashed_line(&line(theta_i), Stroke::new(1.0, palette.weak), 2.0, 3.0));
    ui.painter().line_segment(line(-theta_i), Stroke::new(1.0, palette.accent));
    let font = TextStyle::Small.resolve(ui.style());
    let text = |angle: f64, text: String, align: Align2, right: f32| {
        let at = screen.place([x(angle), top]) + vec2(right, -2.0);
        ui.painter().text(at, align, text, font.clone(), palette.weak);
    };
    text(-theta_i, format!("light {}", degrees(theta_i)), Align2::LEFT_BOTTOM, 14.0);
    // Where it would stand over the light's.
    if theta_i > 25.0 {
        text(theta_i, "mirror".to_owned(), Align2::CENTER_BOTTOM, 0.0);
    }
    screen.place([x(-theta_i), top])
}

/// The sign of a light.
fn paint(ui: &Ui, response: &Response, at: Pos2) {
    let palette = Palette::here(ui);
    let hot = response.hovered() || response.dragged() || response.has_focus();
    let radius = if hot { 7.5 } else { 6.0 };
    ui.painter().circle(at, radius, palette.accent, Stroke::new(1.5, palette.panel));
    for i in 0..8_u8 {
        let (sin, cos) = (f32::from(i) * std::f32::consts::FRAC_PI_4).sin_cos();
        let ray = [radius + 1.5, radius + 4.0].map(|out| at + out * vec2(cos, sin));
        ui.painter().line_segment(ray, Stroke::new(1.5, palette.accent));
    }
}
