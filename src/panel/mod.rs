//! The panels around the picture, in egui.
//!
//! A panel reads the state of the window and returns actions ([`Panel`]); [`show`] lays out the panels, applies their
//! actions to the [`Session`] and returns the effects that need files, entities or the operating system. No window is
//! needed for any of this.
//!
//! **To add one**: write `panel/x.rs` and add its name to [`register_builtin`]; a panel at the bottom automatically
//! gets a tab and a menu entry. From outside the crate: [`PanelApp::add_panel`].

use std::{
    mem::swap,
    ops::{Deref, DerefMut},
};

use bevy::{
    app::{App, Plugin},
    ecs::{
        change_detection::DetectChangesMut,
        message::Messages as Queue,
        query::{QueryState, With},
        system::Local,
        world::World,
    },
};
use bevy_egui::{
    EguiContext, EguiPrimaryContextPass, PrimaryEguiContext,
    egui::{self, Frame, Id, LayerId, Margin, Pos2, Rect, Ui, UiBuilder, vec2},
};

use crate::registry::Registry;
pub use context::{Panel, PanelApp, PanelContext, Panels};
pub use dialogs::Dialogs;
use focus::Region;
use state::{Effect, LabEffect, PictureArea, Session};
pub use state::{PanelInfo, Place};
use theme::Palette;
use widths::Widths;

pub mod author;
pub mod caption;
pub mod channels;
pub mod chooser;
pub mod clipping;
pub mod command;
pub mod compare;
mod context;
pub mod dialogs;
pub mod effects;
pub mod explain;
pub mod export;
pub mod files;
mod finder;
mod focus;
pub mod follow;
pub mod formula;
mod glyphs;
mod handles;
pub mod help;
pub mod history;
pub mod icon;
pub mod inspector;
pub mod keys;
pub mod knob;
mod labels;
pub mod laws;
pub mod lesson;
mod linked;
pub mod manual;
pub mod marks;
mod matching;
pub mod maths;
mod menu;
pub mod messages;
pub mod model_override;
mod notice;
pub mod picture;
mod placing;
pub mod plots;
pub mod presentation;
pub mod preview;
pub mod progress;
pub mod question;
mod rank;
pub mod reload;
pub mod segmented;
pub mod settings;
pub mod shader;
mod shares;
mod sides;
pub mod state;
pub mod status;
mod terms;
pub mod theme;
pub mod top;
pub mod tree;
pub mod typeset;
pub mod welcome;
mod widths;
pub mod wires;

/// Registers the built-in panels, in layout order. This is the only list.
pub fn register_builtin(to: &mut Panels) {
    to.add_own(top::TopBar);
    to.add_own(status::StatusLine);
    to.add_own(messages::Messages);
    to.add_own(plots::PlotPanel::default());
    to.add_own(shader::Shader);
    to.add_own(history::History);
    to.add_own(explain::Explain);
    to.add_own(lesson::LessonPanel);
    to.add_own(tree::Tree);
    to.add_own(inspector::Inspector);
}

impl Panels {
    /// The built-in panels.
    #[must_use]
    pub fn builtin() -> Self {
        let mut panels = Self::default();
        register_builtin(&mut panels);
        panels
    }
}

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
    if !theme::apply(&ctx, &session.view) {
        return Vec::new();
    }
    let style = ctx.global_style();
    ui.set_style(style);
    if session.is_stale() {
        session.look(registry);
    }
    if !session.panels.iter().copied().eq(panels.infos()) {
        let first = session.panels.is_empty();
        session.panels = panels.infos().collect();
        // The guest panel that was open when the window was closed.
        if let Some(tab) = session.view.guest_tab.clone().filter(|_| first)
            && session.panels.iter().any(|panel| panel.id == tab)
        {
            session.view.unfold(&tab);
        }
    }
    keys::check(&mut session, registry);
    keys::remember(&ctx, &session, registry);
    author::notice_shaders(&mut session, registry);
    let mut effects = Vec::new();
    if session.is_lesson_due() {
        effects.extend(session.resume_lesson());
    }
    let palette = Palette::of(&session.view);
    menu::walk(&ctx);
    chooser::closed(&ctx, &session);
    focus::reveal(&ctx);
    focus::forget_regions(&ctx);
    linked::begin(&ctx);
    lesson::point::begin(&ctx, &session);
    let mut context = PanelContext::new(&session, registry, world);
    let actions = &mut context.actions;
    if !dialogs.is_open() {
        let pressed = keys::pressed(&ctx, &session, registry);
        actions.extend(pressed.into_iter().map(|action| explain::aimed(&ctx, &session, area, action)));
    }
    actions.extend(explain::clicked(&ctx, &session, area));
    actions.extend(explain::on_escape(&ctx, &session, area));
    actions.extend(explain::update(&ctx, &session, area, registry));
    actions.extend(lesson::check::update(&ctx, &session, registry));
    actions.extend(presentation::on_escape(&ctx, &session, area));
    actions.extend(welcome::on_escape(&ctx, &session, area));
    actions.extend(help::show(&ctx, &session, registry));
    actions.extend(finder::show(&ctx, &session, registry));
    actions.extend(author::show(&ctx, &session, area, registry));
    actions.extend(matching::show(&ctx, &session, area, registry));
    let tooltips = theme::tooltips(&ctx);
    let whole = ui.available_rect_before_wrap();

    let presenting = session.view.presenting;
    if presenting {
        actions.extend(chooser::alone(&ctx, &session, registry));
    }
    for (info, panel) in panels.at(Place::Top, &session).filter(|_| !presenting) {
        let frame = theme::panel_frame(&palette, vec2(8.0, 4.0));
        let shown = egui::Panel::top(info.id).frame(frame).show(ui, |ui| panel.show(ui, &mut context));
        focus::region(&ctx, Region::Panel(Place::Top), shown.response.rect);
    }
    for (info, panel) in panels.at(Place::Status, &session).filter(|_| !presenting) {
        let frame = theme::panel_frame(&palette, vec2(8.0, 2.0));
        let shown = egui::Panel::bottom(info.id).frame(frame).show(ui, |ui| panel.show(ui, &mut context));
        focus::region(&ctx, Region::Panel(Place::Status), shown.response.rect);
    }
    // Panel widths are stored per zoom level. A zoom takes effect a frame after it is chosen.
    let zoom = zoom_percent(&ctx);
    let widths = Widths::of(&ctx, &session, whole.width());
    let mut sizes = (widths.left.default, widths.right.default, session.view.bottom_height);
    if presenting && session.lesson.is_some() && session.view.left_open {
        let frame = theme::panel_frame(&palette, vec2(0.0, 4.0));
        let panel = egui::Panel::left("lesson presented").frame(frame).resizable(false);
        let shown = panel.exact_size(lesson::SHARE * whole.width()).show(ui, |ui| {
            sides::side(ui, Place::Left, &session, panels, &mut context);
        });
        focus::region(&ctx, Region::Panel(Place::Left), shown.response.rect);
    }
    // In a presentation, the picture takes the remaining space.
    let whole = if presenting { ui.available_rect_before_wrap() } else { whole };
    // A lesson takes the full height: it is read while the strip explains.
    let learning = session.lesson.is_some();
    if session.view.bottom_open && !presenting && !learning {
        sides::bottom(ui, &session, panels, &palette, whole, &mut sizes.2, &mut context);
    }
    if session.view.left_open && !presenting {
        let side = if session.lesson.is_some() { "lesson at the left" } else { "left" };
        let panel = egui::Panel::left(Id::new((side, zoom)))
            .frame(theme::panel_frame(&palette, vec2(0.0, 4.0)))
            .default_size(widths.left.default)
            .size_range(widths.left.range);
        let response = panel.show(ui, |ui| sides::side(ui, Place::Left, &session, panels, &mut context));
        focus::region(&ctx, Region::Panel(Place::Left), response.response.rect);
        sizes.0 = response.response.rect.width();
    }
    if session.view.bottom_open && !presenting && learning {
        sides::bottom(ui, &session, panels, &palette, whole, &mut sizes.2, &mut context);
    }
    if session.view.right_open && !presenting {
        let panel = egui::Panel::right(Id::new(("right", zoom)))
            .frame(Frame::new().fill(palette.panel).inner_margin(Margin {
                left: 12,
                right: 4,
                top: 8,
                bottom: 4,
            }))
            .default_size(widths.right.default)
            .size_range(widths.right.range);
        let response = panel.show(ui, |ui| sides::side(ui, Place::Right, &session, panels, &mut context));
        focus::region(&ctx, Region::Panel(Place::Right), response.response.rect);
        sizes.1 = response.response.rect.width();
    }
    let (mut actions, commands) = context.into_parts();
    panels.queue(commands);
    actions.extend(widths.dragged(&ctx, &session, sizes));

    if !presenting {
        actions.extend(welcome::strip(ui, &session, registry));
    }
    let rect = ui.available_rect_before_wrap();
    focus::region(&ctx, Region::Picture, rect);
    let several = presenting && !session.document.variants.is_empty();
    let footer = several.then(|| presentation::Footer::of(ui, rect, &session, registry));
    let arrangement = compare::arrange(&session, rect, footer.as_ref().map_or(0.0, |footer| footer.height));
    let compares = !arrangement.is_single();
    let rect = if compares { arrangement.picture } else { rect };
    let stage = (presenting && !compares).then(|| presentation::Stage::of(ui, rect, &session, registry));
    let frame = stage.as_ref().map_or(rect, |stage| stage.picture);
    let mut over = if compares {
        picture::views(ui, &arrangement, &area.written, &session, registry)
    } else {
        picture::overlays(ui, [rect, frame], &area.written, stage.as_ref(), &session, registry)
    };
    let (asked, places) = compare::show(ui, &arrangement, &session, registry);
    if let Some(footer) = footer {
        footer.paint(ui, whole, &session, registry);
    }
    over.places.extend(places);
    actions.append(&mut over.actions);
    actions.extend(asked);
    // Nothing behind a window shows a tooltip over it.
    let windows = [
        session.view.keys_open,
        session.view.about_open,
        session.draft.is_some(),
        session.match_draft.is_some(),
        dialogs.is_open(),
    ];
    if session.questions.open.is_some() {
        theme::hide_tooltips(&ctx, &[]);
    } else if windows.contains(&true) {
        theme::hide_tooltips(&ctx, &tooltips);
    }
    actions.extend(question::show(&ctx, &session));
    actions.extend(dialogs.update(&ctx, &mut session, registry));
    let mut now = picture_area(&ctx, &session, [rect, frame], over.places, over.written, dialogs.is_open());
    if compares {
        (now.cells, now.map) = (arrangement.cells, arrangement.map);
    }
    if area.written != now.written {
        // The marks keep clear of it from the next frame on.
        ctx.request_repaint();
    }
    *area = now;
    focus::remember_regions(&ctx);
    linked::end(&ctx);
    lesson::point::show(&ctx, &palette);
    focus::show(&ctx, &palette, frame);

    for action in actions {
        let action = explain::placed(&ctx, &session, action);
        effects.extend(session.apply(action, registry));
    }
    if session.document.in_gesture() && !gesture_goes_on(&ctx) {
        session.document.end_gesture();
    }
    if session.wanted_dialog.is_some() {
        effects.extend(session.wanted_dialog.take());
    }
    effects.retain(|effect| !dialogs.start(&ctx, effect, &session, registry));
    for effect in &effects {
        if let Effect::CopyText(text) = effect {
            ctx.copy_text(text.clone());
        }
    }
    effects.retain(|effect| !matches!(effect, Effect::CopyText(_)));
    effects
}

/// The current zoom, in per cent.
fn zoom_percent(ctx: &egui::Context) -> u32 {
    (100.0 * ctx.zoom_factor()).round() as u32
}

/// True during a drag, or while the user types into a field: each is one step of the history.
fn gesture_goes_on(ctx: &egui::Context) -> bool {
    let focus = ctx.memory(egui::Memory::focused);
    let key = Id::new("focus of the gesture");
    let before = ctx.data(|data| data.get_temp::<Option<Id>>(key)).flatten();
    ctx.data_mut(|data| data.insert_temp(key, focus));
    let typing = focus.is_some() && focus == before;
    // A slider keeps the focus after a drag.
    ctx.input(|input| !input.pointer.any_released() && (typing || input.pointer.any_down()))
}

/// Areas that keep the pointer from the picture, as last shown.
#[derive(Clone, Debug, Default)]
struct Cover {
    /// Clickable rectangles over the picture.
    places: Vec<Rect>,
    /// True while a question or a dialog waits for an answer.
    busy: bool,
}

/// True if a position, in points of the panels, is over the picture and no panel, menu or dialog is in between; `frame`
/// is that of the [`PictureArea`]. Uses the most recent layout: a press counts where it was made, even before the next
/// frame.
#[must_use]
pub fn is_over_picture(ctx: &egui::Context, frame: Rect, at: Pos2) -> bool {
    let cover: Cover = ctx.data(|d| d.get_temp(Id::new("cover of the picture"))).unwrap_or_default();
    is_in_sight(ctx, frame, at) && !cover.places.iter().any(|place| place.contains(at))
}

/// True if a position is over the visible picture, even where something over the picture can be clicked.
fn is_in_sight(ctx: &egui::Context, frame: Rect, at: Pos2) -> bool {
    let cover: Cover = ctx.data(|d| d.get_temp(Id::new("cover of the picture"))).unwrap_or_default();
    // Panels are not separate layers; menus, popups, windows and dialogs are.
    frame.contains(at)
        && !cover.busy
        && ctx.layer_id_at(at).is_none_or(|layer| layer.order == egui::Order::Background)
        && !ctx.egui_is_using_pointer()
}

/// The picture area, and whether pointer and keys belong to the picture. Clicks in `covered` do not.
fn picture_area(
    ctx: &egui::Context,
    session: &Session,
    [rect, frame]: [Rect; 2],
    covered: Vec<Rect>,
    written: Vec<Rect>,
    dialog: bool,
) -> PictureArea {
    let busy = session.questions.open.is_some() || dialog;
    ctx.data_mut(|d| d.insert_temp(Id::new("cover of the picture"), Cover { places: covered, busy }));
    let pointer = ctx.input(|i| i.pointer.latest_pos());
    PictureArea {
        rect,
        frame,
        zoom: ctx.zoom_factor(),
        has_pointer: pointer.is_some_and(|at| is_over_picture(ctx, frame, at)),
        has_keys: !busy && ctx.memory(|m| m.focused()).is_none(),
        // The chooser opens and closes by an action, and is not among egui's.
        popup_open: egui::Popup::is_any_open(ctx) || session.view.chooser_open || session.view.finder_open,
        written,
        ..PictureArea::default()
    }
}

/// Adds the window to the app: the state, the panels, and the system that shows them. Requests for the rest of the app
/// are written as [`LabEffect`] messages.
#[derive(Clone, Copy, Debug, Default)]
pub struct PanelPlugin;

impl Plugin for PanelPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Session>().init_resource::<PictureArea>();
        app.world_mut().get_resource_or_insert_with(Panels::builtin);
        app.add_message::<LabEffect>();
        app.add_systems(EguiPrimaryContextPass, show_panels);
    }
}

/// The session, with a flag for changes.
struct Tracked<'a> {
    session: &'a mut Session,
    changed: &'a mut bool,
}

impl Deref for Tracked<'_> {
    type Target = Session;

    fn deref(&self) -> &Session {
        self.session
    }
}

impl DerefMut for Tracked<'_> {
    fn deref_mut(&mut self) -> &mut Session {
        *self.changed = true;
        self.session
    }
}

/// Shows the panels in the primary egui context, if there is one, and runs the commands that they queue. Exclusive, so
/// that panels can read the world.
pub fn show_panels(
    world: &mut World,
    contexts: &mut QueryState<&mut EguiContext, With<PrimaryEguiContext>>,
    mut dialogs: Local<Dialogs>,
    mut out: Local<(Session, Panels)>,
) {
    let Some(mut context) = contexts.iter_mut(world).next() else { return };
    let ctx = context.get_mut().clone();
    let mut ui = Ui::new(
        ctx.clone(),
        Id::new("lab"),
        UiBuilder::new().layer_id(LayerId::background()).max_rect(ctx.viewport_rect()),
    );
    let mut area = world.resource::<PictureArea>().clone();
    // Taken out because panels read the world; `resource_scope` would count as a change in every frame.
    let (session, panels) = &mut *out;
    swap(world.resource_mut::<Session>().bypass_change_detection(), session);
    swap(world.resource_mut::<Panels>().bypass_change_detection(), panels);
    let mut changed = false;
    let tracked = Tracked { session, changed: &mut changed };
    let effects =
        show(&mut ui, tracked, &mut area, world.resource::<Registry>(), panels, &mut dialogs, world);
    let commands = panels.take_queued();
    swap(world.resource_mut::<Panels>().bypass_change_detection(), panels);
    swap(world.resource_mut::<Session>().bypass_change_detection(), session);
    if changed {
        world.resource_mut::<Session>().set_changed();
    }
    world.resource_mut::<Queue<LabEffect>>().write_batch(effects.into_iter().map(LabEffect));
    world.resource_mut::<PictureArea>().set_if_neq(area);
    for command in commands {
        command(world);
    }
}
