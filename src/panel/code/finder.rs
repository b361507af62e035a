//! The bar to find and replace.

use std::ops::Range;

use bevy_egui::egui::TextEdit;

use super::{
    CodePanel, OpenCode,
    find::{self, line},
};
use crate::panel::prelude::*;

/// Ids of its fields.
pub(super) const FIELDS: [&str; 2] = ["code find", "code replace"];

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
    /// Its widgets, as shown last.
    pub(super) widgets: Vec<Id>,
    /// The places, and what they were found in.
    found: Option<(String, String, bool, Vec<Range<usize>>)>,
    /// Number of places replaced at once, until the text or what is looked for changes.
    replaced: Option<usize>,
}

impl Finder {
    /// The places in a text.
    fn places(&mut self, text: &str) -> &[Range<usize>] {
        let is_known = self.found.as_ref().is_some_and(|(known, wanted, exact, _)| {
            known == text && *wanted == self.wanted && *exact == self.exact
        });
        if !is_known {
            let places = find::find(text, &self.wanted, self.exact);
            self.replaced = None;
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
    /// Opens the bar.
    pub(super) fn begin_finding(&mut self, replace: bool) {
        // What is selected within a line is what is looked for.
        if let Some(selected) =
            self.buffer.get(self.selection()).filter(|s| !s.is_empty() && !s.contains('\n'))
        {
            selected.clone_into(&mut self.finder.wanted);
        }
        (self.finder.open, self.finder.fresh) = (true, true);
        self.finder.replaces = replace;
    }

    /// Selects the next place, or the one before.
    pub(super) fn find_next(&mut self, ctx: &Context, open: &OpenCode, backwards: bool) {
        let Range { start, end } = self.selection();
        let from = if backwards { start } else { end };
        let places = self.finder.places(&self.buffer);
        if let Some(place) = find::next(places, from, backwards).map(|at| places[at].clone()) {
            self.select(ctx, open, place);
        }
    }
}

/// What a button of the bar asks for.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Asked {
    Next(bool),
    Replace,
    ReplaceAll,
}

/// Shows the bar, if it is open.
pub(super) fn show(ui: &mut Ui, panel: &mut CodePanel, open: &OpenCode, context: &mut PanelContext<'_>) {
    panel.finder.widgets.clear();
    if !panel.finder.open {
        return;
    }
    let selection = panel.selection();
    let places = panel.finder.places(&panel.buffer);
    let (count, selected) = (places.len(), places.iter().position(|place| *place == selection));
    let bar = ui.horizontal_wrapped(|ui| panel.finder.bar(ui, count, selected));
    match bar.inner {
        Some(Asked::Next(backwards)) => panel.find_next(ui.ctx(), open, backwards),
        Some(asked) => {
            let all = panel.finder.places(&panel.buffer);
            let places = match selected.filter(|_| asked == Asked::Replace) {
                Some(at) => vec![all[at].clone()],
                None => all.to_vec(),
            };
            let text = find::replace(&panel.buffer, &places, &panel.finder.by);
            panel.put(text, context);
            if let Some(first) = places.first() {
                let end = first.start + panel.finder.by.len();
                panel.select(ui.ctx(), open, end..end);
            }
            if asked == Asked::Replace {
                panel.find_next(ui.ctx(), open, false);
            } else {
                panel.finder.places(&panel.buffer);
                panel.finder.replaced = Some(places.len());
                // A button that has nothing left to do loses the focus, and Esc with it.
                ui.ctx().memory_mut(|memory| memory.request_focus(Id::new(FIELDS[1])));
            }
        }
        None => {}
    }
}

fn field(ui: &mut Ui, id: &str, hint: &str, text: &mut String) -> Response {
    let before = text.clone();
    let edit = TextEdit::singleline(text).id(Id::new(id)).hint_text(hint.to_owned()).desired_width(160.0);
    let response = ui.add(edit);
    theme::names_field(&response, hint, [&before, text, hint]);
    response
}

impl Finder {
    fn bar(&mut self, ui: &mut Ui, count: usize, selected: Option<usize>) -> Option<Asked> {
        let mut asked = None;
        let wanted = field(ui, FIELDS[0], "Find", &mut self.wanted);
        let mut widgets = vec![wanted.id];
        if std::mem::take(&mut self.fresh) {
            wanted.request_focus();
            theme::select_all(ui, wanted.id, &self.wanted);
        }
        // Tab leads from one field to the other.
        if self.replaces {
            widgets.push(field(ui, FIELDS[1], "Replace by", &mut self.by).id);
        }
        let replaced = self.replaced.filter(|_| selected.is_none());
        let said = match (count, selected) {
            _ if self.wanted.is_empty() => String::new(),
            (0, _) => "not found".to_owned(),
            (find::MOST_FOUND, None) => format!("more than {}", find::MOST_FOUND - 1),
            (find::MOST_FOUND, Some(at)) => format!("{} of more than {}", at + 1, find::MOST_FOUND - 1),
            (_, Some(at)) => format!("{} of {count}", at + 1),
            (_, None) => plural(count, "place"),
        };
        let said = replaced.map_or(said, |count| format!("{count} replaced"));
        ui.label(theme::small(ui, said));
        let mut button = |ui: &mut Ui, word: &str, possible: bool, help: &str, does: Asked| {
            let button = ui.add_enabled(possible, Button::new(word)).on_hover_text(help);
            if button.clicked() {
                asked = Some(does);
            }
            button
        };
        let mut all = vec![
            button(ui, "Previous", count > 0, "Shift+F3", Asked::Next(true)),
            button(ui, "Next", count > 0, "F3 or Enter", Asked::Next(false)),
            ui.checkbox(&mut self.exact, "Aa").on_hover_text("Small and capital letters differ"),
        ];
        if self.replaces {
            all.push(button(ui, "Replace", selected.is_some(), "The place that is selected", Asked::Replace));
            all.push(button(ui, "Replace all", count > 0, "Every place that is found", Asked::ReplaceAll));
        }
        // After a click, too, Esc closes the bar.
        all.iter().filter(|button| button.clicked()).for_each(Response::request_focus);
        let close = icon::button(ui, Icon::Cross, "Stop finding (Esc)");
        self.open &= !close.clicked();
        widgets.extend(all.iter().chain([&close]).map(|button| button.id));
        self.widgets = widgets;
        asked
    }
}
