//! The chooser of reflection models: families as headings, name, author and year; type to search.

use bevy_egui::egui::{
    self, Button, Id, Key, Modifiers, Popup, PopupCloseBehavior, RichText, ScrollArea, Sense, TextEdit, Ui,
    WidgetInfo, WidgetType, pos2, vec2,
};

use super::{
    state::{Action, Edit, Lab, ViewChange},
    theme::{self, Palette},
};
use crate::{reflection::ModelEntry, registry::Registry};

/// The models that a search finds, in the order in which the chooser lists them: by family, then in
/// the order of registration. Every word of the search must occur in name, id, author, family or
/// summary.
#[must_use]
pub fn find<'a>(registry: &'a Registry, search: &str) -> Vec<&'a ModelEntry> {
    let plain = |s: &str| s.to_lowercase().replace(['–', '-', '_'], " ");
    let words: Vec<String> = plain(search).split_whitespace().map(str::to_owned).collect();
    let mut families = Vec::new();
    for model in registry.models() {
        if !families.contains(&model.declaration.family) {
            families.push(model.declaration.family);
        }
    }
    let hit = |m: &&ModelEntry| {
        let d = m.declaration;
        let all = plain(&[d.name, d.id, d.author, d.family.name(), d.summary].join(" "));
        words.iter().all(|w| all.contains(w.as_str()))
    };
    families
        .iter()
        .flat_map(|f| registry.models().iter().filter(move |m| m.declaration.family == *f))
        .filter(hit)
        .collect()
}

/// The button and, when it is open, the list.
pub fn show(ui: &mut Ui, lab: &Lab, registry: &Registry) -> Vec<Action> {
    let mut actions = Vec::new();
    let scale = theme::scale_here(ui);
    let palette = Palette::here(ui);
    let id = Id::new("reflection chooser");
    let current = registry.model(&lab.scene.reflection_model).map(|m| m.declaration);
    let name = current.map_or(lab.scene.reflection_model.as_str(), |d| d.name);
    let button = Button::new(theme::strong(ui, name))
        .right_text(RichText::new("▾").color(palette.weak))
        .min_size(vec2(132.0, 24.0) * scale)
        .truncate();
    let response = ui.add(button);
    response
        .widget_info(|| WidgetInfo::labeled(WidgetType::ComboBox, true, format!("Reflection model: {name}")));
    if response.clicked() {
        actions.push(Action::View(ViewChange::Chooser(!lab.view.chooser_open)));
    }
    if !lab.view.chooser_open
        && let Some(d) = current
    {
        response.clone().on_hover_ui(|ui| {
            ui.set_max_width(320.0 * scale);
            ui.label(theme::strong(ui, d.name));
            ui.label(d.summary);
            ui.label(theme::small(ui, format!("{} · key R chooses another", d.source)));
        });
    }
    let search_id = id.with("search");
    let row_id = id.with("row");
    if !lab.view.chooser_open {
        ui.data_mut(|d| {
            d.remove::<String>(search_id);
            d.remove::<usize>(row_id);
        });
        return actions;
    }
    let mut search: String = ui.data(|d| d.get_temp(search_id)).unwrap_or_default();
    let found = find(registry, &search);
    let start = found.iter().position(|m| m.declaration.id == lab.scene.reflection_model).unwrap_or(0);
    let before: Option<usize> = ui.data(|d| d.get_temp(row_id));
    let mut row = before.unwrap_or(start).min(found.len().saturating_sub(1));
    let mut chosen = None;
    let mut moved = before.is_none();
    ui.input_mut(|i| {
        if i.consume_key(Modifiers::NONE, Key::ArrowDown) && row + 1 < found.len() {
            (row, moved) = (row + 1, true);
        }
        if i.consume_key(Modifiers::NONE, Key::ArrowUp) && row > 0 {
            (row, moved) = (row - 1, true);
        }
        if i.consume_key(Modifiers::NONE, Key::Enter) {
            chosen = found.get(row).map(|m| m.declaration.id);
        }
    });
    let mut open = true;
    let width = 400.0 * scale;
    Popup::from_response(&response)
        .id(id)
        .open_bool(&mut open)
        .width(width)
        .close_behavior(PopupCloseBehavior::CloseOnClickOutside)
        .show(|ui| {
            ui.set_width(width);
            let edit = TextEdit::singleline(&mut search)
                .id(id.with("text"))
                .hint_text("Search: name, author, year")
                .desired_width(f32::INFINITY);
            let edit = ui.add(edit);
            edit.widget_info(|| {
                let mut info = WidgetInfo::text_edit(true, "", &search, "");
                info.label = Some("Search reflection models".to_owned());
                info
            });
            if before.is_none() {
                edit.request_focus();
            }
            if edit.changed() {
                row = 0;
                ui.data_mut(|d| d.insert_temp(search_id, search.clone()));
            }
            ui.add_space(4.0 * scale);
            ScrollArea::vertical().max_height(420.0 * scale).show(ui, |ui| {
                ui.set_width(ui.available_width());
                if found.is_empty() {
                    ui.weak("No model has that in its name, author, year or description.");
                }
                let mut family = None;
                for (i, model) in found.iter().enumerate() {
                    let d = model.declaration;
                    if family != Some(d.family) {
                        family = Some(d.family);
                        ui.add_space(if i == 0 { 0.0 } else { 6.0 * scale });
                        ui.label(theme::small(ui, d.family.name()));
                    }
                    let response = model_row(ui, lab, model, i == row);
                    if i == row && moved {
                        response.scroll_to_me(None);
                    }
                    if response.hovered() && ui.input(|i| i.pointer.delta() != egui::Vec2::ZERO) {
                        row = i;
                    }
                    if response.clicked() {
                        chosen = Some(d.id);
                    }
                    response.on_hover_ui(|ui| {
                        ui.set_max_width(320.0 * scale);
                        ui.label(d.summary);
                        for (law, holds) in d.laws.list() {
                            ui.label(theme::small(
                                ui,
                                format!("{} {law}", if holds { "✓" } else { "✗ not" }),
                            ));
                        }
                        ui.label(theme::small(ui, d.source));
                    });
                }
            });
            ui.separator();
            ui.label(theme::small(
                ui,
                "↑ ↓ Enter choose · Esc closes · 1–9 choose the numbered ones without this list",
            ));
        });
    ui.data_mut(|d| d.insert_temp(row_id, row));
    if let Some(model) = chosen {
        actions.push(Action::Edit(Edit::Model(model.to_owned())));
        open = false;
    }
    if !open {
        actions.push(Action::View(ViewChange::Chooser(false)));
    }
    actions
}

fn model_row(ui: &mut Ui, lab: &Lab, model: &ModelEntry, marked: bool) -> egui::Response {
    let palette = Palette::here(ui);
    let scale = theme::scale_here(ui);
    let d = model.declaration;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 26.0 * scale), Sense::click());
    let current = d.id == lab.scene.reflection_model;
    response.widget_info(|| WidgetInfo::selected(WidgetType::SelectableLabel, true, current, d.name));
    if ui.is_rect_visible(rect) {
        let painter = ui.painter_at(rect);
        if marked {
            painter.rect_filled(rect, 4.0, palette.chosen);
        }
        if current {
            painter.rect_filled(
                egui::Rect::from_min_size(rect.min, vec2(3.0, rect.height())),
                1.0,
                palette.accent,
            );
        }
        let y = rect.center().y;
        let body = egui::TextStyle::Body.resolve(ui.style());
        let small = egui::TextStyle::Small.resolve(ui.style());
        if let Some(slot) = lab.model_slots.iter().position(|m| m == d.id) {
            painter.text(
                pos2(rect.left() + 16.0 * scale, y),
                egui::Align2::CENTER_CENTER,
                slot + 1,
                small.clone(),
                palette.weak,
            );
        }
        let at = pos2(rect.left() + 30.0 * scale, y);
        let name = painter.text(at, egui::Align2::LEFT_CENTER, d.name, body, palette.text);
        let author = ui.painter().layout_no_wrap(d.author.to_owned(), small, palette.weak);
        let x = (rect.right() - 6.0 * scale - author.size().x).max(name.right() + 8.0 * scale);
        painter.galley(pos2(x, y - author.size().y / 2.0), author, palette.weak);
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_model_is_listed_and_words_in_any_order_find_it() {
        let registry = Registry::builtin();
        assert_eq!(find(&registry, "").len(), registry.models().len());
        let ids = |s: &str| find(&registry, s).iter().map(|m| m.declaration.id).collect::<Vec<_>>();
        assert_eq!(ids("1977 blinn phong"), ["blinn_phong"]);
        assert!(ids("no such model").is_empty());
    }
}
