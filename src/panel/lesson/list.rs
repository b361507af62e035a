//! The menu of lessons: title, summary, duration and progress.

use crate::{
    lesson::{Lesson, shipped::LESSONS},
    panel::{
        maths,
        prelude::*,
        state::{LessonSource, Past},
    },
};

/// Width of the menu, in points.
const WIDTH: f32 = 440.0;
/// Width of the icon in front of a title, in points.
const SIGN: f32 = 26.0;

/// The lessons that come with the program, above the other entries of the menu.
pub(in crate::panel) fn entries(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let screen = ui.ctx().content_rect();
    ui.set_width(WIDTH.min(screen.width() - 64.0));
    let most = screen.height() - 166.0;
    ScrollArea::vertical().max_height(most).min_scrolled_height(most).show(ui, |ui| {
        for (i, lesson) in LESSONS.iter().enumerate() {
            if entry(ui, i, lesson, session) {
                actions.push(Action::Lesson(LessonCommand::Open(LessonSource::Shipped(i))));
                ui.close();
            }
        }
    });
    ui.separator();
}

/// The duration of a lesson, and the learner's progress.
pub(in crate::panel) fn facts(minutes: Option<u32>, past: Option<&Past>) -> String {
    let minutes = minutes.map(|minutes| format!("{minutes} min"));
    let past = past.map(Past::words);
    minutes.into_iter().chain(past).collect::<Vec<_>>().join(" · ")
}

/// The entry of a lesson. Returns true if it is clicked.
fn entry(ui: &mut Ui, i: usize, lesson: &Lesson, session: &Session) -> bool {
    let palette = Palette::here(ui);
    let past = session.progress.of(&lesson.id).filter(|past| past.finished || past.is_begun());
    let current = session.lesson.as_ref().is_some_and(|open| open.source == LessonSource::Shipped(i));
    let small = TextStyle::Small.resolve(ui.style());
    let facts = ui.painter().layout_no_wrap(facts(lesson.minutes, past), small, palette.weak);
    let width = ui.available_width() - SIGN - 12.0;
    let title = format!("{}. {}", i + 1, lesson.title);
    let title = theme::title(ui, &title, width - facts.size().x - 12.0);
    let mut job = maths::prose(ui, &lesson.summary, TextStyle::Small);
    job.wrap.max_width = width;
    let summary = ui.painter().layout_job(job);
    let below = title.size().y + 2.0;
    let height = below + summary.size().y + 10.0;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    theme::says_chosen(&response, WidgetType::Button, current, format!("Lesson: {}", lesson.title));
    let hot = theme::is_hot(&response);
    if hot || current {
        ui.painter().rect_filled(rect, 4.0, if hot { palette.hovered } else { palette.chosen });
    }
    let line = title.rows.first().map_or(0.0, |row| row.rect().bottom());
    let centre = pos2(rect.left() + 0.5 * SIGN, rect.top() + 5.0 + 0.5 * line);
    match past {
        Some(past) if past.finished => {
            let sign = Rect::from_center_size(centre, vec2(11.0, 11.0));
            icon::paint(ui.painter(), sign, Icon::Check, palette.accent);
        }
        Some(_) => _ = ui.painter().circle_filled(centre, 3.5, palette.accent),
        None => _ = ui.painter().circle_stroke(centre, 3.5, Stroke::new(1.2, palette.weak)),
    }
    let at = pos2(rect.left() + SIGN, rect.top() + 5.0);
    let right = pos2(rect.right() - 8.0 - facts.size().x, at.y + line - facts.size().y);
    ui.painter().galley(right, facts, palette.weak);
    ui.painter().galley(at, title, palette.text);
    ui.painter().galley(at + vec2(0.0, below), summary, palette.text);
    response.clicked()
}
