//! Segmented buttons: several options side by side.

use super::prelude::*;

/// Width of a segment: as when selected, so that nothing moves when the selection does.
pub(super) fn segment_width(ui: &Ui, option: &str) -> f32 {
    let bold = FontId::new(TextStyle::Button.resolve(ui.style()).size, theme::semibold());
    let text = ui.painter().layout_no_wrap(option.to_owned(), bold, Color32::WHITE);
    text.size().x + 2.0 * ui.spacing().button_padding.x
}

/// Values side by side, each with a tooltip. Returns another one that was clicked.
pub(super) fn values<T: Copy + PartialEq>(
    ui: &mut Ui,
    name: &str,
    all: &[T],
    now: T,
    text: fn(T) -> &'static str,
    tip: impl Fn(&mut Ui, T),
) -> Option<T> {
    let names: Vec<_> = all.iter().map(|value| text(*value)).collect();
    let at = all.iter().position(|value| *value == now);
    segmented(ui, name, &names, at, |ui, i| tip(ui, all[i])).map(|i| all[i])
}

/// Options side by side, one of them selected. Returns the index of another option that was clicked.
pub fn segmented(
    ui: &mut Ui,
    name: &str,
    options: &[&str],
    chosen: Option<usize>,
    tip: impl Fn(&mut Ui, usize),
) -> Option<usize> {
    let palette = Palette::here(ui);
    let mut out = None;
    egui::Frame::new()
        .fill(palette.field)
        .stroke(Stroke::new(1.0, palette.line))
        .corner_radius(5.0)
        .inner_margin(1.0)
        .show(ui, |ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            ui.horizontal(|ui| {
                for (i, option) in options.iter().enumerate() {
                    let on = chosen == Some(i);
                    let width = segment_width(ui, option);
                    let colour = if on { palette.text } else { palette.weak };
                    let text = RichText::new(*option).color(colour);
                    let text = if on { text.family(theme::semibold()) } else { text };
                    let fill = if on { palette.chosen } else { Color32::TRANSPARENT };
                    let button = Button::new(text).fill(fill).stroke(Stroke::NONE).corner_radius(4.0);
                    let response = ui.add(button.min_size(vec2(width, 22.0)));
                    let says = format!("{name}: {option}");
                    theme::says_chosen(&response, WidgetType::RadioButton, on, says);
                    if on {
                        let r = response.rect.shrink2(vec2(6.0, 0.0));
                        let line = Stroke::new(2.0, palette.accent);
                        ui.painter().hline(r.x_range(), r.bottom() - 1.0, line);
                    }
                    if response.clicked() && !on {
                        out = Some(i);
                    }
                    response.on_hover_ui(|ui| tip(ui, i));
                }
            });
        });
    out
}
