//! The edit history as a list: a click undoes or redoes up to a step.

use super::prelude::*;

/// Id of the tab.
pub const HISTORY_TAB: &str = "history";

/// The *History* panel.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    let palette = Palette::here(ui);
    let done = session.document.done();
    let steps: Vec<_> = std::iter::once("Scene as it was opened").chain(session.document.steps()).collect();
    let height = ui.spacing().interact_size.y;
    // The latest step is always in view.
    let shown = ui.id().with("shown step");
    let news = ui.data(|data| data.get_temp(shown)) != Some((done, steps.len()));
    ui.data_mut(|data| data.insert_temp(shown, (done, steps.len())));
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for (i, name) in steps.into_iter().enumerate() {
            let colour = if i > done { palette.weak } else { palette.text };
            let text = RichText::new(name).color(colour);
            let size = vec2(ui.available_width(), height);
            let row = ui.add(Button::selectable(i == done, text).min_size(size).truncate());
            if i == done && news {
                row.scroll_to_me(Some(Align::Center));
            }
            let undone = "Undone: click to redo up to here";
            let help = if i > done { undone } else { "Click to undo what came after" };
            if row.on_hover_text(help).clicked() && i != done {
                context.act(Action::GoToStep(i));
            }
        }
    });
}
