//! The point at which the equation was evaluated: the polygon, the vertices with their weights, or the point of the
//! pixel.

use bevy_egui::egui::Grid;

use super::rows;
use crate::{
    explain::{Corner, Seen},
    panel::prelude::*,
    shading::Stage,
};

/// Shows the point of the pixel, or the pinned one, and how the shading model uses it.
pub(super) fn point(ui: &mut Ui, seen: &Seen, pinned: bool) {
    rows::close(ui);
    let name = if pinned { "pinned point" } else { "point at the pixel's centre" };
    rows::named_triple(ui, name, seen.position, " m");
    // Per-pixel shading evaluates the equation with the interpolated normal or with that of the polygon: mark the one in
    // use.
    let per_pixel = seen.shading.stage == Stage::Pixel;
    let of_polygon =
        seen.spots.first().is_some_and(|spot| per_pixel && is_along(spot.normal, seen.face_normal))
            && !is_along(seen.interpolated_normal, seen.face_normal);
    let used = if of_polygon { ", used here" } else { "" };
    rows::named_triple(ui, &format!("normal of polygon {}{used}", seen.polygon), seen.face_normal, "");
    if per_pixel && !of_polygon {
        let n = seen.interpolated_normal;
        let length = n.length();
        rows::named_triple(ui, "interpolated normal", n, "");
        rows::named(ui, "its length", &rows::short(length), &rows::all(length));
        if n != Vec3::ZERO {
            rows::named_triple(ui, "renormalised, used here", n.normalize_or_zero(), "");
        }
    }
    if seen.shading.stage == Stage::Vertex {
        ui.add_space(6.0);
        vertices(ui, seen);
    }
    if let Some(per_pixel) = &seen.per_pixel {
        ui.add_space(6.0);
        rows::estimate(ui, "per-pixel shading would give", per_pixel.colour, per_pixel.error(), false);
        rows::estimate(ui, "instead of", seen.light, seen.error(), false);
    }
}

/// True if two directions are parallel or opposite.
fn is_along(a: Vec3, b: Vec3) -> bool {
    a.cross(b).length() < 1e-4 * a.length() * b.length()
}

/// Gap between the columns of the vertices, in points.
const GAP: f32 = 8.0;

/// Shows the colours of the vertices with their weights: in columns, with short names if need be, if those have room.
fn vertices(ui: &mut Ui, seen: &Seen) {
    rows::heading(ui, "Interpolated between the vertices");
    let weight = |corner: &Corner| format!("{} ×", rows::short(corner.weight));
    let body = TextStyle::Body.resolve(ui.style());
    let widest = |of: &dyn Fn(&Corner) -> f32| seen.corners.iter().map(of).fold(0.0, f32::max);
    let weights = widest(&|corner| theme::width_in(ui, &weight(corner), &body));
    let colours = widest(&|corner| rows::width_of_estimate(ui, corner.colour, seen.error_at(corner)));
    let colours = colours.max(rows::width_of_estimate(ui, seen.light, seen.error()));
    let fits = |is_long: &bool| {
        let names = widest(&|corner| theme::small_width(ui, &name(corner, *is_long)));
        names + weights + colours + 2.0 * GAP <= ui.available_width()
    };
    let Some(is_long) = [true, false].into_iter().find(fits) else {
        for corner in &seen.corners {
            let before = format!("{}: {}", name(corner, true), weight(corner));
            rows::estimate(ui, &before, corner.colour, seen.error_at(corner), false);
        }
        rows::estimate(ui, "=", seen.light, seen.error(), true);
        return;
    };
    Grid::new(ui.id().with("weights")).num_columns(3).spacing([GAP, 3.0]).show(ui, |ui| {
        for corner in &seen.corners {
            ui.label(theme::small(ui, name(corner, is_long)));
            ui.label(weight(corner)).on_hover_text(rows::all(corner.weight));
            rows::estimate(ui, "", corner.colour, seen.error_at(corner), false);
            ui.end_row();
        }
        ui.label("");
        ui.label("=");
        rows::estimate(ui, "", seen.light, seen.error(), true);
        ui.end_row();
    });
}

/// The name of a vertex, with or without the word.
fn name(corner: &Corner, is_long: bool) -> String {
    if is_long { format!("vertex {}", corner.vertex) } else { corner.vertex.to_string() }
}
