//! The user's own document while a lesson shows other scenes: it is set aside and restored unchanged.

use std::{
    mem::swap,
    path::{Path, PathBuf},
};

use super::{Desk, Pin, Session, View};
use crate::{
    channel::DebugChannel,
    document::{Document, Selection},
    files::printable,
    optics::TermSelection,
    scene::variant::MAX_VARIANTS,
};

/// View settings that belong to the shown document rather than to the user.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DocumentView {
    terms: TermSelection,
    channels: [Option<DebugChannel>; MAX_VARIANTS + 1],
    active: usize,
    pinned: Option<Pin>,
    pin_number: u64,
    show_markers: bool,
    bottom_open: bool,
    bottom_tab: String,
}

impl DocumentView {
    pub(super) fn of(view: &View) -> Self {
        let View {
            terms, channels, active, pinned, pin_number, show_markers, bottom_open, bottom_tab, ..
        } = view.clone();
        Self { terms, channels, active, pinned, pin_number, show_markers, bottom_open, bottom_tab }
    }

    pub(super) fn put(self, view: &mut View) {
        view.terms = self.terms;
        view.channels = self.channels;
        view.active = self.active;
        (view.pinned, view.pin_number) = (self.pinned, self.pin_number);
        view.show_markers = self.show_markers;
        view.bottom_open = self.bottom_open;
        view.bottom_tab = self.bottom_tab;
        view.blinking = false;
    }
}

/// A document that is set aside, with everything that belongs to it.
#[derive(Clone, Debug)]
pub struct Aside {
    document: Document,
    path: Option<PathBuf>,
    selection: Selection,
    desk: Desk,
    shown: DocumentView,
    left_open: bool,
    examples_open: bool,
}

impl Aside {
    /// An unchanged document without a file, to be exchanged with the user's own.
    pub(super) fn around(document: Document, session: &Session) -> Self {
        let mut view = View { show_markers: session.view.show_markers, ..View::default() };
        (view.bottom_open, view.bottom_tab) = (false, session.view.bottom_tab.clone());
        Self {
            document,
            path: None,
            selection: Selection::Room,
            desk: Desk { model_slots: session.model_slots.clone(), ..Desk::default() },
            shown: DocumentView::of(&view),
            left_open: true,
            examples_open: false,
        }
    }

    /// The view settings with which a lesson begins, where these are the user's own.
    pub(super) fn beginning(&self) -> DocumentView {
        DocumentView { show_markers: self.shown.show_markers, ..DocumentView::of(&View::default()) }
    }
}

impl Session {
    /// Exchanges the current document with the one set aside.
    pub(super) fn exchange(&mut self, aside: &mut Aside) {
        self.document.end_gesture();
        swap(&mut self.document, &mut aside.document);
        swap(&mut self.path, &mut aside.path);
        swap(&mut self.selection, &mut aside.selection);
        swap(&mut self.desk, &mut aside.desk);
        swap(&mut self.view.left_open, &mut aside.left_open);
        swap(&mut self.view.examples_open, &mut aside.examples_open);
        let shown = std::mem::replace(&mut aside.shown, DocumentView::of(&self.view));
        shown.put(&mut self.view);
        (self.renaming, self.match_draft, self.take_draft) = (None, None, None);
        self.messages.another_document();
    }

    /// The user's own document with what belongs to it, even while a lesson is open.
    fn own(&self) -> (&Document, &Desk) {
        match &self.lesson {
            Some(lesson) => (&lesson.aside.document, &lesson.aside.desk),
            None => (&self.document, &self.desk),
        }
    }

    /// The user's own document, even while a lesson is open.
    #[must_use]
    pub fn own_document(&self) -> &Document {
        self.own().0
    }

    /// File of the user's own document.
    #[must_use]
    pub fn own_path(&self) -> Option<&Path> {
        self.lesson.as_ref().map_or(self.path.as_deref(), |lesson| lesson.aside.path.as_deref())
    }

    /// Title of the user's own document: name of the scene, otherwise of the file.
    #[must_use]
    pub fn own_title(&self) -> String {
        let (document, path) = (self.own_document(), self.own_path());
        let file = || Some(printable(&path?.file_stem()?.to_string_lossy()).into_owned());
        document.name.clone().or_else(file).unwrap_or_else(|| "Untitled scene".to_owned())
    }

    /// Records that no file contains the user's own document.
    pub(super) fn lose_own_file(&mut self) {
        match &mut self.lesson {
            Some(lesson) => lesson.aside.desk.disk.lost = true,
            None => self.desk.disk.lost = true,
        }
    }

    /// True if the user's own document differs from its file.
    #[must_use]
    pub fn is_dirty(&self) -> bool {
        let (document, desk) = self.own();
        desk.disk.lacks_document() || document.differs()
    }

    /// True if the user's own document is shown and differs from its file. Changes to a scene of a lesson do not count.
    #[must_use]
    pub fn shows_unsaved(&self) -> bool {
        self.lesson.is_none() && self.is_dirty()
    }
}
