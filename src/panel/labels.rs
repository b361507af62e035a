//! Labels in the picture: beside each object its name, reflection model and most telling values.

use bevy_egui::egui::{FontId, Rect, TextStyle, Ui, pos2, vec2};
use glam::Vec3;

use super::{
    caption,
    marks::Lens,
    state::{Labels, Session},
    theme::{self, Palette},
};
use crate::{document::Selection, registry::Registry, scene::Scene};

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
    let lens = Lens::of(session, rect);
    let scene = &session.document;
    let down = session.facts.camera * Vec3::NEG_Y;
    let radius = |size: f32| 0.5 * size;
    let mut found: Vec<_> = scene
        .objects
        .iter()
        .enumerate()
        .filter(|(_, object)| object.visible)
        .filter_map(|(i, object)| {
            let middle = lens.project(object.position)?;
            let below = lens.project(object.position + down * radius(object.size))?;
            let large = (below - middle).length() >= 0.5 * SMALLEST;
            let distance = object.position.distance_squared(session.facts.eye);
            (large && rect.contains(middle)).then_some((i, below, distance))
        })
        .collect();
    // Nearer objects take precedence.
    found.sort_by(|a, b| a.2.total_cmp(&b.2));
    found.truncate(MOST);
    let chosen = found.iter().map(|(i, ..)| scene.objects[*i].clone()).collect();
    // Resolves the view for these few objects only.
    let few = Scene { objects: chosen, variants: scene.variants.clone(), ..shallow(scene) };
    let Some((seen, _)) = few.seen(view, registry) else { return Vec::new() };
    let mut places: Vec<Rect> = Vec::new();
    let palette = Palette::here(ui);
    let size = TextStyle::Body.resolve(ui.style()).size;
    for ((i, below, _), object) in found.into_iter().zip(&seen.objects) {
        let model = seen.model_of(object);
        let name = session.name_of(Selection::Object(i), registry);
        let values = caption::values(object, model, registry, VALUES);
        let model = registry.model(model).map_or(model, |m| m.declaration.name).to_owned();
        let room = (rect.width() - 24.0).clamp(40.0, 260.0 * theme::scale_here(ui));
        let galleys = [
            theme::elided(ui, &name, FontId::new(size, theme::semibold()), palette.text, room),
            theme::elided(ui, &model, FontId::proportional(0.9 * size), palette.text, room),
            theme::elided(ui, &values, FontId::proportional(0.9 * size), palette.weak, room),
        ];
        let galleys: Vec<_> = galleys.into_iter().filter(|galley| galley.size().x > 0.0).collect();
        let width = galleys.iter().map(|galley| galley.size().x).fold(0.0, f32::max);
        let height: f32 = galleys.iter().map(|galley| galley.size().y).sum();
        let padding = vec2(8.0, 4.0);
        let whole = vec2(width, height) + 2.0 * padding;
        let free = rect.shrink(4.0);
        let left = (below.x - 0.5 * whole.x).clamp(free.left(), (free.right() - whole.x).max(free.left()));
        let top = (below.y + 6.0).clamp(free.top(), (free.bottom() - whole.y).max(free.top()));
        let place = Rect::from_min_size(pos2(left, top), whole);
        if places.iter().any(|other| other.intersects(place)) {
            continue;
        }
        let painter = ui.painter_at(rect);
        painter.rect_filled(place, 4.0, palette.panel.gamma_multiply(0.88));
        let mut at = place.min + padding;
        for galley in galleys {
            let x = place.center().x - 0.5 * galley.size().x;
            let height = galley.size().y;
            painter.galley(pos2(x, at.y), galley, palette.text);
            at.y += height;
        }
        places.push(place);
    }
    places
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
