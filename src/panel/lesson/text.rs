//! The text of a step, typeset: prose with symbols, lists, equations.

use bevy_egui::egui::{
    FontFamily,
    text::{LayoutJob, LayoutSection},
};

use crate::{
    lesson::{Block, Run, RunStyle},
    panel::{
        maths::{self, Sizes},
        prelude::*,
    },
    reflection::Term,
};

/// Line height of prose, relative to the font size.
const LEADING: f32 = 1.45;
/// Indentation of a list, relative to the font size.
const INDENT: f32 = 1.45;

/// Sentences with symbols, emphasis, key names and code.
pub(super) fn job(ui: &Ui, runs: &[Run], style: TextStyle) -> LayoutJob {
    let font = style.resolve(ui.style());
    let mut job = LayoutJob::default();
    for run in runs {
        // Prose treats text between backticks as code.
        let part = match run.style {
            RunStyle::Code => maths::prose(ui, &format!("`{}`", run.text), style.clone()),
            _ => maths::prose(ui, &run.text, style.clone()),
        };
        for LayoutSection { leading_space, byte_range, mut format } in part.sections {
            match run.style {
                RunStyle::Emphasis => format.italics = true,
                RunStyle::Strong if format.font_id.family == FontFamily::Proportional => {
                    format.font_id.family = theme::semibold();
                }
                _ => {}
            }
            // An index stays with its letter.
            if format.valign != Align::BOTTOM || format.font_id.size >= font.size {
                format.line_height = Some(LEADING * font.size);
            }
            job.append(&part.text[byte_range.start.0..byte_range.end.0], leading_space, format);
        }
    }
    job
}

/// Text of runs for screen readers.
pub(super) fn spoken(runs: &[Run]) -> String {
    runs.iter().map(|run| run.text.as_str()).collect()
}

/// A paragraph.
pub(super) fn paragraph(ui: &mut Ui, runs: &[Run]) {
    ui.add(Label::new(job(ui, runs, TextStyle::Body)).wrap());
}

/// An equation, with one typeset line per line of the source.
fn equation(ui: &mut Ui, text: &str) {
    let parts: Vec<_> =
        text.lines().map(str::trim).filter(|line| !line.is_empty()).map(|line| (Term::Total, line)).collect();
    ui.add_space(2.0);
    ui.indent("equation", |ui| {
        maths::equation_of(ui, &parts, Sizes::default(), |symbol| maths::meaning(symbol).map(str::to_owned));
    });
    ui.add_space(2.0);
}

/// A list item.
fn item(ui: &mut Ui, number: Option<u64>, depth: usize, runs: &[Run]) {
    let size = TextStyle::Body.resolve(ui.style()).size;
    let left = INDENT * size * (depth + 1) as f32;
    let whole = ui.available_rect_before_wrap();
    let place = whole.with_min_x(whole.left() + left);
    let mut child = ui.new_child(UiBuilder::new().max_rect(place));
    paragraph(&mut child, runs);
    let used = child.min_rect();
    let sign = number.map_or_else(|| "•".to_owned(), |number| format!("{number}."));
    let colour = theme::Palette::here(ui).weak;
    let galley = ui.painter().layout_no_wrap(sign, TextStyle::Body.resolve(ui.style()), colour);
    let y = used.top() + 0.5 * (LEADING * size - galley.size().y);
    ui.painter().galley(pos2(place.left() - 0.4 * size - galley.size().x, y), galley, colour);
    ui.allocate_exact_size(vec2(whole.width(), used.height()), Sense::hover());
}

/// A block of a step; `task` shows the task in place of a task block.
pub(super) fn block(ui: &mut Ui, block: &Block, task: impl FnOnce(&mut Ui)) {
    match block {
        Block::Paragraph(runs) => paragraph(ui, runs),
        Block::Item { number, depth, runs } => item(ui, *number, *depth, runs),
        Block::Equation(text) => equation(ui, text),
        Block::Task => task(ui),
    }
}
