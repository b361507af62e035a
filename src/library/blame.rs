//! Traces problems in unedited files back to the edited ones.

use super::Library;
use crate::{
    registry::Registry,
    shader::{check::ShaderProblem, compose::Composed, limits},
    text::detailed,
};

impl Library {
    /// Names the edited file that causes a problem in another one: it is empty, or no longer declares
    /// something used there.
    #[must_use]
    pub fn blamed(
        &self,
        mut problem: Box<ShaderProblem>,
        composed: &Composed,
        registry: &Registry,
    ) -> Box<ShaderProblem> {
        if registry.sources().get(&problem.file).is_some() {
            return problem;
        }
        let text = |source: &str| registry.sources().get(source).or_else(|| self.pending(source));
        let edited = || composed.map.files().filter(|source| text(source).is_some());
        let empty = || edited().find(|source| text(source).is_some_and(limits::is_empty));
        let changed = || self.changed().filter(|source| composed.depends_on(source));
        let Some(cause) = empty().or_else(changed).or_else(|| edited().next()) else {
            return problem;
        };
        let text = text(cause).unwrap_or_default();
        let generated = problem.file.starts_with('(');
        if !generated && !limits::is_empty(text) {
            problem.message = detailed(&problem.message, &format!("introduced by the change in {cause}"));
            return problem;
        }
        let message = match text.trim().is_empty() {
            true => format!("the file is empty; {}", problem.message),
            false => format!("after the end of the file: {}", problem.message),
        };
        let text = text.trim_end();
        let last = text.char_indices().last().map_or(0, |(at, _)| at);
        Box::new(ShaderProblem::at(cause, text, last, message))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::registry::compose::compose_evaluation;

    fn blamed(edited: &[(&str, &str)], file: &str) -> ShaderProblem {
        let mut registry = Registry::builtin();
        edited.iter().for_each(|(source, text)| registry.sources_mut().edit(*source, *text));
        let composed = compose_evaluation(registry.sources(), &registry.models()[0]);
        let problem = ShaderProblem {
            file: file.to_owned(),
            line: 9,
            column: 9,
            source: "…".to_owned(),
            message: "wrong".to_owned(),
        };
        *Library::default().blamed(Box::new(problem), &composed, &registry)
    }

    #[test]
    fn a_problem_leads_to_the_file_that_was_edited() {
        let said = |edited: &[(&str, &str)], file: &str| blamed(edited, file).to_string();
        let terms = ("terms.wgsl", "fn f() {}\nfn g() {}\n");
        assert_eq!(said(&[terms], "terms.wgsl"), "terms.wgsl:9:9: wrong", "it shows where it is");
        assert_eq!(said(&[], "evaluate.wgsl"), "evaluate.wgsl:9:9: wrong", "nothing was edited");
        assert_eq!(
            said(&[terms], "evaluate.wgsl"),
            "evaluate.wgsl:9:9: wrong; introduced by the change in terms.wgsl"
        );
        assert_eq!(said(&[terms], "(row)"), "terms.wgsl:2:9: after the end of the file: wrong");
        assert_eq!(
            said(&[terms, ("reflection/lambert.wgsl", "\n")], "evaluate.wgsl"),
            "reflection/lambert.wgsl:1:1: the file is empty; wrong"
        );
    }
}
