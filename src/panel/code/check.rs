//! Checks of a text while it is typed: on a thread, after a short rest, and without a change of anything else.

use std::path::Path;

use super::{
    super::state::{CodeOf, OpenCode, read_scene},
    find::line,
};
use crate::{
    caught::{catch, message},
    custom,
    library::status::Trouble,
    panel::prelude::*,
    parameter::{Outside, Parameter},
    registry::compose::compose,
    shader::{check::ShaderProblem, whole::validate_drawing},
    shading::Stage,
    text::place::Place,
};

/// Most errors that are marked.
pub const MOST_MARKS: usize = 1000;

/// An error in a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mark {
    /// The line, from 1.
    pub line: usize,
    /// The column, from 1; 0 for the whole line.
    pub column: usize,
    /// The message.
    pub message: String,
}

/// The outcome of a check.
#[derive(Clone, Debug, Default)]
pub(super) struct Checked {
    /// The errors, by line.
    pub(super) marks: Vec<Mark>,
    /// The parameters that the text declares, if its declaration can be read.
    pub(super) parameters: Option<&'static [Parameter]>,
}

/// What a check needs of the window.
pub(super) struct Given {
    of: CodeOf,
    text: Arc<str>,
    registry: Registry,
    scene: Option<std::path::PathBuf>,
    outside: Outside,
    shown: [String; 2],
}

impl Given {
    pub(super) fn new(open: &OpenCode, session: &Session, registry: &Registry) -> Self {
        Self {
            of: open.of.clone(),
            text: open.text.clone(),
            registry: registry.clone(),
            scene: session.path.clone(),
            outside: session.outside.clone(),
            shown: [session.model_shown().to_owned(), session.shading_shown().to_owned()],
        }
    }

    /// Checks the text. A panic of a library is an error like any other.
    pub(super) fn check(self) -> Checked {
        catch(|| self.run()).unwrap_or_else(|payload| {
            let message = format!("this text cannot be checked: {}", message(&*payload));
            Checked { marks: vec![Mark { line: 1, column: 0, message }], parameters: None }
        })
    }

    fn run(&self) -> Checked {
        let CodeOf::File(path) = &self.of else {
            let read = read_scene(&self.text, self.scene.as_deref(), &self.registry, &self.outside);
            let mark = |(at, message): (Place, String)| Mark { line: at.line, column: at.column, message };
            let marks = read.err().into_iter().flatten().take(MOST_MARKS).map(mark).collect();
            return Checked { marks, parameters: None };
        };
        let [model, shading] = &self.shown;
        let found = problems(path, &self.text, &self.registry, [model, shading]);
        let source = self.registry.folders().source_of(path).unwrap_or_default();
        let parameters = custom::is_model(&self.text)
            .then(|| custom::declare(path, &self.text, &self.registry).ok())
            .flatten()
            .map(|model| model.entry.parameters);
        Checked { marks: marks(found, &source), parameters }
    }
}

/// The problems as marks in the text of one of the files.
fn marks(found: Vec<ShaderProblem>, source: &str) -> Vec<Mark> {
    let mark = |problem: ShaderProblem| match problem.file == source || source.is_empty() {
        true => Mark { line: problem.line, column: problem.column, message: problem.message },
        false => Mark { line: 1, column: 0, message: problem.to_string() },
    };
    let mut all: Vec<_> = found.into_iter().take(MOST_MARKS).map(mark).collect();
    all.sort_by_key(|mark| (mark.line, mark.column));
    all
}

/// The problems of the file of a text that drawing found.
fn troubles<'a>(open: &'a OpenCode, session: &'a Session) -> impl Iterator<Item = &'a ShaderProblem> {
    let own = move |trouble: &&Trouble| open.path().is_some_and(|path| trouble.path.as_deref() == Some(path));
    session.shaders.troubles.iter().filter(own).map(|trouble| &trouble.problem)
}

/// The errors that drawing found, where they belong to this text: the line is that which was compiled.
pub(super) fn drawn(open: &OpenCode, session: &Session) -> Vec<Mark> {
    let is_here = |problem: &&ShaderProblem| {
        let (here, compiled) = (open.text[line(&open.text, problem.line)].trim(), problem.source.trim());
        here == compiled && !here.is_empty()
    };
    let mark = |p: &ShaderProblem| Mark { line: p.line, column: p.column, message: p.message.clone() };
    troubles(open, session).filter(is_here).take(MOST_MARKS).map(mark).collect()
}

/// Why the file of a text cannot be used, where that has no line in it.
pub(super) fn refused<'a>(open: &'a OpenCode, session: &'a Session) -> Option<&'a str> {
    let first_line = &open.text[line(&open.text, 1)];
    let is_of_file = |problem: &&ShaderProblem| problem.source.is_empty() && !first_line.trim().is_empty();
    troubles(open, session).find(is_of_file).map(|problem| problem.message.as_str())
}

/// The problems of the text of a file, as far as they can be known without drawing. `shown` are the ids of the
/// reflection model and the shading model of the picture, with which a file that belongs to no model is checked.
#[must_use]
pub fn problems(path: &Path, text: &str, registry: &Registry, shown: [&str; 2]) -> Vec<ShaderProblem> {
    let source = registry.folders().source_of(path);
    let is_custom = source.as_deref().is_none_or(|source| source.starts_with("models/"));
    if is_custom && custom::is_model(text) {
        return custom::read(path, text, registry).err().unwrap_or_default();
    }
    let Some(source) = source else { return Vec::new() };
    let mut sources = registry.sources().clone();
    sources.edit(source.clone(), text);
    let own = registry.models().iter().find(|model| model.declaration.wgsl.path == source);
    let own_shading = registry.shading_models().iter().find(|s| s.declaration.wgsl.path == source);
    let Some((model, shading)) = own
        .or_else(|| registry.model(shown[0]))
        .zip(own_shading.or_else(|| registry.shading_model(shown[1])))
    else {
        return Vec::new();
    };
    let composed = compose(&sources, (model, model.declaration.passage()), shading, registry.lights());
    if !composed.map.has(&source) && composed.problem.is_none() {
        return Vec::new();
    }
    let faces = shading.declaration.stage == Stage::Polygon;
    validate_drawing(&composed, faces).err().map(|problem| vec![*problem]).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::library::assets::EXAMPLES;

    const SHOWN: [&str; 2] = ["lambert", "phong"];

    fn said(text: &str) -> Vec<Mark> {
        let found = problems(Path::new("models/a.wgsl"), text, &Registry::builtin(), SHOWN);
        marks(found, "models/a.wgsl")
    }

    #[test]
    fn an_error_is_at_its_line_and_a_correct_model_has_none() {
        let (_, text) = EXAMPLES[1];
        assert_eq!(said(text), []);
        let line = 1 + text.lines().position(|line| line.starts_with("fn response")).expect("a model");
        let broken = text.replacen("fn response", "fn wrong() -> f32 { return no_such; }\nfn response", 1);
        let marks = said(&broken);
        assert_eq!(marks.len(), 1);
        assert_eq!(marks[0].line, line);
        assert!(marks[0].message.contains("no_such"), "{}", marks[0].message);
        assert_eq!(
            broken.lines().nth(line - 1).map(|l| l.find("no_such").map(|at| at + 1)),
            Some(Some(marks[0].column))
        );
    }

    #[test]
    fn errors_of_a_declaration_are_all_marked() {
        let text = "/* lcm\n{\n  \"laws\": [\"no law\"],\n  \"nonsense\": 1\n}\n*/\nfn response() {}\n";
        let lines: Vec<_> = said(text).into_iter().map(|mark| mark.line).collect();
        assert_eq!(lines, [3, 4]);
    }

    #[test]
    fn an_error_of_the_scene_is_at_its_character() {
        let marked = |text: &str| {
            let mut code = super::super::super::state::Code::default();
            code.add(CodeOf::Scene, String::new(), text, 1);
            let checked = Given::new(&code.open[0], &Session::default(), &Registry::builtin()).check();
            checked.marks.first().map(|mark| (mark.line, mark.column))
        };
        let text = crate::scene::save::to_json(&Scene::default(), None, &Registry::builtin());
        assert_eq!(marked(&text), None);
        let wrong = text.replacen("\"name\"", "\"nmae\"", 1);
        let at = wrong.find("\"nmae\"").expect("it is given");
        let line = wrong[..at].matches('\n').count() + 1;
        let column = at - wrong[..at].rfind('\n').map_or(0, |end| end + 1) + 1;
        assert_eq!(marked(&wrong), Some((line, column)));
        assert_eq!(marked("{ \"name\": \"a\" \"lights\": [] }"), Some((1, 15)), "a comma is missing");
    }

    #[test]
    fn what_drawing_found_is_marked_only_in_the_text_that_was_compiled() {
        let mut code = super::super::super::state::Code::default();
        let path = || std::path::PathBuf::from("/lab/models/a.wgsl");
        code.add(CodeOf::File(path()), "a.wgsl".to_owned(), "fn f() {}\n\tlet x = 1;\n", 1);
        let open = code.open.remove(0);
        let with = |line, source: &str| {
            let mut session = Session::default();
            let problem = ShaderProblem {
                file: "models/a.wgsl".to_owned(),
                line,
                column: 1,
                source: source.to_owned(),
                message: "wrong".to_owned(),
            };
            session.shaders.troubles.push(Trouble { problem, path: Some(path()), stale: Vec::new() });
            session
        };
        let lines = |session: &Session| drawn(&open, session).iter().map(|m| m.line).collect::<Vec<_>>();
        let compiled = with(2, "\tlet x = 1;");
        assert_eq!((lines(&compiled), refused(&open, &compiled)), (vec![2], None));
        // Of bytes that are no text, and of another version.
        for other in [with(1, "\u{fffd}\u{fffd}"), with(2, "let y = 1;"), with(9, "let z;")] {
            assert_eq!((lines(&other), refused(&open, &other)), (Vec::new(), None));
        }
        // The file is missing.
        let gone = with(1, "");
        assert_eq!((lines(&gone), refused(&open, &gone)), (Vec::new(), Some("wrong")));
    }

    #[test]
    fn whatever_is_typed_a_check_ends() {
        for text in
            ["", "/*", "/* lcm {", "fn response(", &"(".repeat(100_000), &"/*".repeat(50_000), "\u{0}é"]
        {
            let open = |of| {
                let mut code = super::super::super::state::Code::default();
                code.add(of, String::new(), text, 1);
                code.open.remove(0)
            };
            for of in [CodeOf::File("models/a.wgsl".into()), CodeOf::Scene] {
                let given = Given::new(&open(of.clone()), &Session::default(), &Registry::builtin());
                let checked = given.check();
                assert!(
                    !checked.marks.is_empty() || text.is_empty() || matches!(of, CodeOf::File(_)),
                    "{text:.20}"
                );
            }
        }
    }
}
