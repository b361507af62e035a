//! The buttons at the lower end of a lesson, which stay in place while long text scrolls: previous and next.

use crate::panel::{focus, keys, narrow, prelude::*, state::OpenLesson};

/// Height of a button, in points.
const HEIGHT: f32 = 30.0;

/// Shows the buttons.
pub(super) fn footer(ui: &mut Ui, open: &OpenLesson, actions: &mut Vec<Action>) {
    let scale = theme::scale_here(ui);
    if open.asking {
        let text = "The task is not done. Skip it? The step then counts as not done.";
        ui.add(Label::new(RichText::new(text).color(Palette::here(ui).warning)).wrap());
        ui.add_space(2.0);
    }
    let last = open.is_last();
    let (next, tip) = match (open.asking, last) {
        (true, _) => ("Skip the task", "Go on without it"),
        (false, true) => ("Finish", "Leave the lesson: your own scene comes back"),
        (false, false) => ("Next", "The next step"),
    };
    // The same widgets in all steps, so that Enter repeats.
    let buttons = |ui: &mut Ui| {
        let size = vec2(
            0.5 * (ui.available_width() - ui.spacing().item_spacing.x),
            narrow::high(ui.ctx(), HEIGHT * scale),
        );
        let before = ui.add_enabled(open.step > 0, Button::new("Previous").min_size(size));
        let back = keys::hint(ui.ctx(), "The step before, as it began", "previous_step");
        if before.on_hover_text(back).clicked() {
            actions.push(Action::Lesson(LessonCommand::Previous));
        }
        let button = theme::action_button(ui, next, open.is_done() || open.asking, size);
        let response = ui.push_id("next", |ui| ui.add(button)).inner;
        theme::says(&response, WidgetType::Button, next);
        focus::first(ui.ctx(), response.id);
        if response.on_hover_text(keys::hint(ui.ctx(), tip, "next_step")).clicked() {
            actions.push(Action::Lesson(LessonCommand::Next));
        }
    };
    let fixed = UiBuilder::new().id(Id::new("buttons of the lesson"));
    ui.scope_builder(fixed, |ui| ui.horizontal(buttons));
}
