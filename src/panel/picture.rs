//! What is painted over the picture: badges, caption, axes, hints.

use bevy_egui::egui::{
    self, Align2, Color32, FontFamily, FontId, Painter, Pos2, Rect, Sense, Stroke, TextStyle, Ui, pos2, vec2,
};
use glam::Vec3;

use super::{
    icon, maths,
    state::{Lab, Selection, Shaders},
    theme::{self, Palette},
};
use crate::{
    optics::{TermSelection, colour::Encoding, tone::ToneMapping},
    reflection::Term,
    registry::Registry,
};

/// Paints the overlays into the rectangle of the picture.
pub fn overlays(ui: &mut Ui, rect: Rect, lab: &Lab, registry: &Registry) {
    if rect.width() < 80.0 || rect.height() < 80.0 {
        return;
    }
    let scale = theme::scale(&lab.view);
    badges(ui, rect, lab, scale);
    caption(ui, rect, lab, registry, scale);
    axes(ui, rect, lab, scale);
    hint(ui, rect, lab);
}

/// Words on a ground that can be read over any picture, in lines that leave the axes free. Returns the
/// rectangle.
fn plate(
    painter: &Painter,
    palette: &Palette,
    anchor: Align2,
    at: Pos2,
    text: String,
    font: FontId,
    colour: Color32,
    left: f32,
) -> Rect {
    let padding = vec2(8.0, 4.0);
    let room = painter.clip_rect().width() - 116.0 - 2.0 * padding.x - left;
    let galley = painter.layout(text, font, colour, room.max(64.0));
    let size = galley.size() + 2.0 * padding + vec2(left, 0.0);
    let rect = anchor.anchor_size(at, size);
    painter.rect_filled(rect, 4.0, palette.panel.gamma_multiply(0.88));
    painter.galley(rect.min + padding + vec2(left, 0.0), galley, colour);
    rect
}

fn badges(ui: &mut Ui, rect: Rect, lab: &Lab, scale: f32) {
    let palette = Palette::here(ui);
    let mut y = rect.top() + 8.0;
    for (i, badge) in lab.disk.badge.iter().chain(&lab.badges).enumerate() {
        let font = FontId::new(TextStyle::Body.resolve(ui.style()).size, theme::semibold());
        let painter = ui.painter_at(rect);
        let left = 18.0 * scale;
        let place = plate(
            &painter,
            &palette,
            Align2::LEFT_TOP,
            pos2(rect.left() + 8.0, y),
            badge.text.clone(),
            font,
            palette.text,
            left,
        );
        painter.rect_stroke(
            place,
            4.0,
            Stroke::new(1.0, palette.severity(badge.severity)),
            egui::StrokeKind::Inside,
        );
        icon::severity(
            &painter,
            pos2(place.left() + 14.0 * scale, place.center().y),
            6.0 * scale,
            badge.severity,
            &palette,
        );
        let response = ui.interact(place, ui.id().with(("badge", i)), Sense::hover());
        if !badge.help.is_empty() {
            response.on_hover_text(&badge.help);
        }
        y = place.bottom() + 4.0;
    }
}

/// What the picture shows, in words, so that a screenshot says it too.
#[must_use]
pub fn caption_text(lab: &Lab, registry: &Registry) -> String {
    let object = match lab.selection {
        Selection::Object(i) => lab.scene.objects.get(i),
        _ => None,
    };
    let (model, mode) = match object {
        Some(o) => (lab.scene.model_of(o), lab.scene.mode_of(o)),
        None => (lab.scene.reflection_model.as_str(), lab.scene.shading_model.as_str()),
    };
    let model = registry.model(model).map_or(model, |m| m.declaration.name);
    let (mode, stage) = match registry.mode(mode) {
        Some(m) => (m.declaration.name, format!(" · computed {}", m.declaration.stage.phrase())),
        None => (mode, String::new()),
    };
    let terms = match lab.view.terms {
        TermSelection::All => String::new(),
        other => format!(" · {} term alone", other.id()),
    };
    let exposure = match lab.scene.display.exposure {
        0.0 => String::new(),
        ev => format!(" · {}{} EV", if ev > 0.0 { "+" } else { "" }, super::limits::number(f64::from(ev))),
    };
    let tone = match lab.scene.display.tone_mapping {
        ToneMapping::None => String::new(),
        tone => format!(" · {}", tone.name()),
    };
    let encoding = match lab.scene.display.encoding {
        Encoding::Srgb => "",
        Encoding::Off => " · gamma-naive",
    };
    format!("{model} · {mode} shading{stage}{terms}{exposure}{tone}{encoding}")
}

fn caption(ui: &Ui, rect: Rect, lab: &Lab, registry: &Registry, scale: f32) {
    let palette = Palette::here(ui);
    let painter = ui.painter_at(rect);
    let term = match lab.view.terms {
        TermSelection::All => None,
        TermSelection::Ambient => Some(Term::Ambient),
        TermSelection::Diffuse => Some(Term::Diffuse),
        TermSelection::Specular => Some(Term::Specular),
    };
    let font = TextStyle::Small.resolve(ui.style());
    let at = rect.left_bottom() + vec2(8.0, -8.0);
    let left = if term.is_some() { 28.0 * scale } else { 0.0 };
    let place = plate(
        &painter,
        &palette,
        Align2::LEFT_BOTTOM,
        at,
        caption_text(lab, registry),
        font,
        palette.text,
        left,
    );
    if let Some(term) = term {
        let y = place.center().y;
        maths::term_sample(
            &painter,
            pos2(place.left() + 8.0, y),
            pos2(place.left() + 4.0 + left, y),
            term,
            &palette,
        );
    }
}

/// The directions of the room as the camera sees them; the letters tell them apart.
fn axes(ui: &Ui, rect: Rect, lab: &Lab, scale: f32) {
    let palette = Palette::here(ui);
    let painter = ui.painter_at(rect);
    let radius = 34.0 * scale;
    let centre = rect.right_bottom() - vec2(radius + 8.0, radius + 8.0);
    painter.circle_filled(centre, radius, palette.panel.gamma_multiply(0.72));
    let inverse = lab.camera.inverse();
    let mut ends: Vec<(Vec3, &str)> =
        [(Vec3::X, "x"), (Vec3::Y, "y"), (Vec3::Z, "z")].into_iter().map(|(a, n)| (inverse * a, n)).collect();
    // What points away from the eye is painted first.
    ends.sort_by(|a, b| a.0.z.total_cmp(&b.0.z));
    for (direction, name) in ends {
        let length = radius * 0.66;
        let end = centre + vec2(direction.x, -direction.y) * length;
        let colour = if direction.z < -0.2 { palette.weak } else { palette.text };
        painter.line_segment([centre, end], Stroke::new(1.5, colour));
        let outward = vec2(direction.x, -direction.y);
        let place = if outward.length() > 0.2 {
            end + outward.normalized() * 7.0 * scale
        } else {
            centre + vec2(8.0, 8.0) * scale
        };
        painter.text(
            place,
            Align2::CENTER_CENTER,
            name,
            FontId::new(12.0 * scale, theme::maths_italic()),
            colour,
        );
    }
}

/// What to do, or what is going on, where there is no picture.
fn hint(ui: &Ui, rect: Rect, lab: &Lab) {
    let text = if lab.scene.objects.is_empty() {
        "There is nothing to light. Add an object: + beside “Objects”."
    } else if lab.scene.lights.is_empty() {
        "It is dark. Add a light: + beside “Lights”."
    } else if lab.status.shaders == Shaders::Compiling && lab.status.frame_ms == 0.0 {
        "Compiling shaders…"
    } else {
        return;
    };
    let palette = Palette::here(ui);
    let font = FontId::new(TextStyle::Body.resolve(ui.style()).size, FontFamily::Proportional);
    plate(
        &ui.painter_at(rect),
        &palette,
        Align2::CENTER_CENTER,
        rect.center(),
        text.to_owned(),
        font,
        palette.text,
        0.0,
    );
}
