//! Knobs for choices.

use bevy_egui::egui::{self, Id, Popup, PopupCloseBehavior, RectAlign, Response, Ui, WidgetInfo, WidgetType};

use super::{
    Declared, Knob, flag_knob,
    line::{CHOICE, Caption, Words, button, choice_width, explain, head, knob, tooltip},
};
use crate::{
    panel::{chooser, menu, theme},
    parameter::{Value, kind::choice::Choice},
};

impl Knob for Choice {
    fn show(&self, ui: &mut Ui, of: &Declared, value: &Value) -> Option<Value> {
        // The name in files is a word, not a symbol of the equation.
        let symbol = if of.parameter.symbol == of.parameter.name { "" } else { of.caption.symbol };
        let caption = Caption { symbol, ..of.caption };
        if let Some(on) = value.truth() {
            return flag_knob(ui, &caption, on).map(Value::flag);
        }
        let Value::Choice(id) = value else { return None };
        let chosen = self.options.iter().position(|(option, _)| option == id).unwrap_or(0);
        let names: Vec<_> = self.options.iter().map(|(_, name)| *name).collect();
        let new = choice_knob(ui, &caption, chosen, &names)?;
        Some(Value::Choice(self.options[new].0.into()))
    }
}

/// A choice among many options: label at the left; a button at the right opens `list`, which receives its own id, until
/// that returns a value.
pub fn list_knob<R>(
    ui: &mut Ui,
    caption: &Caption,
    shown: &str,
    list: impl FnOnce(&mut Ui, Id) -> Option<R>,
) -> Option<R> {
    let id = ui.make_persistent_id(caption.salt);
    let (label, button) = button(ui, caption, shown, "▾", WidgetType::ComboBox);
    explain(label, |ui| tooltip(ui, caption, "", ""));
    let out = drop_down(&button, id, WIDE, list);
    if out.is_some() {
        Popup::close_id(ui.ctx(), id);
    }
    ui.add_space(4.0);
    out
}

/// Width of a list of models, in points: most authors fit beside the names.
pub(in crate::panel) const WIDE: f32 = 460.0;

/// The popup of a button, at most `width` points wide: `list`, which receives its own id.
pub(in crate::panel) fn drop_down<R>(
    button: &Response,
    id: Id,
    width: f32,
    list: impl FnOnce(&mut Ui, Id) -> Option<R>,
) -> Option<R> {
    let width = f32::min(width, button.ctx.content_rect().width() - 32.0);
    let list_id = id.with("list");
    let popup = Popup::from_toggle_button_response(button)
        .id(id)
        .align(RectAlign::BOTTOM_END)
        .width(width)
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            ui.set_width(width);
            list(ui, list_id)
        });
    if popup.is_none() {
        chooser::forget(&button.ctx, list_id);
    }
    popup.and_then(|popup| popup.inner)
}

/// A choice among several options: label at the left, list at the right. Returns the index of a new choice.
pub fn choice_knob(ui: &mut Ui, caption: &Caption, chosen: usize, options: &[&str]) -> Option<usize> {
    let plain: Vec<_> = options.iter().map(|name| [*name, "", ""]).collect();
    choice_with_help(ui, caption, chosen, &plain)
}

/// A choice with tooltips: each option has a name, an author and a summary; the latter two may be empty.
pub fn choice_with_help(
    ui: &mut Ui,
    caption: &Caption,
    chosen: usize,
    options: &[[&str; 3]],
) -> Option<usize> {
    knob(ui, caption, |ui| {
        let id = ui.make_persistent_id(caption.salt);
        let (label, out) = head(ui, caption, Words::Leave(CHOICE), |ui| {
            let width = choice_width(ui);
            let now = options.get(chosen).copied();
            let [shown, _, summary] = now.unwrap_or(["–", "", ""]);
            let mut by_key = false;
            let combo = egui::ComboBox::from_id_salt(id).width(width).truncate().selected_text(shown);
            let combo = combo.show_ui(ui, |ui| list(ui, chosen, options, &mut by_key));
            combo.response.widget_info(|| {
                WidgetInfo::labeled(WidgetType::ComboBox, true, format!("{}: {shown}", caption.label))
            });
            if by_key {
                combo.response.request_focus();
            }
            if caption.disabled.is_some() {
                explain(combo.response, |ui| tooltip(ui, caption, "", ""));
            } else if !summary.is_empty() {
                combo.response.on_hover_ui(|ui| now.into_iter().for_each(|now| tip(ui, now)));
            }
            combo.inner.flatten()
        });
        explain(label, |ui| tooltip(ui, caption, "", ""));
        ui.add_space(4.0);
        out
    })
}

/// The open list of options. Returns the index of a new choice.
fn list(ui: &mut Ui, chosen: usize, options: &[[&str; 3]], by_key: &mut bool) -> Option<usize> {
    let mut out = None;
    for (i, option) in options.iter().enumerate() {
        let response = menu::choice(ui, i == chosen, option[0], by_key);
        if response.clicked() && i != chosen {
            out = Some(i);
        }
        if !option[2].is_empty() {
            response.on_hover_ui(|ui| tip(ui, *option));
        }
    }
    out
}

fn tip(ui: &mut Ui, [name, author, summary]: [&str; 3]) {
    ui.set_max_width(300.0);
    ui.label(theme::strong(ui, name));
    ui.label(summary);
    if !author.is_empty() {
        ui.label(theme::small(ui, author));
    }
}
