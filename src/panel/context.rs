//! A panel and its connection to the rest of the window.

use bevy::{
    app::App,
    ecs::{resource::Resource, world::World},
};
use bevy_egui::egui::{Rect, Response, Ui};

use super::{
    state::{Action, Over, PanelInfo, PictureArea, Place, Session, Severity},
    theme::Palette,
};
use crate::{
    caught::{catch, message},
    document::{Document, Edit},
    registry::Registry,
};

/// A part of the window. It may keep state of its own, reads everything else through the [`PanelContext`], and changes
/// it by actions and commands, which take effect when all panels have been shown.
pub trait Panel: Send + Sync + 'static {
    /// A name that no other panel has.
    fn id(&self) -> &'static str;
    /// The name for people.
    fn title(&self) -> &'static str;
    /// The place.
    fn place(&self) -> Place;
    /// False while there is nothing to show. A panel that is open over the rest hides the tooltips below it, or takes
    /// the input: see [`Over`].
    fn is_open(&self, _session: &Session) -> bool {
        true
    }
    /// A note on its tab beside the title, such as the number of errors.
    fn note(&self, _session: &Session) -> Option<(Severity, String)> {
        None
    }
    /// Shows it.
    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>);
}

/// A panel of the window itself: see [`register_builtin`](super::register_builtin).
pub(super) struct Own {
    names: [&'static str; 2],
    place: Place,
    is_open: fn(&Session) -> bool,
    note: fn(&Session) -> Option<(Severity, String)>,
    show: Box<dyn FnMut(&mut Ui, &mut PanelContext<'_>) + Send + Sync>,
}

impl Own {
    /// A panel by its id and its title that is always open.
    pub(super) fn new(
        names: [&'static str; 2],
        place: Place,
        show: impl FnMut(&mut Ui, &mut PanelContext<'_>) + Send + Sync + 'static,
    ) -> Self {
        Self { names, place, is_open: |_| true, note: |_| None, show: Box::new(show) }
    }

    /// Makes the panel open only while a condition holds.
    pub(super) fn open_if(self, is_open: fn(&Session) -> bool) -> Self {
        Self { is_open, ..self }
    }

    /// Adds a note beside the title.
    pub(super) fn noted(self, note: fn(&Session) -> Option<(Severity, String)>) -> Self {
        Self { note, ..self }
    }
}

impl Panel for Own {
    fn id(&self) -> &'static str {
        self.names[0]
    }

    fn title(&self) -> &'static str {
        self.names[1]
    }

    fn place(&self) -> Place {
        self.place
    }

    fn is_open(&self, session: &Session) -> bool {
        (self.is_open)(session)
    }

    fn note(&self, session: &Session) -> Option<(Severity, String)> {
        (self.note)(session)
    }

    fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        (self.show)(ui, context);
    }
}

/// A change of the world that waits until all panels have been shown.
type Command = Box<dyn FnOnce(&mut World) + Send + Sync>;

/// The window as a panel sees it, and the panel's way to change it.
pub struct PanelContext<'a> {
    session: &'a Session,
    registry: &'a Registry,
    world: &'a World,
    area: &'a PictureArea,
    /// The area of the picture in this frame, as far as it is known, and the places that can be clicked over it.
    pub(super) picture: (PictureArea, Vec<Rect>),
    pub(super) actions: Vec<Action>,
    queue: Vec<Command>,
}

impl<'a> PanelContext<'a> {
    pub(super) fn new(
        session: &'a Session,
        registry: &'a Registry,
        world: &'a World,
        area: &'a PictureArea,
    ) -> Self {
        let (picture, actions, queue) = Default::default();
        Self { session, registry, world, area, picture, actions, queue }
    }

    /// The area of the picture in the previous frame.
    pub(super) fn area(&self) -> &'a PictureArea {
        self.area
    }

    /// The state of the window: the selection, the display, the messages.
    #[must_use]
    pub fn session(&self) -> &'a Session {
        self.session
    }

    /// The scene, with its history.
    #[must_use]
    pub fn document(&self) -> &'a Document {
        &self.session.document
    }

    /// Everything that is known by id.
    #[must_use]
    pub fn registry(&self) -> &'a Registry {
        self.registry
    }

    /// The world of the app, to be read. [`Session`], [`Registry`] and [`Panels`] are not in it while panels are shown:
    /// the first two are [here](Self::session).
    ///
    /// Panels are shown in `PostUpdate`, so systems of `Update` and of [`LabFrame`](crate::render::schedule::LabFrame)
    /// have run in this frame. [`World::get_resource`] and [`World::try_query`] read without changing anything.
    #[must_use]
    pub fn world(&self) -> &'a World {
        self.world
    }

    /// Performs an action that a user could perform.
    pub fn act(&mut self, action: Action) {
        self.actions.push(action);
    }

    /// Performs an action that a user asks for by a click.
    pub(super) fn on_click(&mut self, widget: &Response, action: impl FnOnce() -> Action) {
        self.actions.extend(widget.clicked().then(action));
    }

    /// Changes the scene, as one step of the history. An edit that breaks a rule of scenes is refused with a message.
    pub fn edit(&mut self, edit: Edit) {
        self.act(Action::Edit(edit));
    }

    /// Makes the edits that there are.
    pub(super) fn edits(&mut self, edits: impl IntoIterator<Item = Edit>) {
        self.actions.extend(edits.into_iter().map(Action::Edit));
    }

    /// Adds a message to those at the bottom of the window.
    pub fn say(&mut self, message: impl Into<String>) {
        self.act(Action::Say(Severity::Info, message.into()));
    }

    /// Adds a message about a problem. [`Action::Say`] has errors, too.
    pub fn warn(&mut self, message: impl Into<String>) {
        self.act(Action::Say(Severity::Warning, message.into()));
    }

    /// Changes the world, once all panels have been shown and their actions are carried out.
    pub fn queue(&mut self, command: impl FnOnce(&mut World) + Send + Sync + 'static) {
        self.queue.push(Box::new(command));
    }

    /// The actions and commands of the panels, and the picture.
    pub(super) fn into_parts(self) -> (Vec<Action>, Vec<Command>, (PictureArea, Vec<Rect>)) {
        (self.actions, self.queue, self.picture)
    }
}

/// The panels of the window.
#[derive(Default, Resource)]
pub struct Panels {
    list: Vec<Listed>,
    /// The commands queued when the panels were last shown.
    queue: Vec<Command>,
}

/// A panel of the list.
pub(super) struct Listed {
    panel: Box<dyn Panel>,
    /// It is not one of the window's own.
    guest: bool,
    /// It may panic.
    guarded: bool,
    /// The message of its panic.
    stopped: Option<String>,
}

impl Listed {
    fn info(&self) -> PanelInfo {
        let panel = &self.panel;
        PanelInfo { id: panel.id(), title: panel.title(), place: panel.place(), guest: self.guest }
    }

    pub(super) fn note(&self, session: &Session) -> Option<(Severity, String)> {
        self.panel.note(session)
    }

    /// Shows the panel. One of others that panics is shown no more, and the window goes on.
    pub(super) fn show(&mut self, ui: &mut Ui, context: &mut PanelContext<'_>) {
        if !self.guarded {
            return self.panel.show(ui, context);
        }
        if let Some(why) = &self.stopped {
            ui.colored_label(Palette::here(ui).error, format!("This panel stopped: {why}"));
            if ui.button("Show it again").clicked() {
                self.stopped = None;
            }
            return;
        }
        let Err(payload) = catch(|| self.panel.show(ui, context)) else { return };
        let why = message(&*payload).to_owned();
        let (title, id) = (self.panel.title(), self.panel.id());
        let text = format!("The panel “{title}” ({id}) crashed: {why}. The window continues without it.");
        context.act(Action::Say(Severity::Error, text));
        self.stopped = Some(why);
    }
}

impl std::fmt::Debug for Panels {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_list().entries(self.list.iter().map(|p| p.panel.id())).finish()
    }
}

impl Panels {
    /// Adds a panel; one with the same id is replaced, and the new one stands in its place. One that panics is shown no
    /// more, and the window goes on.
    pub fn add(&mut self, panel: impl Panel) {
        self.put(Box::new(panel), true);
    }

    /// Adds a panel of the window itself.
    pub(super) fn add_own(&mut self, panel: Own) {
        self.put(Box::new(panel), false);
    }

    fn put(&mut self, panel: Box<dyn Panel>, guest: bool) {
        let new = Listed { panel, guest, guarded: guest, stopped: None };
        match self.list.iter_mut().find(|p| p.panel.id() == new.panel.id()) {
            Some(known) => *known = Listed { guest: known.guest, ..new },
            None => self.list.push(new),
        }
    }

    /// The menu entries of the panels.
    pub fn infos(&self) -> impl Iterator<Item = PanelInfo> {
        self.list.iter().map(Listed::info)
    }

    /// The panels at a place that are not hidden, each with its entry.
    pub(super) fn at(
        &mut self,
        place: Place,
        session: &Session,
    ) -> impl DoubleEndedIterator<Item = (PanelInfo, &mut Listed)> {
        self.list
            .iter_mut()
            .map(|listed| (listed.info(), listed))
            .filter(move |(info, _)| info.place == place && !(info.guest && session.settings.hides(info.id)))
    }

    /// Shows the panels at a place.
    pub(super) fn show(&mut self, ui: &mut Ui, place: Place, context: &mut PanelContext<'_>) {
        self.at(place, context.session()).for_each(|(_, panel)| panel.show(ui, context));
    }

    /// True if an overlay of this kind is open.
    pub(super) fn is_open(&self, over: Over, session: &Session) -> bool {
        let is = |panel: &dyn Panel| panel.place() == Place::Over(over) && panel.is_open(session);
        self.list.iter().any(|listed| is(&*listed.panel))
    }

    /// The id of the topmost dialog or question that is open.
    pub(super) fn asks(&self, session: &Session) -> Option<&'static str> {
        let seen = self.list.iter().filter(|one| !(one.guest && session.settings.hides(one.panel.id())));
        let open = seen.map(|listed| &*listed.panel).filter(|panel| {
            matches!(panel.place(), Place::Over(Over::Dialog | Over::Question)) && panel.is_open(session)
        });
        open.max_by_key(|panel| panel.place()).map(|panel| panel.id())
    }

    pub(super) fn queue(&mut self, commands: Vec<Command>) {
        self.queue.extend(commands);
    }

    /// The commands that the panels queued when they were shown last. [`show_panels`](super::show_panels) carries them
    /// out.
    #[must_use]
    pub fn take_queued(&mut self) -> Vec<impl FnOnce(&mut World) + use<>> {
        std::mem::take(&mut self.queue)
    }
}

/// Adding panels to an app.
pub trait PanelApp {
    /// Adds a panel to the window; one with the same id is replaced.
    fn add_panel(&mut self, panel: impl Panel) -> &mut Self;
}

impl PanelApp for App {
    fn add_panel(&mut self, panel: impl Panel) -> &mut Self {
        self.world_mut().get_resource_or_insert_with(Panels::builtin).add(panel);
        self
    }
}
