//! The keyboard focus: navigation with F6, and a visible frame.

use bevy_egui::egui::{Event, EventFilter, Order, WidgetRect, accesskit};

use super::prelude::*;

/// A region of the window, in the order of F6.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Region {
    /// The panels at one side.
    Panel(Place),
    /// Widgets over the picture: badges, arrows.
    Picture,
}

/// The regions of the window, and the targets of F6 in them.
#[derive(Clone, Debug, Default)]
struct Regions(Vec<(Region, Rect)>, Vec<Id>);

/// The known state of the focus.
#[derive(Clone, Debug, Default)]
struct Known {
    /// The regions as last shown, and those of this frame.
    shown: Regions,
    next: Regions,
    /// True if the user has moved the keyboard focus to the picture.
    picture: bool,
    /// The focused widget that is scrolled out of view.
    hidden: Option<Id>,
    /// The widget that had the focus at the last check.
    looked_for: Option<Id>,
}

fn with<R>(ctx: &Context, of: impl FnOnce(&mut Known) -> R) -> R {
    kept::with(ctx, of)
}

/// Starts to collect the regions of the window.
pub(super) fn forget_regions(ctx: &Context) {
    with(ctx, |known| known.next = Regions::default());
}

/// Registers a region shown in this frame.
pub(super) fn region(ctx: &Context, region: Region, rect: Rect) {
    with(ctx, |known| known.next.0.push((region, rect)));
}

/// Completes the collection of regions.
pub(super) fn remember_regions(ctx: &Context) {
    with(ctx, |known| {
        known.shown = known.next.clone();
        known.shown.0.sort_by_key(|(region, _)| *region);
    });
}

/// Sets the target of F6 in its region, instead of the first widget: the selected row. The latest call counts.
pub(super) fn first(ctx: &Context, id: Id) {
    with(ctx, |known| known.next.1.insert(0, id));
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
    let place = |w: &WidgetRect| (w.rect.center().y.round(), w.rect.left());
    stops.sort_by(|a, b| place(a).partial_cmp(&place(b)).unwrap_or(std::cmp::Ordering::Equal));
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

/// Moves the focus to the next or previous region of the window. After the last panel, the picture has the focus, then
/// the widgets over it.
pub(super) fn next_region(ctx: &Context, back: bool) {
    let Known { shown: Regions(regions, wanted), picture: sent, .. } = kept::get(ctx);
    let firsts: Vec<Option<WidgetRect>> = regions
        .iter()
        .map(|(region, rect)| {
            let within = |w: &WidgetRect| {
                w.layer_id.order == Order::Background
                    && w.interact_rect.is_positive()
                    && rect.contains(w.rect.center())
                    // Excludes the edges of panels, which can only be dragged.
                    && w.sense.senses_click()
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
    with(ctx, |known| known.picture = next.is_none());
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
    let Some(id) = with(ctx, |known| known.hidden.take()) else { return };
    // Every widget follows this request, including those of third-party dialogs.
    let request = accesskit::ActionRequest {
        action: accesskit::Action::ScrollIntoView,
        target_tree: accesskit::TreeId::ROOT,
        target_node: id.accesskit_id(),
        data: None,
    };
    ctx.input_mut(|input| input.events.push(Event::AccessKitActionRequest(request)));
}

/// Leaves it to a widget with the focus to scroll. The middle of a text that is longer than its area, which all others
/// would come to, says nothing. Call before [`show`].
pub(super) fn scrolls_itself(ctx: &Context, id: Id) {
    if ctx.memory(|memory| memory.has_focus(id)) {
        with(ctx, |known| known.looked_for = Some(id));
    }
}

/// Records a widget that got the focus outside the visible area. Focus by pointer scrolls nothing.
fn look_for(ctx: &Context, widget: &WidgetRect) {
    if with(ctx, |known| known.looked_for.replace(widget.id)) == Some(widget.id) {
        return;
    }
    let pointer = ctx.input(|input| input.pointer.any_down() || input.pointer.any_released());
    if !pointer && !widget.interact_rect.expand(0.5).contains_rect(widget.rect) {
        with(ctx, |known| known.hidden = Some(widget.id));
        ctx.request_repaint();
    }
}

/// Draws a frame around the focused widget; `rect` is the picture. Text fields have a frame already.
pub(super) fn show(ctx: &Context, palette: &Palette, rect: Rect) {
    let stroke = Stroke::new(1.5, palette.accent);
    let Some(id) = ctx.memory(egui::Memory::focused) else {
        let pressed = ctx.input(|input| input.pointer.any_pressed());
        let in_picture = with(ctx, |known| {
            known.looked_for = None;
            known.picture &= !pressed;
            known.picture
        });
        if in_picture {
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
    let frame = widget.rect.intersect(widget.interact_rect).expand(1.0);
    painter.rect_stroke(frame, 4.0, stroke, StrokeKind::Outside);
}
