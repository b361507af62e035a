//! What stands around the text: the tabs, the question about a conflict, and the bar to find and replace.

use std::ops::Range;

use bevy_egui::egui::TextEdit;

use super::{
    CodeCommand, CodeOf, CodePanel, OpenCode, Theirs,
    difference::{self, Change},
    find,
    surface::line,
};
use crate::panel::{keys, prelude::*};

/// Ids of the fields of the bar to find and replace.
pub(super) const FIELDS: [&str; 2] = ["code find", "code replace"];

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
    let session = context.session();
    ui.horizontal(|ui| {
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            let visible = session.code.visible();
            if visible.is_some() {
                let close = icon::button(ui, Icon::Cross, "Close this text");
                context.on_click(&close, || Action::Code(CodeCommand::Close));
            }
            let unsaved = visible.is_some_and(OpenCode::is_unsaved);
            let (word, help) = match visible.map(|open| &open.of) {
                Some(CodeOf::Scene) => {
                    ("Apply", "Makes this the scene, as one step of the history (Ctrl+Enter)")
                }
                _ => ("Save", "Writes the file; the picture then follows (Ctrl+S)"),
            };
            button(ui, word, unsaved, CodeCommand::Save, context).on_hover_text(help);
            let scene = session.code.of(&CodeOf::Scene).is_none();
            let help = keys::hint(ui.ctx(), "Edit the scene as JSON", "scene_code");
            button(ui, "Scene", scene, CodeCommand::Scene, context).on_hover_text(help);
            let help = keys::hint(ui.ctx(), "Edit the code of the model", "code");
            button(ui, "Model", true, CodeCommand::Model, context).on_hover_text(help);
            let scroll = ScrollArea::horizontal().id_salt("code tabs").auto_shrink(false).max_height(26.0);
            ui.with_layout(Layout::left_to_right(Align::Center), |ui| {
                scroll.show(ui, |ui| {
                    ui.horizontal(|ui| {
                        for (i, open) in session.code.open.iter().enumerate() {
                            let sign = if open.is_unsaved() { "● " } else { "" };
                            let text = format!("{sign}{}", open.name);
                            let tab = ui.add(Button::selectable(i == session.code.shown, text));
                            let tab = match open.path() {
                                Some(path) => tab.on_hover_text(path.shown().to_string()),
                                None => tab.on_hover_text("The scene of this document"),
                            };
                            context.on_click(&tab, || Action::Code(CodeCommand::Show(i)));
                        }
                    });
                });
            });
        });
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

/// The question about a text that is being closed, or that another program has changed.
pub(super) fn conflict(ui: &mut Ui, open: &OpenCode, context: &mut PanelContext<'_>) {
    let name = &open.name;
    let (text, commands): (String, Vec<(&str, CodeCommand)>) = if open.closing {
        let text = format!("{name} has changes that are not saved.");
        (text, vec![("Discard them", CodeCommand::Discard), ("Keep it open", CodeCommand::Stay)])
    } else {
        match &open.theirs {
            None => return,
            Some(Theirs::Changed(_)) => {
                let text = match open.of {
                    CodeOf::Scene => format!("The scene was changed elsewhere, and you have changed {name}."),
                    CodeOf::File(_) => format!("Another program has changed {name}, and you have too."),
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
        }
    };
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

/// The difference between the text as typed and the other version.
pub(super) fn difference(ui: &mut Ui, mine: &str, theirs: &str) {
    let palette = Palette::here(ui);
    let all = difference::difference(mine, theirs);
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

/// The bar to find and replace.
#[derive(Default)]
pub(super) struct Finder {
    pub(super) open: bool,
    replaces: bool,
    wanted: String,
    by: String,
    exact: bool,
    /// True until its field has the focus.
    fresh: bool,
    /// The places, and what they were found in.
    found: Option<(String, String, bool, Vec<Range<usize>>)>,
}

impl Finder {
    /// The places in a text.
    fn places(&mut self, text: &str) -> &[Range<usize>] {
        let is_known = self.found.as_ref().is_some_and(|(known, wanted, exact, _)| {
            known == text && *wanted == self.wanted && *exact == self.exact
        });
        if !is_known {
            let places = find::find(text, &self.wanted, self.exact);
            self.found = Some((text.to_owned(), self.wanted.clone(), self.exact, places));
        }
        self.found.as_ref().map_or(&[], |(.., places)| places)
    }

    /// The places in these lines of the text that was searched last, from 0.
    pub(super) fn places_in(&self, text: &str, rows: &Range<usize>) -> Vec<Range<usize>> {
        let Some((known, .., places)) = self.found.as_ref().filter(|_| self.open) else { return Vec::new() };
        if known != text || places.is_empty() {
            return Vec::new();
        }
        let (start, end) = (line(text, rows.start + 1).start, line(text, rows.end).end);
        places.iter().filter(|place| place.start >= start && place.end <= end).cloned().collect()
    }
}

impl CodePanel {
    pub(super) fn begin_finding(&mut self, open: &OpenCode, replace: bool) {
        let _ = open;
        let [a, b] = self.cursor;
        // What is selected within a line is what is looked for.
        if let Some(selected) =
            self.buffer.get(a.min(b)..a.max(b)).filter(|s| !s.is_empty() && !s.contains('\n'))
        {
            selected.clone_into(&mut self.finder.wanted);
        }
        (self.finder.open, self.finder.fresh) = (true, true);
        self.finder.replaces = replace;
    }

    pub(super) fn find_next(&mut self, ctx: &Context, open: &OpenCode, backwards: bool) {
        let [a, b] = self.cursor;
        let from = if backwards { a.min(b) } else { a.max(b) };
        let places = self.finder.places(&self.buffer);
        if let Some(place) = find::next(places, from, backwards).map(|at| places[at].clone()) {
            self.select(ctx, open, place);
        }
    }
}

pub(super) fn find(ui: &mut Ui, panel: &mut CodePanel, open: &OpenCode, context: &mut PanelContext<'_>) {
    if !panel.finder.open {
        return;
    }
    let mut asks = None;
    let count = panel.finder.places(&panel.buffer).len();
    let selected = {
        let [a, b] = panel.cursor;
        let places = panel.finder.places(&panel.buffer);
        places.iter().position(|place| *place == (a.min(b)..a.max(b)))
    };
    ui.horizontal_wrapped(|ui| {
        let finder = &mut panel.finder;
        let field = |ui: &mut Ui, id: &str, hint: &str, text: &mut String| {
            let before = text.clone();
            let edit =
                TextEdit::singleline(text).id(Id::new(id)).hint_text(hint.to_owned()).desired_width(160.0);
            let response = ui.add(edit);
            theme::names_field(&response, hint, [&before, text, hint]);
            response
        };
        let wanted = field(ui, FIELDS[0], "Find", &mut finder.wanted);
        if std::mem::take(&mut finder.fresh) {
            wanted.request_focus();
        }
        let said = match (count, selected) {
            _ if finder.wanted.is_empty() => String::new(),
            (0, _) => "not found".to_owned(),
            (find::MOST_FOUND, _) => format!("more than {}", find::MOST_FOUND - 1),
            (_, Some(at)) => format!("{} of {count}", at + 1),
            (_, None) => plural(count, "place"),
        };
        ui.label(theme::small(ui, said));
        for (word, help, ask) in [("Previous", "Shift+F3", 0), ("Next", "F3 or Enter", 1)] {
            if ui.add_enabled(count > 0, Button::new(word)).on_hover_text(help).clicked() {
                asks = Some(ask);
            }
        }
        ui.checkbox(&mut finder.exact, "Aa").on_hover_text("Small and capital letters differ");
        if finder.replaces {
            field(ui, FIELDS[1], "Replace by", &mut finder.by);
            if ui.add_enabled(selected.is_some(), Button::new("Replace")).clicked() {
                asks = Some(2);
            }
            if ui.add_enabled(count > 0, Button::new("Replace all")).clicked() {
                asks = Some(3);
            }
        }
        let close = icon::button(ui, Icon::Cross, "Stop finding (Esc)");
        if close.clicked() {
            finder.open = false;
        }
    });
    match asks {
        Some(0) => panel.find_next(ui.ctx(), open, true),
        Some(1) => panel.find_next(ui.ctx(), open, false),
        Some(ask) => {
            let all = panel.finder.places(&panel.buffer);
            let places = match selected.filter(|_| ask == 2) {
                Some(at) => vec![all[at].clone()],
                None => all.to_vec(),
            };
            let text = find::replace(&panel.buffer, &places, &panel.finder.by);
            panel.put(text, context);
            if let Some(first) = places.first() {
                let end = first.start + panel.finder.by.len();
                panel.select(ui.ctx(), open, end..end);
            }
            if ask == 2 {
                panel.find_next(ui.ctx(), open, false);
            }
        }
        None => {}
    }
}
