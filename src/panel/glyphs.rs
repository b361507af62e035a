//! Text and glyphs from outside, limited to the characters that the fonts contain.

use std::{borrow::Cow, collections::HashSet};

use super::prelude::*;
use bevy::log::warn;
use bevy_egui::egui::AtomExt as _;

/// Width of a column of glyphs, as a multiple of the size of the text.
const COLUMN: f32 = 1.25;

/// Replaces each character that the fonts lack by letters of similar sound. `owner` names the origin of the text in the
/// log.
pub(super) fn legible<'a>(ui: &Ui, text: &'a str, owner: &str) -> Cow<'a, str> {
    if has(ui, text) {
        return Cow::Borrowed(text);
    }
    let letter = |c: char| match deunicode::deunicode_char(c).filter(|known| has(ui, known)) {
        _ if has(ui, c.encode_utf8(&mut [0; 4])) => c.to_string(),
        Some(known) => known.to_owned(),
        None => "?".to_owned(),
    };
    let shown: String = text.chars().map(letter).collect();
    report(ui, text, &shown, owner);
    Cow::Owned(shown)
}

/// The glyph of a type, or the first letter of the type's name if the fonts lack the glyph.
pub(super) fn glyph<'a>(ui: &Ui, glyph: &'a str, name: &str) -> Cow<'a, str> {
    if has(ui, glyph) {
        return Cow::Borrowed(glyph);
    }
    let name = legible(ui, name, "a type");
    let shown: String = name.chars().next().unwrap_or('?').to_uppercase().collect();
    report(ui, glyph, &shown, &format!("“{name}”"));
    Cow::Owned(shown)
}

/// The entry of a type in a menu. Glyphs stand in a column, since their widths differ and names begin below each other.
pub(super) fn entry(ui: &Ui, sign: &str, name: &str) -> Button<'static> {
    let size = TextStyle::Body.resolve(ui.style()).size;
    let sign = RichText::new(glyph(ui, sign, name)).atom_size(vec2(COLUMN * size, size));
    Button::new((sign, legible(ui, name, "a type").into_owned()))
}

/// Names such an entry for screen readers.
pub(super) fn says(ui: &Ui, entry: &Response, sign: &str, name: &str) {
    let says = format!("{}  {}", glyph(ui, sign, name), legible(ui, name, "a type"));
    entry.widget_info(|| WidgetInfo::labeled(WidgetType::Button, entry.enabled(), &says));
}

fn has(ui: &Ui, text: &str) -> bool {
    let font = TextStyle::Body.resolve(ui.style());
    // egui's own check reports every character of the font that contains the replacement box as missing.
    ui.fonts_mut(|fonts| {
        let mut font = fonts.fonts.font(&font.family);
        text.chars().all(|c| font.characters().contains_key(&c))
    })
}

/// Logs a replacement once.
fn report(ui: &Ui, text: &str, shown: &str, owner: &str) {
    let known = Id::new("glyphs reported");
    let new = ui.data_mut(|data| {
        data.get_temp_mut_or_default::<HashSet<(String, String)>>(known).insert((owner.into(), text.into()))
    });
    if new {
        let lacking: Vec<_> = text.chars().filter(|c| !has(ui, c.encode_utf8(&mut [0; 4]))).collect();
        let codes: Vec<_> = lacking.iter().map(|c| format!("U+{:04X}", u32::from(*c))).collect();
        warn!("The fonts have no glyph for {} in “{text}” of {owner}: shown as “{shown}”.", codes.join(", "));
    }
}
