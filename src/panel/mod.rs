//! The panels around the picture, in egui.
//!
//! A panel reads the state of the window and returns actions ([`Panel`]); [`show`] lays out the panels, applies their
//! actions to the [`Session`] and returns the effects that need files, entities or the operating system. No window is
//! needed for any of this.
//!
//! **To add one**: write `panel/x.rs` and add a line to [`register_builtin`]; a panel at the bottom automatically
//! gets a tab and a menu entry. From outside the crate: [`PanelApp::add_panel`].

use std::{
    mem::swap,
    ops::{Deref, DerefMut},
};

use bevy::{
    app::{App, Plugin},
    ecs::{
        change_detection::DetectChangesMut,
        message::Messages as Queue,
        query::{QueryState, With},
        system::Local,
        world::World,
    },
};
use bevy_egui::{
    EguiContext, EguiPrimaryContextPass, PrimaryEguiContext,
    egui::{Id, LayerId, Ui, UiBuilder},
};

use crate::registry::Registry;
use context::Own;
pub use context::{Panel, PanelApp, PanelContext, Panels};
use cover::is_in_sight;
pub use cover::is_over_picture;
pub use dialogs::Dialogs;
pub use frame::show;
use state::{
    CODE_TAB, EXPLAIN_TAB, Effect, MATERIALS_TAB, MESSAGES_TAB, PLOTS_TAB, PictureArea, SHADER_TAB, Session,
};
pub use state::{Over, PanelInfo, Place, follow};

pub mod author;
mod band;
pub mod caption;
pub mod channels;
pub mod chooser;
pub mod clipping;
pub mod code;
pub mod command;
pub mod compare;
mod context;
mod cover;
pub mod dialogs;
mod draft;
pub mod effects;
pub mod explain;
pub mod export;
pub mod files;
mod finder;
mod fits;
mod focus;
pub mod formula;
mod frame;
mod gallery;
mod glyphs;
mod handles;
pub mod help;
pub mod history;
pub mod icon;
pub mod inspector;
mod kept;
pub mod keys;
pub mod knob;
mod labels;
pub mod laws;
pub mod lesson;
mod linked;
pub mod manual;
pub mod marks;
mod matching;
mod materials;
pub mod maths;
mod menu;
pub mod messages;
mod modal;
pub mod model_override;
mod narrow;
mod notice;
pub mod picture;
mod placer;
pub mod plots;
mod prelude;
pub mod presentation;
pub mod preview;
pub mod progress;
pub mod question;
mod rank;
pub mod reload;
mod resting;
pub mod segmented;
pub mod settings;
pub mod shader;
mod shares;
mod sheet;
mod sides;
pub mod state;
pub mod status;
mod taking;
pub mod theme;
mod together;
pub mod top;
pub mod tree;
pub mod typeset;
pub mod welcome;
mod widths;
pub mod wires;

/// Registers the built-in panels, in layout order. This is the only list.
pub fn register_builtin(to: &mut Panels) {
    let [list, window, dialog, question] =
        [Over::List, Over::Window, Over::Dialog, Over::Question].map(Place::Over);
    let mut plots = plots::PlotPanel::default();
    let plots = move |ui: &mut Ui, context: &mut PanelContext<'_>| plots.show(ui, context);
    let mut editor = code::CodePanel::default();
    let code = move |ui: &mut Ui, context: &mut PanelContext<'_>| editor.show(ui, context);
    let mut shelf = materials::MaterialPanel::default();
    let shelf = move |ui: &mut Ui, context: &mut PanelContext<'_>| shelf.show(ui, context);
    for panel in [
        Own::new(["top", "Top bar"], Place::Top, top::show),
        Own::new(["status", "Status line"], Place::Status, status::show),
        Own::new([MESSAGES_TAB, "Messages"], Place::Bottom, messages::show),
        Own::new([PLOTS_TAB, "Plots"], Place::Bottom, plots),
        Own::new([SHADER_TAB, "Shader"], Place::Bottom, shader::show).noted(shader::note),
        Own::new([CODE_TAB, "Code"], Place::Bottom, code).noted(code::note),
        Own::new([MATERIALS_TAB, "Materials"], Place::Bottom, shelf),
        Own::new([history::HISTORY_TAB, "History"], Place::Bottom, history::show),
        Own::new([EXPLAIN_TAB, "Explain"], Place::Bottom, explain::show),
        Own::new(["lesson", "Lesson"], Place::Left, lesson::show),
        Own::new(["tree", "Scene"], Place::Left, tree::show),
        Own::new(["inspector", "Properties"], Place::Right, inspector::show),
        Own::new(["examples", "Examples"], Place::Strip, welcome::show).open_if(|s| s.view.examples_open),
        Own::new(["picture", "Picture"], Place::Picture, picture::show),
        Own::new(["finder", finder::WORDS.label], list, finder::show).open_if(|s| s.view.finder_open),
        Own::new(["models", "Reflection models"], list, chooser::alone).open_if(|s| s.view.chooser_open),
        Own::new(help::KEYS, window, help::keys_window).open_if(|s| s.view.keys_open),
        Own::new(help::ABOUT, window, help::about_window).open_if(|s| s.view.about_open),
        Own::new([author::DRAFT, author::DRAFT_TITLE], dialog, author::show)
            .open_if(|s| s.authoring.draft.is_some()),
        Own::new([materials::DRAFT, materials::TITLE], dialog, materials::ask)
            .open_if(|s| s.materials.draft.is_some()),
        Own::new([matching::DRAFT, "Match to A"], dialog, matching::show)
            .open_if(|s| s.match_draft.is_some()),
        Own::new(fits::FITS, window, fits::show).open_if(|s| s.fits.is_some()),
        Own::new([taking::DRAFT, taking::TITLE], dialog, taking::show).open_if(|s| s.take_draft.is_some()),
        Own::new(["question", "Question"], question, question::show).open_if(|s| s.questions.open.is_some()),
    ] {
        to.add_own(panel);
    }
}

impl Panels {
    /// The built-in panels.
    #[must_use]
    pub fn builtin() -> Self {
        let mut panels = Self::default();
        register_builtin(&mut panels);
        panels
    }
}

/// Adds the window to the app: the state, the panels, and the system that shows them. Requests for the rest of the app
/// are written as [`Effect`] messages.
#[derive(Clone, Copy, Debug, Default)]
pub struct PanelPlugin;

impl Plugin for PanelPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Session>().init_resource::<PictureArea>();
        app.world_mut().get_resource_or_insert_with(Panels::builtin);
        app.add_message::<Effect>();
        app.add_systems(EguiPrimaryContextPass, show_panels);
    }
}

/// The session, with a flag for changes.
struct Tracked<'a> {
    session: &'a mut Session,
    changed: &'a mut bool,
}

impl Deref for Tracked<'_> {
    type Target = Session;

    fn deref(&self) -> &Session {
        self.session
    }
}

impl DerefMut for Tracked<'_> {
    fn deref_mut(&mut self) -> &mut Session {
        *self.changed = true;
        self.session
    }
}

/// Shows the panels in the primary egui context, if there is one, and runs the commands that they queue. Exclusive, so
/// that panels can read the world.
pub fn show_panels(
    world: &mut World,
    contexts: &mut QueryState<&mut EguiContext, With<PrimaryEguiContext>>,
    mut dialogs: Local<Dialogs>,
    mut out: Local<(Session, Panels)>,
) {
    let Some(mut context) = contexts.iter_mut(world).next() else { return };
    let ctx = context.get_mut().clone();
    let whole = UiBuilder::new().layer_id(LayerId::background()).max_rect(ctx.viewport_rect());
    let mut ui = Ui::new(ctx.clone(), Id::new("lab"), whole);
    let mut area = world.resource::<PictureArea>().clone();
    // Taken out because panels read the world; `resource_scope` would count as a change in every frame.
    let (session, panels) = &mut *out;
    swap(world.resource_mut::<Session>().bypass_change_detection(), session);
    swap(world.resource_mut::<Panels>().bypass_change_detection(), panels);
    let mut changed = false;
    let tracked = Tracked { session, changed: &mut changed };
    let effects =
        show(&mut ui, tracked, &mut area, world.resource::<Registry>(), panels, &mut dialogs, world);
    let commands = panels.take_queued();
    swap(world.resource_mut::<Panels>().bypass_change_detection(), panels);
    swap(world.resource_mut::<Session>().bypass_change_detection(), session);
    if changed {
        world.resource_mut::<Session>().set_changed();
    }
    world.resource_mut::<Queue<Effect>>().write_batch(effects);
    world.resource_mut::<PictureArea>().set_if_neq(area);
    for command in commands {
        command(world);
    }
}
