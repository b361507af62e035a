//! The start without a file: a strip below the picture offers a lesson, an example scene or a new model. Also the menu
//! of examples.

use bevy_egui::egui::text::LayoutJob;

use super::{
    command,
    focus::{self, Region},
    keys,
    lesson::list,
    maths, narrow,
    prelude::*,
    preview::{self, Source},
    state::LessonSource,
};
use crate::{lesson::shipped::LESSONS, parameter::Outside, scene::examples::EXAMPLES};

/// Size of a picture in the strip, in points.
const CARD: Vec2 = vec2(112.0, 63.0);
/// Height of the headings, in points.
const HEADING: f32 = 24.0;
/// Widths of the sections for lessons and for a new model, and the gap between sections, in points.
const LESSON: f32 = 184.0;
const MODEL: f32 = 148.0;
const GAP: f32 = 24.0;
/// Width below which the new model is just a button below the lessons, and the width of that section then, in points.
const WIDE: f32 = 600.0;
const NARROW: f32 = 150.0;
/// Tooltip of the section for a new model.
const MODEL_TIP: &str =
    "A model of your own is one file in WGSL: equation and knobs. The picture follows while you write it.";
/// Space for the scroll bar below the titles, in points.
const BAR: f32 = 10.0;
/// Size of a picture in the menu, in points.
const ROW: Vec2 = vec2(96.0, 54.0);
/// Minimum height of strip and picture together, in points.
const LEAST: f32 = 320.0;
/// Maximum and minimum width of the menu, in points.
const MENU: [f32; 2] = [580.0, 260.0];
/// Maximum number of lines of a description that is shortened.
const SHORT: usize = 2;

/// The strip below the picture, with three sections.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    if !context.session().view.examples_open {
        return;
    }
    if narrow::is(ui.ctx()) {
        return below_each_other(ui, context);
    }
    // The picture has priority; the menus offer the same.
    if ui.available_height() >= LEAST {
        strip(ui, context);
    }
}

/// The sections below each other, in a narrow window.
fn below_each_other(ui: &mut Ui, context: &mut PanelContext<'_>) {
    ScrollArea::vertical().id_salt("doors").auto_shrink(false).show(ui, |ui| {
        // The scroll bar floats over this margin.
        ui.set_max_width(ui.available_width() - 8.0);
        lesson_door(ui, context);
        let model = ui.button("New reflection model…").on_hover_text(MODEL_TIP);
        context.on_click(&model, || Action::Model(ModelCommand::New));
        heading(ui, "Examples", |ui| close(ui, context));
        let (titles, below) = titles(ui);
        ui.horizontal_wrapped(|ui| {
            for (i, title) in titles.iter().enumerate() {
                example(ui, i, title, below, context);
            }
        });
    });
}

/// The titles of the examples below their pictures, and the height that they take.
fn titles(ui: &Ui) -> (Vec<Arc<Galley>>, f32) {
    let (font, ink) = (TextStyle::Small.resolve(ui.style()), Palette::here(ui).text);
    let title = |name: &str| ui.painter().layout(name.to_owned(), font.clone(), ink, CARD.x);
    let titles: Vec<_> = EXAMPLES.iter().map(|example| title(&example.name)).collect();
    let below = 4.0 + titles.iter().map(|galley| galley.size().y).fold(0.0, f32::max) + BAR;
    (titles, below)
}

fn strip(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let palette = Palette::here(ui);
    let panel = egui::Panel::bottom("examples").frame(theme::panel_frame(&palette, vec2(12.0, 4.0)));
    let shown = panel.show(ui, |ui| {
        let (titles, below) = titles(ui);
        let size = vec2(ui.available_width(), HEADING + 4.0 + CARD.y + below);
        let whole = Rect::from_min_size(ui.available_rect_before_wrap().min, size);
        let wide = whole.width() >= WIDE;
        let lessons = if wide { LESSON } else { NARROW };
        let model = if wide { MODEL } else { 0.0 };
        let first = whole.left() + lessons + GAP;
        let last = whole.right() - if wide { model + GAP } else { 0.0 };
        let column = |ui: &mut Ui, from: f32, to: f32, show: &mut dyn FnMut(&mut Ui)| {
            let place = Rect::from_x_y_ranges(from..=to, whole.y_range());
            if from > whole.left() {
                let line = Stroke::new(1.0, palette.line);
                ui.painter().vline(from - 0.5 * GAP, place.shrink(4.0).y_range(), line);
            }
            show(&mut ui.new_child(UiBuilder::new().id_salt(from as i32).max_rect(place)));
        };
        column(ui, whole.left(), whole.left() + lessons, &mut |ui| {
            lesson_door(ui, context);
            if !wide && small_button(ui, "New model…").on_hover_text(MODEL_TIP).clicked() {
                context.act(Action::Model(ModelCommand::New));
            }
        });
        column(ui, first, last, &mut |ui| {
            heading(ui, "Examples", |ui| {
                if !wide {
                    return close(ui, context);
                }
                ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                    let hint = theme::small(ui, "open as new scenes; also in the File menu");
                    ui.add(Label::new(hint).truncate());
                });
            });
            cards(ui, &titles, below, context);
        });
        if wide {
            column(ui, whole.right() - model, whole.right(), &mut |ui| {
                heading(ui, "Your own model", |ui| close(ui, context));
                model_door(ui, context);
            });
        }
        ui.advance_cursor_after_rect(whole);
    });
    focus::region(ui.ctx(), Region::Panel(Place::Strip), shown.response.rect);
}

/// The heading of a section, with widgets at the right.
fn heading(ui: &mut Ui, text: &str, right: impl FnOnce(&mut Ui)) {
    ui.horizontal(|ui| {
        ui.set_height(HEADING);
        ui.label(theme::strong(ui, text));
        ui.with_layout(Layout::right_to_left(Align::Center), right);
    });
}

fn close(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let says = "Close this strip (Esc); its parts stay in the menus File, Edit and Help";
    context.on_click(&icon::button(ui, Icon::Cross, says), || Action::View(ViewChange::Examples(false)));
}

/// The examples, side by side.
fn cards(ui: &mut Ui, titles: &[Arc<Galley>], below: f32, context: &mut PanelContext<'_>) {
    // Mouse wheels scroll vertically only.
    ui.style_mut().always_scroll_the_only_direction = true;
    ScrollArea::horizontal().auto_shrink([false, true]).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            for (i, title) in titles.iter().enumerate() {
                example(ui, i, title, below, context);
            }
        });
    });
}

/// An example as a button, with its title below its picture.
fn example(ui: &mut Ui, i: usize, title: &Arc<Galley>, below: f32, context: &mut PanelContext<'_>) {
    let (palette, example) = (Palette::here(ui), &EXAMPLES[i]);
    let (rect, response) = ui.allocate_exact_size(CARD + vec2(0.0, below), Sense::click());
    let picture = Rect::from_min_size(rect.min, CARD);
    face(ui, i, picture, &response, context.registry());
    ui.painter().galley(picture.left_bottom() + vec2(0.0, 4.0), title.clone(), palette.text);
    frame(ui, picture, &response);
    context.on_click(&response, || Action::OpenExample(i));
    theme::tip(response, 320.0, |ui| {
        ui.label(theme::strong(ui, &example.name));
        ui.label(maths::prose(ui, &example.description, TextStyle::Body));
    });
}

/// The lesson to go on with, and below it all of them.
fn lesson_door(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let (session, registry) = (context.session(), context.registry());
    let palette = Palette::here(ui);
    heading(ui, "Lessons", |_| ());
    let Some(source) = session.progress.next() else { return };
    let past = session.progress.of(&source.name()).filter(|past| past.is_begun());
    let shipped = match source {
        LessonSource::Shipped(i) => LESSONS.get(i),
        LessonSource::File(_) => None,
    };
    let title = shipped.map(|lesson| lesson.title.as_str()).or(past.map(|past| past.title.as_str()));
    let title = title.unwrap_or_default();
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), CARD.y), Sense::click());
    let begun = past.map(|past| format!("Go on: {}", past.words()));
    let minutes = shipped.and_then(|lesson| lesson.minutes);
    let small = begun.unwrap_or_else(|| {
        let is_new = session.progress.lessons.values().all(|past| !past.finished && !past.is_begun());
        let way = if is_new { "Begin here" } else { "Next" };
        minutes.map_or_else(|| way.to_owned(), |minutes| format!("{way}: {minutes} min"))
    });
    theme::says(&response, WidgetType::Button, format!("{small}, {title}"));
    focus::first(ui.ctx(), response.id);
    card(ui, rect, &response);
    let inside = rect.shrink2(vec2(10.0, 7.0));
    let line = theme::elided(ui, &small, TextStyle::Small, palette.weak, inside.width());
    let at = inside.min + vec2(0.0, line.size().y + 1.0);
    ui.painter().galley(inside.min, line, palette.weak);
    let mut job = LayoutJob::simple(title.to_owned(), theme::bold(ui), palette.text, inside.width());
    job.wrap.max_rows = 2;
    ui.painter().galley(at, ui.painter().layout_job(job), palette.text);
    if let Some(past) = past {
        let bar = Rect::from_min_max(pos2(rect.left() + 2.0, rect.bottom() - 4.0), rect.max - vec2(2.0, 1.0));
        let part = bar.with_max_x(bar.left() + past.fraction() * bar.width());
        ui.painter().rect_filled(bar, 1.5, palette.line);
        ui.painter().rect_filled(part, 1.5, palette.accent);
    }
    context.on_click(&response, || Action::Lesson(LessonCommand::Continue));
    if let Some(lesson) = shipped {
        theme::tip(response, 320.0, |ui| {
            ui.label(theme::strong(ui, title));
            ui.label(maths::prose(ui, &lesson.summary, TextStyle::Body));
        });
    }
    let all = small_button(ui, "All lessons ▾");
    Popup::menu(&all).show(|ui| {
        list::entries(ui, session, &mut context.actions);
        command::show::entries(ui, command::LESSONS, session, registry, &mut context.actions);
    });
}

fn small_button(ui: &mut Ui, text: &str) -> Response {
    ui.spacing_mut().interact_size.y = 0.0;
    ui.add(Button::new(RichText::new(text).small()).small())
}

/// The section for a new model.
fn model_door(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let palette = Palette::here(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), CARD.y), Sense::click());
    theme::says(&response, WidgetType::Button, "New reflection model…");
    card(ui, rect, &response);
    let size = 22.0;
    let signs = ["f_r", "(", "L", ",", "V", ")"];
    let widths = signs.map(|sign| maths::symbol_width(ui, sign, size));
    let mut at = pos2(rect.center().x - 0.5 * widths.iter().sum::<f32>(), rect.center().y + 0.32 * size);
    for (sign, width) in signs.into_iter().zip(widths) {
        maths::paint_symbol(ui, at, sign, size, palette.text);
        at.x += width;
    }
    let words = theme::elided(ui, "New reflection model…", TextStyle::Small, palette.text, rect.width());
    ui.painter().galley(rect.left_bottom() + vec2(0.0, 4.0), words, palette.text);
    context.on_click(&response, || Action::Model(ModelCommand::New));
    response.on_hover_text(MODEL_TIP);
}

/// The background of a section without a picture.
fn card(ui: &Ui, rect: Rect, response: &Response) {
    let palette = Palette::here(ui);
    let fill = if theme::is_hot(response) { palette.hovered } else { palette.raised };
    ui.painter().rect_filled(rect, 2.0, fill);
    frame(ui, rect, response);
}

/// Closes the strip on Escape, unless something else handles the key.
pub fn on_escape(ctx: &Context, session: &Session, area: &PictureArea) -> Option<Action> {
    let leaves = session.view.examples_open && !session.view.presenting && keys::escapes(ctx, session, area);
    leaves.then_some(Action::View(ViewChange::Examples(false)))
}

/// The menu of the examples, beside a menu whose right edge is `left`: in up to three columns if one would be too long.
pub fn menu(ui: &mut Ui, left: f32, registry: &Registry, actions: &mut Vec<Action>) {
    let [most, least] = MENU;
    // Over the menu before it, if there is no room beside it.
    let narrow = narrow::is(ui.ctx());
    let left = if narrow { 0.0 } else { left };
    let room = ui.ctx().content_rect().right() - left - 40.0;
    let least = if narrow { least.min(room) } else { least };
    // The menu moves up if necessary.
    let height = ui.ctx().content_rect().height() - 40.0;
    let fits = |columns: &usize| EXAMPLES.len().div_ceil(*columns) as f32 * (ROW.y + 8.0) <= height;
    let has_room = |columns: &usize| *columns == 1 || room >= *columns as f32 * 1.4 * least;
    let columns = (1..=3).find(fits).unwrap_or(3);
    let columns = (1..=columns).rev().find(has_room).unwrap_or(1);
    let width = (room / columns as f32).clamp(least, most);
    ui.set_width(columns as f32 * width);
    let laid = |lines| -> (Vec<_>, Vec<_>) {
        let entries = (0..EXAMPLES.len()).map(|i| Entry::new(ui, i, width, lines));
        entries.map(|entry| (entry.height, entry)).unzip()
    };
    let fits = |heights: &[f32]| filled(heights, height).len() <= columns;
    let mut all = laid(usize::MAX);
    if !fits(&all.0) {
        // Descriptions are shortened if that saves scrolling; tooltips have the rest.
        all = Some(laid(SHORT)).filter(|short| fits(&short.0)).unwrap_or(all);
    }
    let (heights, entries) = all;
    let ends = balanced(&heights, columns);
    ScrollArea::vertical().max_height(height).min_scrolled_height(height).show(ui, |ui| {
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 0.0;
            let mut entries = entries.into_iter().enumerate();
            let mut first = 0;
            for end in ends {
                ui.vertical(|ui| {
                    ui.set_width(width);
                    let column = entries.by_ref().take(end - first);
                    column.for_each(|(i, laid)| entry(ui, i, laid, registry, actions));
                });
                first = end;
            }
        });
    });
}

/// The ends of columns that are as equally high as the order allows.
fn balanced(heights: &[f32], columns: usize) -> Vec<usize> {
    let columns = columns.max(1);
    let mut most = heights.iter().sum::<f32>() / columns as f32;
    loop {
        let ends = filled(heights, most);
        if ends.len() <= columns {
            return ends;
        }
        most += 8.0;
    }
}

/// The ends of columns filled up to a height, one after the other.
fn filled(heights: &[f32], most: f32) -> Vec<usize> {
    let (mut ends, mut height) = (Vec::new(), 0.0);
    for (i, one) in heights.iter().enumerate() {
        if height > 0.0 && height + one > most {
            ends.push(i);
            height = 0.0;
        }
        height += one;
    }
    ends.push(heights.len());
    ends
}

/// The texts of an entry, laid out.
struct Entry {
    name: Arc<Galley>,
    words: Arc<Galley>,
    /// Left and upper edge of the words in the entry.
    at: Vec2,
    height: f32,
}

impl Entry {
    /// The entry of an example with at most so many lines of description.
    fn new(ui: &Ui, i: usize, width: f32, lines: usize) -> Self {
        let example = &EXAMPLES[i];
        let left = 4.0 + ROW.x + 10.0;
        let width = width - left - 12.0;
        let name = theme::elided(ui, &example.name, theme::bold(ui), Palette::here(ui).text, width);
        let mut job = maths::prose(ui, &example.description, TextStyle::Small);
        job.wrap.max_width = width;
        job.wrap.max_rows = lines;
        let words = ui.painter().layout_job(job);
        let below = name.size().y + 3.0;
        let height = (below + words.size().y + 2.0).max(ROW.y) + 8.0;
        Self { name, words, at: vec2(left, below), height }
    }
}

/// The entry of an example: picture, name and description.
fn entry(ui: &mut Ui, i: usize, laid: Entry, registry: &Registry, actions: &mut Vec<Action>) {
    let palette = Palette::here(ui);
    let Entry { name, words, at, height } = laid;
    let (left, below) = (at.x, at.y);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 4.0, palette.hovered);
    }
    let picture = Rect::from_min_size(rect.min + vec2(4.0, 4.0), ROW);
    face(ui, i, picture, &response, registry);
    frame(ui, picture, &response);
    let at = rect.min + vec2(left, 5.0);
    let is_short = words.elided;
    ui.painter().galley(at + vec2(0.0, below), words, palette.text);
    ui.painter().galley(at, name, palette.text);
    let response = if is_short { maths::tip(response, &EXAMPLES[i].description) } else { response };
    if response.clicked() {
        actions.push(Action::OpenExample(i));
        ui.close();
    }
}

fn face(ui: &Ui, i: usize, rect: Rect, response: &Response, registry: &Registry) {
    theme::says(response, WidgetType::Button, format!("Example: {}", EXAMPLES[i].name));
    if ui.is_rect_visible(rect) {
        let preview = preview::of(ui.ctx(), &Source::Example(i), registry, Outside::NONE);
        preview::paint(ui, rect, &preview);
    }
}

fn frame(ui: &Ui, rect: Rect, response: &Response) {
    let palette = Palette::here(ui);
    let (width, edge) = if theme::is_hot(response) { (2.0, palette.accent) } else { (1.0, palette.line) };
    let stroke = Stroke::new(width, edge);
    ui.painter().rect_stroke(rect, 2.0, stroke, StrokeKind::Inside);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_are_equally_high_in_the_order_of_the_entries() {
        assert_eq!(balanced(&[1.0; 6], 3), [2, 4, 6]);
        assert_eq!(balanced(&[4.0, 1.0, 1.0, 1.0, 1.0], 2), [1, 5]);
        assert_eq!(balanced(&[5.0, 90.0], 1), [2]);
        assert!(balanced(&[3.0, 50.0, 2.0, 41.0, 7.0], 3).len() <= 3);
        assert_eq!(balanced(&[], 3), [0]);
    }
}
