//! Files of the editor: reading, writing, and changes by other programs.

use std::{
    io,
    path::{Path, PathBuf},
    sync::Arc,
};

use crate::{
    custom::file,
    files::{self, FileError, Shown as _},
    panel::state::{CODE_TAB, CodeOf, MOST_CODE, OpenCode, Session, Severity, Theirs},
    shader::check::ShaderProblem,
};

/// Opens the file of a new model in the panel *Code*, if that is in sight or has room. True if it does.
pub fn open_new(session: &mut Session, path: &Path) -> bool {
    let view = &session.view;
    let in_sight = view.bottom_open && view.bottom_tab == CODE_TAB;
    if view.presenting || view.narrow && !in_sight {
        return false;
    }
    session.view.unfold(CODE_TAB);
    if !session.code.show(&CodeOf::File(path.to_owned()), 1) {
        open(session, path.to_owned(), 1);
    }
    true
}

/// The text of a file, or why it cannot be edited.
enum Read {
    Text(String),
    Gone,
    Not(String),
}

/// Reads a file of at most [`MOST_CODE`] bytes.
fn read(path: &Path) -> Read {
    let limit = || {
        format!(
            "it is larger than {} KiB, the most that the editor holds; use an editor of your own (Ctrl+E)",
            MOST_CODE >> 10
        )
    };
    match files::kind(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Read::Gone,
        _ => {}
    }
    match file::read(path, &name(path)) {
        Ok(text) if text.len() > MOST_CODE => Read::Not(limit()),
        Ok(text) => Read::Text(text),
        Err(ShaderProblem { line, column, message, source, .. }) if !source.is_empty() => {
            Read::Not(format!("line {line}, column {column}: {message}"))
        }
        Err(problem) => Read::Not(problem.message),
    }
}

/// The name of a file on its tab.
fn name(path: &Path) -> String {
    files::printable(&path.file_name().unwrap_or(path.as_os_str()).to_string_lossy()).into_owned()
}

/// Opens a file at a line.
pub(in crate::panel) fn open(session: &mut Session, path: PathBuf, line: usize) {
    match read(&path) {
        Read::Text(text) => {
            let tab = name(&path);
            session.code.add(CodeOf::File(path), tab, &text, line);
        }
        Read::Gone => {
            session.say(Severity::Error, format!("{} was not opened: there is no such file.", path.shown()));
        }
        Read::Not(why) => {
            session.say(Severity::Error, format!("{} was not opened: {why}.", path.shown()));
        }
    }
}

/// Opens a file with the unsaved text of an earlier window.
pub(in crate::panel) fn recover(session: &mut Session, path: PathBuf, text: Arc<str>) {
    let of = CodeOf::File(path.clone());
    let before = match read(&path) {
        Read::Text(before) => before,
        Read::Gone | Read::Not(_) => String::new(),
    };
    session.code.add(of.clone(), name(&path), &before, 1);
    session.continue_with(&of, text);
    look(session, &path);
}

/// Takes in the present version of a file that may have changed.
pub(in crate::panel) fn look(session: &mut Session, path: &Path) {
    let of = CodeOf::File(path.to_owned());
    if let Some(open) = session.code.of_mut(&of) {
        see(open, read(path));
    }
}

fn see(open: &mut OpenCode, now: Read) {
    match now {
        Read::Text(text) => {
            if open.text == open.base && open.theirs.is_none() {
                open.crlf = text.contains("\r\n");
            }
            open.found(text.replace("\r\n", "\n").into());
        }
        Read::Gone => {
            open.theirs = Some(Theirs::Gone);
            open.shows_difference = false;
        }
        Read::Not(why) => {
            open.theirs = Some(Theirs::Unreadable(why));
            open.shows_difference = false;
        }
    }
}

/// Writes an open text to its file, completely or not at all. If the file has changed since it was read, the user is
/// asked instead, unless `overwrite` says that the user has decided.
pub(in crate::panel) fn save(session: &mut Session, path: &Path, overwrite: bool) {
    let of = CodeOf::File(path.to_owned());
    let Some(open) = session.code.of_mut(&of) else { return };
    if !overwrite {
        match read(path) {
            // Deleted: writing it again loses nothing.
            Read::Gone => {}
            now => see(open, now),
        }
        if matches!(open.theirs, Some(Theirs::Changed(_) | Theirs::Unreadable(_))) {
            return;
        }
    }
    let written = files::in_folder(files::folder_of(path), || files::write(path, open.written().as_bytes()));
    match written {
        Ok(()) => {
            (open.base, open.theirs) = (open.text.clone(), None);
            session.healed(path);
            session.outdate_kept(path);
        }
        Err(error) => {
            let why = match error {
                FileError::Io(error) => files::words(&error),
                other => other.to_string(),
            };
            let text = format!("{} was not saved: {why}. The text stays in the editor.", path.shown());
            session.say_about(path, Severity::Error, text);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::{
        panel::state::{Action, CodeCommand, Effect, KeptCode},
        registry::Registry,
    };

    /// A folder with a file, and a window that has it open.
    fn opened(content: &[u8]) -> (tempfile::TempDir, PathBuf, Session) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.wgsl");
        fs::write(&path, content).expect("writable");
        let mut session = Session::default();
        open(&mut session, path.clone(), 1);
        (folder, path, session)
    }

    fn said(session: &Session) -> String {
        session.messages.iter().map(|note| note.text.as_str()).collect::<Vec<_>>().join("\n")
    }

    fn type_text(session: &mut Session, text: &str) {
        let number = session.code.visible().expect("one is open").number;
        session.apply(Action::Code(CodeCommand::Type(number, text.into())), &Registry::builtin());
    }

    /// Saves as the window does.
    fn press_save(session: &mut Session) {
        for effect in session.apply(Action::Code(CodeCommand::Save), &Registry::builtin()) {
            let Effect::SaveCode { path, overwrite } = effect else { panic!("{effect:?}") };
            save(session, &path, overwrite);
        }
    }

    #[test]
    fn what_is_no_text_or_too_large_is_not_opened_and_says_why() {
        for (content, why) in [
            (b"// caf\xe9\n".to_vec(), "line 1, column 7: the byte 0xe9 is not UTF-8"),
            (vec![b' '; 10 << 20], "larger than 1 MiB"),
            (vec![b' '; MOST_CODE + 1], "larger than 256 KiB"),
        ] {
            let (_folder, path, session) = opened(&content);
            assert!(session.code.open.is_empty());
            assert!(said(&session).contains(why), "{}", said(&session));
            assert_eq!(fs::read(&path).expect("still there"), content);
        }
        let (_folder, _, session) = opened(&vec![b' '; MOST_CODE]);
        assert_eq!(session.code.open.len(), 1, "the greatest size");
        let mut session = Session::default();
        open(&mut session, "/nonexistent/a.wgsl".into(), 1);
        assert!(said(&session).contains("there is no such file"), "{}", said(&session));
    }

    #[test]
    fn a_saved_text_is_in_the_file_and_another_programs_change_is_never_overwritten() {
        let (_folder, path, mut session) = opened(b"one\n");
        type_text(&mut session, "mine\n");
        press_save(&mut session);
        assert_eq!(fs::read_to_string(&path).expect("there"), "mine\n");
        assert!(!session.has_unsaved_code());
        // Another program is faster than the watcher.
        fs::write(&path, "theirs\n").expect("writable");
        type_text(&mut session, "mine again\n");
        press_save(&mut session);
        assert_eq!(fs::read_to_string(&path).expect("there"), "theirs\n", "the file stays");
        assert_eq!(&*session.code.open[0].text, "mine again\n", "the text stays");
        session.apply(Action::Code(CodeCommand::KeepMine), &Registry::builtin());
        press_save(&mut session);
        assert_eq!(fs::read_to_string(&path).expect("there"), "mine again\n");
        // Without changes here, the text follows the file.
        fs::write(&path, "theirs too\n").expect("writable");
        look(&mut session, &path);
        assert_eq!(&*session.code.open[0].text, "theirs too\n");
        assert!(!session.has_unsaved_code());
    }

    #[test]
    fn a_file_that_is_deleted_while_open_can_be_saved_again() {
        let (_folder, path, mut session) = opened(b"one\n");
        fs::remove_file(&path).expect("deleted");
        look(&mut session, &path);
        assert_eq!(session.code.open[0].theirs, Some(Theirs::Gone));
        assert!(session.has_unsaved_code(), "the text is only here now");
        press_save(&mut session);
        assert_eq!(fs::read_to_string(&path).expect("there again"), "one\n");
        assert!(!session.has_unsaved_code());
    }

    #[test]
    fn a_file_that_becomes_unreadable_while_open_is_replaced_only_on_request() {
        let (_folder, path, mut session) = opened(b"one\n");
        type_text(&mut session, "mine\n");
        let bad = b"\xff\xff".to_vec();
        fs::write(&path, &bad).expect("writable");
        look(&mut session, &path);
        assert!(
            matches!(&session.code.open[0].theirs, Some(Theirs::Unreadable(why)) if why.contains("UTF-8"))
        );
        press_save(&mut session);
        assert_eq!(fs::read(&path).expect("there"), bad);
        let effects = session.apply(Action::Code(CodeCommand::KeepMine), &Registry::builtin());
        assert_eq!(effects, [Effect::SaveCode { path: path.clone(), overwrite: true }]);
        save(&mut session, &path, true);
        assert_eq!(fs::read_to_string(&path).expect("there"), "mine\n");
    }

    #[test]
    fn a_text_whose_file_can_no_longer_be_read_is_unsaved() {
        for bad in [Some(b"\xff\xff".to_vec()), Some(vec![b' '; 10 << 20]), None] {
            let (_folder, path, mut session) = opened(b"one\n");
            let command = |session: &mut Session, command| {
                assert_eq!(session.apply(Action::Code(command), &Registry::builtin()), []);
            };
            match &bad {
                Some(bad) => fs::write(&path, bad).expect("writable"),
                None => fs::remove_file(&path).expect("deleted"),
            }
            look(&mut session, &path);
            assert!(session.has_unsaved_code());
            assert_eq!(session.names_at_risk(&Action::Quit), ["a.wgsl"]);
            command(&mut session, CodeCommand::Close);
            assert!(session.code.open[0].closing, "the user is asked");
            command(&mut session, CodeCommand::Stay);
            // The file is as it was.
            fs::write(&path, "one\n").expect("writable");
            look(&mut session, &path);
            assert!(!session.has_unsaved_code());
            command(&mut session, CodeCommand::Close);
            assert!(session.code.open.is_empty());
        }
    }

    #[test]
    fn what_cannot_be_written_stays_in_the_editor() {
        let (folder, path, mut session) = opened(b"one\n");
        type_text(&mut session, "mine\n");
        drop(folder);
        fs::write(path.parent().expect("a folder"), "a file in place of the folder").expect("writable");
        save(&mut session, &path, true);
        assert!(said(&session).contains("was not saved"), "{}", said(&session));
        assert_eq!(&*session.code.open[0].text, "mine\n");
        fs::remove_file(path.parent().expect("a folder")).expect("clean");
    }

    #[test]
    fn the_text_of_an_earlier_window_is_no_longer_offered_once_its_file_is_saved() {
        let (_folder, path, mut session) = opened(b"one\n");
        let kept = |path: PathBuf| KeptCode { path, text: "kept".into(), when: "5 minutes ago".to_owned() };
        session.offer_code(vec![kept(path.clone()), kept("/models/other.wgsl".into())]);
        type_text(&mut session, "mine\n");
        let paths = |session: &Session| session.code.kept.iter().map(|k| k.path.clone()).collect::<Vec<_>>();
        assert_eq!(paths(&session).len(), 2);
        press_save(&mut session);
        assert_eq!(paths(&session), [PathBuf::from("/models/other.wgsl")]);
        assert_eq!(session.code.outdated, [path]);
        let offers: Vec<_> = session.messages.iter().filter(|note| note.offer.is_some()).collect();
        assert!(matches!(offers[..], [note] if note.text.contains("other.wgsl")), "{offers:?}");
    }

    #[test]
    fn the_text_of_an_earlier_window_comes_back_as_unsaved() {
        let (_folder, path, _) = opened(b"one\n");
        let mut session = Session::default();
        recover(&mut session, path.clone(), "kept\n".into());
        let open = &session.code.open[0];
        assert_eq!((&*open.text, &*open.base, open.is_unsaved()), ("kept\n", "one\n", true));
        assert_eq!(open.replaced.as_deref(), Some("one\n"));
        assert_eq!(fs::read_to_string(&path).expect("there"), "one\n");
    }
}
