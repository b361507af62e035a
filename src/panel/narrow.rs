//! Narrow windows, such as those of phones: what is one there, and how high its controls are.

use bevy_egui::egui::Context;

/// Width below which a window has no room for panels beside the picture, in points; also reached by a large interface
/// scale.
const WIDTH: f32 = 640.0;
/// Minimum height of a control in such a window, in points: that of a thumb.
pub(super) const THUMB: f32 = 32.0;
/// What a window keeps at the sides of dialogs and menus together, in points.
const MARGIN: f32 = 16.0;

/// True if the window is narrow.
pub(super) fn is(ctx: &Context) -> bool {
    ctx.content_rect().width() < WIDTH
}

/// The height of a control that is usually so high.
pub(super) fn high(ctx: &Context, usual: f32) -> f32 {
    if is(ctx) { usual.max(THUMB) } else { usual }
}

/// The width of the content of a dialog or a menu that is usually so wide, with a frame that takes `around` points.
pub(super) fn wide(ctx: &Context, usual: f32, around: f32) -> f32 {
    usual.min(ctx.content_rect().width() - MARGIN - around).max(0.0)
}
