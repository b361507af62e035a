//! Knobs for colours.

use bevy_egui::egui::{self, Color32, Id, Response, Sense, Stroke, Ui, WidgetInfo, WidgetType, vec2};

use super::{
    Declared, Knob,
    field::{Entry, complaint, field, text_field},
    line::{Caption, NUMBER, Words, explain, head, knob, tooltip, unit},
    picker::picker,
    vector::axis_letter,
};
use crate::{
    panel::{
        narrow,
        theme::{self, Palette},
    },
    parameter::{Value, kind::colour::Colour},
    scene::limits::Limits,
    text::capitalised,
};

impl Knob for Colour {
    fn show(&self, ui: &mut Ui, of: &Declared, value: &Value) -> Option<Value> {
        let Value::Colour(rgb) = *value else { return None };
        colour_knob(ui, &of.caption, rgb, Some(self.default)).map(Value::Colour)
    }
}

/// A knob for a colour, sRGB-encoded: swatch with picker, three integers, hexadecimal.
pub fn colour_knob(
    ui: &mut Ui,
    caption: &Caption,
    value: [u8; 3],
    default: Option<[u8; 3]>,
) -> Option<[u8; 3]> {
    let id = ui.make_persistent_id(caption.salt);
    let out = knob(ui, caption, |ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        let [r, g, b] = value;
        let (label, hex) = head(ui, caption, Words::Leave(NUMBER), |ui| {
            unit(ui, "");
            let name = format!("{} in hexadecimal", caption.label);
            let shown = format!("#{r:02x}{g:02x}{b:02x}");
            let read = |text: &str| {
                parse_hex(text)
                    .ok_or_else(|| "is not a colour; must be # and six hexadecimal digits".to_owned())
            };
            let id = id.with("hex");
            text_field(ui, Entry { id, name: &name, shown: &shown, hint: "", width: 72.0 }, read)
        });
        let default_text = default.map(|[r, g, b]| format!("{r}, {g}, {b}")).unwrap_or_default();
        let rule = format!(
            "three whole numbers from 0 to 255: red, green, blue, encoded as sRGB. Default {default_text}"
        );
        explain(label, |ui| tooltip(ui, caption, &rule, ""));
        let (new, wrong) = ui.horizontal(|ui| channels(ui, id, caption, value, default)).inner;
        if let Some((error, field)) = hex.error.map(|e| (e, hex.response)).or(wrong) {
            complaint(ui, &field, &capitalised(&error), &format!("{r}, {g}, {b}"));
        }
        ui.add_space(6.0);
        new.or(hex.value)
    });
    out.filter(|c| *c != value)
}

/// Widths of a swatch, of the field of a channel, and of the letter and the gaps beside that, in points.
const SWATCH: f32 = 44.0;
const CHANNEL: f32 = 40.0;
const BESIDE: f32 = 22.0;

/// The swatch, and a field for each channel. Returns the new value, and the first error with the field.
fn channels(
    ui: &mut Ui,
    id: Id,
    caption: &Caption,
    value: [u8; 3],
    default: Option<[u8; 3]>,
) -> (Option<[u8; 3]>, Option<(String, Response)>) {
    ui.spacing_mut().item_spacing.x = 4.0;
    let mut rgb = value;
    // In a narrow panel, swatch and fields shrink before the unit is cut off.
    let whole = SWATCH + 3.0 * (CHANNEL + BESIDE) + theme::small_width(ui, caption.unit).max(18.0) + 4.0;
    let over = (whole - ui.available_width()).max(0.0);
    let shrunk = over.min(0.5 * SWATCH);
    let channel_width = (CHANNEL - (over - shrunk) / 3.0).max(34.0);
    swatch(ui, id.with("swatch"), caption.label, SWATCH - shrunk, &mut rgb, default);
    let (mut out, mut wrong) = (Some(rgb).filter(|rgb| *rgb != value), None);
    let limits = Limits::between(0.0, 255.0).whole();
    for (channel, (letter, word)) in [("R", "red"), ("G", "green"), ("B", "blue")].into_iter().enumerate() {
        let name = format!("{}: {word}", caption.label);
        let mut set = |v: f64| {
            let mut rgb = value;
            rgb[channel] = v as u8;
            out = Some(rgb);
        };
        let now = f64::from(value[channel]);
        axis_letter(ui, letter, &name, &limits, now, &mut set);
        let f = field(ui, id.with(channel), &name, now, &limits, channel_width);
        f.value.into_iter().for_each(set);
        wrong = wrong.or(f.error.map(|e| (e, f.response)));
    }
    unit(ui, caption.unit);
    (out, wrong)
}

/// The colour swatch: a click opens the picker, a double-click sets the default.
fn swatch(ui: &mut Ui, id: Id, name: &str, width: f32, rgb: &mut [u8; 3], default: Option<[u8; 3]>) {
    let palette = Palette::here(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(width, narrow::high(ui.ctx(), 22.0)), Sense::click());
    let says = format!("{name}: choose a colour");
    response.widget_info(|| WidgetInfo::labeled(WidgetType::ColorButton, ui.is_enabled(), &says));
    let [r, g, b] = *rgb;
    let hot = response.hovered() || response.has_focus();
    let stroke = Stroke::new(if hot { 1.5 } else { 1.0 }, if hot { palette.accent } else { palette.weak });
    ui.painter().rect(rect, 4.0, Color32::from_rgb(r, g, b), stroke, egui::StrokeKind::Inside);
    if response.double_clicked()
        && let Some(default) = default
    {
        *rgb = default;
        egui::Popup::close_id(ui.ctx(), id);
        return;
    }
    egui::Popup::from_toggle_button_response(&response)
        .id(id)
        .close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            *rgb = picker(ui, id.with("picker"), name, *rgb).unwrap_or(*rgb);
        });
    response.on_hover_text("Choose a colour. Double-click: default.");
}

/// A colour that cannot be edited here.
pub fn colour_sample(ui: &mut Ui, rgb: [u8; 3]) {
    let palette = Palette::here(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(44.0, 22.0), Sense::hover());
    let [r, g, b] = rgb;
    let stroke = Stroke::new(1.0, palette.line);
    ui.painter().rect(rect, 4.0, Color32::from_rgb(r, g, b), stroke, egui::StrokeKind::Inside);
    response.on_hover_text(format!("The colour in sRGB: {r}, {g}, {b}"));
}

/// Parses `#rrggbb`, `rrggbb` or `#rgb`.
#[must_use]
pub fn parse_hex(text: &str) -> Option<[u8; 3]> {
    let digits = text.trim().trim_start_matches('#');
    // Four or eight digits would include an opacity.
    if !digits.is_ascii() || ![3, 6].contains(&digits.len()) {
        return None;
    }
    let [r, g, b, _] = Color32::from_hex(&format!("#{digits}")).ok()?.to_array();
    Some([r, g, b])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_read_in_hexadecimal() {
        assert_eq!(parse_hex("#ff8000"), Some([255, 128, 0]));
        assert_eq!(parse_hex("F80"), Some([255, 136, 0]));
        for nonsense in ["", "#ff80", "#gg0000", "ü1234"] {
            assert_eq!(parse_hex(nonsense), None, "{nonsense:?}");
        }
    }
}
