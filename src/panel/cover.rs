//! The pointer belongs to the picture where no panel, menu or dialog covers it.

use bevy_egui::egui::{Context, Id, Order, Pos2, Rect};

/// Areas that keep the pointer from the picture, as last shown.
#[derive(Clone, Debug, Default)]
struct Cover {
    /// Clickable rectangles over the picture.
    places: Vec<Rect>,
    /// True while a question or a dialog waits for an answer.
    busy: bool,
}

fn memory() -> Id {
    Id::new("cover of the picture")
}

/// Keeps the cover of this frame.
pub(super) fn keep(ctx: &Context, places: Vec<Rect>, busy: bool) {
    ctx.data_mut(|d| d.insert_temp(memory(), Cover { places, busy }));
}

/// True if a position, in points of the panels, is over the picture and no panel, menu or dialog is in between; `frame`
/// is that of the [`PictureArea`](super::state::PictureArea). Uses the most recent layout: a press counts where it was
/// made, even before the next frame.
#[must_use]
pub fn is_over_picture(ctx: &Context, frame: Rect, at: Pos2) -> bool {
    let cover: Cover = ctx.data(|d| d.get_temp(memory())).unwrap_or_default();
    is_in_sight(ctx, frame, at) && !cover.places.iter().any(|place| place.contains(at))
}

/// True if a position is over the visible picture, even where something over the picture can be clicked.
pub(super) fn is_in_sight(ctx: &Context, frame: Rect, at: Pos2) -> bool {
    let cover: Cover = ctx.data(|d| d.get_temp(memory())).unwrap_or_default();
    // Panels are not separate layers; menus, popups, windows and dialogs are.
    frame.contains(at)
        && !cover.busy
        && ctx.layer_id_at(at).is_none_or(|layer| layer.order == Order::Background)
        && !ctx.egui_is_using_pointer()
}
