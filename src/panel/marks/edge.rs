//! The arrows at the edge of the picture.

use bevy_egui::egui::{
    Align2, Color32, CursorIcon, FontId, Id, Painter, Pos2, Rect, Sense, Shape, Stroke, Ui, Vec2, WidgetInfo,
    WidgetType, vec2,
};

use super::{
    Asked, Sight,
    ink::{OUTLINE, RIM},
    place::at_edge,
};
use crate::{
    document::Selection,
    panel::{state::Action, theme},
};

/// Half the height of an arrow at the edge, points.
const ARROW: f32 = 8.0;
/// Distance of the arrows from the edge, points.
const INSET: f32 = 16.0;
/// Angle between the places tried for an arrow along the edge, and their number to either side.
const STEP: f32 = 2.0 * std::f32::consts::PI / 180.0;
const ASIDE: u16 = 20;
/// Names in the tooltip of an arrow that stands for several lights.
const NAMES: usize = 8;

/// A light that is not in view.
pub(super) struct Outside {
    pub(super) light: usize,
    /// The direction from the middle of the picture.
    pub(super) way: Vec2,
    /// The place, if it is in the picture and something is written over it.
    pub(super) covered: Option<Pos2>,
}

/// The place of an arrow on the way from the middle to a light: as far out as nothing is written over it; at the edge beside
/// that way where it would be far in, over the objects in the middle.
fn clear_end(frame: Rect, overlays: &[Rect], outside: &Outside) -> Pos2 {
    let end = outside.covered.unwrap_or_else(|| at_edge(frame, outside.way));
    let (middle, way) = (frame.center(), outside.way);
    let length = (end - middle).length();
    let inward = |least: f32| {
        let lengths = (0..).map(move |k| length - 2.0 * k as f32).take_while(move |l| *l > least);
        lengths.map(move |l| middle + way * l)
    };
    let turns = (1..=ASIDE).flat_map(|k| [f32::from(k), -f32::from(k)]).filter(|_| outside.covered.is_none());
    let aside = turns.map(|k| at_edge(frame, Vec2::angled(way.angle() + STEP * k)));
    let free = |at: &Pos2| {
        let arrow = Rect::from_center_size(*at, Vec2::splat(3.0 * ARROW));
        !overlays.iter().any(|r| r.intersects(arrow))
    };
    let mut places = inward(length - 3.0 * ARROW).chain(aside).chain(inward(0.3 * length));
    places.find(free).unwrap_or(end)
}

/// Paints the arrow for some lights, with their number.
fn paint(painter: &Painter, at: Pos2, way: Vec2, count: usize, colour: Color32) {
    let (ahead, side) = (way * ARROW, way.rot90() * ARROW);
    // So slim that it cannot be taken for an arrow in another direction.
    let (tip, back) = (at + ahead * 1.2, at - ahead);
    let triangle = vec![tip, back + side * 0.7, back - side * 0.7];
    painter.add(Shape::convex_polygon(triangle, colour, Stroke::new(RIM, OUTLINE)));
    if count > 1 {
        let font = FontId::new(10.5, theme::semibold());
        let text = painter.layout_no_wrap(count.to_string(), font, colour);
        let middle = at - way * (ARROW + 0.5 * text.size().max_elem() + 3.0);
        let plate = Rect::from_center_size(middle, text.size() + vec2(6.0, 2.0));
        painter.rect_filled(plate, 3.0, OUTLINE);
        painter.galley(Align2::CENTER_CENTER.anchor_size(middle, text.size()).min, text, colour);
    }
}

/// The arrows. A single arrow stands for many that would overlap, and gives their number.
pub(super) fn arrows(
    ui: &Ui,
    Sight { rect, written, session, registry }: Sight<'_>,
    outside: &[Outside],
    colour_of: impl Fn(usize) -> Color32,
) -> Asked {
    let frame = rect.shrink(INSET);
    let (mut actions, mut places) = (Vec::new(), Vec::new());
    if !frame.is_positive() {
        return (actions, places);
    }
    let mut ends: Vec<_> = outside.iter().map(|o| (o, clear_end(frame, written, o))).collect();
    // Around the picture, so that neighbours come one after the other.
    ends.sort_by(|a, b| a.0.way.angle().total_cmp(&b.0.way.angle()));
    let mut groups: Vec<(Vec2, Pos2, Vec<usize>)> = Vec::new();
    for (Outside { light, way, .. }, at) in ends {
        match groups.iter_mut().rev().find(|(_, first, _)| first.distance(at) < 3.4 * ARROW) {
            Some((_, _, lights)) => lights.push(*light),
            None => groups.push((*way, at, vec![*light])),
        }
    }
    for (way, at, mut lights) in groups {
        lights.sort_unstable();
        let chosen = lights.iter().position(|i| session.selection == Selection::Light(*i));
        // A light that shines goes before those that are off.
        let lit = lights.iter().position(|i| session.document.lights[*i].enabled);
        let colour = colour_of(lights[chosen.or(lit).unwrap_or(0)]);
        paint(&ui.painter_at(rect), at, way, lights.len(), colour);
        let place = Rect::from_center_size(at, Vec2::splat(3.0 * ARROW));
        let id = Id::new(("light outside the view", lights[0]));
        let response = ui.interact(place, id, Sense::click()).on_hover_cursor(CursorIcon::PointingHand);
        let name = |i: usize| session.name_of(Selection::Light(i), registry);
        let mut names: Vec<_> = lights.iter().take(NAMES).map(|i| name(*i)).collect();
        if lights.len() > NAMES {
            names.push(format!("and {} more", lights.len() - NAMES));
        }
        let hidden = |i: &usize| outside.iter().any(|o| o.light == *i && o.covered.is_some());
        let where_ =
            if lights.iter().all(hidden) { "Under what is written here" } else { "Outside the view" };
        let said = format!("{where_}: {}", names.join(", "));
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, &said));
        if response.clicked() {
            // Again and again: one after the other.
            let next = chosen.map_or(0, |k| (k + 1) % lights.len());
            actions.push(Action::Select(Selection::Light(lights[next])));
        }
        response.on_hover_ui(|ui| {
            names.iter().for_each(|name| drop(ui.label(name)));
            let next = if lights.len() > 1 { " the next" } else { "" };
            ui.label(theme::small(ui, format!("{where_}. Click to select{next}")));
        });
        places.push(place);
    }
    (actions, places)
}

#[cfg(test)]
mod tests {
    use bevy_egui::egui::pos2;

    use super::*;

    #[test]
    fn an_arrow_gives_way_to_what_is_written_along_the_edge_and_not_into_the_middle() {
        let frame = Rect::from_min_max(pos2(0.0, 0.0), pos2(300.0, 400.0));
        let outside = |covered| Outside { light: 0, way: vec2(0.6, -0.8), covered };
        let end = at_edge(frame, vec2(0.6, -0.8));
        assert_eq!(clear_end(frame, &[], &outside(None)), end);
        let badge = Rect::from_min_max(pos2(170.0, 0.0), pos2(300.0, 90.0));
        let at = clear_end(frame, &[badge], &outside(None));
        assert!(!badge.intersects(Rect::from_center_size(at, Vec2::splat(3.0 * ARROW))), "{at:?}");
        assert!(frame.expand(1.0).contains(at) && !frame.shrink(1.0).contains(at), "at the edge: {at:?}");
        // A small step inwards is enough beside a thin one.
        let thin = Rect::from_min_max(pos2(0.0, 0.0), pos2(300.0, 4.0));
        let at = clear_end(frame, &[thin], &outside(None));
        assert!((at - end).length() < 3.0 * ARROW && at.y > end.y, "{at:?}");
        // A light in the picture is pointed at on the way to it.
        let covered = clear_end(frame, &[badge], &outside(Some(pos2(210.0, 120.0))));
        assert!((covered - frame.center()).normalized().dot(vec2(0.6, -0.8)) > 0.999, "{covered:?}");
    }
}
