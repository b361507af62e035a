//! Line icons, sharp at every size, and icon buttons. An icon button always has a tooltip, which is also its name for
//! screen readers.

use bevy_egui::egui::{
    Color32, Id, Painter, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, Widget, WidgetInfo, WidgetType,
    collapsing_header::paint_default_icon, pos2, vec2,
};

use super::{
    narrow,
    state::Severity,
    theme::{self, Palette},
};
use crate::{declared::texts, shading::Stage};

texts! {
    /// An icon.
    Icon(
        /// The straight lines of an icon in a square with side 1, apart from the one through what is off: the coordinates of
        /// their corners.
        lines
    ) {
        /// Add something.
        Plus = "0.5 0.16 0.5 0.84, 0.16 0.5 0.84 0.5",
        /// Delete.
        Bin = "0.14 0.26 0.86 0.26, 0.38 0.26 0.38 0.12 0.62 0.12 0.62 0.26, \
             0.24 0.26 0.3 0.9 0.7 0.9 0.76 0.26",
        /// Duplicate.
        Duplicate = "0.34 0.34 0.9 0.34 0.9 0.9 0.34 0.9 0.34 0.34, \
             0.66 0.34 0.66 0.1 0.1 0.1 0.1 0.66 0.34 0.66, 0.62 0.48 0.62 0.76, 0.48 0.62 0.76 0.62",
        /// Rename.
        Pencil = "0.14 0.86 0.2 0.64 0.7 0.14 0.86 0.3 0.36 0.8 0.14 0.86",
        /// Close or dismiss.
        Cross = "0.22 0.22 0.78 0.78, 0.78 0.22 0.22 0.78",
        /// Copy text.
        Copy = "0.34 0.34 0.9 0.34 0.9 0.9 0.34 0.9 0.34 0.34, \
             0.66 0.34 0.66 0.1 0.1 0.1 0.1 0.66 0.34 0.66",
        /// Show more.
        Down = "0.2 0.36 0.5 0.66 0.8 0.36",
        /// Show less.
        Up = "0.2 0.64 0.5 0.34 0.8 0.64",
        /// The observer, or a visible part.
        Eye = "",
        /// A hidden part.
        EyeOff = "",
        /// A light that is on.
        Lamp = "0.36 0.78 0.64 0.78, 0.4 0.94 0.6 0.94",
        /// A light that is off.
        LampOff = "0.36 0.78 0.64 0.78, 0.4 0.94 0.6 0.94",
        /// The room.
        Room = "0.12 0.34 0.66 0.34 0.66 0.9 0.12 0.9 0.12 0.34, 0.12 0.34 0.36 0.1 0.9 0.1 0.66 0.34, \
             0.9 0.1 0.9 0.64 0.66 0.9",
        /// Reset to the default.
        Reset = "0.1 0.12 0.18 0.38 0.44 0.32",
        /// Bring into view.
        Target = "0.5 0.02 0.5 0.3, 0.5 0.7 0.5 0.98, 0.02 0.5 0.3 0.5, 0.7 0.5 0.98 0.5",
        /// Done or correct.
        Check = "0.12 0.54 0.4 0.82 0.9 0.2",
    }
}

/// Draws an icon into a square.
pub fn paint(painter: &Painter, rect: Rect, icon: Icon, colour: Color32) {
    let s = rect.width().min(rect.height());
    let stroke = Stroke::new((s / 11.0).max(1.2), colour);
    let at = |x: f32, y: f32| pos2(rect.center().x + (x - 0.5) * s, rect.center().y + (y - 0.5) * s);
    let line = |points: &mut dyn Iterator<Item = (f32, f32)>| {
        painter.add(Shape::line(points.map(|(x, y)| at(x, y)).collect(), stroke));
    };
    let arc = |steps: u8, from: f32, step: f32, (x, y): (f32, f32), radius: f32| {
        let angles = (0..=steps).map(|i| (from + step * f32::from(i)).to_radians());
        line(&mut angles.map(|a| (x + radius * a.cos(), y + radius * a.sin())));
    };
    match icon {
        Icon::Lamp | Icon::LampOff => arc(16, 128.0, 17.75, (0.5, 0.4), 0.32),
        Icon::Reset => arc(14, -150.0, 20.0, (0.5, 0.54), 0.36),
        Icon::Target => {
            painter.circle_stroke(at(0.5, 0.5), 0.26 * s, stroke);
        }
        Icon::Eye | Icon::EyeOff => {
            for height in [0.3, -0.3] {
                let lid = (0..=12).map(|i| i as f32 / 12.0);
                line(&mut lid.map(|t| (0.06 + 0.88 * t, 0.5 - height * (std::f32::consts::PI * t).sin())));
            }
            painter.circle_filled(at(0.5, 0.5), 0.15 * s, colour);
        }
        _ => {}
    }
    let off = matches!(icon, Icon::LampOff | Icon::EyeOff).then_some("0.06 0.94 0.94 0.06");
    for points in icon.lines().split(',').filter(|points| !points.is_empty()).chain(off) {
        let numbers: Vec<f32> = points.split_whitespace().filter_map(|number| number.parse().ok()).collect();
        line(&mut numbers.chunks_exact(2).map(|at| (at[0], at[1])));
    }
}

/// Width and height of a button, in points.
pub(super) const SIZE: f32 = 22.0;

/// An icon button. `says` is the tooltip and the accessible name.
pub fn button(ui: &mut Ui, icon: Icon, says: &str) -> Response {
    let palette = Palette::here(ui);
    let size = vec2(SIZE, narrow::high(ui.ctx(), SIZE));
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, ui.is_enabled(), says));
    if ui.is_rect_visible(rect) {
        let hot = response.hovered() || response.has_focus();
        if hot {
            ui.painter().rect_filled(rect, 4.0, palette.hovered);
        }
        let colour = if hot { palette.text } else { palette.weak };
        paint(ui.painter(), Rect::from_center_size(rect.center(), vec2(13.0, 13.0)), icon, colour);
    }
    response.on_hover_text(says)
}

/// The triangle and the background of a row that folds what is below it. The row takes the whole of `rect`, and its name
/// for screen readers is `says`.
pub(super) fn fold(ui: &mut Ui, rect: Rect, id: Id, says: &str, open: bool) -> Response {
    let response = ui.interact(rect, id, Sense::click());
    theme::says_chosen(&response, WidgetType::CollapsingHeader, open, says);
    let sign = Rect::from_center_size(rect.left_center() + vec2(8.0, 0.0), vec2(8.0, 8.0));
    let openness = if open { 1.0 } else { 0.0 };
    paint_default_icon(ui, openness, &response.clone().with_new_rect(sign));
    response
}

/// The icon of a severity as a widget of this size.
pub(super) fn sign(ui: &mut Ui, size: [f32; 2], radius: f32, severity: Severity) -> Response {
    let (rect, response) = ui.allocate_exact_size(size.into(), Sense::hover());
    self::severity(ui.painter(), rect.center(), radius, severity, &Palette::here(ui));
    response
}

/// A label behind the icon of a severity.
pub(super) fn remark(ui: &mut Ui, size: [f32; 2], severity: Severity, label: impl Widget) {
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        sign(ui, size, 5.5, severity);
        ui.add(label);
    });
}

/// The icon of a severity: its shape says as much as its colour.
pub fn severity(painter: &Painter, centre: Pos2, radius: f32, severity: Severity, palette: &Palette) {
    severity_in(painter, centre, radius, severity, palette.severity(severity));
}

/// The icon of a severity in another colour, for a background in the colour of the severity.
pub fn severity_in(painter: &Painter, centre: Pos2, radius: f32, severity: Severity, colour: Color32) {
    let r = radius;
    let stroke = Stroke::new((r / 4.0).max(1.2), colour);
    let mark = |top: f32, bottom: f32, dot: f32| {
        painter.line_segment([centre + vec2(0.0, top * r), centre + vec2(0.0, bottom * r)], stroke);
        painter.circle_filled(centre + vec2(0.0, dot * r), stroke.width * 0.65, colour);
    };
    match severity {
        Severity::Info => {
            painter.circle_stroke(centre, r, stroke);
            mark(-0.05, 0.55, -0.45);
        }
        Severity::Warning => {
            let corners = [vec2(0.0, -r), vec2(1.05 * r, 0.85 * r), vec2(-1.05 * r, 0.85 * r)];
            let corners = corners.map(|corner| centre + corner);
            painter.add(Shape::closed_line(corners.to_vec(), stroke));
            mark(-0.35, 0.25, 0.55);
        }
        Severity::Error => {
            painter.circle_stroke(centre, r, stroke);
            let d = 0.4 * r;
            painter.line_segment([centre + vec2(-d, -d), centre + vec2(d, d)], stroke);
            painter.line_segment([centre + vec2(d, -d), centre + vec2(-d, d)], stroke);
        }
    }
}

/// A triangle with marks at the points where a shading model evaluates the reflection model.
pub fn stage(painter: &Painter, rect: Rect, stage: Stage, palette: &Palette) {
    let corners = [
        pos2(rect.center().x, rect.top() + 3.0),
        pos2(rect.right() - 3.0, rect.bottom() - 4.0),
        pos2(rect.left() + 3.0, rect.bottom() - 4.0),
    ];
    painter.add(Shape::convex_polygon(corners.to_vec(), palette.raised, Stroke::new(1.2, palette.weak)));
    let dot = |p: Pos2, r: f32| {
        painter.circle_filled(p, r, palette.accent);
    };
    let unit = rect.width() / 48.0;
    match stage {
        Stage::Polygon => {
            let sum = corners[0].to_vec2() + corners[1].to_vec2() + corners[2].to_vec2();
            dot((sum / 3.0).to_pos2(), 3.5 * unit);
        }
        Stage::Vertex => corners.into_iter().for_each(|p| dot(p, 3.0 * unit)),
        Stage::Pixel => {
            let (rows, height) = (6, corners[1].y - corners[0].y);
            let step = height / rows as f32;
            for row in 0..rows {
                let y = corners[0].y + (row as f32 + 0.7) * step;
                let half = (y - corners[0].y) / height * 0.5 * (corners[1].x - corners[2].x) - 1.0;
                let count = (2.0 * half / step).floor().max(0.0) as i32;
                for k in 0..=count {
                    let x = rect.center().x + (k as f32 - 0.5 * count as f32) * step;
                    let dot = Rect::from_center_size(pos2(x, y), vec2(0.55, 0.55) * step);
                    painter.rect_filled(dot, 0.0, palette.accent);
                }
            }
        }
    }
}
