//! The overlays of the picture: badges, caption, axes, hints.

use std::collections::BTreeSet;

use bevy_egui::egui::{
    self, Align2, CursorIcon, FontFamily, FontId, Pos2, Rect, Sense, Stroke, TextStyle, Ui, WidgetInfo,
    WidgetType, pos2, vec2,
};
use glam::Vec3;

use super::{
    caption::{self, Lines, caption_text},
    channels, clipping,
    compare::Arrangement,
    explain, handles, icon, keys, labels, marks,
    presentation::{CAPTION, Stage},
    state::{Action, Badge, Cell, CompareCommand, SHADER_TAB, Session, Severity, ViewChange},
    theme::{self, Palette},
    wires,
};
use crate::{
    caption::single,
    library::status::{ShaderStatus, shown_instead},
    optics::TermSelection,
    reflection::Term,
    registry::Registry,
    scene::{
        comparison::Edge,
        variant::{LETTERS, MAX_VARIANTS},
    },
    text::plural,
};

/// Minimum width of a picture for axes, in points: in a narrower one they would hide more than they say.
const AXES: f32 = 240.0;
/// Side of the corner for the axes, in points.
const AXES_CORNER: f32 = 84.0;

/// Minimum width of a part of a picture for its own badges, in points.
const NARROWEST: f32 = 140.0;
/// Width of a wide legend, in points.
const WIDE_PLATE: f32 = 330.0;
/// Maximum fraction of a picture that the plate about an error covers.
const PLATE: f32 = 0.25;

/// Result of painting the overlays.
#[derive(Debug, Default)]
pub struct Overlaid {
    /// The requested actions.
    pub actions: Vec<Action>,
    /// Clickable rectangles, which cover the picture.
    pub places: Vec<Rect>,
    /// Rectangles of badges, caption and axes.
    pub written: Vec<Rect>,
}

/// Paints the overlays into the picture, which extends over `whole`, and around it the texts of a presentation. Marks
/// keep clear of the rectangles `written` over the picture in the previous frame.
pub fn overlays(
    ui: &mut Ui,
    [whole, rect]: [Rect; 2],
    written: &[Rect],
    stage: Option<&Stage>,
    session: &Session,
    registry: &Registry,
) -> Overlaid {
    let mut all = Overlaid::default();
    if rect.width() < 80.0 || rect.height() < 80.0 {
        return all;
    }
    wires::paint(ui, rect, rect, session.active(), session, registry);
    clipping::paint(&ui.painter_at(whole), whole, session.active(), session, ui.pixels_per_point());
    // A presentation has no marks, and its messages are as large as the rest of the text.
    marked(ui, rect, written, session, registry, &mut all);
    all.written.extend(labels::labels(ui, rect, session.active(), session, registry));
    all.written.extend(explain::vectors(ui, rect, session.active(), session, registry));
    ui.scope(|ui| {
        let free = stage.map_or(rect, |stage| stage.paint(ui, session, registry));
        let (asked, covered) = stale(ui, free, session, registry);
        all.actions.extend(asked);
        let top = if covered.is_positive() { covered.bottom() + 4.0 } else { free.top() + 8.0 };
        let from = (Align2::LEFT_TOP, top);
        let top = channel(ui, free, from, session.active(), session, registry, &mut all);
        let signs = badges_of(session.active(), whole, ui, session, registry);
        let signs = signs.into_iter().chain(of_disk(session)).collect();
        badges(ui, free, (Align2::LEFT_TOP, top), signs, &mut all);
        all.places.push(covered);
        all.written.push(covered);
        hint(ui, rect, session);
    });
    if stage.is_none() {
        all.written.push(caption(ui, rect, session, registry));
        let corner = Rect::from_min_max(rect.right_bottom() - vec2(AXES_CORNER, AXES_CORNER), rect.max);
        if rect.width() >= AXES && !all.written.iter().any(|place| place.intersects(corner)) {
            all.written.push(axes(ui, rect, session));
        }
    }
    all
}

/// Paints the legend of a view's debug channel from a corner on, if there is one. Returns the top of the free space
/// below.
fn channel(
    ui: &mut Ui,
    rect: Rect,
    (side, top): (Align2, f32),
    view: usize,
    session: &Session,
    registry: &Registry,
    to: &mut Overlaid,
) -> f32 {
    let Some((place, actions)) = channels::legend(ui, rect, (side, top), view, session, registry) else {
        return top;
    };
    to.actions.extend(actions);
    to.places.push(place);
    to.written.push(place);
    place.bottom() + 4.0
}

/// Paints the marks of a view, and over them the handles of the selection.
fn marked(ui: &Ui, rect: Rect, written: &[Rect], session: &Session, registry: &Registry, to: &mut Overlaid) {
    if session.view.presenting {
        return;
    }
    // Handles would cover the pixel that is explained or that a lesson refers to, and look like vectors.
    let covers = session.explains() || session.lesson.is_some();
    let paints = [marks::marks, handles::handles];
    for paint in paints.into_iter().take(if covers { 1 } else { 2 }) {
        let (asked, places) = paint(ui, rect, written, session, registry);
        to.actions.extend(asked);
        to.places.extend(places);
    }
}

/// Paints the overlays of a comparison: marks and handles into every view, and messages about the picture into the
/// active one.
pub fn views(
    ui: &mut Ui,
    arrangement: &Arrangement,
    written: &[Rect],
    session: &Session,
    registry: &Registry,
) -> Overlaid {
    let mut all = Overlaid::default();
    let shown = arrangement.cells.iter().filter(|cell| cell.part.is_positive());
    // Stacked views share their marks.
    let layout = session.document.comparison.layout;
    let apart = layout.is_beside();
    // A difference has no wireframe.
    for cell in arrangement.cells.iter().filter(|_| !layout.is_map()) {
        wires::paint(ui, cell.rect, cell.part, cell.view, session, registry);
        let painter = ui.painter_at(cell.part);
        clipping::paint(&painter, cell.rect, cell.view, session, ui.pixels_per_point());
    }
    for cell in shown.take(if apart { usize::MAX } else { 1 }) {
        ui.push_id(("view", cell.view), |ui| {
            marked(ui, cell.rect, written, session, registry, &mut all);
            all.written.extend(labels::labels(ui, cell.rect, cell.view, session, registry));
        });
    }
    for cell in arrangement.cells.iter().filter(|cell| cell.rect.is_positive()) {
        // Stacked views share a rectangle.
        all.written.extend(explain::vectors(ui, cell.rect, cell.view, session, registry));
    }
    let active = arrangement.cells.iter().find(|cell| cell.view == session.active());
    let mut stale_in = None;
    if let Some(cell) = active.or(arrangement.cells.first()) {
        ui.scope(|ui| {
            let (asked, covered) = stale(ui, cell.rect, session, registry);
            all.actions.extend(asked);
            all.places.push(covered);
            all.written.push(covered);
            hint(ui, cell.rect, session);
            stale_in = Some((cell.view, covered)).filter(|_| covered.is_positive());
        });
    }
    if let Some((map, reason)) = arrangement.map.zip(session.no_difference()) {
        let font = TextStyle::Body.resolve(ui.style());
        all.written.push(plate(ui, map, Align2::CENTER_CENTER, map.center(), &reason, font, 0.0));
    }
    ui.scope(|ui| {
        if session.view.presenting {
            let body = FontId::proportional(CAPTION * arrangement.picture.height());
            ui.style_mut().text_styles.insert(TextStyle::Body, body);
        }
        // The badges of a difference are those of both views.
        let is_shown = |cell: &&Cell| cell.part.is_positive() || layout.is_map();
        let mut next = None;
        let mut disk = of_disk(session);
        for cell in arrangement.cells.iter().filter(is_shown) {
            let free = stale_in.filter(|(view, _)| *view == cell.view || !apart);
            let first = free.map_or(cell.rect.top() + 8.0, |(_, covered)| covered.bottom() + 4.0);
            let is_second = cell.part.is_positive() && cell.part.min != cell.rect.min;
            // Below the legend of a lobe, if there is one, and in a narrow picture below the badges at the left.
            let narrow = cell.rect.width() < 2.0 * WIDE_PLATE * theme::scale_here(ui);
            let corner = Rect::from_min_max(cell.rect.right_top() - vec2(16.0, 0.0), cell.rect.right_top())
                .expand2(vec2(0.0, 16.0));
            let there = all.written.iter().filter(|place| place.is_positive() && place.intersects(corner));
            let left = next.filter(|_| narrow).unwrap_or(first);
            let below = there.map(|place| place.bottom() + 4.0).fold(left, f32::max);
            let from = match session.document.comparison.edge {
                Edge::Vertical if is_second => (Align2::RIGHT_TOP, below),
                Edge::Horizontal if is_second => (Align2::LEFT_TOP, first.max(cell.part.top() + 8.0)),
                _ => (Align2::LEFT_TOP, next.filter(|_| !apart).unwrap_or(first)),
            };
            let top = channel(ui, cell.rect, from, cell.view, session, registry, &mut all);
            let mut signs = badges_of(cell.view, cell.rect, ui, session, registry);
            signs.extend(disk.take());
            // Keeps badges on their own side of the edge of a wipe, if there is room.
            let beside = cell.part.is_positive() && cell.part.width() >= NARROWEST * theme::scale_here(ui);
            let room = if beside { cell.part } else { cell.rect };
            next = Some(badges(ui, room, (from.0, top), signs, &mut all));
        }
    });
    all
}

/// Heading and lines of the message about a shader error in the picture. The model with the display name `shown` comes
/// first.
#[must_use]
pub fn stale_words(status: &ShaderStatus, shown: &str) -> Option<(String, Vec<String>)> {
    /// Maximum number of lines; more would hide the picture.
    const MOST: usize = 3;
    let mut names = status.stale();
    if names.is_empty() {
        return None;
    }
    names.sort_by_key(|name| *name != shown);
    let few = |all: Vec<&str>| {
        let more = format!("{} more", all.len().saturating_sub(MOST));
        let shown: Vec<_> = all.iter().take(MOST).copied().collect();
        shown_instead(&if all.len() > MOST { [shown, vec![more.as_str()]].concat() } else { shown })
    };
    let heading = format!("Showing {}", few(names));
    let causes: Vec<_> = status.troubles.iter().filter(|t| !t.stale.is_empty()).collect();
    let mut lines: Vec<_> = causes.iter().take(MOST).map(|t| t.problem.to_string()).collect();
    if causes.len() > MOST {
        lines.push(format!("and {}", plural(causes.len() - MOST, "more error")));
    }
    Some((heading, lines))
}

/// Shows that the picture does not match the shaders, in a way that stands out on any picture: a frame, and a filled
/// plate that opens the panel with the errors.
fn stale(ui: &mut Ui, rect: Rect, session: &Session, registry: &Registry) -> (Vec<Action>, Rect) {
    let shown = registry.model(session.model_shown()).map_or("", |m| m.declaration.name);
    let Some((heading, lines)) = stale_words(&session.shaders, shown) else {
        return (Vec::new(), Rect::NOTHING);
    };
    let palette = Palette::here(ui);
    let painter = ui.painter_at(rect);
    painter.rect_stroke(rect, 0.0, Stroke::new(3.0, palette.error), egui::StrokeKind::Inside);
    let padding = vec2(10.0, 7.0);
    let left = 26.0;
    let margin = 10.0;
    let room = (rect.width() - 2.0 * margin).min(560.0 * theme::scale_here(ui)) - left - 2.0 * padding.x;
    let ink = palette.panel;
    let lay_out = |text: &str, font: FontId, rows: usize, room: f32| {
        let mut job = egui::text::LayoutJob::simple(text.to_owned(), font, ink, room);
        job.wrap.max_rows = rows;
        painter.layout_job(job)
    };
    let body = TextStyle::Body.resolve(ui.style()).size;
    let large = || FontId::new(1.12 * body, theme::semibold());
    let room = room.max(64.0);
    let mut galleys = vec![lay_out(&heading, large(), 3, room)];
    galleys.extend(lines.iter().map(|line| lay_out(line, FontId::proportional(body), 2, room)));
    let size_of = |galleys: &[std::sync::Arc<egui::Galley>]| {
        let height: f32 = galleys.iter().map(|g| g.size().y + 2.0).sum();
        let width = galleys.iter().map(|g| g.size().x).fold(0.0, f32::max);
        vec2(width + left, height) + 2.0 * padding
    };
    // The picture has priority, then the heading; the panel lists all errors.
    let most = PLATE * rect.area();
    while galleys.len() > 1 && size_of(&galleys).x * size_of(&galleys).y > most {
        galleys.pop();
    }
    let too_large = |galleys: &[_]| size_of(galleys).x * size_of(galleys).y > most;
    for rows in [2, 1] {
        if too_large(&galleys) {
            galleys = vec![lay_out(&heading, large(), rows, room)];
        }
    }
    if too_large(&galleys) {
        let less = most / size_of(&galleys).y - left - 2.0 * padding.x;
        galleys = vec![lay_out(&heading, large(), 1, less.max(1.0))];
    }
    if too_large(&galleys) {
        // There is room for the frame only.
        return (Vec::new(), Rect::NOTHING);
    }
    let size = size_of(&galleys);
    let place = Rect::from_min_size(rect.min + vec2(margin, margin), size);
    let response = ui.interact(place, ui.id().with("stale shader"), Sense::click());
    let said = format!("{heading}: {}", lines.join("; "));
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &said));
    // The rim stands out even where the picture has the colour of the plate.
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
        let key = keys::word(ui.ctx(), "panel.shader");
        ui.label(theme::small(ui, format!("Click, or key {key}: the line and the message")));
    });
    let mut actions = Vec::new();
    if response.clicked() {
        actions.push(Action::View(ViewChange::BottomTab(SHADER_TAB.to_owned())));
    }
    (actions, place)
}

/// Text on a background that is readable over any picture. Returns the rectangle.
fn plate(ui: &Ui, rect: Rect, anchor: Align2, at: Pos2, text: &str, font: FontId, left: f32) -> Rect {
    let palette = Palette::here(ui);
    let padding = vec2(8.0, 4.0) * theme::scale_here(ui);
    let room = rect.width() - 16.0 - 2.0 * padding.x - left;
    let galley = ui.painter().layout(text.to_owned(), font, palette.text, room.max(64.0));
    let place = anchor.anchor_size(at, galley.size() + 2.0 * padding + vec2(left, 0.0));
    let painter = ui.painter_at(rect);
    painter.rect_filled(place, 4.0, palette.panel.gamma_multiply(0.88));
    painter.galley(place.min + padding + vec2(left, 0.0), galley, palette.text);
    place
}

/// The badge for a scene file that has changed on disk.
fn of_disk(session: &Session) -> Option<Sign> {
    session.disk_badge().map(|badge| (badge, Vec::new()))
}

/// A badge, and the actions of a click on it.
type Sign = (Badge, Vec<Action>);

/// The badge for hidden terms of the equation in a view, which shows them all.
fn hidden_terms(view: usize, session: &Session, registry: &Registry) -> Option<Sign> {
    let shown = match session.terms_of(view) {
        TermSelection::All => return None,
        other => other.id(),
    };
    let over = session.document.overrides(view).and_then(|variant| variant.reflection_model);
    let models = match &over {
        Some(id) => [id.as_str()].into(),
        None => session.document.shown().map(|o| session.document.model_of(o)).collect::<BTreeSet<_>>(),
    };
    let whose = match single(&models).and_then(|id| registry.model(id)) {
        _ if !session.lacks_term(view, registry) => String::new(),
        Some(model) => format!(", which is 0 with {}", model.declaration.name),
        None => ", which is 0 in this picture".to_owned(),
    };
    let badge = Badge {
        severity: if whose.is_empty() { Severity::Info } else { Severity::Warning },
        text: format!("Only the {shown} term{whose} · Show all"),
        help: "The other terms of the equation are hidden. Click to show them all; T goes on to the next."
            .to_owned(),
    };
    Some((badge, vec![Action::View(ViewChange::Terms(TermSelection::All))]))
}

/// The badges of a view's picture. An action on the active view activates the view first.
fn badges_of(view: usize, picture: Rect, ui: &Ui, session: &Session, registry: &Registry) -> Vec<Sign> {
    let per_point = ui.pixels_per_point();
    let pixels = f64::from(picture.area() * per_point * per_point);
    let toggle = Action::View(ViewChange::Clipping(!session.view.show_clipping));
    let clipped = clipping::badge(session, view, pixels).map(|badge| (badge, vec![toggle]));
    let mut terms = hidden_terms(view, session, registry);
    if view != session.active()
        && let Some((_, actions)) = &mut terms
    {
        actions.insert(0, Action::Compare(CompareCommand::Activate(view)));
    }
    let mut all: Vec<_> = terms.into_iter().chain(clipped).collect();
    if !session.document.variants.is_empty() {
        for (badge, _) in &mut all {
            badge.text = format!("{} · {}", LETTERS[view.min(MAX_VARIANTS)], badge.text);
        }
    }
    all
}

/// Paints a column of badges from a corner on. Returns the top of the free space below.
fn badges(ui: &mut Ui, rect: Rect, (side, top): (Align2, f32), all: Vec<Sign>, to: &mut Overlaid) -> f32 {
    let palette = Palette::here(ui);
    let scale = theme::scale_here(ui);
    let font = FontId::new(TextStyle::Body.resolve(ui.style()).size, theme::semibold());
    let mut at = pos2(side.pos_in_rect(&rect.shrink(8.0)).x, top);
    for (badge, actions) in all {
        let place = plate(ui, rect, side, at, &badge.text, font.clone(), 18.0 * scale);
        let sense = if actions.is_empty() { Sense::hover() | Sense::FOCUSABLE } else { Sense::click() };
        let response = ui.interact(place, ui.id().with(("badge", &badge.text)), sense);
        let painter = ui.painter_at(rect);
        let here = !actions.is_empty() && (response.hovered() || response.has_focus());
        let rim = if here { palette.text } else { palette.severity(badge.severity) };
        painter.rect_stroke(place, 4.0, Stroke::new(scale, rim), egui::StrokeKind::Inside);
        let sign = pos2(place.left() + 14.0 * scale, place.center().y);
        icon::severity(&painter, sign, 6.0 * scale, badge.severity, &palette);
        let role = if actions.is_empty() { WidgetType::Label } else { WidgetType::Button };
        response.widget_info(|| WidgetInfo::labeled(role, true, &badge.text));
        if !actions.is_empty() {
            to.places.push(place);
        }
        if response.clicked() {
            to.actions.extend(actions);
        }
        to.written.push(place);
        let pointer = if sense.senses_click() { CursorIcon::PointingHand } else { CursorIcon::Default };
        let response = response.on_hover_cursor(pointer);
        if !badge.help.is_empty() {
            // With the keyboard alone, the help can be reached in no other way.
            if response.has_focus() {
                response.show_tooltip_text(&badge.help);
            }
            response.on_hover_text(&badge.help);
        }
        at.y = place.bottom() + 4.0;
    }
    at.y
}

fn caption(ui: &Ui, rect: Rect, session: &Session, registry: &Registry) -> Rect {
    let palette = Palette::here(ui);
    let term = match session.terms() {
        TermSelection::All => None,
        TermSelection::Ambient => Some(Term::Ambient),
        TermSelection::Diffuse => Some(Term::Diffuse),
        TermSelection::Specular => Some(Term::Specular),
    };
    let padding = vec2(8.0, 4.0);
    let left = if term.is_some() { 14.0 } else { 0.0 };
    // The axes take the corner if there is room for them.
    let corner = if rect.width() >= AXES { 100.0 } else { 0.0 };
    let room = (rect.width() - 16.0 - corner - 2.0 * padding.x - left).max(64.0);
    let size = TextStyle::Small.resolve(ui.style()).size;
    let lines = Lines::of(ui, caption::parts(session, registry), size, palette.text, room);
    let size = lines.size + 2.0 * padding + vec2(left, 0.0);
    let place = Align2::LEFT_BOTTOM.anchor_size(rect.left_bottom() + vec2(8.0, -8.0), size);
    ui.painter().rect_filled(place, 4.0, palette.panel.gamma_multiply(0.88));
    if lines.cut {
        let whole = ui.interact(place, ui.id().with("caption"), Sense::hover());
        whole.on_hover_text(caption_text(session, registry));
    }
    lines.paint(ui, place.min + padding + vec2(left, 0.0), palette.text);
    if let Some(term) = term {
        // The colour of the term in the equation.
        let at = pos2(place.left() + 8.0 + 4.0, place.center().y);
        ui.painter().circle_filled(at, 4.0, palette.term_text(term));
    }
    place
}

/// The world axes as seen by the camera, with letters to tell them apart.
fn axes(ui: &Ui, rect: Rect, session: &Session) -> Rect {
    let palette = Palette::here(ui);
    let painter = ui.painter_at(rect);
    let radius = 34.0;
    let centre = rect.right_bottom() - vec2(radius + 8.0, radius + 8.0);
    painter.circle_filled(centre, radius, palette.panel.gamma_multiply(0.72));
    let inverse = session.facts.camera.inverse();
    let mut ends: Vec<(Vec3, &str)> =
        [(Vec3::X, "x"), (Vec3::Y, "y"), (Vec3::Z, "z")].into_iter().map(|(a, n)| (inverse * a, n)).collect();
    // Axes that point away from the eye are painted first.
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
    Rect::from_center_size(centre, vec2(2.0, 2.0) * radius)
}

/// Shows a hint in place of a missing picture.
fn hint(ui: &Ui, rect: Rect, session: &Session) {
    let text = if session.scene().objects.is_empty() {
        "There is nothing to light. Add an object: + beside “Objects”."
    } else if session.document.lights.is_empty() {
        "It is dark. Add a light: + beside “Lights”."
    } else {
        return;
    };
    let font = FontId::new(TextStyle::Body.resolve(ui.style()).size, FontFamily::Proportional);
    plate(ui, rect, Align2::CENTER_CENTER, rect.center(), text, font, 0.0);
}
