//! The panels beside and below the picture. At a side, guest panels are sections at the bottom, which fold, and scroll
//! if they are long; the window's own panel takes the remaining space. At the bottom, panels are tabs.

use bevy_egui::egui::{Frame, Margin, containers::panel::PanelState};

use super::{
    compare,
    context::{Listed, PanelContext, Panels},
    focus::{self, Region},
    glyphs, keys,
    lesson::point,
    narrow,
    prelude::*,
    shares::shared,
    state::{
        CODE_TAB, EXPLAIN_TAB, MATERIALS_TAB, MESSAGES_TAB, OpenLesson, PLOTS_TAB, PanelInfo, SHADER_TAB,
    },
    widths::zoom_percent,
};

/// Id of the lesson panel.
const LESSON: &str = "lesson";
/// Fraction of the left side that the scene list takes below a lesson, and height of its rows in points.
const TREE: f32 = 0.42;
const ROW: f32 = 26.0;
/// Maximum fraction of a side for all guest sections.
const GUESTS: f32 = 0.5;
/// Height of the title of a section, in points.
const TITLE: f32 = 26.0;
/// Space below the content of a section, in points.
const END: f32 = 8.0;
/// The line above a section, and the borders of the last widget in it, in points.
const LINE: f32 = 2.0;
/// Minimum height of an unfolded section, in points.
const LEAST: f32 = TITLE + 64.0 + END;

/// Shows the panels at a side, within `edge`. Returns its width.
pub(super) fn side(
    ui: &mut Ui,
    edge: egui::Panel,
    place: Place,
    panels: &mut Panels,
    context: &mut PanelContext<'_>,
) -> f32 {
    // What is too wide for a panel must not widen it: egui would paint the panel over its neighbour.
    let shown = edge.show(ui, |ui| {
        let room = ui.available_rect_before_wrap();
        let mut inside = ui.new_child(UiBuilder::new().max_rect(room));
        within(&mut inside, place, panels, context);
        ui.expand_to_include_rect(room);
    });
    focus::region(ui.ctx(), Region::Panel(place), shown.response.rect);
    shown.response.rect.width()
}

/// Shows the panels at a side in all of `ui`.
pub(super) fn within(ui: &mut Ui, place: Place, panels: &mut Panels, context: &mut PanelContext<'_>) {
    let session = context.session();
    let mut lessons = Vec::new();
    let (guests, own): (Vec<_>, Vec<_>) = panels.at(place, session).partition(|(info, _)| info.guest);
    let wanted = |ui: &Ui, info: &PanelInfo| match session.settings.folds(info.id) {
        true => narrow::high(ui.ctx(), TITLE),
        false => ui.data(|data| data.get_temp(Id::new(("section", info.id)))).unwrap_or(LEAST),
    };
    let all: Vec<_> = guests.iter().map(|(info, _)| wanted(ui, info)).collect();
    let share = shared(&all, GUESTS * ui.available_height()).max(LEAST);
    // From the bottom up, so that the first one is on top.
    for (info, panel) in guests.into_iter().rev() {
        // As high as its last content, up to its share.
        let id = Id::new(("section", info.id));
        let wanted = wanted(ui, &info);
        let strip = egui::Panel::bottom(id).frame(Frame::NONE).resizable(false).exact_size(wanted.min(share));
        let shown = strip.show(ui, |ui| section(ui, info, panel, context)).inner;
        if let Some(shown) = shown.filter(|shown| *shown != wanted) {
            ui.data_mut(|data| data.insert_temp(id, shown));
            ui.ctx().request_repaint();
        }
    }
    for (info, panel) in own {
        let lesson = session.lesson.as_ref().filter(|_| place == Place::Left);
        match (lesson, info.id) {
            // A narrow window shows either.
            (Some(open), id) if session.view.narrow && !session.view.presenting => {
                if open.tree_open != (id == LESSON) {
                    panel.show(ui, context);
                }
            }
            (Some(_), LESSON) => lessons.push(panel),
            (Some(open), _) if !session.view.presenting => tree_below(ui, open, panel, context),
            (Some(_), _) | (None, LESSON) => {}
            (None, _) => panel.show(ui, context),
        }
    }
    // In the remaining space.
    for panel in lessons {
        panel.show(ui, context);
    }
}

/// The scene list below a lesson, unfolded by a click on its title.
fn tree_below(ui: &mut Ui, open: &OpenLesson, panel: &mut Listed, context: &mut PanelContext<'_>) {
    let session = context.session();
    let unfolded = open.tree_open || point::at_part(session);
    let rows = 4 + session.document.lights.len() + session.document.objects.len();
    let list = (rows as f32 * ROW).min(TREE * ui.available_height()).max(3.0 * ROW);
    let height = TITLE + LINE + if unfolded { list } else { 0.0 };
    let strip = egui::Panel::bottom("scene list below a lesson").frame(Frame::NONE).resizable(false);
    strip.exact_size(height).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), TITLE), Sense::hover());
        let inside = rect.with_min_x(rect.left() + 8.0);
        let says = "Scene list";
        let response = icon::fold(ui, inside, Id::new("title of the scene list"), says, unfolded);
        fold_title(ui, inside, says);
        let way = if unfolded { "Fold the scene list" } else { "Unfold the scene list" };
        context.on_click(&response.on_hover_text(way), || Action::Lesson(LessonCommand::Tree(!unfolded)));
        if unfolded {
            panel.show(ui, context);
        }
    });
}

/// The text of a title that folds the content below.
fn fold_title(ui: &Ui, rect: Rect, text: &str) {
    let colour = Palette::here(ui).text;
    let galley = theme::elided(ui, text, theme::bold(ui), colour, rect.width() - 16.0);
    let at = rect.left_center() + vec2(16.0, -0.5 * galley.size().y);
    ui.painter().galley(at, galley, colour);
}

/// A guest panel: the title, which folds it, and the content. Returns the total height if it is unfolded.
fn section(ui: &mut Ui, info: PanelInfo, panel: &mut Listed, context: &mut PanelContext<'_>) -> Option<f32> {
    ui.spacing_mut().item_spacing.y = 0.0;
    let top = ui.cursor().top();
    let folded = context.session().settings.folds(info.id);
    title(ui, info, folded, context);
    if folded {
        return None;
    }
    let title = ui.cursor().top() - top;
    // The rows of the scene list extend from edge to edge; text does not.
    let left = if info.place == Place::Left { 12 } else { 0 };
    let frame = Frame::new().inner_margin(Margin { left, right: 0, top: 0, bottom: END as i8 });
    let output = frame.show(ui, |ui| {
        // The scroll bar floats over a margin, so that nothing moves when it appears.
        ui.spacing_mut().scroll.floating_allocated_width = 0.0;
        let scroll = ScrollArea::vertical().id_salt(info.id).auto_shrink(false).min_scrolled_height(0.0);
        scroll.show(ui, |ui| {
            ui.reset_style();
            ui.set_max_width(ui.available_width() - 8.0);
            ui.push_id(info.id, |ui| panel.show(ui, context));
        })
    });
    Some((LINE + title + output.inner.content_size.y + END).ceil())
}

fn title(ui: &mut Ui, info: PanelInfo, folded: bool, context: &mut PanelContext<'_>) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let height = narrow::high(ui.ctx(), TITLE);
        ui.set_min_height(height);
        ui.add_space(if info.place == Place::Left { 8.0 } else { 0.0 });
        let width = ui.available_width() - icon::SIZE - 8.0;
        let (rect, _) = ui.allocate_exact_size(vec2(width, height), Sense::hover());
        let id = Id::new(("title of a section", info.id));
        let response = icon::fold(ui, rect, id, info.title, !folded);
        let text = glyphs::legible(ui, info.title, &format!("the panel “{}”", info.id));
        fold_title(ui, rect, &text);
        let button = response.on_hover_text(if folded { "Unfold the panel" } else { "Fold the panel" });
        context.on_click(&button, || Action::View(ViewChange::Fold(info.id.to_owned(), !folded)));
        let tip = format!("Hide “{text}”; View › Panels shows it again");
        let button = icon::button(ui, Icon::Cross, &tip);
        context.on_click(&button, || Action::View(ViewChange::Panel(info.id.to_owned(), false)));
    });
}

/// Minimum height of the strip with the shaders, in points.
const SHADER_STRIP: f32 = 184.0;
/// Minimum height of the strip that explains a pixel, in points and as a fraction of the window.
const EXPLAIN_STRIP: (f32, f32) = (200.0, 0.37);

/// Minimum height of the strip with the plots, in points.
const PLOT_STRIP: f32 = 312.0;

/// Minimum height of the strip with the editor, in points.
const CODE_STRIP: f32 = 240.0;

/// Minimum height of the strip with the materials, in points: a row of them.
const MATERIAL_STRIP: f32 = 212.0;

/// Height of the tabs, with the borders of the strip, in points.
pub(super) const TABS: f32 = 40.0;
/// Fraction of the height of a window that the strip takes at most, and the one that the picture keeps unless the user
/// gives the strip more.
const STRIP: f32 = 0.6;
const PICTURE: f32 = 0.4;
/// Minimum height of the strip in any window, in points.
const LOWEST: f32 = 48.0;
/// Fraction of the height of a panel that it gets at the cost of the picture: scrolling by so little is not worth it.
const LITTLE: f32 = 0.1;

/// The strip at the bottom, with its height, and true if the user has given it that. Tabs appear if there is more than
/// one panel.
pub(super) fn bottom(
    ui: &mut Ui,
    panels: &mut Panels,
    whole: Rect,
    (height, is_given): (&mut f32, bool),
    context: &mut PanelContext<'_>,
) {
    let session = context.session();
    let (kind, least, start) = heights(&session.view.bottom_tab, whole);
    let usual = usual_most(ui, whole, least, context);
    let most = if is_given { STRIP * whole.height() } else { usual };
    let low = least.min(usual);
    let first = height.max(low).max(start).min(most);
    let id = Id::new(("bottom", zoom_percent(ui.ctx()), kind));
    let before = PanelState::load(ui.ctx(), id).map_or(first, |state| state.size().y).clamp(low, most);
    let before = before.min(ui.available_height());
    let strip = egui::Panel::bottom(id)
        .frame(theme::panel_frame(&Palette::of(&session.settings), vec2(12.0, 4.0)))
        .resizable(true)
        .default_size(first)
        .size_range(low..=most);
    let response = strip.show(ui, |ui| {
        let mut all: Vec<_> = panels.at(Place::Bottom, session).collect();
        let shown = all.iter().position(|(info, _)| info.id == session.view.bottom_tab).unwrap_or(0);
        ui.horizontal(|ui| {
            tabs(ui, &all, shown, context);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let says = keys::hint(ui.ctx(), "Fold the strip away", "panel.messages");
                let button = icon::button(ui, Icon::Down, &says);
                context.on_click(&button, || Action::View(ViewChange::Bottom(false)));
            });
        });
        if let Some((info, panel)) = all.get_mut(shown) {
            // The materials scroll as a whole by themselves.
            let is_low = low < least && info.id != MATERIALS_TAB;
            let own = if is_low { vec2(0.0, least - TABS) } else { Vec2::ZERO };
            scrolled(ui, info, panel, own, context);
        }
        ui.take_available_height();
    });
    focus::region(ui.ctx(), Region::Panel(Place::Bottom), response.response.rect);
    // Only a drag of its edge gives it another height.
    let shown = response.response.rect.height();
    if shown > low + 1.0 && (shown - before).abs() > 1.0 {
        *height = shown;
    }
}

/// Maximum height of the strip that nobody has given one, whose panel needs at least so much.
fn usual_most(ui: &Ui, whole: Rect, least: f32, context: &PanelContext<'_>) -> f32 {
    let before = context.area().rect;
    let width = if before.is_positive() { before.width() } else { PICTURE * whole.width() };
    let left = left_below(ui, whole, width, context);
    let most = if left >= (1.0 - LITTLE) * least { left.max(least) } else { left };
    most.max(LOWEST).min(STRIP * whole.height())
}

/// The height that is left below a picture of this width, with the headers and the bar of compared views, if it keeps its
/// part of the window.
pub(super) fn left_below(ui: &Ui, whole: Rect, width: f32, context: &PanelContext<'_>) -> f32 {
    let mut left = ui.available_height() - PICTURE * whole.height();
    // The bar has fewer rows in less room.
    for _ in 0..4 {
        let room = vec2(width, (ui.available_height() - left).max(0.0));
        let room = Rect::from_min_size(whole.min, room);
        let picture = compare::arrange(context.session(), room, 0.0, 0.0).picture.height().max(0.0);
        left -= (PICTURE * whole.height() - picture).max(0.0);
    }
    left
}

/// The kind of a panel in the strip, of which each has a height of its own, its minimum height with the tabs, and the
/// height that it begins with where there is room.
pub(super) fn heights(tab: &str, whole: Rect) -> (u8, f32, f32) {
    // High enough for a complete error with its source line.
    let share = |(least, part): (f32, f32)| least.max(part * whole.height());
    match tab {
        SHADER_TAB => (1, SHADER_STRIP, 0.0),
        EXPLAIN_TAB => (2, share(EXPLAIN_STRIP), 0.0),
        // A plot is large if there is room.
        PLOTS_TAB => (3, PLOT_STRIP, 0.36 * whole.height()),
        CODE_TAB => (4, CODE_STRIP, 0.45 * whole.height()),
        MATERIALS_TAB => (5, MATERIAL_STRIP, 0.34 * whole.height()),
        MESSAGES_TAB => (0, 72.0, 0.0),
        _ => (6, 72.0, 0.0),
    }
}

/// A panel that scrolls where it has less room than it needs, as guests do in any.
pub(super) fn scrolled(
    ui: &mut Ui,
    info: &PanelInfo,
    panel: &mut Listed,
    least: Vec2,
    context: &mut PanelContext<'_>,
) {
    let room = ui.available_size();
    if !info.guest && room.x >= least.x && room.y >= least.y {
        return panel.show(ui, context);
    }
    let area = ScrollArea::new([room.x < least.x, true]).id_salt(info.id).auto_shrink(false);
    area.min_scrolled_height(0.0).show(ui, |ui| {
        // The scroll bar floats over this margin.
        let inner = room - vec2(8.0, 0.0);
        if info.guest {
            ui.set_max_width(inner.x);
            return panel.show(ui, context);
        }
        let (rect, _) = ui.allocate_exact_size(inner.max(least), Sense::hover());
        ui.scope_builder(UiBuilder::new().max_rect(rect), |ui| panel.show(ui, context));
    });
}

/// The tabs of panels, with their notes.
fn tabs(ui: &mut Ui, all: &[(PanelInfo, &mut Listed)], shown: usize, context: &mut PanelContext<'_>) {
    let palette = Palette::here(ui);
    for (i, (info, panel)) in all.iter().enumerate() {
        let title = glyphs::legible(ui, info.title, &format!("the panel “{}”", info.id));
        let text = theme::strong(ui, title);
        let text = if i == shown { text } else { text.color(palette.weak) };
        if all.len() == 1 {
            ui.label(text);
            continue;
        }
        let mut button = Button::selectable(i == shown, text);
        if let Some((severity, note)) = panel.note(context.session()) {
            button = button.right_text(theme::strong(ui, note).color(palette.severity(severity)));
        }
        let button = ui.add(button);
        if i == shown {
            focus::first(ui.ctx(), button.id);
        }
        point::tab(ui, info.id, button.rect);
        context.on_click(&button, || Action::View(ViewChange::BottomTab(info.id.to_owned())));
    }
}
