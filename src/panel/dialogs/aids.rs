//! Features that the file dialogs lack: tooltips for their icons and for a long name, such a name with both of its ends, and
//! a button that opens a folder.

use crate::panel::prelude::*;
use bevy_egui::egui::{
    Area, LayerId, Order, Tooltip,
    epaint::{ClippedShape, TextShape},
    layers::ShapeIdx,
};
use egui_file_dialog::FileDialogConfig;

/// Padding around an icon, in points.
const ICON: f32 = 6.0;
/// Maximum width of a tooltip in one line, in points.
const ONE_LINE: f32 = 320.0;
/// Space at both ends of a shortened name, in points.
const NAME: f32 = 4.0;

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
        Tooltip::always_open(ctx.clone(), layer, Id::new("part of a dialog"), rect).show(|ui| {
            // Otherwise it has the width of the tooltip before.
            let font = TextStyle::Body.resolve(ui.style());
            let whole = ui.painter().layout_no_wrap(words.clone(), font, Color32::PLACEHOLDER).size().x;
            ui.set_min_width(whole.ceil().min(ONE_LINE));
            ui.label(words)
        });
    }
}

/// Shortens the name of the selected file in the middle, where the dialog would cut off how it begins.
pub(super) fn shorten_name(ctx: &Context, layer: LayerId, bottom: Rect, name: &str) {
    let found = ctx.graphics(|graphics| {
        graphics.get(layer)?.all_entries().enumerate().find_map(|(i, ClippedShape { clip_rect, shape })| {
            let Shape::Text(text) = shape else { return None };
            let whole = shape.visual_bounding_rect();
            let is_cut = text.galley.text() == name && !clip_rect.expand(2.0).contains_rect(whole);
            (is_cut && bottom.contains(clip_rect.center())).then(|| (i, *clip_rect, text.clone()))
        })
    });
    let Some((i, clip, text)) = found else { return };
    let Some(format) = text.galley.job.sections.first().map(|section| section.format.clone()) else { return };
    let galley = ctx.fonts_mut(|fonts| {
        let room = clip.width() - 2.0 * NAME;
        let short = with_both_ends(name, room, |c| fonts.glyph_width(&format.font_id, c));
        fonts.layout_no_wrap(short, format.font_id.clone(), format.color)
    });
    ctx.graphics_mut(|graphics| {
        let Some(list) = graphics.get_mut(layer) else { return };
        let pos = pos2(clip.left() + NAME, text.pos.y);
        list.mutate_shape(ShapeIdx(i), |clipped| {
            clipped.shape = Shape::Text(TextShape { pos, galley, ..text });
        });
    });
}

/// A name without the part in its middle for which there is no room.
fn with_both_ends(name: &str, room: f32, mut width: impl FnMut(char) -> f32) -> String {
    let all: Vec<(char, f32)> = name.chars().map(|c| (c, width(c))).collect();
    let mut over = all.iter().map(|(_, width)| width).sum::<f32>() - room;
    if over <= 0.0 {
        return name.to_owned();
    }
    over += width('…');
    let mut cut = all.len() / 2..all.len() / 2;
    while over > 0.0 && cut.len() < all.len() {
        let gone = if cut.start == 0 || cut.end < all.len() && cut.len().is_multiple_of(2) {
            cut.end += 1;
            cut.end - 1
        } else {
            cut.start -= 1;
            cut.start
        };
        over -= all[gone].1;
    }
    let part = |part: &[(char, f32)]| part.iter().map(|(c, _)| *c).collect::<String>();
    format!("{}…{}", part(&all[..cut.start]), part(&all[cut.end..]))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_that_is_too_wide_keeps_both_ends() {
        let short = |room: f32| with_both_ends("abcdefghij", room, |_| 1.0);
        assert_eq!(short(10.0), "abcdefghij");
        assert_eq!(short(5.0), "ab…ij");
        assert_eq!(short(4.0), "ab…j");
        assert_eq!(short(0.0), "…");
    }
}
