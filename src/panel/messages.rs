//! The strip at the bottom: messages, which stay until they are dismissed.

use bevy_egui::egui::{self, Align, Layout, RichText, ScrollArea, Sense, Ui, vec2};

use super::{
    Panel, PanelContext, Place,
    icon::{self, Icon},
    is_panel,
    state::{Action, MESSAGES_TAB, Note},
    theme::Palette,
};

/// The *Messages* panel.
#[derive(Clone, Copy, Debug)]
pub struct Messages;

impl Panel for Messages {
    is_panel!(MESSAGES_TAB, "Messages", Place::Bottom);

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let (session, actions) = (context.session(), &mut context.actions);
        if session.messages.is_empty() {
            ui.add_space(8.0);
            ui.weak("No messages. Problems with files, values and shaders appear here and stay until you dismiss them.");
            return;
        }
        ui.horizontal(|ui| {
            if ui.button("Copy all").clicked() {
                let all = session.messages.iter().map(|m| format!("{}: {}", m.severity.name(), m.text));
                actions.push(Action::Copy(all.collect::<Vec<_>>().join("\n")));
            }
            if ui.button("Dismiss all").clicked() {
                actions.push(Action::DismissAll);
            }
        });
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            for (i, message) in session.messages.iter().enumerate().rev() {
                ui.push_id(i, |ui| ui.horizontal_top(|ui| row(ui, i, message, actions)));
            }
        });
    }
}

/// A message with what it offers, and buttons that copy and dismiss it.
fn row(ui: &mut Ui, i: usize, message: &Note, actions: &mut Vec<Action>) {
    ui.spacing_mut().item_spacing.x = 6.0;
    let (rect, sign) = ui.allocate_exact_size(vec2(16.0, 20.0), Sense::hover());
    icon::severity(ui.painter(), rect.center(), 6.0, message.severity, &Palette::here(ui));
    sign.on_hover_text(message.severity.name());
    let width = ui.available_width() - 58.0;
    ui.allocate_ui_with_layout(vec2(width, 0.0), Layout::top_down(Align::Min), |ui| {
        ui.set_width(width);
        ui.add_space(2.0);
        ui.add(egui::Label::new(RichText::new(&message.text)).wrap().selectable(true));
        if let Some((label, action)) = &message.offer
            && ui.button(*label).clicked()
        {
            actions.push((**action).clone());
        }
    });
    if icon::button(ui, Icon::Copy, "Copy the message").clicked() {
        actions.push(Action::Copy(message.text.clone()));
    }
    if icon::button(ui, Icon::Cross, "Dismiss the message").clicked() {
        actions.push(Action::Dismiss(i));
    }
}
