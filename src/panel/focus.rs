//! The keyboard focus: navigation with F6, and a visible frame.

use bevy_egui::egui::{
    self, Context, Event, EventFilter, Id, Key, Order, Rect, Response, Stroke, StrokeKind, Ui, WidgetRect,
    accesskit,
};

use super::{Place, theme::Palette};

/// A region of the window, in the order of F6.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Region {
    /// The panels at one side.
    Panel(Place),
    /// Widgets over the picture: badges, arrows.
    Picture,
}

/// The regions of the window, as last shown.
#[derive(Clone, Debug, Default)]
struct Regions(Vec<(Region, Rect)>);

fn memory() -> Id {
    Id::new("regions of the window")
}

/// Starts to collect the regions of the window.
pub(super) fn forget_regions(ctx: &Context) {
    ctx.data_mut(|d| {
        d.insert_temp(memory().with("next"), Regions::default());
        d.insert_temp(memory().with("next firsts"), Vec::<Id>::new());
    });
}

/// Registers a region shown in this frame.
pub(super) fn region(ctx: &Context, region: Region, rect: Rect) {
    ctx.data_mut(|d| d.get_temp_mut_or_default::<Regions>(memory().with("next")).0.push((region, rect)));
}

/// Completes the collection of regions.
pub(super) fn remember_regions(ctx: &Context) {
    ctx.data_mut(|d| {
        let mut regions: Regions = d.get_temp(memory().with("next")).unwrap_or_default();
        regions.0.sort_by_key(|(region, _)| *region);
        d.insert_temp(memory(), regions);
        let firsts: Vec<Id> = d.get_temp(memory().with("next firsts")).unwrap_or_default();
        d.insert_temp(memory().with("firsts"), firsts);
    });
}

/// Sets the target of F6 in its region, instead of the first widget: the selected row. The latest call counts.
pub(super) fn first(ctx: &Context, id: Id) {
    ctx.data_mut(|d| d.get_temp_mut_or_default::<Vec<Id>>(memory().with("next firsts")).insert(0, id));
}

/// Focusable widgets in the order of the Tab key, as last shown, including those scrolled out of view.
fn drawn(ctx: &Context, keep: impl Fn(&WidgetRect) -> bool) -> Vec<WidgetRect> {
    let mut stops: Vec<WidgetRect> = ctx.viewport(|viewport| {
        let widgets = &viewport.prev_pass.widgets;
        // A menu takes clicks as a whole, but is not a stop.
        let whole = |w: &WidgetRect| w.id == w.layer_id.id.with("move");
        let focusable =
            |w: &&WidgetRect| w.enabled && w.sense.is_focusable() && w.rect.is_positive() && !whole(w);
        widgets.layers().flat_map(|(_, all)| all).filter(focusable).filter(|w| keep(w)).copied().collect()
    });
    // Neither is a scroll area.
    let centres: Vec<_> = stops.iter().map(|w| w.rect.center()).collect();
    stops.retain(|w| centres.iter().filter(|centre| w.rect.contains(**centre)).count() < 3);
    stops
}

/// Focusable widgets in reading order.
pub(super) fn stops(ctx: &Context, keep: impl Fn(&WidgetRect) -> bool) -> Vec<WidgetRect> {
    let mut stops = drawn(ctx, keep);
    stops.sort_by(|a, b| {
        (a.rect.center().y.round(), a.rect.left())
            .partial_cmp(&(b.rect.center().y.round(), b.rect.left()))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    stops
}

/// Steps that arrow keys ask of a widget with the focus, to the right and downwards, if it takes the keys of that
/// axis; with Shift ten at once.
pub(super) fn steps(ui: &Ui, response: &Response, [across, along]: [bool; 2]) -> [f64; 2] {
    if !response.has_focus() {
        return [0.0; 2];
    }
    let filter = EventFilter { horizontal_arrows: across, vertical_arrows: along, ..EventFilter::default() };
    ui.memory_mut(|m| m.set_focus_lock_filter(response.id, filter));
    ui.input(|i| {
        let presses = |more, less| i.num_presses(more) as f64 - i.num_presses(less) as f64;
        let steps = [presses(Key::ArrowRight, Key::ArrowLeft), presses(Key::ArrowDown, Key::ArrowUp)];
        steps.map(|steps| if i.modifiers.shift { 10.0 * steps } else { steps })
    })
}

pub(super) fn focused(ctx: &Context) -> Option<WidgetRect> {
    let id = ctx.memory(egui::Memory::focused)?;
    ctx.viewport(|viewport| viewport.prev_pass.widgets.get(id).copied())
}

/// Key of the flag that the user has moved the keyboard focus to the picture.
fn picture() -> Id {
    Id::new("keys sent to the picture")
}

/// Moves the focus to the next or previous region of the window. After the last panel, the picture has the focus, then
/// the widgets over it.
pub(super) fn next_region(ctx: &Context, back: bool) {
    let Regions(regions) = ctx.data(|d| d.get_temp(memory())).unwrap_or_default();
    let wanted: Vec<Id> = ctx.data(|d| d.get_temp(memory().with("firsts"))).unwrap_or_default();
    let firsts: Vec<Option<WidgetRect>> = regions
        .iter()
        .map(|(region, rect)| {
            let within = |w: &WidgetRect| {
                w.layer_id.order == Order::Background
                    && w.interact_rect.is_positive()
                    && rect.contains(w.rect.center())
                    // Excludes the edges of panels, which can be dragged.
                    && !(*region == Region::Picture && w.sense.senses_drag())
            };
            // From the first widget over the picture, Tab reaches all others.
            let all = if *region == Region::Picture { drawn(ctx, within) } else { stops(ctx, within) };
            let wanted = wanted.iter().find_map(|id| all.iter().find(|w| w.id == *id));
            wanted.or(all.first()).copied()
        })
        .collect();
    let here = focused(ctx).and_then(|w| regions.iter().position(|(_, r)| r.contains(w.rect.center())));
    // The widgets over the picture come after the picture itself.
    let over = regions.iter().position(|(region, _)| *region == Region::Picture);
    let count = over.unwrap_or(regions.len());
    let sent = ctx.data(|d| d.get_temp(picture())).unwrap_or(false);
    let order: Vec<usize> = match (here, back) {
        (None, false) if sent => over.into_iter().chain(0..count).collect(),
        (None, false) => (0..count).collect(),
        (None, true) => (0..count).rev().collect(),
        (at, false) if at == over => (0..count).collect(),
        (at, true) if at == over => Vec::new(),
        (Some(at), false) => (at + 1..count).collect(),
        (Some(at), true) => (0..at).rev().collect(),
    };
    let next = order.into_iter().find_map(|i| firsts[i]);
    ctx.data_mut(|d| d.insert_temp(picture(), next.is_none()));
    ctx.memory_mut(|m| match next {
        Some(widget) => m.request_focus(widget.id),
        None => {
            if let Some(id) = m.focused() {
                m.surrender_focus(id);
            }
        }
    });
}

/// Scrolls to a widget that got the focus by keyboard, in any scroll area. Call before the widgets are shown.
pub(super) fn reveal(ctx: &Context) {
    let Some(id) = ctx.data_mut(|d| d.remove_temp::<Option<Id>>(hidden()).flatten()) else { return };
    // Every widget follows this request, including those of third-party dialogs.
    let request = accesskit::ActionRequest {
        action: accesskit::Action::ScrollIntoView,
        target_tree: accesskit::TreeId::ROOT,
        target_node: id.accesskit_id(),
        data: None,
    };
    ctx.input_mut(|input| input.events.push(Event::AccessKitActionRequest(request)));
}

/// Key of the focused widget that is scrolled out of view.
fn hidden() -> Id {
    Id::new("focus out of sight")
}

/// Key of the widget that had the focus at the last check.
fn looked_for() -> Id {
    Id::new("focus looked for")
}

/// Records a widget that got the focus outside the visible area. Focus by pointer scrolls nothing.
fn look_for(ctx: &Context, widget: &WidgetRect) {
    if ctx.data(|d| d.get_temp(looked_for())) == Some(widget.id) {
        return;
    }
    ctx.data_mut(|d| d.insert_temp(looked_for(), widget.id));
    let pointer = ctx.input(|input| input.pointer.any_down() || input.pointer.any_released());
    if !pointer && !widget.interact_rect.expand(0.5).contains_rect(widget.rect) {
        ctx.data_mut(|d| d.insert_temp(hidden(), Some(widget.id)));
        ctx.request_repaint();
    }
}

/// Draws a frame around the focused widget; `rect` is the picture. Text fields have a frame already.
pub(super) fn show(ctx: &Context, palette: &Palette, rect: Rect) {
    let stroke = Stroke::new(1.5, palette.accent);
    let Some(id) = ctx.memory(egui::Memory::focused) else {
        ctx.data_mut(|d| d.remove::<Id>(looked_for()));
        if ctx.input(|input| input.pointer.any_pressed()) {
            ctx.data_mut(|d| d.remove::<bool>(picture()));
        }
        if ctx.data(|d| d.get_temp(picture())).unwrap_or(false) {
            let painter = ctx.layer_painter(egui::LayerId::background());
            painter.rect_stroke(rect.shrink(1.0), 0.0, stroke, StrokeKind::Inside);
        }
        return;
    };
    let Some(widget) = ctx.viewport(|viewport| viewport.this_pass.widgets.get(id).copied()) else { return };
    look_for(ctx, &widget);
    if ctx.text_edit_focused() {
        return;
    }
    let painter = ctx.layer_painter(widget.layer_id).with_clip_rect(widget.interact_rect.expand(3.0));
    painter.rect_stroke(
        widget.rect.intersect(widget.interact_rect).expand(1.0),
        4.0,
        stroke,
        StrokeKind::Outside,
    );
}
