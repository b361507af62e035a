//! Texts for the clipboard, and what is said about them.

use super::{Action, Effect, Note, Session, Severity};
use crate::{platform, registry::Registry};

impl Session {
    pub(super) fn carry_away(&mut self, action: Action, registry: &Registry) {
        match action {
            Action::Copy(text, said) => self.copy(text, Note::new(Severity::Info, said)),
            Action::CopyLink(to) => self.copy_link(to, registry),
            _ => {}
        }
    }

    /// Copies a text, and says so once it is on the clipboard.
    pub(super) fn copy(&mut self, text: String, note: Note) {
        self.copy_and_say(text, note, platform::COPIES_AT_ONCE);
    }

    fn copy_and_say(&mut self, text: String, note: Note, at_once: bool) {
        self.request(Effect::CopyText(text.clone()));
        if at_once {
            self.note(note);
        } else {
            self.copying.push((text, note));
        }
    }

    /// Says of a text that is on the clipboard what there is to say.
    pub fn copied(&mut self, text: &str) {
        if let Some(note) = self.awaited(text) {
            self.note(note);
        }
    }

    /// Says why a text was not copied.
    pub fn not_copied(&mut self, text: &str, why: &str) {
        self.awaited(text);
        self.say(Severity::Warning, format!("Nothing was copied: {why}."));
    }

    /// What is to be said once a text is on the clipboard: nothing of what the user copies from a field.
    fn awaited(&mut self, text: &str) -> Option<Note> {
        let place = self.copying.iter().position(|(copied, _)| copied == text)?;
        Some(self.copying.remove(place).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(session: &Session) -> Vec<&str> {
        session.messages.iter().map(|note| &*note.text).collect()
    }

    #[test]
    fn what_is_copied_is_said_once_it_is_on_the_clipboard() {
        let mut session = Session::default();
        let note = |text: &str| Note::new(Severity::Info, text);
        session.copy_and_say("a".to_owned(), note("Copied a."), true);
        assert_eq!(texts(&session), ["Copied a."]);
        for (text, said) in [("b", "Copied b."), ("c", "Copied c.")] {
            session.copy_and_say(text.to_owned(), note(said), false);
        }
        assert_eq!(texts(&session), ["Copied a."], "not yet");
        session.copied("c");
        session.copied("of a field");
        session.not_copied("b", "the page is not in front");
        assert_eq!(
            texts(&session),
            ["Copied a.", "Copied c.", "Nothing was copied: the page is not in front."]
        );
        session.copied("b");
        assert_eq!(session.messages.len(), 3, "each is said once");
    }
}
