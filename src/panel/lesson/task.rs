//! The task of a step: a multiple-choice question, or something to do or find.

use super::text::{job, paragraph, spoken};
use crate::{
    lesson::{AnswerChoice, Goal, Run, Task},
    panel::{maths, prelude::*, state::OpenLesson},
};

/// Width of the bar at the left of a task, in points.
const BAR: f32 = 3.0;
/// Width of the circle in front of an answer, in points.
const CIRCLE: f32 = 24.0;
/// Space above and below answers that are scrolled into sight, in points.
const MARGIN: f32 = 6.0;

/// Shows the task. `unmet` says why it is not done.
pub(super) fn task(
    ui: &mut Ui,
    open: &OpenLesson,
    task: &Task,
    unmet: Option<&str>,
    actions: &mut Vec<Action>,
) {
    let palette = Palette::here(ui);
    let scale = theme::scale_here(ui);
    ui.add_space(2.0);
    let [left, right, top, bottom] = [12.0, 10.0, 8.0, 10.0].map(|points| (points * scale) as i8);
    let margin = egui::Margin { left, right, top, bottom };
    let frame = egui::Frame::new().fill(palette.raised).corner_radius(6.0).inner_margin(margin);
    let shown = frame.show(ui, |ui| {
        ui.set_min_width(ui.available_width());
        let name = match task {
            Task::Predict { .. } => "Your prediction",
            Task::Do(_) => "Do it",
            Task::Find(_) => "Find it",
        };
        heading(ui, name, open);
        match task {
            Task::Predict { question, answers } => predict(ui, open, question, answers, actions),
            Task::Do(goal) | Task::Find(goal) => reach(ui, open, goal, unmet, actions),
        }
    });
    let rect = shown.response.rect;
    let bar = Rect::from_min_max(rect.min, pos2(rect.left() + BAR * scale, rect.bottom()));
    ui.painter().rect_filled(bar, 1.5, palette.accent);
    ui.add_space(2.0);
}

/// The kind of task, a check mark once it is done, and the number of attempts.
fn heading(ui: &mut Ui, name: &str, open: &OpenLesson) {
    let tries = open.tries.get(&open.step).copied().unwrap_or(0);
    ui.horizontal(|ui| {
        let size = TextStyle::Body.resolve(ui.style()).size;
        ui.label(theme::strong(ui, name).color(Palette::here(ui).accent));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            if open.is_done() {
                ui.label(theme::strong(ui, "Done"));
                check(ui, size);
            }
            if tries > 0 {
                let words = if tries == 1 { "1 try".to_owned() } else { format!("{tries} tries") };
                ui.label(theme::small(ui, &words));
                ui.add_space(4.0);
            }
        });
    });
}

/// A check mark on a disc.
fn check(ui: &mut Ui, size: f32) {
    let palette = Palette::here(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(1.25 * size, 1.25 * size), Sense::hover());
    theme::says(&response, WidgetType::Label, "done");
    ui.painter().circle_filled(rect.center(), 0.6 * size, palette.accent);
    icon::paint(ui.painter(), rect.shrink(0.28 * size), Icon::Check, palette.panel);
}

fn predict(
    ui: &mut Ui,
    open: &OpenLesson,
    question: &[Run],
    answers: &[AnswerChoice],
    actions: &mut Vec<Action>,
) {
    let first = ui.cursor().top();
    paragraph(ui, question);
    ui.add_space(2.0);
    let mut seen = None;
    let chosen = open.answer();
    let tried = open.answers.get(&open.step).map_or(&[][..], Vec::as_slice);
    let answered = just_answered(ui, open);
    for (i, choice) in answers.iter().enumerate() {
        let top = ui.cursor().top();
        // The correct answer, once known, stays marked.
        let known = tried.contains(&i) || (open.is_done() && choice.right);
        if answer(ui, choice, chosen == Some(i), known) {
            actions.push(Action::Lesson(LessonCommand::Answer(i)));
        }
        if known && (chosen == Some(i) || choice.right) {
            feedback(ui, choice, open.is_done());
            if answered && chosen == Some(i) {
                seen = Some(top);
            }
        }
    }
    // The question with all answers, or those from the chosen one on, which may lie below what is in sight.
    if let Some(chosen) = seen {
        let (end, room) = (ui.cursor().top(), ui.clip_rect().height() - 2.0 * MARGIN);
        let top = if end - first <= room { first } else { chosen };
        let whole = Rect::from_x_y_ranges(ui.max_rect().x_range(), top..=end.min(top + room));
        ui.scroll_to_rect(whole.expand2(vec2(0.0, MARGIN)), None);
    }
}

/// What brings the chosen answer into sight when it changes.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Answered {
    entries: u64,
    answer: Option<usize>,
    tries: usize,
    /// Size of the type: a presentation has larger type, and begins with the answer in sight.
    size: f32,
}

/// True in the first frames after an answer, and after the type has got another size: texts take a frame to find their
/// places.
fn just_answered(ui: &Ui, open: &OpenLesson) -> bool {
    const FRAMES: u8 = 3;
    let id = Id::new("answer of a lesson");
    let now = Answered {
        entries: open.entries,
        answer: open.answer(),
        tries: open.tries.get(&open.step).copied().unwrap_or(0),
        size: TextStyle::Body.resolve(ui.style()).size,
    };
    let left = ui.data_mut(|data| {
        let left = match data.get_temp::<(Answered, u8)>(id) {
            Some((before, left)) if before == now => left.saturating_sub(1),
            Some((before, _)) if before.entries == now.entries => FRAMES,
            _ => 0,
        };
        data.insert_temp(id, (now, left));
        left
    });
    if left > 0 {
        ui.ctx().request_repaint();
    }
    left > 0
}

/// The verdict on an answer and its reason, below the text of the answer.
fn feedback(ui: &mut Ui, choice: &AnswerChoice, done: bool) {
    ui.horizontal_top(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.add_space(CIRCLE * theme::scale_here(ui));
        ui.vertical(|ui| {
            verdict(ui, choice.right, done);
            if !choice.feedback.is_empty() {
                paragraph(ui, &choice.feedback);
            }
        });
    });
    ui.add_space(2.0);
}

/// Correct or wrong, in a word and a colour.
fn verdict(ui: &mut Ui, right: bool, done: bool) {
    let palette = Palette::here(ui);
    let (words, colour) = match (right, done) {
        (true, _) => ("Right.", palette.accent),
        (false, false) => ("Wrong. Try another answer.", palette.error),
        (false, true) => ("Wrong.", palette.error),
    };
    ui.label(theme::strong(ui, words).color(colour));
}

/// An answer. Returns true if it was clicked. `known` shows if it is correct.
fn answer(ui: &mut Ui, choice: &AnswerChoice, chosen: bool, known: bool) -> bool {
    let palette = Palette::here(ui);
    let scale = theme::scale_here(ui);
    let left = CIRCLE * scale;
    let mut text = job(ui, &choice.text, TextStyle::Body);
    text.wrap.max_width = ui.available_width() - left - 6.0;
    let galley = ui.painter().layout_job(text);
    let height = galley.size().y + 8.0 * scale;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    let verdict = match (known, choice.right) {
        (false, _) => "",
        (true, true) => ": right",
        (true, false) => ": wrong",
    };
    let says = format!("{}{verdict}", spoken(&choice.text));
    theme::says_chosen(&response, WidgetType::RadioButton, chosen, says);
    let hot = theme::is_hot(&response);
    let wrong = known && !choice.right;
    let fill = match (wrong, chosen) {
        (true, _) => palette.panel.lerp_to_gamma(palette.error, if chosen { 0.25 } else { 0.1 }),
        (false, true) => palette.chosen,
        (false, false) if hot => palette.hovered,
        (false, false) => palette.panel,
    };
    let (width, edge) = match (wrong, chosen || hot) {
        (true, _) => (if chosen { 2.0 } else { 1.0 }, palette.error),
        (false, true) => (1.0, palette.accent),
        (false, false) => (1.0, palette.line),
    };
    ui.painter().rect(rect, 4.0, fill, Stroke::new(width, edge), StrokeKind::Inside);
    let centre = pos2(rect.left() + 0.5 * left, rect.top() + 0.5 * (height.min(28.0 * scale)));
    let sign = Rect::from_center_size(centre, vec2(10.0, 10.0) * scale);
    match (known, choice.right) {
        (true, true) => icon::paint(ui.painter(), sign, Icon::Check, palette.accent),
        (true, false) => icon::paint(ui.painter(), sign, Icon::Cross, palette.error),
        _ => {
            ui.painter().circle_stroke(centre, 5.0 * scale, Stroke::new(1.2, palette.weak));
        }
    }
    ui.painter().galley(pos2(rect.left() + left, rect.top() + 4.0 * scale), galley, palette.text);
    response.clicked()
}

fn reach(ui: &mut Ui, open: &OpenLesson, goal: &Goal, unmet: Option<&str>, actions: &mut Vec<Action>) {
    paragraph(ui, &goal.text);
    if !open.is_done()
        && let Some(why) = unmet
    {
        let mut text = maths::prose(ui, &format!("Not yet: {why}."), TextStyle::Small);
        text.sections.iter_mut().for_each(|section| section.format.color = Palette::here(ui).weak);
        ui.add(Label::new(text).wrap());
    }
    let Some(hint) = &goal.hint else { return };
    if open.hint {
        paragraph(ui, hint);
    }
    if ui.button(if open.hint { "Hide the hint" } else { "Show a hint" }).clicked() {
        actions.push(Action::Lesson(LessonCommand::Hint));
    }
}
