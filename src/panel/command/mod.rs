//! The commands of the window, each declared once: id, name, place in the menus, usual keys, tooltip, the reason why it
//! cannot be used now, and its action. Menus, keys, the list of keys (F1), the finder and the table of the documents
//! follow.
//!
//! **To add one**: one line in the file of its menu here, where it shall stand; a command without a place in a menu
//! stands in `elsewhere.rs`.

use std::borrow::Cow;

use super::state::{Action, LessonCommand, Session, Shortcut};
use crate::{declared::texts, registry::Registry, text::quoted};

mod edit;
mod elsewhere;
mod file;
mod help;
mod library;
pub mod own;
pub(super) mod show;
mod view;

/// The menus of the bar, each with its default key.
pub(super) const BAR: [(&str, &str); 4] =
    [("Alt+F", "File"), ("Alt+E", "Edit"), ("Alt+V", "View"), ("Alt+H", "Help")];

/// The id of the finder.
pub(super) const FINDER: &str = "find";

/// The id and the tooltip of the command that opens unsaved text of an earlier window.
pub(super) const CONTINUE: &str = "continue_text";
pub(super) const CONTINUE_TIP: &str =
    "Opens the text in the panel Code; no file is overwritten until you save it there";

/// The menus that others show too, or add to.
pub(super) const EXAMPLES: &str = "Examples";
pub(super) const LESSONS: &str = "Lessons";
pub(super) const LOBE: &str = "Lobe at the explained point";

texts! {
    /// The headings of the list of keys, in its order.
    #[derive(Default, PartialOrd, Ord)]
    Group(
        /// The heading.
        name
    ) {
        /// Documents and pictures.
        File = "File",
        /// Parts of the scene, and the history.
        Edit = "Edit",
        /// Models.
        Reflection = "Reflection and shading",
        /// The picture and the camera's subject.
        #[default]
        Picture = "Picture",
        /// Files of reflection models.
        CustomModels = "Custom models",
        /// Views beside each other.
        Comparison = "Comparison",
        /// Keys that steer the camera; with the focus in a panel they are the panel's.
        Camera = "Camera",
        /// Handles in the picture.
        Handles = "Handles",
        /// The window itself.
        Window = "Window",
        /// Lessons.
        Lessons = "Lessons",
    }
}

/// The form of a menu entry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mark {
    /// Words.
    #[default]
    None,
    /// On or off.
    Check(bool),
    /// One of several, chosen or not.
    Radio(bool),
}

/// A command.
#[derive(Clone, Debug)]
pub struct Command {
    /// The id in the settings, such as `save` or `channel.depth`.
    pub id: Cow<'static, str>,
    /// The name in menus.
    pub name: Cow<'static, str>,
    says: Option<Cow<'static, str>>,
    row: Option<&'static str>,
    /// A sign before the name in menus, for an entry without a mark.
    pub glyph: &'static str,
    /// True if the name comes from another crate, which may use any character.
    pub foreign: bool,
    /// The keys.
    pub keys: Vec<Shortcut>,
    /// Sentences about default keys that cannot be read. The program has none.
    pub unreadable: Vec<String>,
    group: Option<Group>,
    rank: i8,
    /// The tooltip of its menu entry; empty for none.
    pub tip: Cow<'static, str>,
    /// The reason why it cannot be used now.
    pub why_not: Option<Cow<'static, str>>,
    /// The form of its menu entry.
    pub mark: Mark,
    /// The action.
    pub action: Action,
    /// The action of its key, where that is another.
    pub by_key: Option<Action>,
    /// True if its keys work while text is typed, as far as they are no text.
    pub anywhere: bool,
    /// True if it is about panels or marks, which a presentation does not have.
    pub at_desk: bool,
    /// True if it acts while its key is held, so that it can be used by that alone.
    pub held: bool,
    /// True if it is not offered now, though its id is known.
    pub absent: bool,
}

/// Methods that set the field of their name.
macro_rules! with {
    ($($(#[$doc:meta])* $field:ident($($value:ident: $type:ty)?) = $to:expr;)*) => {$(
        $(#[$doc])*
        fn $field(self, $($value: $type)?) -> Self {
            Self { $field: $to, ..self }
        }
    )*};
}

/// A command with a name in menus.
pub(super) fn command(
    id: impl Into<Cow<'static, str>>,
    name: impl Into<Cow<'static, str>>,
    action: Action,
) -> Command {
    Command {
        id: id.into(),
        name: name.into(),
        says: None,
        row: None,
        glyph: "",
        foreign: false,
        keys: Vec::new(),
        unreadable: Vec::new(),
        group: None,
        rank: 0,
        tip: Cow::Borrowed(""),
        why_not: None,
        mark: Mark::None,
        action,
        by_key: None,
        anywhere: false,
        at_desk: false,
        held: false,
        absent: false,
    }
}

impl Command {
    /// The default keys, separated by spaces.
    fn keys(mut self, keys: &str) -> Self {
        for key in keys.split_whitespace() {
            match Shortcut::read(key) {
                Ok(key) => self.keys.push(key),
                Err(why) => self.unreadable.push(format!(
                    "The default key {} of the command {} cannot be read: {why}.",
                    quoted(key),
                    quoted(&self.id)
                )),
            }
        }
        self
    }

    /// It cannot be used now, for this reason.
    fn unless(self, cannot: bool, why: &'static str) -> Self {
        Self { why_not: cannot.then_some(Cow::Borrowed(why)), ..self }
    }

    with! {
        /// The name where no menu is around it.
        says(says: impl Into<Cow<'static, str>>) = Some(says.into());
        /// The name in the list of keys, where the rows around it say the rest.
        row(row: &'static str) = Some(row);
        /// The heading in the list of keys, if not that of its menu.
        group(group: Group) = Some(group);
        /// The place below the heading, where the order is not that of the declarations.
        rank(rank: i8) = rank;
        /// The tooltip of its menu entry.
        tip(tip: impl Into<Cow<'static, str>>) = tip.into();
        /// The form of its menu entry.
        mark(mark: Mark) = mark;
        /// The keys work while text is typed, as far as they are no text.
        anywhere() = true;
        /// A presentation does not have it.
        at_desk() = true;
        /// It is not offered now.
        absent(absent: bool) = absent;
    }

    /// The heading in the list of keys.
    #[must_use]
    pub fn heading(&self) -> Group {
        self.group.unwrap_or_default()
    }

    /// The name in the list of keys; `path` is that of the menu it is in.
    #[must_use]
    pub fn in_list(&self, path: &[&str]) -> String {
        self.row.map_or_else(|| self.title(path), str::to_owned)
    }

    /// The name where no menu is around it; `path` is that of the menu it is in.
    #[must_use]
    pub fn title(&self, path: &[&str]) -> String {
        match (&self.says, path) {
            (Some(says), _) => says.to_string(),
            (None, [_, .., menu]) => format!("{menu}: {}", self.name),
            (None, _) => self.name.to_string(),
        }
    }
}

/// An entry of a menu.
#[derive(Clone, Debug)]
pub enum Item {
    /// A command.
    Command(Box<Command>),
    /// A menu that hangs there.
    Menu(Menu),
    /// A line between entries.
    Line,
}

/// A menu.
#[derive(Clone, Debug, Default)]
pub struct Menu {
    /// The name.
    pub name: &'static str,
    /// The name with what is chosen in it, if that is said.
    pub shown: Option<String>,
    /// The entries.
    pub items: Vec<Item>,
    group: Option<Group>,
    width: f32,
    scrolls: bool,
    stays: bool,
    empty: &'static str,
}

impl Menu {
    fn new(name: &'static str) -> Self {
        Self { name, ..Self::default() }
    }

    with! {
        /// The heading of its commands in the list of keys.
        group(group: Group) = Some(group);
        /// A width that depends on nothing, points.
        width(width: f32) = width;
        /// Scrolls if it does not fit the window.
        scrolls() = true;
        /// Enter leaves it open, so that choices can be tried.
        stays() = true;
        /// The text in place of its entries if it has none.
        empty(empty: &'static str) = empty;
    }

    /// The commands and those of the menus in it, each with the names of the menus it is in.
    #[must_use]
    pub fn commands(&self) -> Vec<(Vec<&'static str>, &Command)> {
        let mut all = Vec::new();
        for item in &self.items {
            match item {
                Item::Command(command) => all.push((Vec::new(), &**command)),
                Item::Line => {}
                Item::Menu(menu) => all.extend(menu.commands().into_iter().map(|(mut path, command)| {
                    path.insert(0, menu.name);
                    (path, command)
                })),
            }
        }
        all
    }

    /// A menu in it, however deep.
    #[must_use]
    pub fn find(&self, name: &str) -> Option<&Self> {
        let menus = || {
            self.items.iter().filter_map(|item| if let Item::Menu(menu) = item { Some(menu) } else { None })
        };
        menus().find(|menu| menu.name == name).or_else(|| menus().find_map(|menu| menu.find(name)))
    }

    fn for_each(&mut self, change: &mut impl FnMut(&mut Command)) {
        for item in &mut self.items {
            match item {
                Item::Command(command) => change(command),
                Item::Menu(menu) => menu.for_each(change),
                Item::Line => {}
            }
        }
    }
}

/// The state that declarations may read, and the list they are added to.
struct List<'a> {
    session: &'a Session,
    registry: &'a Registry,
    /// The pinned point can be looked at from the side.
    has_sides: bool,
    now: Menu,
}

impl List<'_> {
    fn add(&mut self, command: Command) {
        let group = command.group.or(self.now.group);
        self.now.items.push(Item::Command(Box::new(Command { group, ..command })));
    }

    fn line(&mut self) {
        self.now.items.push(Item::Line);
    }

    fn menu(&mut self, menu: Menu, fill: impl FnOnce(&mut Self)) {
        let group = menu.group.or(self.now.group);
        let outer = std::mem::replace(&mut self.now, Menu { group, ..menu });
        fill(self);
        let inner = std::mem::replace(&mut self.now, outer);
        self.now.items.push(Item::Menu(inner));
    }
}

/// All commands as they are now, with the menus of the bar. `has_sides` says that the pinned point can be looked at from
/// the side.
#[must_use]
pub fn all(session: &Session, registry: &Registry, has_sides: bool) -> Menu {
    let library = session.view.finder_open || session.keys.begin_with(&library::KINDS);
    let mut root = declared(session, registry, has_sides, library);
    root.for_each(&mut |command| {
        if let Some(own) = session.keys.of(&command.id) {
            command.keys = own.to_vec();
        }
    });
    if session.view.presenting && session.lesson.is_some() {
        turn_pages(&mut root);
    }
    root
}

/// All commands with their default keys; scenes, lessons and models only if they are asked for.
#[must_use]
pub fn declared(session: &Session, registry: &Registry, has_sides: bool, library: bool) -> Menu {
    let mut list = List { session, registry, has_sides, now: Menu::default() };
    elsewhere::elsewhere(&mut list);
    file::file(&mut list);
    edit::edit(&mut list);
    view::view_menu(&mut list);
    help::help(&mut list);
    if library {
        library::library(&mut list);
    }
    list.now
}

/// Remote controls of lecturers send Page Up and Page Down: in a presentation they turn the pages of the lesson.
fn turn_pages(root: &mut Menu) {
    let pages = ["PageUp", "PageDown"].map(Shortcut::read);
    let is_page = |shortcut: &Shortcut| pages.iter().any(|page| page.as_ref() == Ok(shortcut));
    root.for_each(&mut |command| {
        command.keys.retain(|shortcut| !is_page(shortcut));
        let page = match command.action {
            Action::Lesson(LessonCommand::Previous) => &pages[0],
            Action::Lesson(LessonCommand::Next) => &pages[1],
            _ => return,
        };
        command.keys.extend(page.as_ref().ok().copied());
    });
}

/// The commands that have keys, in the order of the list of keys.
#[must_use]
pub fn with_keys(root: &Menu) -> Vec<(Vec<&'static str>, &Command)> {
    let mut all = root.commands();
    all.retain(|(_, command)| !command.absent && !command.keys.is_empty());
    all.sort_by_key(|(_, command)| (command.heading(), command.rank));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        lesson,
        panel::{Panels, Place},
    };

    #[test]
    fn lessons_point_at_the_menus_of_the_bar_and_at_tabs_of_the_strip() {
        assert_eq!(BAR.map(|(_, name)| name), lesson::MENUS);
        let panels = Panels::builtin();
        let tabs: Vec<_> =
            panels.infos().filter(|panel| panel.place == Place::Bottom).map(|panel| panel.id).collect();
        for tab in lesson::TABS {
            assert!(tabs.contains(tab), "{tab} is not one of {tabs:?}");
        }
    }

    #[test]
    fn the_list_of_keys_follows_headings_then_ranks_then_declarations() {
        let (session, registry) = (Session::default(), Registry::builtin());
        let root = declared(&session, &registry, true, false);
        let all = root.commands();
        let order = |(_, command): &(Vec<&str>, &Command)| {
            let at = all.iter().position(|(_, other)| other.id == command.id);
            (command.heading(), command.rank, at)
        };
        let listed: Vec<_> = with_keys(&root).iter().map(order).collect();
        assert!(listed.len() > 60 && listed.is_sorted(), "{listed:?}");
    }

    #[test]
    fn a_default_key_that_cannot_be_read_is_reported_and_the_others_stay() {
        let command = command("save", "Save", Action::Save).keys("Strg+S F4");
        assert_eq!(command.keys, [Shortcut::read("F4").expect("a key")]);
        let why = "The default key \"Strg+S\" of the command \"save\" cannot be read: \"Strg\" is not a modifier; use \
                   Ctrl, Shift or Alt.";
        assert_eq!(command.unreadable, [why]);
    }
}
