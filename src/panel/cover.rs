//! The pointer belongs to the picture where no panel, menu or dialog covers it.

use bevy_egui::egui::Order;

use super::prelude::*;

/// Areas that keep the pointer from the picture, as last shown.
#[derive(Clone, Debug, Default)]
struct Cover {
    /// Clickable rectangles over the picture.
    places: Vec<Rect>,
    /// True while a question or a dialog waits for an answer.
    busy: bool,
}

/// Keeps the cover of this frame.
pub(super) fn keep(ctx: &Context, places: Vec<Rect>, busy: bool) {
    kept::set(ctx, Cover { places, busy });
}

/// True if a position, in points of the panels, is over the picture and no panel, menu or dialog is in between; `frame`
/// is that of the [`PictureArea`](super::state::PictureArea). Uses the most recent layout: a press counts where it was
/// made, even before the next frame.
#[must_use]
pub fn is_over_picture(ctx: &Context, frame: Rect, at: Pos2) -> bool {
    takes_drops(ctx, frame, at) && !ctx.egui_is_using_pointer()
}

/// True if what a panel's drag carries falls onto the picture at a position.
pub(super) fn takes_drops(ctx: &Context, frame: Rect, at: Pos2) -> bool {
    let cover: Cover = kept::get(ctx);
    is_visible(ctx, &cover, frame, at) && !cover.places.iter().any(|place| place.contains(at))
}

/// True if a position is over the visible picture, even where something over the picture can be clicked.
pub(super) fn is_in_sight(ctx: &Context, frame: Rect, at: Pos2) -> bool {
    is_visible(ctx, &kept::get(ctx), frame, at) && !ctx.egui_is_using_pointer()
}

fn is_visible(ctx: &Context, cover: &Cover, frame: Rect, at: Pos2) -> bool {
    // Panels are not separate layers; menus, popups, windows and dialogs are.
    frame.contains(at)
        && !cover.busy
        && ctx.layer_id_at(at).is_none_or(|layer| layer.order == Order::Background)
}
