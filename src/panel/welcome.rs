//! The examples: a menu of them, and the strip below the picture that shows them when the window opens without a file.

use bevy_egui::egui::{
    self, Align, Context, Label, Layout, Rect, Response, ScrollArea, Sense, Stroke, StrokeKind, TextStyle,
    Ui, WidgetInfo, WidgetType, vec2,
};

use super::{
    focus::{self, Region},
    icon::{self, Icon},
    keys, maths,
    preview::{self, Source},
    state::{Action, PictureArea, Session, ViewChange},
    theme::{self, Palette},
};
use crate::{registry::Registry, scene::examples::EXAMPLES};

/// The size of a picture in the strip, points.
const CARD: egui::Vec2 = vec2(112.0, 63.0);
/// The room of the scroll bar below the titles, points.
const BAR: f32 = 10.0;
/// The size of one in the menu.
const ROW: egui::Vec2 = vec2(96.0, 54.0);
/// The least height of strip and picture together, points.
const LEAST: f32 = 320.0;
/// Width of the menu, at most and at least.
const MENU: [f32; 2] = [580.0, 260.0];

/// The strip below the picture.
pub fn strip(ui: &mut Ui, session: &Session, registry: &Registry) -> Vec<Action> {
    let mut actions = Vec::new();
    // The picture comes first; the menu has the examples too.
    if !session.view.examples_open || ui.available_height() < LEAST {
        return actions;
    }
    let palette = Palette::here(ui);
    let panel = egui::Panel::bottom("examples").frame(theme::panel_frame(&palette, vec2(12.0, 4.0)));
    let shown = panel.show(ui, |ui| {
        ui.horizontal(|ui| {
            ui.label(theme::strong(ui, "Examples"));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                if icon::button(ui, Icon::Cross, "Close the examples (Esc); they stay under File › Examples")
                    .clicked()
                {
                    actions.push(Action::View(ViewChange::Examples(false)));
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let hint = theme::small(ui, "open as new scenes; also in the File menu");
                    ui.add(Label::new(hint).truncate());
                });
            });
        });
        let font = TextStyle::Small.resolve(ui.style());
        let title = |name: &str| ui.painter().layout(name.to_owned(), font.clone(), palette.text, CARD.x);
        let titles: Vec<_> = EXAMPLES.iter().map(|example| title(&example.name)).collect();
        let below = 4.0 + titles.iter().map(|galley| galley.size().y).fold(0.0, f32::max) + BAR;
        // Wheels turn up and down.
        ui.style_mut().always_scroll_the_only_direction = true;
        ScrollArea::horizontal().auto_shrink([false, true]).show(ui, |ui| {
            ui.horizontal_top(|ui| {
                for ((i, example), galley) in EXAMPLES.iter().enumerate().zip(titles) {
                    let (rect, response) = ui.allocate_exact_size(CARD + vec2(0.0, below), Sense::click());
                    let picture = Rect::from_min_size(rect.min, CARD);
                    face(ui, i, picture, &response, registry);
                    ui.painter().galley(picture.left_bottom() + vec2(0.0, 4.0), galley, palette.text);
                    frame(ui, picture, &response);
                    if response.clicked() {
                        actions.push(Action::OpenExample(i));
                    }
                    response.on_hover_ui(|ui| {
                        ui.set_max_width(320.0);
                        ui.label(theme::strong(ui, &example.name));
                        ui.label(maths::prose(ui, &example.description, TextStyle::Body));
                    });
                }
            });
        });
    });
    focus::region(ui.ctx(), Region::Examples, shown.response.rect);
    actions
}

/// Escape closes the strip, unless it is another's.
pub fn left(ctx: &Context, session: &Session, area: &PictureArea) -> Option<Action> {
    let left = session.view.examples_open && !session.view.presenting && keys::escapes(ctx, session, area);
    left.then_some(Action::View(ViewChange::Examples(false)))
}

/// The menu of the examples, beside one that ends at `left`: in two columns where one would be too long.
pub fn menu(ui: &mut Ui, left: f32, registry: &Registry, actions: &mut Vec<Action>) {
    let [most, least] = MENU;
    let room = ui.ctx().content_rect().right() - left - 40.0;
    // The menu moves up where it needs to.
    let height = ui.ctx().content_rect().height() - 40.0;
    let is_long = EXAMPLES.len() as f32 * (ROW.y + 8.0) > height;
    let columns = if is_long && room >= 2.0 * 1.4 * least { 2 } else { 1 };
    let width = (room / columns as f32).clamp(least, most);
    ui.set_width(columns as f32 * width);
    ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            let each = EXAMPLES.len().div_ceil(columns);
            for column in 0..columns {
                ui.vertical(|ui| {
                    ui.set_width(width);
                    for i in (column * each..EXAMPLES.len()).take(each) {
                        entry(ui, i, registry, actions);
                    }
                });
            }
        });
    });
}

/// An example with its picture, its name and its description.
fn entry(ui: &mut Ui, i: usize, registry: &Registry, actions: &mut Vec<Action>) {
    let example = &EXAMPLES[i];
    let palette = Palette::here(ui);
    let left = 4.0 + ROW.x + 10.0;
    let width = ui.available_width() - left - 12.0;
    let font = egui::FontId::new(TextStyle::Body.resolve(ui.style()).size, theme::semibold());
    let name = theme::elided(ui, &example.name, font, palette.text, width);
    let mut job = maths::prose(ui, &example.description, TextStyle::Small);
    job.wrap.max_width = width;
    let words = ui.painter().layout_job(job);
    let below = name.size().y + 3.0;
    let height = (below + words.size().y + 2.0).max(ROW.y) + 8.0;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 4.0, palette.hovered);
    }
    let picture = Rect::from_min_size(rect.min + vec2(4.0, 4.0), ROW);
    face(ui, i, picture, &response, registry);
    frame(ui, picture, &response);
    let at = rect.min + vec2(left, 5.0);
    ui.painter().galley(at + vec2(0.0, below), words, palette.text);
    ui.painter().galley(at, name, palette.text);
    if response.clicked() {
        actions.push(Action::OpenExample(i));
        ui.close();
    }
}

fn face(ui: &Ui, i: usize, rect: Rect, response: &Response, registry: &Registry) {
    let label = || format!("Example: {}", EXAMPLES[i].name);
    response.widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, label()));
    if ui.is_rect_visible(rect) {
        preview::paint(ui, rect, &preview::of(ui.ctx(), &Source::Example(i), registry));
    }
}

fn frame(ui: &Ui, rect: Rect, response: &Response) {
    let palette = Palette::here(ui);
    let stroke = if response.hovered() || response.has_focus() {
        Stroke::new(2.0, palette.accent)
    } else {
        Stroke::new(1.0, palette.line)
    };
    ui.painter().rect_stroke(rect, 2.0, stroke, StrokeKind::Inside);
}
