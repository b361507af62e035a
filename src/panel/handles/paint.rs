//! Painting of the handles.

use bevy_egui::egui::{Align2, Color32, FontId, Pos2, Ui, vec2};
use glam::Vec3;

use super::{
    Handle,
    shape::{DISC, LETTERS, Placed},
};
use crate::{
    panel::{
        marks::{Ink, Lens, OUTLINE},
        theme,
    },
    scene::SceneSize,
};

/// Okabe–Ito vermilion, bluish green and blue, lightened: x, y, z.
const AXES: [Color32; 3] = [
    Color32::from_rgb(0xff, 0x7a, 0x33),
    Color32::from_rgb(0x2e, 0xd0, 0x9c),
    Color32::from_rgb(0x5a, 0xa9, 0xf5),
];
/// Colour of handles that belong to no axis.
const WHITE: Color32 = Color32::from_rgb(0xf6, 0xf6, 0xf6);
/// Width of a line, in points.
const LINE: f32 = 2.25;
/// Width of the line under the pointer, in points.
const HOT: f32 = 3.75;

/// State of a handle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    /// Idle.
    Free,
    /// Under the pointer, or dragged.
    Hot,
    /// Dimmed while another handle is dragged.
    Dim,
}

fn colour_of(handle: Handle, state: State) -> Color32 {
    let colour = if handle.sort.has_axis { AXES[handle.which] } else { WHITE };
    match state {
        State::Free => colour,
        State::Hot => colour.lerp_to_gamma(Color32::WHITE, 0.45),
        State::Dim => colour.gamma_multiply(0.3),
    }
}

/// Paints the handles with the given opacity, each in its state; the one under the pointer is on top.
pub(super) fn handles(ui: &Ui, lens: Lens, all: &[Placed], opacity: f32, state: impl Fn(Handle) -> State) {
    let painter = ui.painter_at(lens.rect);
    for hot in [false, true] {
        let mut ink = Ink::new(lens);
        let mut letters: Vec<(Pos2, &'static str, Color32)> = Vec::new();
        for placed in all.iter().filter(|p| (state(p.handle) == State::Hot) == hot) {
            let colour = colour_of(placed.handle, state(placed.handle)).gamma_multiply(opacity);
            let width = if hot { HOT } else { LINE };
            for line in &placed.far {
                ink.stroke(line.clone(), 1.25, colour.gamma_multiply(0.35));
            }
            for line in &placed.lines {
                ink.stroke(line.clone(), width, colour);
            }
            let mut brush = Brush { ink: &mut ink, letters: &mut letters, colour, width, hot };
            (placed.handle.sort.end)(&mut brush, placed);
        }
        ink.paint(&painter);
        for (at, letter, colour) in letters {
            painter.circle_filled(at, 8.0, OUTLINE.gamma_multiply(0.75 * f32::from(colour.a()) / 255.0));
            let font = FontId::new(13.0, theme::semibold());
            painter.text(at - vec2(0.0, 1.0), Align2::CENTER_CENTER, letter, font, colour);
        }
    }
}

/// The tools and colours that paint the end of a handle.
pub(super) struct Brush<'a> {
    ink: &'a mut Ink,
    /// Letters are painted over everything.
    letters: &'a mut Vec<(Pos2, &'static str, Color32)>,
    colour: Color32,
    width: f32,
    /// The handle is under the pointer.
    hot: bool,
}

/// The tip of an arrow, with the letter of its axis.
pub(super) fn arrow(brush: &mut Brush, placed: &Placed) {
    if let Some([.., from, tip]) = placed.lines.first().map(Vec::as_slice) {
        let ahead = (*tip - *from).normalized() * (2.0 + 1.5 * brush.width);
        let side = ahead.rot90() * 0.62;
        let back = *tip - 1.2 * ahead;
        brush.ink.fill(vec![*tip + ahead, back + side, back - side], brush.colour);
    }
    let at = placed.end + (placed.end - middle(placed)).normalized() * 4.0;
    brush.letters.push((at, LETTERS[placed.handle.which], brush.colour));
}

/// The letter of its axis.
pub(super) fn letter(brush: &mut Brush, placed: &Placed) {
    brush.letters.push((placed.end, LETTERS[placed.handle.which], brush.colour));
}

/// A disc.
pub(super) fn disc(brush: &mut Brush, placed: &Placed) {
    brush.ink.disc(placed.end, if brush.hot { DISC + 1.0 } else { DISC - 0.5 }, brush.colour);
}

/// A disc with a dark middle.
pub(super) fn eye(brush: &mut Brush, placed: &Placed) {
    brush.ink.disc(placed.end, DISC, brush.colour);
    let opacity = f32::from(brush.colour.a()) / 255.0;
    brush.ink.disc(placed.end, DISC - 4.5, OUTLINE.gamma_multiply(opacity));
}

/// A square.
pub(super) fn square(brush: &mut Brush, placed: &Placed) {
    let r = if brush.hot { 7.0 } else { 5.5 };
    let corners = [(-r, -r), (r, -r), (r, r), (-r, r)];
    brush.ink.fill(corners.map(|(x, y)| placed.end + vec2(x, y)).to_vec(), brush.colour);
}

/// The start of the first line.
fn middle(placed: &Placed) -> Pos2 {
    placed.lines.first().and_then(|line| line.first()).copied().unwrap_or(placed.end)
}

/// The axis along which something is moved, through the whole scene.
pub(super) fn guide(ui: &Ui, lens: Lens, at: Vec3, axis: usize, room: SceneSize) {
    let ends = [0.0, room.corner()[axis]].map(|v| {
        let mut end = at;
        end[axis] = v;
        end
    });
    thin(ui, lens, lens.path(&ends), AXES[axis].gamma_multiply(0.6));
}

/// The arms of an angle.
pub(super) fn angle(ui: &Ui, lens: Lens, at: Vec3, ends: [Pos2; 2]) {
    let Some(middle) = lens.project(at) else { return };
    thin(ui, lens, ends.map(|end| vec![middle, end]), WHITE.gamma_multiply(0.7));
}

fn thin(ui: &Ui, lens: Lens, lines: impl IntoIterator<Item = Vec<Pos2>>, colour: Color32) {
    let mut ink = Ink::new(lens);
    lines.into_iter().for_each(|line| ink.stroke(line, 1.0, colour));
    ink.paint(&ui.painter_at(lens.rect));
}
