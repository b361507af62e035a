//! The menu of what is shown, and how.

use super::{Command, Group, List, Mark, Menu, command};
use crate::{
    channel::DebugChannel,
    optics::TermSelection,
    panel::{
        fits,
        state::{
            Action, CompareCommand, Effect, HandleChange, HandleMode, Labels, LobeChoice, LobeScale,
            MATERIALS_TAB, MESSAGES_TAB, MatchCommand, PLOTS_TAB, PanelInfo, Place, SHADER_TAB, ThemeChoice,
            ViewChange,
        },
    },
    scene::comparison::Layout,
    text::capitalised,
};

/// A command that changes what is shown.
fn view(id: &'static str, name: &'static str, change: ViewChange) -> Command {
    command(id, name, Action::View(change))
}

/// A command that switches something on or off.
fn switch(id: &'static str, name: &'static str, on: bool, change: ViewChange) -> Command {
    view(id, name, change).mark(Mark::Check(on))
}

/// A command that makes one of several choices, named after it.
fn choice(kind: &str, id: &str, name: &'static str, on: bool, change: ViewChange) -> Command {
    command(format!("{kind}.{id}"), name, Action::View(change)).mark(Mark::Radio(on))
}

pub(super) fn view_menu(to: &mut List) {
    to.menu(Menu::new("View").width(super::show::WIDTH).scrolls(), |to| {
        camera(to);
        terms(to);
        compare(to);
        to.line();
        marks(to);
        handles(to);
        to.menu(Menu::new("Labels of objects"), |to| {
            for labels in Labels::ALL.iter().copied() {
                let on = to.session.view.labels == labels;
                to.add(choice("labels", labels.id(), labels.name(), on, ViewChange::Labels(labels)));
            }
        });
        channels(to);
        to.line();
        panels(to);
        sizes(to);
        let v = &to.session.view;
        let presentation =
            switch("presentation", "Presentation", v.presenting, ViewChange::Presenting(!v.presenting));
        to.add(presentation.says("Presentation; Esc leaves it").keys("F5").group(Group::Window).anywhere());
        let whole = switch("full_screen", "Full screen", v.fullscreen, ViewChange::Fullscreen(!v.fullscreen));
        to.add(whole.keys("F11").group(Group::Window).anywhere());
    });
}

fn camera(to: &mut List) {
    to.add(command("home", "Home: the observer’s view", Action::Do(Effect::HomeView)).keys("H"));
    to.add(command("focus", "Focus selection", Action::Do(Effect::FocusSelection)).keys("C"));
    let side = command("side", "Look from the side", Action::LookFromSide).keys("Shift+H");
    let says = "Look at the pinned point from the side: its vectors N and L face on";
    to.add(side.says(says).unless(!to.has_sides, "No point is pinned"));
    let observer = command("set_observer", "Set observer to this view", Action::Do(Effect::ObserverFromView));
    let problem = to.session.observer_problem();
    to.add(observer.unless(problem.is_some(), problem.unwrap_or_default()));
}

fn terms(to: &mut List) {
    let (offered, now) = (to.session.offered_terms(to.registry), to.session.terms());
    to.menu(Menu::new("Terms of the equation").group(Group::Reflection).stays(), |to| {
        for terms in TermSelection::ALL {
            let name = match terms {
                TermSelection::All => "All terms".to_owned(),
                other => format!("The {} term alone", other.id()),
            };
            let show = command(format!("terms.{}", terms.id()), name, Action::View(ViewChange::Terms(terms)));
            to.add(show.mark(Mark::Radio(now == terms)).absent(!offered.contains(&terms)));
        }
        to.line();
        lobe(to);
    });
}

fn lobe(to: &mut List) {
    let now = to.session.view.lobe;
    to.menu(Menu::new(super::LOBE).group(Group::Picture).stays(), |to| {
        for scale in LobeScale::ALL.iter().copied() {
            let change = ViewChange::Lobe(LobeChoice { scale, ..now });
            let entry = choice("lobe", scale.id(), scale.name(), now.scale == scale, change);
            to.add(entry.tip(scale.summary()));
        }
        to.line();
        for (all, id, name, help) in [
            (false, "one", "For one light", "The lobe for the light whose block is unfolded."),
            (
                true,
                "all",
                "For all lights",
                "A lobe for each light that reaches the point, in a colour of its own.",
            ),
        ] {
            let lights =
                choice("lobe", id, name, now.all == all, ViewChange::Lobe(LobeChoice { all, ..now }));
            to.add(lights.tip(help).unless(now.scale == LobeScale::Off, "No lobe is drawn"));
        }
    });
}

fn compare(to: &mut List) {
    let now = to.session.document.comparison.layout;
    to.menu(Menu::new("Compare").group(Group::Comparison), |to| {
        for layout in Layout::ALL {
            let action = Action::Compare(CompareCommand::Layout(*layout));
            let show = command(format!("layout.{}", layout.id()), capitalised(layout.name()), action);
            to.add(show.mark(Mark::Radio(now == *layout)).tip(layout.summary()));
        }
        to.line();
        let add = command("add_view", "Add a view", Action::Compare(CompareCommand::Add));
        to.add(add.says("Add a view").keys("Ctrl+B").rank(-1));
        let fit = command("fit", "Fit to the measurement", Action::Match(MatchCommand::Fit));
        to.add(fit.says("Fit to the measurement").tip(fits::ONE).at_desk());
        let every = Action::Match(MatchCommand::Every(Default::default()));
        let every = command("fit_every", "Fit every model…", every).says("Fit every model…");
        to.add(every.tip(fits::EVERY).at_desk());
    });
}

fn marks(to: &mut List) {
    let v = &to.session.view;
    to.menu(Menu::new("Marks"), |to| {
        let lights = ViewChange::Markers(!v.show_markers);
        let lights = switch("light_markers", "Show light markers", v.show_markers, lights).at_desk();
        to.add(lights.says("Show light markers"));
        let room = switch("room_outline", "Outline of the room", v.show_room, ViewChange::Room(!v.show_room));
        to.add(room.says("Outline of the room").at_desk());
    });
}

fn handles(to: &mut List) {
    let v = &to.session.view;
    let word = if v.show_handles { v.handles.id() } else { "hidden" };
    let menu = Menu { shown: Some(format!("Handles: {word}")), ..Menu::new("Handles").group(Group::Handles) };
    to.menu(menu, |to| {
        let show = ViewChange::Handles(HandleChange::Show(!v.show_handles));
        to.add(switch("handles", "Show handles", v.show_handles, show).says("Show handles").at_desk());
        to.line();
        for mode in HandleMode::ALL.iter().copied() {
            let on = v.show_handles && v.handles == mode;
            let change = ViewChange::Handles(HandleChange::Mode(mode));
            to.add(choice("handles", mode.id(), mode.name(), on, change).at_desk());
        }
        to.line();
        let next = view("next_handles", "Next", ViewChange::Handles(HandleChange::Mode(v.handles.next())));
        to.add(next.says("Next handles: move, turn, size").keys("F3").at_desk());
    });
}

fn channels(to: &mut List) {
    let shown = to.session.channel_of(to.session.active());
    let show =
        |id, name, channel| choice("channel", id, name, shown == channel, ViewChange::Channel(channel));
    to.menu(Menu::new("Channel"), |to| {
        let picture = show("none", "The picture", None);
        to.add(picture.says("No debug channel: the picture").keys("Shift+X").rank(-1));
        to.line();
        for channel in DebugChannel::ALL {
            to.add(show(channel.id(), channel.name(), Some(channel)).tip(channel.explanation()));
        }
        to.line();
        let on = to.session.view.show_clipping;
        let clipped = switch("clipped_pixels", "Show clipped pixels", on, ViewChange::Clipping(!on));
        to.add(clipped.says("Show clipped pixels"));
    });
}

fn panels(to: &mut List) {
    let (session, v) = (to.session, &to.session.view);
    to.menu(Menu::new("Panels").group(Group::Window).width(0.8 * super::show::WIDTH), |to| {
        let left = if session.lesson.is_some() { "Lesson and scene list" } else { "Scene list" };
        to.add(switch("scene_list", left, v.left_open, ViewChange::Left(!v.left_open)).at_desk());
        to.add(switch("properties", "Properties", v.right_open, ViewChange::Right(!v.right_open)).at_desk());
        let examples = ViewChange::Examples(!v.examples_open);
        to.add(switch("examples", "Examples", v.examples_open, examples).at_desk());
        for panel in
            session.panels.iter().filter(|p| p.guest && matches!(p.place, Place::Left | Place::Right))
        {
            let side = if panel.place == Place::Left { v.left_open } else { v.right_open };
            let shown = side && !session.settings.hides(panel.id);
            to.add(of_panel(panel, shown, ViewChange::Panel(panel.id.to_owned(), !shown)));
        }
        for panel in session.panels.iter().filter(|p| p.place == Place::Bottom) {
            to.add(tab(to.session, panel));
        }
    });
}

fn of_panel(panel: &PanelInfo, shown: bool, change: ViewChange) -> Command {
    let switch = command(format!("panel.{}", panel.id), panel.title, Action::View(change));
    Command { foreign: panel.guest, ..switch.mark(Mark::Check(shown)).at_desk() }
}

/// A panel at the bottom.
fn tab(session: &super::Session, panel: &PanelInfo) -> Command {
    let shown = session.view.shows_strip() && session.view.bottom_tab == panel.id;
    let change = if shown { ViewChange::Bottom(false) } else { ViewChange::BottomTab(panel.id.to_owned()) };
    let tab = of_panel(panel, shown, change);
    match panel.id {
        // The key folds the strip away, whatever it shows.
        MESSAGES_TAB => Command {
            by_key: Some(Action::View(session.strip_change())),
            ..tab.says("Messages").keys("F8").rank(1)
        },
        PLOTS_TAB => tab.says("Plots: curves of the model").keys("F7").rank(1),
        MATERIALS_TAB => tab.says("Materials: apply and save them").keys("Ctrl+Shift+M").rank(1),
        SHADER_TAB => tab.says("Shader: files and errors").keys("F9").rank(1),
        _ => tab,
    }
}

fn sizes(to: &mut List) {
    let settings = &to.session.settings;
    let shown = Some(format!("Size of everything: {} %", settings.scale));
    let menu = Menu { shown, ..Menu::new("Size of everything").group(Group::Window) };
    to.menu(menu, |to| {
        to.add(view("larger", "Larger", ViewChange::Larger).says("Everything larger").keys("Ctrl++"));
        to.add(view("smaller", "Smaller", ViewChange::Smaller).says("Everything smaller").keys("Ctrl+−"));
        to.add(view("size_100", "100 %", ViewChange::Scale(100)).says("Everything at 100 %").keys("Ctrl+0"));
    });
    to.menu(Menu::new("Theme").group(Group::Window).stays(), |to| {
        for (theme, id, name) in [(ThemeChoice::Dark, "dark", "Dark"), (ThemeChoice::Light, "light", "Light")]
        {
            to.add(choice("theme", id, name, settings.theme == theme, ViewChange::Theme(theme)));
        }
    });
}
