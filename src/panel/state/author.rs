//! Custom models and shaders: the name of a new model, its file, and the check of laws.

use super::{Action, Effect, ModelCommand, SHADER_TAB, Session, Severity};
use crate::{
    custom::{id_of_name, source_path},
    library::status::Reloaded,
    reflection::law_report::LawReport,
    registry::Registry,
};

/// A model that is about to be created.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ModelDraft {
    /// Id of the model to copy; `None` for a new model.
    pub of: Option<String>,
    /// Name as typed; the identifier is derived from it.
    pub name: String,
}

/// A check of the laws of a model.
#[derive(Clone, Debug, PartialEq)]
pub struct LawCheck {
    /// Id of the model.
    pub model: String,
    /// The latest shader reload when the check started: a later one makes the check out of date.
    pub since: Option<Reloaded>,
    /// The findings or an error; `None` while the check runs.
    pub outcome: Option<Result<LawReport, String>>,
}

/// The writing of custom models and shaders.
#[derive(Clone, Debug, Default)]
pub struct Authoring {
    /// The custom model that is about to be created.
    pub draft: Option<ModelDraft>,
    /// A model to select once it is available, because its file was just written.
    pub wanted_model: Option<String>,
    /// The view that gets it: the one that was active when its file was written.
    pub wanted_view: usize,
    /// The latest law check of a model.
    pub laws: Option<LawCheck>,
    /// Shader problems of the previous frame, by file and message.
    pub(in crate::panel) seen_troubles: Vec<(String, String)>,
}

/// A problem with a name.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NameProblem {
    /// The problem as a sentence.
    pub why: String,
    /// A similar identifier that is valid and free.
    pub instead: Option<String>,
}

/// The identifier for a new model with the given name.
///
/// # Errors
/// Returns an error with the rule that the name violates, and a valid alternative if there is one.
pub fn check_name(name: &str, registry: &Registry) -> Result<String, NameProblem> {
    let problem = |why: String, instead: Option<String>| Err(NameProblem { why, instead });
    if name.trim().is_empty() {
        return problem("Type a name, such as My velvet.".to_owned(), None);
    }
    let id = match id_of_name(name) {
        Ok(id) => id,
        Err(bad) => {
            let instead = bad.instead.map(|id| free_id(&id, registry));
            let hint = instead.as_ref().map_or_else(String::new, |id| format!(", for example “{id}”"));
            let rule = "Use only letters a–z, digits and spaces, beginning with a letter, at most 40";
            return problem(format!("{rule}{hint}."), instead);
        }
    };
    // A file without a valid model also counts.
    let taken = if registry.model(&id).is_some() {
        format!("There is already a model “{id}”")
    } else if registry.broken_model(&id).is_some() {
        format!("There is already a file {}", source_path(&id))
    } else {
        return Ok(id);
    };
    let free = free_id(&id, registry);
    problem(format!("{taken}; “{free}” is free."), Some(free))
}

/// A free id: the given one, or that with a number.
fn free_id(id: &str, registry: &Registry) -> String {
    let taken = |id: &str| registry.model(id).is_some() || registry.broken_model(id).is_some();
    let numbered = (2..).map(|n| format!("{id}_{n}"));
    std::iter::once(id.to_owned()).chain(numbered).find(|id| !taken(id)).unwrap_or_default()
}

impl Authoring {
    /// Creates the model whose name was typed.
    fn create(&mut self, registry: &Registry) -> Option<Effect> {
        // The problem is shown beside the field.
        let checked = self.draft.as_ref().and_then(|draft| check_name(&draft.name, registry).ok());
        let (id, ModelDraft { of, name }) = checked.and_then(|id| Some((id, self.draft.take()?)))?;
        Some(Effect::NewModel { of, id, name: name.trim().to_owned() })
    }

    /// Starts a check of a model, unless one runs. `since` is the latest reload of shaders.
    fn check_laws(&mut self, model: String, since: Option<Reloaded>) -> Option<Effect> {
        let running = self.laws.as_ref().is_some_and(|check| check.outcome.is_none());
        (!running).then(|| {
            self.laws = Some(LawCheck { model: model.clone(), since, outcome: None });
            Effect::CheckLaws(model)
        })
    }

    /// Receives the result of a law check.
    pub fn laws_checked(&mut self, model: &str, outcome: Result<LawReport, String>) {
        if let Some(check) = self.laws.as_mut().filter(|check| check.model == model) {
            check.outcome = Some(outcome);
        }
    }
}

impl Session {
    /// Applies a command for custom models and shaders.
    pub(super) fn author(&mut self, ask: ModelCommand, registry: &Registry) {
        match ask {
            ModelCommand::New => {
                self.authoring.draft = Some(ModelDraft { of: None, name: free_id("my_model", registry) });
            }
            ModelCommand::Duplicate => {
                let of = self.model_shown().to_owned();
                self.author(ModelCommand::DuplicateOf(of), registry);
            }
            ModelCommand::DuplicateOf(of) => {
                if registry.model(&of).is_none() {
                    return self.say(Severity::Warning, format!("There is no model “{of}” to copy."));
                }
                let name = free_id(&format!("my_{}", of.trim_start_matches("my_")), registry);
                self.authoring.draft = Some(ModelDraft { of: Some(of), name });
            }
            ModelCommand::Type(text) => {
                if let Some(draft) = &mut self.authoring.draft {
                    draft.name = text;
                }
            }
            ModelCommand::Create => {
                if let Some(effect) = self.authoring.create(registry) {
                    self.view.examples_open = false;
                    self.request(effect);
                }
            }
            ModelCommand::Cancel => self.authoring.draft = None,
            ModelCommand::EditShown => self.edit_shown(registry),
            ModelCommand::CheckLaws => {
                let model = self.model_shown().to_owned();
                self.requested.extend(self.authoring.check_laws(model, self.shaders.last.clone()));
            }
        }
    }

    /// Selects the model whose file was just written in the view in which it was asked for, which may not be the active one
    /// any more.
    pub(in crate::panel) fn choose_wanted_model(&mut self, registry: &Registry) {
        let Some(id) = self.authoring.wanted_model.take() else { return };
        let (active, asked) = (self.active(), self.authoring.wanted_view);
        if asked <= self.document.variants.len() {
            self.view.active = asked;
            self.look(registry);
        }
        let (edit, news) = (self.edit_model(&id), self.has_news());
        // An edit never requests a file.
        let _ = self.apply(Action::Edit(edit), registry);
        if news {
            self.keep_news();
        }
        self.view.active = active;
        self.look(registry);
    }

    fn edit_shown(&mut self, registry: &Registry) {
        let id = self.model_shown();
        let path = registry.model(id).map_or_else(|| source_path(id), |m| m.declaration.wgsl.path.to_owned());
        match self.shaders.folders.file_of(&path) {
            Some(file) => {
                let line = self.line_of_trouble(&path).unwrap_or(1);
                self.request(Effect::OpenInEditor { path: file, line });
            }
            None => {
                self.say(Severity::Info, BUILT_IN);
                self.view.unfold(SHADER_TAB);
            }
        }
    }

    /// The line of the first problem in a file.
    #[must_use]
    pub fn line_of_trouble(&self, path: &str) -> Option<usize> {
        self.shaders.troubles.iter().find(|t| t.problem.file == path).map(|t| t.problem.line)
    }
}

/// Why a file can't be opened.
pub const BUILT_IN: &str = "The shaders are built in, so there is no file to open. Export the shaders first: \
     Edit, “Export shaders for editing…”. Or copy the model as a file.";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_taken_as_the_command_line_takes_them_and_the_message_says_one_that_would_do() {
        let registry = Registry::builtin();
        for (good, id) in [
            ("my_velvet", "my_velvet"),
            ("x", "x"),
            ("Student toon", "student_toon"),
            ("  My  GGX-2 (test)! ", "my_ggx_2_test"),
            ("a__b", "a__b"),
        ] {
            assert_eq!(check_name(good, &registry).as_deref(), Ok(id), "{good}");
            assert_eq!(id_of_name(good).as_deref(), Ok(id), "{good}");
        }
        for (bad, word) in [
            ("", "such as My velvet"),
            ("2 fast", "for example “fast”"),
            ("../evil", "for example “evil”"),
            ("velvet.wgsl", "for example “velvet_wgsl”"),
            ("größe", "for example “groesse”"),
            ("Évolué", "for example “evolue”"),
            ("漢字", "for example “han_zi”"),
            ("42", "at most 40."),
            (&"x".repeat(41), &format!("for example “{}”", "x".repeat(40))),
        ] {
            let said = check_name(bad, &registry).expect_err(bad).why;
            assert!(said.contains(word), "{bad}: {said}");
            assert!(id_of_name(bad).is_err(), "{bad}");
        }
        let said = check_name("Phong", &registry).expect_err("there is one");
        assert_eq!(said.why, "There is already a model “phong”; “phong_2” is free.");
        assert_eq!(said.instead.as_deref(), Some("phong_2"));
        assert!(check_name(&"x".repeat(40), &registry).is_ok());
        let mut registry = Registry::builtin();
        registry.mark_broken("my_velvet", "why".to_owned());
        let said = check_name("My velvet", &registry).expect_err("there is a file");
        assert_eq!(said.why, "There is already a file models/my_velvet.wgsl; “my_velvet_2” is free.");
    }
}
