//! The edit history as a list: a click undoes or redoes up to a step.

use bevy_egui::egui::{self, Align, RichText, ScrollArea, Ui};

use super::{Panel, PanelContext, Place, is_panel, state::Action, theme::Palette};

/// Id of the tab.
pub const HISTORY_TAB: &str = "history";

/// The *History* panel.
#[derive(Clone, Copy, Debug)]
pub struct History;

impl Panel for History {
    is_panel!(HISTORY_TAB, "History", Place::Bottom);

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let (session, actions) = (context.session(), &mut context.actions);
        let palette = Palette::here(ui);
        let done = session.document.done();
        let steps: Vec<_> =
            std::iter::once("Scene as it was opened").chain(session.document.steps()).collect();
        let height = ui.spacing().interact_size.y;
        // The latest step is always in view.
        let shown = ui.id().with("shown step");
        let news = ui.data(|data| data.get_temp(shown)) != Some((done, steps.len()));
        ui.data_mut(|data| data.insert_temp(shown, (done, steps.len())));
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for (i, name) in steps.into_iter().enumerate() {
                let colour = if i > done { palette.weak } else { palette.text };
                let text = RichText::new(name).color(colour);
                let row = egui::Button::selectable(i == done, text)
                    .min_size(egui::vec2(ui.available_width(), height));
                let row = ui.add(row.truncate());
                if i == done && news {
                    row.scroll_to_me(Some(Align::Center));
                }
                let help = if i > done {
                    "Undone: click to redo up to here"
                } else {
                    "Click to undo what came after"
                };
                if row.on_hover_text(help).clicked() && i != done {
                    actions.push(Action::GoToStep(i));
                }
            }
        });
    }
}
