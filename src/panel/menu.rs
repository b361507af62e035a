//! Menus and drop-down lists by keyboard: arrows walk through them, open what hangs at an entry, and change menus.

use bevy_egui::egui::{
    ComboBox, Event, IntoAtoms, Modifiers, Order,
    containers::menu::{MenuState, SubMenu},
};

use super::{
    focus::{focused, next_region, stops},
    prelude::*,
    state::FocusMove,
    theme::says,
};

/// Number of passes within which a menu is shown; one without entries never gets the focus.
const PATIENCE: u64 = 4;

/// The known state of the menus.
#[derive(Clone, Default)]
struct Known {
    /// The menu to open or close as soon as the bar is shown, and the last pass in which it can.
    asked: Option<(&'static str, u64)>,
    /// The menu whose first entry gets the focus as soon as it is shown, and the last pass in which it can.
    entered: Option<(Id, u64)>,
    /// A list and its entry that is chosen now: where arrow keys begin.
    current: Option<(Id, Id)>,
    /// The chosen entry of the list that is open, and the first and the latest pass that showed it.
    seen: Option<(Id, u64, u64)>,
}

fn enter(ctx: &Context, menu: Id) {
    let last = ctx.cumulative_pass_nr() + PATIENCE;
    kept::with(ctx, |known: &mut Known| known.entered = Some((menu, last)));
    ctx.request_repaint();
}

/// Moves the keyboard focus if that is the action.
pub(super) fn moves_focus(ctx: &Context, action: &Action) -> bool {
    let Action::Focus(to) = action else { return false };
    match to {
        FocusMove::NextPanel => next_region(ctx, false),
        FocusMove::PreviousPanel => next_region(ctx, true),
        FocusMove::Menu(name) => {
            let last = ctx.cumulative_pass_nr() + PATIENCE;
            kept::with(ctx, |known: &mut Known| known.asked = Some((name, last)));
        }
    }
    ctx.request_repaint();
    true
}

/// The bar of menus: opens the one that is asked for; Left and Right go to the neighbours. One that is alone holds all
/// others.
pub(super) fn bar(ctx: &Context, menus: &[(&str, Response)]) {
    let asked = kept::with(ctx, |known: &mut Known| known.asked.take());
    // A question or a choice that must be dealt with first has the keys.
    if ctx.memory(egui::Memory::top_modal_layer).is_some() {
        return;
    }
    let in_one = menus.len() == 1;
    let ids: Vec<Id> = menus.iter().map(|(_, button)| Popup::default_response_id(button)).collect();
    let open = ids.iter().position(|id| Popup::is_id_open(ctx, *id));
    let count = ids.len();
    let sideways = ctx.input_mut(|input| {
        let at = open.filter(|_| !in_one)?;
        let right = input.consume_key(Modifiers::NONE, Key::ArrowRight).then_some((at + 1) % count);
        right.or_else(|| {
            input.consume_key(Modifiers::NONE, Key::ArrowLeft).then_some((at + count - 1) % count)
        })
    });
    let asked = asked.filter(|(_, last)| ctx.cumulative_pass_nr() <= *last);
    let place = |name: &str| menus.iter().position(|(menu, _)| *menu == name).or(in_one.then_some(0));
    let asked = asked.and_then(|(name, _)| place(name));
    let Some(wanted) = asked.or(sideways) else { return };
    ctx.memory_mut(|m| m.move_focus(egui::FocusDirection::None));
    if open == Some(wanted) {
        Popup::close_id(ctx, ids[wanted]);
        return;
    }
    Popup::open_id(ctx, ids[wanted]);
    enter(ctx, ids[wanted]);
}

/// A menu at an entry of another one: Right or Enter goes into it, Left back to the entry.
pub(super) fn submenu<'a>(ui: &mut Ui, text: impl IntoAtoms<'a>, content: impl FnOnce(&mut Ui)) {
    let response = ui.menu_button(text, content).response;
    let id = SubMenu::id_from_widget_id(response.id);
    let open = MenuState::from_ui(ui, |menu, _| menu.open_item == Some(id));
    let pressed = |key| ui.input_mut(|input| input.consume_key(Modifiers::NONE, key));
    let here = response.has_focus();
    if here && response.enabled() && pressed(Key::ArrowRight) {
        // egui forgets what is open and was never shown.
        MenuState::mark_shown(ui.ctx(), id);
        MenuState::from_ui(ui, |menu, _| menu.open_item = Some(id));
        enter(ui.ctx(), id);
    } else if here && open && response.clicked() {
        enter(ui.ctx(), id);
    }
    let within = || here || focused(ui.ctx()).is_some_and(|w| w.layer_id.id == id);
    if open && within() && pressed(Key::ArrowLeft) {
        MenuState::from_ui(ui, |menu, _| menu.open_item = None);
        response.request_focus();
    }
}

/// An entry of a drop-down list. It closes the list by key as by a click; `by_key` tells them apart, since then the
/// focus goes back to the button.
pub(super) fn choice(ui: &mut Ui, chosen: bool, text: impl Into<String>, by_key: &mut bool) -> Response {
    let text: String = text.into();
    let response = ui.selectable_label(chosen, text);
    if chosen {
        let pass = ui.ctx().cumulative_pass_nr();
        let first = kept::with(ui.ctx(), |known: &mut Known| {
            known.current = Some((response.layer_id.id, response.id));
            let before = known.seen.filter(|(id, _, last)| *id == response.id && pass <= last + 1);
            let first = before.map_or(pass, |(_, first, _)| first);
            known.seen = Some((response.id, first, pass));
            first
        });
        // A list opens with what is chosen in sight. Its height is known after its first pass.
        if pass <= first + PATIENCE && !ui.clip_rect().contains_rect(response.rect) {
            response.scroll_to_me_animation(None, egui::style::ScrollAnimation::none());
            ui.ctx().request_repaint();
        }
    }
    if response.clicked() {
        *by_key = response.has_focus();
        ui.close();
    }
    response
}

/// A drop-down list of options, each with a tooltip, as it is named for screen readers. Returns its button, and the index
/// of the option that was clicked.
pub(super) fn list(
    ui: &mut Ui,
    combo: ComboBox,
    name: &str,
    options: &[&str],
    chosen: Option<usize>,
    tip: impl Fn(&mut Ui, usize),
) -> (Response, Option<usize>) {
    let shown = chosen.map_or("–", |i| options[i]);
    let (mut picked, mut by_key) = (None, false);
    let menu = combo.selected_text(shown).show_ui(ui, |ui| {
        for (i, option) in options.iter().enumerate() {
            let response = choice(ui, chosen == Some(i), *option, &mut by_key);
            picked = response.clicked().then_some(i).or(picked);
            response.on_hover_ui(|ui| tip(ui, i));
        }
    });
    says(&menu.response, WidgetType::ComboBox, format!("{name}: {shown}"));
    if by_key {
        menu.response.request_focus();
    }
    (menu.response, picked)
}

/// Steps that the arrow keys ask of a menu, downwards. The others open and close what hangs at an entry, and change
/// menus (see [`submenu`] and [`bar`]): they do not move the focus.
fn steps(ctx: &Context) -> isize {
    let (mut step, mut stays) = (0, false);
    ctx.input_mut(|input| {
        input.events.retain(|event| {
            let Event::Key { key, pressed: true, modifiers: Modifiers::NONE, .. } = event else {
                return true;
            };
            match key {
                Key::ArrowDown => step += 1,
                Key::ArrowUp => step -= 1,
                _ => stays |= [Key::ArrowLeft, Key::ArrowRight].contains(key),
            }
            ![Key::ArrowDown, Key::ArrowUp].contains(key)
        });
    });
    if stays {
        ctx.memory_mut(|m| m.move_focus(egui::FocusDirection::None));
    }
    step
}

/// Lets the arrow keys walk through an open menu or list, however it was opened. Call before the widgets see the keys.
pub(super) fn walk(ctx: &Context) {
    if !Popup::is_any_open(ctx) || ctx.text_edit_focused() {
        return;
    }
    // A widget that is dragged, such as a colour picker, has the arrows to itself.
    let now = focused(ctx).filter(|w| w.layer_id.order == Order::Foreground);
    if now.is_some_and(|w| w.sense.senses_drag()) {
        return;
    }
    let mut step = steps(ctx);
    let Known { entered, current, .. } = kept::get(ctx);
    let entering = entered.filter(|(_, last)| ctx.cumulative_pass_nr() <= *last).map(|(menu, _)| menu);
    if entering.is_some() {
        step = 1;
    }
    if step == 0 {
        return;
    }
    let top = || ctx.memory(|m| m.areas().top_layer_id(Order::Foreground)).map(|layer| layer.id);
    let menu = entering.or_else(|| now.map(|w| w.layer_id.id)).or_else(top);
    let stops = stops(ctx, |w| {
        w.layer_id.order == Order::Foreground && Some(w.layer_id.id) == menu && !w.sense.senses_drag()
    });
    if stops.is_empty() {
        ctx.request_repaint();
        return;
    }
    kept::with(ctx, |known: &mut Known| known.entered = None);
    let count = stops.len() as isize;
    let chosen = current.filter(|(list, _)| Some(*list) == menu);
    let at = now
        .map(|now| now.id)
        .or(chosen.map(|(_, entry)| entry))
        .and_then(|id| stops.iter().position(|s| s.id == id))
        .map_or_else(|| if step > 0 { 0 } else { count - 1 }, |at| (at as isize + step).rem_euclid(count));
    // Else egui moves it once more, by geometry.
    ctx.memory_mut(|m| {
        m.move_focus(egui::FocusDirection::None);
        m.request_focus(stops[at as usize].id);
    });
}
