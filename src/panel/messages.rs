//! The strip at the bottom: messages, which stay until they are dismissed.

use super::{
    command::{CONTINUE, CONTINUE_TIP},
    keys,
    prelude::*,
    state::{CodeCommand, Effect, Note},
};

/// The *Messages* panel.
pub(super) fn show(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    if session.messages.is_empty() {
        ui.add_space(8.0);
        ui.weak("No messages. Problems with files, values and shaders appear here and stay until you dismiss them.");
        return;
    }
    ui.horizontal(|ui| {
        if ui.button("Copy all").clicked() {
            let all = session.messages.iter().map(|m| format!("{}: {}", m.severity.name(), m.text));
            context.act(Action::Do(Effect::CopyText(all.collect::<Vec<_>>().join("\n"))));
        }
        context.on_click(&ui.button("Dismiss all"), || Action::DismissAll);
    });
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        for (i, message) in session.messages.iter().enumerate().rev() {
            ui.push_id(i, |ui| ui.horizontal_top(|ui| row(ui, i, message, context)));
        }
    });
}

/// A message with its offer, and buttons that copy and dismiss it.
fn row(ui: &mut Ui, i: usize, message: &Note, context: &mut PanelContext<'_>) {
    ui.spacing_mut().item_spacing.x = 6.0;
    icon::sign(ui, [16.0, 20.0], 6.0, message.severity).on_hover_text(message.severity.name());
    let width = ui.available_width() - 58.0;
    ui.allocate_ui_with_layout(vec2(width, 0.0), Layout::top_down(Align::Min), |ui| {
        ui.set_width(width);
        ui.add_space(2.0);
        ui.add(Label::new(RichText::new(&message.text)).wrap().selectable(true));
        if let Some((label, action)) = &message.offer
            && explained(ui.button(*label), context.session(), action).clicked()
        {
            context.act((**action).clone());
        }
    });
    let button = icon::button(ui, Icon::Copy, "Copy the message");
    context.on_click(&button, || Action::Do(Effect::CopyText(message.text.clone())));
    if icon::button(ui, Icon::Cross, "Dismiss the message").clicked() {
        context.act(Action::Dismiss(i));
    }
}

/// The button of a message, with a tooltip where the label does not say what its action does, and with the key that does
/// the same.
pub(super) fn explained(button: Response, session: &Session, action: &Action) -> Response {
    let Action::Code(CodeCommand::Recover(path)) = action else { return button };
    let is_next = session.code.kept.last().is_some_and(|kept| kept.path == *path);
    let tip = if is_next { keys::hint(&button.ctx, CONTINUE_TIP, CONTINUE) } else { CONTINUE_TIP.to_owned() };
    button.on_hover_text(tip)
}
