//! The views of a comparison in the picture: their places, headers, and the edge of a wipe.

use bevy_egui::egui::{
    self, Align, Align2, Button, CursorIcon, Id, Key, Layout as Direction, Pos2, Rect, RichText, Sense,
    Stroke, StrokeKind, TextStyle, Ui, UiBuilder, WidgetInfo, WidgetType, pos2, vec2,
};

mod bar;

use bar::{NARROW, ROW, bar};

use super::{
    caption::Lines,
    icon::{self, Icon},
    keys, knob, matching,
    state::{Action, Cell, CompareCommand, MatchCommand, Session},
    theme::{self, Palette},
};
use crate::{
    caption::{Part, line, view_parts},
    registry::Registry,
    scene::{
        Comparison,
        comparison::{Edge, Layout},
        variant::{LETTERS, MAX_VARIANTS},
    },
};

/// Height of a header, points.
const HEADER: f32 = 28.0;
/// Between views, points.
const GAP: f32 = 2.0;
/// Width of the place in which the edge of a wipe can be grasped, points.
const GRASP: f32 = 14.0;
/// One press of a key moves the edge by so much.
const STEP: f32 = 0.02;

/// The places of everything that belongs to a comparison.
#[derive(Clone, Debug, PartialEq)]
pub struct Arrangement {
    /// The views; all have the same size.
    pub cells: Vec<Cell>,
    /// The headers, by view.
    headers: Vec<(usize, Rect)>,
    /// The bar below.
    bar: Option<Rect>,
    /// The picture, headers and bar apart.
    pub picture: Rect,
    /// The map of the difference.
    pub map: Option<Rect>,
    /// The place of a fourth view where there are three.
    vacant: Option<Rect>,
}

impl Default for Arrangement {
    fn default() -> Self {
        Self {
            cells: Vec::new(),
            headers: Vec::new(),
            bar: None,
            picture: Rect::NOTHING,
            map: None,
            vacant: None,
        }
    }
}

impl Arrangement {
    /// True if the scene has no variants, so that there is nothing but the picture.
    #[must_use]
    pub fn is_single(&self) -> bool {
        self.headers.is_empty()
    }
}

/// Arranges the views of a session in the place that the panels leave. In a presentation there is no bar, but a footer of
/// this height.
#[must_use]
pub fn arrange(session: &Session, whole: Rect, footer: f32) -> Arrangement {
    let variants = session.document.variants.len();
    if variants == 0 {
        let cells = vec![Cell { view: 0, rect: whole, part: whole }];
        return Arrangement { cells, picture: whole, ..Arrangement::default() };
    }
    let comparison = &session.document.comparison;
    let rows = match comparison.layout {
        _ if session.view.presenting => 0.0,
        _ if whole.width() < NARROW => match comparison.layout {
            Layout::Difference => 4.0,
            Layout::Wipe => 3.0,
            _ => 2.0,
        },
        Layout::Wipe | Layout::Difference => 2.0,
        _ => 1.0,
    };
    let bar = Rect::from_min_max(pos2(whole.left(), whole.bottom() - rows * ROW), whole.max);
    let picture = Rect::from_min_max(whole.min, pos2(whole.right(), bar.top() - footer));
    // Large enough for the last row.
    let high = if session.view.presenting { (0.055 * whole.height()).max(HEADER) } else { HEADER };
    let below_header = |rect: Rect| Rect::from_min_max(rect.min + vec2(0.0, high), rect.max);
    let header = |rect: Rect| Rect::from_min_size(rect.min, vec2(rect.width(), high));
    let halves = |rect: Rect| {
        let middle = rect.center().x;
        [rect.with_max_x(middle - 0.5 * GAP), rect.with_min_x(middle + 0.5 * GAP)]
    };
    let mut all = Arrangement { bar: (rows > 0.0).then_some(bar), ..Arrangement::default() };
    let views = comparison.views(variants);
    match comparison.layout {
        Layout::SideBySide => {
            let lines = if views.len() > 2 { 2 } else { 1 };
            let height = (picture.height() - (lines - 1) as f32 * GAP) / lines as f32;
            let shown: Vec<_> = views.into_iter().map(Some).chain([None]).collect();
            for (i, view) in shown.into_iter().enumerate().take(2 * lines) {
                let top = picture.top() + (i / 2) as f32 * (height + GAP);
                let line = Rect::from_min_size(pos2(picture.left(), top), vec2(picture.width(), height));
                let place = halves(line)[i % 2];
                let rect = below_header(place);
                match view {
                    Some(view) => {
                        all.headers.push((view, header(place)));
                        all.cells.push(Cell { view, rect, part: rect });
                    }
                    None => all.vacant = Some(place),
                }
            }
        }
        Layout::Single => {
            let rect = below_header(picture);
            let view = match session.active() {
                0 if session.view.blinking => comparison.with.min(variants),
                _ if session.view.blinking => 0,
                active => active,
            };
            all.headers.push((view, header(picture)));
            all.cells.push(Cell { view, rect, part: rect });
        }
        Layout::Wipe | Layout::Difference | Layout::Blink => {
            let rect = below_header(picture);
            for (view, place) in views.iter().zip(halves(header(picture))) {
                all.headers.push((*view, place));
            }
            let parts = match comparison.layout {
                Layout::Wipe => parts(rect, comparison),
                Layout::Difference => {
                    all.map = Some(rect);
                    [Rect::NOTHING; 2]
                }
                _ if session.view.blinking => [Rect::NOTHING, rect],
                _ => [rect, Rect::NOTHING],
            };
            all.cells.extend(views.iter().zip(parts).map(|(view, part)| Cell { view: *view, rect, part }));
        }
    }
    let first = all.cells.iter().map(|cell| cell.rect);
    all.picture = first.reduce(Rect::union).unwrap_or(picture);
    all
}

/// The parts of a rectangle at both sides of the edge of a wipe.
fn parts(rect: Rect, comparison: &Comparison) -> [Rect; 2] {
    let edge = edge_of(rect, comparison);
    match comparison.edge {
        Edge::Vertical => [rect.with_max_x(edge.x), rect.with_min_x(edge.x)],
        Edge::Horizontal => [rect.with_max_y(edge.y), rect.with_min_y(edge.y)],
    }
}

/// The point of the edge of a wipe in the middle of its length.
fn edge_of(rect: Rect, comparison: &Comparison) -> Pos2 {
    match comparison.edge {
        Edge::Vertical => pos2(rect.left() + comparison.split * rect.width(), rect.center().y),
        Edge::Horizontal => pos2(rect.center().x, rect.top() + comparison.split * rect.height()),
    }
}

/// Shows headers, edge and bar. Returns what was asked for, and the places that do not belong to the picture.
pub fn show(
    ui: &mut Ui,
    arrangement: &Arrangement,
    session: &Session,
    registry: &Registry,
) -> (Vec<Action>, Vec<Rect>) {
    let (mut actions, mut places) = (Vec::new(), Vec::new());
    let held = keys::of(ui.ctx(), "blink").is_some_and(|blink| ui.input(|i| i.key_down(blink.key)));
    if session.view.blinking && !held {
        actions.push(Action::Compare(CompareCommand::Blink(false)));
    }
    let palette = Palette::here(ui);
    let several = arrangement.cells.len() > 1;
    for (view, rect) in &arrangement.headers {
        places.push(*rect);
        header(ui, *view, *rect, several, session, registry, &mut actions);
    }
    let comparison = &session.document.comparison;
    if several && comparison.layout == Layout::SideBySide {
        for cell in arrangement.cells.iter().filter(|cell| cell.view == session.active()) {
            let stroke = Stroke::new(1.5, palette.accent);
            ui.painter().rect_stroke(cell.rect, 0.0, stroke, StrokeKind::Inside);
        }
    }
    if let Some(rect) = arrangement.vacant {
        let font = TextStyle::Body.resolve(ui.style());
        ui.painter().rect_filled(rect, 0.0, palette.panel);
        let words = format!("{} adds a view", keys::word(ui.ctx(), "add_view"));
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, words, font, palette.weak);
        places.push(rect);
    }
    if comparison.layout == Layout::Wipe && several && !session.view.presenting {
        places.push(wipe(ui, arrangement.picture, comparison, &mut actions));
    }
    if let Some(rect) = arrangement.bar {
        places.push(rect);
        bar(ui, rect, session, &mut actions);
    }
    (actions, places)
}

/// The letter of a view, its difference from A, and its menu.
fn header(
    ui: &mut Ui,
    view: usize,
    rect: Rect,
    several: bool,
    session: &Session,
    registry: &Registry,
    actions: &mut Vec<Action>,
) {
    let palette = Palette::here(ui);
    let active = session.active() == view;
    ui.painter().rect_filled(rect, 0.0, palette.panel);
    let rule = if active && several { palette.accent } else { palette.line };
    ui.painter().hline(
        rect.x_range(),
        rect.bottom() - 1.0,
        Stroke::new(if active { 2.0 } else { 1.0 }, rule),
    );
    let letter = LETTERS[view.min(MAX_VARIANTS)];
    let parts = in_parts(session, view, registry);
    let text = line(&parts);
    let comparison = &session.document.comparison;
    // Of views that are shown in turn, the one on screen stands out.
    let hidden =
        comparison.layout == Layout::Blink && view != if session.view.blinking { comparison.with } else { 0 };
    let lit = if comparison.layout == Layout::Blink { !hidden } else { active };
    let ink = if hidden { palette.weak } else { palette.text };
    let scale = rect.height() / HEADER;
    let click = ui.interact(rect, Id::new(("view header", view)), Sense::click());
    click.widget_info(|| {
        WidgetInfo::selected(WidgetType::RadioButton, true, active, format!("View {letter}: {text}"))
    });
    if click.clicked() {
        actions.push(Action::Compare(CompareCommand::Activate(view)));
    }
    let inner = rect.shrink2(vec2(6.0, 2.0));
    ui.scope_builder(
        UiBuilder::new().max_rect(inner).layout(Direction::right_to_left(Align::Center)),
        |ui| {
            if !session.view.presenting {
                menu(ui, view, session, actions);
            }
            if !several && session.document.comparison.layout == Layout::Single {
                for other in (0..=session.document.variants.len()).rev() {
                    let name = LETTERS[other];
                    let on = other == view;
                    let text =
                        RichText::new(name).small().color(if on { palette.text } else { palette.weak });
                    let button = ui.add(Button::new(text).selected(on).min_size(vec2(22.0, 20.0)));
                    button.widget_info(|| {
                        WidgetInfo::selected(WidgetType::RadioButton, true, on, format!("Show view {name}"))
                    });
                    if button.clicked() {
                        actions.push(Action::Compare(CompareCommand::Activate(other)));
                    }
                    button
                        .on_hover_text(format!("View {name}: {}", line(&in_parts(session, other, registry))));
                }
            }
            ui.with_layout(Direction::left_to_right(Align::Center), |ui| {
                let size = scale * TextStyle::Body.resolve(ui.style()).size;
                let badge = egui::Rect::from_center_size(
                    pos2(ui.max_rect().left() + 10.0 * scale, rect.center().y),
                    vec2(20.0, 20.0) * scale,
                );
                let (fill, on) = if lit { (palette.accent, palette.panel) } else { (palette.field, ink) };
                ui.painter().rect(badge, 4.0, fill, Stroke::new(1.0, palette.line), StrokeKind::Inside);
                let font = egui::FontId::new(size, theme::semibold());
                ui.painter().text(badge.center(), Align2::CENTER_CENTER, letter, font, on);
                let room = (ui.max_rect().width() - 30.0 * scale).max(0.0);
                let at = badge.right_center() + vec2(8.0, 0.0) * scale;
                // With symbols as in the equation, if the words have room. A presentation says the rest below.
                let dots = theme::elided(ui, ", …", egui::FontId::proportional(size), ink, room);
                let less = if session.view.presenting { 0.0 } else { dots.size().x };
                let all = parts.len();
                let parts = fitting(ui, parts, size, ink, room - less);
                let cut = parts.len() < all && !session.view.presenting;
                let lines = Lines::within(ui, parts, size, ink, room, 1);
                if lines.size.y < 1.9 * size && lines.size.x <= room {
                    let place = Align2::LEFT_CENTER.anchor_size(at, lines.size);
                    if cut {
                        ui.painter().galley(place.right_top(), dots, ink);
                    }
                    lines.paint(ui, place.min, ink);
                } else {
                    let galley = theme::elided(ui, &text, egui::FontId::proportional(size), ink, room);
                    let at = Align2::LEFT_CENTER.anchor_size(at, galley.size());
                    ui.painter().galley(at.min, galley, ink);
                }
            });
        },
    );
    click.on_hover_ui(|ui| {
        ui.set_max_width(320.0);
        ui.label(theme::strong(ui, format!("View {letter}")));
        ui.label(if view == 0 { "The scene itself.".to_owned() } else { text });
        ui.label(theme::small(ui, "Click: the panels show and change this view."));
    });
}

/// The first of some parts: as many as fit into one line.
fn fitting(ui: &Ui, mut parts: Vec<Part>, size: f32, ink: egui::Color32, room: f32) -> Vec<Part> {
    while parts.len() > 1 {
        let lines = Lines::within(ui, parts.clone(), size, ink, room, 1);
        if lines.size.y < 1.9 * size && lines.size.x <= room {
            break;
        }
        parts.pop();
    }
    parts
}

/// A view in words: its name, unless what it shows says the same, and what it shows.
fn in_parts(session: &Session, view: usize, registry: &Registry) -> Vec<Part> {
    let shown = view_parts(&session.document, view, registry);
    let said = line(&shown).to_lowercase();
    let name = view.checked_sub(1).and_then(|i| session.document.variants.get(i)?.name.as_deref());
    let name = name.filter(|name| !said.contains(&name.to_lowercase()));
    name.map(|name| Part::new(0, name)).into_iter().chain(shown).collect()
}

/// What can be done with a view.
fn menu(ui: &mut Ui, view: usize, session: &Session, actions: &mut Vec<Action>) {
    let letter = LETTERS[view.min(MAX_VARIANTS)];
    let button = icon::button(ui, Icon::Down, &format!("Menu of view {letter}"));
    let id = ui.make_persistent_id(("view menu", view));
    let chosen = knob::drop_down(&button, id, 176.0, |ui, _| {
        let mut chosen = None;
        let mut item = |ui: &mut Ui, text: String, command: CompareCommand| {
            if ui.add(Button::new(text).frame(false)).clicked() {
                chosen = Some(command);
                egui::Popup::close_id(ui.ctx(), id);
            }
        };
        if view > 0 {
            item(ui, format!("Make {letter} like A"), CompareCommand::LikeA(view));
            item(ui, format!("Swap A and {letter}"), CompareCommand::Swap(view));
            if matching::entry(ui, view) {
                actions.push(Action::Match(MatchCommand::Ask(view)));
                egui::Popup::close_id(ui.ctx(), id);
            }
            item(ui, format!("Remove view {letter}"), CompareCommand::Remove(view));
            ui.separator();
        }
        if session.document.variants.len() < MAX_VARIANTS {
            item(ui, "Add a view".to_owned(), CompareCommand::Add);
        } else {
            ui.label(theme::small(ui, "A scene has at most four views."));
        }
        chosen
    });
    actions.extend(chosen.map(Action::Compare));
}

/// The edge of a wipe, with a handle. Returns the place that it takes from the picture.
fn wipe(ui: &mut Ui, rect: Rect, comparison: &Comparison, actions: &mut Vec<Action>) -> Rect {
    let at = edge_of(rect, comparison);
    let upright = comparison.edge == Edge::Vertical;
    let (place, cursor) = if upright {
        (Rect::from_center_size(at, vec2(GRASP, rect.height())), CursorIcon::ResizeHorizontal)
    } else {
        (Rect::from_center_size(at, vec2(rect.width(), GRASP)), CursorIcon::ResizeVertical)
    };
    let response = ui.interact(place, Id::new("edge of the wipe"), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::slider(true, f64::from(comparison.split), "Edge between the views"));
    let painter = ui.painter_at(rect);
    let ends = if upright {
        [pos2(at.x, rect.top()), pos2(at.x, rect.bottom())]
    } else {
        [pos2(rect.left(), at.y), pos2(rect.right(), at.y)]
    };
    let on = response.hovered() || response.dragged() || response.has_focus();
    let core = if on { egui::Color32::from_rgb(0x7c, 0xc8, 0xff) } else { egui::Color32::WHITE };
    painter.line_segment(ends, Stroke::new(3.5, egui::Color32::from_black_alpha(160)));
    painter.line_segment(ends, Stroke::new(1.5, core));
    painter.circle(at, 9.0, egui::Color32::from_black_alpha(190), Stroke::new(1.5, core));
    let along = if upright { vec2(4.0, 0.0) } else { vec2(0.0, 4.0) };
    let across = if upright { vec2(0.0, 3.0) } else { vec2(3.0, 0.0) };
    for side in [-1.0, 1.0] {
        let tip = at + side * 1.5 * along;
        let back = at + side * 0.6 * along;
        painter.line(vec![back + across, tip, back - across], Stroke::new(1.5, core));
    }
    let mut split = comparison.split;
    if let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) {
        split = if upright {
            (pointer.x - rect.left()) / rect.width()
        } else {
            (pointer.y - rect.top()) / rect.height()
        };
    }
    if response.double_clicked() {
        split = 0.5;
    }
    if response.has_focus() {
        let keys = if upright { [Key::ArrowLeft, Key::ArrowRight] } else { [Key::ArrowUp, Key::ArrowDown] };
        ui.memory_mut(|m| {
            let filter = egui::EventFilter {
                horizontal_arrows: upright,
                vertical_arrows: !upright,
                ..Default::default()
            };
            m.set_focus_lock_filter(response.id, filter);
        });
        for (key, step) in keys.into_iter().zip([-STEP, STEP]) {
            if ui.input(|i| i.key_pressed(key)) {
                split += step;
            }
        }
    }
    if split != comparison.split {
        let split = (split.clamp(0.0, 1.0) * 1000.0).round() / 1000.0;
        actions.push(Action::Compare(CompareCommand::Set(Comparison { split, ..*comparison })));
    }
    response.on_hover_cursor(cursor).on_hover_text(
        "Drag the edge between the views. With the focus, arrow keys move it; double-click: the middle.",
    );
    place
}
