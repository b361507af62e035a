//! Matches: commands and results.

use super::{Effect, Session, Severity};
use crate::{
    document::Edit,
    matching::{Match, MatchError, Measure, digits, parameters, rounded},
    parameter::Parameter,
    registry::Registry,
    scene::{Part, Scene, variant::LETTERS},
    text::listed,
};

/// A command for matches.
#[derive(Clone, Debug, PartialEq)]
pub enum MatchCommand {
    /// Open the dialog that matches this view to view A: 1 is view B.
    Ask(usize),
    /// Change the options in the dialog.
    Change(MatchDraft),
    /// Start the match.
    Start,
    /// Close the dialog without a match.
    Close,
    /// Fit the model beside a measurement to it.
    Fit,
    /// Fit every model to the measurement.
    Every(Measure),
    /// Put a fitted model into a view.
    Show(&'static str),
    /// Close the list of fits.
    CloseFits,
}

/// Options of a match that is about to start.
#[derive(Clone, Debug, PartialEq)]
pub struct MatchDraft {
    /// The view that is matched to view A.
    pub view: usize,
    /// The quantity to compare, and the metric.
    pub measure: Measure,
    /// Parameters of the view, each with true if it is free.
    pub parameters: Vec<(&'static Parameter, bool)>,
}

impl MatchDraft {
    /// The free parameters.
    pub fn free(&self) -> impl Iterator<Item = &'static Parameter> {
        self.parameters.iter().filter(|(_, free)| *free).map(|(parameter, _)| *parameter)
    }
}

/// A note as one more sentence.
fn sentence(note: &str) -> String {
    let (first, rest) = note.split_at(note.chars().next().map_or(0, char::len_utf8));
    format!(" {}{rest}.", first.to_uppercase())
}

impl Session {
    pub(super) fn matching(&mut self, command: MatchCommand, registry: &Registry) {
        let running = self.facts.matching.is_some() || self.facts.ranking.is_some();
        match command {
            MatchCommand::Ask(_) | MatchCommand::Fit | MatchCommand::Every(_) if running => {
                self.say(Severity::Info, "A match is still running: wait for it, or cancel it below.");
            }
            MatchCommand::Ask(view) => {
                let parameters = parameters(&self.document, view, registry);
                if parameters.is_empty() {
                    let letter = LETTERS.get(view).copied().unwrap_or("?");
                    let text = format!(
                        "View {letter} shows nothing that could be matched: no visible object has a numeric or colour parameter."
                    );
                    self.say(Severity::Info, text);
                } else {
                    self.match_draft = Some(MatchDraft { view, measure: Measure::default(), parameters });
                }
            }
            MatchCommand::Change(draft) => self.match_draft = Some(draft),
            MatchCommand::Start => {
                if let Some(draft) = self.match_draft.take() {
                    let names = draft.free().map(|parameter| parameter.name).collect();
                    self.request(Effect::Match {
                        view: draft.view,
                        measure: draft.measure,
                        parameters: names,
                    });
                }
            }
            MatchCommand::Close => self.match_draft = None,
            MatchCommand::Fit => self.fit(registry),
            MatchCommand::Every(measure) => self.fit_every(measure, registry),
            MatchCommand::Show(model) => self.show_fit(model, registry),
            MatchCommand::CloseFits => self.fits = None,
        }
    }

    /// Handles the end of a match: its values become one step of the history, unless the scene has changed since.
    /// `outcome` is `None` if the search crashed.
    pub fn matched(
        &mut self,
        scene: &Scene,
        (view, measure): (usize, Measure),
        outcome: Option<Result<Match, MatchError>>,
        registry: &Registry,
    ) {
        let letter = LETTERS.get(view).copied().unwrap_or("?");
        let unit = measure.unit();
        // The arrangement of the views does not matter.
        let is_same = || Scene { comparison: self.document.comparison, ..scene.clone() } == *self.document;
        let (severity, text) = match outcome {
            None => (Severity::Error, format!("The match of view {letter} failed: an internal error.")),
            Some(Err(MatchError::Cancelled)) => {
                (Severity::Info, format!("The match of view {letter} was cancelled; nothing was changed."))
            }
            Some(Err(why)) => (Severity::Error, format!("View {letter} was not matched: {why}.")),
            Some(Ok(_)) if !is_same() => {
                let what = format!("The scene was changed while view {letter} was matched");
                (Severity::Warning, format!("{what}, so nothing was applied. Match it again."))
            }
            Some(Ok(found)) if found.values.is_empty() => {
                let what = format!("View {letter} stays as it is: no other values come nearer to view A.");
                let note = found.ended.note().map_or_else(String::new, sentence);
                (Severity::Info, format!("{what} Error: {} ({unit}).{note}", digits(found.before)))
            }
            Some(Ok(found)) => return self.apply_match(view, measure, found, registry),
        };
        self.say(severity, text);
    }

    fn apply_match(&mut self, view: usize, measure: Measure, found: Match, registry: &Registry) {
        let letter = LETTERS.get(view).copied().unwrap_or("?");
        let label = |name: &&'static str| registry.material_parameter(name).map_or(*name, |p| p.label);
        let ambiguity = found.ambiguity(|name| label(&name)).map_or_else(String::new, |note| sentence(&note));
        let values: Vec<_> =
            found.values.iter().map(|(name, value)| format!("{} {}", label(name), rounded(value))).collect();
        let kept: Vec<_> = found.kept.iter().map(label).collect();
        let kept = match kept.as_slice() {
            [] => String::new(),
            names => format!(" Unchanged: {}.", listed(names, "and")),
        };
        let note = found.ended.note().map_or_else(String::new, sentence);
        let steps = self.document.done();
        let edit = Edit::materials(Part::Variant(view - 1), found.values, "Match");
        self.edit_here(edit, registry);
        self.look(registry);
        if self.document.done() != steps {
            let text = format!(
                "View {letter} matched to view A on the {measure}: {}.{kept} Error: {} → {} ({}).{ambiguity}{note}",
                listed(&values, "and"),
                digits(found.before),
                digits(found.after),
                measure.unit()
            );
            let step = self.last_step();
            self.messages.offer_undo(text, step);
        }
    }
}
