//! The scene list at the left: room, observer, lights, objects.

use bevy_egui::egui::{
    self, Align2, FontId, Id, Key, Rect, ScrollArea, Sense, Stroke, TextEdit, TextStyle, Ui, WidgetInfo,
    WidgetType, pos2, vec2,
};

use super::{
    Panel, PanelContext, Place, focus, glyphs,
    icon::{self, Icon},
    is_panel, knob,
    lesson::point,
    state::{Action, Session},
    theme::{self, Palette},
};
use crate::document::{Edit, Selection};
use crate::{
    optics::colour::Encoding,
    parameter::{BASE_COLOUR, Value},
    registry::Registry,
    scene::{Light, Object, Part},
};

/// Height of a row, in points.
const HEIGHT: f32 = 26.0;

/// The scene list.
#[derive(Clone, Copy, Debug)]
pub struct Tree;

#[derive(Clone, Copy)]
enum Row {
    Part(Selection),
    Lights,
    Objects,
}

impl Panel for Tree {
    is_panel!("tree", "Scene", Place::Left);

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let (session, registry, actions) = (context.session(), context.registry(), &mut context.actions);
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
        actions.extend(step(ui, session).map(Action::Select));
        focus::first(ui.ctx(), row_id(session.selection));
        ui.spacing_mut().item_spacing.y = 0.0;
        let total = 4 + lights + objects;
        let mut area = ScrollArea::vertical().auto_shrink(false);
        let memory = ui.id().with("shown selection");
        if let Some(offset) = offset_of_selection(ui, memory, session) {
            area = area.vertical_scroll_offset(offset);
        }
        let output = area.show_rows(ui, HEIGHT, total, |ui, range| {
            for i in range {
                match row(i) {
                    Row::Part(part) => PartRow::of(part, session, registry).show(ui, actions),
                    Row::Lights => {
                        heading(ui, "Lights", lights, HEIGHT, |ui| add_lights(ui, registry, actions));
                    }
                    Row::Objects => {
                        heading(ui, "Objects", objects, HEIGHT, |ui| add_objects(ui, registry, actions));
                    }
                }
            }
        });
        ui.data_mut(|d| d.insert_temp(memory.with("offset"), output.state.offset.y));
    }
}

fn row_id(part: Selection) -> Id {
    Id::new(("row", part))
}

/// The offset that scrolls to a selection made elsewhere, if it is out of sight.
fn offset_of_selection(ui: &Ui, memory: Id, session: &Session) -> Option<f32> {
    let shown: Option<Selection> = ui.data(|d| d.get_temp(memory));
    if shown == Some(session.selection) {
        return None;
    }
    ui.data_mut(|d| d.insert_temp(memory, session.selection));
    let index = match session.selection {
        Selection::Room => 0,
        Selection::Observer => 1,
        Selection::Light(i) => 3 + i,
        Selection::Object(i) => 4 + session.document.lights.len() + i,
    };
    let (top, view) = (index as f32 * HEIGHT, ui.available_height());
    let offset: f32 = ui.data(|d| d.get_temp(memory.with("offset"))).unwrap_or(0.0);
    let out_of_sight = top < offset || top + HEIGHT > offset + view;
    out_of_sight.then(|| (top - 0.4 * view).max(0.0))
}

fn add_lights(ui: &mut Ui, registry: &Registry, actions: &mut Vec<Action>) {
    for light in registry.lights() {
        let d = light.declaration;
        add_item(ui, d.glyph, d.name, d.summary, Action::AddLight(d.id.to_owned()), actions);
    }
}

fn add_objects(ui: &mut Ui, registry: &Registry, actions: &mut Vec<Action>) {
    for shape in registry.shapes() {
        let d = shape.declaration;
        add_item(ui, d.glyph, d.name, d.summary, Action::AddObject(d.id.to_owned()), actions);
    }
}

/// The part that an arrow key moves to from the focused row. That part gets the focus.
fn step(ui: &Ui, session: &Session) -> Option<Selection> {
    let focus = ui.memory(egui::Memory::focused)?;
    let keys = [Key::ArrowUp, Key::ArrowDown];
    let way = keys.map(|key| ui.input(|i| i.num_presses(key)));
    if way == [0, 0] || ui.input(|i| i.modifiers.any()) || egui::Popup::is_any_open(ui.ctx()) {
        return None;
    }
    let lights = (0..session.document.lights.len()).map(Selection::Light);
    let objects = (0..session.document.objects.len()).map(Selection::Object);
    let parts: Vec<_> =
        [Selection::Room, Selection::Observer].into_iter().chain(lights).chain(objects).collect();
    let at = parts.iter().position(|part| row_id(*part) == focus)?;
    let next = parts[(at + way[1]).saturating_sub(way[0]).min(parts.len() - 1)];
    // Otherwise egui would move the focus once more, by geometry.
    ui.memory_mut(|m| {
        m.move_focus(egui::FocusDirection::None);
        m.request_focus(row_id(next));
    });
    Some(next)
}

fn add_item(ui: &mut Ui, glyph: &str, name: &str, summary: &str, action: Action, actions: &mut Vec<Action>) {
    let glyph = glyphs::glyph(ui, glyph, name);
    let response = ui.button(format!("{glyph}  {name}"));
    let response = if summary.is_empty() { response } else { response.on_hover_text(summary) };
    if response.clicked() {
        actions.push(action);
        ui.close();
    }
}

fn heading(ui: &mut Ui, name: &str, count: usize, height: f32, menu: impl FnOnce(&mut Ui)) {
    let palette = Palette::here(ui);
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
    let small = TextStyle::Small.resolve(ui.style());
    let text = ui.painter().text(
        pos2(rect.left() + 8.0, rect.bottom() - 5.0),
        Align2::LEFT_BOTTOM,
        name,
        FontId::new(small.size, theme::semibold()),
        palette.weak,
    );
    ui.painter().text(
        pos2(text.right() + 6.0, text.bottom()),
        Align2::LEFT_BOTTOM,
        count,
        small,
        palette.weak,
    );
    let place = Rect::from_min_size(pos2(rect.right() - 26.0, rect.top() + 2.0), vec2(22.0, 22.0));
    let mut child = ui.new_child(egui::UiBuilder::new().id_salt(name).max_rect(place));
    let what = if name == "Lights" { "Add a light" } else { "Add an object" };
    let response = icon::button(&mut child, Icon::Plus, what);
    egui::Popup::menu(&response).show(menu);
}

/// Width below which the list has tighter spacing, in points.
const NARROW: f32 = 190.0;

/// The row of a part.
struct PartRow<'a> {
    part: Selection,
    name: String,
    /// True for a light or an object.
    nested: bool,
    session: &'a Session,
    registry: &'a Registry,
}

impl<'a> PartRow<'a> {
    fn of(part: Selection, session: &'a Session, registry: &'a Registry) -> Self {
        let nested = matches!(part, Selection::Light(_) | Selection::Object(_));
        Self { part, name: session.name_of(part, registry), nested, session, registry }
    }

    fn show(&self, ui: &mut Ui, actions: &mut Vec<Action>) {
        let Self { part, ref name, nested, session, .. } = *self;
        let palette = Palette::here(ui);
        let selected = session.selection == part;
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
        let response = ui.interact(rect, row_id(part), Sense::click());
        response.widget_info(|| WidgetInfo::selected(WidgetType::SelectableLabel, true, selected, name));
        let hovered = ui.rect_contains_pointer(rect);
        point::part(ui, session, part, rect);
        let painter = ui.painter_at(rect);
        let ground = rect.shrink2(vec2(4.0, 0.0));
        if selected {
            painter.rect_filled(ground, 4.0, palette.chosen);
            let bar = Rect::from_min_size(ground.min, vec2(3.0, ground.height()));
            painter.rect_filled(bar, 1.5, palette.accent);
        } else if hovered {
            painter.rect_filled(ground, 4.0, palette.hovered);
        }
        let narrow = rect.width() < NARROW;
        let x = rect.left() + (if nested && !narrow { 22.0 } else { 16.0 });
        let square = Rect::from_center_size(pos2(x, rect.center().y), vec2(14.0, 14.0));
        let dot = self.sign(ui, &painter, square);
        let text_left = x + 14.0;
        if session.renaming == Some(part) {
            let place = Rect::from_min_max(
                pos2(text_left - 4.0, rect.top() + 2.0),
                pos2(ground.right() - 4.0, rect.bottom() - 2.0),
            );
            return self.rename(ui, place, actions);
        }
        let between = if narrow { 22.0 } else { 24.0 };
        let right = ground.right() - if nested { 2.0 * between } else { 8.0 };
        let colour = if is_there(session, part) { palette.text } else { palette.weak };
        let room = (right - text_left).max(8.0);
        let body = TextStyle::Body.resolve(ui.style());
        let (galley, cut) = theme::elided_within(ui, name, &body, colour, room);
        painter.galley(pos2(text_left, rect.center().y - galley.size().y / 2.0), galley, colour);
        if let Some(rgb) = dot {
            let centre = |from_right: f32| pos2(ground.right() - from_right, rect.center().y);
            self.toggle(ui, centre(1.5 * between), hovered, actions);
            self.colour_dot(ui, centre(0.5 * between), rgb, actions);
        }
        acted(ui, &response, part, nested, actions);
        response.context_menu(|ui| menu(ui, session, part, nested, actions));
        if cut {
            response.on_hover_text(name);
        }
    }

    /// Paints the icon or the glyph of a part. Returns the colour of a light or an object.
    fn sign(&self, ui: &Ui, painter: &egui::Painter, square: Rect) -> Option<[u8; 3]> {
        let Self { part, session, registry, .. } = *self;
        let palette = Palette::here(ui);
        let (sign, name, rgb) = match part {
            Selection::Room | Selection::Observer => {
                let icon = if part == Selection::Room { Icon::Room } else { Icon::Eye };
                icon::paint(painter, square, icon, palette.text);
                return None;
            }
            Selection::Light(i) => {
                let light = &session.document.lights[i];
                let known =
                    registry.light(&light.light_type).map(|e| (e.declaration.glyph, e.declaration.name));
                let (sign, name) = known.unwrap_or(("?", ""));
                (sign, name, light.rgb8())
            }
            Selection::Object(i) => {
                let object = &session.document.objects[i];
                let known =
                    registry.shape(&object.object_type).map(|e| (e.declaration.glyph, e.declaration.name));
                let (sign, name) = known.unwrap_or(("?", ""));
                let colour = object.material.colour(&BASE_COLOUR, Encoding::Off) * 255.0;
                (sign, name, [colour.x as u8, colour.y as u8, colour.z as u8])
            }
        };
        let font = FontId::new(14.0, TextStyle::Body.resolve(ui.style()).family);
        let sign = glyphs::glyph(ui, sign, name);
        painter.text(square.center(), Align2::CENTER_CENTER, sign, font, palette.text);
        Some(rgb)
    }

    /// The eye of an object, or the lamp of a light.
    fn toggle(&self, ui: &mut Ui, centre: egui::Pos2, row_hovered: bool, actions: &mut Vec<Action>) {
        let (palette, part) = (Palette::here(ui), self.part);
        let there = is_there(self.session, part);
        let says = format!("{} {}", toggle_words(part, there), self.name);
        let response = spot(ui, centre, ui.id().with(("toggle", part)), &says);
        let icon = match (part, there) {
            (Selection::Light(_), true) => Icon::Lamp,
            (Selection::Light(_), false) => Icon::LampOff,
            (_, true) => Icon::Eye,
            (_, false) => Icon::EyeOff,
        };
        let strong = row_hovered || !there || response.hovered();
        let colour = if strong { palette.text } else { palette.weak };
        let square = Rect::from_center_size(centre, vec2(13.0, 13.0));
        icon::paint(ui.painter(), square, icon, colour);
        if response.on_hover_text(format!("{says} (V for what is selected)")).clicked() {
            actions.push(Action::Toggle(part));
        }
    }

    /// The colour of a part, as a button that changes it.
    fn colour_dot(&self, ui: &mut Ui, centre: egui::Pos2, [r, g, b]: [u8; 3], actions: &mut Vec<Action>) {
        let (palette, part) = (Palette::here(ui), self.part);
        let says = format!("Colour of {}", self.name);
        let response = spot(ui, centre, ui.id().with(("dot", part)), &says);
        ui.painter().circle(centre, 4.5, egui::Color32::from_rgb(r, g, b), Stroke::new(1.0, palette.weak));
        egui::Popup::menu(&response).close_behavior(egui::PopupCloseBehavior::CloseOnClickOutside).show(
            |ui| {
                if let Some(rgb) = knob::picker(ui, response.id.with("picker"), &says, [r, g, b]) {
                    actions.extend(match part {
                        Selection::Light(i) => {
                            Some(Action::Edit(Edit::set(Part::Light(i), Light::colour, rgb)))
                        }
                        Selection::Object(i) => {
                            let edit = Edit::material(Part::Object(i), BASE_COLOUR.name, Value::Colour(rgb));
                            Some(Action::Edit(edit))
                        }
                        Selection::Room | Selection::Observer => None,
                    });
                }
            },
        );
        response.on_hover_text(&says);
    }

    fn rename(&self, ui: &mut Ui, place: Rect, actions: &mut Vec<Action>) {
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
        let done = response.lost_focus();
        if done || (!first && !response.has_focus()) {
            ui.data_mut(|d| d.remove::<String>(id));
            let given_up = ui.input(|i| i.key_pressed(Key::Escape)) || text.trim() == name.as_str();
            actions.push(match part {
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
fn acted(ui: &Ui, response: &egui::Response, part: Selection, nested: bool, actions: &mut Vec<Action>) {
    // The menu of a row applies to the selection.
    if response.clicked() || response.secondary_clicked() {
        actions.push(Action::Select(part));
    }
    if nested && response.has_focus() && ui.input(|i| i.key_pressed(Key::Delete)) {
        actions.push(Action::Remove(part));
    }
    if nested && response.double_clicked() {
        actions.push(Action::BeginRename(part));
    }
}

/// The context menu of a row.
fn menu(ui: &mut Ui, session: &Session, part: Selection, nested: bool, actions: &mut Vec<Action>) {
    let mut item = |ui: &mut Ui, text: &str, action: Action| {
        if ui.button(text).clicked() {
            actions.push(action);
            ui.close();
        }
    };
    if nested {
        item(ui, "Rename", Action::BeginRename(part));
        item(ui, "Duplicate", Action::Duplicate(part));
        item(ui, toggle_words(part, is_there(session, part)), Action::Toggle(part));
        ui.separator();
        item(ui, "Delete", Action::Remove(part));
    } else {
        item(ui, "Show properties", Action::Select(part));
    }
    if part == Selection::Observer {
        let problem = session.observer_problem();
        let place = |ui: &mut Ui| item(ui, "Set observer to this view", Action::ObserverFromView);
        let place = ui.add_enabled_ui(problem.is_none(), place).response;
        problem.map(|why| place.on_hover_text(why));
    }
}

/// False if a part is hidden or switched off.
fn is_there(session: &Session, part: Selection) -> bool {
    match part {
        Selection::Light(i) => session.document.lights.get(i).is_none_or(|light| light.enabled),
        Selection::Object(i) => session.document.objects.get(i).is_none_or(|object| object.visible),
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
fn spot(ui: &Ui, centre: egui::Pos2, id: egui::Id, says: &str) -> egui::Response {
    let rect = Rect::from_center_size(centre, vec2(22.0, 22.0));
    let response = ui.interact(rect, id, Sense::CLICK);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, says));
    if response.hovered() {
        ui.painter().rect_filled(rect, 4.0, Palette::here(ui).hovered);
    }
    response
}
