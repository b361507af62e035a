//! Windows that ask for something beside the picture, without blocking it.

use bevy_egui::egui::{Align2, Id, Key, RichText, Ui, Window};

use super::PanelContext;

/// Width of such a window, in points.
const WIDTH: f32 = 440.0;

/// Shows such a window. Returns false if the user closes it.
pub(super) fn window(
    ui: &Ui,
    id: &str,
    title: String,
    context: &PanelContext<'_>,
    content: impl FnOnce(&mut Ui),
) -> bool {
    let mut open = true;
    Window::new(RichText::new(title).heading())
        .id(Id::new(id))
        .open(&mut open)
        .collapsible(false)
        .resizable(false)
        .default_width(WIDTH)
        .pivot(Align2::CENTER_CENTER)
        .default_pos(context.area().rect.center())
        .show(ui.ctx(), |ui| {
            ui.set_width(WIDTH);
            content(ui);
        });
    open && !ui.input(|i| i.key_pressed(Key::Escape))
}
