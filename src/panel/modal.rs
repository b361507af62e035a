//! Dialogs and questions have the keys and the pointer to themselves: what is pressed before one is in sight waits for
//! it, and no menu stays open over it.

use bevy_egui::egui::{Event, LayerId, Order, SurrenderFocusOn};

use super::prelude::*;

/// The known state of the dialogs.
#[derive(Clone, Default)]
struct Known {
    /// The dialog that was open in the pass before.
    dialog: Option<&'static str>,
    /// True if the pass before was the first one that showed it.
    opened: bool,
    /// What was pressed since it was asked for.
    waits: Vec<Event>,
}

/// True for what a keyboard sends to the widget that has the focus.
pub(super) fn is_typed(event: &Event) -> bool {
    matches!(event, Event::Text(_) | Event::Paste(_) | Event::Key { pressed: true, .. })
}

/// Gives the keys to the open dialog, named by its id: in its first pass they wait, since the focus is not in it yet.
/// Call before anything else sees them.
pub(super) fn begin(ctx: &Context, dialog: Option<&'static str>) {
    let (opens, opened) = kept::with(ctx, |known: &mut Known| {
        let opens = dialog.is_some() && known.dialog != dialog;
        known.dialog = dialog;
        (opens, std::mem::replace(&mut known.opened, opens))
    });
    if opens || opened {
        Popup::close_all(ctx);
    }
    // By default, a click on anything else takes the focus from a field.
    let is_blocked = dialog.is_some() && is_beside(ctx);
    let takes_focus = if is_blocked { SurrenderFocusOn::Never } else { SurrenderFocusOn::Clicks };
    ctx.options_mut(|options| options.input_options.surrender_focus_on = takes_focus);
    if opens {
        let typed = ctx.input_mut(|input| {
            let (typed, other) = std::mem::take(&mut input.events).into_iter().partition(is_typed);
            input.events = other;
            typed
        });
        wait(ctx, typed);
        ctx.memory_mut(|memory| {
            memory.move_focus(egui::FocusDirection::None);
            memory.focused().into_iter().for_each(|behind| memory.surrender_focus(behind));
        });
        return;
    }
    let waited = kept::with(ctx, |known: &mut Known| std::mem::take(&mut known.waits));
    ctx.input_mut(|input| drop(input.events.splice(0..0, waited)));
}

/// True if the pointer is on what the dialog blocks, beside it.
fn is_beside(ctx: &Context) -> bool {
    let Some(at) = ctx.pointer_interact_pos() else { return false };
    ctx.memory(|memory| {
        let Some(dialog) = memory.top_modal_layer() else { return false };
        // What is below the dialog counts as the dialog.
        let is_within = memory.area_rect(dialog.id).is_some_and(|rect| rect.contains(at));
        memory.layer_id_at(at) == Some(dialog) && !is_within
    })
}

/// Lets keys wait for the dialog that may be open in the next pass.
pub(super) fn wait(ctx: &Context, typed: Vec<Event>) {
    if !typed.is_empty() {
        kept::with(ctx, |known: &mut Known| known.waits.extend(typed));
        ctx.request_repaint();
    }
}

/// Covers all panels while a dialog is open, or has just been asked for and is not in sight yet. Call after the panels have
/// been shown.
pub(super) fn end(ui: &Ui, before: Option<&'static str>, now: Option<&'static str>) {
    if now.is_none() {
        return;
    }
    let ctx = ui.ctx();
    // The last widget of a layer is above its others.
    let _ = ui.interact(ctx.content_rect(), Id::new("behind a dialog"), Sense::CLICK | Sense::DRAG);
    if now != before {
        let to_come = LayerId::new(Order::Foreground, Id::new("dialog to come"));
        ctx.memory_mut(|memory| memory.set_modal_layer(to_come));
        ctx.request_repaint();
    }
}
