//! The scene as JSON in the editor.

use std::{path::Path, sync::Arc};

use super::{CODE_TAB, CodeOf, MOST_CODE, SCENE_JSON, Session, Severity};
use crate::{
    document::Extent,
    parameter::Outside,
    registry::Registry,
    scene::{
        Scene,
        error::Problem,
        load::{self, Defaults},
        save,
    },
    text::{place::Place, sentence},
};

impl Session {
    pub(super) fn edit_scene_here(&mut self, registry: &Registry) {
        self.view.unfold(CODE_TAB);
        self.follow_scene(registry);
        if self.code.show(&CodeOf::Scene, 0) {
            return;
        }
        let text = self.scene_json(registry);
        if text.len() > MOST_CODE {
            let text = format!(
                "The scene is {} KiB as JSON; the editor holds at most {} KiB. Save it, and edit the file.",
                text.len() >> 10,
                MOST_CODE >> 10
            );
            return self.say(Severity::Warning, text);
        }
        self.code.add(CodeOf::Scene, SCENE_JSON.to_owned(), &text, 1);
    }

    /// The scene of the document as JSON.
    fn scene_json(&self, registry: &Registry) -> String {
        save::to_json(self.document.scene(), None, registry)
    }

    /// Lets the scene in the editor follow the document: other panels, undo, a file that was opened.
    pub(in crate::panel) fn follow_scene(&mut self, registry: &Registry) {
        if self.code.of(&CodeOf::Scene).is_none() {
            return;
        }
        let now: Arc<str> = self.scene_json(registry).into();
        if let Some(open) = self.code.of_mut(&CodeOf::Scene) {
            open.found(now);
        }
    }

    /// Makes the scene in the editor that of the document, as one step of the history.
    pub(super) fn apply_scene(&mut self, registry: &Registry) {
        let Some(open) = self.code.visible() else { return };
        let read = read_scene(&open.text, self.path.as_deref(), registry, &self.outside);
        match read {
            Ok(scene) => {
                let scene = *scene;
                self.document.end_gesture();
                self.document.change("Scene as JSON", Extent::All, self.selection, |to| *to = scene);
                self.document.end_gesture();
                if !self.exists(self.selection) {
                    self.select_first();
                }
                let text = self.scene_json(registry).into();
                if let Some(open) = self.code.of_mut(&CodeOf::Scene) {
                    open.base = open.text.clone();
                    open.found(text);
                }
            }
            Err(problems) => {
                let said = |(at, what): &(Place, String)| format!("line {}: {what}", at.line);
                let first = problems.first().map_or_else(String::new, said);
                let text = sentence(&format!("The scene was not changed; its JSON has an error in {first}"));
                self.say(Severity::Warning, text);
            }
        }
    }
}

/// Reads a scene from its JSON. `path` is the file of the document, beside which the files named in the scene are.
///
/// # Errors
/// Returns the problems, each with its place; column 0 is a whole line.
pub(in crate::panel) fn read_scene(
    text: &str,
    path: Option<&Path>,
    registry: &Registry,
    outside: &Outside,
) -> Result<Box<Scene>, Vec<(Place, String)>> {
    let folder = path.and_then(Path::parent).unwrap_or(Path::new(""));
    let read =
        load::in_folder(text.as_bytes(), (SCENE_JSON, folder), registry, Defaults::Refuse.allowing(outside));
    read.map(|loaded| Box::new(loaded.scene)).map_err(|error| {
        let place = |problem: &Problem| {
            let bare = Problem { place: None, ..problem.clone() };
            (problem.place.unwrap_or(Place { line: 1, column: 0 }), bare.to_string())
        };
        error.problems().iter().map(place).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::state::{Action, CodeCommand, OpenCode};

    fn command(session: &mut Session, command: CodeCommand) {
        assert!(session.apply(Action::Code(command), &Registry::builtin()).is_empty());
    }

    fn typed(session: &mut Session, text: &str) {
        let number = of(session).number;
        command(session, CodeCommand::Type(number, text.into()));
    }

    fn of(session: &Session) -> &OpenCode {
        session.code.visible().expect("one is open")
    }

    #[test]
    fn the_scene_as_json_is_one_step_and_its_errors_have_lines() {
        let registry = Registry::builtin();
        let mut session = Session::default();
        command(&mut session, CodeCommand::Scene);
        let before = session.document.scene().clone();
        let text = of(&session).text.to_string();
        assert!(text.contains("\"exposure\"") || text.contains("\"lights\""), "{text}");
        // Another panel changes the scene: the text follows.
        let mut other = before.clone();
        other.name = Some("Another".to_owned());
        session.document.change("Name", Extent::All, session.selection, |scene| *scene = other);
        session.follow_scene(&registry);
        assert!(of(&session).text.contains("Another") && !of(&session).is_unsaved());
        // The text changes the scene, as one step.
        let steps = session.document.done();
        let edited = of(&session).text.replace("Another", "Mine");
        typed(&mut session, &edited);
        command(&mut session, CodeCommand::Save);
        assert_eq!(session.document.scene().name.as_deref(), Some("Mine"));
        assert_eq!(session.document.done(), steps + 1);
        assert!(!of(&session).is_unsaved());
        session.apply(Action::Undo, &registry);
        assert_eq!(session.document.scene().name.as_deref(), Some("Another"));
        // An error is told with its line, and changes nothing.
        session.follow_scene(&registry);
        let lines = of(&session).text.lines().count();
        let broken = format!("{}\n}}", of(&session).text.trim_end());
        let problems = read_scene(&broken, None, &registry, Outside::NONE).expect_err("a bracket too many");
        assert_eq!(problems.len(), 1);
        assert_eq!(problems[0].0.line, lines + 1, "{problems:?}");
        let scene = session.document.scene().clone();
        typed(&mut session, &broken);
        command(&mut session, CodeCommand::Save);
        assert_eq!(*session.document.scene(), scene);
        assert!(of(&session).is_unsaved());
    }
}
