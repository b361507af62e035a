//! The texts that are open in the editor: files of shaders and custom models, and the scene as JSON.
//!
//! A text of a file has three versions: the one that is typed, the one that was last read or written, and that of the
//! file now. Where both the first and the last have changed, the user decides; until then nothing is written.

use std::{
    mem,
    path::{Path, PathBuf},
    sync::Arc,
};

use super::{CODE_TAB, CodeCommand, Effect, Note, Session, Severity};
use crate::{
    custom::source_path, files::Shown as _, platform::fs, recovery::texts::OF_SCENE, registry::Registry,
};

/// Greatest size of a text in the editor, bytes.
pub const MOST_CODE: usize = 256 << 10;
/// Name of the scene in the editor, and in messages about it.
pub const SCENE_JSON: &str = "scene.json";

/// The subject of an open text.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum CodeOf {
    /// A file.
    File(PathBuf),
    /// The scene of the document.
    Scene,
}

/// The version of the subject that another program, or another panel, made meanwhile.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Theirs {
    /// Another text.
    Changed(Arc<str>),
    /// The file is gone.
    Gone,
    /// The file cannot be read as text, for this reason.
    Unreadable(String),
}

/// An open text.
#[derive(Clone, Debug, PartialEq)]
pub struct OpenCode {
    /// The subject.
    pub of: CodeOf,
    /// The name on its tab.
    pub name: String,
    /// The text as typed.
    pub text: Arc<str>,
    /// The text as last read or written.
    pub base: Arc<str>,
    /// True if lines of the file end with a carriage return and a line feed, as on Windows.
    pub crlf: bool,
    /// The other version, until the user has decided.
    pub theirs: Option<Theirs>,
    /// True while the difference from the other version is shown in place of the text.
    pub shows_difference: bool,
    /// The text that was here before, which undoing in the editor brings back; the panel takes it.
    pub replaced: Option<Arc<str>>,
    /// True while the user is asked about unsaved changes, because the text is being closed.
    pub closing: bool,
    /// Unique number.
    pub number: u64,
}

impl OpenCode {
    /// True if there are changes that are nowhere but in the editor, or if the whole text is.
    #[must_use]
    pub fn is_unsaved(&self) -> bool {
        self.text != self.base || matches!(self.theirs, Some(Theirs::Gone | Theirs::Unreadable(_)))
    }

    /// The text as it is written to the file.
    #[must_use]
    pub fn written(&self) -> String {
        if self.crlf { self.text.replace('\n', "\r\n") } else { self.text.to_string() }
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        match &self.of {
            CodeOf::File(path) => Some(path),
            CodeOf::Scene => None,
        }
    }
}

/// Unsaved text that an earlier window left.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct KeptCode {
    /// The file that it belongs to.
    pub path: PathBuf,
    /// The text.
    pub text: Arc<str>,
    /// Its age: "5 minutes ago".
    pub when: String,
}

/// The open texts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Code {
    /// The texts, in the order in which they were opened.
    pub open: Vec<OpenCode>,
    /// Index of the visible text.
    pub shown: usize,
    /// The line to go to, from 1, with the number of the text; 0 is where its cursor is. The panel takes it.
    pub goto: Option<(u64, usize)>,
    /// Texts of earlier windows that wait for the user.
    pub kept: Vec<KeptCode>,
    /// Files whose texts of earlier windows are no longer needed.
    pub outdated: Vec<PathBuf>,
    /// Number of texts opened so far.
    opened: u64,
}

impl Code {
    /// The visible text.
    #[must_use]
    pub fn visible(&self) -> Option<&OpenCode> {
        self.open.get(self.shown)
    }

    /// The text with this subject.
    #[must_use]
    pub fn of(&self, of: &CodeOf) -> Option<&OpenCode> {
        self.open.iter().find(|open| open.of == *of)
    }

    pub(in crate::panel) fn of_mut(&mut self, of: &CodeOf) -> Option<&mut OpenCode> {
        self.open.iter_mut().find(|open| open.of == *of)
    }

    fn visible_mut(&mut self) -> Option<&mut OpenCode> {
        self.open.get_mut(self.shown)
    }

    /// Makes a text visible that is open already, at a line, or with 0 as it was left. True if there is one.
    pub(in crate::panel) fn show(&mut self, of: &CodeOf, line: usize) -> bool {
        let Some(at) = self.open.iter().position(|open| open.of == *of) else { return false };
        self.shown = at;
        self.goto = Some((self.open[at].number, line));
        true
    }

    /// Adds a text, and makes it visible at a line.
    pub(in crate::panel) fn add(&mut self, of: CodeOf, name: String, text: &str, line: usize) {
        let base: Arc<str> = text.replace("\r\n", "\n").into();
        self.opened += 1;
        let crlf = text.contains("\r\n");
        let open = OpenCode {
            of,
            name,
            text: base.clone(),
            base,
            crlf,
            theirs: None,
            shows_difference: false,
            replaced: None,
            closing: false,
            number: self.opened,
        };
        self.open.push(open);
        self.shown = self.open.len() - 1;
        self.goto = Some((self.opened, line.max(1)));
    }
}

impl Session {
    /// Applies a command for the editor.
    pub(super) fn code(&mut self, command: CodeCommand, registry: &Registry) {
        self.focus_after(&command);
        match command {
            CodeCommand::Model => {
                let id = self.model_shown().to_owned();
                self.edit_model_here(&id, registry)
            }
            CodeCommand::ModelOf(id) => self.edit_model_here(&id, registry),
            CodeCommand::File(path, line) => self.edit_file_here(path, line),
            CodeCommand::Scene => self.edit_scene_here(registry),
            CodeCommand::Follow => self.follow_scene(registry),
            CodeCommand::Show(at) => self.code.shown = at.min(self.code.open.len().saturating_sub(1)),
            CodeCommand::Type(number, text) => {
                if let Some(open) = self.code.open.iter_mut().find(|open| open.number == number) {
                    (open.text, open.closing) = (text, false);
                }
            }
            CodeCommand::Arrived => {
                self.code.goto = None;
                self.code.visible_mut().into_iter().for_each(|open| open.replaced = None);
            }
            CodeCommand::Save => self.save_code(registry),
            CodeCommand::Close => match self.code.visible_mut() {
                Some(open) if open.is_unsaved() => open.closing = true,
                Some(_) => self.close_code(),
                None => {}
            },
            CodeCommand::Discard => self.close_code(),
            CodeCommand::Stay => self.code.visible_mut().into_iter().for_each(|open| open.closing = false),
            CodeCommand::KeepMine => {
                let Some(open) = self.code.visible_mut() else { return };
                open.shows_difference = false;
                match open.theirs.take() {
                    Some(Theirs::Changed(theirs)) => open.base = theirs,
                    // What cannot be read differs from any text.
                    Some(Theirs::Unreadable(_)) => self.write_code(true),
                    gone => open.theirs = gone,
                }
            }
            CodeCommand::TakeTheirs => {
                let Some(open) = self.code.visible_mut() else { return };
                open.shows_difference = false;
                match open.theirs.take() {
                    Some(Theirs::Changed(theirs)) => {
                        (open.text, open.base) = (theirs.clone(), theirs);
                    }
                    other => open.theirs = other,
                }
            }
            CodeCommand::Difference(on) => {
                self.code.visible_mut().into_iter().for_each(|open| open.shows_difference = on)
            }
            CodeCommand::Recover(path) => self.recover_code(&path, registry),
        }
    }

    /// Brings the focus back to the text after a choice above it, whose button is gone.
    fn focus_after(&mut self, command: &CodeCommand) {
        if matches!(
            command,
            CodeCommand::Stay
                | CodeCommand::KeepMine
                | CodeCommand::TakeTheirs
                | CodeCommand::Difference(false)
        ) {
            self.code.goto = self.code.visible().map(|open| (open.number, 0));
        }
    }

    fn close_code(&mut self) {
        if self.code.shown < self.code.open.len() {
            self.code.open.remove(self.code.shown);
            self.code.shown = self.code.shown.min(self.code.open.len().saturating_sub(1));
        }
        if self.code.open.is_empty() {
            self.code.goto = None;
        }
    }

    fn edit_model_here(&mut self, id: &str, registry: &Registry) {
        let path = registry.model(id).map_or_else(|| source_path(id), |m| m.declaration.wgsl.path.to_owned());
        match self.shaders.folders.file_of(&path) {
            Some(file) => {
                let line = self.line_of_trouble(&path).unwrap_or(0);
                self.edit_file_here(file, line);
            }
            None => self.note(Note::new(Severity::Info, super::BUILT_IN).offering(
                "Duplicate as a file…",
                super::Action::Model(super::ModelCommand::DuplicateOf(id.to_owned())),
            )),
        }
    }

    fn edit_file_here(&mut self, path: PathBuf, line: usize) {
        self.view.unfold(CODE_TAB);
        if !self.code.show(&CodeOf::File(path.clone()), line) {
            self.request(Effect::OpenCode { path, line });
        }
    }

    fn save_code(&mut self, registry: &Registry) {
        if self.code.visible().is_some_and(|open| open.of == CodeOf::Scene) {
            self.follow_scene(registry);
        }
        let Some(open) = self.code.visible() else { return };
        match (&open.of, &open.theirs) {
            (_, Some(Theirs::Changed(_))) => {
                let text = format!("{} has changed on both sides: choose which version to keep.", open.name);
                self.say(Severity::Warning, text);
            }
            (_, Some(Theirs::Unreadable(_))) => {
                let text =
                    format!("{} can no longer be read: “Write mine over it” replaces the file.", open.name);
                self.say(Severity::Warning, text);
            }
            (CodeOf::File(_), _) => self.write_code(false),
            (CodeOf::Scene, _) => self.apply_scene(registry),
        }
    }

    fn write_code(&mut self, overwrite: bool) {
        let Some(open) = self.code.visible() else { return };
        if let Some(path) = open.path() {
            let path = path.to_owned();
            self.request(Effect::SaveCode { path, overwrite });
        }
    }

    fn recover_code(&mut self, path: &Path, registry: &Registry) {
        let Some(at) = self.code.kept.iter().position(|kept| kept.path == path) else { return };
        let kept = self.code.kept.remove(at);
        self.withdraw_kept(path);
        if kept.path == Path::new(OF_SCENE) {
            self.edit_scene_here(registry);
            return self.continue_with(&CodeOf::Scene, kept.text);
        }
        let of = CodeOf::File(kept.path.clone());
        self.view.unfold(CODE_TAB);
        if self.code.of(&of).is_some() {
            self.continue_with(&of, kept.text);
        } else {
            self.request(Effect::RecoverCode { path: kept.path, text: kept.text });
        }
    }

    /// Puts the text of an earlier window in the place of an open one, as a step that the editor undoes.
    pub(in crate::panel) fn continue_with(&mut self, of: &CodeOf, text: Arc<str>) {
        self.code.show(of, 1);
        let Some(open) = self.code.of_mut(of) else { return };
        (open.closing, open.shows_difference) = (false, false);
        let before = mem::replace(&mut open.text, text);
        if before == open.text {
            let place = open.path().unwrap_or(Path::new(OF_SCENE)).to_owned();
            let said = format!("Nothing to continue: {} already has the text that was kept.", open.name);
            self.code.outdated.push(place);
            self.say(Severity::Info, said);
        } else if !before.is_empty() {
            open.replaced = Some(before);
            let said = format!(
                "The unsaved text of {} is in the editor. Ctrl+Z there brings back the text that it replaces.",
                open.name
            );
            self.say(Severity::Info, said);
        }
    }

    /// Withdraws the offers to continue with texts of a file that has been saved since they were kept.
    pub(in crate::panel) fn outdate_kept(&mut self, path: &Path) {
        let Ok(path) = fs::absolute(path) else { return };
        let count = self.code.kept.len();
        self.code.kept.retain(|kept| kept.path != path);
        if self.code.kept.len() < count {
            self.withdraw_kept(&path);
            self.code.outdated.push(path);
        }
    }

    /// Removes the messages that offer to continue with the text of a file, if there is none any more.
    fn withdraw_kept(&mut self, path: &Path) {
        if self.code.kept.iter().any(|kept| kept.path == path) {
            return;
        }
        let offer = super::Action::Code(CodeCommand::Recover(path.to_owned()));
        self.messages.retain(|note| note.offer.as_ref().is_none_or(|(_, action)| **action != offer));
    }

    /// True if the editor is in sight with the file that all errors of shaders are in: it marks them at their lines.
    #[must_use]
    pub fn edits_troubles(&self) -> bool {
        let in_sight = self.sees(CODE_TAB) && !self.view.presenting;
        let file = self.code.visible().filter(|_| in_sight).and_then(OpenCode::path);
        file.is_some_and(|file| self.shaders.troubles.iter().all(|t| t.path.as_deref() == Some(file)))
    }

    /// True if the editor has changes that are nowhere else.
    #[must_use]
    pub fn has_unsaved_code(&self) -> bool {
        self.code.open.iter().any(OpenCode::is_unsaved)
    }

    /// The numbers of texts whose changes an action would lose: all when the window closes, that of the scene when another
    /// scene takes its place.
    fn texts_at_risk(&self, action: &super::Action) -> Vec<u64> {
        let is_at_risk = |open: &&OpenCode| {
            open.is_unsaved() && (*action == super::Action::Quit || open.of == CodeOf::Scene)
        };
        self.code.open.iter().filter(is_at_risk).map(|open| open.number).collect()
    }

    /// The names of texts whose changes an action would lose.
    pub(in crate::panel) fn names_at_risk(&self, action: &super::Action) -> Vec<&str> {
        let all = self.texts_at_risk(action);
        let is_one = |open: &&OpenCode| all.contains(&open.number);
        self.code.open.iter().filter(is_one).map(|open| &*open.name).collect()
    }

    /// Shows the first text whose changes an action would lose.
    pub(super) fn show_at_risk(&mut self, action: &super::Action) {
        let first = self.texts_at_risk(action).first().copied();
        if let Some(at) = self.code.open.iter().position(|open| Some(open.number) == first) {
            self.code.shown = at;
            self.view.unfold(CODE_TAB);
        }
    }

    /// Takes back the changes that an action would lose.
    pub(super) fn forget_at_risk(&mut self, action: &super::Action) {
        let all = self.texts_at_risk(action);
        for open in self.code.open.iter_mut().filter(|open| all.contains(&open.number)) {
            (open.text, open.theirs) = (open.base.clone(), None);
        }
    }

    /// Offers the unsaved texts that earlier windows left.
    pub fn offer_code(&mut self, kept: Vec<KeptCode>) {
        for kept in kept {
            let text = format!(
                "Unsaved text of {} was kept {}. Continue opens it in the panel Code; until then it stays kept.",
                kept.path.shown(),
                kept.when
            );
            let command = CodeCommand::Recover(kept.path.clone());
            self.code.kept.push(kept);
            self.note(Note::new(Severity::Warning, text).offering("Continue", super::Action::Code(command)));
        }
    }
}

impl OpenCode {
    /// Takes in the present text of the subject. Unsaved changes stay; the user decides about them.
    pub(in crate::panel) fn found(&mut self, now: Arc<str>) {
        if now == self.base {
            self.theirs = None;
        } else if now == self.text {
            (self.base, self.theirs) = (now, None);
        } else if self.text == self.base {
            (self.text, self.base, self.theirs) = (now.clone(), now, None);
        } else {
            self.theirs = Some(Theirs::Changed(now));
        }
        self.shows_difference &= self.theirs.is_some();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::panel::state::Action;

    fn command(session: &mut Session, command: CodeCommand) -> Vec<Effect> {
        session.apply(Action::Code(command), &Registry::builtin())
    }

    fn typed(session: &mut Session, text: &str) {
        let number = of(session).number;
        assert_eq!(command(session, CodeCommand::Type(number, text.into())), []);
    }

    fn open() -> Session {
        let mut session = Session::default();
        session.code.add(CodeOf::File("models/a.wgsl".into()), "a.wgsl".to_owned(), "one\r\ntwo\r\n", 1);
        session
    }

    fn of(session: &Session) -> &OpenCode {
        session.code.visible().expect("one is open")
    }

    #[test]
    fn a_text_that_is_open_is_shown_as_it_was_left_unless_a_line_is_asked_for() {
        let mut session = open();
        let number = of(&session).number;
        assert_eq!(session.code.goto, Some((number, 1)), "a new one is shown from its start");
        for line in [0, 2] {
            command(&mut session, CodeCommand::Arrived);
            assert_eq!(command(&mut session, CodeCommand::File("models/a.wgsl".into(), line)), []);
            assert_eq!(session.code.goto, Some((number, line)));
        }
        session.code.add(CodeOf::File("b".into()), "b".to_owned(), "", 0);
        assert_eq!(session.code.goto, Some((number + 1, 1)));
    }

    #[test]
    fn line_ends_of_a_file_stay_as_they_were() {
        let mut session = open();
        assert_eq!(&*of(&session).text, "one\ntwo\n");
        typed(&mut session, "one\ntwo\nthree\n");
        assert_eq!(of(&session).written(), "one\r\ntwo\r\nthree\r\n");
        let mut unix = Session::default();
        unix.code.add(CodeOf::File("b".into()), "b".to_owned(), "one\n", 1);
        assert_eq!(of(&unix).written(), "one\n");
    }

    #[test]
    fn a_change_on_one_side_is_taken_and_one_on_both_waits_for_the_user() {
        let theirs: Arc<str> = "one\nTHEIRS\n".into();
        // Only on disk.
        let mut session = open();
        session.code.open[0].found(theirs.clone());
        assert_eq!((&of(&session).text, of(&session).is_unsaved()), (&theirs, false));
        // On both sides: nothing is written before the user has decided.
        for (choice, kept, base) in [
            (CodeCommand::KeepMine, "one\nmine\n", "one\nTHEIRS\n"),
            (CodeCommand::TakeTheirs, "one\nTHEIRS\n", "one\nTHEIRS\n"),
        ] {
            let mut session = open();
            typed(&mut session, "one\nmine\n");
            session.code.open[0].found(theirs.clone());
            assert_eq!(of(&session).theirs, Some(Theirs::Changed(theirs.clone())));
            assert_eq!(&*of(&session).text, "one\nmine\n");
            assert_eq!(command(&mut session, CodeCommand::Save), [], "nothing is written");
            assert!(command(&mut session, CodeCommand::Difference(true)).is_empty());
            assert!(of(&session).shows_difference);
            command(&mut session, choice);
            let now = of(&session);
            assert_eq!((&*now.text, &*now.base, &now.theirs), (kept, base, &None));
            assert!(!now.shows_difference);
            assert_eq!(now.is_unsaved(), kept != base);
        }
        // Both made the same change.
        let mut session = open();
        typed(&mut session, "one\nTHEIRS\n");
        session.code.open[0].found(theirs);
        assert!(!of(&session).is_unsaved() && of(&session).theirs.is_none());
    }

    #[test]
    fn after_a_choice_about_a_conflict_the_focus_goes_back_to_the_text() {
        for choice in [
            CodeCommand::KeepMine,
            CodeCommand::TakeTheirs,
            CodeCommand::Stay,
            CodeCommand::Difference(false),
        ] {
            let mut session = open();
            command(&mut session, CodeCommand::Arrived);
            session.code.open[0].theirs = Some(Theirs::Unreadable("it is no text".to_owned()));
            command(&mut session, choice);
            assert_eq!(session.code.goto, Some((of(&session).number, 0)));
        }
    }

    #[test]
    fn what_would_lose_changes_of_texts_asks_first() {
        use crate::panel::state::{Answer, Question};
        let registry = Registry::builtin();
        let mut session = open();
        assert_eq!(session.apply(Action::Quit, &registry), [Effect::Quit], "without changes it does not");
        typed(&mut session, "mine");
        // A file of a shader does not belong to the scene.
        session.apply(Action::New, &registry);
        assert_eq!(session.questions.open, None);
        let asked = Some(Question::UnsavedTexts(Box::new(Action::Quit)));
        for (answer, quits, text) in [
            (Answer::Cancel, false, "mine"),
            (Answer::Keep, false, "mine"),
            (Answer::Discard, true, "one\ntwo\n"),
        ] {
            assert_eq!(session.apply(Action::Quit, &registry), []);
            assert!(session.questions.open == asked && session.questions.is_quitting());
            let effects = session.apply(Action::Answer(answer), &registry);
            assert_eq!((effects == [Effect::Quit], &*of(&session).text), (quits, text), "{answer:?}");
        }
    }

    #[test]
    fn another_scene_asks_about_changes_of_the_json_of_this_one() {
        use crate::panel::state::{Answer, Question};
        let registry = Registry::builtin();
        let mut session = Session::default();
        command(&mut session, CodeCommand::Scene);
        typed(&mut session, "{");
        session.apply(Action::New, &registry);
        assert_eq!(session.questions.open, Some(Question::UnsavedTexts(Box::new(Action::New))));
        session.apply(Action::Answer(Answer::Cancel), &registry);
        assert_eq!(&*of(&session).text, "{");
        session.apply(Action::New, &registry);
        session.apply(Action::Answer(Answer::Discard), &registry);
        assert!(session.questions.open.is_none() && !of(&session).is_unsaved());
    }

    #[test]
    fn the_json_of_a_scene_that_an_earlier_window_left_is_continued() {
        let mut session = Session::default();
        let kept = KeptCode { path: OF_SCENE.into(), text: "{".into(), when: "5 minutes ago".to_owned() };
        session.offer_code(vec![kept]);
        assert!(session.messages.last().is_some_and(|note| note.text.contains(OF_SCENE)));
        assert_eq!(command(&mut session, CodeCommand::Recover(OF_SCENE.into())), []);
        assert_eq!((&of(&session).of, &*of(&session).text), (&CodeOf::Scene, "{"));
        assert!(of(&session).is_unsaved());
    }

    #[test]
    fn the_text_of_an_earlier_window_takes_the_place_of_a_newer_one_as_a_step_that_can_be_undone() {
        let kept = || KeptCode {
            path: "models/a.wgsl".into(),
            text: "kept".into(),
            when: "5 minutes ago".to_owned(),
        };
        let offers = |session: &Session| session.messages.iter().filter(|note| note.offer.is_some()).count();
        let mut session = open();
        typed(&mut session, "newer");
        command(&mut session, CodeCommand::Arrived);
        session.offer_code(vec![kept()]);
        assert_eq!(offers(&session), 1);
        let number = of(&session).number;
        assert_eq!(command(&mut session, CodeCommand::Recover("models/a.wgsl".into())), []);
        assert_eq!((&*of(&session).text, of(&session).replaced.as_deref()), ("kept", Some("newer")));
        assert_eq!(session.code.goto, Some((number, 1)), "the focus goes there");
        assert!(session.messages.last().is_some_and(|note| note.text.contains("Ctrl+Z there brings back")));
        assert_eq!(offers(&session), 0);
        command(&mut session, CodeCommand::Arrived);
        assert_eq!(of(&session).replaced, None);
        // The text is what was kept: there is nothing to bring back, and no need for the copy.
        session.offer_code(vec![kept()]);
        command(&mut session, CodeCommand::Recover("models/a.wgsl".into()));
        assert_eq!((of(&session).replaced.clone(), session.code.outdated.len()), (None, 1));
        assert!(session.messages.last().is_some_and(|note| note.text.starts_with("Nothing to continue")));
    }

    #[test]
    fn a_text_with_changes_is_closed_only_by_a_word_of_the_user() {
        let mut session = open();
        typed(&mut session, "mine");
        command(&mut session, CodeCommand::Close);
        assert!(of(&session).closing);
        command(&mut session, CodeCommand::Stay);
        assert!(!of(&session).closing && session.has_unsaved_code());
        command(&mut session, CodeCommand::Close);
        command(&mut session, CodeCommand::Discard);
        assert!(session.code.open.is_empty() && !session.has_unsaved_code());
        // Without changes there is nothing to ask.
        let mut session = open();
        command(&mut session, CodeCommand::Close);
        assert!(session.code.open.is_empty());
    }
}
