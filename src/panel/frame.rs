//! A frame of the window: what has happened since the last one is taken in, the panels of the list are shown, each in its
//! place, and what the user asks for is applied.

use std::ops::DerefMut;

use bevy::ecs::world::World;
use bevy_egui::egui::{self, Context, Frame, Id, Margin, Rect, Ui, vec2};

use super::{
    Dialogs, Over, PanelContext, Panels, Place, author, code, cover, explain,
    focus::{self, Region},
    keys, lesson, linked, menu, modal, narrow, presentation, sheet, sides,
    state::{Action, Effect, PictureArea, Session},
    theme::{self, Palette},
    welcome,
    widths::{Widths, zoom_percent},
};
use crate::registry::Registry;

/// Shows the window, applies the user's actions, and returns the effects. `ui` covers the window. Borrows `session`
/// mutably only when something changes. `area` holds the picture area of the previous frame and receives that of this
/// frame. `world` is for panels to read.
pub fn show(
    ui: &mut Ui,
    mut session: impl DerefMut<Target = Session>,
    area: &mut PictureArea,
    registry: &Registry,
    panels: &mut Panels,
    dialogs: &mut Dialogs,
    world: &World,
) -> Vec<Effect> {
    let ctx = ui.ctx().clone();
    if !theme::apply(&ctx, &session.settings) {
        return Vec::new();
    }
    let style = ctx.global_style();
    ui.set_style(style);
    let mut effects = absorb(&ctx, &mut session, registry, panels);
    let asks = dialog(&session, panels, dialogs);
    modal::begin(&ctx, asks);
    menu::walk(&ctx);
    focus::reveal(&ctx);
    focus::forget_regions(&ctx);
    linked::begin(&ctx);
    lesson::point::begin(&ctx, &session);
    let mut context = PanelContext::new(&session, registry, world, area);
    pressed(&ctx, &mut context, asks.is_some());
    panels.show(ui, Place::Over(Over::List), &mut context);
    panels.show(ui, Place::Over(Over::Window), &mut context);
    panels.show(ui, Place::Over(Over::Dialog), &mut context);
    let tooltips = theme::tooltips(&ctx);
    if session.view.presenting {
        lesson_alone(ui, panels, &mut context);
    } else {
        around(ui, panels, &mut context);
    }
    panels.show(ui, Place::Picture, &mut context);
    // Nothing behind a window shows a tooltip over it.
    if panels.is_open(Over::Question, &session) {
        theme::hide_tooltips(&ctx, &[]);
    } else if panels.is_open(Over::Window, &session) || dialog(&session, panels, dialogs).is_some() {
        theme::hide_tooltips(&ctx, &tooltips);
    }
    panels.show(ui, Place::Over(Over::Question), &mut context);
    let (mut actions, commands, picture) = context.into_parts();
    panels.queue(commands);
    actions.extend(dialogs.update(&ctx, &mut session, registry));
    let now = picture_area(&ctx, &session, picture, panels, dialogs);
    if area.written != now.written {
        // The marks keep clear of it from the next frame on.
        ctx.request_repaint();
    }
    *area = now;
    focus::remember_regions(&ctx);
    linked::end(&ctx);
    let palette = Palette::of(&session.settings);
    lesson::point::show(&ctx, &palette);
    focus::show(&ctx, &palette, area.frame);
    effects.extend(apply(&ctx, &mut session, actions, registry));
    effects.retain(|effect| !dialogs.start(&ctx, effect, &session, registry));
    modal::end(ui, asks, dialog(&session, panels, dialogs));
    effects
}

/// The id of the dialog or the question that has the keys and the pointer to itself, if one is open.
fn dialog(session: &Session, panels: &Panels, dialogs: &Dialogs) -> Option<&'static str> {
    panels.asks(session).or(dialogs.is_open().then_some("file dialog"))
}

/// Takes in what has changed since the last frame: the registry, the list of panels, the user's keys, the shaders and the
/// progress of a lesson. From here on, the frame sees one state.
fn absorb(
    ctx: &Context,
    session: &mut impl DerefMut<Target = Session>,
    registry: &Registry,
    panels: &Panels,
) -> Vec<Effect> {
    if session.is_stale() {
        session.look(registry);
    }
    if session.view.narrow != narrow::is(ctx) {
        session.view.narrow = narrow::is(ctx);
    }
    // A shortcut in the finder, or another program, may ask something.
    if session.view.finder_open && panels.asks(session).is_some() {
        session.view.finder_open = false;
    }
    if !session.panels.iter().copied().eq(panels.infos()) {
        let first = session.panels.is_empty();
        session.panels = panels.infos().collect();
        // The guest panel that was open when the window was closed.
        if let Some(tab) = session.settings.guest_tab.clone().filter(|_| first)
            && session.panels.iter().any(|panel| panel.id == tab)
        {
            session.view.unfold(&tab);
        }
    }
    keys::check(session, registry);
    keys::remember(ctx, session, registry);
    author::notice_shaders(session, registry);
    if !session.is_lesson_due() {
        return Vec::new();
    }
    session.resume_lesson();
    session.requests()
}

/// Adds the actions of keys, and of clicks into the picture.
fn pressed(ctx: &Context, context: &mut PanelContext<'_>, asks: bool) {
    let (session, registry, area) = (context.session(), context.registry(), context.area());
    let actions = &mut context.actions;
    if !asks {
        actions.extend(code::keys(ctx, session));
    }
    let pressed = keys::pressed(ctx, session, registry, asks);
    actions.extend(pressed.into_iter().map(|action| explain::aimed(ctx, session, area, action)));
    actions.extend(explain::clicked(ctx, session, area));
    actions.extend(explain::on_escape(ctx, session, area));
    actions.extend(explain::update(ctx, session, area, registry));
    actions.extend(lesson::check::update(ctx, session, registry));
    actions.extend(presentation::on_escape(ctx, session, area));
    actions.extend(welcome::on_escape(ctx, session, area));
}

/// The lesson beside the picture of a presentation, which has no other panels.
fn lesson_alone(ui: &mut Ui, panels: &mut Panels, context: &mut PanelContext<'_>) {
    let session = context.session();
    if session.lesson.is_some() && session.view.left_open {
        let frame = theme::panel_frame(&Palette::of(&session.settings), vec2(0.0, 4.0));
        let whole = ui.available_rect_before_wrap();
        let edge = match session.view.narrow {
            true => egui::Panel::bottom("lesson below").exact_size(lesson::BELOW * whole.height()),
            false => egui::Panel::left("lesson presented").exact_size(lesson::SHARE * whole.width()),
        };
        sides::side(ui, edge.frame(frame).resizable(false), Place::Left, panels, context);
    }
}

/// The panels around the picture.
fn around(ui: &mut Ui, panels: &mut Panels, context: &mut PanelContext<'_>) {
    let (ctx, session, whole) = (ui.ctx().clone(), context.session(), ui.available_rect_before_wrap());
    let palette = Palette::of(&session.settings);
    for (place, padding) in [(Place::Top, 4.0), (Place::Status, 2.0)] {
        for (info, panel) in panels.at(place, session) {
            let top = place == Place::Top;
            let bar = if top { egui::Panel::top(info.id) } else { egui::Panel::bottom(info.id) };
            let bar = bar.frame(theme::panel_frame(&palette, vec2(8.0, padding)));
            let shown = bar.show(ui, |ui| panel.show(ui, context));
            focus::region(&ctx, Region::Panel(place), shown.response.rect);
        }
    }
    if session.view.narrow {
        return sheet::below(ui, panels, whole, context);
    }
    // Panel widths are stored per zoom level. A zoom takes effect a frame after it is chosen.
    let zoom = zoom_percent(&ctx);
    let widths = Widths::of(&ctx, session, whole.width());
    let strip = session.settings.strip_height(&session.view.bottom_tab);
    let mut sizes = (widths.left.default, widths.right.default, strip);
    // A lesson takes the full height: it is read while the strip explains.
    let (order, left) = match session.lesson {
        Some(_) => ([Place::Left, Place::Bottom, Place::Right], "lesson at the left"),
        None => ([Place::Bottom, Place::Left, Place::Right], "left"),
    };
    for place in order {
        if place == Place::Bottom && session.view.bottom_open {
            sides::bottom(ui, panels, whole, (&mut sizes.2, widths.is_height_given), context);
        } else if place == Place::Left && session.view.left_open {
            let edge = egui::Panel::left(Id::new((left, zoom)))
                .frame(theme::panel_frame(&palette, vec2(0.0, 4.0)))
                .default_size(widths.left.default)
                .size_range(widths.left.range);
            sizes.0 = sides::side(ui, edge, place, panels, context);
        } else if place == Place::Right && session.view.right_open {
            let margin = Margin { left: 12, right: 4, top: 8, bottom: 4 };
            let edge = egui::Panel::right(Id::new(("right", zoom)))
                .frame(Frame::new().fill(palette.panel).inner_margin(margin))
                .default_size(widths.right.default)
                .size_range(widths.right.range);
            sizes.1 = sides::side(ui, edge, place, panels, context);
        }
    }
    context.actions.extend(widths.dragged(&ctx, session, sizes));
    panels.show(ui, Place::Strip, context);
}

/// Applies the actions of a frame. Returns the effects, among them the dialog that others want; texts are copied.
fn apply(
    ctx: &Context,
    session: &mut impl DerefMut<Target = Session>,
    actions: Vec<Action>,
    registry: &Registry,
) -> Vec<Effect> {
    let mut effects = Vec::new();
    for action in actions {
        if menu::moves_focus(ctx, &action) {
            continue;
        }
        let action = explain::placed(ctx, session, action);
        effects.extend(session.apply(action, registry));
    }
    // Asked in each frame: it compares the focus with that of the frame before.
    let goes_on = gesture_goes_on(ctx);
    if session.document.in_gesture() && !goes_on {
        session.document.end_gesture();
    }
    if session.wanted_dialog.is_some() {
        effects.extend(session.wanted_dialog.take());
    }
    effects.retain(|effect| match effect {
        Effect::CopyText(text) => {
            ctx.copy_text(text.clone());
            false
        }
        _ => true,
    });
    effects
}

/// True during a drag, or while the user types into a field: each is one step of the history.
fn gesture_goes_on(ctx: &Context) -> bool {
    let focus = ctx.memory(egui::Memory::focused);
    let key = Id::new("focus of the gesture");
    let before = ctx.data(|data| data.get_temp::<Option<Id>>(key)).flatten();
    ctx.data_mut(|data| data.insert_temp(key, focus));
    let typing = focus.is_some() && focus == before;
    // A slider keeps the focus after a drag.
    ctx.input(|input| !input.pointer.any_released() && (typing || input.pointer.any_down()))
}

/// The area of the picture with the input that belongs to it: none while a dialog is open, and no clicks in `covered`.
fn picture_area(
    ctx: &Context,
    session: &Session,
    (area, covered): (PictureArea, Vec<Rect>),
    panels: &Panels,
    dialogs: &Dialogs,
) -> PictureArea {
    let busy = dialog(session, panels, dialogs).is_some();
    cover::keep(ctx, covered, busy);
    let pointer = ctx.input(|i| i.pointer.latest_pos());
    PictureArea {
        zoom: ctx.zoom_factor(),
        has_pointer: pointer.is_some_and(|at| cover::is_over_picture(ctx, area.frame, at)),
        has_keys: !busy && ctx.memory(|m| m.focused()).is_none(),
        // The lists open and close by actions, and are not among egui's.
        popup_open: egui::Popup::is_any_open(ctx) || panels.is_open(Over::List, session),
        ..area
    }
}
