//! The scene list at the left: room, observer, lights, objects.

use std::ops::Range;

use bevy_egui::egui::TextEdit;

use super::{focus, glyphs, knob, lesson::point, narrow, prelude::*, state::Effect};
use crate::{
    optics::colour::Encoding,
    parameter::{BASE_COLOUR, Value},
    scene::{Light, Object},
};

/// Height of a row, in points.
const HEIGHT: f32 = 26.0;

/// Height of a row in this window.
fn height(ui: &Ui) -> f32 {
    narrow::high(ui.ctx(), HEIGHT)
}

#[derive(Clone, Copy)]
enum Row {
    Part(Selection),
    Lights,
    Objects,
}

/// The scene list.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    let (lights, objects) = (session.document.lights.len(), session.document.objects.len());
    // Rows are addressed by index, so that ten thousand objects cost no more than the visible ones.
    let row = |i: usize| match i {
        0 => Row::Part(Selection::Room),
        1 => Row::Part(Selection::Observer),
        2 => Row::Lights,
        i if i < 3 + lights => Row::Part(Selection::Light(i - 3)),
        i if i == 3 + lights => Row::Objects,
        i => Row::Part(Selection::Object(i - 4 - lights)),
    };
    let memory = ui.id().with("shown selection");
    context.actions.extend(step(ui, memory, &session.document));
    focus::first(ui.ctx(), row_id(session.selection));
    ui.spacing_mut().item_spacing.y = 0.0;
    let total = 4 + lights + objects;
    let mut area = ScrollArea::vertical().auto_shrink(false);
    if let Some(offset) = offset_of_selection(ui, memory, session) {
        area = area.vertical_scroll_offset(offset);
    }
    // Found once: a row has up to ten thousand copies.
    let chosen = match session.selection {
        Selection::Object(i) => session.document.row(i).map_or(0..0, |row| row.range()),
        _ => 0..0,
    };
    let output = area.show_rows(ui, height(ui), total, |ui, range| {
        for i in range {
            match row(i) {
                Row::Part(part) => PartRow::of(part, &chosen, context).show(ui, context),
                Row::Lights => heading(ui, "Lights", lights, |ui| add_lights(ui, context)),
                Row::Objects => heading(ui, "Objects", objects, |ui| add_objects(ui, context)),
            }
        }
    });
    ui.data_mut(|d| d.insert_temp(memory.with("offset"), output.state.offset.y));
}

fn row_id(part: Selection) -> Id {
    Id::new(("row", part))
}

/// The id of the other end of a range that is being selected.
fn range_end(memory: Id) -> Id {
    memory.with("end of a range")
}

/// The offset that scrolls to a selection made elsewhere, or to the end of a range, if it is out of sight.
fn offset_of_selection(ui: &Ui, memory: Id, session: &Session) -> Option<f32> {
    let (shown, end): (Option<Selection>, Option<Selection>) =
        ui.data(|d| (d.get_temp(memory), d.get_temp(range_end(memory))));
    let now = end.unwrap_or(session.selection);
    if shown == Some(now) {
        return None;
    }
    ui.data_mut(|d| d.insert_temp(memory, now));
    let index = match now {
        Selection::Room => 0,
        Selection::Observer => 1,
        Selection::Light(i) => 3 + i,
        Selection::Object(i) => 4 + session.document.lights.len() + i,
    };
    let height = height(ui);
    let (top, view) = (index as f32 * height, ui.available_height());
    let offset: f32 = ui.data(|d| d.get_temp(memory.with("offset"))).unwrap_or(0.0);
    let out_of_sight = top < offset || top + height > offset + view;
    out_of_sight.then(|| (top - 0.4 * view).max(0.0))
}

fn add_lights(ui: &mut Ui, context: &mut PanelContext<'_>) {
    for d in context.registry().lights().iter().map(|light| light.declaration) {
        add_item(ui, [d.glyph, d.name, d.summary], Action::AddLight(d.id.to_owned()), context);
    }
}

fn add_objects(ui: &mut Ui, context: &mut PanelContext<'_>) {
    for d in context.registry().shapes().iter().map(|shape| shape.declaration) {
        add_item(ui, [d.glyph, d.name, d.summary], Action::AddObject(d.id.to_owned()), context);
    }
}

/// Selects the part that an arrow key moves to from the focused row, with Shift all from the selection to it; it gets the
/// focus.
fn step(ui: &Ui, memory: Id, scene: &Scene) -> Option<Action> {
    let focus = ui.memory(egui::Memory::focused)?;
    let keys = [Key::ArrowUp, Key::ArrowDown];
    let way = keys.map(|key| ui.input(|i| i.num_presses(key)));
    let modifiers = ui.input(|i| i.modifiers);
    if way == [0, 0] || modifiers.command || modifiers.alt || Popup::is_any_open(ui.ctx()) {
        return None;
    }
    let lights = (0..scene.lights.len()).map(Selection::Light);
    let objects = (0..scene.objects.len()).map(Selection::Object);
    let parts: Vec<_> =
        [Selection::Room, Selection::Observer].into_iter().chain(lights).chain(objects).collect();
    let at = parts.iter().position(|part| row_id(*part) == focus)?;
    let next = parts[(at + way[1]).saturating_sub(way[0]).min(parts.len() - 1)];
    // Otherwise egui would move the focus once more, by geometry.
    ui.memory_mut(|m| {
        m.move_focus(egui::FocusDirection::None);
        m.request_focus(row_id(next));
    });
    ui.data_mut(|d| match modifiers.shift {
        true => _ = d.insert_temp(range_end(memory), next),
        false => d.remove::<Selection>(range_end(memory)),
    });
    Some(if modifiers.shift { Action::SelectRange(next) } else { Action::Select(next) })
}

fn add_item(ui: &mut Ui, [glyph, name, summary]: [&str; 3], action: Action, context: &mut PanelContext<'_>) {
    let entry = glyphs::entry(ui, glyph, name);
    let response = ui.add(entry);
    glyphs::says(ui, &response, glyph, name);
    let response = if summary.is_empty() { response } else { response.on_hover_text(summary) };
    if response.clicked() {
        context.act(action);
        ui.close();
    }
}

fn heading(ui: &mut Ui, name: &str, count: usize, menu: impl FnOnce(&mut Ui)) {
    let colour = Palette::here(ui).weak;
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), height(ui)), Sense::hover());
    let small = TextStyle::Small.resolve(ui.style());
    let (font, painter) = (FontId::new(small.size, theme::semibold()), ui.painter());
    let at = pos2(rect.left() + 8.0, rect.bottom() - 5.0);
    let text = painter.text(at, Align2::LEFT_BOTTOM, name, font, colour);
    painter.text(text.right_bottom() + vec2(6.0, 0.0), Align2::LEFT_BOTTOM, count, small, colour);
    let size = vec2(icon::SIZE, narrow::high(ui.ctx(), icon::SIZE));
    let top = rect.center().y - 0.5 * size.y;
    let place = Rect::from_min_size(pos2(rect.right() - 26.0, top), size);
    let mut child = ui.new_child(UiBuilder::new().id_salt(name).max_rect(place));
    let what = if name == "Lights" { "Add a light" } else { "Add an object" };
    let response = icon::button(&mut child, Icon::Plus, what);
    Popup::menu(&response).show(menu);
}

/// Width below which the list has tighter spacing, and names go before icons, in points.
const NARROW: f32 = 190.0;
/// Width below which the spacing is tighter still, in points.
const TIGHT: f32 = 150.0;

/// Spacing of a row: from its left to the middle of the sign, from there to the name, and the width of a column of icons.
fn spacing(width: f32, nested: bool) -> [f32; 3] {
    match width {
        width if width < TIGHT => [13.0, 11.0, 17.0],
        width if width < NARROW => [16.0, 14.0, 22.0],
        _ => [if nested { 22.0 } else { 16.0 }, 14.0, 24.0],
    }
}

/// The number of columns behind a name in a narrow list: switch and colour, or the switch alone, or none, so that the name
/// has its room. The switch of what is off stays. A row under the pointer has both.
fn columns(name: f32, room: f32, between: f32, is_there: bool) -> usize {
    let fits = |count: usize| name <= room - (count as f32 * between).max(4.0);
    let least = usize::from(!is_there);
    (least..=2).rev().find(|count| fits(*count)).unwrap_or(least)
}

/// The row of a part.
struct PartRow<'a> {
    part: Selection,
    name: String,
    /// True for a light or an object.
    nested: bool,
    /// True for the copies of the row that is edited.
    is_in_chosen_row: bool,
    session: &'a Session,
    registry: &'a Registry,
}

impl<'a> PartRow<'a> {
    /// `chosen` are the objects of the row that is edited.
    fn of(part: Selection, chosen: &Range<usize>, context: &PanelContext<'a>) -> Self {
        let (session, registry) = (context.session(), context.registry());
        let nested = matches!(part, Selection::Light(_) | Selection::Object(_));
        let is_in_chosen_row = matches!(part, Selection::Object(i) if chosen.contains(&i));
        Self { part, name: session.name_of(part, registry), nested, is_in_chosen_row, session, registry }
    }

    fn show(&self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let Self { part, ref name, nested, session, .. } = *self;
        let palette = Palette::here(ui);
        let selected = session.is_selected(part);
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), height(ui)), Sense::hover());
        let response = ui.interact(rect, row_id(part), Sense::click());
        theme::says_chosen(&response, WidgetType::SelectableLabel, selected, name);
        let hovered = ui.rect_contains_pointer(rect);
        point::part(ui, session, part, rect);
        let painter = ui.painter_at(rect);
        let ground = rect.shrink2(vec2(4.0, 0.0));
        if selected {
            painter.rect_filled(ground, 4.0, palette.chosen);
            // Of several, the first has the longest bar: ranges begin there.
            let inset = if session.selection == part { 0.0 } else { 0.3 * ground.height() };
            let bar = Rect::from_min_size(ground.min, vec2(3.0, ground.height())).shrink2(vec2(0.0, inset));
            painter.rect_filled(bar, 1.5, palette.accent);
        } else if hovered || self.is_in_chosen_row {
            painter.rect_filled(ground, 4.0, palette.hovered);
        }
        let [indent, gap, between] = spacing(rect.width(), nested);
        let x = rect.left() + indent;
        let square = Rect::from_center_size(pos2(x, rect.center().y), vec2(14.0, 14.0));
        let dot = self.sign(ui, &painter, square);
        let text_left = x + gap;
        if session.renaming == Some(part) {
            let place =
                rect.shrink2(vec2(0.0, 2.0)).with_min_x(text_left - 4.0).with_max_x(ground.right() - 4.0);
            return self.rename(ui, place, context);
        }
        let body = TextStyle::Body.resolve(ui.style());
        let columns = match nested {
            true if rect.width() < NARROW && !hovered => {
                self.columns(ui, ground.right() - text_left, between)
            }
            _ => 2 * usize::from(nested),
        };
        let right = ground.right() - (columns as f32 * between).max(if nested { 4.0 } else { 8.0 });
        let colour = if is_there(&session.document, part) { palette.text } else { palette.weak };
        let room = (right - text_left).max(8.0);
        let (galley, cut) = theme::elided_within(ui, name, &body, colour, room);
        painter.galley(pos2(text_left, rect.center().y - galley.size().y / 2.0), galley, colour);
        if let Some(rgb) = dot {
            self.buttons(ui, ground, [columns as f32, between], rgb, context);
        }
        acted(ui, &response, part, nested, context);
        response.context_menu(|ui| menu(ui, part, nested, context));
        if cut {
            response.on_hover_text(name);
        }
    }

    /// The number of columns behind the name in a narrow list.
    fn columns(&self, ui: &Ui, room: f32, between: f32) -> usize {
        let body = TextStyle::Body.resolve(ui.style());
        let name = theme::width_in(ui, &self.name, &body);
        columns(name, room, between, is_there(&self.session.document, self.part))
    }

    /// The switch and the colour of a light or an object, as far as so many columns of a width have room for them.
    fn buttons(
        &self,
        ui: &mut Ui,
        row: Rect,
        [columns, width]: [f32; 2],
        rgb: [u8; 3],
        context: &mut PanelContext<'_>,
    ) {
        let high = narrow::high(ui.ctx(), icon::SIZE);
        let place = |column: f32| {
            let centre = pos2(row.right() - (column - 0.5) * width, row.center().y);
            Rect::from_center_size(centre, vec2(width.min(icon::SIZE), high))
        };
        if columns > 0.5 {
            self.toggle(ui, place(columns), ui.rect_contains_pointer(row), context);
        }
        if columns > 1.5 {
            self.colour_dot(ui, place(1.0), rgb, context);
        }
    }

    /// Paints the icon or the glyph of a part. Returns the colour of a light or an object.
    fn sign(&self, ui: &Ui, painter: &egui::Painter, square: Rect) -> Option<[u8; 3]> {
        let Self { part, session, registry, .. } = *self;
        let palette = Palette::here(ui);
        let (known, rgb) = match part {
            Selection::Room | Selection::Observer => {
                let icon = if part == Selection::Room { Icon::Room } else { Icon::Eye };
                icon::paint(painter, square, icon, palette.text);
                return None;
            }
            Selection::Light(i) => {
                let light = &session.document.lights[i];
                let known = registry.light(&light.light_type).map(|e| e.declaration);
                (known.map(|d| (d.glyph, d.name)), light.rgb8())
            }
            Selection::Object(i) => {
                let object = &session.document.objects[i];
                let known = registry.shape(&object.object_type).map(|e| e.declaration);
                let colour = object.material.colour(&BASE_COLOUR, Encoding::Off) * 255.0;
                (known.map(|d| (d.glyph, d.name)), colour.to_array().map(|c| c as u8))
            }
        };
        let font = FontId::new(14.0, TextStyle::Body.resolve(ui.style()).family);
        let (sign, name) = known.unwrap_or(("?", ""));
        let sign = glyphs::glyph(ui, sign, name);
        painter.text(square.center(), Align2::CENTER_CENTER, sign, font, palette.text);
        Some(rgb)
    }

    /// The eye of an object, or the lamp of a light.
    fn toggle(&self, ui: &mut Ui, place: Rect, row_hovered: bool, context: &mut PanelContext<'_>) {
        let (palette, part) = (Palette::here(ui), self.part);
        let there = is_there(&self.session.document, part);
        let says = format!("{} {}", toggle_words(part, there), self.name);
        let response = spot(ui, place, ui.id().with(("toggle", part)), &says);
        let icon = match (part, there) {
            (Selection::Light(_), true) => Icon::Lamp,
            (Selection::Light(_), false) => Icon::LampOff,
            (_, true) => Icon::Eye,
            (_, false) => Icon::EyeOff,
        };
        let strong = row_hovered || !there || response.hovered();
        let colour = if strong { palette.text } else { palette.weak };
        icon::paint(ui.painter(), Rect::from_center_size(place.center(), vec2(13.0, 13.0)), icon, colour);
        if response.on_hover_text(format!("{says} (V for what is selected)")).clicked() {
            context.act(Action::Toggle(part));
        }
    }

    /// The colour of a part, as a button that changes it.
    fn colour_dot(&self, ui: &mut Ui, place: Rect, [r, g, b]: [u8; 3], context: &mut PanelContext<'_>) {
        let (palette, part) = (Palette::here(ui), self.part);
        let says = format!("Colour of {}", self.name);
        let response = spot(ui, place, ui.id().with(("dot", part)), &says);
        ui.painter().circle(place.center(), 4.5, Color32::from_rgb(r, g, b), Stroke::new(1.0, palette.weak));
        let popup = Popup::menu(&response);
        popup.close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
            let chosen = knob::picker(ui, response.id.with("picker"), &says, [r, g, b]);
            context.edits(chosen.map(|rgb| match part {
                Selection::Light(i) => Edit::set(Part::Light(i), Light::colour, rgb),
                _ => Edit::material(part.into(), BASE_COLOUR.name, Value::Colour(rgb)),
            }));
        });
        response.on_hover_text(&says);
    }

    fn rename(&self, ui: &mut Ui, place: Rect, context: &mut PanelContext<'_>) {
        let Self { part, ref name, session, .. } = *self;
        let id = ui.id().with(("rename", part));
        let own = match part {
            Selection::Light(i) => session.document.lights[i].name.clone(),
            Selection::Object(i) => session.document.objects[i].name.clone(),
            _ => None,
        };
        let first = ui.data(|d| d.get_temp::<String>(id)).is_none();
        let mut text: String =
            ui.data(|d| d.get_temp(id)).unwrap_or_else(|| own.unwrap_or_else(|| name.clone()));
        let response =
            ui.put(place, TextEdit::singleline(&mut text).id(id.with("text")).desired_width(place.width()));
        theme::names_field(&response, &format!("New name of {name}"), [name, &text, ""]);
        if first {
            response.request_focus();
            // Typing replaces the old name.
            theme::select_all(ui, response.id, &text);
        }
        if response.lost_focus() || (!first && !response.has_focus()) {
            ui.data_mut(|d| d.remove::<String>(id));
            let given_up = ui.input(|i| i.key_pressed(Key::Escape)) || text.trim() == name.as_str();
            context.act(match part {
                _ if given_up => Action::CancelRename,
                Selection::Light(i) => Action::Edit(Edit::set(Part::Light(i), Light::name, text)),
                Selection::Object(i) => Action::Edit(Edit::set(Part::Object(i), Object::name, text)),
                _ => Action::CancelRename,
            });
        } else {
            ui.data_mut(|d| d.insert_temp(id, text));
        }
    }
}

/// Clicks on a row, and keys while it has the focus.
fn acted(ui: &Ui, response: &Response, part: Selection, nested: bool, context: &mut PanelContext<'_>) {
    let modifiers = ui.input(|i| i.modifiers);
    if response.clicked() {
        context.act(match modifiers {
            held if nested && held.shift => Action::SelectRange(part),
            held if nested && held.command => Action::SelectAlso(part),
            _ => Action::Select(part),
        });
    }
    // The menu of a row applies to the selection.
    if response.secondary_clicked() && !context.session().is_selected(part) {
        context.act(Action::Select(part));
    }
    if nested && response.has_focus() && ui.input(|i| i.key_pressed(Key::Delete)) {
        context.act(Action::Remove(part));
    }
    if nested && response.double_clicked() && !modifiers.any() {
        context.act(Action::BeginRename(part));
    }
}

/// The context menu of a row.
fn menu(ui: &mut Ui, part: Selection, nested: bool, context: &mut PanelContext<'_>) {
    let session = context.session();
    let mut item = |ui: &mut Ui, text: &str, action: Action| {
        if ui.button(text).clicked() {
            context.act(action);
            ui.close();
        }
    };
    if nested {
        // Of several that are selected, all but the name.
        item(ui, "Rename", Action::BeginRename(part));
        item(ui, "Duplicate", Action::Duplicate(part));
        item(ui, toggle_words(part, is_there(&session.document, part)), Action::Toggle(part));
        if matches!(part, Selection::Object(_)) {
            item(ui, "Hide the others", Action::HideOthers);
        }
        ui.separator();
        item(ui, "Delete", Action::Remove(part));
    } else {
        item(ui, "Show properties", Action::Select(part));
    }
    if part == Selection::Observer {
        let problem = session.observer_problem();
        let place = |ui: &mut Ui| item(ui, "Set observer to this view", Action::Do(Effect::ObserverFromView));
        let place = ui.add_enabled_ui(problem.is_none(), place).response;
        problem.map(|why| place.on_hover_text(why));
    }
}

/// False if a part is hidden or switched off.
fn is_there(scene: &Scene, part: Selection) -> bool {
    match part {
        Selection::Light(i) => scene.lights.get(i).is_none_or(|light| light.enabled),
        Selection::Object(i) => scene.objects.get(i).is_none_or(|object| object.visible),
        Selection::Room | Selection::Observer => true,
    }
}

fn toggle_words(part: Selection, there: bool) -> &'static str {
    match (part, there) {
        (Selection::Light(_), true) => "Switch off",
        (Selection::Light(_), false) => "Switch on",
        (_, true) => "Hide",
        (_, false) => "Show",
    }
}

/// A small clickable area in a row. Tab skips it, since the row offers the same action by keyboard.
fn spot(ui: &Ui, rect: Rect, id: Id, says: &str) -> Response {
    let response = ui.interact(rect, id, Sense::CLICK);
    theme::says(&response, WidgetType::Button, says);
    if response.hovered() {
        ui.painter().rect_filled(rect, 4.0, Palette::here(ui).hovered);
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn in_a_narrow_list_names_go_before_icons() {
        let of = |name: f32| [true, false].map(|is_there| columns(name, 70.0, 17.0, is_there));
        assert_eq!(of(30.0), [2, 2]);
        assert_eq!(of(50.0), [1, 1]);
        assert_eq!(of(60.0), [0, 1], "what is off says so");
        assert_eq!(of(300.0), [0, 1]);
    }
}
