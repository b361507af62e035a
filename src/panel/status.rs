//! The line at the bottom: messages, errors of shaders, the selection.

use bevy_egui::egui::{
    self, Align, Button, Layout, RichText, Sense, TextStyle, Ui, WidgetInfo, WidgetType, vec2,
};

use super::{
    Panel, PanelContext, Place, export,
    icon::{self, Icon},
    matching,
    state::{Action, MESSAGES_TAB, SHADER_TAB, Session, Severity, ViewChange},
    theme::{self, Palette},
};
use crate::{scene::variant::LETTERS, text::plural};

/// See the module.
#[derive(Clone, Copy, Debug)]
pub struct StatusLine;

impl Panel for StatusLine {
    fn id(&self) -> &'static str {
        "status"
    }

    fn title(&self) -> &'static str {
        "Status line"
    }

    fn place(&self) -> Place {
        Place::Status
    }

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        let (session, registry, actions) = (context.session(), context.registry(), &mut context.actions);
        let palette = Palette::here(ui);
        ui.horizontal(|ui| {
            ui.set_min_height(20.0);
            let count = session.messages.len();
            let text = theme::small(
                ui,
                if count == 0 { "No messages".to_owned() } else { plural(count, "message") },
            );
            let (rect, _) = ui.allocate_exact_size(vec2(14.0, 16.0), Sense::hover());
            match session.messages.worst() {
                Some(worst) => icon::severity(ui.painter(), rect.center(), 5.5, worst, &palette),
                None => icon::paint(
                    ui.painter(),
                    rect.shrink(3.0),
                    if session.view.bottom_open { Icon::Down } else { Icon::Up },
                    palette.weak,
                ),
            }
            let says =
                if session.view.bottom_open { "Fold the strip away (F8)" } else { "Show messages (F8)" };
            let button = ui.add(Button::new(text).frame_when_inactive(false).small());
            button
                .widget_info(|| WidgetInfo::labeled(WidgetType::Button, true, format!("Messages: {count}")));
            if button.on_hover_text(says).clicked() {
                actions.push(Action::View(session.strip_change()));
            }
            shader_errors(ui, session, actions);
            export::progress(ui, session, actions);
            matching::progress(ui, session, actions);
            samples(ui, session);
            let selected = format!("{} selected · F1 keys", session.name_of(session.selection, registry));
            latest(ui, session, theme::small_width(ui, &selected), actions);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.add(egui::Label::new(theme::small(ui, selected)).truncate());
            });
        });
    }
}

/// The samples of light with extent in words, per view if there are several; none while no view has such light.
fn samples_in_words(converged: &[[u32; 2]]) -> Option<String> {
    let shown = || converged.iter().enumerate().filter(|(_, [_, total])| *total > 0);
    let words: Vec<_> = shown()
        .map(|(view, [done, total])| {
            let letter = LETTERS.get(view).copied().unwrap_or_default();
            let of = if shown().count() > 1 { format!("{letter}: ") } else { String::new() };
            format!("{of}{done} of {total}")
        })
        .collect();
    (!words.is_empty()).then(|| format!("{} samples", words.join(", ")))
}

/// How far pictures of light with extent have converged.
fn samples(ui: &mut Ui, session: &Session) {
    let Some(words) = samples_in_words(&session.facts.converged) else { return };
    ui.add(egui::Label::new(theme::small(ui, words))).on_hover_text(
        "Light with extent is added up from samples, a few in each frame. The picture is their mean: noise goes as samples \
         come, and nothing more is drawn at the end. Every change begins anew.",
    );
}

/// The part of the line that the last message may take from what stands at the right.
const NEWS: f32 = 0.75;

/// The last message, until something is changed. At the right, `beside` points are wanted.
fn latest(ui: &mut Ui, session: &Session, beside: f32, actions: &mut Vec<Action>) {
    let Some(message) = session.messages.last() else { return };
    let listed = session.view.bottom_open && session.view.bottom_tab == MESSAGES_TAB;
    if listed || !session.has_news() {
        return;
    }
    let palette = Palette::here(ui);
    // The sign before the count is that of the worst.
    if session.messages.worst() != Some(message.severity) {
        let (rect, _) = ui.allocate_exact_size(vec2(14.0, 16.0), Sense::hover());
        icon::severity(ui.painter(), rect.center(), 5.5, message.severity, &palette);
    }
    let (all, gap) = (ui.available_width(), 2.0 * ui.spacing().item_spacing.x);
    let button = message.offer.as_ref().map_or(0.0, |(text, _)| theme::small_width(ui, text) + 2.0 * gap);
    let room = (all - beside - gap).max(NEWS * all) - button;
    let colour = palette.text;
    let galley = theme::elided(ui, &message.text, TextStyle::Small, colour, room);
    let label = ui.add(egui::Label::new(galley));
    label.on_hover_text(&message.text);
    if let Some((text, action)) = &message.offer
        && ui.add(Button::new(theme::small(ui, *text).color(colour)).small()).clicked()
    {
        actions.push((**action).clone());
    }
}

/// The number of errors of the shaders, and if the picture suffers from them; leads to the panel that says more.
fn shader_errors(ui: &mut Ui, session: &Session, actions: &mut Vec<Action>) {
    let count = session.shaders.troubles.len();
    if count == 0 {
        return;
    }
    let palette = Palette::here(ui);
    let stale = if session.shaders.stale().is_empty() {
        "nothing on the picture depends on it"
    } else {
        "the picture shows the last good version"
    };
    let (rect, _) = ui.allocate_exact_size(vec2(14.0, 16.0), Sense::hover());
    icon::severity(ui.painter(), rect.center(), 5.5, Severity::Error, &palette);
    let text = format!("{}: {stale}", plural(count, "shader error"));
    let text = RichText::new(text).small().color(palette.error);
    let button = ui.add(Button::new(text).frame_when_inactive(false).small());
    if button.on_hover_text("Show where the errors are (F9)").clicked() {
        actions.push(Action::View(ViewChange::BottomTab(SHADER_TAB.to_owned())));
    }
}

#[cfg(test)]
mod tests {
    use super::samples_in_words;

    #[test]
    fn samples_are_told_per_view_where_there_are_several() {
        assert_eq!(samples_in_words(&[[0, 0]; 2]), None);
        assert_eq!(samples_in_words(&[[64, 256], [0, 0]]).as_deref(), Some("64 of 256 samples"));
        let both = samples_in_words(&[[64, 256], [8, 256]]);
        assert_eq!(both.as_deref(), Some("A: 64 of 256, B: 8 of 256 samples"));
    }
}
