//! Features that the file dialogs lack: tooltips for their icons and for a long name, and a button that opens a folder.

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

/// Shows the tooltip of what is under the pointer: an icon at the top, or at the bottom the name of the selected file, if
/// only a part of it is in sight.
pub(super) fn name_parts(
    ctx: &Context,
    layer: LayerId,
    (top, bottom): (Rect, Rect),
    (config, file): (&FileDialogConfig, Option<&str>),
) {
    let pointer = ctx.pointer_hover_pos().filter(|at| ctx.layer_id_at(*at) == Some(layer));
    let Some((pointer, part)) = pointer.and_then(|at| {
        let part = [top, bottom].into_iter().find(|part| part.contains(at));
        part.map(|part| (at, part))
    }) else {
        return;
    };
    let icons = icons(config);
    let named = |clip: Rect, shape: &Shape| {
        let Shape::Text(text) = shape else { return None };
        let (rect, text) = (shape.visual_bounding_rect(), text.galley.text());
        let words = if part == top {
            icons.iter().find(|(icon, _)| *icon == text).map(|(_, words)| *words)
        } else {
            file.filter(|name| *name == text && !clip.expand(2.0).contains_rect(rect))
        };
        let rect = rect.expand(ICON).intersect(part);
        words.filter(|_| rect.contains(pointer)).map(|words| (rect, words.to_owned()))
    };
    let found = ctx.graphics(|graphics| {
        graphics.get(layer)?.all_entries().find_map(|ClippedShape { clip_rect, shape }| match shape {
            Shape::Vec(shapes) => shapes.iter().find_map(|shape| named(*clip_rect, shape)),
            shape => named(*clip_rect, shape),
        })
    });
    // One frame measures the tooltip and the next shows it; an idle window would not draw the second.
    let id = Id::new("words of a part");
    let now = found.as_ref().map(|(_, words)| words.clone());
    let before =
        ctx.data_mut(|d| std::mem::replace(d.get_temp_mut_or_default::<Option<String>>(id), now.clone()));
    if before != now {
        ctx.request_repaint();
    }
    if let Some((rect, words)) = found {
        Tooltip::always_open(ctx.clone(), layer, Id::new("part of a dialog"), rect)
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
