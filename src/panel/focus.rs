//! The keyboard focus: where it goes with F6 and within menus, and that it is seen wherever it is.

use bevy_egui::egui::{
    self, Context, Event, Id, Key, LayerId, Modifiers, Order, Popup, Rect, Response, Stroke, StrokeKind,
    WidgetRect,
};

use super::{Place, theme::Palette};

/// The parts of the window, as they were shown last, in the order of F6.
#[derive(Clone, Debug, Default)]
struct Regions(Vec<(Place, Rect)>);

fn memory() -> Id {
    Id::new("regions of the window")
}

/// Begins to collect the parts of the window.
pub(super) fn forget_regions(ctx: &Context) {
    ctx.data_mut(|d| d.insert_temp(memory().with("next"), Regions::default()));
}

/// A part of the window was shown here.
pub(super) fn region(ctx: &Context, place: Place, rect: Rect) {
    ctx.data_mut(|d| d.get_temp_mut_or_default::<Regions>(memory().with("next")).0.push((place, rect)));
}

/// All parts were shown.
pub(super) fn remember_regions(ctx: &Context) {
    ctx.data_mut(|d| {
        let mut regions: Regions = d.get_temp(memory().with("next")).unwrap_or_default();
        regions.0.sort_by_key(|(place, _)| *place);
        d.insert_temp(memory(), regions);
    });
}

/// What can have the focus in a layer, in the order of reading, as it was shown last.
fn stops(ctx: &Context, keep: impl Fn(&WidgetRect) -> bool) -> Vec<WidgetRect> {
    let mut stops: Vec<WidgetRect> = ctx.viewport(|viewport| {
        let widgets = &viewport.prev_pass.widgets;
        let focusable =
            |w: &&WidgetRect| w.enabled && w.sense.is_focusable() && w.interact_rect.is_positive();
        widgets.layers().flat_map(|(_, all)| all).filter(focusable).filter(|w| keep(w)).copied().collect()
    });
    // A menu and an area that scrolls take clicks as a whole, but are no stops.
    let centres: Vec<_> = stops.iter().map(|w| w.rect.center()).collect();
    stops.retain(|w| centres.iter().filter(|centre| w.rect.contains(**centre)).count() < 3);
    stops.sort_by(|a, b| {
        (a.rect.center().y.round(), a.rect.left())
            .partial_cmp(&(b.rect.center().y.round(), b.rect.left()))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    stops
}

fn focused(ctx: &Context) -> Option<WidgetRect> {
    let id = ctx.memory(egui::Memory::focused)?;
    ctx.viewport(|viewport| viewport.prev_pass.widgets.get(id).copied())
}

/// Moves the focus to the next part of the window, or the one before; after the last it is the picture's again.
pub(super) fn next_region(ctx: &Context, back: bool) {
    let Regions(regions) = ctx.data(|d| d.get_temp(memory())).unwrap_or_default();
    let firsts: Vec<Option<WidgetRect>> = regions
        .iter()
        .map(|(_, rect)| {
            let within =
                |w: &WidgetRect| w.layer_id.order == Order::Background && rect.contains(w.rect.center());
            stops(ctx, within).first().copied()
        })
        .collect();
    let here = focused(ctx).and_then(|w| regions.iter().position(|(_, r)| r.contains(w.rect.center())));
    let count = regions.len();
    let order: Vec<usize> = match (here, back) {
        (None, false) => (0..count).collect(),
        (None, true) => (0..count).rev().collect(),
        (Some(at), false) => (at + 1..count).collect(),
        (Some(at), true) => (0..at).rev().collect(),
    };
    let next = order.into_iter().find_map(|i| firsts[i]);
    ctx.memory_mut(|m| match next {
        Some(widget) => m.request_focus(widget.id),
        None => {
            if let Some(id) = m.focused() {
                m.surrender_focus(id);
            }
        }
    });
}

fn opened() -> Id {
    Id::new("menu opened by key")
}

/// Opens the menus of a bar: each with Alt and its letter, the first with F10.
pub(super) fn open_menus(ctx: &Context, bar: &[(Key, Response)]) {
    let ids: Vec<Id> = bar.iter().map(|(_, button)| Popup::default_response_id(button)).collect();
    let wanted = ctx.input_mut(|input| {
        let by_letter = bar.iter().position(|(key, _)| input.consume_key(Modifiers::ALT, *key));
        let first = input.consume_key(Modifiers::NONE, Key::F10).then_some(0);
        by_letter.or(first)
    });
    let Some(wanted) = wanted else { return };
    ctx.memory_mut(|m| m.move_focus(egui::FocusDirection::None));
    if Popup::is_id_open(ctx, ids[wanted]) {
        Popup::close_id(ctx, ids[wanted]);
        return;
    }
    Popup::open_id(ctx, ids[wanted]);
    // Its entries are there with the next frame.
    ctx.data_mut(|d| d.insert_temp(opened(), true));
    ctx.request_repaint();
}

/// Lets the arrow keys walk through an open menu or list, however it was opened. Call before the widgets see the keys.
pub(super) fn walk_menus(ctx: &Context) {
    if !Popup::is_any_open(ctx) || ctx.text_edit_focused() {
        return;
    }
    // What is dragged, as in a picker of colours, has the arrows for itself.
    let now = focused(ctx).filter(|w| w.layer_id.order == Order::Foreground);
    if now.is_some_and(|w| w.sense.senses_drag()) {
        return;
    }
    let mut step = 0_isize;
    let mut stays = false;
    ctx.input_mut(|input| {
        input.events.retain(|event| {
            let Event::Key { key, pressed: true, modifiers: Modifiers::NONE, .. } = event else {
                return true;
            };
            match key {
                Key::ArrowDown => step += 1,
                Key::ArrowUp => step -= 1,
                // They open and close what hangs at an entry; the focus stays within the menu.
                Key::ArrowLeft | Key::ArrowRight => {
                    stays = true;
                    return true;
                }
                _ => return true,
            }
            false
        });
    });
    if stays {
        ctx.memory_mut(|m| m.move_focus(egui::FocusDirection::None));
    }
    let entering = now.is_none() && ctx.data_mut(|d| d.remove_temp::<bool>(opened())).unwrap_or(false);
    if entering {
        step = 1;
    }
    if step == 0 {
        return;
    }
    let layer = now.map(|w| w.layer_id).or_else(|| top_menu(ctx));
    let stops = stops(ctx, |w| Some(w.layer_id) == layer && !w.sense.senses_drag());
    if stops.is_empty() {
        if entering {
            ctx.data_mut(|d| d.insert_temp(opened(), true));
        }
        return;
    }
    let count = stops.len() as isize;
    let at = now
        .and_then(|now| stops.iter().position(|s| s.id == now.id))
        .map_or_else(|| if step > 0 { 0 } else { count - 1 }, |at| (at as isize + step).rem_euclid(count));
    // Else egui moves it once more, by geometry.
    ctx.memory_mut(|m| {
        m.move_focus(egui::FocusDirection::None);
        m.request_focus(stops[at as usize].id);
    });
}

/// The menu that lies on top.
fn top_menu(ctx: &Context) -> Option<LayerId> {
    ctx.memory(|m| m.areas().top_layer_id(Order::Foreground))
}

/// Frames what has the focus. Fields that are typed into have a frame of their own.
pub(super) fn show(ctx: &Context, palette: &Palette) {
    if ctx.text_edit_focused() {
        return;
    }
    let Some(id) = ctx.memory(egui::Memory::focused) else { return };
    let Some(widget) = ctx.viewport(|viewport| viewport.this_pass.widgets.get(id).copied()) else { return };
    let painter = ctx.layer_painter(widget.layer_id).with_clip_rect(widget.interact_rect.expand(3.0));
    painter.rect_stroke(
        widget.rect.intersect(widget.interact_rect).expand(1.0),
        4.0,
        Stroke::new(1.5, palette.accent),
        StrokeKind::Outside,
    );
}
