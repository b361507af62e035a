//! What is painted over the picture: badges, caption, axes, hints.

use bevy_egui::egui::{
    self, Align2, Color32, FontFamily, FontId, Painter, Pos2, Rect, Sense, Stroke, TextStyle, Ui, WidgetInfo,
    WidgetType, pos2, vec2,
};
use glam::Vec3;

use super::{
    author::SHADER_TAB,
    caption::caption_text,
    clipping, icon, marks, presentation,
    state::{Action, Badge, Lab, Severity, Shaders, ViewChange},
    theme::{self, Palette},
};
use crate::{
    library::status::ShaderStatus,
    optics::TermSelection,
    reflection::Term,
    registry::Registry,
    text::{listed, plural},
};

/// Paints the overlays into the rectangle of the picture. Returns what was asked for there, and the places that
/// can be clicked, which do not belong to the picture.
pub fn overlays(ui: &mut Ui, rect: Rect, lab: &Lab, registry: &Registry) -> (Vec<Action>, Vec<Rect>) {
    if rect.width() < 80.0 || rect.height() < 80.0 {
        return (Vec::new(), Vec::new());
    }
    clipping::paint(&ui.painter_at(rect), rect, lab, ui.pixels_per_point());
    // In a presentation the picture has no marks, and what it says of itself stands below the equation.
    let presenting = lab.view.presenting;
    let (mut actions, mut places) =
        if presenting { Default::default() } else { marks::marks(ui, rect, lab, registry) };
    let free = if presenting { presentation::overlay(ui, rect, lab, registry) } else { rect };
    let (asked, covered) = stale(ui, free, lab, registry);
    actions.extend(asked);
    let top = if covered.is_positive() { covered.bottom() + 4.0 } else { free.top() + 8.0 };
    badges(ui, free, top, lab);
    if !presenting {
        caption(ui, rect, lab, registry);
        // In a narrow picture they would hide more than they say.
        if rect.width() >= 240.0 {
            axes(ui, rect, lab);
        }
    }
    hint(ui, rect, lab);
    places.push(covered);
    (actions, places)
}

/// What the picture says of itself while a shader has an error: a heading, and where the errors are. The model
/// that people call `shown` is named first.
#[must_use]
pub fn stale_words(status: &ShaderStatus, shown: &str) -> Option<(String, Vec<String>)> {
    /// More would hide the picture.
    const MOST: usize = 3;
    let mut names = status.stale();
    if names.is_empty() {
        return None;
    }
    names.sort_by_key(|name| *name != shown);
    let few = |all: Vec<&str>| {
        let more = format!("{} more", all.len().saturating_sub(MOST));
        let shown: Vec<_> = all.iter().take(MOST).copied().collect();
        listed(&if all.len() > MOST { [shown, vec![more.as_str()]].concat() } else { shown }, "and")
    };
    let heading = format!("Showing the last good version of {}", few(names));
    let causes: Vec<_> = status.troubles.iter().filter(|t| !t.stale.is_empty()).collect();
    let mut lines: Vec<_> = causes.iter().take(MOST).map(|t| t.problem.to_string()).collect();
    if causes.len() > MOST {
        lines.push(format!("and {}", plural(causes.len() - MOST, "more error")));
    }
    Some((heading, lines))
}

/// Says that the picture is not what the shaders say, in a way that is not overlooked on any picture: a frame, and
/// a filled plate that leads to the panel with the errors.
fn stale(ui: &mut Ui, rect: Rect, lab: &Lab, registry: &Registry) -> (Vec<Action>, Rect) {
    let shown = registry.model(lab.model_shown()).map_or("", |m| m.declaration.name);
    let Some((heading, lines)) = stale_words(&lab.shaders, shown) else {
        return (Vec::new(), Rect::NOTHING);
    };
    let palette = Palette::here(ui);
    let painter = ui.painter_at(rect);
    painter.rect_stroke(rect, 0.0, Stroke::new(3.0, palette.error), egui::StrokeKind::Inside);
    let padding = vec2(10.0, 7.0);
    let left = 26.0;
    let margin = 10.0;
    let room = (rect.width() - 2.0 * margin).min(560.0) - left - 2.0 * padding.x;
    let ink = palette.panel;
    let lay_out = |text: &str, font: FontId, rows: usize| {
        let mut job = egui::text::LayoutJob::simple(text.to_owned(), font, ink, room.max(64.0));
        job.wrap.max_rows = rows;
        painter.layout_job(job)
    };
    let body = TextStyle::Body.resolve(ui.style()).size;
    let mut galleys = vec![lay_out(&heading, FontId::new(1.12 * body, theme::semibold()), 3)];
    galleys.extend(lines.iter().map(|line| lay_out(line, FontId::proportional(body), 2)));
    // Where there is little room, the heading is what counts.
    let most = rect.height() - 2.0 * (margin + padding.y);
    while galleys.len() > 1 && galleys.iter().map(|g| g.size().y + 2.0).sum::<f32>() > most {
        galleys.pop();
    }
    let height: f32 = galleys.iter().map(|g| g.size().y + 2.0).sum();
    let width = galleys.iter().map(|g| g.size().x).fold(0.0, f32::max);
    let size = vec2(width + left, height) + 2.0 * padding;
    let place = Rect::from_min_size(rect.min + vec2(margin, margin), size);
    let response = ui.interact(place, ui.id().with("stale shader"), Sense::click());
    let said = format!("{heading}: {}", lines.join("; "));
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &said));
    // The rim stands out where the picture has the colour of the plate.
    let rim = if response.hovered() || response.has_focus() { palette.text } else { palette.panel };
    painter.rect(place, 5.0, palette.error, Stroke::new(2.0, rim), egui::StrokeKind::Outside);
    let mut at = place.min + padding;
    let sign = pos2(at.x + 8.0, at.y + 0.5 * galleys[0].rows.first().map_or(0.0, |r| r.height()));
    icon::severity_in(&painter, sign, 8.0, Severity::Error, ink);
    at.x += left;
    for galley in galleys {
        let height = galley.size().y;
        painter.galley(at, galley, ink);
        at.y += height + 2.0;
    }
    let response = response.on_hover_cursor(egui::CursorIcon::PointingHand).on_hover_ui(|ui| {
        ui.set_max_width(340.0);
        ui.label(
            "A shader has an error, so the picture shows these models as they were before the last change. Correct the \
             file and save it: the picture follows by itself.",
        );
        ui.label(theme::small(ui, "Click, or key F9: the line and the message"));
    });
    let mut actions = Vec::new();
    if response.clicked() {
        actions.push(Action::View(ViewChange::BottomTab(SHADER_TAB.to_owned())));
    }
    (actions, place)
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

/// Says that terms of the equation are hidden.
fn hidden_terms(lab: &Lab) -> Option<Badge> {
    let shown = match lab.view.terms {
        TermSelection::All => return None,
        other => other.id(),
    };
    Some(Badge {
        severity: Severity::Info,
        text: format!("Only the {shown} term"),
        help:
            "The other terms of the equation are hidden. T goes on to the next; View › Terms of the equation \
               shows them all."
                .to_owned(),
    })
}

fn badges(ui: &mut Ui, rect: Rect, top: f32, lab: &Lab) {
    let palette = Palette::here(ui);
    let mut y = top;
    let hidden = hidden_terms(lab);
    let per_point = ui.pixels_per_point();
    let clipped = clipping::badge(lab, f64::from(lab.picture_rect.area() * per_point * per_point));
    let all = hidden.iter().chain(&lab.disk.badge).chain(&lab.badges).chain(&clipped);
    for (i, badge) in all.enumerate() {
        let font = FontId::new(TextStyle::Body.resolve(ui.style()).size, theme::semibold());
        let painter = ui.painter_at(rect);
        let left = 18.0;
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
        icon::severity(&painter, pos2(place.left() + 14.0, place.center().y), 6.0, badge.severity, &palette);
        let response = ui.interact(place, ui.id().with(("badge", i)), Sense::hover() | Sense::FOCUSABLE);
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Label, true, &badge.text));
        if !badge.help.is_empty() {
            // By key there is no other way to its help.
            if response.has_focus() {
                response.show_tooltip_text(&badge.help);
            }
            response.on_hover_text(&badge.help);
        }
        y = place.bottom() + 4.0;
    }
}

fn caption(ui: &Ui, rect: Rect, lab: &Lab, registry: &Registry) {
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
    let left = if term.is_some() { 14.0 } else { 0.0 };
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
        // The colour of the term in the equation.
        painter.circle_filled(pos2(place.left() + 8.0 + 4.0, y), 4.0, palette.term_text(term));
    }
}

/// The directions of the room as the camera sees them; the letters tell them apart.
fn axes(ui: &Ui, rect: Rect, lab: &Lab) {
    let palette = Palette::here(ui);
    let painter = ui.painter_at(rect);
    let radius = 34.0;
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
        let place =
            if outward.length() > 0.2 { end + outward.normalized() * 7.0 } else { centre + vec2(8.0, 8.0) };
        painter.text(place, Align2::CENTER_CENTER, name, FontId::new(12.0, theme::maths_italic()), colour);
    }
}

/// What to do, or what is going on, where there is no picture.
fn hint(ui: &Ui, rect: Rect, lab: &Lab) {
    let text = if lab.document.objects.is_empty() {
        "There is nothing to light. Add an object: + beside “Objects”."
    } else if lab.document.lights.is_empty() {
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
