//! The open lesson, at the left: step, text, task, and navigation.

use std::path::Path;

use bevy_egui::egui::{Frame, Margin, Modifiers};

use super::{
    focus, narrow,
    prelude::*,
    state::{LessonSource, LinkTo, OpenLesson, problem_of},
};

pub mod check;
mod footer;
pub(super) mod list;
pub(super) mod point;
mod task;
mod text;

/// Font size in a presentation, as a fraction of the screen height.
const PRESENTED: f32 = 0.0235;
/// Fraction of the screen that the lesson takes in a presentation.
pub(super) const SHARE: f32 = 0.31;
/// Fraction of a narrow screen that it takes there, below the picture.
pub(super) const BELOW: f32 = 0.45;

/// The *Lesson* panel.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    if let Some(open) = &session.lesson {
        lesson(ui, session, open, &mut context.actions);
    }
}

/// Shows the lesson in all of `ui`.
fn lesson(ui: &mut Ui, session: &Session, open: &OpenLesson, actions: &mut Vec<Action>) {
    if session.view.presenting {
        enlarge(ui, PRESENTED * ui.ctx().content_rect().height());
    }
    let scale = theme::scale_here(ui);
    let side = (12.0 * scale) as i8;
    let margin = Margin { left: side, right: side, top: 4, bottom: 6 };
    let edge = |panel: egui::Panel| panel.frame(Frame::new().inner_margin(margin)).resizable(false);
    let (head, foot) = (egui::Panel::top("head of the lesson"), egui::Panel::bottom("foot of the lesson"));
    // Where the text has little room, all of it but the buttons scrolls.
    let scrolls = narrow::is(ui.ctx());
    if !scrolls {
        edge(head).show(ui, |ui| header(ui, session, open, actions));
    }
    edge(foot).show(ui, |ui| footer::footer(ui, open, actions));
    let whole = ui.available_rect_before_wrap();
    let turned = pages(ui.ctx(), whole);
    Frame::new().inner_margin(Margin { left: side, right: 4, top: 6, bottom: 0 }).show(ui, |ui| {
        // The scroll bar floats over a margin, so that nothing moves when it appears.
        ui.spacing_mut().scroll.floating_allocated_width = 0.0;
        // A step starts scrolled to the top.
        let area = ScrollArea::vertical().id_salt(("text of the lesson", open.entries)).auto_shrink(false);
        area.show(ui, |ui| {
            ui.set_max_width(ui.available_width() - f32::from(side) + 4.0);
            ui.spacing_mut().item_spacing.y = 7.0 * scale;
            if turned != 0.0 {
                ui.scroll_with_delta(vec2(0.0, turned * 0.8 * whole.height()));
            }
            if scrolls {
                header(ui, session, open, actions);
            }
            problems(ui, open);
            body(ui, open, actions);
            ui.add_space(12.0);
        });
    });
}

/// Scales all text styles to a body size in points.
fn enlarge(ui: &mut Ui, body: f32) {
    let style = ui.style_mut();
    let now = style.text_styles.get(&TextStyle::Body).map_or(body, |font| font.size);
    let factor = body / now;
    style.text_styles.values_mut().for_each(|font| font.size *= factor);
    style.spacing.item_spacing *= factor;
    style.spacing.button_padding *= factor;
    style.spacing.interact_size *= factor;
}

/// Page Up and Page Down scroll the text while the lesson has the focus: +1 for a page up, −1 for a page down.
fn pages(ctx: &Context, whole: Rect) -> f32 {
    let here = focus::focused(ctx).is_some_and(|widget| whole.x_range().contains(widget.rect.center().x));
    if !here {
        return 0.0;
    }
    ctx.input_mut(|input| {
        let up = input.consume_key(Modifiers::NONE, Key::PageUp);
        let down = input.consume_key(Modifiers::NONE, Key::PageDown);
        f32::from(i8::from(up) - i8::from(down))
    })
}

/// The title, the number of the step, and the progress.
fn header(ui: &mut Ui, session: &Session, open: &OpenLesson, actions: &mut Vec<Action>) {
    let count = open.lesson.steps.len();
    let width = ui.available_width();
    let room = width - 2.0 * (icon::SIZE + ui.spacing().item_spacing.x);
    let title = theme::title(ui, &open.lesson.title, room);
    let size = vec2(width, title.size().y.max(icon::SIZE));
    ui.allocate_ui_with_layout(size, Layout::right_to_left(Align::Center), |ui| {
        let says = format!("Leave the lesson: “{}” comes back", session.own_title());
        if icon::button(ui, Icon::Cross, &says).clicked() {
            actions.push(Action::Lesson(LessonCommand::Leave));
        }
        if icon::button(ui, Icon::Reset, "Begin this step again").clicked() {
            actions.push(Action::Lesson(LessonCommand::Again));
        }
        ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
            let cut = title.elided;
            let label = ui.add(Label::new(title));
            if cut {
                label.on_hover_text(&open.lesson.title);
            }
        });
    });
    ui.horizontal(|ui| {
        let words = format!("Step {} of {count}", open.step + 1);
        let text = theme::small(ui, format!("{words} ▾"));
        let button = ui.menu_button(text, |ui| steps(ui, open, actions));
        button.response.on_hover_text("Go to another step");
        bar(ui, open, &words);
    });
}

/// The list of the steps.
fn steps(ui: &mut Ui, open: &OpenLesson, actions: &mut Vec<Action>) {
    ui.set_max_width(narrow::wide(ui.ctx(), 360.0, ui.spacing().menu_margin.sum().x));
    let wraps = narrow::is(ui.ctx());
    ScrollArea::vertical().max_height(ui.ctx().content_rect().height() - 160.0).show(ui, |ui| {
        for (i, step) in open.lesson.steps.iter().enumerate() {
            let done = if open.done.contains(&i) { "  ✓" } else { "" };
            let text = format!("{}. {}{done}", i + 1, step.title);
            let button = Button::selectable(i == open.step, text);
            if ui.add(if wraps { button.wrap() } else { button }).clicked() {
                actions.push(Action::Lesson(LessonCommand::GoTo(i)));
                ui.close();
            }
        }
    });
    if matches!(open.source, LessonSource::Shipped(_)) {
        ui.separator();
        if ui.button("Copy link to this step").clicked() {
            actions.push(Action::CopyLink(LinkTo::Step));
            ui.close();
        }
    }
}

/// A mark for each step: the current one and those before are filled.
fn bar(ui: &mut Ui, open: &OpenLesson, says: &str) {
    let palette = Palette::here(ui);
    let count = open.lesson.steps.len().max(1) as f32;
    let height = 4.0 * theme::scale_here(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), 16.0), Sense::hover());
    theme::says(&response, WidgetType::ProgressIndicator, says);
    let gap = if rect.width() / count > 8.0 { 3.0 } else { 1.0 };
    let width = (rect.width() - gap * (count - 1.0)) / count;
    for i in 0..open.lesson.steps.len() {
        let left = rect.left() + i as f32 * (width + gap);
        let mark = Rect::from_min_size(pos2(left, rect.center().y - 0.5 * height), vec2(width, height));
        let fill = if i <= open.step { palette.accent } else { palette.line };
        ui.painter().rect_filled(mark, 0.5 * height, fill);
    }
}

/// Problems of the edited file, while the last good version is shown.
fn problems(ui: &mut Ui, open: &OpenLesson) {
    if open.problems.is_empty() {
        return;
    }
    let palette = Palette::here(ui);
    let frame = Frame::new().fill(palette.field).corner_radius(4.0).inner_margin(8.0);
    frame.stroke(Stroke::new(1.0, palette.error)).show(ui, |ui| {
        ui.set_min_width(ui.available_width());
        ui.add(Label::new(theme::strong(ui, "The file has errors; this is the last good version.")).wrap());
        for problem in &open.problems {
            let text = match &open.source {
                LessonSource::File(path) => {
                    problem_of(Path::new(path.file_name().unwrap_or_default()), problem)
                }
                LessonSource::Shipped(_) => problem.to_string(),
            };
            icon::remark(ui, [14.0, 18.0], Severity::Error, Label::new(text).wrap().selectable(true));
        }
    });
}

/// The text and the task of the step.
fn body(ui: &mut Ui, open: &OpenLesson, actions: &mut Vec<Action>) {
    let Some(step) = open.now() else { return };
    ui.add(Label::new(RichText::new(&step.title).heading()).wrap());
    let unmet = check::unmet(ui.ctx());
    for block in &step.blocks {
        text::block(ui, block, |ui| {
            if let Some(task) = &step.task {
                task::task(ui, open, task, unmet.as_deref(), actions);
            }
        });
    }
}
