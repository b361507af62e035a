//! Features that the file dialogs lack: tooltips for their icons, and a button that opens a folder.

use crate::panel::prelude::*;
use bevy_egui::egui::{Area, LayerId, Order, Tooltip, epaint::ClippedShape};
use egui_file_dialog::FileDialogConfig;

/// Padding around an icon, in points.
const ICON: f32 = 6.0;

/// The glyph of each icon at the top, and its tooltip.
fn icons(config: &FileDialogConfig) -> [(&str, &'static str); 7] {
    [
        (&config.parent_directory_icon, "The folder that this one is in"),
        (&config.back_icon, "Back: the folder before"),
        (&config.forward_icon, "Forward again"),
        (&config.new_folder_icon, "Create a new folder here"),
        (&config.path_edit_icon, "Type the path"),
        (&config.menu_icon, "Reload, hidden files and more"),
        (&config.search_icon, "Search in this folder"),
    ]
    .map(|(icon, words)| (icon.as_str(), words))
}

/// Shows the tooltip of the icon under the pointer.
pub(super) fn name_icons(ctx: &Context, layer: LayerId, top: Rect, config: &FileDialogConfig) {
    let pointer = ctx.pointer_hover_pos().filter(|at| top.contains(*at));
    let Some(pointer) = pointer.filter(|at| ctx.layer_id_at(*at) == Some(layer)) else { return };
    let icons = icons(config);
    let named = |shape: &Shape| {
        let Shape::Text(text) = shape else { return None };
        let rect = shape.visual_bounding_rect().expand(ICON);
        let icon = icons.iter().find(|(icon, _)| *icon == text.galley.text())?;
        rect.contains(pointer).then_some((rect, icon.1))
    };
    let found = ctx.graphics(|graphics| {
        graphics.get(layer)?.all_entries().find_map(|ClippedShape { shape, .. }| match shape {
            Shape::Vec(shapes) => shapes.iter().find_map(named),
            shape => named(shape),
        })
    });
    // One frame measures the tooltip and the next shows it; an idle window would not draw the second.
    let id = Id::new("words of an icon");
    let now = found.map(|(_, words)| words);
    if ctx.data_mut(|d| std::mem::replace(d.get_temp_mut_or_default::<Option<&str>>(id), now)) != now {
        ctx.request_repaint();
    }
    if let Some((rect, words)) = found {
        Tooltip::always_open(ctx.clone(), layer, Id::new("icon of a dialog"), rect)
            .show(|ui| ui.label(words));
    }
}

/// Covers the dialog's own button, which opens only files. Returns true if clicked.
pub(super) fn open_folder(ctx: &Context, layer: LayerId, bottom: Rect, label: &str) -> bool {
    // The only disabled widget there.
    let place = ctx.viewport(|v| {
        let widgets = v.this_pass.widgets.get_layer(layer);
        widgets.filter(|w| !w.enabled && bottom.contains_rect(w.rect)).map(|w| w.rect).last()
    });
    let Some(place) = place else { return false };
    let id = Id::new("open the selected folder");
    let area = Area::new(id).order(Order::Foreground).fixed_pos(place.min).constrain(false);
    let button = area.show(ctx, |ui| {
        ui.spacing_mut().item_spacing = vec2(0.0, 0.0);
        ui.add_sized(place.size(), Button::new(label))
    });
    button.inner.on_hover_text("Show what is in this folder").clicked()
}
