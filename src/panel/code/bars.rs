//! What stands above the text: the tabs, and the question about a conflict.

use super::{
    CodeCommand, CodeOf, OpenCode, Theirs, check,
    difference::{self, Change},
};
use crate::panel::{keys, prelude::*};

fn button(
    ui: &mut Ui,
    text: &str,
    enabled: bool,
    command: CodeCommand,
    context: &mut PanelContext<'_>,
) -> Response {
    let button = ui.add_enabled(enabled, Button::new(text));
    context.on_click(&button, || Action::Code(command));
    button
}

/// The open texts, and what can be done with them.
pub(super) fn tabs(ui: &mut Ui, context: &mut PanelContext<'_>) {
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            commands(ui, context);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| names(ui, context));
        });
    });
}

/// Laid out from right to left.
fn commands(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let session = context.session();
    let visible = session.code.visible();
    if visible.is_some() {
        let close = icon::button(ui, Icon::Cross, "Close this text");
        context.on_click(&close, || Action::Code(CodeCommand::Close));
    }
    let unsaved = visible.is_some_and(OpenCode::is_unsaved);
    let (word, help) = match visible.map(|open| &open.of) {
        Some(CodeOf::Scene) => ("Apply", "Makes this the scene, as one step of the history (Ctrl+Enter)"),
        _ => ("Save", "Writes the file; the picture then follows (Ctrl+S)"),
    };
    button(ui, word, unsaved, CodeCommand::Save, context).on_hover_text(help);
    let scene = session.code.of(&CodeOf::Scene).is_none();
    let help = keys::hint(ui.ctx(), "Edit the scene as JSON", "scene_code");
    button(ui, "Scene", scene, CodeCommand::Scene, context).on_hover_text(help);
    let help = keys::hint(ui.ctx(), "Edit the code of the model", "code");
    button(ui, "Model", true, CodeCommand::Model, context).on_hover_text(help);
}

fn names(ui: &mut Ui, context: &mut PanelContext<'_>) {
    let code = &context.session().code;
    let scroll = ScrollArea::horizontal().id_salt("code tabs").auto_shrink(false).max_height(26.0);
    scroll.show(ui, |ui| {
        let row = |ui: &mut Ui| {
            for (i, open) in code.open.iter().enumerate() {
                let sign = if open.is_unsaved() { "● " } else { "" };
                let tab = ui.add(Button::selectable(i == code.shown, format!("{sign}{}", open.name)));
                let help = open.path().map(|path| path.shown().to_string());
                let tab = tab.on_hover_text(help.as_deref().unwrap_or("The scene of this document"));
                context.on_click(&tab, || Action::Code(CodeCommand::Show(i)));
            }
        };
        ui.horizontal(row);
    });
}

/// The panel without a text.
pub(super) fn nothing(ui: &mut Ui, context: &mut PanelContext<'_>) {
    ui.add_space(8.0);
    let text = "Open the code of a custom model, or the scene as JSON. A built-in model is edited as a copy: duplicate it as \
                a file, or export the shaders.";
    ui.add(Label::new(text).wrap());
    ui.add_space(4.0);
    super::super::author::buttons(ui, context);
}

/// What is said above a text, with the choices: it is being closed, another program has changed it, or its file cannot be
/// used.
fn question(open: &OpenCode, session: &Session) -> Option<(String, Vec<(&'static str, CodeCommand)>)> {
    let name = &open.name;
    if open.closing {
        let (text, discard) = if open.text == open.base {
            (format!("The text of {name} is in no file any more."), "Discard it")
        } else {
            (format!("{name} has changes that are not saved."), "Discard them")
        };
        return Some((text, vec![(discard, CodeCommand::Discard), ("Keep it open", CodeCommand::Stay)]));
    }
    Some(match &open.theirs {
        None => (format!("{name} cannot be used: {}.", check::refused(open, session)?), Vec::new()),
        Some(Theirs::Changed(_)) => {
            // What was changed here may have been undone since.
            let text = match (&open.of, open.text != open.base) {
                (CodeOf::Scene, true) => {
                    format!("The scene was changed elsewhere, and you have changed {name}.")
                }
                (CodeOf::Scene, false) => {
                    format!("The scene was changed elsewhere; {name} is as it was before.")
                }
                (CodeOf::File(_), true) => format!("Another program has changed {name}, and you have too."),
                (CodeOf::File(_), false) => {
                    format!("Another program has changed {name}; here it is as it was before.")
                }
            };
            let see = match open.shows_difference {
                true => ("Back to the text", CodeCommand::Difference(false)),
                false => ("Show the difference", CodeCommand::Difference(true)),
            };
            let choices =
                vec![("Keep mine", CodeCommand::KeepMine), ("Take theirs", CodeCommand::TakeTheirs), see];
            (text, choices)
        }
        Some(Theirs::Gone) => {
            let text =
                format!("{name} was deleted. Its text is still here; saving it writes the file again.");
            (text, Vec::new())
        }
        Some(Theirs::Unreadable(why)) => {
            let text = format!("{name} can no longer be read: {why}. Its last text is still here.");
            (text, vec![("Write mine over it", CodeCommand::KeepMine)])
        }
    })
}

/// Shows the question about a text, if there is one.
pub(super) fn conflict(ui: &mut Ui, open: &OpenCode, context: &mut PanelContext<'_>) {
    let Some((text, commands)) = question(open, context.session()) else { return };
    let palette = Palette::here(ui);
    let frame = egui::Frame::new().fill(palette.raised).inner_margin(4.0).corner_radius(4.0);
    frame.show(ui, |ui| {
        ui.horizontal_wrapped(|ui| {
            icon::sign(ui, [14.0, 18.0], 5.5, Severity::Warning);
            ui.label(text);
            for (word, command) in commands {
                button(ui, word, true, command, context);
            }
        });
    });
}

/// The difference between two texts.
pub(super) struct Known {
    of: [Arc<str>; 2],
    all: Vec<Change<String>>,
}

/// The difference between the text as typed and the other version, which is calculated once.
pub(super) fn difference(ui: &mut Ui, known: &mut Option<Known>, mine: &Arc<str>, theirs: &Arc<str>) {
    let palette = Palette::here(ui);
    let of = [mine, theirs].map(Arc::clone);
    let known = match known.take().filter(|known| known.of == of) {
        Some(same) => known.insert(same),
        None => {
            let all = difference::difference(mine, theirs);
            known.insert(Known { all: all.into_iter().map(Change::owned).collect(), of })
        }
    };
    let all = &known.all;
    let height = ui.text_style_height(&TextStyle::Monospace);
    let scroll = ScrollArea::both().id_salt("code difference").auto_shrink(false);
    ui.spacing_mut().item_spacing.y = 0.0;
    scroll.show_rows(ui, height, all.len(), |ui, rows| {
        for change in &all[rows] {
            let (sign, line, colour) = match change {
                Change::Both(line) => ("  ", line, palette.weak),
                Change::Mine(line) => ("− mine    ", line, palette.accent),
                Change::Theirs(line) => ("+ theirs  ", line, palette.warning),
            };
            let text = RichText::new(format!("{sign}{line}")).monospace().color(colour);
            ui.add(Label::new(text).extend());
        }
    });
}
