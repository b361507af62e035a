//! Labels in the picture: beside each object its name, reflection model and most telling values.

use super::{caption, marks::Lens, prelude::*, state::Labels};

/// Maximum number of labels; more would hide the picture.
const MOST: usize = 16;
/// Minimum size of a labelled object, in points.
const SMALLEST: f32 = 24.0;
/// Number of values in a label.
const VALUES: usize = 3;

/// Paints the labels of the objects in a view. Returns their rectangles.
pub(super) fn labels(ui: &Ui, rect: Rect, view: usize, session: &Session, registry: &Registry) -> Vec<Rect> {
    let on = match session.view.labels {
        Labels::Off => false,
        Labels::On => true,
        Labels::Presentation => session.view.presenting,
    };
    if !on {
        return Vec::new();
    }
    let found = nearest(rect, session);
    let scene = &session.document;
    let chosen = found.iter().map(|(i, _)| scene.objects[*i].clone()).collect();
    // Resolves the view for these few objects only.
    let few = Scene { objects: chosen, variants: scene.variants.clone(), ..shallow(scene) };
    let Some((seen, _)) = few.seen(view, registry) else { return Vec::new() };
    let mut places: Vec<Rect> = Vec::new();
    let palette = Palette::here(ui);
    let size = TextStyle::Body.resolve(ui.style()).size;
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
        places.extend(plate(ui, rect, below, galleys, &places));
    }
    places
}

/// The visible objects that are near enough for a label, the nearest first, since those take precedence; each with the
/// point below it in the picture.
fn nearest(rect: Rect, session: &Session) -> Vec<(usize, Pos2)> {
    let lens = Lens::of(session, rect);
    let down = session.facts.camera * Vec3::NEG_Y;
    let objects = session.document.objects.iter().enumerate().filter(|(_, object)| object.visible);
    let mut found: Vec<_> = objects
        .filter_map(|(i, object)| {
            let middle = lens.project(object.position)?;
            let below = lens.project(object.position + down * (0.5 * object.size))?;
            let large = (below - middle).length() >= 0.5 * SMALLEST;
            let distance = object.position.distance_squared(session.facts.eye);
            (large && rect.contains(middle)).then_some((i, below, distance))
        })
        .collect();
    found.sort_by(|a, b| a.2.total_cmp(&b.2));
    found.into_iter().take(MOST).map(|(i, below, _)| (i, below)).collect()
}

/// Paints the lines of a label below a point, unless it would cover others. Returns its rectangle.
fn plate(ui: &Ui, rect: Rect, below: Pos2, lines: [Arc<Galley>; 3], others: &[Rect]) -> Option<Rect> {
    let lines = || lines.iter().filter(|line| line.size().x > 0.0);
    let width = lines().map(|line| line.size().x).fold(0.0, f32::max);
    let height: f32 = lines().map(|line| line.size().y).sum();
    let padding = vec2(8.0, 4.0);
    let whole = vec2(width, height) + 2.0 * padding;
    let free = rect.shrink(4.0);
    let left = (below.x - 0.5 * whole.x).clamp(free.left(), (free.right() - whole.x).max(free.left()));
    let top = (below.y + 6.0).clamp(free.top(), (free.bottom() - whole.y).max(free.top()));
    let place = Rect::from_min_size(pos2(left, top), whole);
    if others.iter().any(|other| other.intersects(place)) {
        return None;
    }
    let (palette, painter) = (Palette::here(ui), ui.painter_at(rect));
    painter.rect_filled(place, 4.0, palette.panel.gamma_multiply(0.88));
    let mut y = place.top() + padding.y;
    for line in lines() {
        painter.galley(pos2(place.center().x - 0.5 * line.size().x, y), line.clone(), palette.text);
        y += line.size().y;
    }
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
