//! Menus, drawn from the declarations.

use bevy_egui::egui::{
    Align, Atom, Atoms, Button, Checkbox, Id, Layout, RadioButton, Response, RichText, ScrollArea, Ui, vec2,
};

use super::{Command, Item, Mark, Menu, all};
use crate::{
    panel::{
        glyphs, menu, narrow,
        state::{Action, Session, ViewChange},
        theme::Palette,
    },
    registry::Registry,
};

/// Room for the longest entry and its key, points.
pub(super) const WIDTH: f32 = 232.0;

/// Shows what a menu has beside its entries, such as pictures. It begins at the right of another menu, which ends there.
pub(in crate::panel) type Special<'s> = &'s dyn Fn(&mut Ui, &Menu, f32, &mut Vec<Action>);

/// The entries of one of the menus, as they are now.
pub(in crate::panel) fn entries(
    ui: &mut Ui,
    name: &str,
    session: &Session,
    registry: &Registry,
    actions: &mut Vec<Action>,
) {
    if let Some(menu) = all(session, registry, false).find(name) {
        items(ui, menu, &|_, _, _, _| (), actions);
    }
}

/// The content of a menu.
pub(in crate::panel) fn content(ui: &mut Ui, menu: &Menu, special: Special, actions: &mut Vec<Action>) {
    if menu.width > 0.0 {
        let around = ui.spacing().menu_margin.sum().x;
        ui.set_width(narrow::wide(ui.ctx(), menu.width, around));
    }
    if !menu.scrolls {
        return items(ui, menu, special, actions);
    }
    let most = ui.ctx().content_rect().height() - 48.0;
    let area = ScrollArea::vertical().max_height(most).min_scrolled_height(most);
    area.show(ui, |ui| items(ui, menu, special, actions));
}

fn items(ui: &mut Ui, menu: &Menu, special: Special, actions: &mut Vec<Action>) {
    let offered = |item: &&Item| !matches!(item, Item::Command(command) if command.absent);
    let is_empty = !menu.items.iter().filter(offered).any(|item| !matches!(item, Item::Line));
    if is_empty && !menu.empty.is_empty() {
        ui.weak(menu.empty);
        return;
    }
    for item in menu.items.iter().filter(offered) {
        match item {
            Item::Line => _ = ui.separator(),
            Item::Menu(inner) => {
                let name = in_line(ui, menu, inner.shown.as_deref().unwrap_or(inner.name));
                let right = ui.max_rect().right();
                menu::submenu(ui, name, |ui| {
                    special(ui, inner, right, actions);
                    content(ui, inner, special, actions);
                });
            }
            Item::Command(command) => entry(ui, command, menu, actions),
        }
    }
}

/// The name of an entry without a mark. Beside entries with marks, it begins where their names do.
fn in_line<'a>(ui: &Ui, menu: &Menu, name: &'a str) -> Atoms<'a> {
    let is_marked = |item: &Item| matches!(item, Item::Command(command) if command.mark != Mark::None);
    let mut all = Atoms::new(name);
    if menu.items.iter().any(is_marked) {
        let width = ui.spacing().icon_width - ui.spacing().button_padding.x;
        all.push_left(Atom::custom(Id::new("room of a mark"), vec2(width, 0.0)));
    }
    all
}

/// The name of a command, with characters that the fonts have.
fn legible(ui: &Ui, command: &Command, name: &str) -> String {
    if !command.foreign {
        return name.to_owned();
    }
    glyphs::legible(ui, name, &format!("the command “{}”", command.id)).into_owned()
}

fn entry(ui: &mut Ui, command: &Command, menu: &Menu, actions: &mut Vec<Action>) {
    let name = legible(ui, command, &command.name);
    let keys = command.keys.first().map(ToString::to_string).unwrap_or_default();
    let enabled = command.why_not.is_none();
    let response = match command.mark {
        Mark::None => {
            let keys = RichText::new(keys).color(Palette::here(ui).weak);
            let button = match command.glyph {
                "" => Button::new(in_line(ui, menu, &name)),
                sign => glyphs::entry(ui, sign, &command.name),
            };
            // In a menu of a fixed width there is room for keys.
            let has_room = menu.width > 0.0 || !keys.is_empty();
            let button = if has_room { button.shortcut_text(keys) } else { button };
            let response = ui.add_enabled(enabled, button);
            if !command.glyph.is_empty() {
                glyphs::says(ui, &response, command.glyph, &command.name);
            }
            response
        }
        Mark::Check(mut on) => {
            let line = ui.horizontal(|ui| {
                let response = ui.add_enabled(enabled, Checkbox::new(&mut on, name));
                ui.with_layout(Layout::right_to_left(Align::Center), |ui| ui.weak(keys));
                response
            });
            line.inner
        }
        Mark::Radio(on) => ui.add_enabled(enabled, RadioButton::new(on, name)),
    };
    if response.clicked() {
        actions.push(command.action.clone());
        // A presentation has no menus.
        let leaves = command.action == Action::View(ViewChange::Presenting(true));
        if leaves || !menu.stays && !matches!(command.mark, Mark::Check(_)) {
            ui.close();
        }
    }
    explain(response, command);
}

/// The tooltip of an entry.
fn explain(response: Response, command: &Command) {
    let response = match &*command.tip {
        "" => response,
        tip => response.on_hover_text(tip),
    };
    if let Some(why) = &command.why_not {
        response.on_disabled_hover_text(format!("{}.", why.trim_end_matches('.')));
    }
}
