//! Labels in the picture: beside each object its name, reflection model and most telling values.

use std::collections::HashMap;

use super::{caption, marks::Lens, prelude::*, state::Labels};
use crate::{
    caption::{Ground, of_copy},
    scene::{Display, rows::Variable},
};

/// Maximum number of labels; more would hide the picture.
const MOST: usize = 16;
/// Maximum number of labels of rows, which have one short line.
const MOST_OF_ROWS: usize = 100;
/// Minimum size of a labelled object, in points.
const SMALLEST: f32 = 24.0;
/// The space around the text of a label, in points.
const PADDING: Vec2 = vec2(8.0, 4.0);
/// Number of values in a label.
const VALUES: usize = 3;

/// Paints the labels of the objects in a view, and those of rows that have labels. Returns their rectangles.
pub(super) fn labels(ui: &Ui, rect: Rect, view: usize, session: &Session, registry: &Registry) -> Vec<Rect> {
    let on = match session.view.labels {
        Labels::Off => false,
        Labels::On => true,
        Labels::Presentation => session.view.presenting,
    };
    let mut places = if on { of_objects(ui, rect, view, session, registry) } else { Vec::new() };
    let in_view: &Scene = if view == session.active() { session.scene() } else { &session.document };
    if on {
        return places;
    }
    // Only the nearest are put into words, since a row has up to ten thousand copies.
    let rows: Vec<_> =
        in_view.rows().filter(|row| row.repeat.labels && !row.repeat.vary.is_empty()).collect();
    if rows.is_empty() {
        return places;
    }
    let row_of = |i: usize| {
        let place = rows.partition_point(|row| row.range().end <= i);
        rows.get(place).filter(|row| row.range().contains(&i)).map(|_| place)
    };
    let mut variables: HashMap<usize, Vec<Variable>> = HashMap::new();
    let palette = palette(ui, &in_view.display);
    let size = type_size(ui, rect, session);
    let found = nearest(rect, session, |i| row_of(i).is_some(), MOST_OF_ROWS);
    // Values break into lines between neighbours.
    let width = (apart(&found, 2.0 * size) - 2.0 * PADDING.x - 2.0).max(4.0 * size).min(rect.width());
    for (i, below) in found {
        let Some(place) = row_of(i) else { continue };
        let variables = variables.entry(place).or_insert_with(|| rows[place].variables(registry).collect());
        let parts = of_copy(in_view, i, variables, registry);
        if parts.is_empty() {
            continue;
        }
        let count = parts.len();
        let line = caption::Lines::within(ui, parts, 0.9 * size, palette.text, width, count);
        if let Some(place) = plate(ui, palette, rect, below, line.size, &places) {
            line.paint(ui, place.min + PADDING, palette.text);
            places.push(place);
        }
    }
    places
}

/// Paints the labels that the view has for all objects.
fn of_objects(ui: &Ui, rect: Rect, view: usize, session: &Session, registry: &Registry) -> Vec<Rect> {
    let found = nearest(rect, session, |_| true, MOST);
    let scene = &session.document;
    let chosen = found.iter().map(|(i, _)| scene.objects[*i].clone()).collect();
    // Resolves the view for these few objects only.
    let few = Scene { objects: chosen, variants: scene.variants.clone(), ..shallow(scene) };
    let Some((seen, _)) = few.seen(view, registry) else { return Vec::new() };
    let mut places: Vec<Rect> = Vec::new();
    let palette = palette(ui, &seen.display);
    let size = type_size(ui, rect, session);
    let room = (rect.width() - 24.0).clamp(40.0, 260.0 * theme::scale_here(ui));
    for ((i, below), object) in found.into_iter().zip(&seen.objects) {
        let model = seen.model_of(object);
        let name = session.name_of(Selection::Object(i), registry);
        let values = caption::values(object, model, registry, VALUES);
        let model = registry.model(model).map_or(model, |m| m.declaration.name).to_owned();
        let galleys = [
            theme::elided(ui, &name, FontId::new(size, theme::semibold()), palette.text, room),
            theme::elided(ui, &model, FontId::proportional(0.9 * size), palette.text, room),
            theme::elided(ui, &values, FontId::proportional(0.9 * size), palette.weak, room),
        ];
        let filled = || galleys.iter().filter(|line| line.size().x > 0.0);
        let width = filled().map(|line| line.size().x).fold(0.0, f32::max);
        let height: f32 = filled().map(|line| line.size().y).sum();
        let Some(place) = plate(ui, palette, rect, below, vec2(width, height), &places) else { continue };
        let painter = ui.painter_at(rect);
        let mut y = place.top() + PADDING.y;
        for line in filled() {
            painter.galley(pos2(place.center().x - 0.5 * line.size().x, y), line.clone(), palette.text);
            y += line.size().y;
        }
        places.push(place);
    }
    places
}

/// The smallest distance between neighbours in about one line.
fn apart(found: &[(usize, Pos2)], line: f32) -> f32 {
    let each = found.iter().enumerate().flat_map(|(i, (_, a))| found[..i].iter().map(move |(_, b)| *a - *b));
    let beside = each.filter(|way| way.y.abs() < line).map(|way| way.x.abs());
    beside.fold(f32::INFINITY, f32::min)
}

/// The size of letters: in a presentation they are read from afar.
fn type_size(ui: &Ui, rect: Rect, session: &Session) -> f32 {
    let usual = TextStyle::Body.resolve(ui.style()).size;
    if session.view.presenting { usual.max(0.026 * rect.height()) } else { usual }
}

/// The colours of labels: of the theme that suits the background of the scene, or of the window if there is none.
fn palette(ui: &Ui, display: &Display) -> Palette {
    match display.backdrop() {
        None => Palette::here(ui),
        Some(_) if Ground::of(display) == Ground::LIGHT => theme::LIGHT,
        Some(_) => theme::DARK,
    }
}

/// The visible objects among these that are near enough for a label, the nearest first, since those take precedence; each
/// with the point below it in the picture.
fn nearest(rect: Rect, session: &Session, wanted: impl Fn(usize) -> bool, most: usize) -> Vec<(usize, Pos2)> {
    let lens = Lens::of(session, rect);
    let down = session.facts.camera * Vec3::NEG_Y;
    let objects = session.document.objects.iter().enumerate();
    let mut found: Vec<_> = objects
        .filter(|(i, object)| object.visible && wanted(*i))
        .filter_map(|(i, object)| {
            let middle = lens.project(object.position)?;
            let below = lens.project(object.position + down * (0.5 * object.size))?;
            let large = (below - middle).length() >= 0.5 * SMALLEST;
            let distance = object.position.distance_squared(session.facts.eye);
            (large && rect.contains(middle)).then_some((i, below, distance))
        })
        .collect();
    found.sort_by(|a, b| a.2.total_cmp(&b.2));
    found.into_iter().take(most).map(|(i, below, _)| (i, below)).collect()
}

/// Paints the plate of a label with contents of this size below a point, unless it would cover others. Returns its rectangle.
fn plate(
    ui: &Ui,
    palette: Palette,
    rect: Rect,
    below: Pos2,
    contents: Vec2,
    others: &[Rect],
) -> Option<Rect> {
    let whole = contents + 2.0 * PADDING;
    let free = rect.shrink(4.0);
    let left = (below.x - 0.5 * whole.x).clamp(free.left(), (free.right() - whole.x).max(free.left()));
    let top = (below.y + 6.0).clamp(free.top(), (free.bottom() - whole.y).max(free.top()));
    let place = Rect::from_min_size(pos2(left, top), whole);
    if others.iter().any(|other| other.intersects(place)) {
        return None;
    }
    ui.painter_at(rect).rect_filled(place, 4.0, palette.plate());
    Some(place)
}

/// A copy of a scene without its lists.
fn shallow(scene: &Scene) -> Scene {
    Scene {
        reflection_model: scene.reflection_model.clone(),
        shading_model: scene.shading_model.clone(),
        display: scene.display,
        lights: Vec::new(),
        ..Scene::default()
    }
}
